#include "scene/lammps_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "scene/bounds.hpp"
#include "scene/missing_forces.hpp"
#include "scene/own_parts.hpp"
#include "scene/parts_in_use.hpp"
#include "scene/scene_place.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *start_format = "ropewalk-lammps-3", *images_key = "images";
constexpr const char* export_again = "export the run again with `ropewalk export`";

template <class S, class Visit>
void visit_start(S&& s, const Visit& v) {
  v({"id", "", "hash of scene, parameter sets, tubes and first state, which states of this export bear"}, s.id);
  v({"step", "", "time step of the export"}, s.step);
  v({"time_ps", "ps", "time of the export"}, s.time);
  v({"time_step_ps", "ps", "time step"}, s.time_step);
  v({"work_eV", "eV", "work done by the loads so far"}, s.work);
  v({"dissipated_eV", "eV", "energy taken out by damping so far"}, s.dissipated);
  v({"heat_eV", "eV", "energy brought in by the thermostat so far"}, s.heat);
  v({"lineage", "", "key of the random numbers: another one for a scene that goes on from a state"}, s.lineage);
  v({"strands_begin_with_tubes", "", "the first tube of each strand; empty: each tube is a strand"},
    s.strand_begin);
  v({"strand_holes_nm", "nm", "between the tubes of a strand at the start: their sum, of the strand with most"},
    s.strand_holes);
  v({images_key, "", "elements at each end of a strand that are images, in a slice; else 0"}, s.images);
  v({"period_nm", "nm", "period of a slice at the start; else 0"}, s.period);
  v({"viscosity_inner_nm", "nm", "distance up to which contact viscosity acts in full"}, s.viscosity_inner);
  v({"viscosity_outer_nm", "nm", "distance beyond which there is no contact viscosity"}, s.viscosity_outer);
  v({"tubes_came_broken", "", "whether tubes were broken in the state that the scene began with, and no others break"},
    s.tubes_came_broken);
  v({"parameters", "", "files of the parameter sets, by type of the tube"}, s.parameters);
  v({"sums", "", "hashes of `in.rope`, `tubes.csv` and `rope.state`, to which `import` holds them"}, s.sums);
}

// Takes the next number off `text`, and what separates it from the next.
template <class T>
bool take(std::string_view& text, T& value) {
  while (!text.empty() && (text.front() == ' ' || text.front() == ',')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

// Whole lines of a text; what follows the last newline is left out.
template <class F>
void for_each_line(std::string_view text, F f) {
  int number = 1;
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1))
    f(number++, text.substr(0, end));
}

constexpr std::array<OutputColumn, 3> tube_columns = {{
    {"tubes", "", "tubes of one kind that follow one another"},
    {"elements", "", "elements of each of them"},
    {"type", "", "type of the tube, from 0"},
}};

// The step, then the numbers of fix `motion`.
constexpr std::array<OutputColumn, 1 + lammps_row_numbers> row_columns = {{
    {"step", "", "time step"},
    {"time_ps", "ps", "time"},
    {"stretch_eV", "eV", "stretch energy of the bonds"},
    {"shear_eV", "eV", "shear energy of the bonds"},
    {"bend_eV", "eV", "bending energy of the bonds"},
    {"twist_eV", "eV", "torsional energy of the bonds"},
    {"vdw_eV", "eV", "van der Waals energy of the contacts"},
    {"kinetic_eV", "eV", "kinetic energy of translation and rotation"},
    {"work_eV", "eV", "work done by the loads since the start"},
    {"dissipated_eV", "eV", "energy taken out by damping since the start"},
    {"heat_eV", "eV", "energy brought in by the thermostat since the start"},
}};

constexpr double most_steps = 1e15;

template <class Columns>
std::vector<OutputColumn> listed(const Columns& columns) {
  return {columns.begin(), columns.end()};
}

}  // namespace

