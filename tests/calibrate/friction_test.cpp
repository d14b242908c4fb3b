// calibrate/friction: rigid tubes against differences of their energy, and against relaxed atoms.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "atomistic/finite_tube.hpp"
#include "atoms/lattice.hpp"
#include "friction/sliding.hpp"
#include "friction/strength.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

constexpr double pN = 1e-3 * units::nN_nm, lattice = 0.2493;

std::vector<Vector3> tube(Chirality c, double length) {
  const TubeShape shape = rolled_shape(c, lattice);
  const long hexagons = hexagons_in(c, shape, length);
  std::vector<Vector3> atoms;
  for (const Site& site : strip_sites(c, hexagons))
    atoms.push_back(place(c, site, shape) -
                    Vector3(0, 0, 0.5 * static_cast<double>(hexagons) * shape.length_per_hexagon));
  return atoms;
}
double radius(Chirality c) { return rolled_shape(c, lattice).radius; }
RigidPair pair_of(Chirality a, Chirality b, double length, const AtomLaw& law = {}) {
  return {law, tube(a, length + 4), radius(a), tube(b, length), radius(b)};
}
std::vector<double> lengths_of(const RigidPair& pair) { return {2, 2.6, 3.2, 3.8, 4.4, pair.length()}; }

TEST(RigidPair, ForcesAreTheGradientOfItsEnergy) {
  // Without the steps that a cutoff makes in the energy.
  const RigidPair pair = pair_of({5, 5}, {6, 4}, 3, {2.84e-3, 0.34, 100});
  const double d = radius({5, 5}) + radius({6, 4}) + 0.31, h = 1e-5;
  for (const double tilt : {0.0, 0.2}) {
    const Register at{0.3, 1.1, 0.07, tilt};
    const auto energy = [&](double turn_a, double turn_b, double along, double apart) {
      // Along the axis of b, which is tilted.
      Register r = at;
      r.turn_a += turn_a;
      r.turn_b += turn_b;
      r.shift += along;
      return pair.forces(r, d + apart, {pair.length()})[0].energy;
    };
    const RegisterForces f = pair.forces(at, d, {pair.length()})[0];
    EXPECT_NEAR(f.spin_a * pair.radius_a(), -(energy(h, 0, 0, 0) - energy(-h, 0, 0, 0)) / (2 * h), 1e-6);
    EXPECT_NEAR(f.spin_b * pair.radius_b(), -(energy(0, h, 0, 0) - energy(0, -h, 0, 0)) / (2 * h), 1e-6);
    EXPECT_NEAR(f.apart, -(energy(0, 0, 0, h) - energy(0, 0, 0, -h)) / (2 * h), 1e-5);
    if (tilt == 0) {
      EXPECT_NEAR(f.along, -(energy(0, 0, h, 0) - energy(0, 0, -h, 0)) / (2 * h), 1e-6);
    }
    EXPECT_GT(std::fabs(f.spin_a) + std::fabs(f.along), 1e-4);
  }
}

TEST(RigidPair, PartsAddUpAndRestWhereNothingPulls) {
  const RigidPair pair = pair_of({5, 5}, {5, 5}, 4);
  const Register at{0.2, 0.9, 0.05, 0};
  const double d = pair.free_distance(at, 2 * pair.radius_a() + 0.32);
  EXPECT_NEAR(d - 2 * pair.radius_a(), 0.315, 0.02);
  const auto f = pair.forces(at, d, {1, 2, 3, pair.length()});
  EXPECT_NEAR(f.back().apart, 0, 1e-3);
  EXPECT_LT(f[0].energy, 0);
  for (std::size_t k = 1; k < f.size(); ++k) EXPECT_LT(f[k].energy, f[k - 1].energy);
  EXPECT_NEAR(f[1].energy - f[0].energy, f[2].energy - f[1].energy, 0.05 * std::fabs(f[1].energy - f[0].energy));
}

