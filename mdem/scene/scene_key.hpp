// A key of a scene file, and a table, as help, templates and refinement know them.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace ropewalk {

struct SceneKey {
  std::string table = {};
  std::string key;
  std::string unit;      // empty: none
  std::string value;     // the default as TOML, or an example of one
  std::string standard;  // what holds where the key is missing, in words; empty: `value`
  std::string meaning;
  // For scenes with elements of another length: the value goes as this power of it, up to `most`.
  int length_power = 0;
  double most = std::numeric_limits<double>::infinity();
  bool whole = false;   // an integer, rounded up
  bool number = false;  // a single number with any digits
  // "all", "ends" or a list of elements. A key of the same table that goes as the length of an element is what each
  // of them takes of a whole, which matters for "all" alone: the others stay where they are.
  bool numbers_elements = false;
  bool counts_held = false;  // elements at an end of a tube that are held as one, between the same two places
  // For the same scene done more slowly (scene/slower.hpp): a time goes as the duration, a rate as its inverse. A
  // course has times in its points, or a rate beside them.
  enum class Pace { none, time, rate, course };
  Pace pace = Pace::none;
  // Whether it is the size of every tube of the scene.
  enum class TubeSize { no, length, elements };
  TubeSize tube_size = TubeSize::no;

  bool required() const { return standard == "required"; }
};

struct SceneTable {
  std::string name;  // empty: the top of the file
  std::string meaning;
  std::vector<SceneKey> keys;
  bool listed = false;  // [[name]], any number of them
  // Its numbers are properties of the tubes, measured or assumed, that may have a standard error
  // (input_numbers.hpp). In other tables they are what the user asks for.
  bool has_properties = false;

  std::string header() const { return listed ? "[[" + name + "]]" : "[" + name + "]"; }
  // Whether the whole table may be left out.
  bool optional() const;
};

}  // namespace ropewalk
