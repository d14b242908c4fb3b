// What force terms remember of a state: the slips of friction, links, the tethers' lengths. It lies in a file
// beside the state file, whose header names it:
//
//   # memory: final-memory.csv of friction, links
//
// Each line of that file is a record: the name of its term, which one of that name, the element that it belongs to,
// and the numbers, with spaces between. A sum over the rows of the state ties both files to each other. Where tubes
// have broken the header of the state file itself says: "# broken_behind_elements: 12,57".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/forces/force_term.hpp"

namespace ropewalk {

// The beginning of a state file's name with "-memory.csv" behind it.
std::string memory_path_of(const std::string& state_path);
// The file, of the memories of terms in a scene's order and of a state file's text.
std::string state_memory_text(const std::vector<NamedMemory>& memories, const std::string& state);

// What a state file says of it.
struct StateMemory {
  std::string state_path, path;    // path: of the memory; empty: the header names none
  std::vector<std::string> names;  // names of the terms in the header
  bool missing = false;            // the file that the header names
  std::vector<NamedMemory> terms;
  std::vector<int> broken;    // elements behind which tubes have broken
  std::uint64_t lineage = 0;  // lineage of the rows

  bool has(const std::string& term) const;
};
// `path`: where the memory lies; empty: beside the state file, under the name in its header. Throws InputError.
StateMemory read_state_memory(const std::string& state_path, const std::string& path = "");

}  // namespace ropewalk
