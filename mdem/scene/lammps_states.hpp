// The binary files of states that `ropewalk export` and `lmp-ropewalk` exchange: rope.state, where LAMMPS begins,
// and lammps.states, what it writes. A state is a header of 104 bytes and a record of 152 bytes for each element, in
// the order of the scene, then the memories of the force terms (ForceTerms::memory()), if any; all numbers
// little-endian. Every process so knows where an element's record is, and many
// of them read or write one file at once.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/dynamics/step_control.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Written last: a state that a kill has cut off has zeros here.
inline constexpr std::array<char, 8> state_mark = {'R', 'W', 'S', 'T', 'A', 'T', 'E', '4'};

struct StateHeader {
  std::array<char, 8> mark = state_mark;
  std::int64_t step = 0, elements = 0;
  double time = 0;                  // ps
  double work = 0, dissipated = 0;  // eV
  double heat = 0;                  // heat from the thermostat, eV
  double skin = 0;                  // skin of the neighbour list, nm; 0: there was no list
  std::int64_t memory = 0;          // numbers behind the records, of the force terms
  // Into how many parts steps are divided, and StepControl's numbers.
  std::int64_t divided = 1, kept_until = 0, keep = StepControl::least_keep;
  std::uint64_t of_export = 0;  // LammpsStart::id

  void set(int parts, const StepControl& control) {
    divided = parts, kept_until = control.kept_until, keep = control.keep;
  }
  StepControl control() const { return {kept_until, keep, 0}; }
};
static_assert(sizeof(StateHeader) == 104, "this is the format of the file");

// One element of a state: position, orientation, velocity, angular velocity, force and torque, as
// lammps_state_columns() lists their components.
using StateRecord = std::array<double, 19>;
static_assert(sizeof(StateRecord) == 152, "this is the format of the file");

struct StateInFile {
  StateHeader header;
  std::int64_t at = 0;  // byte of the file

  std::int64_t record(std::int64_t element) const {
    return at + static_cast<std::int64_t>(sizeof(StateHeader)) +
           element * static_cast<std::int64_t>(sizeof(StateRecord));
  }
  std::int64_t end() const { return record(header.elements) + header.memory * std::int64_t{sizeof(double)}; }
};

std::vector<OutputColumn> lammps_state_columns();

// The states of a file that are whole, in the order of the file. Throws InputError for other files, and for states of
// another export than this one; without `of_export` those of any export count.
std::vector<StateInFile> find_states(const std::string& path, std::int64_t elements,
                                     std::optional<std::uint64_t> of_export = std::nullopt);
// The last one. Throws InputError where there is none.
StateInFile last_state(const std::string& path, std::int64_t elements,
                       std::optional<std::uint64_t> of_export = std::nullopt);

// Names the fault of a record that LAMMPS cannot have written: numbers that are not finite, or no unit quaternion.
// Empty: none.
std::string complaint_about(const StateRecord& record);

// A file of one state. The total forces of the last step go along: they hold the damping at half-step velocities,
// which a state does not tell, and the first kick needs them.
std::string state_file(StateHeader header, const State& state, const Vec3Array& force, const Vec3Array& torque,
                       const std::vector<double>& memory = {});

// The memories of the force terms behind a state.
std::vector<double> memory_in(const std::string& path, const StateInFile& state);

// Reads the states of a file one after another; one that is cut off is left out.
class LammpsStates {
 public:
  LammpsStates(const std::string& path, const Topology& topology,
               std::optional<std::uint64_t> of_export = std::nullopt);
  // False at the end.
  bool next(State& state, Vec3Array& force, Vec3Array& torque);
  // The memories of the force terms in the last state that was read.
  const std::vector<double>& memory() const { return memory_; }
  // The header of the last state that was read.
  const StateHeader& header() const { return all_[next_ - 1].header; }

 private:
  std::string path_;
  std::vector<StateInFile> all_;
  std::size_t next_ = 0;
  std::vector<double> memory_;
  std::ifstream file_;
};

}  // namespace ropewalk
