// What is foreseen of a scene, changes of its text, and a run against a finer model.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/error.hpp"
#include "observe/observe.hpp"
#include "plan/features.hpp"
#include "plan/outcome.hpp"
#include "plan/scene_edit.hpp"
#include "plan/spot_check.hpp"
#include "scene/dissipation.hpp"
#include "scene/scene_toml.hpp"
#include "scene/wound.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

const std::string head = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n";
const std::string bundle = head +
                           "[rope]\ntubes = 7\nlength_nm = 27.2  # long\n[twist]\nmoment_nN_nm = 8\n"
                           "rate_nN_nm_per_ps = 1\n[run]\n# time_step_fs = \"auto\"\n";
const std::string lone = head + "[chain]\nelements = 41\n[run]\nduration_ps = 20\n";

Scene scene_from(const std::string& text) { return scene_of_text(text, "scene.toml"); }

// An outcome is a mean over the last quarter. The error of a small part of the energy is relative to a tenth of the
// energy.
TEST(Outcome, ComparesWhatCounts) {
  const auto log = [](double twist, double bend) {
    std::vector<LogRow> rows;
    for (int k = 0; k <= 8; ++k) {
      LogRow row;
      row["time_ps"] = k;
      row["twist_eV"] = k == 0 ? 0 : twist + (k % 2 ? 1 : -1) * (k > 6 ? 0 : 5);
      row["bend_eV"] = bend;
      row["vdw_eV"] = -1000;
      row["tension_upper_nN"] = std::nan("");
      rows.push_back(row);
    }
    return rows;
  };
  const Outcome a = outcome_of(log(100, 1), usual_observables(), false),
                b = outcome_of(log(102, 2), usual_observables(), false);
  EXPECT_NEAR(a.of.at("twist_eV").value, (100 - 5 + 100 + 100) / 3.0, 1e-9);
  const auto off = differences(b, a);
  EXPECT_NEAR(off.at("bend_eV"), 1 / (0.1 * 105), 1e-9) << "of a tenth of the largest energy since the start";
  EXPECT_NEAR(off.at("energy"), 2 / a.of.at("energy").value, 1e-9);
  EXPECT_EQ(off.count("tension_upper_nN"), 0u);
  EXPECT_EQ(off.at("beta_deg"), 0);
  EXPECT_NEAR(outcome_of(log(100, 1), {"twist_eV"}, true).of.at("twist_eV").value, 100, 1e-12);
}

// The moment is the slope of the energy of tubes that turn together, as long as one another along the axis, and bend to
// helices.
TEST(Features, ARopeTurnsAsFarAsItsTubesBearTogether) {
  Scene scene = scene_from(bundle);
  const Prepared p = prepare(scene);
  const double turn = features_of(scene, p).turn, moment = 8 * units::nN_nm;
  const BondStiffness& k = p.topology.types[0].bond;
  const auto energy = [&](double at) {  // per length
    std::vector<double> strains;
    double mean = 0, sum = 7 * 0.5 * k.twist * at * at;
    for (int t = 0; t < 7; ++t) {
      const Vector3 first = p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])];
      const double rho2 = first.head<2>().squaredNorm();
      strains.push_back(0.5 * rho2 * at * at);
      mean += strains.back() / 7;
      sum += 0.5 * k.bend * rho2 * std::pow(at, 4);
    }
    for (const double strain : strains) sum += 0.5 * k.stretch * (strain - mean) * (strain - mean);
    return sum;
  };
  const double h = 1e-4 * turn;
  EXPECT_NEAR((energy(turn + h) - energy(turn - h)) / (2 * h), 7 * moment, 1e-5 * 7 * moment);
  EXPECT_LT(turn, moment / k.twist) << "a tube alone would turn farther";
}

