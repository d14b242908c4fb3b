// Splitting every element in two: the map against chains whose rod is known, and its conserved quantities.
#include "sim/dynamics/refine.hpp"

#include <gtest/gtest.h>

#include "sim/forces/forces.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::element_length;
using test::published_topology;
using test::Random;
using test::turn;

Topology one_tube(int elements, double shear = 0) {
  Topology t = published_topology();
  t.types[0].bond.shear = shear;
  t.add_tube(elements);
  return t;
}

BondEnergy bonds_of(const Topology& topology, const State& s) {
  Forces f(s.size());
  compute_reference(topology, Interaction{}, s, f);
  return {f.energy.stretch, f.energy.shear, f.energy.bend, f.energy.twist};
}

// An element whose axis is t, turned by `roll` about it.
Quaternion along(const Vector3& t, double roll) {
  return Quaternion::FromTwoVectors(Vector3::UnitZ(), t) * turn(Vector3::UnitZ(), roll);
}

TEST(Halved, TopologyKeepsMassAndLength) {
  Topology coarse = published_topology();
  coarse.types.push_back(coarse.types[0]);
  coarse.types[1].radius = 0.34;
  coarse.add_tube(5);
  coarse.add_tube(3, 1);
  const Topology fine = halved(coarse);
  EXPECT_EQ(fine.tube_begin, (std::vector<int>{0, 10, 16}));
  EXPECT_EQ(fine.tube_type, coarse.tube_type);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(2 * fine.types[k].mass, coarse.types[k].mass);
    EXPECT_EQ(2 * fine.types[k].inertia, coarse.types[k].inertia);
    EXPECT_EQ(2 * fine.types[k].element_length, coarse.types[k].element_length);
    EXPECT_EQ(fine.types[k].radius, coarse.types[k].radius);
    EXPECT_EQ(fine.types[k].bond.bend, coarse.types[k].bond.bend);
  }
}

// An element comes between every two. The old centres and axes keep their bits, each new bond has half of the
// stretch and twist of an old one, and a rigid motion stays rigid.
TEST(Halved, ElementsBetweenLeaveTheOthersInPlace) {
  Topology coarse = published_topology();
  coarse.add_tube(5);
  coarse.add_tube(4);
  const Topology fine = halved(coarse, Splitting::between);
  EXPECT_EQ(fine.tube_begin, (std::vector<int>{0, 9, 16}));
  EXPECT_EQ(2 * fine.types[0].mass, coarse.types[0].mass);
  EXPECT_EQ(heirs(coarse, Splitting::between), (std::vector<int>{0, 2, 4, 6, 8, 9, 11, 13, 15}));
  EXPECT_EQ(heirs(coarse), (std::vector<int>{0, 2, 4, 6, 8, 10, 12, 14, 16}));
  const Vector3 axis = Vector3(1, -2, 0.5).normalized(), velocity(0.1, 0.2, -0.3), spin(0.02, -0.01, 0.03);
  const double phi = 0.4, d = 1.01 * element_length;
  State s(9);
  for (std::size_t i = 0; i < 9; ++i) {
    const double along_tube = static_cast<double>(i < 5 ? i : i - 5);
    s.position.set(i, Vector3(i < 5 ? 0 : 3, 1, -4) + d * along_tube * axis);
    s.orientation.set(i, along(axis, phi * along_tube));
    s.velocity.set(i, velocity + spin.cross(Vector3(s.position[i])));
    s.angular_velocity.set(i, spin);
  }
  const State f = halved(coarse, s, Splitting::between);
  ASSERT_EQ(f.size(), 16u);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto there = static_cast<std::size_t>(heirs(coarse, Splitting::between)[i]);
    EXPECT_EQ((f.position[there] - s.position[i]).norm(), 0);
    EXPECT_LT(f.orientation[there].angularDistance(s.orientation[i]), 1e-7);
  }
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_LT((f.velocity[i] - velocity - spin.cross(Vector3(f.position[i]))).norm(), 1e-9) << i;
    EXPECT_LT((f.angular_velocity[i] - spin).norm(), 1e-9) << i;
  }
  const BondEnergy energy = bonds_of(fine, f);
  const BondStiffness& k = fine.types[0].bond;
  EXPECT_NEAR(energy.twist, 14 * 2 * k.twist / element_length * (1 - std::cos(0.5 * phi)), 1e-8);
  EXPECT_NEAR(energy.stretch, 14 * 0.25 * k.stretch * element_length * 1e-4, 1e-8);
}