std::vector<OutputColumn> lammps_start_keys() {
  std::vector<OutputColumn> keys = {{"format", "", start_format}};
  visit_start(LammpsStart(), [&](const OutputColumn& key, const auto&) { keys.push_back(key); });
  return keys;
}
std::vector<OutputColumn> lammps_tube_columns() { return listed(tube_columns); }
std::vector<OutputColumn> lammps_row_columns() { return listed(row_columns); }

void refuse_what_lammps_lacks(const Scene& scene) {
  refuse_missing_forces(scene.missing_forces, scene.path);
  if (const std::vector<PartInUse> own = parts_in_use(scene); !own.empty())
    throw InputError(place_in(scene, own.front().key),
                     fmt::format("is not for LAMMPS: lmp-ropewalk has no {}, which is of {} alone", own.front().words,
                                 own_program()),
                     fmt::format("run this scene with `{} run`", own_program()));
  Drive::NotForLammps lacking;
  for (const auto& drive : scene.drives)
    if (lacking.key.empty()) lacking = drive->not_for_lammps();
  if (lacking.key.empty() && scene.has_ends(Drive::Ends::endless))
    for (const char* name : {"friction", "links", "failure"})
      for (const auto& drive : scene.drives)
        if (lacking.key.empty() && drive->table().name == name)
          lacking = {name,
                     "images of a slice remember what their originals do, which other ranks have; a rope of ten "
                     "periods between grips, whose middle is as a slice, takes ten times as long a step"};
  if (lacking.key.empty() && scene.run.stepping.runge_kutta)
    lacking = {"run.integrator", "it evaluates forces once in a step"};
  if (lacking.key.empty() && scene.run.solver != RunOptions::Solver::fire)
    lacking = {"run.solver", "its ranks have no solver of linear systems"};
  if (!lacking.key.empty())
    throw InputError(place_in(scene, lacking.key), "is not for LAMMPS: " + lacking.reason,
                     "run this scene with `ropewalk run`");
}

std::string start_json(const LammpsStart& start) {
  Json json;
  json["format"] = start_format;
  visit_start(start, [&](const OutputColumn& key, const auto& value) { json[key.name] = value; });
  return json.dump(1) + "\n";
}

LammpsStart read_start(const LammpsDirectory& dir) {
  const std::string path = dir.start();
  LammpsStart start;
  try {
    const Json json = Json::parse(read_file(path));
    if (json.at("format") != start_format)
      throw InputError({path, 0, "format"}, fmt::format("\"{}\" is needed", start_format), export_again);
    visit_start(start, [&](const OutputColumn& key, auto& value) {
      const Json& found = json.at(key.name);
      using Value = std::decay_t<decltype(value)>;
      if (std::is_integral_v<Value> && !std::is_same_v<Value, bool> && !found.is_number_integer())
        throw InputError({path, 0, key.name}, "is no whole number", export_again);
      found.get_to(value);
    });
  } catch (const Json::exception&) {
    throw InputError({path, 0, ""}, "is damaged", export_again);
  }
  for (const double value : {start.time, start.time_step, start.work, start.dissipated, start.heat,
                             start.strand_holes, start.period, start.viscosity_inner, start.viscosity_outer})
    if (!std::isfinite(value)) throw InputError({path, 0, ""}, "holds a number that is not finite", export_again);
  for (const std::string& name : start.parameters)
    if (has_control_character(name) || name.find('/') != std::string::npos)
      throw InputError({path, 0, "parameters"},
                       fmt::format("\"{}\" is no file of this directory", printable(name, 40)), export_again);
  return start;
}

std::string tubes_csv(const Topology& topology) {
  std::string text = column_names(tube_columns) + "\n";
  for (int t = 0, next = 0; t < topology.tubes(); t = next) {
    const auto alike = [&](int u) {
      return topology.length_of(u) == topology.length_of(t) && topology.tube_type[u] == topology.tube_type[t];
    };
    while (next < topology.tubes() && alike(next)) ++next;
    text += fmt::format("{},{},{}\n", next - t, topology.length_of(t), topology.tube_type[t]);
  }
  return text;
}

