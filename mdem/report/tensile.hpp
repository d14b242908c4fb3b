// Ropes that were pulled: what a testing machine tells of each, with means and errors over replicates.
#pragma once

#include <string>
#include <vector>

#include "io/log.hpp"
#include "io/outputs.hpp"
#include "report/page.hpp"

namespace ropewalk {

// From the log of one run. The pull is the last rise of the strain before the largest stress that began with a
// tenth of that stress or less, or at the strain at which the rope was held. It ends where the stress has fallen to
// half.
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
  bool to_half = false;  // the run went on until the stress had fallen to half of the largest
};

// `heights_of_breaks`: nm, in any order. Throws std::invalid_argument where nothing pulls in the log.
TensileTest tensile_test(const std::vector<LogRow>& log, std::vector<double> heights_of_breaks);

// Runs that differ in their seed alone.
struct TensileGroup {
  std::string name;
  std::string line;  // groups with the same text are points of one line
  std::vector<TensileTest> tests;
};

// Columns of the table behind run, replicates, to_half and --x; each but these is followed by its standard error.
std::vector<OutputColumn> tensile_columns();
std::string tensile_csv(const std::vector<TensileGroup>& groups, const std::string& x);
// Strength over the column `x` of the log, in the row in which the pull begins; over beta_deg with the cos^2 of
// that angle, which is the law of yarns of long fibres (J. W. S. Hearle, P. Grosberg, S. Backer, Structural
// Mechanics of Fibers, Yarns, and Fabrics, Wiley 1969). Empty: no line has two points.
std::string tensile_svg(const std::vector<TensileGroup>& groups, const std::string& x);
// The part of a page: the table and that chart. `lines`: what the names of the lines are, "tube_length_nm, per_nm".
std::string tensile_part(const std::vector<TensileGroup>& groups, const std::string& x, const std::string& lines,
                         Figures& figures);

}  // namespace ropewalk
