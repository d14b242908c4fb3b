// Eigenvalues of states at rest against exact ones: the waves of a chain, and a tube under couples of fixed
// direction.
#include "sim/dynamics/modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "observe/mode_shape.hpp"
#include "plan/sliding_rope.hpp"
#include "scene/ends/grip.hpp"
#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "sim/statics/reduction.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::element_length;

// A straight tube along z, each element turned by `turn` more than the one before.
Simulation tube(int elements, double turn = 0, const LoadsAndConstraints& loads = {}, double bond_damping = 0) {
  Topology topology = test::published_topology();
  topology.add_tube(elements);
  State s(static_cast<std::size_t>(elements));
  for (int e = 0; e < elements; ++e) {
    s.position.set(static_cast<std::size_t>(e), Vector3(0, 0, e * element_length));
    s.orientation.set(static_cast<std::size_t>(e), test::turn(Vector3::UnitZ(), e * turn));
  }
  Interaction in;
  in.damping.bond.rate = bond_damping;
  return Simulation(topology, in, loads, s, 0.001);
}

Simulation twisted_tube(int elements, double moment) {
  Topology topology = test::published_topology();
  topology.add_tube(elements);
  TwistLoad twist;
  twist.moment = moment;
  LoadsAndConstraints loads;
  add_twist(twist, topology, loads);
  return tube(elements, std::asin(moment * element_length / test::published_bond().twist), loads);
}

Modes modes_of(const Simulation& s, const ModeSearch& search) {
  std::string why;
  return modes_of(tangent_of(s), *reduction_of(s, why), search);
}

double nearest(const Modes& found, std::complex<double> wanted) {
  double best = 1e9;
  for (const Mode& mode : found.modes) best = std::min(best, std::abs(mode.rate - wanted));
  return best;
}

// Frequencies of a free chain of N: 2 (k/m)^1/2 sin(n pi/2N).
TEST(Modes, OfAChainAreItsWaves) {
  constexpr int n = 7;
  const Simulation s = tube(n);
  const TubeType& type = s.topology().types[0];
  const Modes found = modes_of(s, {80, 5.0});
  const double sound = std::sqrt(type.bond.stretch / element_length / type.mass),
               torsion = std::sqrt(type.bond.twist / element_length / type.inertia);
  for (int k = 1; k < n; ++k)
    for (const double each : {sound, torsion}) {
      const double frequency = 2 * each * std::sin(k * units::pi / (2 * n));
      EXPECT_LT(nearest(found, {0, frequency}), 1e-5 * frequency) << k;
    }
  for (const Mode& mode : found.modes) EXPECT_LT(mode.rate.real(), 5 * neutral_below(found)) << mode.rate;
}

// Bond damping takes lambda (1 - cos q) from the waves of stretch: s^2 + lambda (1 - cos q) s + w^2 = 0 with the
// frequency w above.
TEST(Modes, DecayAsTheDampingSays) {
  constexpr int n = 7;
  constexpr double rate = 0.8;
  const Simulation s = tube(n, 0, {}, rate);
  const TubeType& type = s.topology().types[0];
  const Modes found = modes_of(s, {80, 5.0});
  for (int k = 1; k < n; ++k) {
    const double q = k * units::pi / n, decay = 0.5 * rate * (1 - std::cos(q)),
                 w = 2 * std::sqrt(type.bond.stretch / element_length / type.mass) * std::sin(q / 2);
    EXPECT_LT(nearest(found, {-decay, std::sqrt(w * w - decay * decay)}), 1e-5 * w) << k;
  }
}

// Without the motions that meet no stiffness the others are the same.
TEST(Modes, OfATwistedTubeAreTheSameWithoutNeutralOnes) {
  const Simulation s = twisted_tube(40, 70 * units::nN_nm);
  const Modes all = modes_of(s, {24, 0.05}), some = modes_of(s, {6, 0.05, true});
  ASSERT_GT(all.modes.front().rate.real(), 0.01);
  for (const Mode& mode : some.modes) {
    EXPECT_GT(std::abs(mode.rate), 1e-6);
    EXPECT_LT(nearest(all, mode.rate), 1e-5);
  }
}

// A beam with free ends: (4.73004/L)^2 (EI/m)^1/2, here with the inertia of its elements.
TEST(Modes, TheSlowestOfAFreeTubeBendsIt) {
  constexpr int n = 60;
  const Simulation s = tube(n);
  const TubeType& type = s.topology().types[0];
  const Modes found = modes_of(s, {20, 0.05});
  const double length = n * element_length, frequency = std::pow(4.73004074 / length, 2) *
                                                        std::sqrt(type.bond.bend * element_length / type.mass);
  const Mode* bending = nullptr;
  for (const Mode& mode : found.modes)
    if (mode.rate.imag() > 0.5 * frequency && (!bending || mode.rate.imag() < bending->rate.imag()))
      bending = &mode;
  ASSERT_TRUE(bending);
  EXPECT_NEAR(bending->rate.imag(), frequency, 0.02 * frequency);
  EXPECT_LT(bending->residual, 1e-8);
  const ModeShape shape = shape_of(s.topology(), s.state(), tangent_of(s).mass, *bending);
  EXPECT_GT(shape.shares.sideways, 0.98);
  EXPECT_EQ(shape.half_waves, 1);
  EXPECT_STREQ(shape.name(), "sideways");
}

