#include "sim/statics/stability.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/dynamics/modes.hpp"
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

}  // namespace ropewalk
