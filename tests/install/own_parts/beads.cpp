// The example of docs/how-to/contact-law.md, [contact] law = "beads": a Lennard-Jones law between the centres of
// elements, here beside the installed library. tests/examples/contact_law/beads.cpp has its tests.
#include <cmath>
#include <vector>

#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

// U(r) = V(r) - V(c) - (r - c) V'(c) for r < c, V(r) = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) with its minimum where
// the walls of both tubes are as far apart as in graphite. The shift makes energy and force end at the cutoff c.
class BeadLaw : public ContactLaw {
 public:
  BeadLaw(std::vector<double> radii, double epsilon, double cutoff)
      : radii_(std::move(radii)), epsilon_(epsilon), cutoff_(cutoff) {}

  std::string name() const override { return "beads"; }
  double cutoff() const override { return cutoff_; }
  PairForce force(TypePair types, const Vector3& separation, const Vector3&, const Vector3&) const override {
    const double r = detail::safe_distance(separation);
    if (r >= cutoff_) return {};
    const auto [energy, slope] = lennard_jones(types, r);
    const auto [energy_c, slope_c] = lennard_jones(types, cutoff_);
    PairForce f;
    f.energy = energy - energy_c - (r - cutoff_) * slope_c;
    f.force_j = -(slope - slope_c) / r * separation;
    return f;
  }

 private:
  std::pair<double, double> lennard_jones(TypePair types, double r) const {
    const double rest =
        radii_[static_cast<std::size_t>(types.i)] + radii_[static_cast<std::size_t>(types.j)] + 0.335;
    const double p6 = 0.5 * std::pow(rest / r, 6);  // (sigma/r)^6
    return {4 * epsilon_ * (p6 * p6 - p6), 4 * epsilon_ * (6 * p6 - 12 * p6 * p6) / r};
  }

  std::vector<double> radii_;  // nm, of the tube types
  double epsilon_, cutoff_;    // eV, nm
};

ContactLawKind beads_kind() {
  ContactLawKind kind;
  kind.name = "beads";
  kind.make = [](const Scene& scene) {
    std::vector<double> radii;
    for (const ParameterSet& set : scene.sets) radii.push_back(set.radius);
    return std::make_shared<const BeadLaw>(radii, 0.5, scene.contact.cutoff > 0 ? scene.contact.cutoff : 4.5);
  };
  return kind;
}

const bool added = add_contact_law(beads_kind());

}  // namespace
}  // namespace ropewalk