void read_tubes(const LammpsDirectory& dir, Topology& topology) {
  const std::string path = dir.tubes();
  for_each_line(read_file(path), [&](int number, std::string_view line) {
    if (number == 1 && line == column_names(tube_columns)) return;
    int tubes = 0, elements = 0, type = -1;
    const bool read = take(line, tubes) && take(line, elements) && take(line, type) && line.empty();
    if (number == 1 || !read || tubes < 1 || elements < 1 || type < 0 ||
        type >= static_cast<int>(topology.types.size()))
      throw InputError({path, number, ""}, fmt::format("no line of {}", column_names(tube_columns)), export_again);
    const double total = topology.elements() + double{1} * tubes * elements;
    if (total > max_elements)
      throw InputError({path, number, ""}, fmt::format("makes it {:.3g} elements", total), export_again);
    for (int t = 0; t < tubes; ++t) topology.add_tube(elements, type);
  });
  if (topology.tubes() == 0) throw InputError({path, 0, ""}, "holds no tube", export_again);
}

void set_strands(const LammpsDirectory& dir, const LammpsStart& start, Topology& topology) {
  std::vector<int> begin = start.strand_begin;
  if (begin.empty()) return;
  begin.push_back(topology.tubes());
  const bool rise = std::adjacent_find(begin.begin(), begin.end(), std::greater_equal<>()) == begin.end();
  if (begin.front() != 0 || !rise)
    throw InputError({dir.start(), 0, "strands_begin_with_tubes"}, "does not fit the tubes of this export",
                     export_again);
  topology.groups.strand_begin = std::move(begin);
  topology.groups.strand_holes = start.strand_holes;
}

void set_slice(const LammpsDirectory& dir, const LammpsStart& start, Topology& topology) {
  const int of_strand = topology.elements() / topology.strands();
  if (start.images < 0 || 3 * start.images > of_strand || !(start.period >= 0) || (start.images > 0 && start.period == 0))
    throw InputError({dir.start(), 0, images_key}, "does not fit the tubes of this export", export_again);
  topology.groups.images = start.images;
  topology.groups.period = start.period;
}

namespace {

constexpr std::array<const char*, 5> of_a_term = {"term", "lost", "drag", "events", "begun"};

// Names of the numbers that fix `motion` writes in a row.
std::vector<std::string> row_names(int terms) {
  std::vector<std::string> names = {"time", "stretch", "shear", "bend",       "twist",
                                    "vdw",  "kinetic", "work",  "dissipated", "heat"};
  for (int k = 1; k <= terms; ++k)
    for (const char* number : of_a_term) names.push_back(fmt::format("{}{}", number, k));
  return names;
}

std::string row_title(int terms) {
  std::string title = column_names(row_columns);
  for (int k = 1; k <= terms; ++k) title += fmt::format(",term{0}_eV,lost{0}_eV,drag{0}_eV,events{0},begun{0}", k);
  return title;
}

std::string row_format(int terms) {
  std::string text = "${step}";
  for (const std::string& name : row_names(terms)) text += fmt::format(",${{{}}}", name);
  return text;
}

// With all their digits.
std::string row_variables(int terms) {
  const std::vector<std::string> names = row_names(terms);
  std::string text = "variable now equal step\nvariable step format now %.0f\n";
  for (std::size_t k = 0; k < names.size(); ++k) {
    text +=
        fmt::format("variable {0}_now equal f_motion[{1}]\nvariable {0} format {0}_now %.17g\n", names[k], k + 1);
  }
  return text;
}

std::string pair_line(const LammpsScript& s) {
  return fmt::format("pair_style mdem/{} ${{dir}} ${{forces}}", s.law);
}

}  // namespace

