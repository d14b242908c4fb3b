// Whether the question of a run is decided, by the [[stop]] rules of its scene.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "scene/stop_rule.hpp"

namespace ropewalk {

// With these words a decision begins, and so does the reason in the manifest of a run that it ended.
inline constexpr const char* decided_words = "decided at";

class StopWatch {
 public:
  StopWatch() = default;
  explicit StopWatch(std::vector<StopRule> rules) : rules_(std::move(rules)) {}

  // The step of the last row; -1: there is none.
  std::int64_t last_step() const {
    return rows_.empty() ? -1 : static_cast<std::int64_t>(std::llround(rows_.back()["step"]));
  }
  bool empty() const { return rules_.empty(); }
  void add(const LogRow& row);
  // Rows after this step did not happen.
  void cut(std::int64_t step);
  // The decision in words; empty: none yet. `passed`: limits so far.
  std::string decided(const std::vector<LimitRecord>& passed) const;

 private:
  std::string decided(const StopRule& rule, const std::vector<LimitRecord>& passed) const;

  std::vector<StopRule> rules_;
  std::vector<LogRow> rows_;
};

}  // namespace ropewalk
