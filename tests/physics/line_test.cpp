// The line law in the simulator: what rows of elements make of it.
#include <gtest/gtest.h>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

LineContact contact(double radius_i, double radius_j) {
  const LineDensity density = test::line_density(radius_i, radius_j);
  const int nodes = line_nodes(test::element_length, line_parallel_well(density).distance, density.contact);
  return {density, test::element_length, test::element_length, nodes, nodes};
}

// Energy per length of a long row beside one element, shifted along it.
double row_energy(const LineContact& k, double distance, double shift) {
  double sum = 0;
  for (int e = -6; e <= 6; ++e)
    sum += k.energy({distance, 0, e * k.length_j + shift}, Vector3::UnitZ(), Vector3::UnitZ());
  return sum / k.length_i;
}

// Energy of two long rows crossing at `angle`, displaced along both.
double crossing_energy(const LineContact& k, double distance, double angle, double a, double b) {
  const Vector3 ni = Vector3::UnitZ(), nj(0, std::sin(angle), std::cos(angle));
  const int reach = static_cast<int>(4.0 / (test::element_length * std::sin(angle))) + 3;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      sum += k.energy(Vector3(distance, 0, 0) + (j * k.length_j + b) * nj - (i * k.length_i + a) * ni, ni, nj);
  return sum;
}

struct Spread {
  double low = 1e300, high = -1e300;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double width() const { return high - low; }
};

class LineRows : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(LineRows, ParallelRowsSlideWithoutFeelingTheirElements) {
  const LineContact k = contact(GetParam().first, GetParam().second);
  const LineWell well = line_parallel_well(k.density);
  for (const auto& [inside, bound] : {std::pair(0.0, 2e-4), std::pair(0.05, 4e-3)}) {
    Spread s;
    for (int n = 0; n < 40; ++n) s.add(row_energy(k, well.distance - inside, n * test::element_length / 40));
    EXPECT_LT(s.width(), bound * std::fabs(well.energy)) << inside << " nm inside of the well";
    EXPECT_NEAR(s.low, line_parallel_energy(k.density, well.distance - inside), 1e-3 * std::fabs(well.energy));
  }
}

TEST_P(LineRows, CrossedRowsSlideToo) {
  const LineContact k = contact(GetParam().first, GetParam().second);
  for (const double angle : {3.0,  5.0,  7.0,  8.0,  9.0,  10.0, 11.0, 12.0, 13.0, 14.0, 16.0,
                             18.0, 19.0, 20.0, 22.0, 25.0, 28.0, 30.0, 45.0, 60.0, 90.0}) {
    const LineWell well = line_crossed_well(k.density, angle * units::degree);
    Spread s;
    for (int n = 0; n < 9; ++n)
      s.add(crossing_energy(k, well.distance, angle * units::degree, (n / 3) * k.length_i / 6,
                            (n % 3) * k.length_j / 6));
    EXPECT_LT(s.width(), 1e-3 * std::fabs(well.energy)) << angle << " deg";
    EXPECT_NEAR(s.low, well.energy, 1e-3 * std::fabs(well.energy)) << angle << " deg";
  }
}

// Energy of two finite parallel tubes at rest, one of them drawn out by `shift`.
double drawn_out(const LineContact& k, double shift) {
  constexpr int elements = 14;
  const double distance = line_parallel_well(k.density).distance;
  double sum = 0;
  for (int i = 0; i < elements; ++i)
    for (int j = 0; j < elements; ++j) {
      sum += k.energy({distance, 0, (j - i) * k.length_j + shift}, Vector3::UnitZ(), Vector3::UnitZ());
    }
  return sum;
}

// The force of pull-out is the binding energy of a length; where the ends stand against the nodes shows by 2 %, and
// not in the mean over a node spacing.
TEST_P(LineRows, PullOutHardlyFeelsTheNodes) {
  const LineContact k = contact(GetParam().first, GetParam().second);
  const double well = std::fabs(line_parallel_well(k.density).energy), h = 1e-3;
  constexpr int shifts = 24;
  double mean = 0;
  for (int n = 0; n < shifts; ++n) {
    const double shift = (4 + static_cast<double>(n) / shifts) * k.length_j;
    const double force = (drawn_out(k, shift + h) - drawn_out(k, shift - h)) / (2 * h);
    EXPECT_NEAR(force, well, 0.02 * well) << shift;
    mean += force / shifts;
  }
  EXPECT_NEAR(mean, well, 1e-3 * well);
}

INSTANTIATE_TEST_SUITE_P(Radii, LineRows,
                         ::testing::Values(std::pair(0.6785, 0.6785), std::pair(0.34, 0.34),
                                           std::pair(0.6785, 0.34)));

struct LineBundle {
  Topology topology = test::published_topology();
  Interaction in;
  State state;
  double spacing = 0;

  explicit LineBundle(double temperature, int elements = 5,
                      Interaction::Precision precision = Interaction::Precision::full) {
    in.precision = precision;
    in.law = line_law({contact(0.6785, 0.6785)});
    spacing = line_parallel_well(contact(0.6785, 0.6785).density).distance;
    state = test::disordered_bundle(topology, 7, elements, spacing, 0, 1);
    test::set_velocities(topology, temperature, state);
  }
  Simulation make(double dt) const { return Simulation(topology, in, {}, state, dt); }
};

