// `view`: a page with the frames of a run in space, or a movie.
#include <fmt/format.h>

#include <filesystem>

#include "commands/commands.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "run/pages/run_movie.hpp"
#include "run/pages/view_input.hpp"

namespace ropewalk {

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

}  // namespace ropewalk
