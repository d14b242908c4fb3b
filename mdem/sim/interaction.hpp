// What acts between the elements of a scene, resolved from scene and parameter set.
#pragma once

#include <optional>

#include "model/bond.hpp"
#include "model/contact_paper.hpp"
#include "model/damping.hpp"

namespace ropewalk {

struct Interaction {
  BondStiffness bond;
  std::optional<PaperContact> paper;  // none: no contact
  bool legacy_torque = false;
  int exclude_along_tube = 20;  // pairs of one tube up to this many elements apart do not interact
  Damping damping;

  double cutoff() const { return paper ? paper->cutoff() : 0.0; }
  bool damped_contact() const { return damping.contact.eta > 0; }
};

struct Energies {
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0;  // eV
  double bonds() const { return stretch + shear + bend + twist; }
  double potential() const { return bonds() + vdw; }
};

}  // namespace ropewalk
