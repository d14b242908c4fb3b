// The pull in the log of a run: where it begins, where its stress is largest, and whether that is a strength.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/log.hpp"

namespace ropewalk {

// The pull is the last rise of the strain before the largest stress that began with a tenth of that stress or less,
// or at the strain at which the rope was held.
struct LoggedPull {
  std::size_t begin = 0, most = 0;  // rows
  double strength = 0;              // GPa, largest stress
  double strain = 0;                // since the pull began, at the largest stress
  double modulus = 0;               // GPa, slope of a straight line through the stress up to half of the largest
  // The largest stress is no strength, and why: the rope was not at rest when the pull began. Empty: it is one.
  std::string no_strength;
};

// Nothing: no stress pulls.
std::optional<LoggedPull> pull_of(const std::vector<LogRow>& log);

}  // namespace ropewalk
