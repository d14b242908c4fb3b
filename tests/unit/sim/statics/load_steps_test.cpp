// Times of states of rest along the schedules of loads, and their table.
#include "sim/statics/load_steps.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "io/equilibria.hpp"
#include "io/files.hpp"
#include "scene/ends/grip.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/force.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

Topology tube() {
  Topology topology = test::published_topology();
  topology.add_tube(6);
  return topology;
}

GripLoad grip(std::size_t axis, GripAxis::Is is, std::vector<Schedule::Point> points) {
  GripLoad out;
  out.axes[axis].is = is;
  out.axes[axis].points = std::move(points);
  return out.on_elements({5}, tube());
}

TEST(LoadSteps, AreEvenAlongARamp) {
  LoadsAndConstraints loads;
  TwistLoad twist;
  twist.moment = 20;
  twist.rate = 2;
  twist.hold = 100;  // in which nothing changes
  add_twist(twist, tube(), loads);
  EXPECT_EQ(load_step_times(loads, 4), (std::vector<double>{0, 2.5, 5, 7.5, 10}));
}

TEST(LoadSteps, MeetEveryTurnOfASchedule) {
  LoadsAndConstraints loads;
  loads.add(grip(GripLoad::about_z, GripAxis::Is::moved, {{0, 0}, {10, 1}, {50, 1}, {60, 0}}));
  EXPECT_EQ(load_step_times(loads, 4), (std::vector<double>{0, 5, 10, 55, 60}));
  // One after the other: a short stretch has a step as well, and few steps become as many as there are stretches.
  loads.add(grip(GripLoad::z, GripAxis::Is::loaded, {{20, 0}, {21, 3}}));
  EXPECT_EQ(load_step_times(loads, 5), (std::vector<double>{0, 5, 10, 21, 55, 60}));
  EXPECT_EQ(load_step_times(loads, 1), (std::vector<double>{0, 10, 21, 60}));
}

TEST(LoadSteps, AreNoneWhereNothingChanges) {
  LoadsAndConstraints loads;
  loads.add(ForceLoad({5}, {1, 0, 0}));
  loads.add(grip(GripLoad::z, GripAxis::Is::loaded, {{0, 3}}));
  TwistLoad twist;
  twist.moment = 20;
  add_twist(twist, tube(), loads);
  EXPECT_TRUE(load_step_times(loads, 10).empty());
}

TEST(Equilibria, AreReadAsTheyWereWritten) {
  Equilibrium a, b;
  a.step = 12;
  a.time = 0.1 + 0.2;
  a.stability = Equilibrium::Stability::unstable;
  a.growth = 4.25;
  a.error = 0.1;
  a.saddles = 2;
  b.step = 40;
  b.force = 1e-5;
  b.moment = 2e-5;
  b.above = 3e-9;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("equilibria-" + std::to_string(::getpid()) + ".csv")).string();
  write_file_atomically(path, equilibria_csv({a, b}));
  const Equilibria read = read_equilibria(path);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(equilibria_csv(read), equilibria_csv({a, b}));
  EXPECT_EQ(read[0].time, a.time);
  EXPECT_EQ(read[0].stability, Equilibrium::Stability::unstable);
  EXPECT_TRUE(std::isnan(read[1].growth));
  std::filesystem::remove(path);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
