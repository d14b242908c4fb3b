#include "scene/lammps_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "scene/build.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* start_format = "ropewalk-lammps-1";
constexpr const char* remedy = "export the run again with `ropewalk export`";

template <class S, class Visit>
void visit_start(S&& s, const Visit& v) {
  v({"step", "", "time step of the export"}, s.step);
  v({"time_ps", "ps", "time of the export"}, s.time);
  v({"time_step_ps", "ps", "time step"}, s.time_step);
  v({"work_eV", "eV", "work done by the loads so far"}, s.work);
  v({"dissipated_eV", "eV", "energy taken out by damping so far"}, s.dissipated);
  v({"viscosity_inner_nm", "nm", "distance up to which contact viscosity acts in full"}, s.viscosity_inner);
  v({"viscosity_outer_nm", "nm", "distance beyond which there is no contact viscosity"}, s.viscosity_outer);
  v({"parameters", "", "files of the parameter sets, by type of the tube"}, s.parameters);
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

// Without what is nothing and takes another digit of the exponent.
Vector3 readable(const Vector3& v) {
  return v.unaryExpr([](double x) { return std::fabs(x) < 1e-99 ? 0.0 : x; });
}

struct Box {
  Vector3 low, high;
};

Box box_of(const State& s, double margin) {
  Box box{s.position[0], s.position[0]};
  for (std::size_t i = 0; i < s.size(); ++i) {
    box.low = box.low.cwiseMin(s.position[i]);
    box.high = box.high.cwiseMax(s.position[i]);
  }
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
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
}};

constexpr std::array<OutputColumn, 20> state_columns = {{
    {"id", "", "element, from 1"},
    {"x", "nm", "centre of the element"},
    {"y", "nm", "centre of the element"},
    {"z", "nm", "centre of the element"},
    {"d2_quat[1]", "", "orientation, a unit quaternion: w"},
    {"d2_quat[2]", "", "orientation: x"},
    {"d2_quat[3]", "", "orientation: y"},
    {"d2_quat[4]", "", "orientation: z"},
    {"vx", "nm/ps", "velocity"},
    {"vy", "nm/ps", "velocity"},
    {"vz", "nm/ps", "velocity"},
    {"omegax", "rad/ps", "angular velocity"},
    {"omegay", "rad/ps", "angular velocity"},
    {"omegaz", "rad/ps", "angular velocity"},
    {"fx", "eV/nm", "force, damping included"},
    {"fy", "eV/nm", "force, damping included"},
    {"fz", "eV/nm", "force, damping included"},
    {"tqx", "eV", "torque, damping included"},
    {"tqy", "eV", "torque, damping included"},
    {"tqz", "eV", "torque, damping included"},
}};

constexpr double farthest = 1e12;    // of any number of a state, in its unit
constexpr double norm_slack = 1e-6;  // of a quaternion
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
std::vector<OutputColumn> lammps_state_columns() { return listed(state_columns); }

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
      throw InputError({path, 0, "format"}, fmt::format("\"{}\" is needed", start_format), remedy);
    visit_start(start, [&](const OutputColumn& key, auto& value) { json.at(key.name).get_to(value); });
  } catch (const Json::exception&) {
    throw InputError({path, 0, ""}, "is damaged", remedy);
  }
  for (const double value :
       {start.time, start.time_step, start.work, start.dissipated, start.viscosity_inner, start.viscosity_outer})
    if (!std::isfinite(value)) throw InputError({path, 0, ""}, "holds a number that is not finite", remedy);
  for (const std::string& name : start.parameters)
    if (has_control_character(name) || name.find('/') != std::string::npos)
      throw InputError({path, 0, "parameters"},
                       fmt::format("\"{}\" is no file of this directory", printable(name, 40)), remedy);
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
      throw InputError({path, number, ""}, fmt::format("no line of {}", column_names(tube_columns)), remedy);
    const double total = topology.elements() + double{1} * tubes * elements;
    if (total > max_elements)
      throw InputError({path, number, ""}, fmt::format("makes it {:.3g} elements", total), remedy);
    for (int t = 0; t < tubes; ++t) topology.add_tube(elements, type);
  });
  if (topology.tubes() == 0) throw InputError({path, 0, ""}, "holds no tube", remedy);
}

