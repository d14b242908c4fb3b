// [[stop]] a run ends early where its question is decided.
#pragma once

#include <string>

#include "observe/rope_shape.hpp"

namespace ropewalk {

struct StopRule {
  enum class When { above, below, steady, growth, limit, shape };
  When when = When::above;
  std::string column;  // column of the log
  double value = 0;    // above, below: in the column's unit; steady: the largest change; growth: the relative error
  double over = 20;    // span of the last rows that steady and growth look at, ps
  double from = 0;     // ps, before which the rule does not look
  std::string limit;   // a key of [limits]; empty: any of them
  RopeShape shape = RopeShape::helix;
};

}  // namespace ropewalk