std::string lammps_input(const LammpsScript& s) {
  // LAMMPS leaves out neighbours along a chain by 1, 2 and 3 bonds; the model says up to how many.
  const auto weight = [&](int bonds) { return bonds <= s.excluded_elements ? 0 : 1; };
  std::string text = fmt::format(
      "# {}. Run with lmp-ropewalk. Units are nm, ps and eV, in which LAMMPS's \"lj\" has all factors 1.\n"
      "# On the command line: -var steps N (in all, from rope.state on), -var from lammps.states (to go on from "
      "the\n"
      "# last state written), -var forces plain (pair by pair, slowly, as a check).\n"
      "variable dir index .\n"
      "if \"$(is_defined(variable,from)) == 0\" then \"variable open index file\" else \"variable open index "
      "append\"\n"
      "variable from index rope.state\n"
      "variable forces index engine\n"
      "variable steps index {}\n"
      "variable last equal {}+${{steps}}\n"
      "variable every index {}\n"
      "if \"$(is_defined(variable,wall)) == 1\" then \"timer timeout ${{wall}}\"  # seconds, or hours:minutes:seconds\n"
      "units lj\n"
      "atom_style hybrid sphere bond\n"
      "boundary m m m\n"
      "newton on\n"
      "special_bonds lj/coul {} {} {}\n"
      "comm_modify mode single vel yes cutoff {}\n",
      lammps_comment(s.name), s.steps, s.first_step, s.every, weight(1), weight(2), weight(3), s.reach + s.skin);
  text += s.long_in_z ? "processors 1 1 *  # ropes lie along z: every cut is across them\n" : "comm_style tiled\n";
  text += fmt::format(
      "region box block {} {} {} {} {} {}\n"
      "create_box {} box bond/types {} extra/bond/per/atom 1\n"
      "fix elements all property/atom d2_quat 4 d2_carried 6 ghost yes\n"
      "{}\n"
      "pair_coeff * *\n"
      "bond_style mdem/vbond ${{dir}}\n"
      "bond_coeff *\n"
      "neighbor {} bin\n"
      "neigh_modify every 1 delay 0 check yes\n"
      "timestep {}\n"
      "fix states all mdem/states ${{every}} ${{dir}}/lammps.states from ${{dir}}/${{from}}\n",
      s.low.x(), s.high.x(), s.low.y(), s.high.y(), s.low.z(), s.high.z(), s.types, s.types, pair_line(s), s.skin,
      s.time_step);
  if (s.damped) text += "fix damping all mdem/damp\n";
  if (s.driven) text += "fix grips all mdem/grip\n";
  text += fmt::format("fix motion all mdem/{}\n", s.relax ? "relax" : "nve");
  if (!s.long_in_z) text += "balance 1.0 rcb\nfix even all balance 1000 1.01 rcb\n";
  text += row_variables(s.terms);
  text += fmt::format(
      "fix rows all print ${{every}} \"{0}\" ${{open}} ${{dir}}/lammps-rows.csv screen no title \"{1}\"\n"
      "thermo_style custom step f_motion[1] f_motion[4] f_motion[5] f_motion[6] f_motion[7] pe\n"
      "thermo_modify norm no lost error\n"
      "thermo ${{every}}\n"
      "run ${{last}} upto\n"
      "unfix rows\n"
      "print \"{0}\" append ${{dir}}/lammps-rows.csv screen no\n",
      row_format(s.terms), row_title(s.terms));
  // A relaxation ends where forces are small.
  if (!s.relax) text += "if \"$(is_defined(variable,wall)) == 1 && $(step) < ${last}\" then \"quit 6\"\n";
  return text;
}