// Three and a half turns in 19 bonds, and stretched: each fine bond has half of both.
TEST(Halved, StraightTwistedStretchedChainIsExact) {
  const int n = 20;
  const double phi = 66 * units::degree, strain = 0.01, d = element_length * (1 + strain);
  const Topology coarse = one_tube(n);
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  State s(n);
  for (int e = 0; e < n; ++e) {
    const auto i = static_cast<std::size_t>(e);
    s.position.set(i, Vector3(3, 1, -4) + d * e * axis);
    s.orientation.set(i, along(axis, phi * e));
  }
  const Topology fine = halved(coarse);
  const State f = halved(coarse, s);
  ASSERT_EQ(f.size(), 2u * n);
  double roll = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_LT((f.position[i] - Vector3(3, 1, -4) - (0.5 * static_cast<double>(i) - 0.25) * d * axis).norm(), 1e-12);
    if (i > 0) roll += bond_twist_angle(frame_of(f.orientation[i - 1]), frame_of(f.orientation[i]));
  }
  EXPECT_NEAR(roll, (2 * n - 1) * phi / 2, 1e-10) << "39 half bonds";
  const Quaternion middle = along(axis, 0.25 * phi);
  EXPECT_LT(f.orientation[1].angularDistance(middle), 1e-7) << "the roll is where it was";
  const BondEnergy energy = bonds_of(fine, f);
  const BondStiffness& k = fine.types[0].bond;
  EXPECT_NEAR(energy.twist, (2 * n - 1) * 2 * k.twist / element_length * (1 - std::cos(0.5 * phi)), 1e-8);
  EXPECT_NEAR(energy.stretch, (2 * n - 1) * 0.25 * k.stretch * element_length * strain * strain, 1e-8);
  EXPECT_LT(energy.bend + energy.shear, 1e-10);
}

State ring(int n, double angle, double roll) {
  const double radius = 0.5 * element_length / std::sin(0.5 * angle);
  State s(static_cast<std::size_t>(n));
  for (int e = 0; e < n; ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Quaternion q = turn(Vector3::UnitY(), angle * e);  // carries z about y
    s.position.set(i, radius * (q * -Vector3::UnitX()));
    s.orientation.set(i, q * turn(Vector3::UnitZ(), roll * e));
  }
  return s;
}

// Bonds of 12 degrees, with and without 30 degrees of twist in each: the finer elements lie on the same circle.
TEST(Halved, RingStaysOnItsCircleWhateverItsTwist) {
  const int n = 31;
  const double angle = 12 * units::degree, radius = 0.5 * element_length / std::sin(0.5 * angle);
  const Topology coarse = one_tube(n, 2200);
  for (const double roll : {0.0, 30 * units::degree}) {
    const State f = halved(coarse, ring(n, angle, roll));
    for (std::size_t i = 0; i < f.size(); ++i) {
      const Quaternion q = turn(Vector3::UnitY(), angle * (0.5 * static_cast<double>(i) - 0.25));
      EXPECT_LT((f.position[i] - radius * (q * -Vector3::UnitX())).norm(), 1e-11) << i;
      EXPECT_LT((axis_of(f.orientation[i]) - q * Vector3::UnitZ()).norm(), 1e-12) << i;
    }
    const BondEnergy energy = bonds_of(halved(coarse), f);
    const BondStiffness& k = coarse.types[0].bond;
    const double rod = 0.5 * k.bend * angle * angle / element_length * (n - 0.5);
    EXPECT_NEAR(energy.bend / rod, 1 - angle * angle / 48, 1e-5) << "1 - cos of the half angle";
    const double twist = 0.25 * k.twist / (0.5 * element_length) * (1 + std::cos(0.5 * angle)) *
                         (1 - std::cos(0.5 * roll)) * 2 * (2 * n - 1);
    EXPECT_NEAR(energy.twist, twist, 1e-8 + 1e-9 * twist);
  }
}

