// Schedules in a scene: a list of points in time.
#pragma once

#include <string>
#include <vector>

#include "io/toml_table.hpp"
#include "sim/dynamics/schedule.hpp"

namespace ropewalk {

// key = [[0, 300], [100, 400]]: times in ps, rising from 0 on, and values within the bounds.
std::vector<Schedule::Point> points_in_time(const TomlTable& table, const std::string& key, const Bounds& bounds);

}  // namespace ropewalk
