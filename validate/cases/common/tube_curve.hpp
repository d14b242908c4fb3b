// Energy per length of one tube against an amplitude: atoms and model, from the elastic window into the collapse.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/common/lammps_session.hpp"

namespace ropewalk {

// Fixed beforehand. The set claims forces within 1 % in the window, so energies within less; the rest is left to
// the minimiser and to the specimen's ends.
inline constexpr double window_tolerance = 0.03;

struct TubeCurve {
  std::string tube;                      // "(10,10)"
  std::string amplitude_name, unit;      // "strain", ""
  std::vector<double> amplitude, atoms;  // eV/nm, above the relaxed tube
  std::function<double(double)> model;   // eV/nm at an amplitude
  double window = 0;                     // the set claims forces within 1 % up to here, either sign
  double end = 0;                        // the set says that the tube gives way here
  // Shown beside the others, but not compared: past its collapse a tube is no uniform rod.
  std::vector<double> more_amplitude, more_atoms;
  std::string more_name;
};

// The check in the window, where 5 and 10 % are left, the figure of energies and that of residuals.
void add_curve(const TubeCurve& curve, CaseResult& result);

// How many points, from rest outwards, lie before the slope of the energy (force, torque or moment) falls behind by
// a tenth; and the check that says so, for information.
std::size_t points_before_collapse(const std::vector<double>& amplitude, const std::vector<double>& energy);
void add_collapse(const TubeCurve& curve, const std::vector<double>& amplitude, std::size_t points,
                  const std::string& note, CaseResult& result);

// Energy per length of a chain: each bond has the same separation and turn.
double chain_energy(const BondStiffness& bond, double element, double strain, double twist, double curvature);

// The rows of a table that have this value in the column, one column of them.
std::vector<double> column_where(const ReferenceTable& table, const std::string& column, const std::string& key,
                                 double value);

}  // namespace ropewalk