// Elements of length h on a helix, axes along its tangents: how far the halves are from it (nm), and how far their
// axes from its tangents, away from the ends.
std::pair<double, double> off_the_helix(double h) {
  const double radius = 6, climb = 1.5, turn_per_length = 1 / std::hypot(radius, climb);
  const auto place = [&](double s) {
    const double p = s * turn_per_length;
    return Vector3(radius * std::cos(p), radius * std::sin(p), climb * p);
  };
  const auto tangent = [&](double s) {
    const double p = s * turn_per_length;
    return Vector3(-radius * std::sin(p), radius * std::cos(p), climb).normalized();
  };
  const int n = static_cast<int>(std::lround(40 / h));
  Topology coarse = one_tube(n);
  coarse.types[0].element_length = h;
  State s(static_cast<std::size_t>(n));
  for (int e = 0; e < n; ++e) {
    s.position.set(static_cast<std::size_t>(e), place(h * e));
    s.orientation.set(static_cast<std::size_t>(e), along(tangent(h * e), 0.3 * h * e));
  }
  const State f = halved(coarse, s);
  double off = 0, turned = 0;
  for (std::size_t i = 1; i + 1 < f.size(); ++i) {
    const double at = h * (0.5 * static_cast<double>(i) - 0.25);
    off = std::max(off, (f.position[i] - place(at)).norm());
    turned = std::max(turned, (axis_of(f.orientation[i]) - tangent(at)).norm());
  }
  return {off, turned};
}

TEST(Halved, HelixIsApproachedInFourthOrder) {
  const auto [coarse_off, coarse_turned] = off_the_helix(2);
  const auto [fine_off, fine_turned] = off_the_helix(1);
  EXPECT_LT(coarse_off, 2e-3);
  EXPECT_GT(coarse_off / fine_off, 12);
  EXPECT_GT(coarse_turned / fine_turned, 7);
}

// A constant transverse force: curvature that changes linearly and shear that does not; the deflections of the
// Timoshenko beam are cubic, and the halves lie on them to the order of the squared deflection.
TEST(Halved, ShearedBeamFollowsTimoshenkosCubic) {
  const double shear = 1500, kappa0 = 2e-6, gamma = 3e-6;
  const int n = 9;
  const Topology coarse = one_tube(n, shear);
  const double kappa1 = -shear * gamma / coarse.types[0].bond.bend;
  const auto slope = [&](double z) { return kappa0 * z + 0.5 * kappa1 * z * z; };
  const auto deflection = [&](double z) { return gamma * z + 0.5 * kappa0 * z * z + kappa1 * z * z * z / 6; };
  State s(n);
  for (int e = 0; e < n; ++e) {
    const double z = e * element_length;
    s.position.set(static_cast<std::size_t>(e), {deflection(z), 0, z});
    s.orientation.set(static_cast<std::size_t>(e), turn(Vector3::UnitY(), slope(z)));
  }
  const State f = halved(coarse, s);
  double cubic_part = 0;
  for (std::size_t i = 1; i + 1 < f.size(); ++i) {
    const double z = (0.5 * static_cast<double>(i) - 0.25) * element_length;
    EXPECT_NEAR(f.position.x[i], deflection(z), 1e-12) << i;
    EXPECT_NEAR(axis_of(f.orientation[i]).x(), slope(z), 1e-12) << i;
    cubic_part = std::max(cubic_part, std::fabs(slope(z) - 0.5 * (slope(z - 0.5) + slope(z + 0.5))));
  }
  EXPECT_GT(cubic_part, 1e-8) << "or the test would not see it";
}

