// ropewalk-calibrate, also reached as `ropewalk calibrate`: parameter sets from atomistic data. Exit codes: 0
// done, 2 wrong input, 3 a calculation that failed.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/command_line.hpp"
#include "io/data_files.hpp"
#include "io/error_exit.hpp"
#include "io/plain_text.hpp"
#include "io/program.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"
#include "version.hpp"

namespace {

using namespace ropewalk;
using namespace ropewalk::calibrate;

struct Verbs {
  CalibrateArguments calibrate;
  UniversalArguments universal;
  FitArguments fit;
  ShowArguments show;
  CheckShippedArguments check_shipped;
  FrictionArguments friction;
  PullArguments pull;
  FluctuationsArguments fluctuations;
  int code = 0;
};

// The command as it can be typed in a shell.
std::string command_line(int argc, char** argv) {
  std::string text = "ropewalk calibrate";
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    text += word.find_first_of(" \t\n\"'$`\\") == std::string::npos ? " " + word : " '" + word + "'";
  }
  return text;
}

void add_law(CLI::App& app, std::string& lj, double& cutoff) {
  app.add_option("--lj", lj, "Lennard-Jones epsilon (eV) and sigma (nm) between atoms of two tubes")
      ->capture_default_str();
  app.add_option("--lj-cutoff", cutoff, "Its cutoff (nm), truncated as lj/cut does; 0: none")
      ->capture_default_str();
}

void add_calibrate(CLI::App& app, Verbs& v) {
  CalibrateArguments& a = v.calibrate;
  app.add_option("--chirality", a.chirality, "n,m, as in 10,10 or 7,3");
  app.add_option("--potential", a.potential, "tersoff, airebo, rebo or lcbop")->capture_default_str();
  app.add_option("--potential-file", a.user_potential, "Your own pair_style and pair_coeff lines, one atom type");
  add_law(app, a.lj, a.lj_cutoff);
  app.add_flag("--envelope", a.envelope, "Measure kink, collapse and 1 % limits with LAMMPS (minutes)");
  app.add_option("--envelope-of", a.envelope_of,
                 "Take them from this set of the same tube and potential instead, with the rows of its table");
  app.add_option("--out", a.out, "Parameter file; its tables lie beside it [default: cnt-N-M-POTENTIAL.toml]");
  app.add_option("--keep", a.keep, "Keep LAMMPS's inputs and logs in this new directory");
  app.add_option("--cell-length", a.stiffness.cell_length, "Least length of the periodic cells (nm); 0: chosen")
      ->capture_default_str();
  app.add_option("--strain", a.stiffness.largest_strain, "Fit window of stretch")->capture_default_str();
  app.add_option("--shear", a.stiffness.largest_shear, "Fit window of twist: radius times twist")
      ->capture_default_str();
  app.add_option("--bend-lengths", a.bend_lengths, "Free lengths of the shorter and the longer bent tube (nm)")
      ->capture_default_str();
  app.add_flag("--json", a.json, "JSON");
  app.add_flag("--force", a.force, "Replace existing files");
  app.add_flag("--quiet", a.quiet, "No progress lines");
}

