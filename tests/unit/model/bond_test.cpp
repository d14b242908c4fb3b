#include "model/bond.hpp"

#include <gtest/gtest.h>

#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::derivative;
using test::Random;

struct BondPose {
  Vector3 separation;
  Quaternion qi, qj;
};

BondPose random_pose(Random& random, double bend) {
  const Quaternion q = random.orientation();
  return {q * Vector3(0, 0, 1.356) + 0.2 * bend * random.direction(),
          test::turn(random.direction(), random.uniform(0, bend)) * q,
          test::turn(random.direction(), random.uniform(0, bend)) * q};
}

BondStiffness shearing_bond() {
  BondStiffness k = test::published_bond();
  k.shear = thin_tube_shear(k, 0.678);
  return k;
}

double energy(const BondPose& p, const BondStiffness& k = test::published_bond()) {
  return bond_energy(k, test::element_length, p.separation, frame_of(p.qi), frame_of(p.qj)).total();
}

BondForce force(const BondPose& p, const BondStiffness& k = test::published_bond()) {
  return bond_energy_and_gradient(k, test::element_length, p.separation, frame_of(p.qi), frame_of(p.qj));
}

enum class Form { published, shearing, anharmonic, pulled, shaped };
BondStiffness bond_of(Form form) {
  if (form == Form::anharmonic) return test::anharmonic_bond();
  if (form == Form::pulled) return test::pulled_bond();
  if (form == Form::shaped) return test::shaped_bond();
  return form == Form::shearing ? shearing_bond() : test::published_bond();
}

class BondForms : public ::testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(All, BondForms,
                         ::testing::Values(Form::published, Form::shearing, Form::anharmonic, Form::pulled,
                                           Form::shaped));

TEST_P(BondForms, ForceAndTorquesAreTheGradient) {
  const BondStiffness k = bond_of(GetParam());
  const auto energy = [&](const BondPose& p) {
    return bond_energy(k, test::element_length, p.separation, frame_of(p.qi), frame_of(p.qj)).total();
  };
  Random random(3);
  for (int n = 0; n < 3000; ++n) {
    const BondPose p = random_pose(random, n % 2 ? 0.2 : 2.0);
    const BondForce f = force(p, k);
    // The stiffness of the anharmonic bond jumps at the edges of its window.
    const bool kinks = GetParam() == Form::anharmonic || GetParam() == Form::pulled;
    const double h = kinks ? 1e-6 : 1e-3,
                 tight = (kinks ? 1e-5 : 1e-7) * std::max({f.force_j.norm(), f.torque_i.norm(), 1.0});
    for (int a = 0; a < 3; ++a) {
      const Vector3 e = Vector3::Unit(a);
      const double fj = -derivative([&](double s) { return energy({p.separation + s * e, p.qi, p.qj}); }, h);
      const double ti = -derivative(
          [&](double s) {
            return energy({p.separation, test::turn(e, s) * p.qi, p.qj});
          },
          h);
      const double tj = -derivative(
          [&](double s) {
            return energy({p.separation, p.qi, test::turn(e, s) * p.qj});
          },
          h);
      ASSERT_NEAR(f.force_j[a], fj, tight);
      ASSERT_NEAR(f.torque_i[a], ti, tight);
      ASSERT_NEAR(f.torque_j[a], tj, tight);
    }
  }
}

TEST_P(BondForms, NetTorqueVanishes) {
  const BondStiffness k = bond_of(GetParam());
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const BondPose p = random_pose(random, 1.5);
    const BondForce f = force(p, k);
    ASSERT_LT((f.torque_i + f.torque_j + p.separation.cross(f.force_j)).norm(),
              1e-12 * (f.torque_i.norm() + f.torque_j.norm() + 10 * f.force_j.norm() + 1e4));
  }
}

