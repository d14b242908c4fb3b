// A hexagonal rope in a testing machine: two clamps hold the ends of all tubes as rigid discs. It is wound evenly
// into concentric helices, clamps included, and brought to rest, so that no bay differs from another.
//
// The energy of such a rope per tube and length has three parts. With the rest radii rho, the twist phi (rad per
// length of the relaxed rope) and the stretch lambda (of that length), s = sqrt(lambda^2 + rho^2 phi^2), tan(theta)
// = rho phi /lambda:
//
//   bonds      A chain has the strain s - 1, the twist phi cos(theta) and the curvature phi sin(theta). This part
//   is
//              exact if the radii do not change. For Hooke's bonds it is EA (s-1)^2/2 + GJ phi^2 cos^2(theta)/2 +
//              EI phi^2 sin^2(theta)/2
//   cohesion   -Gamma/s, Gamma what a tube binds with per length of it. It shortens the rope until the bonds bear
//   it:
//              everything is counted from there. Outer tubes have less of it, and clamps keep all equally long. Of
//              the line law it is larger by (phi d)^2/4, d the distance of neighbours: lines that wind about each
//              other are nearer to one another than parallel ones, d^2 + x^2 (1 - (phi d)^2/2) at the arc x between
//              two points
//   crowding   neighbours in a twisted rope lie as on a surface of the curvature K = 3 phi^2 (G. M. Grason, Rev.
//   Mod.
//              Phys. 87, 401 (2015), DOI 10.1103/RevModPhys.87.401). To lay a disc of the radius R of a hexagonal
//              lattice with the Young's modulus Y upon it costs pi Y K^2 R^6/384, and draws its middle apart with
//              the stress Y K R^2/16. Two tubes have room enough
//
// The torque is M = dU/dphi and the tension T = dU/dlambda. At held length the tension of the outer tubes presses
// on the core with E (phi R)^4/8, where E is EA over the area of a cell. At free length this pressure is zero.
#pragma once

#include <cmath>
#include <vector>

#include "model/parameters.hpp"
#include "scene/ends/grip.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk::validate {

struct RopeInMachine {
  enum class Length { held, free };
  // At rest.
  struct Reading {
    double torque = 0, tension = 0;  // per tube: eV, eV/nm
    double stretch = 1;              // relative to the relaxed length
    double energy = 0;               // eV per tube, above the straight rope
    double stretch_share = 0;        // fraction of the bonds' energy
    double core_pressure = 0;        // eV/nm^3
  };

  ParameterSet set;
  int tubes = 0;
  Topology topology;
  Interaction interaction;
  double spacing = 0;            // nm
  double length = 0;             // nm, between the clamps, relaxed
  std::vector<double> radii;     // radii of the tubes, nm
  std::vector<double> cohesion;  // cohesion of the tubes, eV/nm
  double modulus = 0;            // eV/nm^3, Y of the lattice

  // Two tubes side by side, or a hexagonal number.
  RopeInMachine(const ParameterSet& set, int tubes, int elements);
  double bonded() const { return (topology.length_of(0) - 1) * set.element_length; }  // bonded length of each tube, nm
  double outer_radius() const;                                                        // distance of the outermost axes from the middle, nm
  double cell() const { return 0.5 * std::sqrt(3.0) * spacing * spacing; }            // area of each tube, nm^2
  double disc_radius() const { return std::sqrt(tubes * cell() / units::pi); }        // radius of the cross-section, nm
  double twist_at(double angle) const;  // rad/nm, where the outermost tubes lean by this angle

  // With the spins of all tubes held in the clamps or free.
  // Throws std::runtime_error where it does not come to rest.
  Reading wound(double twist, Length length, bool spins_free = false) const;
  // What the formulas above give. Where the length is free, it is that at the stretch without tension.
  Reading theory(const ParameterSet& oracle, double twist, Length length, bool spins_free = false) const;

 private:
  State straight_;  // at rest
  double straight_energy_ = 0;
  double bond_stretch_ = 1;  // stretch of the relaxed rope
};

}  // namespace ropewalk::validate