struct Whole {
  double mass = 0;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

Whole whole_of(const Topology& topology, const State& s) {
  Whole w;
  for (int e = 0; e < topology.elements(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const TubeType& type = topology.type_of_element(e);
    w.mass += type.mass;
    w.linear += type.mass * s.velocity[i];
    w.angular += type.mass * s.position[i].cross(s.velocity[i]) + type.inertia * s.angular_velocity[i];
  }
  return w;
}

TEST(Halved, MomentaAreKeptInAnyMotion) {
  Topology coarse = published_topology();
  State s = test::disordered_bundle(coarse, 7, 12, 1.7, 0.08, 5);
  for (std::size_t i = 0; i < s.size(); ++i) s.velocity.add(i, {0.4, -0.2, 0.7});
  s.time = 3.5;
  s.step = 77;
  const State f = halved(coarse, s);
  const Whole before = whole_of(coarse, s), after = whole_of(halved(coarse), f);
  EXPECT_NEAR(after.mass, before.mass, 1e-14 * before.mass);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.linear.norm());
  EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * before.angular.norm());
  EXPECT_EQ(f.time, 3.5);
  EXPECT_EQ(f.step, 77);
  const double kinetic = kinetic_energy(coarse, s), fine = kinetic_energy(halved(coarse), f);
  EXPECT_GT(fine, 0.3 * kinetic);
  EXPECT_LT(fine, 1.1 * kinetic);
}

// A tumbling ring: the velocities of the halves are those of a rigid body, of the same momenta.
TEST(Halved, RigidMotionStaysRigid) {
  const int n = 15;
  const Topology coarse = one_tube(n, 2200);
  State s = ring(n, 0.2, 0.4);
  const Vector3 spin(0.3, -0.1, 0.2), drift(1, 2, -0.5);
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.velocity.set(i, drift + spin.cross(s.position[i]));
    s.angular_velocity.set(i, spin);
  }
  const State f = halved(coarse, s);
  const Vector3 turned = f.angular_velocity[0];
  for (std::size_t i = 1; i < f.size(); ++i) {
    EXPECT_LT((f.angular_velocity[i] - turned).norm(), 1e-9);
    const Vector3 relative = f.velocity[i] - f.velocity[0];
    EXPECT_LT((relative - turned.cross(f.position[i] - f.position[0])).norm(), 1e-8);
  }
  EXPECT_LT((turned - spin).norm(), 0.02 * spin.norm()) << "the inertia of the finer chain is a little larger";
  const Whole before = whole_of(coarse, s), after = whole_of(halved(coarse), f);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * before.angular.norm());
}

// Waves are carried over, too: a standing wave of 20 elements, in all four kinds of motion, keeps its kinetic
// energy.
TEST(Halved, LongWavesKeepTheirKineticEnergy) {
  const int n = 60;
  const Topology coarse = one_tube(n, 2200);
  State s(n);
  for (int e = 0; e < n; ++e) {
    const auto i = static_cast<std::size_t>(e);
    s.position.set(i, {0, 0, e * element_length});
    const double wave = 2 * units::pi * (e + 0.5) / 20;
    s.velocity.set(i, 0.1 * std::sin(wave) * Vector3(1, 0, 1));
    const double slope = 0.1 * 2 * units::pi / (20 * element_length) * std::cos(wave);
    s.angular_velocity.set(i, {0, slope, 0.2 * std::sin(wave)});
  }
  const State f = halved(coarse, s);
  const double before = kinetic_energy(coarse, s), after = kinetic_energy(halved(coarse), f);
  EXPECT_NEAR(after / before, 1, 0.02);
}

TEST(Halved, ATubeOfOneElementIsCutInItsMiddle) {
  const Topology coarse = one_tube(1);
  State s(1);
  s.position.set(0, {1, 2, 3});
  s.orientation.set(0, turn(Vector3::UnitX(), 0.7));
  s.velocity.set(0, {0, 1, 0});
  const State f = halved(coarse, s);
  ASSERT_EQ(f.size(), 2u);
  const Vector3 apart = f.position[1] - f.position[0];
  EXPECT_LT((apart - 0.5 * element_length * axis_of(s.orientation[0])).norm(), 1e-14);
  EXPECT_LT((0.5 * (f.position[0] + f.position[1]) - s.position[0]).norm(), 1e-14);
  EXPECT_LT((f.velocity[0] - s.velocity[0]).norm(), 1e-10);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
