#include "run/equilibrium_of.hpp"

#include "sim/statics/newton.hpp"
#include "sim/statics/stability.hpp"

namespace ropewalk {

Equilibrium equilibrium_of(const Statics& end, const StabilityVerdict& verdict) {
  constexpr double per_ns = 1000;  // 1/ps in 1/ns
  using Kind = StabilityVerdict::Kind;
  Equilibrium e;
  e.stability = verdict.kind == Kind::stable     ? Equilibrium::Stability::stable
                : verdict.kind == Kind::unstable ? Equilibrium::Stability::unstable
                                                 : Equilibrium::Stability::unknown;
  e.growth = verdict.growth * per_ns;
  e.error = verdict.error * per_ns;
  e.force = end.largest_force;
  e.moment = end.largest_torque;
  e.above = end.relaxed.above;
  e.saddles = static_cast<int>(end.relaxed.saddles);
  return e;
}

}  // namespace ropewalk
