#include "scene/schedule_rows.hpp"

#include <fmt/format.h>

#include "scene/bounds.hpp"

namespace ropewalk {

std::vector<Schedule::Point> points_in_time(const TomlTable& t, const std::string& key, const Bounds& bounds) {
  std::vector<Schedule::Point> points;
  for (const std::vector<double>& row : t.rows(key, Bounds::any(), 2)) {
    if (row[0] < 0 || row[0] > longest_time || (!points.empty() && row[0] <= points.back().time))
      throw t.error(key, fmt::format("has the time {} ps in point {}", row[0], points.size() + 1),
                    "times rise from one point to the next, from 0 on");
    if (!bounds.allow(row[1]))
      throw t.error(
          key, fmt::format("has the value {} in point {}, which {}", row[1], points.size() + 1, bounds.words()),
          "write points [[ps, value], ...]");
    points.push_back({row[0], row[1]});
  }
  return points;
}

}  // namespace ropewalk