void add_verbs(CLI::App& app, Verbs& v) {
  CLI::App* fit = app.add_subcommand("fit", "Fit a table of energies of your own");
  fit->add_option("data", v.fit.data, "CSV: energies of stretch, twist and bend, or of contact")->required();
  fit->add_option("settings", v.fit.settings, "TOML: model, free parameters, starts and bounds")->required();
  fit->add_option("--out", v.fit.out, "Write the base set with the fitted numbers to this file");
  fit->add_flag("--json", v.fit.json, "JSON");
  fit->add_flag("--force", v.fit.force, "Replace an existing file");
  fit->callback([&v] { v.code = fit_command(v.fit); });

  CLI::App* show = app.add_subcommand("show", "The table of a set, and a page with its plots");
  show->add_option("set", v.show.set, "Parameter set: a file, or the name of a shipped one")->required();
  show->add_option("--page", v.show.page, "Where the page goes [default: NAME.html]");
  show->add_flag("--table", v.show.table_only, "The table alone");
  show->callback([&v] { v.code = show_command(v.show); });

  CLI::App* check = app.add_subcommand("check-shipped", "Make a shipped set anew and compare");
  check->add_option("set", v.check_shipped.set, "Which")->capture_default_str();
  check->add_flag("--all", v.check_shipped.all, "All of them");
  check->add_option("--tolerance", v.check_shipped.tolerance, "Relative difference allowed")
      ->capture_default_str()
      ->check(number_within(Bounds::positive()));
  check->callback([&v] { v.code = check_shipped_command(v.check_shipped); });

  CLI::App* friction =
      app.add_subcommand("friction", "Friction of two tubes side by side, from their atoms (minutes)");
  FrictionArguments& f = v.friction;
  friction->add_option("set", f.first, "Parameter set of a tube: a file, or the name of a shipped one")->required();
  friction->add_option("other", f.second, "That of the other tube [default: the same]");
  friction->add_option("--out", f.out, "File [default: friction-N-M-N-M-POTENTIAL.toml]");
  friction->add_option("--keep", f.keep, "Keep LAMMPS's inputs and logs in this new directory");
  friction->add_option("--registers", f.registers, "Turns of both tubes that the strengths are means of")
      ->capture_default_str()
      ->check(CLI::Range(4, 10000));
  friction->add_option("--checks", f.checks, "Of these, how many LAMMPS relaxes")
      ->capture_default_str()
      ->check(CLI::Range(2, 100));
  friction
      ->add_option("--budget", f.budget_min, "Minutes, by which registers and checks are chosen; drag comes on top")
      ->check(CLI::Range(0.5, 1e4))
      ->excludes("--registers")
      ->excludes("--checks");
  friction->add_option("--drag-ps", f.drag_ps, "Time at 300 K at each of three speeds, at least 10; 0: no drag")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0, 1e5)));
  friction->add_flag("--json", f.json, "JSON");
  friction->add_flag("--force", f.force, "Replace an existing file");
  friction->add_flag("--quiet", f.quiet, "No progress lines");
  friction->callback([&v] { v.code = friction_command(v.friction); });

  CLI::App* pull = app.add_subcommand(
      "pull", "Add to a set what its tube bears until it gives way, by LAMMPS: for [failure] (some seconds)");
  pull->add_option("set", v.pull.set, "Parameter set with [bond.anharmonic]: a file, or the name of a shipped one")
      ->required();
  pull->add_option("--out", v.pull.out, "Parameter file; its tables lie beside it [default: NAME.toml]");
  pull->add_option("--keep", v.pull.keep, "Keep LAMMPS's inputs and logs in this new directory");
  pull->add_flag("--force", v.pull.force, "Replace existing files, as to change a set where it lies");
  pull->callback([&v] { v.code = pull_command(v.pull); });

  CLI::App* fluctuations = app.add_subcommand(
      "fluctuations",
      "EA, EI, GJ and their coupling from how the tubes of a run move in heat, beside those of a set");
  FluctuationsArguments& m = v.fluctuations;
  fluctuations
      ->add_option("run", m.run, "Directory of a run: of ropewalk run with a thermostat, or of ropewalk coarsen")
      ->required();
  fluctuations
      ->add_option("--temperature", m.temperature, "Of the motion, K [default: that of the run's thermostat]")
      ->check(number_within(Bounds::range(1, 1e4)));
  fluctuations->add_option("--after", m.after, "Leave out so much time at the start, ps")
      ->capture_default_str()
      ->check(number_within(Bounds::non_negative()));
  fluctuations->add_option("--against", m.against,
                           "Set to compare with: a file or a name [default: that of the run]");
  fluctuations->add_option("--out", m.out, "Write that set with these stiffnesses to this file");
  fluctuations->add_flag("--json", m.json, "JSON");
  fluctuations->add_flag("--force", m.force, "Replace an existing file");
  fluctuations->callback([&v] { v.code = fluctuations_command(v.fluctuations); });

  CLI::App* universal = app.add_subcommand("universal", "Fit one contact law for all radii (minutes)");
  add_law(*universal, v.universal.lj, v.universal.lj_cutoff);
  universal->add_option("--out", v.universal.out, "File [default: the shipped one]");
  universal->add_flag("--force", v.universal.force, "Replace an existing file");
  universal->callback([&v] { v.code = universal_command(v.universal); });
}

int run(CLI::App& app, Verbs& v) {
  if (!app.get_subcommands().empty()) return v.code;
  if (v.calibrate.chirality.empty())
    throw InputError({"", 0, "--chirality"}, "is missing", "write --chirality 10,10, or see --help");
  return calibrate_command(v.calibrate);
}

}  // namespace

int main(int argc, char** argv) {
  begin_program("ropewalk calibrate");
  CLI::App app(
      "ropewalk calibrate derives a tube's parameter set from atomistic data: stiffnesses from relaxed LAMMPS\n"
      "cells, van der Waals contact from the surface integral, both fitted with NLopt.\n"
      "Example: ropewalk calibrate --chirality 12,6",
      "ropewalk calibrate");
  keep_help_within_width(app);
  app.set_version_flag("--version", std::string("ropewalk-calibrate ") + version + " (" + git_id + ")");
  app.require_subcommand(0, 1);
  Verbs verbs;
  verbs.calibrate.command = verbs.friction.command = verbs.fit.command = verbs.universal.command =
      verbs.pull.command = verbs.fluctuations.command = command_line(argc, argv);
  add_calibrate(app, verbs);
  add_verbs(app, verbs);
  add_describe(app, [] {
    const std::vector<std::string> sets = shipped_sets();
    return Description{"ropewalk-calibrate",
                       version,
                       "",
                       nlohmann::ordered_json::object(),
                       {{"show", sets}, {"friction", sets}, {"pull", sets}}};
  });
  catch_interrupts();
  try {
    refuse_control_characters(argv);
    app.parse(argc, argv);
    return code_at_exit("ropewalk calibrate", run(app, verbs));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return code_at_exit("ropewalk calibrate", app.exit(e));
    std::fprintf(stderr, "ropewalk calibrate: %s\n", usage_error(app, e, "ropewalk calibrate").c_str());
    return 2;
  } catch (const std::exception& e) {
    if (interrupted_by() != 0 && error_code(e) == 3) {
      std::fprintf(stderr, "\nropewalk calibrate: interrupted; nothing was written\n");
      return 128 + interrupted_by();
    }
    return report_error("ropewalk calibrate", e);
  }
}
