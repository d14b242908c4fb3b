// The contact between elements of two tubes as one energy U(s, n_i, n_j) of a pair, eV: s = x_j - x_i in nm, n_i
// and n_j the unit axes. A law states its energy here; a ContactEngine (sim/contact/contact_engine.hpp)
// sums it. A law is immutable and has no state.
#pragma once

#include <memory>
#include <string>

#include "model/contact/contact.hpp"

namespace ropewalk {

// Types of the tubes of a pair, indices of Topology::types.
struct TypePair {
  int i = 0, j = 0;
};

class ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  virtual std::string name() const = 0;

  // Distance of element centres from which on U and its gradient are zero, whatever the types, nm.
  virtual double cutoff() const = 0;
  // nm: how far from its centre an element has points that interact. Turning the element moves them.
  virtual double lever() const { return 0; }
  // Skin of the first neighbour list, nm.
  virtual double default_skin() const { return 0.15; }
  // Whether buffers of the list's chunks must cover all elements between the first and the last one.
  virtual bool whole_ranges() const { return true; }
  // Points of an element that interact.
  virtual int nodes() const { return 1; }

  // Energy, force on j and torques about both centres: the exact gradient of U. This is the plain form, for the
  // reference, for LAMMPS, and for laws without an engine of their own.
  virtual PairForce force(TypePair types, const Vector3& separation, const Vector3& n_i,
                          const Vector3& n_j) const = 0;
  virtual double energy(TypePair types, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
    return force(types, separation, n_i, n_j).energy;
  }
  // False only where the pair certainly has no energy.
  virtual bool reaches(TypePair, const Vector3& /*separation*/, const Vector3& /*n_i*/,
                       const Vector3& /*n_j*/) const {
    return true;
  }

  // Two long straight tubes in elements of `length` nm. Distances of their axes in nm; the defaults are found
  // numerically from energy(), and a law that binds nowhere rests at its cutoff.
  virtual double parallel_distance(TypePair types, double length) const;  // distance of the lowest energy
  virtual double crossed_distance(TypePair types, double length) const;   // the same at a right angle
  virtual double binding(TypePair types, double length) const;            // largest, eV/nm, never negative
  // nm: where a typed cutoff would cut, of tube axes or of element centres.
  virtual double range(TypePair) const { return cutoff(); }
  // nm: nearer than this the energy is a continuation that nothing was fitted to.
  virtual double core_distance(TypePair) const { return 0; }
};

}  // namespace ropewalk