// The tube of 67.8 nm under couples of fixed direction: straight below 8.987 EI/L, and beyond it at the rates of
// the theory of rods (plan/sliding_rope.hpp), which has no slip here.
TEST(Modes, ATwistedTubeGrowsAsTheTheoryOfRodsSays) {
  constexpr int n = 50;
  const TubeType type = test::published_topology().types[0];
  const SlidingRope rod{n * element_length, type.bond.bend, type.mass / element_length, 0};
  const double critical = rod.static_moment();
  EXPECT_NEAR(critical / units::nN_nm, 47.51, 0.01);
  const auto growth = [&](double over) {
    const Modes found = modes_of(twisted_tube(n, over * critical), {12, 0.05});
    const double rate = found.modes.front().rate.real();
    return rate < neutral_below(found) ? 0 : rate;
  };
  EXPECT_EQ(growth(0.97), 0);
  for (const double over : {1.05, 1.1, 1.2, 1.5}) {
    const double theory = rod.growth(over * critical, 1);
    EXPECT_NEAR(growth(over), theory, 0.08 * theory) << over;
  }
}

// u'' = a + c exp(iMz/EI) of a rod at its critical moment, and a bending moment of 0, 1/2 or 1 times iM u' at its
// ends for a follower, a couple with a potential and one of fixed direction. Free rods bear 2 pi EI/L of the second
// kind; of the other two the deflection, or its curvature, obeys the equation of a clamped rod with tan x = x.
// Pinned ones bear 2 pi of the first and the third kind and of the second x with tan(x/2) = -x/6; a cantilever pi.
TEST(Modes, ATubeBucklesAtTheMomentOfItsEndsAndOfItsCouples) {
  using A = TwistLoad::Application;
  constexpr int n = 60;
  constexpr double clamped = 8.98681892, half_pinned = 4.91128773;
  enum class Ends { free, pinned, clamped, cantilever };
  const auto growing = [&](Ends ends, A couple, double number) {
    Topology topology = test::published_topology();
    topology.add_tube(n);
    BondStiffness& bond = topology.types[0].bond;
    bond.twist *= 20;  // hardly turns, so that bonds twist in proportion
    const double moment = number * bond.bend / ((n - 1) * element_length);
    TwistLoad twist;
    twist.moment = moment;
    twist.application = couple;
    LoadsAndConstraints loads;
    add_twist(twist, topology, loads);
    if (ends == Ends::pinned) {
      loads.add(FixLoad({0}, true, true, true, false));
      loads.add(FixLoad({n - 1}, true, true, false, false));
    }
    if (ends != Ends::free && ends != Ends::pinned) loads.add(FixLoad({0}));
    if (ends == Ends::clamped) {
      GripLoad grip;
      grip.axes[GripLoad::z].is = grip.axes[GripLoad::about_z].is = GripAxis::Is::free;
      loads.add(grip.on_elements({n - 1}, topology));
    }
    State s(static_cast<std::size_t>(n));
    const double turn = std::asin(moment * element_length / bond.twist);
    for (int e = 0; e < n; ++e) {
      s.position.set(static_cast<std::size_t>(e), Vector3(0, 0, e * element_length));
      s.orientation.set(static_cast<std::size_t>(e), test::turn(Vector3::UnitZ(), e * turn));
    }
    const Modes found = modes_of(Simulation(topology, {}, loads, s, 0.001), {12, 0.05});
    return std::count_if(found.modes.begin(), found.modes.end(),
                         [&](const Mode& mode) { return mode.rate.real() > std::max(2e-3, neutral_below(found)); });
  };
  struct Case {
    Ends ends;
    A couple;
    double number;
  };
  for (const Case& c :
       {Case{Ends::free, A::couple, clamped}, Case{Ends::free, A::follower, clamped},
        Case{Ends::free, A::conservative, 2 * units::pi}, Case{Ends::pinned, A::couple, 2 * units::pi},
        Case{Ends::pinned, A::follower, 2 * units::pi}, Case{Ends::pinned, A::conservative, half_pinned},
        Case{Ends::clamped, A::couple, clamped}, Case{Ends::cantilever, A::conservative, units::pi}}) {
    const std::string which = std::to_string(static_cast<int>(c.ends)) + std::to_string(static_cast<int>(c.couple));
    const auto below = growing(c.ends, c.couple, 0.96 * c.number);
    EXPECT_EQ(below, c.ends == Ends::free && c.couple == A::conservative ? 2 : 0) << which;
    EXPECT_GT(growing(c.ends, c.couple, 1.05 * c.number), below) << which;
  }
}

TEST(Modes, HeldUnknownsDoNotMove) {
  LoadsAndConstraints loads;
  loads.add(FixLoad({0}));
  const Simulation s = tube(30, 0, loads);
  const TubeType& type = s.topology().types[0];
  const Modes found = modes_of(s, {12, 0.05});
  // A cantilever: its end element is held whole.
  const double length = 29.5 * element_length, frequency = std::pow(1.87510407 / length, 2) *
                                                           std::sqrt(type.bond.bend * element_length / type.mass);
  double lowest = 1e9;
  for (const Mode& mode : found.modes) {
    if (std::abs(mode.rate) > 1e-3) lowest = std::min(lowest, mode.rate.imag());
    EXPECT_EQ(mode.shape.head<6>().norm(), 0);
  }
  EXPECT_NEAR(lowest, frequency, 0.03 * frequency);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
