// The force that draws two overlapping tubes apart: by cohesion alone, and with dry friction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cases/common/bundle.hpp"
#include "core/checks.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk::validate::staggered_strength {
namespace {

// Fixed beforehand.
constexpr double tolerance = 0.02;  // relative to the force
constexpr int beyond = 10;          // elements of each tube outside of the overlap
constexpr double friction = 20;     // pN/nm, axial
constexpr double breaks_at = 1e-3;  // strain
constexpr double speed = 0.004;     // nm/ps
constexpr double way = 2;           // displacement of the pulled end, nm
constexpr double seen_from = 1;     // nm of the way: from here on the whole overlap slides

// Two tubes side by side that move along their axis alone, and overlap by so many elements once the second is drawn
// out by `out` of them. The first is held at its lower end, and something holds the second at its upper.
struct Joint {
  Scene scene;
  Prepared p;

  Joint(const ParameterSet& set, int length, int out, const std::string& holds)
      : scene(scene_of_text(
            fmt::format(
                "format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n[rope]\ntubes = 2\npacking = "
                "\"round\"\nlength_nm = {}\n[bond]\nlaw = \"harmonic\"\n[[load]]\nkind = \"fix\"\nelements = "
                "\"all\"\naxes = \"xy\"\n[[load]]\nkind = \"fix\"\ntubes = [0]\nelements = [0]\n{}",
                set.path, length * set.element_length, holds),
            "")) {
    scene.sets = {set};
    p = prepare(scene);
    for (int e = length; e < 2 * length; ++e)
      p.state.position.z[static_cast<std::size_t>(e)] += out * set.element_length;
  }
};

// Force of cohesion, eV/nm: the difference of two energies at rest. The overlaps differ by one whole element, so
// that the nodes of both tubes face one another alike and the grain of the rows cancels.
double force_of_cohesion(const ParameterSet& set, int overlap) {
  const auto energy = [&](int out) {
    const Joint joint(set, overlap + beyond, out,
                      "[[load]]\nkind = \"fix\"\ntubes = [1]\nelements = [-1]\n[run]\nmode = \"relax\"\n");
    Simulation s = start(joint.scene, joint.p);
    if (!s.relax(1e-4, 400000, [](long) { return true; }))
      throw std::runtime_error("the joint does not come to rest");
    return s.forces().energy.potential();
  };
  return (energy(beyond + 1) - energy(beyond)) / set.element_length;
}

struct Pulled {
  double force = 0;    // eV/nm, mean over the way of the pulled end from seen_from on
  double largest = 0;  // eV/nm
  bool broken = false;
};

Pulled pulled(const ParameterSet& set, int overlap, bool may_break) {
  const int length = overlap + beyond;
  const Joint joint(
      set, length, beyond,
      fmt::format(
          "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0.02\n[[grip]]\ntubes = [1]\nend = \"upper\"\nz = {{ "
          "displacement_nm = [[0, 0], [{0}, {1}]] }}\nsmooth_ps = 50\n[[friction]]\nstrength_pN_per_nm = "
          "{2}\nelastic_slip_nm = 0.02\n{3}[run]\nduration_ps = {0}\n",
          way / speed, way, friction, may_break ? fmt::format("[failure]\nstrain = {}\n", breaks_at) : ""));
  Simulation s = start(joint.scene, joint.p);
  const long steps = std::lround(joint.p.duration / joint.p.time_step), looks = 400;
  Pulled out;
  long seen = 0;
  for (long k = 0; k < looks && !out.broken; ++k) {
    s.steps((k + 1) * steps / looks - k * steps / looks);
    // Mean tension of the bonds outside of the overlap.
    constexpr int bonds = beyond - 4;
    double tension = 0;
    for (int b = 0; b < bonds; ++b) {
      const auto i = static_cast<std::size_t>(2 * length - 3 - b);
      const double strain = (s.state().position[i] - s.state().position[i - 1]).norm() / set.element_length - 1;
      tension += set.bond.stretch * strain / bonds;
    }
    out.broken = s.tubes_now().tubes() > 2;
    if (!out.broken) out.largest = std::max(out.largest, tension);
    if (s.state().time < seen_from / speed) continue;
    out.force += tension;
    ++seen;
  }
  if (seen > 0) out.force /= static_cast<double>(seen);
  return out;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const CaseTube tube = context.tube();
  const double cohesion = -pair_well(tube.set).energy, in_pN = 1000 * units::eV_in_nN_nm,
               q = friction / in_pN, a = tube.set.element_length, slid = 0.5 * (seen_from + way);
  const auto theory = [&](double overlap, double strength) { return cohesion + strength * overlap; };
  std::vector<double> lengths, smooth, rough;
  for (const int overlap : {15, 30, 60}) {
    const double length = overlap * a;
    if (context.progress) context.progress(fmt::format("an overlap of {:.3g} nm", length));
    const double bare = force_of_cohesion(tube.model, overlap), held = pulled(tube.model, overlap, false).force;
    const std::string of = fmt::format("overlap of {:.3g} nm", length);
    result.check_relative("force without friction, " + of, bare * in_pN, theory(length, 0) * in_pN, tolerance, "pN",
                          "the energy of the contact per length, whatever the overlap");
    result.check_relative("force with friction, " + of, held * in_pN, theory(length - slid, q) * in_pN, tolerance,
                          "pN", "the overlap is 1.5 nm shorter in the mean over what is seen");
    lengths.push_back(length);
    smooth.push_back(bare * in_pN);
    rough.push_back(held * in_pN);
  }
  // The overlap beyond which a tube breaks before it slides out.
  const double bears = breaks_at * tube.set.bond.stretch, critical = (bears - cohesion) / q;
  for (const auto& [part, words] : {std::pair(0.8, "0.8"), std::pair(1.25, "1.25")}) {
    const Pulled seen = pulled(tube.model, static_cast<int>(std::lround(part * critical / a)), true);
    result.check_absolute(fmt::format("broken tubes at {} of the critical overlap", words), seen.broken, part > 1,
                          0.5, "", "a shorter overlap slides, a longer one breaks the tube");
    if (part > 1)
      result.show_relative("force at which the tube breaks", seen.largest * in_pN, bears * in_pN, tolerance, "pN",
                           "EA times the strain at which bonds break; waves of the pull break one earlier");
  }
  result.figure(
      "Force that draws a tube out of an overlap", {"overlap", "nm"}, {"force", "pN"},
      fmt::format("Cohesion alone does not care for the overlap; friction of {:g} pN/nm adds in proportion "
                  "to it, until the tube breaks.",
                  friction),
      {theory_curve("cohesion", 0, lengths.back(), [&](double x) { return theory(x, 0) * in_pN; }),
       model_points("without friction", lengths, smooth),
       theory_curve("cohesion and friction", 0, lengths.back(),
                    [&](double x) { return theory(x - slid, q) * in_pN; }),
       model_points("with friction", lengths, rough)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "staggered-strength";
  c.order = 173;
  c.run = run;
  c.turns_red = {{wrong_contact(1.1), {"force without friction"}}};
  c.stays_green = {wrong_EI(1.1), wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::staggered_strength
