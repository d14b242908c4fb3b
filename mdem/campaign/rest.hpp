// The state in which a rope comes to rest, approached from both sides: from a rope that is wound less and from one
// that is wound more. Only where both come to the same state is it one of rest.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "io/limits_file.hpp"
#include "observe/approach.hpp"
#include "plan/rest_theory.hpp"

namespace ropewalk {

// The two scenes as a sweep of [start] twist_deg_per_nm: a quarter of the winding of the compact state and half as
// much again as it, at most 20 degrees at the rim. `viscosity` (eV ps/nm^3), where it is not negative, is the
// contact viscosity of both: any value leads to a state of rest, and a lower one sooner until the rope swings.
std::string rest_sweep(const Scene& scene, const Prepared& prepared, const RestTheory& theory, double viscosity);

// Their windings, rad/nm: from below and from above.
std::array<double, 2> rest_starts(const Prepared& prepared, const RestTheory& theory);

// The end of one run. Means are over its last fifth.
struct RestSide {
  double start = 0;                      // deg/nm
  double twist = 0, drift = 0;           // geometric_twist_deg, and its slope (deg/ps)
  double moved = 0;                      // deg: between the least and the largest twist
  double beta = 0, least = 0, most = 0;  // beta_deg: mean, and where it swings
  double Q = 0, voids = 0;               // voids: nm^2
  double time = 0;                       // time at the end, ps
  Approach to_twist, to_beta;            // deg: where both are going
  RopeShape shape = RopeShape::straight;
  std::vector<LimitRecord> limits = {};  // that the run watched
  std::string branch() const;            // "compact", "compact with defects", "open (cage)"
};
RestSide rest_side(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits, double start);

// A value with its error, whose square is the sum of those of its parts.
struct RestValue {
  double value = 0;
  double start = 0;  // half of the difference of both sides
  double drift = 0;  // creep that is still to come (observe/approach.hpp): both sides' alike, since they creep together
  double statistics = 0;  // standard error by noise
  double error() const { return std::hypot(start, drift, statistics); }
};

struct RestVerdict {
  // rests: both sides are within `tolerance` of the twist that they go to, know it that well and agree within it,
  // on one branch. creeps: they agree on where they go to within its error, which is below a tenth of it, but are
  // not there. apart: they stand still at two values. several: they stand still on two branches.
  enum class Kind { rests, creeps, moves, apart, several };
  Kind kind = Kind::moves;
  bool agree() const { return kind == Kind::rests; }
  std::string words;        // one or two sentences
  RestValue twist, beta;    // deg; nan: neither `rests` nor `creeps`
  double further_time = 0;  // ps, time that a rope which `creeps` still needs to rest
};
RestVerdict rest_verdict(const std::array<RestSide, 2>& sides, double tolerance);
const char* name_of(RestVerdict::Kind kind);

// A sentence: sources of error that a verdict leaves out.
std::string left_out_of_rest();

// A sentence for each side that is beyond a limit of the model; none: no line.
std::vector<std::string> beyond_of(const std::array<RestSide, 2>& sides);

// A row for each side, and what the verdict says.
std::string rest_csv(const std::array<RestSide, 2>& sides);
std::string rest_json(const std::array<RestSide, 2>& sides, const RestVerdict& verdict, const RestTheory& theory,
                      double length);

}  // namespace ropewalk
