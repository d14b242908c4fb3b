// `ropewalk calibrate pull SET`: adds to a set what its tube holds beyond the window of its bond.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "atomistic/runs.hpp"
#include "atoms/honeycomb_file.hpp"
#include "atoms/tube_reference.hpp"
#include "io/data_files.hpp"
#include "io/file_group.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "verbs/verbs.hpp"
#include "version.hpp"

namespace ropewalk::calibrate {
namespace {

struct PullArguments {
  std::string set;
  std::string out;   // empty: NAME.toml in the current directory
  std::string keep;  // empty: LAMMPS's files are removed at the end
  bool force = false;
  std::string command;
};

namespace fs = std::filesystem;

double number_of(const ParameterSet& set, const std::string& key) {
  const Quantity* q = find_quantity(set, key);
  if (!q) throw InputError({set.path, 0, key}, "is missing", "take a set that ropewalk calibrate made");
  return q->value;
}

// The table of a set that lies beside it, unchanged.
std::string stored_table(const ParameterSet& set, const std::string& kind) {
  const std::string name = provenance_value(set, kind + "_table");
  const std::string path = (fs::path(set.path).parent_path() / name).string();
  if (name.empty() || !fs::is_regular_file(path) ||
      hash_hex(read_file(path)) != provenance_value(set, kind + "_hash"))
    throw InputError({set.path, 0, fmt::format("provenance.{}_table", kind)},
                     "is not beside the set, or is not the one that it was made from",
                     "bring that table, or make the set anew with ropewalk calibrate --chirality");
  return path;
}

RelaxedTube tube_at_rest(const ParameterSet& set) {
  RelaxedTube tube;
  tube.shape = reference_of(set).shape;
  tube.energy_per_hexagon = 2 * number_of(set, "atomistic.energy_per_atom");
  tube.contraction = number_of(set, "atomistic.poisson");
  return tube;
}

// The lines of comment with which a file begins.
std::string first_comment(const std::string& path) {
  std::istringstream lines(read_file(path));
  std::string out;
  for (std::string line; std::getline(lines, line) && line.rfind('#', 0) == 0;) out += line + "\n";
  return out;
}

void put_provenance(ParameterSet& set, const std::string& key, const std::string& value) {
  for (auto& entry : set.provenance)
    if (entry.first == key) {
      entry.second = value;
      return;
    }
  set.provenance.emplace_back(key, value);
}

int pull_command(const PullArguments& a) {
  ParameterSet set = read_parameters(find_parameters(a.set, "", {"", 0, "set"}));
  refuse_filament(set, "there is nothing to pull", "give its strength in [failure] strain, up to validity.stretch");
  if (!set.anharmonic)
    throw InputError({set.path, 0, "bond.anharmonic"}, "is missing, where the pull begins",
                     "take a set that ropewalk calibrate made with --potential tersoff");
  const Potential potential = potential_of(set, provenance_value(set, "potential"));
  if (potential.file_hash != provenance_value(set, "potential_hash"))
    throw InputError({set.path, 0, "provenance.potential_hash"}, "is that of another file than " + potential.file,
                     "set LAMMPS_POTENTIALS to the folder of the file, or make the set anew");
  AtomisticOrigin origin;
  std::vector<AtomisticRow> rows = read_atomistic_csv(stored_table(set, "stiffness"), &origin);
  const std::string contact = read_file(stored_table(set, "contact"));
  rows.erase(std::remove_if(rows.begin(), rows.end(), [](const AtomisticRow& r) { return r.kind == "pull"; }),
             rows.end());
  const std::string out = a.out.empty() ? set.name + ".toml" : a.out;
  if (fs::path(out).extension() != ".toml")
    throw InputError({out, 0, "--out"}, "is not named *.toml", "choose such a name: the tables lie beside it");
  const std::string stem = out.substr(0, out.size() - 5);
  const std::string stiffness_file = stem + "-stiffness.csv", contact_file = stem + "-contact.csv";
  for (const std::string& file : {out, stiffness_file, contact_file}) check_output(file, "--out", a.force);

  StiffnessOptions options;
  options.lammps.interrupted = [] { return interrupted_by() != 0; };
  const LammpsVersion lammps = lammps_version(options.lammps);
  WorkFolder folder(a.keep);
  RunContext run{set.chirality, potential, folder.path(), options, 0, {}};
  PulledCell pulled;
  try {
    pulled = pull_cell(run, tube_at_rest(set));
  } catch (const LammpsError& e) {
    folder.stay_for(e);
    throw;
  }
  rows.insert(rows.end(), pulled.rows.begin(), pulled.rows.end());
  Anharmonic law = *set.anharmonic;
  law.pull_step = 0;
  PullFit pull = fit_pull(rows, law, set.bond.stretch, set.bond.twist, number_of(set, "atomistic.natural_twist"));
  pull.ended_by = pulled.ended_by;
  if (!(pull.end > 0))
    throw InputError({set.path, 0, "bond.anharmonic.max_strain"}, "is where the tube gives way already",
                     "nothing: the set has all that its atoms bear");

  put_pull(set, pull);
  const std::string table = atomistic_csv(rows, origin), comment = first_comment(set.path);
  put_provenance(set, "stiffness_table", fs::path(stiffness_file).filename().string());
  put_provenance(set, "stiffness_hash", hash_hex(table));
  put_provenance(set, "contact_table", fs::path(contact_file).filename().string());
  put_provenance(set, "pull_command", a.command);
  put_provenance(set, "pull_program", fmt::format("ropewalk {} ({})", version, git_id));
  put_provenance(set, "pull_lammps", lammps.text);
  const std::string text = parameters_text(set, comment);
  parameters_of_text(text, out);  // throws where other commands would refuse it
  write_files_together({{stiffness_file, table}, {contact_file, contact}, {out, text}});
  for (const std::string& w : run.warnings) fmt::print("warning: {}\n", w);
  fmt::print("{}: {:.4g} nN at a strain of {:.3g}; beyond it {}; law within {:.1e} of the energy\nSet: {}\n",
             tube_name(set), pull.force.back().value * units::eV_in_nN_nm, pull.end,
             pull.ended_by, pull.error, out);
  return 0;
}

}  // namespace

void add_pull(CLI::App& app, Program& program) {
  const auto a = std::make_shared<PullArguments>();
  a->command = program.command;
  CLI::App* c = app.add_subcommand(
      "pull", "Add to a set what its tube bears until it gives way, by LAMMPS: for [failure] (some seconds)");
  c->add_option("set", a->set, "Parameter set with [bond.anharmonic]: a file, or the name of a shipped one")
      ->required();
  c->add_option("--out", a->out, "Parameter file; its tables lie beside it [default: NAME.toml]");
  c->add_option("--keep", a->keep, "Keep LAMMPS's inputs and logs in this new directory");
  c->add_flag("--force", a->force, "Replace existing files, as to change a set where it lies");
  c->callback([a, &program] { program.code = pull_command(*a); });
}

}  // namespace ropewalk::calibrate
