#include "run/pages/run_movie.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "io/child_process.hpp"
#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "report/drawing.hpp"
#include "report/movie_picture.hpp"
#include "report/page.hpp"
#include "run/pages/colour_fields.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Before minutes go into pictures. One black picture, thrown away.
void need_ffmpeg() {
  if (run_program({"ffmpeg", "-nostdin", "-v", "error", "-f", "lavfi", "-i", "color=s=16x16", "-frames:v", "1",
                   "-f", "null", "-"}) != ProgramEnd::well)
    throw InputError({"", 0, "--movie"}, "needs ffmpeg, which is missing or does not work", "install ffmpeg");
}

constexpr int by_program = 255;  // above all numbers of errors

void draw(const std::vector<RopeView>& views, const MovieStage& stage, const std::string& folder,
          const std::string& movie) {
  int failed = 0;  // error of the first picture that cannot be made: errno, or `by_program`
  std::vector<ProcessTask> tasks;
  for (std::size_t k = 0; k < views.size(); ++k)
    tasks.push_back({[&, k] {
                       try {
                         write_drawing(fmt::format("{}/{:06}.png", folder, k),
                                       movie_picture(views[k], stage, number_text(views[k].time_ps) + " ps"), "png",
                                       1, "--movie");
                         return 0;
                       } catch (const FileError& e) {
                         return e.code();
                       } catch (const std::exception&) {
                         return by_program;
                       }
                     },
                     [&failed](int status) {
                       if (failed == 0) failed = WIFEXITED(status) ? WEXITSTATUS(status) : by_program;
                     }});
  run_processes(tasks, omp_get_num_procs());
  if (failed == by_program)
    throw InputError({movie, 0, "--movie"}, "pictures cannot be made: rsvg-convert is missing or failed",
                     "install librsvg2-bin");
  if (failed != 0) throw file_error(movie, "pictures cannot be written", failed);
}

}  // namespace

MovieSize make_movie(const RunDirectory& dir, const MovieOptions& a) {
  const std::string format = fs::path(a.file).extension().string();
  if (format != ".webm" && format != ".mp4")
    throw InputError({a.file, 0, "--movie"}, "is no .webm or .mp4", "end the name in one of them");
  refuse_existing(a.file, "--movie", a.force);
  need_ffmpeg();
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const std::size_t stored = frame_times(dir, prepared.topology).size();
  std::vector<RopeView> views;
  const StoredEvents events(dir.events(), prepared.topology);
  const std::vector<StoredFrame> frames =
      frames_of(dir, prepared.topology, evenly(stored, static_cast<std::size_t>(a.frames)));
  for (const StoredFrame& f : frames) views.push_back(view_of(events, f, std::numeric_limits<double>::quiet_NaN()));
  if (!a.colour.empty()) colour_by(a.colour, events, frames, scene, prepared, views);
  const double radius = prepared.topology.largest_radius();
  const RopeCamera camera = camera_from(a.from, views, radius, a.width - 40, 0.5625 * a.width);
  // Beside the movie, where there should be room.
  const fs::path place = fs::path(a.file).parent_path();
  const TemporaryFolder folder(place.empty() ? "." : place.string());
  draw(views, movie_stage(views, camera, radius, a.width), folder.path(), a.file);
  std::vector<std::string> words = {"ffmpeg",
                                    "-nostdin",
                                    "-v",
                                    "error",
                                    "-y",
                                    "-framerate",
                                    fmt::format("{}", a.fps),
                                    "-i",
                                    folder.file("%06d.png"),
                                    "-pix_fmt",
                                    "yuv420p"};
  const std::vector<std::string> webm = {"-c:v", "libvpx-vp9", "-crf", "30",      "-b:v",
                                         "0",    "-cpu-used",  "4",    "-row-mt", "1"},
                                 mp4 = {"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"};
  const auto& codec = format == ".webm" ? webm : mp4;
  words.insert(words.end(), codec.begin(), codec.end());
  Draft movie(a.file);
  words.insert(words.end(), {"-f", format.substr(1), movie.name()});
  if (run_program(words) != ProgramEnd::well) {
    movie.need_room();
    throw InputError({a.file, 0, "--movie"}, "cannot be made: ffmpeg failed", "take the other of .webm and .mp4");
  }
  movie.replace();
  return {views.size(), stored};
}

}  // namespace ropewalk
