// The published law (model/contact/paper.hpp) as a contact law; between tubes of one type alone.
#pragma once

#include "model/contact/paper.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

class PaperLaw : public ContactLaw {
 public:
  const PaperContact contact;
  const bool legacy_torque;  // The published code's torque acts, which is not the gradient of the energy.

  explicit PaperLaw(const PaperContact& c, bool legacy = false) : contact(c), legacy_torque(legacy) {}

  std::string name() const override { return "paper"; }
  double cutoff() const override { return contact.cutoff(); }
  PairForce force(TypePair, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const override {
    return legacy_torque ? contact.legacy_torque(separation, n_i, n_j)
                         : contact.energy_and_gradient(separation, n_i, n_j);
  }
  double energy(TypePair, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const override {
    return contact.energy(separation, n_i, n_j);
  }
  // Both throw InputError where the tubes do not bind.
  double parallel_distance(TypePair, double length) const override;
  double crossed_distance(TypePair, double length) const override;
  double binding(TypePair, double length) const override;
  double core_distance(TypePair) const override { return (2 + contact.core_gap) * contact.radius; }
};

inline std::shared_ptr<const PaperLaw> paper_law(const PaperContact& contact, bool legacy_torque = false) {
  return std::make_shared<const PaperLaw>(contact, legacy_torque);
}

// The distance of two parallel rows (nm) at which their energy is lowest.
double pair_spacing(const PaperContact& contact, double element_length);

// The wells of two long tubes in elements of this length.
struct PaperWells {
  double spacing = 0, parallel = 0;                    // spacing (nm) and energy (eV/nm) of parallel elements at rest
  double crossed_deepest = 0, crossed_shallowest = 0;  // eV at a right angle: it depends on where along their
                                                       // elements the tubes cross
};
PaperWells paper_wells(const PaperContact& contact, double element_length);

}  // namespace ropewalk
