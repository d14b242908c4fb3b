// How far interatomic potentials of carbon lie apart: the second error of a stiffness, beside that of its fit.
//
// The standard errors of a set hold for its potential. A real tube is no better known than the potentials agree:
// those of the shipped sets of (10,10), four fits to carbon, are taken as a sample. With the relative deviation
// d_p(q) of a stiffness q by potential p from the mean over the potentials, the relative covariance of two
// stiffnesses is
//
//   C(q, q') = sum_p d_p(q) d_p(q')/(n - 1)
//
// EA, EI and GJ are those of one wall and go up and down together, so that C counts and not its diagonal alone.
// Contact is left out: all sets have the same law between atoms of two tubes.
#pragma once

#include <array>
#include <string>

namespace ropewalk {

// Stiffnesses of (10,10) by one potential, as in its shipped set. EA in nN, EI and GJ in nN nm^2.
struct PotentialStiffness {
  const char* potential;
  double EA, EI, GJ;
};
inline constexpr std::array<PotentialStiffness, 4> potentials_of_carbon = {{{"tersoff", 1518.96, 362.884, 330.111},
                                                                            {"airebo", 1229.67, 277.551, 237.645},
                                                                            {"rebo", 1103.53, 257.067, 215.699},
                                                                            {"lcbop", 1330.91, 309.272, 247.918}}};

// C of two quantities of a set, by their keys "bond.EA", "bond.EI", "bond.GJ", "bond.kGA"; 0 for all others.
double potential_covariance(const std::string& one, const std::string& other);
// The relative standard deviation of one quantity between potentials, C(q, q)^1/2.
double potential_spread(const std::string& key);

}  // namespace ropewalk