double fluctuation(Simulation& s, double ps) {
  double n = 0, sum = 0, squares = 0;
  const double first = s.total_energy();
  for (long k = 0; k < static_cast<long>(ps / s.time_step()); ++k) {
    s.step();
    const double e = s.total_energy() - first;
    n += 1, sum += e, squares += e * e;
  }
  return std::sqrt(std::max(squares / n - sum * sum / n / n, 0.0));
}

class LineBundles : public ::testing::TestWithParam<Interaction::Precision> {};

TEST_P(LineBundles, KeepTheirEnergyOverOneNanosecond) {
  const LineBundle b(10, 5, GetParam());
  const double dt = default_step_fraction * time_step_limit(b.topology, b.in, b.spacing).limit;
  Simulation s = b.make(dt);
  const double before = s.total_energy();
  const double scatter = fluctuation(s, 1000);
  EXPECT_LT(scatter, 1e-4 * std::fabs(before)) << before << " eV, step " << dt << " ps";
  EXPECT_NEAR(s.total_energy(), before, 3e-4 * std::fabs(before));
}

INSTANTIATE_TEST_SUITE_P(Precisions, LineBundles,
                         ::testing::Values(Interaction::Precision::full, Interaction::Precision::mixed),
                         [](const auto& info) {
                           return info.param == Interaction::Precision::full ? "Double" : "Mixed";
                         });

TEST(LineBundle, EnergyErrorFallsWithTheSquareOfTheStep) {
  const LineBundle b(10);
  Simulation coarse = b.make(0.016), fine = b.make(0.008);
  EXPECT_NEAR(fluctuation(coarse, 300) / fluctuation(fine, 300), 4, 0.8);
}

TEST(LineBundle, RelaxesToTheSpacingOfItsLaw) {
  LineBundle b(0, 20);
  Simulation s = b.make(0.01);
  ASSERT_TRUE(s.relax(1e-6, 100000, [](long) { return true; }));
  const Vector3 centre = s.state().position[10];
  for (int t = 1; t < 7; ++t) {
    const Vector3 d = s.state().position[static_cast<std::size_t>(20 * t + 10)] - centre;
    EXPECT_NEAR(std::hypot(d.x(), d.y()), b.spacing, 1e-3 * b.spacing);
  }
  EXPECT_LT(net_force(s.state(), s.forces()).torque.norm(), 1e-6);
}

struct RelaxedRope {
  Simulation simulation;
  Relaxed end;
  double energy_before = 0;  // eV
};
RelaxedRope relaxed(const std::string& rope, long max_steps) {
  Scene scene = scene_of_text("format = \"ropewalk-scene-1\"\n" + rope + "[run]\nmode = \"relax\"\n", "rope.toml");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double before = s.total_energy();
  const Relaxed end = s.relax(scene.run.goal, max_steps, [](long) { return true; });
  return {std::move(s), end, before};
}

// It rattles there: on the axis no force acts on it, and beside the axis the energy is lower.
TEST(LineBundle, RelaxationMovesAThinTubeOutOfTheMiddleOfSixWideOnes) {
  auto [s, end, before] = relaxed(
      "parameters = [\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]\n"
      "tube_types = [1, 0, 0, 0, 0, 0, 0]\n[rope]\ntubes = 7\nlength_nm = 7\n",
      12000);
  EXPECT_GE(end.saddles, 1);
  EXPECT_LT(s.forces().energy.potential(), -50.7);  // on the axis: -42.1 eV
  EXPECT_NEAR(before, -42.1, 0.1);
  EXPECT_NEAR(s.total_energy() - s.account().supplied(), before, 1e-3);
}

// The rope would twist by itself, very slowly (docs/theory.md, relaxation).
TEST(LineBundle, RelaxationOfAStraightRopeStaysOnItsShallowSaddleAndSaysSo) {
  auto [s, end, before] = relaxed("parameters = \"cnt-5-5-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 10\n", 3000);
  EXPECT_TRUE(end.at_rest);
  EXPECT_EQ(end.saddles, 0);
  EXPECT_GT(end.falls, 1e-5);
  EXPECT_LT(end.falls, 1e-4 * std::fabs(s.forces().energy.vdw));
}

// Twice the load under which each tube buckles; the contact's energy is ten times that of the bonds.
TEST(LineBundle, RelaxationLeavesTheSaddleOfARopeFarAboveItsBucklingLoad) {
  auto [s, end, before] = relaxed(
      "parameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 31.7\n"
      "[[load]]\nkind = \"fix\"\nelements = \"ends\"\naxes = \"xy\"\nrotation = false\n"
      "[[load]]\nkind = \"force\"\nelements = [0]\nforce_nN = [0, 0, 9]\n"
      "[[load]]\nkind = \"force\"\nelements = [-1]\nforce_nN = [0, 0, -9]\n",
      6000);
  EXPECT_GE(end.saddles, 1);
  EXPECT_GT(s.forces().energy.bend, 100);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
