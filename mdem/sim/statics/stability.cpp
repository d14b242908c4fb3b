#include "sim/statics/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/statics/newton.hpp"
#include "sim/statics/reduction.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {
namespace {

// Rates next to zero; and those that are so far from it that the many slow decays of a rope are nearer to the first
// shift.
constexpr double rate_tolerance = 1e-6;  // of 1/(rate - shift): errors of 5e-5/ns next to zero
constexpr ModeSearch slow_motions{12, 0.05, true, 40, 300, false, rate_tolerance},
    fast_motions{1, 0.5, true, 20, 1, true, rate_tolerance};

}  // namespace

std::optional<Stability> stability_of(const Simulation& s, double most_operations, std::string& why) {
  if (const std::string term = term_without_tangent(s); !term.empty())
    return why = term + " has no tangent", std::nullopt;
  if (cost_of_decomposition(s).operations > most_operations)
    return why = "that takes long in a rope so thick", std::nullopt;
  const std::optional<Reduction> reduction = reduction_of(s, why);
  if (!reduction) return std::nullopt;
  try {
    const Tangent tangent = tangent_by_blocks(s);
    const Modes found = modes_of(tangent, *reduction, slow_motions);
    Stability out;
    out.neutral = neutral_below(found);
    bool any = false;
    const auto look = [&](const std::vector<Mode>& modes, double least) {
      for (const Mode& mode : modes) {
        if (std::abs(mode.rate) < out.neutral || mode.rate.real() < least) continue;
        if (!any || mode.rate.real() > out.growth) out.growth = mode.rate.real();
        any = true;
      }
    };
    look(found.modes, -std::numeric_limits<double>::infinity());
    if (out.stable()) look(modes_of(tangent, *reduction, fast_motions).modes, slow_motions.shift);
    return out;
  } catch (const std::runtime_error& e) {
    return why = e.what(), std::nullopt;
  }
}

StabilityVerdict judge_stability(const Simulation& simulation, const Statics& end) {
  using Kind = StabilityVerdict::Kind;
  StabilityVerdict out;
  if (end.falls) return out.kind = Kind::unstable, out;
  const double slow = NewtonOptions().slow;
  if (const auto found = stability_of(simulation, affordable_operations, out.why)) {
    out.growth = found->growth;
    // Slower ones were seen to come and go with what is left of forces and moments at rest.
    out.error = found->stable() ? found->neutral : std::max(slow, found->neutral);
    out.kind = found->stable() ? Kind::stable : found->growth <= out.error ? Kind::unknown : Kind::unstable;
    return out;
  }
  if (end.symmetric) {
    out.kind = Kind::stable;
    out.error = slow;
  }
  return out;
}

std::string StabilityVerdict::words() const {
  constexpr double per_ns = 1000;  // 1/ps in 1/ns
  switch (kind) {
    case Kind::stable:
      return fmt::format("stable: no motion grows faster than {:.2g}/ns", error * per_ns);
    case Kind::unstable:
      if (std::isnan(growth)) return "it rests on a saddle, and stays there";
      return fmt::format("unstable: a motion grows by {:.3g}/ns, which `ropewalk modes` names", growth * per_ns);
    case Kind::unknown:
      break;
  }
  if (std::isfinite(growth))
    return fmt::format("no motion grows faster than {:.2g}/ns; one of {:.2g}/ns cannot be told from the residual",
                       error * per_ns, growth * per_ns);
  return "whether it is stable under these couples is not known (" + why + "): `ropewalk modes` tells";
}

}  // namespace ropewalk
