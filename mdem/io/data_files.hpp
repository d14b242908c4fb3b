// The files that are shipped with the program.
#pragma once

#include <string>
#include <vector>

#include "model/error.hpp"

namespace ropewalk {

// The folder of the shipped sets and scenes: the environment variable ROPEWALK_DATA, else what
// set_data_directory() said, else share/ropewalk beside the program's bin, else what add_data_directory() named,
// else what the build was given as ROPEWALK_DATA_DIR, the source tree's data/.
std::string data_directory();
// For libraries in a program that is not ours.
void set_data_directory(const std::string& folder);
// To be called before main() begins, for a static variable: the data of installed libraries
// (cmake/installed_data.cpp).
bool add_data_directory(const char* folder);

// Names of the shipped parameter sets, in order.
std::vector<std::string> shipped_sets(const std::string& data = data_directory());

// The file of a parameter set: `name` as a file in `folder` (empty: the current one), then as the name of a
// shipped set. Throws InputError at `place` if there is neither.
std::string find_parameters(const std::string& name, const std::string& folder,
                            const InputError::Place& place = {"", 0, "--parameters"},
                            const std::string& data = data_directory());

}  // namespace ropewalk