TEST_P(BondForms, FrameRotationAndSwap) {
  const BondStiffness k = bond_of(GetParam());
  const auto energy = [&](const BondPose& p) { return UNIT::energy(p, k); };
  BondStiffness turned_back = k;
  turned_back.natural.x *= -1;  // from the other end, a curvature about e1 has the other sign
  Random random(5);
  for (int n = 0; n < 500; ++n) {
    const BondPose p = random_pose(random, 1.0);
    const Quaternion r = random.orientation();
    EXPECT_NEAR(energy({r * p.separation, r * p.qi, r * p.qj}), energy(p), 1e-9 * (1 + energy(p)));
    // Read from the other end: both frames turned about e1 by 180 degrees.
    const Quaternion back(0, 1, 0, 0);
    EXPECT_NEAR(UNIT::energy({-p.separation, p.qj * back, p.qi * back}, turned_back), energy(p), 1e-9 * (1 + energy(p)));
  }
}

TEST(ShapedBond, RestsAtItsNaturalShape) {
  const BondStiffness k = test::shaped_bond();
  const double a = test::element_length;
  Random random(6);
  const Quaternion qi = random.orientation(), qj = qi * natural_turn(k, a);
  const Vector3 separation = a * (qi * natural_turn(k, 0.5 * a) * Vector3::UnitZ());
  const BondForce f = force({separation, qi, qj}, k);
  EXPECT_LT(f.energy.total(), 1e-12);
  EXPECT_LT(f.force_j.norm() + f.torque_i.norm() + f.torque_j.norm(), 1e-11);
  EXPECT_NEAR(bond_twist_angle(k, a, frame_of(qi), frame_of(qj)), 0, 1e-14);
  EXPECT_GT(std::fabs(bond_twist_angle(frame_of(qi), frame_of(qj))), 0.3);
}

// Forces do not depend on the natural shape once the frames are turned by it.
TEST(ShapedBond, IsThePlainBondOfItsTurnedFrames) {
  BondStiffness k = shearing_bond(), straight = k;
  k.natural = {0.15, -0.1, 0.3};
  Random random(7);
  for (int n = 0; n < 100; ++n) {
    const BondPose p = random_pose(random, 0.5);
    const Quaternion half = natural_turn(k, 0.5 * test::element_length);
    const BondForce f = force(p, k), g = force({p.separation, p.qi * half, p.qj * half.conjugate()}, straight);
    const double size = 1 + g.force_j.norm() + g.torque_i.norm() + g.torque_j.norm();
    ASSERT_LT((f.force_j - g.force_j).norm() + (f.torque_i - g.torque_i).norm() + (f.torque_j - g.torque_j).norm(),
              1e-11 * size);
    ASSERT_NEAR(f.energy.total(), g.energy.total(), 1e-11 * (1 + g.energy.total()));
  }
}

// Small motions in the plane of each axis are those of a rod of its own stiffness.
TEST(ShapedBond, BendsAndShearsByTheStiffnessOfItsAxis) {
  BondStiffness k = test::shaped_bond();
  k.natural = {};
  const double a = test::element_length, h = 1e-3;
  const Vector3 axes[] = {Vector3::UnitX(), Vector3::UnitY()};
  for (const int axis : {0, 1}) {
    BondStiffness rod = straightened(k);
    rod.bend += axis == 0 ? k.bend_difference : -k.bend_difference;
    const auto turned = [&](double angle) { return test::turn(axes[axis], angle); };
    const auto bent = [&](const BondStiffness& of) { return energy({{0, 0, a}, turned(-0.5 * h), turned(0.5 * h)}, of); };
    const auto sheared = [&](const BondStiffness& of) { return energy({{0, 0, a}, turned(h), turned(h)}, of); };
    EXPECT_NEAR(bent(k) / (0.5 * rod.bend * h * h / a), 1, 1e-5) << axis;
    EXPECT_NEAR(bent(k) / bent(rod), 1, 1e-5) << axis;
    EXPECT_NEAR(sheared(k) / (6 * even_shear_share(rod, a) * rod.bend / a * h * h), 1, 1e-5) << axis;
    EXPECT_NEAR(sheared(k) / sheared(rod), 1, 1e-5) << axis;
  }
}

