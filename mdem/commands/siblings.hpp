// `ropewalk calibrate ...` hands over to the program ropewalk-calibrate, as git does with its own.
#pragma once

#include <string>

namespace ropewalk {

// A program of this build: beside this one, as installed; in `folder` below or beside its own, as built; else on
// the PATH.
std::string find_program(const std::string& folder, const std::string& name);

// The path of this program, for scripts that start it again: it may be one with kinds of its own.
std::string this_program();

// Becomes the sibling that argv[1] names; returns if it names none. Throws InputError where it is not to be found.
void hand_over_to_sibling(char** argv);

}  // namespace ropewalk
