// The scenes that `bench` knows by name, so that results of different days and machines can be compared.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace ropewalk {

struct BenchScene {
  std::string name;
  std::string description;
  std::string source;  // the table [rope], [film] or [chain]
  int elements = 0;    // of a tube; 0: `source` has the length
  // The other tables. Measuring begins after `after` ps.
  std::string motion = "[start]\ntemperature_K = 300\nmay_cool = true\n[run]\nduration_ps = 100\n";
  double after = 0;
};

const std::vector<BenchScene>& bench_scenes();

// Time (ps) at which measuring begins in a scene of this name; 0 for a file.
double bench_after(const std::string& name);

// The text of the scene of this name; empty for a file.
std::string bench_scene_text(const std::string& name, const std::string& law);

// The scene of this name, or of this file. `law` is "line", "paper" or empty; empty means "line", or the file's
// law.
Scene bench_scene(const std::string& name, const std::string& law);

}  // namespace ropewalk