// Tubes that fit hold each other in proportion to their length, unlike ones at their ends alone.
TEST(Strength, GrowsWithTheLengthOfTubesThatFitAlone) {
  const RigidPair like = pair_of({5, 5}, {5, 5}, 6), unlike = pair_of({5, 5}, {9, 0}, 6);
  const std::vector<Register> at = registers(4, lattice);
  const Strength s = along_strength(like, at, lengths_of(like)), u = along_strength(unlike, at, lengths_of(unlike));
  EXPECT_NEAR(s.per_length.value / pN, 26, 12);
  EXPECT_GT(s.largest, 1.5 * s.per_length.value);
  EXPECT_LT(std::fabs(u.per_length.value), 0.15 * s.per_length.value);
  EXPECT_NEAR(0.5 * u.of_ends.value / pN, 7, 5);
  EXPECT_NEAR(s.elastic_slip.value, lattice / (2 * units::pi), 0.006) << "nearly a sine of one lattice constant";
}

TEST(Strength, AnArmchairTubeIsHardToSpinAndAChiralOneIsNot) {
  const std::vector<Register> at = registers(2, lattice);
  const auto torque = [&](Chirality c) {
    const RigidPair pair = pair_of(c, c, 4.5);
    return spin_strength(pair, at, lengths_of(pair)).per_length.value * pair.radius_a();  // eV nm/nm
  };
  // nN nm per nm of contact.
  EXPECT_NEAR(torque({10, 10}) * units::eV_in_nN_nm, 0.047, 0.012);
  EXPECT_LT(torque({12, 6}), 0.15 * torque({10, 10}));
  // Around a zigzag tube the atoms repeat as along an armchair one, so that the shift decides.
  const RigidPair zigzag = pair_of({9, 0}, {9, 0}, 4.5);
  const Strength s = spin_strength(zigzag, registers(6, 0.4318), lengths_of(zigzag));
  EXPECT_GT(s.largest, 1.5 * s.least);
}

TEST(Strength, RisesWhereTubesArePressedTogether) {
  const RigidPair pair = pair_of({5, 5}, {5, 5}, 4);
  const auto pressed = pressed_strengths(pair, registers(2, lattice), {0.0, 0.01, 0.02});
  EXPECT_NEAR(pressed[0].ratio.value, 1, 1e-6);
  EXPECT_GT(pressed[1].ratio.value, 1.3);
  EXPECT_GT(pressed[2].ratio.value, pressed[1].ratio.value);
  EXPECT_GT(pressed[2].force, 1.5 * pressed[1].force);
}

class SlidingInLammps : public ::testing::Test {
 protected:
  std::string folder_ =
      (std::filesystem::temp_directory_path() / ("ropewalk-friction-test-" + std::to_string(::getpid()))).string();
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  SlidingTubes tubes() const {
    return {find_potential("tersoff"), AtomLaw(),      tube({5, 5}, 6.4),
            tube({5, 5}, 3),           radius({5, 5}), radius({5, 5})};
  }
};

// A second way to the same numbers: all atoms relax, energies by LAMMPS.
TEST_F(SlidingInLammps, RelaxedAtomsHoldAsRigidTubesDo) {
  for (const Slip slip : {Slip::along, Slip::spin_b}) {
    const RelaxedStrength s = relaxed_strength(tubes(), Register{1.6, 0.44, 0, 0}, slip, folder_,
                                               slip == Slip::along ? "along" : "spin", LammpsOptions());
    EXPECT_GT(s.rigid / pN, 50);
    EXPECT_NEAR(s.relaxed / s.rigid, 1, 0.15);
  }
}

TEST_F(SlidingInLammps, DragIsFarBelowTheStrength) {
  SlidingTubes small = tubes();
  small.a = tube({5, 5}, 4.4);
  small.b = tube({5, 5}, 1.5);
  const Drag d = measured_drag(small, Register{1.6, 0.44, 0, 0}, 3, lattice, folder_, "drag", LammpsOptions());
  ASSERT_EQ(d.force.size(), 3u);
  EXPECT_LT(std::fabs(d.force[0].value), 20 * pN + 3 * d.force[0].standard_error) << "static: 60 pN/nm";
  EXPECT_GT(d.drag.standard_error, 0);
  EXPECT_LT(d.drag.standard_error, 5);
}

TEST(PairCommands, RefuseWhatTwoTubesCannotHave) {
  Potential own = find_potential("tersoff");
  EXPECT_NE(pair_commands(own, AtomLaw()).find("tersoff 2"), std::string::npos);
  own.commands = {"pair_style hybrid tersoff lj/cut 10", "pair_coeff * * x C"};
  EXPECT_THROW(pair_commands(own, AtomLaw()), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
