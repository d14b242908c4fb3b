// Ropes that are wound by their ends: two that wind round one another, against theory; and one that is twisted to
// the left and let go, against the one that is twisted to the right.
#include <gtest/gtest.h>

#include <cmath>

#include "model/units.hpp"
#include "observe/centre_line.hpp"
#include "run/moving_scene.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

Scene scene_of(const std::string& text) {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + text, "scene.toml");
}

// Per length at the start (eV/nm) of tubes in helices at distances from the axis of which these are the squares,
// wound by `turn` per length at the start while the length becomes `stretch`, under a tension. Stretch, bending and
// twist.
double energy_of_helices(const std::vector<double>& squares, const BondStiffness& bond, double turn, double stretch,
                         double tension) {
  double energy = -tension * stretch;
  for (const double rho2 : squares) {
    const double length = std::sqrt(stretch * stretch + rho2 * turn * turn),
                 curvature = std::sqrt(rho2) * turn * turn / (length * length), twist = turn * stretch / length;
    energy += 0.5 * (bond.stretch * (length - 1) * (length - 1) + bond.bend * curvature * curvature +
                     bond.twist * twist * twist);
  }
  return energy;
}

// The least energy, and the stretch that has it.
std::pair<double, double> rest_of_helices(const std::vector<double>& squares, const BondStiffness& bond,
                                          double turn, double tension) {
  double from = 0.95, to = 1.05;
  for (int k = 0; k < 100; ++k) {
    const double a = from + (to - from) / 3, b = to - (to - from) / 3;
    if (energy_of_helices(squares, bond, turn, a, tension) < energy_of_helices(squares, bond, turn, b, tension))
      to = b;
    else
      from = a;
  }
  return {energy_of_helices(squares, bond, turn, from, tension), from};
}

// The scene that `new --kind two-ply` writes, a little faster.
TEST(TwoPly, WindsAsTheoryHasIt) {
  MovingScene rope(scene_of(
      "[plies]\nropes = 2\ntubes = 7\nlength_nm = 135.6\n[bond]\nlaw = \"harmonic\"\n[[grip]]\nend = \"lower\"\n"
      "[[grip]]\nend = \"upper\"\nz = { force_nN = 20, rate_nN_per_ps = 2 }\n"
      "about_z = { rotation_deg = [[0, 0], [20, 0], [320, 360], [440, 360]] }\n[run]\n"));
  const long steps = std::lround(rope.prepared.duration / rope.simulation.time_step());
  rope.simulation.steps(steps - steps / 8);
  rope.row();
  rope.simulation.steps(steps / 8);
  const LogRow row = rope.row();
  const Topology& topology = rope.prepared.topology;
  const State& state = rope.state();

  // The middle third of the centre lines: tan(theta) = R T.
  const std::vector<CentreLine> lines = rope_lines(topology, state);
  const CentreLine whole = centre_line(topology, state);
  const std::size_t n = whole.points.size(), from = n / 3, to = n - n / 3 - 1;
  const auto arm = [&](std::size_t k) -> Eigen::Vector2d {
    return (lines[0].points[k] - whole.points[k]).head<2>();
  };
  double turned = 0, radius = 0;
  for (std::size_t k = from; k < to; ++k) {
    const Eigen::Vector2d a = arm(k), b = arm(k + 1);
    turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    radius += 0.5 * (a.norm() + b.norm()) / static_cast<double>(to - from);
  }
  const double winding = turned / (whole.points[to].z() - whole.points[from].z());
  const double theta = std::atan(radius * winding) / units::degree;
  EXPECT_GT(theta, 6);
  EXPECT_NEAR(row["ply_angle_deg"], theta, 0.01 * theta);
  EXPECT_NEAR(radius, 0.5 * std::sqrt(7.0) * rope.prepared.spacing, 0.01 * radius) << "they still touch";
  EXPECT_EQ(row["contacts"], 24) << "and both are whole";

  // Torque and contraction of 14 helices between two discs. At the discs the ropes stand upright, for some 4 nm at
  // either end: a rope of half the length has 5 % more torque than theory, this one 2 %.
  const double length = (static_cast<double>(n) - 1) * topology.types[0].element_length,
               turn = 2 * units::pi / length, tension = 20 * units::nN_nm, step = 1e-4;
  std::vector<double> squares;
  for (int t = 0; t < topology.tubes(); ++t)
    squares.push_back(
        Vector3(state.position[static_cast<std::size_t>(topology.tube_begin[t]) + n / 2] - whole.points[n / 2])
            .head<2>()
            .squaredNorm());
  const BondStiffness& bond = topology.types[0].bond;
  const auto rest = [&](double at) { return rest_of_helices(squares, bond, at, tension); };
  const double torque = (rest(turn + step).first - rest(turn - step).first) / (2 * step) / units::nN_nm,
               seen = 0.5 * (row["torque_upper_nN_nm"] + row["torque_lower_nN_nm"]);
  EXPECT_GT(torque, 1.1 * topology.tubes() * bond.twist * turn / units::nN_nm) << "twist alone";
  EXPECT_NEAR(seen, torque, 0.035 * torque);
  EXPECT_NEAR(row["ends_apart_nm"], rest(turn).second * length, 0.1 * (1 - rest(turn).second) * length);
}

