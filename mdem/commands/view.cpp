// `view`: a page with the frames of a run in space, or a movie.
#include <fmt/format.h>

#include <filesystem>

#include "commands/verb.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "run/pages/run_movie.hpp"
#include "run/pages/view_input.hpp"

namespace ropewalk {
namespace {

struct ViewArguments {
  std::string dir;
  std::string out;            // the page; empty: DIR/view.html
  int frames = 100;           // at most
  double megabytes = 15;      // largest size of the page
  std::string movie;          // .webm or .mp4 to write instead
  std::string from = "side";  // view of the movie, as in PictureArguments
  std::string colour;         // colours of the movie, as in PictureArguments
  double fps = 15;            // frames per second of the movie
  int width = 1280;           // width of the movie, pixels
  bool force = false;
};

int view_command(const ViewArguments& a) {
  if (!a.movie.empty()) {
    const MovieSize movie = make_movie({a.dir}, {a.movie, a.from, a.colour, a.frames, a.fps, a.width, a.force});
    fmt::print("{} written: {} of {} frames\n", a.movie, movie.frames, movie.stored);
    return 0;
  }
  if (!can_make_view())
    throw InputError({"", 0, "view"}, "this program was built without three.js, which the page needs",
                     "install libjs-three and build again, or make a movie with --movie");
  if (!a.out.empty()) refuse_existing(a.out, "-o", a.force);
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const ViewInput in = view_input(dir, scene, prepared, static_cast<std::size_t>(a.frames));
  const ViewPage page = view_page(in, static_cast<std::size_t>(a.megabytes * 1e6));
  const std::string out = a.out.empty() ? dir.view() : a.out;
  write_file_atomically(out, page.html);
  fmt::print("{} written: {} of {} frames, {:.1f} MB; positions to {:.2g} nm, numbers to 1/{} of their range\n",
             out, page.frames, in.stored_frames, static_cast<double>(page.html.size()) / 1e6,
             0.5 * page.position_step, 2 * page.levels);
  // The report then names the page.
  if (a.out.empty() && std::filesystem::exists(dir.report())) write_report(dir, scene, prepared);
  return 0;
}

}  // namespace

void add_view(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ViewArguments>();
  CLI::App* c = app.add_subcommand(
      "view", "Show a run in space: a page to turn, play and cut through its frames; or a movie");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  c->add_option("-o", a->out, "Page to write [default: DIR/view.html]");
  c->add_option("--frames", a->frames, "At most so many frames, evenly over the run")
      ->capture_default_str()
      ->check(whole_number(1, 100000));
  c->add_option("--megabytes", a->megabytes,
                "Largest size of the page: numbers are rounded to keep it, then frames are left out")
      ->capture_default_str()
      ->check(number_within(Bounds::range(1.0, 2000.0)));
  CLI::Option* movie =
      c->add_option("--movie", a->movie, "Write a movie of these frames instead: .webm or .mp4, by ffmpeg");
  c->add_option("--from", a->from,
                "Movie, seen from: side (the largest deflection in the picture), x, y, z, or AZIMUTH,ELEVATION")
      ->capture_default_str()
      ->needs(movie);
  add_colour(c, a->colour, "Movie: tubes")->needs(movie);
  c->add_option("--fps", a->fps, "Movie: frames per second")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0.1, 120.0)))
      ->needs(movie);
  c->add_option("--width", a->width, "Movie: width, pixels")
      ->capture_default_str()
      ->check(whole_number(200, 7680))
      ->needs(movie);
  c->add_flag("--force", a->force, "Replace the file of -o or --movie");
  c->callback([a, &program] { program.code = view_command(*a); });
}

}  // namespace ropewalk