std::string lammps_job(const LammpsScript& s, int elements) {
  // Above, ghosts and messages take more than they spare (mdem/lammps/README.md, Scaling).
  const int fewest_of_a_rank = s.long_in_z ? 5000 : 20000, ranks = std::max(1, elements / fewest_of_a_rank);
  return fmt::format(
      "#!/bin/sh\n"
      "# For SLURM. Submit it once, from this directory: sbatch job.sh. A job whose time is over submits the next one,\n"
      "# which goes on from the last state. Then: ropewalk import .\n"
      "#SBATCH --job-name=ropewalk\n"
      "#SBATCH --ntasks={}\n"
      "#SBATCH --time=24:00:00\n"
      "#SBATCH --output=messages.txt\n"
      "#SBATCH --open-mode=append\n"
      "# Add --partition and --account as your cluster asks.\n"
      "from=rope.state\n"
      "[ -s lammps.states ] && from=lammps.states\n"
      "before=$(wc -c lammps.states 2> /dev/null)\n"
      "# Not every version of SLURM sets SLURM_JOB_END_TIME; squeue knows it.\n"
      "end=$SLURM_JOB_END_TIME told= wall=\n"
      "[ \"$end\" ] || told=$(squeue -h -j \"$SLURM_JOB_ID\" -o %e)\n"
      "case $told in *T*) end=$(date -d \"$told\" +%s) ;; esac\n"
      "if [ \"$end\" ]; then\n"
      "  # A part of the time stays for the last state and the next job.\n"
      "  left=$((end - $(date +%s)))\n"
      "  wall=\"-var wall $((left - left / 20))\"\n"
      "else\n"
      "  echo 'SLURM does not tell when this job ends: after its time, submit job.sh again'\n"
      "fi\n"
      "# Where the cluster names no way to start MPI: PMIx, which Open MPI needs under srun.\n"
      "if scontrol show config 2> /dev/null | grep -q '^MpiDefault *= none'; then\n"
      "  srun --mpi=list 2>&1 | grep -qw pmix && export SLURM_MPI_TYPE=\"${{SLURM_MPI_TYPE:-pmix}}\"\n"
      "fi\n"
      "srun lmp-ropewalk -in in.rope -var from $from $wall\n"
      "code=$?\n"
      "[ $code = 6 ] || exit $code\n"
      "[ \"$(wc -c lammps.states)\" != \"$before\" ] || {{ echo 'no step was taken: give the job more time'; exit 6; }}\n"
      "exec sbatch job.sh\n",
      ranks);
}

std::vector<LammpsRow> read_lammps_rows(const LammpsDirectory& dir, std::size_t terms) {
  std::vector<LammpsRow> rows;
  std::string title;
  for_each_line(read_file(dir.rows()), [&](int number, std::string_view line) {
    if (number == 1) title = line;
    if (number == 1 && title.rfind(row_title(static_cast<int>(terms)), 0) != 0)
      throw InputError({dir.rows(), number, ""}, "has another title than the rows of this export", "run LAMMPS again");
    // A run that goes on writes it again, perhaps behind a row that a kill has cut off.
    if (line.size() >= title.size() && line.substr(line.size() - title.size()) == title) return;
    LammpsRow r;
    r.terms.resize(terms);
    r.accounts.resize(terms);
    std::size_t column = 0;
    std::vector<double*> values = {&r.step, &r.time,    &r.stretch, &r.shear,      &r.bend, &r.twist,
                                   &r.vdw,  &r.kinetic, &r.work,    &r.dissipated, &r.heat};
    for (std::size_t k = 0; k < terms; ++k) {
      TermAccount& a = r.accounts[k];
      values.insert(values.end(), {&r.terms[k], &a.lost, &a.drag, &a.events, &a.begun});
    }
    for (double* value : values) {
      if (!take(line, *value))
        throw InputError({dir.rows(), number, ""}, "has fewer numbers than the title names",
                         "take the line out if LAMMPS was killed while it wrote it");
      if (!std::isfinite(*value))
        throw InputError({dir.rows(), number, column < row_columns.size() ? row_columns[column].name : "term"},
                         "is not finite", "run LAMMPS again");
      ++column;
    }
    if (!(r.step >= 0 && r.step < most_steps) || r.step != std::floor(r.step))
      throw InputError({dir.rows(), number, "step"}, fmt::format("{} is no step", r.step), "run LAMMPS again");
    rows.push_back(r);
  });
  return rows;
}

}  // namespace ropewalk
