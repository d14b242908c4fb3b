// Differences between the inputs a run was begun with and those it would go on with.
#pragma once

#include <string>
#include <vector>

#include "run/run_checkpoint.hpp"

namespace ropewalk {

// The keys of two scenes with different values, as "twist.hold_ps: 10 -> 20"; comments and order do not count.
// Throws InputError where one is not TOML; `file` names it.
struct KeyChange {
  std::string key, words;
};
std::vector<KeyChange> changed_keys(const std::string& before, const std::string& now, const std::string& file);

// A sentence each. `harmless`: the motion up to here would have been the same, as with a longer hold, other limits
// or other outputs.
struct OriginChanges {
  std::vector<std::string> harmless, others;
};
OriginChanges changes_of(const RunOrigin& before, const RunOrigin& now, const RunDirectory& dir);

// The changes as remarks. Throws InputError where there are others than harmless ones and they are not `accepted`.
std::vector<std::string> judged_changes(const OriginChanges& changes, bool accepted, const RunDirectory& dir);

}  // namespace ropewalk
