// Energy per length of one tube against strain, twist or curvature: atoms and model, from the elastic window to the
// collapse.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/common/lammps_session.hpp"
#include "core/reference.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk::validate {

// Fixed beforehand: the anharmonic bond claims energies within 1 % up to the limits of the set.
inline constexpr double window_tolerance = 0.01;

struct TubeCurve {
  std::string tube;                      // "(10,10)"
  std::string amplitude_name, unit;      // "strain", ""
  std::vector<double> amplitude, atoms;  // eV/nm, above the relaxed tube
  std::function<double(double)> model;   // eV/nm at an amplitude
  double window = 0;                     // largest amplitude of either sign that is compared
  double end = 0;                        // amplitude at which the tube gives way, by the set
  // Shown, not compared: after its collapse a tube is not a uniform rod.
  std::vector<double> more_amplitude, more_atoms;
  std::string more_name;
};

// Takes the points beyond the collapse out of the comparison, of either sign.
void end_at_collapse(TubeCurve& curve);
// Adds the check in the window, the amplitudes at which the difference reaches 5 and 10 %, and figures of the
// energies and of their differences.
void add_curve(const TubeCurve& curve, CaseResult& result);

// Number of points, from rest outwards, before the slope of the energy (force, torque or moment) falls by a tenth.
std::size_t points_before_collapse(const std::vector<double>& amplitude, const std::vector<double>& energy);
// Number of points, from rest outwards, before the energy leaps: before its slope over the amplitude, which bending
// keeps or lowers, rises by a third above the largest so far. Parts that touch, or a minimiser that went astray.
std::size_t points_before_break(const std::vector<double>& amplitude, const std::vector<double>& energy);
// Adds the amplitude of a collapse, for information.
void add_collapse(const TubeCurve& curve, const std::vector<double>& amplitude, std::size_t points,
                  const std::string& note, CaseResult& result);

// A case that holds (5,5) and (10,10) tubes, or others, to the stored table of its name, which LAMMPS makes again within
// `tolerance`; `compare` does so for one tube.
Case tube_curve_case(const std::string& name, double tolerance,
                     ReferenceTable (*make)(const CaseContext&, const ParameterSet&),
                     void (*compare)(const CaseTube&, const ReferenceTable&, CaseResult&));

// About how long LAMMPS takes for `relaxations` of `length` nm of tube, s of one core (Tersoff).
double lammps_seconds(const ParameterSet& set, double length, double relaxations);

}  // namespace ropewalk::validate
