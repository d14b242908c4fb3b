// The results of a run as numbers, which the prompt, the report and all tables share.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "io/outputs.hpp"

namespace ropewalk {

// Rows of the log before the first limit was passed; all where none was.
std::size_t rows_within(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits);

// nN nm: the torque about z that twists a rope, the mean over both ends where both are held, else that of the held
// end.
std::function<double(const LogRow&)> torque_of(const std::vector<LogRow>& log);

// A quantity that curves show: a column of the log, or torque_nN_nm, which is torque_of().
struct CurveColumn {
  std::string quantity, unit, meaning;
  bool whole = false;  // integers
  std::function<double(const LogRow&)> value;
};
// `log`: of the run. Throws InputError where there is no such column.
CurveColumn curve_column(const std::string& name, const std::vector<LogRow>& log,
                         const InputError::Place& place = {});

// Degrees: the rotation of the upper end at this time, ps, between two rows; NaN where there are none.
double rotation_at(const std::vector<LogRow>& log, double time);

struct TubeBreak {
  double time_ps = 0;
  int tube = 0, element = 0;  // from 0; the element before the break, counted in the tube
  std::string held_by = {};   // as LimitRecord::passed_held_by
};

struct RunResults {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::string first_limit;  // key of the limit that was passed first; empty: none was
  double first_limit_ps = none;
  double first_limit_deg = none;  // rotation of a twisted rope at that time
  double torque_max = none;                              // nN nm: the largest absolute torque_of() of a row
  double torque_max_deg = none, torque_max_ps = none;    // rotation and time of that row
  bool torque_fell = false;                              // below 95 % of it by the end
  double torque_within = none;                           // nN nm: the same of the rows before the first limit
  double bending_max = none, bending_max_ps = none;      // nN nm: largest moment across z on an end; of a bent rope
  bool bending_fell = false;                             // below 95 % of it by the end
  double first_break_deg = none, first_break_ps = none;  // first break of a tube
  TubeBreak first_break;
  int tubes_broken = 0;
  // GPa, N/tex, strain since the pull began (io/pull.hpp): at the largest stress; where ends are drawn apart.
  double strength = none, strength_N_per_tex = none, strength_strain = none;
  std::string no_strength;  // why the largest stress is no strength; empty: it is one, or nothing is drawn apart
  bool stress_fell = false;
  double stored_at_limit = none;  // MJ/kg: of the last row before the first limit; without one, the largest
  double links_formed = 0, links_broken = 0, bonds_broken = 0;  // counts in the last row
};

RunResults run_results(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits,
                       const std::vector<TubeBreak>& breaks);

// Columns for tables of runs, and their cells, without a comma at either end.
std::vector<OutputColumn> limit_columns();
std::string limit_cells(const std::vector<LimitRecord>& limits);
std::vector<OutputColumn> result_columns();
std::string result_cells(const RunResults& results);
// The same by name; NaN: the run has no such value.
std::vector<double> result_values(const RunResults& results);

// A sentence each: bending moment, torque and first break, strength, stored energy. `errors`: of result_values(), nan
// where none is known; empty: none is.
std::vector<std::string> result_sentences(const RunResults& results, const std::vector<double>& errors = {});

}  // namespace ropewalk
