// Whether a state at rest is stable: the fastest growth of a small motion, by the modes of its tangent
// (sim/dynamics/modes.hpp), which hold under loads without a potential as well.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct Stability {
  double growth = 0;   // 1/ps: the largest real part of a rate; negative: all motions decay
  double neutral = 0;  // 1/ps: smaller ones cannot be told from zero
  bool stable() const { return growth <= neutral; }
};

// Returns nothing, and the reason in `why`, where the modes are not those of the constraints, a term has no
// tangent, the decomposition would take more than `most_operations`, or no eigenvalue was found.
std::optional<Stability> stability_of(const Simulation& simulation, double most_operations, std::string& why);
// Above which judge_stability() does without the modes.
inline constexpr double affordable_operations = 1e11;

// What is known of a state at which Newton's method has come to rest.
struct Statics;
struct StabilityVerdict {
  enum class Kind { stable, unstable, unknown };
  Kind kind = Kind::unknown;
  double growth = std::numeric_limits<double>::quiet_NaN();  // growth rate of the fastest motion, 1/ps; NaN: not known
  double error = std::numeric_limits<double>::quiet_NaN();   // 1/ps: smaller rates cannot be told from zero
  std::string why = {};                                      // it is unknown

  std::string words() const;  // a clause
};
// Judges by the rates of the modes where these cost little. Else, where forces have a potential, Newton's method
// looks for a motion of negative curvature. Pivots or quotients of the tangent do not tell under couples.
StabilityVerdict judge_stability(const Simulation& simulation, const Statics& end);

}  // namespace ropewalk
