// Tubes of several walls: what is asked for, their contact against sums over atoms, and their sets.
#include "verbs/walls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atomistic/walled_tube.hpp"
#include "atoms/lattice.hpp"
#include "contact/fit_contact.hpp"
#include "contact/integral.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

using testing::HasSubstr;

std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Walls, AreReadInsideFirst) {
  for (const char* text : {"(5,5)@(10,10)", "5,5@10,10", " (5,5) @ 10,10 "})
    EXPECT_EQ(walls_text(parse_walls(text)), "(5,5)@(10,10)") << text;
  EXPECT_EQ(parse_walls("7,3").size(), 1u);
  EXPECT_EQ(parse_walls("(5,5)@(10,10)@(15,15)").size(), 3u);
}

TEST(Walls, ThatDoNotFitAreRefusedWithOneThatDoes) {
  const std::string near = refusal_of([] { parse_walls("(5,5)@(7,7)"); });
  EXPECT_THAT(near, HasSubstr("(5,5) and (7,7) are walls 0.136 nm apart, and walls fit at 0.28 to 0.45 nm"));
  EXPECT_THAT(near, HasSubstr("around (5,5) fits (10,10)"));
  EXPECT_THAT(refusal_of([] { parse_walls("(10,10)@(5,5)"); }), HasSubstr("from inside to outside"));
  EXPECT_THAT(refusal_of([] { parse_walls("(5,5)@"); }), HasSubstr("--chirality"));
}

TEST(Walls, AreFoundByTheirNumberAndWidth) {
  EXPECT_EQ(walls_text(find_walls(3, 2.5)), "(8,8)@(13,13)@(18,18)");
  const std::vector<Chirality> five = find_walls(5, 8);
  EXPECT_EQ(five.size(), 5u);
  EXPECT_NEAR(2 * tube_radius(five.back()), 8, 0.1);
  for (std::size_t k = 1; k < five.size(); ++k)
    EXPECT_NEAR(tube_radius(five[k]) - tube_radius(five[k - 1]), 0.34, 0.005);
  EXPECT_THAT(refusal_of([] { find_walls(6, 2.5); }), HasSubstr("has no room"));
}

TEST(Walls, LockWhereAllAreArmchairOrAllAreZigzag) {
  EXPECT_TRUE(walls_lock(parse_walls("(5,5)@(10,10)")));
  EXPECT_TRUE(walls_lock(parse_walls("(9,0)@(18,0)")));
  EXPECT_FALSE(walls_lock(parse_walls("(9,0)@(10,10)")));
}

// The sheet rolled at these radii, and its shells.
struct Rolled {
  explicit Rolled(const std::vector<Chirality>& walls) {
    for (const Chirality c : walls) {
      const TubeCell cell = tube_cell(c, translation_vector(c), 0.2485);
      columns.push_back({cell.atoms, cell.length});
      shells.push_back({cell.radius, graphene_density(0.2485)});
    }
  }
  std::vector<AtomColumn> columns;
  std::vector<Shell> shells;
};

struct RolledPair {
  const char *i, *j;
};
void PrintTo(const RolledPair& p, std::ostream* out) { *out << p.i << " beside " << p.j; }

class WalledContact : public testing::TestWithParam<RolledPair> {
 protected:
  const AtomLaw law{2.84e-3, 0.34, 3};
  const Rolled i{parse_walls(GetParam().i)}, j{parse_walls(GetParam().j)};
  const WallsIntegral integral{law, i.shells, j.shells};
};

TEST_P(WalledContact, OfParallelTubesIsTheMeanOverAtoms) {
  const Well well = integral.parallel_well();
  for (const double distance : {well.distance, well.distance + 0.15, well.distance + 0.6}) {
    double sum = 0;
    for (const AtomColumn& a : i.columns)
      for (const AtomColumn& b : j.columns) sum += registry_spread({law, law, law}, a, b, distance, 60).mean;
    EXPECT_NEAR(sum / well.energy, integral.parallel(distance) / well.energy, 2e-3) << distance;
  }
}

