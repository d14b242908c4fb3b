// `picture`: a figure for a paper from the frames and the log of a run.
#include <fmt/format.h>

#include <filesystem>

#include "commands/commands.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "report/plate.hpp"
#include "run/pages/run_views.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t usual_states = 4;

std::vector<std::vector<std::string>> curves_of(const std::vector<std::string>& groups) {
  std::vector<std::vector<std::string>> out;
  for (const std::string& group : groups) {
    out.emplace_back(1);
    for (const char c : group)
      if (c == '+')
        out.back().emplace_back();
      else
        out.back().back() += c;
    for (const std::string& column : out.back()) column_of_log(column, {"", 0, "--curves"});
  }
  return out;
}

// PDF and PNG by librsvg's program.
void convert(const std::string& svg, const std::string& out, const std::string& format, double zoom) {
  const std::string draft = out + ".svg";
  write_file_atomically(draft, svg);
  const ProgramEnd end =
      run_program({"rsvg-convert", "-f", format, "-z", fmt::format("{}", zoom), "-o", out, draft});
  std::error_code ignored;
  fs::remove(draft, ignored);
  if (end != ProgramEnd::well)
    throw InputError({out, 0, "-o"}, "cannot be made: rsvg-convert is missing or failed",
                     "install librsvg2-bin, or write .svg");
}

}  // namespace

int picture_command(const PictureArguments& a) {
  const std::string format = fs::path(a.out).extension().string();
  if (format != ".svg" && format != ".pdf" && format != ".png")
    throw InputError({a.out, 0, "-o"}, "is no .svg, .pdf or .png", "end the name in one of them");
  refuse_existing(a.out, "-o", a.force);
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  PlateInput in;
  in.tube_radius = prepared.topology.largest_radius();
  in.shells = observer.shells;
  in.log = read_log(dir.log());
  in.curves = curves_of(a.curves);
  in.width = a.width;
  for (const StoredFrame& frame : frames_at(dir, prepared.topology, a.at, usual_states)) {
    const RopeObservation o = observe(observer, scene, prepared.topology, frame.state);
    const double beta = o.beta / units::degree;
    in.views.push_back(view_of(prepared.topology, frame, beta));
    if (a.sections && !o.middle.points.empty())
      in.sections.push_back({frame.state.time, beta, o.middle, o.radius_profile});
  }
  if (in.sections.size() != in.views.size()) in.sections.clear();
  in.camera =
      camera_from(a.from, in.views, in.tube_radius, a.width - 20 - (in.sections.empty() ? 0 : 164), a.highest);
  const std::string svg = plate_svg(in);
  if (format == ".svg")
    write_file_atomically(a.out, svg);
  else
    convert(svg, a.out, format.substr(1), format == ".png" ? a.zoom : 1);
  fmt::print("{} written\n", a.out);
  return 0;
}

}  // namespace ropewalk