std::string lammps_data(const std::string& name, const Topology& topology, const State& s, const Vec3Array& force,
                        const Vec3Array& torque) {
  // LAMMPS lets the box grow with the elements, never below this one, which a single straight tube needs.
  const Box box = box_of(s, 1.0);
  std::string text = fmt::format(
      "{}: elements of nanotubes in nm, eV and ps, written by ropewalk\n\n{} atoms\n{} bonds\n{} atom types\n"
      "{} bond types\n\n{} {} xlo xhi\n{} {} ylo yhi\n{} {} zlo zhi\n\nAtoms # hybrid\n\n",
      lammps_comment(name), topology.elements(), topology.bonds(), topology.types.size(), topology.types.size(),
      box.low.x(), box.high.x(), box.low.y(), box.high.y(), box.low.z(), box.high.z());
  std::string velocities = "\nVelocities\n\n", bonds = "\nBonds\n\n", turns = "\nElements\n\n";
  int bond = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    const int kind = topology.tube_type[t] + 1;
    // LAMMPS wants a density; our styles take the mass from the parameter set and check that this agrees.
    const double density = type.mass / (4.0 / 3.0 * units::pi * type.radius * type.radius * type.radius);
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Vector3 x = s.position[i], v = s.velocity[i], w = s.angular_velocity[i];
      const Quaternion q = s.orientation[i];
      text += fmt::format("{} {} {} {} {} {} {} {}\n", e + 1, kind, x.x(), x.y(), x.z(), 2 * type.radius, density,
                          t + 1);
      velocities += fmt::format("{} {} {} {} {} {} {}\n", e + 1, v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
      // Of a line LAMMPS reads no more than 255 characters; these have 247 at most.
      const Vector3 f = readable(force[i]), m = readable(torque[i]);
      turns += fmt::format("{} {} {} {} {} {} {} {} {} {} {}\n", e + 1, q.w(), q.x(), q.y(), q.z(), f.x(), f.y(),
                           f.z(), m.x(), m.y(), m.z());
      if (e + 1 < topology.tube_begin[t + 1]) bonds += fmt::format("{} {} {} {}\n", ++bond, kind, e + 1, e + 2);
    }
  }
  return text + velocities + (bond > 0 ? bonds : "") + turns;
}

namespace {

// The numbers of fix `motion` under names, with all their digits.
std::string row_variables() {
  const std::array<const char*, lammps_row_numbers> names = {"time", "stretch", "shear", "bend",      "twist",
                                                             "vdw",  "kinetic", "work",  "dissipated"};
  std::string text = "variable now equal step\nvariable step format now %.0f\n";
  for (std::size_t k = 0; k < names.size(); ++k) {
    text +=
        fmt::format("variable {0}_now equal f_motion[{1}]\nvariable {0} format {0}_now %.17g\n", names[k], k + 1);
  }
  return text;
}

std::string pair_line(const LammpsScript& s) {
  if (s.law == "none") return fmt::format("pair_style zero {} nocoeff", s.reach);
  return fmt::format("pair_style mdem/{} ${{dir}} ${{forces}}", s.law);
}

}  // namespace

