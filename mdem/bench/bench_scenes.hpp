// The scenes that `bench` knows by name, so that figures of different days and machines are of the same thing.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace ropewalk {

struct BenchScene {
  std::string name;
  std::string description;
  std::string source;  // table of what there is, with {} for the lengths that go with the set
  int elements = 0;    // of a tube
  // The rest: from 300 K, or what goes on until it is worth measuring, after so many ps.
  std::string motion = "[start]\ntemperature_K = 300\n[run]\nduration_ps = 100\n";
  double after = 0;
};

const std::vector<BenchScene>& bench_scenes();

// From when on to measure a scene of that name, ps; 0 for a file.
double bench_after(const std::string& name);

// A scene of that name, or that of a file. `law` is "line", "paper" or empty: "line", or the file's.
Scene bench_scene(const std::string& name, const std::string& law);

}  // namespace ropewalk
