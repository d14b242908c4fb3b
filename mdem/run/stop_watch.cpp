#include "run/stop_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "observe/growth.hpp"

namespace ropewalk {

using When = StopRule::When;

void StopWatch::add(const LogRow& row) {
  if (!rules_.empty()) rows_.push_back(row);
}

void StopWatch::cut(std::int64_t step) {
  while (!rows_.empty() && rows_.back()["step"] > static_cast<double>(step)) rows_.pop_back();
}

std::string StopWatch::decided(const std::vector<LimitRecord>& passed) const {
  if (rows_.empty()) return "";
  for (const StopRule& rule : rules_)
    if (const std::string words = decided(rule, passed); !words.empty())
      return fmt::format("{} {:.4g} ps: {}", decided_words, rows_.back()["time_ps"], words);
  return "";
}

std::string StopWatch::decided(const StopRule& rule, const std::vector<LimitRecord>& passed) const {
  const double now = rows_.back()["time_ps"];
  if (now < rule.from) return "";
  if (rule.when == When::limit) {
    for (const LimitRecord& r : passed)
      if (r.passed && (rule.limit.empty() || r.key == rule.limit)) return fmt::format("limits.{} is passed", r.key);
    return "";
  }
  if (rule.when == When::shape) {
    if (shape_of(rows_.back(), rows_.front()) != rule.shape) return "";
    return fmt::format("the shape of the rope is {}", name_of(rule.shape));
  }
  const double value = rows_.back()[rule.column];
  if (rule.when == When::above || rule.when == When::below) {
    const bool above = rule.when == When::above;
    if (!(above ? value > rule.value : value < rule.value)) return "";
    return fmt::format("{} is {:.4g}, {} {:.4g}", rule.column, value, above ? "above" : "below", rule.value);
  }
  const double begin = now - rule.over;
  if (begin < std::max(rule.from, rows_.front()["time_ps"])) return "";
  std::vector<double> times, values;
  for (const LogRow& row : rows_)
    if (row["time_ps"] >= begin - 1e-9) times.push_back(row["time_ps"]), values.push_back(row[rule.column]);
  if (rule.when == When::steady) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (values.size() < 3 || !(*most - *least < rule.value)) return "";
    return fmt::format("{} has changed by {:.3g} in the last {:.4g} ps, less than {:.4g}", rule.column,
                       *most - *least, rule.over, rule.value);
  }
  const Growth g = growth_of(times, values);
  if (!(g.error < rule.value * std::fabs(g.rate))) return "";
  return fmt::format("{} goes as exp(rate t) with {:.4g} ± {:.2g} per ps over the last {:.4g} ps", rule.column,
                     g.rate, g.error, rule.over);
}

}  // namespace ropewalk
