// The numbers that a scene takes from measurements, fits or the judgement of its author, with their standard errors
// where these are stated: those of its parameter sets, of the files of its drives, and of its own tables of
// properties (SceneTable::has_properties). There each may be written
//
//   strain = { value = 0.16, standard_error = 0.02 }     in the unit of the key
//
// What a scene asks for, lengths, loads and times, is exact. Nothing is listed by hand: a drive with force terms,
// and a file of a drive, is walked as it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace ropewalk {

struct InputNumber {
  enum class Of { set, file, scene };
  Of of = Of::scene;
  std::size_t index = 0;                 // of the set, or of the file among input_files()
  std::string key;                       // "bond.EA", "friction.strength", "links.1.stiffness_nN_per_nm"
  double value = 0;                      // value in the unit of its file
  std::optional<double> standard_error;  // none: not stated
  bool typed = true;                     // false: the default of a key that the scene leaves out
};

// In the order sets, files, scene. Of the sets all numbers are here, used or not.
std::vector<InputNumber> input_numbers(const Scene& scene);

// The files of the drives, each once.
std::vector<std::string> input_files(const Scene& scene);

}  // namespace ropewalk