std::string lammps_input(const LammpsScript& s) {
  // LAMMPS leaves out neighbours along a chain by 1, 2 and 3 bonds; the model says up to how many.
  const auto weight = [&](int bonds) { return bonds <= s.excluded_elements ? 0 : 1; };
  std::string text = fmt::format(
      "# {}. Run with lmp-ropewalk. Units are nm, ps and eV, in which LAMMPS's \"lj\" has all factors 1.\n"
      "# On the command line: -var steps N, -var restart FILE (to go on from a restart file), -var forces plain "
      "(pair\n"
      "# by pair, slowly, as a check).\n"
      "variable dir index .\n"
      "variable forces index engine\n"
      "variable again equal is_defined(variable,restart)\n"
      "variable steps index {}\n"
      "variable every index {}\n"
      "units lj\n"
      "atom_style hybrid sphere bond\n"
      "boundary m m m\n"
      "newton on\n"
      "special_bonds lj/coul {} {} {}\n"
      "comm_modify mode single vel yes cutoff {}\n",
      lammps_comment(s.name), s.steps, s.every, weight(1), weight(2), weight(3), s.reach + s.skin);
  text += s.long_in_z ? "processors 1 1 *  # ropes lie along z: every cut is across them\n" : "comm_style tiled\n";
  text += fmt::format(
      "{0}\n"
      "if \"${{again}} == 0\" then &\n"
      "  \"fix elements all property/atom d2_quat 4 d2_carried 6 ghost yes\" &\n"
      "  \"read_data ${{dir}}/rope.data fix elements NULL Elements\" &\n"
      "  \"reset_timestep {1}\" &\n"
      "  \"variable open index file\" &\n"
      "  \"variable grow index no\" &\n"
      "else &\n"
      "  \"read_restart ${{restart}}\" &\n"
      "  \"fix elements all property/atom d2_quat 4 d2_carried 6 ghost yes\" &\n"
      "  \"variable open index append\" &\n"
      "  \"variable grow index yes\"\n"
      "{0}\n"
      "pair_coeff * *\n"
      "bond_style mdem/vbond ${{dir}}\n"
      "bond_coeff *\n"
      "neighbor {2} bin\n"
      "neigh_modify every 1 delay 0 check yes\n"
      "timestep {3}\n",
      pair_line(s), s.step, s.skin, s.time_step);
  if (s.damped) text += "fix damping all mdem/damp\n";
  if (s.driven) text += "fix grips all mdem/grip\n";
  text += fmt::format("fix motion all mdem/{}\n", s.relax ? "relax" : "nve");
  if (!s.long_in_z) text += "balance 1.05 rcb\nfix even all balance 1000 1.05 rcb\n";
  text += row_variables();
  text += fmt::format(
      "fix rows all print ${{every}} \"{0}\" ${{open}} ${{dir}}/lammps-rows.csv screen no title \"{1}\"\n"
      "dump states all custom ${{every}} ${{dir}}/lammps.dump id x y z d2_quat[1] d2_quat[2] d2_quat[3] d2_quat[4] "
      "&\n"
      "  vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz\n"
      "dump_modify states append ${{grow}} format float %.17g\n"
      "thermo_style custom step f_motion[1] f_motion[4] f_motion[5] f_motion[6] f_motion[7] pe\n"
      "thermo_modify norm no lost error\n"
      "thermo ${{every}}\n"
      "restart ${{every}} ${{dir}}/rope.restart.a ${{dir}}/rope.restart.b\n"
      "run ${{steps}}\n"
      "write_dump all custom ${{dir}}/lammps-last.dump id x y z d2_quat[1] d2_quat[2] d2_quat[3] d2_quat[4] &\n"
      "  vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz modify format float %.17g\n"
      "unfix rows\n"
      "print \"{0}\" append ${{dir}}/lammps-rows.csv screen no\n",
      "${step},${time},${stretch},${shear},${bend},${twist},${vdw},${kinetic},${work},${dissipated}",
      column_names(row_columns));
  return text;
}

std::vector<LammpsRow> read_lammps_rows(const LammpsDirectory& dir) {
  std::vector<LammpsRow> rows;
  std::string title;
  for_each_line(read_file(dir.rows()), [&](int number, std::string_view line) {
    if (number == 1) title = line;
    if (line == title) return;  // a restarted run writes it again
    LammpsRow r;
    std::size_t column = 0;
    for (double* value :
         {&r.step, &r.time, &r.stretch, &r.shear, &r.bend, &r.twist, &r.vdw, &r.kinetic, &r.work, &r.dissipated}) {
      if (!take(line, *value))
        throw InputError({dir.rows(), number, ""}, "has fewer numbers than the title names",
                         "take the line out if LAMMPS was killed while it wrote it");
      if (!std::isfinite(*value))
        throw InputError({dir.rows(), number, row_columns[column].name}, "is not finite", "run LAMMPS again");
      ++column;
    }
    if (!(r.step >= 0 && r.step < most_steps) || r.step != std::floor(r.step))
      throw InputError({dir.rows(), number, "step"}, fmt::format("{} is no step", r.step), "run LAMMPS again");
    rows.push_back(r);
  });
  return rows;
}

