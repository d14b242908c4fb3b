// Forces of one's own of a run: functions of Python, which no file of its directory holds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/drive.hpp"

namespace ropewalk {

struct OwnForceOfRun {
  std::string name;         // the name of its function, without commas and spaces
  bool has_energy = false;  // with one it is a force term, without one a load
  std::shared_ptr<const Drive> drive;
};

// "trap, pull (no energy)": what manifest and checkpoint keep of them. Empty: there are none.
std::string own_forces_in_words(const std::vector<OwnForceOfRun>& forces);

// Throws InputError where a state of the forces `before` cannot go on with those of `now`, both in words: they have
// to be as many, and the same ones have to give an energy. Their names may differ.
void refuse_other_forces(const std::string& before, const std::string& now, const std::string& directory);

}  // namespace ropewalk
