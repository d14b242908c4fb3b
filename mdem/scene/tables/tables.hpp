// The tables of a scene that are neither a kind (scene/kinds/) nor a drive (scene/drive.hpp), each in a file of its
// own. A new one needs a struct in scene.hpp, its file here, a line in scene_keys.cpp and one in scene_toml.cpp.
#pragma once

#include <string>
#include <vector>

#include "scene/bounds.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"

namespace ropewalk {

// `copies`: files to be read in the place of the sets that the scene names, where there are any.
KeyTable<Scene> top_table(const std::vector<std::string>& copies);
const KeyTable<StartOptions>& start_table();
const KeyTable<BondOptions>& bond_table();
const KeyTable<ContactOptions>& contact_table();
const KeyTable<Damping>& damping_table();
const KeyTable<RunOptions>& run_table();
const KeyTable<StaticsOptions>& statics_table();
const KeyTable<ObserveOptions>& observe_table();
const KeyTable<LimitOptions>& limits_table();
const KeyTable<StopRule>& stop_table();
const KeyTable<Expectation>& expect_table();

}  // namespace ropewalk