// Helices of the same length, evenly twisted: no strain, no bond longer, the outer tubes at atan(R t).
TEST(ExpectedState, IsARopeThatHasBeenTwisted) {
  Scene scene = scene_from(bundle);
  const Prepared p = prepare(scene);
  const double turn = 0.04, rate = 0.002;
  const State s = wound(p.state, turn, rate);
  const RopeObservation o =
      observe(p.topology, s, rope_shells(p.topology, p.state, 0), validities(scene, p.topology), 0, p.spacing);
  EXPECT_NEAR(o.beta, std::atan(p.spacing * turn), 1e-3);
  const double height = p.state.position[0].z() - p.state.position[p.topology.length_of(0) - 1].z();
  EXPECT_NEAR(o.geometric_twist, std::fabs(turn * height), 0.02);
  const auto energy = [&](const State& state) {
    return Simulation(p.topology, p.interaction, {}, state, p.time_step).forces().energy;
  };
  const double length = p.topology.tubes() * std::fabs(height);
  EXPECT_LT(energy(s).stretch, 1e-3 * energy(s).twist);
  EXPECT_NEAR(energy(s).twist, 0.5 * p.topology.types[0].bond.twist * turn * turn * length, 0.02 * energy(s).twist);
  // Velocities are those with which it goes on turning, without its growing shorter.
  const State later = wound(p.state, turn + 1e-4 * rate, rate);
  for (std::size_t i = 0; i < s.size(); i += 17) {
    const Vector3 moved = (Vector3(later.position[i]) - Vector3(s.position[i])) / 1e-4;
    EXPECT_LT((moved - Vector3(s.velocity[i])).head<2>().norm(), 1e-2 * p.spacing * rate * std::fabs(height));
  }
}

// Two rows side by side that slide along one another lose as much per length, whatever the elements; and so does a
// chain that is sheared evenly, by bonds of the rate l a^2 each with its relative velocity over a.
TEST(Dissipation, BelongsToALengthOfTube) {
  const double spacing = 1.7;
  Damping d;
  d.contact = {20, spacing, 1.5 * spacing};
  d.bond.rate = 3;
  const auto power = [&](const Damping& of, double a) {
    double sum = 0;
    for (int k = -9; k <= 9; ++k)
      sum +=
          of.contact.force({spacing, 0, k * a}, Vector3::Zero(), Vector3::Zero(), Vector3::UnitZ(), Vector3::Zero())
              .power;
    return sum / a;
  };
  for (const double a : {0.4, 0.678, 2.7, 5.4}) {
    const Damping other = same_dissipation(d, 1.356, a);
    EXPECT_NEAR(power(other, a), power(d, 1.356), 1e-9 * std::fabs(power(d, 1.356)));
    EXPECT_NEAR(other.bond.rate * a * a, 3 * 1.356 * 1.356, 1e-9);
  }
}

TEST(SceneEdit, SetsKeysAndKeepsTheRest) {
  const std::string text = "a = 1\n# b = 2  # two\n\n[one]  # first\nc = 3\n# d = 4\n[[load]]\nc = 9\n[two]\n";
  EXPECT_EQ(with_key(text, "", "a", "5"), "a = 5\n" + text.substr(6));
  EXPECT_THAT(with_key(text, "", "b", "5"), HasSubstr("a = 1\nb = 5\n\n[one]"));
  EXPECT_THAT(with_key(text, "one", "c", "5"), HasSubstr("# first\nc = 5\n# d = 4\n[[load]]\nc = 9\n"));
  EXPECT_THAT(with_key(text, "one", "d", "5"), HasSubstr("c = 3\nd = 5\n[[load]]"));
  EXPECT_THAT(with_key(text, "two", "c", "5"), HasSubstr("c = 9\n[two]\nc = 5\n"));
  EXPECT_THAT(with_key(text, "three", "c", "5"), HasSubstr("[two]\n\n[three]\nc = 5\n"));
}