// The scene and its mirror image in the plane y = 0. Loaded, held, let go.
TEST(LeftHandedTwist, IsTheMirrorImage) {
  const std::string scene =
      "[rope]\ntubes = 7\nlength_nm = 27\n[contact]\nprecision = \"double\"\n[start]\nwave_nm = 0.5\n[twist]\n"
      "moment_nN_nm = 10\nrate_nN_nm_per_ps = 2\nhold_ps = 5\nunload_rate_nN_nm_per_ps = 2\nunloaded_ps = 10\n";
  MovingScene right(scene_of(scene)), left(scene_of(scene + "hand = \"left\"\n"));
  const long steps = std::lround(right.prepared.duration / right.simulation.time_step());
  double most_moment = 0, most_twist = 0;
  for (int part = 0; part < 8; ++part) {
    right.simulation.steps(steps / 8);
    left.simulation.steps(steps / 8);
    const LogRow r = right.row(), l = left.row();
    for (const char* mirrored : {"moment_nN_nm", "torque_upper_nN_nm", "torque_lower_nN_nm", "rotation_deg",
                                 "physical_twist_deg", "geometric_twist_deg", "writhe"})
      EXPECT_NEAR(l[mirrored], -r[mirrored], 1e-7 * (1 + std::fabs(r[mirrored]))) << mirrored;
    for (const char* same : {"stretch_eV",
                             "bend_eV",
                             "twist_eV",
                             "vdw_eV",
                             "kinetic_eV",
                             "work_eV",
                             "dissipated_eV",
                             "work_upper_eV",
                             "work_lower_eV",
                             "stored_MJ_per_kg",
                             "ends_strain",
                             "most_tension_nN",
                             "most_curvature_per_nm",
                             "slip_nm",
                             "beta_deg",
                             "Q",
                             "void_area_nm2",
                             "radius_mid_nm",
                             "amplitude_nm",
                             "largest_bond_twist_deg",
                             "core_pressure_GPa"})
      EXPECT_NEAR(l[same], r[same], 1e-7 * (1 + std::fabs(r[same]))) << same;
    most_moment = std::max(most_moment, r["moment_nN_nm"]);
    most_twist = std::max(most_twist, r["physical_twist_deg"]);
    if (part == 7) {
      EXPECT_EQ(r["moment_nN_nm"], 0) << "let go";
      EXPECT_FALSE(std::signbit(l["moment_nN_nm"])) << "a log has no -0";
      EXPECT_LT(std::fabs(r["physical_twist_deg"]), 0.6 * most_twist);
      EXPECT_LT(std::fabs(r["balance_eV"]), 1e-3 * r["work_eV"]);
      EXPECT_GT(r["work_upper_eV"], 0) << "more goes in than comes back";
    }
  }
  EXPECT_EQ(most_moment, 10);
  EXPECT_GT(most_twist, 20);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
