// `coarsen`: atoms as elements.
#include "exchange/coarsen.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/sweep_progress.hpp"
#include "commands/verb.hpp"
#include "io/files.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/terminal_listener.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {

struct CoarsenArguments {
  std::vector<std::string> files;
  std::string out;                      // directory of the run to make
  std::string state;                    // CSV file to write instead, of one frame
  std::vector<std::string> parameters;  // sets; empty: shipped ones of the chiralities that are found
  double element_length = 0;            // nm; 0: the set's
  double time_step_fs = 1;              // step of the MD, for dumps that state no time
  bool force = false;
  bool json = false;
  bool quiet = false;
};

nlohmann::ordered_json as_json(const Coarsening& coarse) {
  auto list = nlohmann::ordered_json::array();
  for (const CoarseTube& t : coarse.tubes())
    list.push_back({{"n", t.chirality.n},
                    {"m", t.chirality.m},
                    {"elements", t.elements},
                    {"atoms", t.atoms},
                    {"atoms_in_no_element", t.without_site},
                    {"endless", t.endless},
                    {"cap_first", t.cap_below},
                    {"cap_last", t.cap_above},
                    {"pentagons", t.pentagons},
                    {"heptagons", t.heptagons},
                    {"atoms_beside_holes", t.open_atoms},
                    {"atoms_with_four_bonds", t.crowded},
                    {"radius_nm", t.radius},
                    {"misfit_nm", t.misfit}});
  return {{"tubes", std::move(list)},
          {"carbon_in_no_tube", coarse.loose()},
          {"other_atoms", coarse.foreign()},
          {"element_length_nm", coarse.topology().types.front().element_length}};
}

void tell_tubes(const Coarsening& coarse) {
  for (std::size_t t = 0; t < coarse.tubes().size(); ++t)
    fmt::print("tube {}: {}\n", t, words_of(coarse.tubes()[t]));
  if (coarse.loose() > 0) fmt::print("{} carbon atoms in no tube\n", coarse.loose());
  if (coarse.foreign() > 0) fmt::print("{} atoms of other species\n", coarse.foreign());
}

int coarsen_command(const CoarsenArguments& a) {
  if (a.out.empty() && a.state.empty())
    throw InputError({"", 0, "-o"}, "is missing", "name the directory of a run, or a state file by --state");
  if (!a.state.empty()) refuse_existing(a.state, "--state", a.force);
  const CoarsenSettings settings{a.files, a.parameters, a.element_length, a.time_step_fs};
  listen_to_stop_signals();
  TerminalListener terminal(a.quiet);
  Coarsening coarse(settings);
  const bool timed = coarse.states_time();
  if (a.json)
    fmt::print("{}\n", as_json(coarse).dump(1));
  else if (!a.quiet)
    tell_tubes(coarse);
  std::FILE* to = a.json ? stderr : stdout;
  if (!a.state.empty()) {
    while (!stop_signal && coarse.next()) {
    }
    if (stop_signal) return tell_stop();
    write_file_atomically(a.state, state_csv(coarse.topology(), coarse.state()));
    fmt::print(to, "{} written: {} elements. Go on with a scene that has [state] file = \"{}\"\n", a.state,
               coarse.topology().elements(), a.state);
    return 0;
  }
  if (stop_signal) return tell_stop();
  const CoarseRun run = write_coarse_run(coarse, settings, {a.out}, a.force, terminal);
  if (coarse.cut_off()) terminal.tell("note: the last frame is cut off and was left out");
  if (!timed && run.frames > 1)
    terminal.tell(fmt::format("note: the dump states no time: its steps are taken for {:g} fs, see --time-step-fs",
                              a.time_step_fs));
  fmt::print(to, "{} written: {} frame{} up to {:.6g} ps. Go on with: ropewalk report {}\n", a.out, run.frames,
             run.frames == 1 ? "" : "s", run.time, a.out);
  if (!run.passed.empty()) fmt::print(to, "Limits passed: {}\n", run.passed);
  return 0;
}

}  // namespace

void add_coarsen(CLI::App& app, Program& program) {
  const auto a = std::make_shared<CoarsenArguments>();
  CLI::App* c = app.add_subcommand(
      "coarsen", "Atoms as elements: tubes found in LAMMPS data files, dumps or XYZ become a run, or a state");
  c->add_option("files", a->files,
                "Files of one simulation: LAMMPS data, LAMMPS text dumps, XYZ or extended XYZ; lengths in Angstrom")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* out =
      c->add_option("-o,--out", a->out, "Directory of the run to make, for observe, report, view and compare");
  c->add_option("--state", a->state, "Write the last frame as a state (CSV), from which a scene can start")
      ->excludes(out);
  c->add_option("--parameters", a->parameters,
                "Parameter sets, one for each (n,m) [default: shipped ones of what is found]")
      ->delimiter(',');
  c->add_option("--element-length-nm", a->element_length,
                "Length of an element [default: the set's, of the first kind of tube]")
      ->check(number_within(Bounds::range(0.3, 50)));
  c->add_option("--time-step-fs", a->time_step_fs, "Time step of the MD, for dumps without ITEM: TIME")
      ->capture_default_str()
      ->check(number_within(Bounds::positive(1e6)));
  c->add_flag("--json", a->json, "What was found, as JSON");
  c->add_flag("--force", a->force, "Replace an earlier run in --out, or the file");
  c->add_flag("--quiet", a->quiet, "Do not list the tubes");
  c->callback([a, &program] { program.code = coarsen_command(*a); });
}

}  // namespace ropewalk
