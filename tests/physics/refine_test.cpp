// A run that outgrows its elements, has them split and goes on, held to one that was as fine from the start.
#include "sim/dynamics/refine.hpp"

#include <gtest/gtest.h>

#include "observe/limits.hpp"
#include "scene/ends/grip.hpp"
#include "scene/finer.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

const std::string path = ROPEWALK_SOURCE_DIR "/data/scenes/test.toml";  // data is looked for beside it

std::string scene_text(const std::string& body) {
  return "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[bond]\nlaw = \"harmonic\"\n" + body;
}

// The simulation of a scene, and of the one with half the element length.
struct Twofold {
  Scene coarse_scene, fine_scene;
  Prepared coarse, fine;

  explicit Twofold(const std::string& body) : coarse_scene(scene_of_text(scene_text(body), path)) {
    coarse = prepare(coarse_scene);
    fine_scene = scene_of_text(finer_scene_text(coarse_scene, coarse, "test"), path);
    fine = prepare(fine_scene);
  }
  Simulation split(const Simulation& from) const {
    Prepared at = fine;
    at.state = halved(coarse.topology, from.state(), splitting_of(coarse_scene));
    Simulation s = start(fine_scene, at);
    s.inherit_from(s.forces().force, s.forces().torque, from.account());
    return s;
  }
};

void run_until(Simulation& s, double time) {
  while (s.state().time < time - 0.5 * s.time_step()) s.step();
}

double distance_of_ends(const Simulation& s) {
  return (s.state().position[0] - s.state().position[s.state().size() - 1]).norm();
}

double largest_bend(const Simulation& s) {
  return peaks(s.topology(), s.state(), s.list(), {{Limits{}}, {}})[0].value;
}

// Couples at both ends bend a tube beyond 20 degrees a bond. On the way its splitting is hardly felt, and at rest
// it is the chain that was fine from the start.
TEST(Refined, BentTubeGoesOnAsTheFineOne) {
  const Twofold scenes(
      "[chain]\nelements = 14\n[contact]\nlaw = \"none\"\n[damping]\npfc_local = 0.7\n[[load]]\nkind = \"torque\"\n"
      "elements = [0]\ntorque_nN_nm = [0, -110, 0]\n[[load]]\nkind = \"torque\"\nelements = [-1]\n"
      "torque_nN_nm = [0, 110, 0]\n[run]\nduration_ps = 120\n");
  Simulation coarse = start(scenes.coarse_scene, scenes.coarse);
  while (largest_bend(coarse) < 19.9 * units::degree && coarse.state().time < 20) coarse.step();
  ASSERT_LT(coarse.state().time, 20);
  Simulation split = scenes.split(coarse);
  Simulation fine = start(scenes.fine_scene, scenes.fine);
  EXPECT_LT(largest_bend(split), 14 * units::degree)
      << "half of it, and what the shear at the new element leans it by";
  run_until(fine, coarse.state().time);
  EXPECT_NEAR(distance_of_ends(split), distance_of_ends(fine), 0.03 * distance_of_ends(fine)) << "at the splitting";
  for (Simulation* s : {&split, &fine}) run_until(*s, 120);
  EXPECT_NEAR(split.forces().energy.bend, fine.forces().energy.bend, 1e-3 * fine.forces().energy.bend);
  EXPECT_NEAR(distance_of_ends(split), distance_of_ends(fine), 1e-3 * distance_of_ends(fine));
  // The account goes on: what the loads did is stored or dissipated, but for the jump at the splitting.
  const double jump = scenes.split(coarse).total_energy() - coarse.total_energy();
  const double balance = split.total_energy() - split.work() + split.dissipated() - jump;
  EXPECT_LT(std::fabs(balance), 0.01 * split.work());
}

// The energy of a bent state on both chains, theory beside it: the rod's, less 1/12 of the squared angle of a bond,
// over the bonds that there are. The state is that of a quasi-static ring under couples.
TEST(Refined, JumpOfTheBendEnergyIsThatOfTheChains) {
  const Twofold scenes("[chain]\nelements = 40\n[contact]\nlaw = \"none\"\n[run]\nduration_ps = 1\n");
  State s = scenes.coarse.state;
  const double a = scenes.coarse.topology.types[0].element_length, angle = 0.3,
               radius = 0.5 * a / std::sin(0.5 * angle);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Quaternion q(Eigen::AngleAxisd(angle * static_cast<double>(i), Vector3::UnitY()));
    s.position.set(i, radius * (q * -Vector3::UnitX()));
    s.orientation.set(i, q);
  }
  Prepared at = scenes.coarse;
  at.state = s;
  const Simulation coarse = start(scenes.coarse_scene, at), fine = scenes.split(coarse);
  const double rod = 0.5 * scenes.coarse.topology.types[0].bond.bend * angle * angle / a;
  EXPECT_NEAR(coarse.forces().energy.bend, 39 * rod * (1 - angle * angle / 12),
              39 * rod * std::pow(angle, 4) / 300);
  EXPECT_NEAR(fine.forces().energy.bend, 39.5 * rod * (1 - angle * angle / 48),
              39.5 * rod * std::pow(angle, 4) / 4000);
  EXPECT_LT(fine.forces().energy.shear + fine.forces().energy.stretch, 0.01 * fine.forces().energy.bend);
}

