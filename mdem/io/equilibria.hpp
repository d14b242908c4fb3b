// equilibria.csv of a run with load steps: its states of rest, one row each, in the order of the load.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "io/outputs.hpp"

namespace ropewalk {

struct Equilibrium {
  enum class Stability { stable, unstable, unknown };

  std::int64_t step = 0;  // step of the row of log.csv with the same state
  double time = 0;        // ps
  Stability stability = Stability::unknown;
  double growth = std::numeric_limits<double>::quiet_NaN();  // growth rate of the fastest motion, 1/ns; NaN: not known
  double error = std::numeric_limits<double>::quiet_NaN();   // 1/ns: smaller rates cannot be told from zero
  double force = 0, moment = 0;                              // eV/nm, eV: the largest that is left
  double above = 0;                                          // eV above the minimum, by estimate
  int saddles = 0;                                           // saddles of the energy that it left on the way
};
using Equilibria = std::vector<Equilibrium>;

const char* name_of(Equilibrium::Stability stability);

// Columns that all tables of states of rest share, from the stability on; below, the cells of one state in them.
std::vector<OutputColumn> rest_columns();
std::string rest_cells(const Equilibrium& e);

std::string equilibria_csv(const Equilibria& all);
// Throws InputError with line and column.
Equilibria read_equilibria(const std::string& path);
std::vector<OutputColumn> equilibria_columns();

}  // namespace ropewalk
