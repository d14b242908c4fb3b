#include "scene/lammps_states.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr std::array<OutputColumn, std::tuple_size<StateRecord>::value> record_columns = {{
    {"x", "nm", "centre of the element"},
    {"y", "nm", "centre of the element"},
    {"z", "nm", "centre of the element"},
    {"qw", "", "orientation, a unit quaternion"},
    {"qx", "", "orientation"},
    {"qy", "", "orientation"},
    {"qz", "", "orientation"},
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

constexpr double largest_number = 1e12;    // limit of any number of a state, in its unit
constexpr double quaternion_slack = 1e-6;  // allowed deviation of a quaternion's norm from 1
constexpr std::int64_t largest_step = 1000000000000000;
constexpr const char* ask_for_export = "was it written by the in.rope of this export?";

template <class T>
bool read(std::ifstream& file, T& value) {
  return static_cast<bool>(file.read(reinterpret_cast<char*>(&value), sizeof value));
}

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::vector<OutputColumn> lammps_state_columns() { return {record_columns.begin(), record_columns.end()}; }

std::vector<StateInFile> find_states(const std::string& path, std::int64_t elements,
                                     std::optional<std::uint64_t> of_export) {
  std::ifstream file = opened_stream(path);
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  std::vector<StateInFile> found;
  const auto fail = [&](const std::string& what) {
    throw InputError({path, 0, ""}, fmt::format("state {}: {}", found.size() + 1, what), ask_for_export);
  };
  for (StateInFile s; file.seekg(s.at) && read(file, s.header); s.at = s.end()) {
    const StateHeader& h = s.header;
    if (h.mark == std::array<char, 8>{}) break;
    if (h.mark != state_mark) fail("does not begin as a state does");
    if (h.elements != elements) fail(fmt::format("{} elements are here, {} in the scene", h.elements, elements));
    if (of_export && h.of_export != *of_export) fail("is of another export");
    if (h.memory < 0 || h.memory > bytes) fail(fmt::format("{} numbers of memory", h.memory));
    for (const std::int64_t step : {h.step, h.kept_until, h.keep})
      if (step < 0 || step > largest_step) fail(fmt::format("{} is no step", step));
    if (h.divided < 1 || h.divided > StepControl::most) fail(fmt::format("a step in {} parts", h.divided));
    for (const double value : {h.time, h.work, h.dissipated, h.heat, h.skin})
      if (!(std::fabs(value) <= largest_number)) fail("holds a number that is not finite");
    if (s.end() > bytes) break;
    found.push_back(s);
  }
  return found;
}

StateInFile last_state(const std::string& path, std::int64_t elements, std::optional<std::uint64_t> of_export) {
  const std::vector<StateInFile> all = find_states(path, elements, of_export);
  if (all.empty()) throw InputError({path, 0, ""}, "holds no whole state", ask_for_export);
  return all.back();
}

std::string complaint_about(const StateRecord& record) {
  for (std::size_t k = 0; k < record.size(); ++k)
    if (!(std::fabs(record[k]) <= largest_number))
      return fmt::format("{} is {}", record_columns[k].name, record[k]);
  const double norm = Quaternion(record[3], record[4], record[5], record[6]).norm();
  if (!(std::fabs(norm - 1) <= quaternion_slack))
    return fmt::format("the quaternion has length {:.6g}, not 1", norm);
  return "";
}

std::string state_file(StateHeader header, const State& s, const Vec3Array& force, const Vec3Array& torque,
                       const std::vector<double>& memory) {
  std::string bytes;
  header.memory = static_cast<std::int64_t>(memory.size());
  bytes.reserve(sizeof header + s.size() * sizeof(StateRecord));
  append(bytes, header);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Vector3 x = s.position[i], v = s.velocity[i], w = s.angular_velocity[i], f = force[i], m = torque[i];
    const Quaternion q = s.orientation[i];
    append(bytes, StateRecord{x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(),
                              w.z(), f.x(), f.y(), f.z(), m.x(), m.y(), m.z()});
  }
  for (const double number : memory) append(bytes, number);
  return bytes;
}

std::vector<double> memory_in(const std::string& path, const StateInFile& state) {
  std::ifstream file = opened_stream(path);
  file.seekg(state.record(state.header.elements));
  std::vector<double> memory(static_cast<std::size_t>(state.header.memory));
  for (double& number : memory) {
    if (!read(file, number)) throw file_error(path, "cannot be read", EIO);
    if (!(std::fabs(number) <= largest_number))
      throw InputError({path, 0, ""}, "holds a number that is not finite in the memory of a force term",
                       ask_for_export);
  }
  return memory;
}

LammpsStates::LammpsStates(const std::string& path, const Topology& topology,
                           std::optional<std::uint64_t> of_export)
    : path_(path), all_(find_states(path, topology.elements(), of_export)), file_(opened_stream(path)) {}

bool LammpsStates::next(State& s, Vec3Array& force, Vec3Array& torque) {
  if (next_ == all_.size()) return false;
  const StateInFile& from = all_[next_++];
  const auto elements = static_cast<std::size_t>(from.header.elements);
  s = State(elements);
  force = torque = Vec3Array(elements);
  s.step = from.header.step;
  s.time = from.header.time;
  file_.seekg(from.record(0));
  for (std::size_t i = 0; i < elements; ++i) {
    StateRecord r;
    if (!read(file_, r)) throw file_error(path_, "cannot be read", EIO);
    const std::string wrong = complaint_about(r);
    if (!wrong.empty())
      throw InputError({path_, 0, ""}, fmt::format("state of step {}, element {}: {}", s.step, i, wrong),
                       ask_for_export);
    s.position.set(i, {r[0], r[1], r[2]});
    s.orientation.set(i, {r[3], r[4], r[5], r[6]});
    s.velocity.set(i, {r[7], r[8], r[9]});
    s.angular_velocity.set(i, {r[10], r[11], r[12]});
    force.set(i, {r[13], r[14], r[15]});
    torque.set(i, {r[16], r[17], r[18]});
  }
  memory_ = memory_in(path_, from);
  return true;
}

}  // namespace ropewalk
