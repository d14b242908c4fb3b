// Elements from a CSV file: tube,x_nm,y_nm,z_nm,qw,qx,qy,qz and, where they move, velocities and spins; one element
// a line, those of a tube one after another along it, tubes numbered 0, 1, 2, ... in order. Empty lines and lines
// that start with # are skipped. The quaternion turns the element's own z into its tube axis. The line below the
// header, "# element_length_nm: 1.356", states the length of an element, and "# tube_types: 0,1,1" which of several
// parameter sets each tube has, "# strands_begin_with_tubes: 0,3" which tubes follow one another in line, and
// "# ropes_begin_with_strands: 0,7" which make a rope of their own; a file may leave them out. A tube that has
// broken stands there as two, and "# broken_behind_elements: 12" says where; it is read as the one tube that it
// was. "# elements_and_sum: 84, 5f0e..." is a sum (xxh64) over all numbers: a file that was cut or scaled is
// refused.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

std::vector<OutputColumn> state_columns();

// What the header of a state file says besides: a memory of force terms (scene/state_memory.hpp), and the elements
// behind which tubes have broken.
struct StateNotes {
  std::string memory;
  std::vector<int> broken;
};

// Fills tubes and state; all elements have the length of the first of topology.types. Throws InputError with file,
// line and column, also where the file states another length, more parameter sets or another sum, or states no sum
// and neighbours along a tube lie at another length.
void read_state_csv(const std::string& path, Topology& topology, State& state);

// The length (nm) that a state file states; 0 where it states none. Throws InputError.
double state_element_length(const std::string& path);

StateNotes read_state_notes(const std::string& path);

// The file, with velocities, in all digits. `topology`: cut where tubes have broken.
std::string state_csv(const Topology& topology, const State& state, const StateNotes& notes = {});

}  // namespace ropewalk
