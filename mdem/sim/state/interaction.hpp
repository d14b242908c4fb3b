// Interactions between the elements of a scene, made from the scene and its parameter sets.
#pragma once

#include <memory>
#include <vector>

#include "model/damping.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

class ContactLaw;  // sim/contact/contact_law.hpp
class ForceTerm;   // sim/forces/force_term.hpp

struct Interaction {
  std::shared_ptr<const ContactLaw> law;  // null: no contact
  // Displacements between nodes (line law) and all that belongs to a pair (paper law) in single precision, or all
  // in double.
  enum class Precision { mixed, full };
  Precision precision = Precision::full;
  double exclude_along_tube = 0;  // nm; 0: the cutoff of the law
  Damping damping;
  std::vector<std::shared_ptr<const ForceTerm>>
      terms;              // what else adds forces, as it is at the start; see add_term()
  double term_reach = 0;   // nm: pairs that the terms ask the neighbour list for
  double term_copies = 0;  // nm: how far from own elements the terms look at others

  bool has_contact() const { return law != nullptr; }
  bool damped_contact() const { return damping.contact.eta > 0; }
  double cutoff() const;  // between element centres, nm: that of the law, or of the terms where they reach farther
  double lever() const;   // lever of the law, nm; without one, zero
  // nm: elements of one tube with points nearer than this along it do not interact.
  double excluded_arc() const { return exclude_along_tube > 0 ? exclude_along_tube : cutoff(); }
  bool whole_ranges() const;
};

struct Energies {
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0;  // eV
  double terms = 0;                                             // energy of all force terms, eV
  double bonds() const { return stretch + shear + bend + twist; }
  double potential() const { return bonds() + vdw + terms; }
};

}  // namespace ropewalk
