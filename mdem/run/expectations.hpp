// Whether a run gave what its scene expects: the [[expect]] tables.
#pragma once

#include <string>
#include <vector>

#include "io/log.hpp"
#include "run/run_directory.hpp"
#include "scene/expectation.hpp"

namespace ropewalk {

// Exit code of a program whose run did not give what was expected.
inline constexpr int not_as_expected = 8;

struct Judgement {
  bool holds = false;
  std::string words;  // "geometric_twist_deg is 162.6 at 100 ps, as expected: 162.4 ± 0.5"
};

// Without those of another scene (Expectation::of_other_scene). Rows in the order of time. A column without a value
// at that time, or a time that no rows enclose, is a miss.
std::vector<Judgement> judge(const std::vector<Expectation>& expected, const std::vector<LogRow>& rows);

// The same of the log of a run, and of the stages before it where its elements were split.
std::vector<Judgement> judge(const std::vector<Expectation>& expected, const RunDirectory& run);

// How many do not hold.
int missed(const std::vector<Judgement>& all);

}  // namespace ropewalk
