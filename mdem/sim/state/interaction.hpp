// Interactions between the elements of a scene, made from the scene and its parameter sets.
#pragma once

#include <memory>

#include "model/damping.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

class ContactLaw;  // sim/contact/contact_law.hpp

struct Interaction {
  std::shared_ptr<const ContactLaw> law;  // null: no contact
  // Displacements between nodes (line law) and all that belongs to a pair (paper law) in single precision, or all
  // in double.
  enum class Precision { mixed, full };
  Precision precision = Precision::full;
  double exclude_along_tube = 0;  // nm; 0: the cutoff of the law
  Damping damping;

  bool has_contact() const { return law != nullptr; }
  bool damped_contact() const { return damping.contact.eta > 0; }
  // Those of the law; without one, zero.
  double cutoff() const;  // nm, of element centres
  double lever() const;   // nm
  // nm: elements of one tube with points nearer than this along it do not interact.
  double excluded_arc() const { return exclude_along_tube > 0 ? exclude_along_tube : cutoff(); }
  bool whole_ranges() const;
};

struct Energies {
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0;  // eV
  double bonds() const { return stretch + shear + bend + twist; }
  double potential() const { return bonds() + vdw; }
};

}  // namespace ropewalk
