// How far a parameter set stands for its tube, as a chain of rigid circular cylinders with the contact law of the
// set. It follows from numbers that stand in every set: radius, standard errors of the stiffnesses, errors of the
// contact.
#pragma once

#include <string>
#include <vector>

#include "model/parameters.hpp"

namespace ropewalk {

struct Grade {
  enum class Level { good, limited, unfit };
  Level level = Level::good;
  std::vector<std::string> reasons;  // for each fault, with its figure

  std::string words() const;  // "good", or "limited: " and the reasons
};

// good: stiffnesses known to 1 %, the line law within 1 % of the well of the surface integral, 0.5 to 2 nm wide,
// and numbers that agree with one another: shell, limits of the model, anharmonic law, pull, well. unfit: a
// stiffness known to no more than a half, a wall that no sheet of its species has, the line law off by more than a tenth of
// the well, or wider than 4.2 nm, where tubes may collapse by themselves (J. A. Elliott et al., Phys. Rev. Lett.
// 92, 095501 (2004), DOI 10.1103/PhysRevLett.92.095501). Filaments are limited: no atoms stand behind their numbers.
Grade grade_of(const ParameterSet& set);

// EA/(2 pi r), N/m: the stiffness of the sheet that the tube is rolled from.
double wall_stiffness(const ParameterSet& set);
// N/m, what it may be: carbon in any potential has 250 to 355. Other sheets of one layer lie far apart, from 60 (silicon)
// to that of carbon.
struct WallRange {
  double softest, stiffest;
  const char* of;  // "a wall of carbon"
};
inline WallRange wall_range(const Honeycomb& honeycomb) {
  return honeycomb.carbon() ? WallRange{200, 500, "a wall of carbon"} : WallRange{30, 500, "a sheet of one layer"};
}

// Largest error of the set's own line law against the surface integral, over the well, as the set states it.
// Negative: it states none.
double line_fit_error(const ParameterSet& set);
// The error of the universal law, which acts between tubes of different kinds. Negative: the set has none.
double universal_error(const ParameterSet& set);
// A contact law that is further off than this is of no use.
inline constexpr double unusable_contact = 0.1;  // part of the well

// Standard deviation, over all registries, of the energy of two real tubes side by side, over the well. Negative:
// the set does not say.
double registry_deviation(const ParameterSet& set);

inline constexpr double faceting_diameter = 2.0;  // nm: wider tubes press each other flat
inline constexpr double slender_diameter = 0.5;   // nm: the wall of narrower tubes is no thin shell

}  // namespace ropewalk
