// ropewalk-validate, also called as `ropewalk validate`: compares the model with references it was not fitted to.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>

#include "chart/chart.hpp"
#include "cli/command_line.hpp"
#include "io/data_files.hpp"
#include "io/error_exit.hpp"
#include "io/plain_text.hpp"
#include "io/program.hpp"
#include "parametrize/parametrize.hpp"
#include "runner/runner.hpp"
#include "version.hpp"

namespace {

using namespace ropewalk;
using namespace ropewalk::validate;

struct Verbs {
  ListArguments list;
  ValidateArguments run, stability;
  ReportArguments report;
  ChartArguments chart;
  ParametrizeArguments parametrize;
  struct {
    std::string scene, model;
    long steps = 0;
  } counted;
  int code = 0;
};

void add_run_options(CLI::App* verb, ValidateArguments& a) {
  verb->add_option("cases", a.cases, "Names of cases, see list [default: all]");
  verb->add_option(
      "--parameters", a.parameters,
      "Run the cases with this set. Those that have nothing to compare it with are listed with the reason");
  verb->add_option("--out", a.out, "Directory of results and report; finished cases in it are not run again")
      ->capture_default_str();
  verb->add_option("-j,--jobs", a.jobs, "Cases at a time [default: one for each core]")->check(whole_number(1));
  verb->add_flag("--again", a.again, "Run finished cases again");
  verb->add_flag("--json", a.json, "JSON");
  verb->add_flag("--quiet", a.quiet, "No progress lines");
}

void add_chart(CLI::App& app, Verbs& v) {
  CLI::App* chart = app.add_subcommand("chart", "Speed against accuracy: cost and error of each numerical setting");
  chart->add_option("--scenes", v.chart.scenes, "Scenes, separated by commas [default: all]")->delimiter(',');
  chart->add_option("--out", v.chart.out, "Directory of points and chart; finished points in it are not run again")
      ->capture_default_str();
  chart->add_option("--from", v.chart.from, "Draw the chart again from this points.csv; nothing is measured")
      ->excludes(chart->get_option("--scenes"));
  chart->add_flag("--quick", v.chart.quick, "A few models of two scenes, or of the named ones");
  chart->add_flag("--instructions", v.chart.instructions,
                  "Also count instructions with callgrind (valgrind), for finished points too");
  chart->add_flag("--again", v.chart.again, "Run finished points again");
  chart->add_flag("--quiet", v.chart.quiet, "No progress lines");
  chart->callback([&v] { v.code = chart_command(v.chart); });

  // Hidden: the program runs itself with this verb under callgrind.
  CLI::App* steps = app.add_subcommand("chart-steps")->group("");
  steps->add_option("scene", v.counted.scene)->required();
  steps->add_option("model", v.counted.model)->required();
  steps->add_option("steps", v.counted.steps)->required()->check(whole_number(1));
  steps->callback([&v] { step_for_counting(v.counted.scene, v.counted.model, v.counted.steps); });
}

// Also the verb `ropewalk parametrize`.
void add_parametrize(CLI::App& app, Verbs& v) {
  ParametrizeArguments& a = v.parametrize;
  CLI::App* verb = app.add_subcommand(
      "parametrize", "From chiralities to validated parameter sets: calibrate, make atoms, validate, one report");
  verb->add_option("tubes", a.tubes, "Chiralities, as in 7,3 10,10")->required();
  verb->add_option("--potential", a.potentials, "tersoff, airebo, rebo, lcbop; several, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--out", a.out, "Directory of sets, atoms and reports; what is finished in it is kept")
      ->capture_default_str();
  verb->add_option(
          "--friction", a.friction,
          "Friction from atoms: of each tube beside its like, of all pairs of tubes, or none; some minutes a pair")
      ->check(CLI::IsMember({"like", "all", "none"}))
      ->capture_default_str();
  verb->add_option("--tier", a.tier, "Cases to run: full, or quick: without ropes and bundles")
      ->check(CLI::IsMember({"full", "quick"}))
      ->capture_default_str();
  verb->add_option("--budget", a.budget, "Minutes that the references of one tube may take [default: any]")
      ->check(number_within(Bounds::positive()));
  verb->add_option("-j,--jobs", a.jobs, "Processes at a time [default: one for each core]")->check(whole_number(1));
  verb->add_flag("--again", a.again, "Make sets and results anew; references of atoms are kept");
  verb->add_flag("--quiet", a.quiet, "No progress lines");
  verb->callback([&v] { v.code = parametrize_command(v.parametrize); });
}

void add_verbs(CLI::App& app, Verbs& v) {
  CLI::App* list = app.add_subcommand("list", "List the cases");
  list->add_flag("--json", v.list.json, "JSON, with set-up, oracle and literature");
  list->callback([&v] { v.code = list_command(v.list); });

  CLI::App* run = app.add_subcommand("run", "Run cases and write the report");
  run->add_option("--tier", v.run.tier, "full, or quick: without ropes and bundles")->capture_default_str();
  run->add_flag("--fresh", v.run.fresh, "Make the references with LAMMPS and compare them with the stored ones");
  run->add_option("--with", v.run.with, "A second set: pairs of unlike tubes are compared too");
  run->add_flag(
      "--atoms", v.run.atoms,
      "Make the references of the set's tube with LAMMPS and the set's potential, beside the set (minutes)");
  run->add_option("--budget", v.run.budget, "Minutes that these may take [default: any]")
      ->check(number_within(Bounds::positive()));
  add_run_options(run, v.run);
  run->callback([&v] { v.code = validate_command(v.run); });

  v.stability.stability = true;
  v.stability.out = "stability";
  CLI::App* stability = app.add_subcommand("stability", "Find where the methods fail and compare with theory");
  add_run_options(stability, v.stability);
  stability->callback([&v] { v.code = validate_command(v.stability); });

  CLI::App* report = app.add_subcommand("report", "Write report.html and report.json again from the results");
  report->add_option("dir", v.report.dir, "Directory of the results")->required();
  report->callback([&v] { v.code = validation_report_command(v.report); });

  add_chart(app, v);
  add_parametrize(app, v);
}

}  // namespace

int main(int argc, char** argv) {
  begin_program("ropewalk validate");
  // `ropewalk parametrize` comes here as it was typed.
  const bool parametrize = argc > 1 && std::strcmp(argv[1], "parametrize") == 0;
  const char* name = parametrize ? "ropewalk" : "ropewalk validate";
  const char* spoken = parametrize ? "ropewalk parametrize" : name;
  CLI::App app(
      "ropewalk validate compares the model with exact theory, LAMMPS references and other codes.\n"
      "Exit code: 0 all hold, 1 some miss, 2 wrong input, 3 a case could not be run.",
      name);
  keep_help_within_width(app);
  app.set_version_flag("--version", std::string("ropewalk-validate ") + version + " (" + git_id + ")");
  app.require_subcommand(1);
  Verbs verbs;
  add_verbs(app, verbs);
  add_describe(app, [] {
    return Description{
        "ropewalk-validate", version, "", nlohmann::ordered_json::object(), {{"--parameters", shipped_sets()}}};
  });
  try {
    refuse_control_characters(argv);
    app.parse(argc, argv);
    return code_at_exit(spoken, verbs.code);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return code_at_exit(spoken, app.exit(e));
    std::fprintf(stderr, "%s: %s\n", spoken, usage_error(app, e, name).c_str());
    return 2;
  } catch (const std::exception& e) {
    return report_error(spoken, e);
  }
}
