// `report`: report.html from the files of a run, or a picture of its end.
#include <fmt/format.h>

#include "commands/verb.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "report/svg.hpp"
#include "run/pages/run_views.hpp"

namespace ropewalk {
namespace {

struct ReportArguments {
  std::string dir;
  std::string picture;  // write the last frame as SVG here instead
};

int report_command(const ReportArguments& a) {
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  if (a.picture.empty()) {
    write_report(dir, scene, prepared);
    fmt::print("{} written\n", dir.report());
    return 0;
  }
  const std::optional<RopeView> view = last_view(dir, scene, prepared);
  if (!view)
    throw InputError({dir.frames(), 0, ""}, "holds no frame", "run the scene further with `ropewalk resume`");
  write_file_atomically(a.picture, rope_svg(*view, prepared.topology.largest_radius()));
  fmt::print("{} written\n", a.picture);
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ReportArguments>();
  CLI::App* c = app.add_subcommand("report", "Make report.html anew from the files of a run");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  c->add_option("--picture", a->picture, "Write a side view of the last frame to this SVG file instead");
  c->callback([a, &program] { program.code = report_command(*a); });
}

}  // namespace ropewalk