// A rope that is being twisted: contact and bonds of the split state, and the run after it.
TEST(Refined, TwistedRopeGoesOnAsTheFineOne) {
  const Twofold scenes(
      "[rope]\ntubes = 7\nlength_nm = 20\n[twist]\nmoment_nN_nm = 24\nrate_nN_nm_per_ps = 4\nhold_ps = 24\n");
  const int n = scenes.coarse.topology.length_of(0);
  ASSERT_EQ(scenes.fine.topology.elements(), 7 * (2 * n - 1)) << "the couples stay where they act";
  Simulation coarse = start(scenes.coarse_scene, scenes.coarse), fine = start(scenes.fine_scene, scenes.fine);
  run_until(coarse, 6);
  run_until(fine, 6);
  Simulation split = scenes.split(coarse);
  const Energies a = coarse.forces().energy, b = split.forces().energy;
  EXPECT_NEAR(b.vdw / a.vdw, (2.0 * n - 1) / (2.0 * n), 3e-3) << "a quarter of an element less at each end";
  EXPECT_NEAR(b.twist, a.twist, 0.01 * a.twist);
  EXPECT_EQ(split.work(), coarse.work());
  EXPECT_NEAR(fine.dissipated() * 2 * n / (2 * n - 1), coarse.dissipated(), 0.05 * coarse.dissipated())
      << "damping per length";
  // At rest under the full moment, whatever the way there.
  for (Simulation* s : {&split, &fine}) run_until(*s, 30);
  const Energies c = split.forces().energy, d = fine.forces().energy;
  EXPECT_NEAR(c.twist, d.twist, 0.01 * d.twist);
  EXPECT_NEAR(c.bend + c.shear, d.bend + d.shear, 0.02 * (d.bend + d.shear));
  EXPECT_NEAR(c.vdw, d.vdw, 1e-3 * std::fabs(d.vdw));
}

// A tube that clamps twist by 40 degrees keeps its free length: energy and torque are those of the rod between the
// clamps before the splitting, right after it and at the end, and the clamp stands where the schedule has it.
TEST(Refined, ClampsHoldTheTubeAtTheSamePlaces) {
  const Twofold scenes(
      "[chain]\nelements = 10\n[contact]\nlaw = \"none\"\n[damping]\nbond_damping_per_ps = 3\n[[grip]]\nend = "
      "\"lower\"\n"
      "[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = [[0, 0], [30, 40]] }\n[run]\nduration_ps = 40\n");
  const TubeType& type = scenes.coarse.topology.types[0];
  const double free = 9 * type.element_length;
  const auto rod = [&](double angle) { return 0.5 * type.bond.twist * angle * angle / free; };
  Simulation coarse = start(scenes.coarse_scene, scenes.coarse);
  run_until(coarse, 15);
  Simulation split = scenes.split(coarse);
  const double angle = scenes.coarse.loads.of<GripLoad>().at(1)->schedule(GripLoad::about_z).value(15);
  EXPECT_NEAR(coarse.forces().energy.twist, rod(angle), 0.01 * rod(angle));
  EXPECT_NEAR(split.forces().energy.twist, coarse.forces().energy.twist, 2e-3 * rod(angle));
  split.set_gauges(ends_of(scenes.fine.loads, scenes.fine.topology), scenes.fine.state);
  split.inherit_from(coarse.gauges().sums);
  run_until(split, 38);
  split.read_gauges();
  run_until(split, 40);
  const EndReadings ends = split.read_gauges();
  const double whole = 40 * units::degree;
  EXPECT_NEAR(split.forces().energy.twist, rod(whole), 2e-3 * rod(whole));
  EXPECT_NEAR(ends[upper_end].torque.z(), type.bond.twist * whole / free, 2e-3 * type.bond.twist * whole / free);
  EXPECT_NEAR(ends[upper_end].turned - ends[lower_end].turned, whole, 1e-3 * whole);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
