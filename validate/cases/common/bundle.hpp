// Tubes in contact: the line law and the surface integral of a set, and straight hexagonal bundles.
#pragma once

#include "cases/common/chain.hpp"
#include "cases/common/straight_tubes.hpp"
#include "contact/integral.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate {

using calibrate::AtomLaw, calibrate::WallsIntegral, calibrate::Shell, calibrate::Well;

// The line law of a set between elements of its own length.
LineContact line_contact_of(const ParameterSet& set);

// The surface integral that the set's line law was fitted to: Lennard-Jones law, radius and surface density.
WallsIntegral surface_integral(const ParameterSet& set);

// The well of two parallel tubes: that of the surface integral. A filament has no atoms to integrate over; its own
// law is all that is known of its contact.
Well pair_well(const ParameterSet& set);

// Energy per length (eV/nm) of a straight hexagonal rope of this spacing (nm): the sum of the integral over all
// pairs of tubes. Thin tubes reach their second neighbours.
double rope_energy(const WallsIntegral& integral, int tubes, double spacing);

// Straight tubes on a hexagonal lattice at the distance of the energy minimum, with the line law.
struct Bundle {
  Topology topology;
  Interaction interaction;
  State state;
  double spacing = 0;    // nm
  double time_step = 0;  // ps

  void place(const ParameterSet& set, int elements, const Places& places);  // straight_tubes()
};
Bundle line_bundle(const ParameterSet& set, int tubes, int elements);
// Relaxes it, and takes its velocities away.
void bring_to_rest(Bundle& bundle);

// Moment (eV) about the z axis with which these elements resist being turned.
double resisting_moment(const std::vector<int>& elements, const Vec3Array& position, const Vec3Array& force,
                        const Vec3Array& torque);

}  // namespace ropewalk::validate
