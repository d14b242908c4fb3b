#include "run/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/stages.hpp"

namespace ropewalk {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<LogRow> rows_of_all_stages(const RunDirectory& run) {
  std::vector<LogRow> rows;
  RunDirectory stage{run.path.substr(0, run.path.size() - stage_of(run).size())};
  for (; stage.path != run.path; stage = finer_directory(stage))
    for (LogRow& row : read_log(stage.log())) rows.push_back(std::move(row));
  const std::vector<LogRow> last = read_log(run.log());
  while (!rows.empty() && !last.empty() && rows.back()["time_ps"] >= last.front()["time_ps"]) rows.pop_back();
  rows.insert(rows.end(), last.begin(), last.end());
  return rows;
}

// The value of a column at a time, on the line through the rows around it; not a number where no rows enclose it.
double value_at(const std::string& column, double time, const std::vector<LogRow>& rows) {
  constexpr double same = 1e-6;  // ps, since times of the log are rounded
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double now = rows[k]["time_ps"];
    if (std::fabs(now - time) <= same) return rows[k][column];
    if (now < time) continue;
    if (k == 0) return none;
    const double before = rows[k - 1]["time_ps"], share = (time - before) / (now - before);
    return (1 - share) * rows[k - 1][column] + share * rows[k][column];
  }
  // Whole steps may end a little before the duration.
  const std::size_t n = rows.size();
  const bool near = n > 1 && time - rows[n - 1]["time_ps"] < rows[n - 1]["time_ps"] - rows[n - 2]["time_ps"];
  return near ? rows.back()[column] : none;
}

}  // namespace

std::vector<Judgement> judge(const std::vector<Expectation>& expected, const std::vector<LogRow>& rows) {
  std::vector<Judgement> all;
  for (const Expectation& e : expected) {
    if (e.of_other_scene) continue;
    double value = none;
    if (!rows.empty()) value = e.at ? value_at(e.column, *e.at, rows) : rows.back()[e.column];
    Judgement j;
    j.holds = std::fabs(value - e.value) <= e.tolerance;
    const std::string when = e.at ? fmt::format("at {:.6g} ps", *e.at) : "at the end";
    if (std::isnan(value))
      j.words = fmt::format("{} has no value {}, where {:.6g} ± {:.2g} is expected", e.column, when, e.value,
                            e.tolerance);
    else
      j.words = fmt::format("{} is {:.6g} {}, {} {:.6g} ± {:.2g}", e.column, value, when,
                            j.holds ? "as expected:" : "not as expected:", e.value, e.tolerance);
    all.push_back(std::move(j));
  }
  return all;
}

std::vector<Judgement> judge(const std::vector<Expectation>& expected, const RunDirectory& run) {
  return expected.empty() ? std::vector<Judgement>() : judge(expected, rows_of_all_stages(run));
}

int missed(const std::vector<Judgement>& all) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), [](const Judgement& j) { return !j.holds; }));
}

}  // namespace ropewalk
