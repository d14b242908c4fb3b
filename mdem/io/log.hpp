// log.csv: one row per logged time, one column per observable. A new column is an entry of observe/observables.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/error.hpp"
#include "observe/observables.hpp"
#include "observe/rope_shape.hpp"

namespace ropewalk {

// The values of all observables at one time, each by its name: row["beta_deg"].
class LogRow {
 public:
  LogRow() : values_(observables().size()) {}
  explicit LogRow(const Measurement& measurement);

  // Throws std::invalid_argument where no observable has this name.
  double& operator[](std::string_view name) { return values_[index_of_observable(name)]; }
  double operator[](std::string_view name) const { return values_[index_of_observable(name)]; }

  // Values of one row, in the order of observables().
  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_;
};

// The shape of the rope in a row of the log that begins with the row `first`.
RopeShape shape_of(const LogRow& row, const LogRow& first);

// eV: bonds, contacts and force terms.
double potential_energy(const LogRow& row);

// Which part of the lost energy numerical damping has taken, and what that means. Empty: a hundredth of the work or
// less is lost, or less than a tenth of it to damping.
std::string damping_words(const LogRow& row);

// The row with the largest stress; null where no end pulls.
const LogRow* strongest_row(const std::vector<LogRow>& log);

std::string log_header();
std::string log_line(const LogRow& row);  // full precision: reading it back gives the same bits

// Index of a column that a user names at `place`. Throws InputError where the log has none of this name.
std::size_t column_of_log(const std::string& name, const InputError::Place& place);

// Throws InputError with line and column. A last line without a newline, as after a kill, is left out, since its
// last number may lack digits.
std::vector<LogRow> read_log(const std::string& path);

// Throws InputError if the file has other columns than this program writes.
void check_log_header(const std::string& path);

}  // namespace ropewalk
