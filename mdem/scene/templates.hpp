// The commented scenes that `ropewalk new` writes.
#pragma once

#include <string>
#include <vector>

namespace ropewalk {

struct SceneTemplate {
  std::string name;
  std::string description;  // one line
  std::string dissipation;  // what takes energy out, and why; empty where nothing does, or no tubes touch
  std::string text;         // TOML; every key with unit, meaning and default
  std::string brief;        // the keys that it sets, alone, and nothing that it expects
};

const std::vector<SceneTemplate>& scene_templates();

}  // namespace ropewalk