TEST_P(WalledContact, OfCrossedTubesIsTheMeanOverAtoms) {
  const Well well = integral.crossed_well();
  // Both tubes as long as they reach each other.
  const auto straight = [&](const AtomColumn& column, double turn, double shift) {
    std::vector<Vector3> out;
    const double half = law.cutoff + 2.5;
    for (const Vector3& a : column.atoms)
      for (double z = a.z() + shift - column.period * std::ceil((a.z() + shift + half) / column.period); z < half;
           z += column.period)
        if (z > -half)
          out.emplace_back(std::cos(turn) * a.x() - std::sin(turn) * a.y(),
                           std::sin(turn) * a.x() + std::cos(turn) * a.y(), z);
    return out;
  };
  constexpr int registries = 6;
  double sum = 0;
  for (int k = 1; k <= registries; ++k) {
    const auto [turn_i, turn_j, shift] = registry_parts(k);
    for (const AtomColumn& a : i.columns)
      for (const AtomColumn& b : j.columns) {
        const std::vector<Vector3> first = straight(a, 2 * units::pi * turn_i, shift * a.period),
                                   second = straight(b, 2 * units::pi * turn_j, shift * b.period);
        for (const Vector3& p : first)
          for (const Vector3& q : second) {
            const Vector3 d(well.distance + q.x() - p.x(), q.z() - p.y(), -q.y() - p.z());
            const double square = d.squaredNorm();
            if (square < law.cutoff * law.cutoff) sum += law.energy(std::sqrt(square)) / registries;
          }
      }
  }
  EXPECT_NEAR(sum / well.energy, 1, 3e-3);
}

TEST_P(WalledContact, HasAClosedForm) {
  FitOptions options;
  options.starts = 3;
  const LineFit f = fit_line(law, i.shells, j.shells, options);
  EXPECT_TRUE(f.fit.usable()) << f.fit.message;
  EXPECT_LT(f.error, 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Tubes, WalledContact,
                         testing::Values(RolledPair{"(5,5)@(10,10)", "(5,5)@(10,10)"},
                                         RolledPair{"(5,5)@(10,10)", "10,10"}));

// Figures of direct sums over the atoms of two (5,5)@(10,10), cutoff 1.2 nm: the second wall deepens the well by 15
// %.
TEST(WalledContact, IsDeeperByTheWallsBehind) {
  const std::vector<Shell> two = {{0.3471, 37.0}, {0.68879, 37.037}};
  const Well both = WallsIntegral({}, two, two).parallel_well(),
             one = WallsIntegral({}, two[1], two[1]).parallel_well();
  EXPECT_NEAR(both.energy, -1.1620, 2e-3);
  EXPECT_NEAR(both.distance, 1.68901, 3e-4);
  EXPECT_NEAR(both.energy / one.energy, 1.15, 0.005);
}

// `check-shipped` asks for what the command that made the set asks for, and finds all that it compares in the set.
TEST(WalledSet, CanBeMadeAnew) {
  for (const char* name : {"cnt-5-5@10-10-tersoff", "cnt-10-10@15-15-tersoff", "cnt-5-5@10-10@15-15-tersoff"}) {
    const ParameterSet set = read_parameters(find_parameters(name, ""));
    const CalibrationRequest request = request_of(set);
    EXPECT_EQ(request.name(), name);
    EXPECT_FALSE(request.outer_carries) << name;
    EXPECT_EQ(request.law.cutoff, 3) << name;
    const double shorter = 3 * 2 * tube_radius(set.chirality);
    EXPECT_NEAR(request.stiffness.short_length, std::min(shorter, 6.0), 1e-9) << name;
    EXPECT_NEAR(request.stiffness.long_length, 2 * std::min(shorter, 6.0), 1e-9) << name;
    const std::vector<std::string> numbers = compared_numbers(set);
    EXPECT_THAT(numbers, testing::IsSupersetOf({"wall.1.EA", "wall.2.EI", "held.outer.GJ", "tube.contact_radius"}));
    for (const std::string& key : numbers) EXPECT_TRUE(find_quantity(set, key)) << name << ": " << key;
  }
  const ParameterSet one = read_parameters(find_parameters("cnt-5-5-tersoff", ""));
  EXPECT_TRUE(request_of(one).walls.empty());
  for (const std::string& key : compared_numbers(one)) EXPECT_TRUE(find_quantity(one, key)) << key;
}

TEST(WalledPotential, NamesEachWallAndTheLawBetweenThem) {
  Potential p;
  p.commands = {"pair_style airebo 3.0 0 0", "pair_coeff * * \"CH.airebo\" C"};
  EXPECT_EQ(walled_pair_commands(p, {2.84e-3, 0.34, 1.2}, 2),
            "pair_style hybrid/overlay airebo 3.0 0 0 airebo 3.0 0 0 lj/cut 12\n"
            "pair_coeff * * airebo 1 \"CH.airebo\" C NULL\npair_coeff * * airebo 2 \"CH.airebo\" NULL C\n"
            "pair_coeff 1 2 lj/cut 0.00284 3.4\npair_modify pair lj/cut shift yes\n");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