// Strain, twist and curvature at once: a piece of a uniform rod has the energy of the header's W, whatever the
// elements' length; and where all are small, Hooke's.
TEST(AnharmonicBond, EnergyPerLengthIsThatOfTheRod) {
  const BondStiffness k = test::anharmonic_bond();
  const Anharmonic& h = k.anharmonic;
  const auto per_length = [&](double a, double e, double t, double kappa) {
    const double turn = kappa * a, chord = turn > 0 ? 2 / kappa * std::sin(0.5 * turn) : a;
    const Quaternion half = test::turn(Vector3::UnitY(), 0.5 * turn);
    const Quaternion i = half.conjugate(), j = half * test::turn(Vector3::UnitZ(), t * a);
    return bond_energy(k, a, Vector3(0, 0, (1 + e) * chord), frame_of(i), frame_of(j)).total() / a;
  };
  const auto rod = [&](double e, double t, double kappa) {
    const double s = h.radius * t, b = h.radius * kappa;
    return 0.5 * k.stretch * e * e + h.coupling * e * t + 0.5 * k.twist * t * t + 0.5 * k.bend * kappa * kappa +
           h.s3 * s * s * s + h.s4 * std::pow(s, 4) + h.e3 * e * e * e + h.e2s * e * e * s + h.es2 * e * s * s +
           h.e4 * std::pow(e, 4) + h.e3s * e * e * e * s + h.e2s2 * e * e * s * s + h.es3 * e * s * s * s +
           h.b4 * std::pow(b, 4);
  };
  for (const auto& [e, t, kappa] :
       {std::array{0.05, 0.0, 0.0}, std::array{-0.05, 0.0, 0.0}, std::array{0.0, 0.03, 0.0},
        std::array{0.0, 0.06, 0.0}, std::array{0.0, -0.06, 0.0},

        std::array{0.0, 0.0, 0.08}, std::array{0.03, 0.05, 0.06}, std::array{-0.04, -0.05, 0.05}})
    for (const double a : {0.7, 1.36, 2.7})
      EXPECT_NEAR(per_length(a, e, t, kappa) / rod(e, t, kappa), 1, 1e-4)
          << a << " " << e << " " << t << " " << kappa;
}

// Beyond the window the energy still rises, with continuous forces.
TEST(AnharmonicBond, GoesOnBeyondItsWindow) {
  const BondStiffness k = test::anharmonic_bond();
  const Frame rest = frame_of(Quaternion::Identity());
  const double a = 1.36;
  const auto stretched = [&](double e) {
    return bond_energy_and_gradient(k, a, Vector3(0, 0, a * (1 + e)), rest, rest);
  };
  const auto bent = [&](double b) {
    const Quaternion half = test::turn(Vector3::UnitY(), 0.5 * a * b / k.anharmonic.radius);
    return bond_energy_and_gradient(k, a, Vector3(0, 0, a), frame_of(half.conjugate()), frame_of(half));
  };
  double last_pull = 0, last_moment = 0;
  for (double x = 0.005; x < 0.6; x += 0.005) {
    const double pull = -stretched(x).force_j.z(), moment = -bent(x).torque_j.y();
    EXPECT_GT(pull, last_pull) << x;
    EXPECT_GT(moment, last_moment) << x;
    EXPECT_GT(stretched(-x).force_j.z(), 0);
    last_pull = pull, last_moment = moment;
  }
  for (const double edge : {k.anharmonic.min_strain, k.anharmonic.max_strain})
    EXPECT_NEAR(stretched(edge - 1e-9).force_j.z(), stretched(edge + 1e-9).force_j.z(), 1e-3);
}

