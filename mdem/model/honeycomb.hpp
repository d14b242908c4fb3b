// The sheet that a tube is rolled from: a honeycomb whose two sublattices may be of two species. Carbon is the
// default.
//
//   lattice constant = sqrt(3) bond length, nm; atomic weights in u (atomic mass constant)
//
// Between the atoms of two tubes Lennard-Jones laws act, one for each pair of species. In two continuous shells,
// where each species has half of the area density, their sum is again one Lennard-Jones law:
//
//   v = (v_11 + 2 v_12 + v_22)/4 = A/d^12 - B/d^6,   sigma = (A/B)^(1/6),   epsilon = B^2/(4 A)
#pragma once

#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include "model/tube.hpp"
#include "model/units.hpp"

namespace ropewalk {

// Lennard-Jones between two atoms.
struct PairLaw {
  double epsilon = 0, sigma = 0;  // eV, nm
};

struct Honeycomb {
  std::string name = "C";
  std::array<std::string, 2> species = {"C", "C"};  // symbols of the first and of the second sublattice
  std::array<double, 2> atomic_weight = {units::carbon_atomic_weight, units::carbon_atomic_weight};  // u
  double lattice_constant = graphene_lattice_constant;                                               // nm
  std::array<PairLaw, 3> pairs;  // 1 with 1, 1 with 2, 2 with 2; of carbon 0: its law stands in its sets alone

  bool carbon() const { return name == "C"; }
  bool one_species() const { return species[0] == species[1]; }
  double bond_length() const { return lattice_constant / std::sqrt(3.0); }
  // Mass of an atom, the mean of both sublattices, eV ps^2/nm^2.
  double mean_mass() const {
    return carbon() ? units::carbon_mass : 0.5 * (atomic_weight[0] + atomic_weight[1]) * units::atomic_mass;
  }
  // Beginning of the names of its sets: "cnt", "bn".
  std::string stem() const {
    if (carbon()) return "cnt";
    std::string text;
    for (const char c : name) text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  }
};

// The law of Lorentz and Berthelot for two unlike atoms.
inline PairLaw mixed_law(const PairLaw& a, const PairLaw& b) {
  return {std::sqrt(a.epsilon * b.epsilon), 0.5 * (a.sigma + b.sigma)};
}

// The one law that acts between continuous shells.
inline PairLaw shell_law(const std::array<PairLaw, 3>& pairs) {
  double attraction = 0, repulsion = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double share = (k == 1 ? 0.5 : 0.25) * 4 * pairs[k].epsilon, s6 = std::pow(pairs[k].sigma, 6);
    attraction += share * s6;
    repulsion += share * s6 * s6;
  }
  return {attraction * attraction / (4 * repulsion), std::pow(repulsion / attraction, 1.0 / 6)};
}

}  // namespace ropewalk