LammpsStates::LammpsStates(const std::string& path) : path_(path) {
  refuse_devices(path);
  file_.open(path);
  if (!file_) throw file_error(path, "cannot be opened", errno);
}

bool LammpsStates::line() {
  ++line_;
  return static_cast<bool>(std::getline(file_, text_)) && !file_.eof();
}

void LammpsStates::fail(const std::string& what) const {
  throw InputError({path_, static_cast<int>(line_), ""}, what, "was it written by the in.rope of this export?");
}

// Of every column of the file, which of ours it is, or -1.
std::vector<int> LammpsStates::columns() {
  constexpr std::string_view title = "ITEM: ATOMS";
  if (text_.compare(0, title.size(), title) != 0) fail("a list of elements is needed here");
  std::string_view rest = std::string_view(text_).substr(title.size());
  std::vector<int> out;
  std::size_t found = 0;
  while (true) {
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    if (rest.empty()) break;
    const std::string_view name = rest.substr(0, rest.find(' '));
    rest.remove_prefix(name.size());
    int which = -1;
    for (std::size_t k = 0; k < state_columns.size(); ++k)
      if (name == state_columns[k].name) which = static_cast<int>(k);
    found += which >= 0;
    out.push_back(which);
  }
  if (found != state_columns.size()) fail("columns of the state are missing");
  return out;
}

// Returns the element, its numbers in `values`: finite ones, and of the orientation a unit quaternion, since LAMMPS
// writes all digits.
std::size_t LammpsStates::element(const std::vector<int>& columns, std::array<double, 20>& values) const {
  std::string_view rest = text_;
  for (const int column : columns) {
    double value = 0;
    if (!take(rest, value)) fail("has fewer numbers than columns");
    if (column < 0) continue;
    const auto k = static_cast<std::size_t>(column);
    if (!(std::fabs(value) <= farthest)) fail(fmt::format("{} is {}", state_columns[k].name, value));
    values[k] = value;
  }
  if (!(values[0] >= 1) || values[0] != std::floor(values[0])) fail("has no element's number");
  const double norm = Quaternion(values[4], values[5], values[6], values[7]).norm();
  if (!(std::fabs(norm - 1) <= norm_slack))
    fail(fmt::format("the quaternion d2_quat has length {:.6g}, not 1", norm));
  return static_cast<std::size_t>(values[0]) - 1;
}

bool LammpsStates::next(const Topology& topology, State& s, Vec3Array& force, Vec3Array& torque) {
  s = State(static_cast<std::size_t>(topology.elements()));
  force = torque = Vec3Array(s.size());
  std::int64_t count = 0;
  const auto number = [&](const char* title, std::int64_t& value) {
    if (!line()) return false;
    if (text_ != std::string("ITEM: ") + title) fail(fmt::format("\"ITEM: {}\" is needed here", title));
    if (!line()) return false;
    std::string_view rest = text_;
    if (!take(rest, value)) fail("a number is needed here");
    return true;
  };
  if (!number("TIMESTEP", s.step) || !number("NUMBER OF ATOMS", count)) return false;
  if (count != topology.elements())
    fail(fmt::format("{} elements are here, {} in the scene", count, topology.elements()));
  for (int k = 0; k < 5; ++k)
    if (!line()) return false;  // four lines of the box, and the columns
  const std::vector<int> which = columns();
  std::vector<bool> seen(s.size());
  for (std::int64_t k = 0; k < count; ++k) {
    if (!line()) return false;
    std::array<double, 20> v{};
    const std::size_t i = element(which, v);
    if (i >= s.size() || seen[i]) fail(fmt::format("has no place for element {}", i + 1));
    seen[i] = true;
    s.position.set(i, {v[1], v[2], v[3]});
    s.orientation.set(i, {v[4], v[5], v[6], v[7]});
    s.velocity.set(i, {v[8], v[9], v[10]});
    s.angular_velocity.set(i, {v[11], v[12], v[13]});
    force.set(i, {v[14], v[15], v[16]});
    torque.set(i, {v[17], v[18], v[19]});
  }
  return true;
}

}  // namespace ropewalk