// Energy, force and slope of stretch alone (eV/nm) belong together, at the edges of the window, of the steps of the
// pull and of its end.
TEST(AnharmonicBond, LawOfStretchIsOneEnergy) {
  for (const BondStiffness& k : {test::anharmonic_bond(), test::pulled_bond()}) {
    const Anharmonic& h = k.anharmonic;
    const auto energy = [&](double e) {
      return 0.5 * k.stretch * e * e + strain_energy(h, e, 0).energy + stretch_beyond(h, k.stretch, e).energy;
    };
    const auto force = [&](double e) {
      return k.stretch * e + strain_energy(h, e, 0).by_strain + stretch_beyond(h, k.stretch, e).by_strain;
    };
    const double step = (0.2 - h.max_strain) / PULL_STEPS;
    for (double e = 0.001; e < 0.3; e += 0.0007)
      EXPECT_NEAR(test::derivative([&](double d) { return energy(e + d); }, 1e-5) / force(e), 1, 1e-6) << e;
    for (double e = h.max_strain + 0.0003; e < 0.2; e += step / 5)
      EXPECT_NEAR(test::derivative([&](double d) { return force(e + d); }, 1e-5),
                  k.stretch + stretch_beyond(h, k.stretch, e).by_strain2, 1e-3)
          << e;
    for (int n = 0; n <= PULL_STEPS; ++n) {
      const double e = h.max_strain + n * step;
      EXPECT_NEAR(force(e - 1e-9), force(e + 1e-9), 1e-3) << e;
      EXPECT_NEAR(energy(e - 1e-9), energy(e + 1e-9), 1e-3) << e;
    }
  }
}

// The forces of the pull, and none beyond its end; no stiffness beyond the window is above that at its edge.
TEST(AnharmonicBond, BeyondItsWindowItHasTheForcesOfThePull) {
  const BondStiffness with = test::pulled_bond(), without = test::anharmonic_bond();
  const Frame rest = frame_of(Quaternion::Identity());
  const double a = 1.36;
  const auto pull = [&](const BondStiffness& k, double e) {
    return -bond_energy_and_gradient(k, a, Vector3(0, 0, a * (1 + e)), rest, rest).force_j.z();
  };
  const double table[] = {694, 768, 832, 888, 936, 976, 1004, 1018};
  for (int n = 1; n <= PULL_STEPS; ++n)
    EXPECT_NEAR(pull(with, 0.08 + n * 0.015), table[n - 1], 1e-6 * table[n - 1]) << n;
  for (const double e : {0.21, 0.3, 0.6}) EXPECT_NEAR(pull(with, e), 1018, 1e-6);
  for (const double e : {-0.2, -0.06, -0.01, 0.0, 0.03, 0.0799}) EXPECT_EQ(pull(with, e), pull(without, e)) << e;
  const double edge = edge_of_window(with.anharmonic, with.stretch).slope;
  for (const BondStiffness& k : {with, without})
    for (double e = 0.081; e < 0.5; e += 0.003)
      EXPECT_LT((pull(k, e + 1e-4) - pull(k, e)) / 1e-4, 1.0001 * edge) << e;
  EXPECT_LT((pull(without, -0.2) - pull(without, -0.201)) / 1e-3, 1.0001 * with.stretch)
      << "nor does it stiffen in compression";
}

// The parts and the published combination B1 .. B4 are one energy.
TEST(Bond, PartsAddUpToTheVectorModel) {
  Random random(6);
  const BondStiffness k = test::published_bond();
  const double a = test::element_length;
  const double b1 = k.stretch / a, b2 = 12 * k.bend / a, b3 = -2 * k.bend / a - k.twist / (2 * a), b4 = k.twist / a;
  for (int n = 0; n < 500; ++n) {
    const BondPose p = random_pose(random, 2.0);
    const Frame i = frame_of(p.qi), j = frame_of(p.qj);
    const double length = p.separation.norm();
    const double published = 0.5 * b1 * (length - a) * (length - a) -
                             0.5 * b2 * (i.t + j.t).dot(p.separation) / length - b3 * i.t.dot(j.t) -
                             0.5 * b4 * (i.e1.dot(j.e1) + i.e2.dot(j.e2));
    const double at_rest = -b2 - b3 - b4;
    ASSERT_NEAR(energy(p), published - at_rest, 1e-9 * (std::fabs(published) + std::fabs(at_rest)));
  }
}

