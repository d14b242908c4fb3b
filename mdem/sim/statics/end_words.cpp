#include "sim/statics/end_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

constexpr double contacts_form = 0.05;  // eV/nm: larger forces after many steps are those of contacts that form

}  // namespace

std::string overloaded_bond(const Simulation& s) {
  constexpr double nearly_slipping = 80 * units::degree;
  const Topology& topology = s.topology();
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    const Anharmonic& h = type.bond.anharmonic;
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const auto [a, b] = bond_ends(type.bond, type.element_length, frame_of(s.state().orientation[i]),
                                    frame_of(s.state().orientation[i + 1]));
      const double twist = std::fabs(bond_twist_angle(a, b)), bend = std::acos(std::min(1.0, a.t.dot(b.t)));
      const double per_length = h.radius / type.element_length;
      const char* what = h.used && per_length * twist >= h.max_shear ? "has collapsed"
                         : h.used && per_length * bend >= h.max_bend ? "has kinked"
                         : twist > nearly_slipping ? "has a bond that slips at a twist of 90 degrees"
                                                   : nullptr;
      if (what)
        return "tube " + std::to_string(t) + " " + what + " at element " +
               std::to_string(e - topology.tube_begin[t]) + ": the load is more than it bears";
    }
  }
  return "";
}

EndWords end_words(const Simulation& s, const Statics& end, bool by_fire, bool on_curve) {
  const std::string dynamics = "take mode = \"dynamics\" for what comes after it";
  if (const std::string bond = overloaded_bond(s); !bond.empty())
    return {bond, "end the load below this one, or " + dynamics};
  if (end.end == Statics::End::refused) {
    const std::string why = "no step of Newton's method is short enough, as where states of rest end (a fold)";
    if (on_curve) return {why, "raise statics.steps to come nearer to it, or " + dynamics};
    return {why, by_fire ? "raise the load in steps, by [statics] steps = 20, or take mode = \"dynamics\""
                         : "take solver = \"auto\", or raise the load in steps, by [statics] steps = 20"};
  }
  if (end.end == Statics::End::interrupted) return {"it was stopped", ""};
  if (s.interaction().law && s.topology().tubes() > 1 && s.forces().energy.vdw == 0)
    return {"no two tubes touch", "start from tubes that touch"};
  if (s.interaction().law && s.topology().tubes() > 1 && end.relaxed.force > contacts_form &&
      end.newton_steps >= NewtonOptions().most)
    return {"tubes may still be drawing together, by 0.15 nm a step at most",
            "let them come together by mode = \"dynamics\" first, and begin with its final.csv ([state])"};
  return {
      fmt::format("{:.2g} eV/nm are left after {} steps of Newton's method", end.relaxed.force, end.newton_steps),
      ""};
}

}  // namespace ropewalk
