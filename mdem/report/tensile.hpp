// Ropes that were pulled: what a testing machine tells of each.
#pragma once

#include <string>
#include <vector>

#include "io/log.hpp"
#include "report/load_tests.hpp"

namespace ropewalk {

// The tensile test in the log of one run. The pull (io/pull.hpp) ends where the stress has fallen to half.
struct TensileTest {
  LogRow before;                  // the row in which the pull begins
  double strength = 0;            // GPa, largest stress
  double specific = 0;            // N/tex
  double strain = 0;              // since the pull began, at the largest stress
  double modulus = 0;             // GPa, slope of a straight line through the stress up to half of the largest
  double toughness = 0;           // MJ/m^3, integral of stress over strain in the pull
  double specific_toughness = 0;  // J/g
  double links = 0, links_broken = 0, bonds_broken = 0;  // at the end of the run
  double breaks_at = 0;                                  // nm, median height of what broke; nan: nothing did
  double breaks_within = 0;                              // nm, between the quartiles of these heights
  std::string no_strength;                               // why the numbers of the pull are nan; empty: they are not
  bool to_half = false;  // the run went on until the stress had fallen to half of the largest
};

// `heights_of_breaks`: nm, in any order. Throws std::invalid_argument where nothing pulls in the log.
TensileTest tensile_test(const std::vector<LogRow>& log, std::vector<double> heights_of_breaks);

LoadTest load_test(const TensileTest& test);
const LoadTestKind& tensile_kind();

}  // namespace ropewalk
