// The state in which a rope comes to rest, approached from both sides: from a rope that is wound less and from one
// that is wound more. Only where both come to the same state is it one of rest.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "plan/rest_theory.hpp"

namespace ropewalk {

// The two scenes as a sweep of [start] twist_deg_per_nm: a quarter of the winding of the compact state and half as
// much again as it, at most 20 degrees at the rim. `viscosity` (eV ps/nm^3), where it is not negative, is the
// contact viscosity of both: any value leads to a state of rest, and a lower one sooner until the rope swings.
std::string rest_sweep(const Scene& scene, const Prepared& prepared, const RestTheory& theory, double viscosity);

// Means over the last fifth of a run.
struct RestSide {
  double start = 0;                      // deg/nm
  double twist = 0, drift = 0;           // geometric_twist_deg, and its slope (deg/ps)
  double moved = 0;                      // deg: between the least and the largest twist
  double beta = 0, least = 0, most = 0;  // beta_deg: mean, and where it swings
  double Q = 0, voids = 0;               // voids: nm^2
  double time = 0;                       // ps, at the end
  RopeShape shape = RopeShape::straight;
  std::string branch() const;  // "compact", "compact with defects", "open (cage)"
};
RestSide rest_side(const std::vector<LogRow>& log, double start);

struct RestVerdict {
  // Both stand still within twice `tolerance` of the twist, on the same branch, and within `tolerance` of their
  // mean.
  bool agree = false;
  std::string words;  // one or two sentences
  double twist = 0, twist_error = 0, beta = 0,
         beta_error = 0;  // deg; half of the difference; nan: they do not agree
};
RestVerdict rest_verdict(const std::array<RestSide, 2>& sides, double tolerance);

// A row for each side, and what the verdict says.
std::string rest_csv(const std::array<RestSide, 2>& sides);
std::string rest_json(const std::array<RestSide, 2>& sides, const RestVerdict& verdict, const RestTheory& theory,
                      double length);

}  // namespace ropewalk