TEST(SceneEdit, SetsValuesAtPathsAndKeepsTheRest) {
  const std::string text =
      "a = 1  # é\n[one]\nc = { x = 1, y = \"é\", z = [1, 2] }  # c\n# d = 4\n[[load]]\nc = [[0, 0],\n [1, 2]]  # "
      "l\n"
      "[[load]]\nc = 9\n";
  const auto set = [&](const char* path, const char* value) { return with_value(text, path, value, "s.toml"); };
  EXPECT_THAT(set("a", "2"), HasSubstr("a = 2  # é\n[one]"));
  EXPECT_THAT(set("one.c.x", "7"), HasSubstr("{ x = 7, y = \"é\", z = [1, 2] }  # c"));
  EXPECT_THAT(set("one.c.z.1", "7"), HasSubstr("y = \"é\", z = [1, 7] }  # c"));
  EXPECT_THAT(set("one.c.w", "7"), HasSubstr("c = { w = 7, x = 1,"));
  EXPECT_THAT(set("one.c", "7"), HasSubstr("[one]\nc = 7  # c\n"));
  EXPECT_THAT(set("one.d", "5"), HasSubstr("\nd = 5\n[[load]]"));
  EXPECT_THAT(set("load.0.c", "[]"), HasSubstr("[[load]]\nc = []  # l\n[[load]]\nc = 9\n"));
  EXPECT_THAT(set("load.1.c", "[8]"), HasSubstr("  # l\n[[load]]\nc = [8]\n"));
  EXPECT_THAT(set("load.1.e", "8"), HasSubstr("[[load]]\ne = 8\nc = 9\n"));
  EXPECT_THAT(set("new.deep.key", "1"), HasSubstr("c = 9\n\n[new]\ndeep.key = 1\n"));
  EXPECT_THAT(set("b", "1"), HasSubstr("b = 1\na = 1"));
  for (const char* wrong : {"load.2.c", "load.x.c", "load", "one", "a.b"})
    EXPECT_THROW(set(wrong, "1"), InputError) << wrong;
}

// A bent cantilever of harmonic bonds at rest: the finer model must find what beam theory says of the coarse one.
TEST(SpotCheck, SeesWhatLongElementsCost) {
  const auto checked = [](double length, int elements) {
    Scene scene = scene_from(fmt::format(
        "{}element_length_nm = {}\n[chain]\nelements = {}\n[contact]\nlaw = \"none\"\n"
        "[bond]\nlaw = \"harmonic\"\n[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = "
        "\"torque\"\nelements = [-1]\n"
        "torque_nN_nm = [0, 8, 0]\n[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-8\nmax_steps = 400000\n",
        head, length, elements));
    const Prepared p = prepare(scene);
    Simulation s = start(scene, p);
    EXPECT_TRUE(s.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; }));
    return spot_check(scene, p, s.state(), 1);
  };
  const SpotCheck coarse = checked(5, 9), fine = checked(2.5, 17);
  // A bond of the shear share s under a moment M holds d^2 (1/4 - 9 s/16) more than the beam, to the lowest order
  // of its bend d = M a/EI.
  const BondStiffness bond = scene_from(lone).parameters().bond;
  const auto excess = [&](double a) {
    const double d = 8 * units::nN_nm * a / bond.bend;
    return d * d * (0.25 - 0.5625 * shear_share(bond, a));
  };
  EXPECT_NEAR(coarse.observables.at("energy").error(), std::fabs(excess(5) - excess(2.5)), 2e-5);
  EXPECT_NEAR(fine.observables.at("energy").error(), std::fabs(excess(2.5) - excess(1.25)), 2e-6);
  EXPECT_GT(coarse.observables.at("energy").error(), 1e-3);
  EXPECT_LT(coarse.observables.at("bending_moment").error(), 0.01);
}

// A rope at rest, and no knob turned: halves of elements see the same shape.
TEST(SpotCheck, LooksAtSpacingAndEndAngleOfARope) {
  Scene scene = scene_from(head + "[rope]\ntubes = 7\nlength_nm = 13.6\n[run]\nduration_ps = 1\n");
  const Prepared p = prepare(scene);
  const SpotCheck check = spot_check(scene, p, wound(p.state, 0.02, 0), 0.2);
  const SpotCheck::Comparison spacing = check.observables.at("spacing"),
                              angle = check.observables.at("geometric_twist_deg");
  EXPECT_NEAR(spacing.here, p.spacing, 0.01 * p.spacing);
  EXPECT_LT(spacing.error(), 2e-3);
  EXPECT_NEAR(angle.here, 0.02 * 13.6 / units::degree, 2);
  EXPECT_LT(angle.error(), 0.05);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
