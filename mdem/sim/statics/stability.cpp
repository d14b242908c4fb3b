#include "sim/statics/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/dynamics/modes.hpp"
#include "sim/statics/newton.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {

std::optional<Stability> stability_of(const Simulation& s, double most_bytes, std::string& why) {
  const auto free = free_unknowns(s);
  if (!free) return why = "clamps tie several elements", std::nullopt;
  if (const std::string term = term_without_tangent(s); !term.empty())
    return why = term + " has no tangent", std::nullopt;
  if (bytes_of_decomposition(s) > most_bytes) return why = "that takes long in a rope so thick", std::nullopt;
  try {
    const Modes found = modes_of(tangent_by_blocks(s), *free, {});
    Stability out;
    out.neutral = neutral_below(found);
    bool any = false;
    for (const Mode& mode : found.modes) {
      if (std::abs(mode.rate) < out.neutral) continue;
      const double rate = mode.rate.real() - mode.residual;
      if (!any || rate > out.growth) out.growth = rate;
      any = true;
    }
    return out;
  } catch (const std::runtime_error& e) {
    return why = e.what(), std::nullopt;
  }
}

StabilityVerdict judge_stability(const Simulation& simulation, const Statics& end) {
  constexpr double affordable = 1.5e8;  // bytes: of 19 tubes of 70 nm
  using Kind = StabilityVerdict::Kind;
  StabilityVerdict out;
  if (end.falls) return out.kind = Kind::unstable, out;
  const double slow = NewtonOptions().slow;
  if (const auto found = stability_of(simulation, affordable, out.why)) {
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