TEST(Bond, SmallDeformationsAreABeam) {
  const BondStiffness k = test::published_bond();
  const double a = test::element_length;
  const Vector3 z(0, 0, a);
  const Frame rest = frame_of(Quaternion::Identity());
  const double small = 1e-3;
  const auto turned = [&](const Vector3& axis, double angle) { return frame_of(test::turn(axis, angle)); };
  const Vector3 x = Vector3::UnitX();

  EXPECT_NEAR(bond_energy(k, a, z * (1 + small), rest, rest).stretch, 0.5 * k.stretch * a * small * small, 1e-9);
  const auto bent = bond_energy(k, a, z, turned(x, -small / 2), turned(x, small / 2));
  EXPECT_NEAR(bent.bend / (0.5 * k.bend / a * small * small), 1, 1e-6);
  EXPECT_NEAR(bent.shear, 0, 1e-9);
  const auto sheared = bond_energy(k, a, z, turned(x, small), turned(x, small));
  EXPECT_NEAR(sheared.shear / (6 * k.bend / a * small * small), 1, 1e-6);
  EXPECT_NEAR(sheared.bend, 0, 1e-12);
  const auto twisted = bond_energy(k, a, z, rest, turned(Vector3::UnitZ(), small));
  EXPECT_NEAR(twisted.twist / (0.5 * k.twist / a * small * small), 1, 1e-6);
  EXPECT_NEAR(twisted.bend + twisted.shear + twisted.stretch, 0, 1e-12);
}

// Known limits of 1 - cos phi: -0.1 % at 0.1 rad and -8 % at 1 rad against phi^2/2, peak at 90 degrees.
TEST(Bond, TwistSoftensAsOneMinusCosine) {
  const BondStiffness k = test::published_bond();
  const double a = test::element_length;
  const Frame rest = frame_of(Quaternion::Identity());
  for (const auto& [phi, deficit] : {std::pair{0.1, 0.00083}, std::pair{1.0, 0.0806}}) {
    const Frame j = frame_of(test::turn(Vector3::UnitZ(), phi));
    const double e = bond_energy(k, a, {0, 0, a}, rest, j).twist;
    EXPECT_NEAR(1 - e / (0.5 * k.twist / a * phi * phi), deficit, 1e-3 * phi);
    EXPECT_NEAR(bond_twist_angle(rest, j), phi, 1e-12);
    EXPECT_NEAR(bond_twist_angle(j, rest), -phi, 1e-12);
  }
}

// The twist angle is blind to bending: bend first, then twist about the bent axis.
TEST(Bond, TwistAngleIgnoresBend) {
  Random random(12);
  for (int n = 0; n < 200; ++n) {
    const double phi = random.uniform(-1.4, 1.4);
    const Quaternion qi = random.orientation();
    const Vector3 sideways = (axis_of(qi).cross(random.direction())).normalized();
    const Quaternion bent = test::turn(sideways, random.uniform(0, 1)) * qi;  // bend without twist
    const Quaternion qj = test::turn(axis_of(bent), phi) * bent;
    EXPECT_NEAR(bond_twist_angle(frame_of(qi), frame_of(qj)), phi, 1e-12);
  }
}

// The physics test of the same name finds by dynamics that a chain is stable below and unstable above.
TEST(Bond, StiffestFrequencyOfThePublishedChain) {
  const Topology t = test::published_topology();
  const double w = stiffest_chain_frequency(test::published_bond(), t.types[0].element_length, t.types[0].mass,
                                            t.types[0].inertia);
  EXPECT_NEAR(2.0 / w, 0.0483, 0.0001);  // ps
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
