// The same state in LAMMPS and here: forces, energies, virial, and a stretch of dynamics, on 1, 2 and 4 ranks. The
// engine inside the ranks is held to the simulator's, the plain styles to the reference.
#include "lammps/states.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/dynamics/loads.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

constexpr double force_tolerance = 1e-12, motion_tolerance = 1e-11;

class FiveStatesTest : public Lammps, public ::testing::WithParamInterface<FiveStates> {
 protected:
  void SetUp() override {
    Lammps::SetUp();
    // The name of a parametrised test has a slash.
    dir = fs::temp_directory_path() /
          ("ropewalk-five-" + std::string(GetParam().name) + "-" + std::to_string(getpid()));
    fs::create_directories(dir);
    spit(dir / "tubes.csv", state_text(GetParam().tubes, 0.01, 7));
    exported(driven_scene(GetParam()), "out");
    scene = read_scene((dir / "scene.toml").string());
    prepared = prepare(scene);
  }

  Scene scene;
  Prepared prepared;
};

// Loads included, as LAMMPS has them in its total.
Forces forces_here(const Prepared& p, double time, bool plain) {
  Forces f(p.state.size());
  if (plain) {
    compute_reference(p.topology, p.interaction, p.state, f);
  } else {
    NeighbourList list(p.interaction, 0.2);
    list.build(p.topology, p.state);
    ForceEngine().compute(p.topology, p.interaction, list, p.state, f);
  }
  std::vector<PointLoad> loads;
  point_loads(p.loads, p.state, time, loads);
  for (const PointLoad& load : loads) {
    f.force.add(static_cast<std::size_t>(load.element), load.force);
    f.torque.add(static_cast<std::size_t>(load.element), load.torque);
  }
  return f;
}

// xx, yy, zz, xy, xz, yz of separation times force, over bonds and contacts without damping.
std::array<double, 6> reference_virial(const Prepared& p) {
  std::array<double, 6> w{};
  const auto add = [&](const Vector3& s, const Vector3& f) {
    const double terms[6] = {s.x() * f.x(), s.y() * f.y(), s.z() * f.z(),
                             s.x() * f.y(), s.x() * f.z(), s.y() * f.z()};
    for (std::size_t k = 0; k < 6; ++k) w[k] += terms[k];
  };
  const Topology& t = p.topology;
  for (int i = 0; i < t.elements(); ++i)
    for (int j = i + 1; j < t.elements(); ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const Vector3 s = p.state.position[b] - p.state.position[a];
      const Quaternion q_i = p.state.orientation[a], q_j = p.state.orientation[b];
      const bool same = t.tube_of(i) == t.tube_of(j);
      if (same && j == i + 1) {
        const TubeType& type = t.type_of_element(i);
        add(s, bond_energy_and_gradient(type.bond, type.element_length, s, frame_of(q_i), frame_of(q_j)).force_j);
      }
      if ((same && j - i <= t.type_of_element(i).elements_within(p.interaction.excluded_arc())) ||
          s.norm() >= p.interaction.cutoff())
        continue;
      const TypePair types{t.tube_type[t.tube_of(i)], t.tube_type[t.tube_of(j)]};
      add(s, p.interaction.law->force(types, s, axis_of(q_i), axis_of(q_j)).force_j);
    }
  return w;
}

double sum_of_magnitudes(const Energies& e) {
  return std::fabs(e.stretch) + std::fabs(e.shear) + std::fabs(e.bend) + std::fabs(e.twist) + std::fabs(e.vdw);
}

// The numbers behind "virial" in LAMMPS's output.
std::array<double, 6> printed_virial(const std::string& out) {
  std::array<double, 6> w{};
  const std::size_t at = out.rfind("virial ");
  EXPECT_NE(at, std::string::npos) << out;
  std::istringstream in(out.substr(at + 7));
  for (double& value : w) in >> value;
  EXPECT_TRUE(in.good());
  return w;
}

TEST_P(FiveStatesTest, ForcesEnergiesAndVirialAgree) {
  // Step 0 carries the forces of the export along; at step 1 LAMMPS has to find them itself.
  edit("out", "fix motion all mdem/nve\n", "fix motion all mdem/nve\nreset_timestep 1\n");
  std::string print = "compute w all pressure NULL pair bond\nthermo_style custom step pe vol c_w[1]\n",
              row = "virial";
  for (int k = 1; k <= 6; ++k) {
    const std::string n = std::to_string(k);
    print += "variable w" + n + "_now equal c_w[" + n + "]*vol\nvariable w" + n + " format w" + n + "_now %.17g\n";
    row += " ${w" + n + "}";
  }
  edit("out", "run ${last} upto\n", print + "run 0\nprint \"" + row + "\"\n");
  prepared.state = start(scene, prepared).state();  // with the velocities that the constraints allow
  const std::array<double, 6> virial = reference_virial(prepared);
  const double scale = std::fabs(virial[0]) + std::fabs(virial[1]) + std::fabs(virial[2]);
  struct Way {
    int ranks;
    const char* forces;
  };
  for (const Way& way : {Way{1, "engine"}, {2, "engine"}, {4, "engine"}, {1, "plain"}, {4, "plain"}}) {
    SCOPED_TRACE(std::string(way.forces) + " on " + std::to_string(way.ranks));
    const bool plain = way.forces == std::string("plain");
    const Forces expected = forces_here(prepared, prepared.time_step, plain);
    ASSERT_GT(std::fabs(expected.energy.vdw), 1);  // there is contact to speak of
    fs::remove(dir / "out/lammps-rows.csv");
    const Outcome o = lmp(way.ranks, "out", std::string("-in in.rope -var steps 0 -var forces ") + way.forces);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    EXPECT_NE(o.out.find(plain ? "Forces by the plain forms" : "Forces by the engine"), std::string::npos) << o.out;
    const Left left = left_by(dir / "out", prepared.topology);
    EXPECT_LT(relative_difference(expected.force, left.force), force_tolerance);
    EXPECT_LT(relative_difference(expected.torque, left.torque), force_tolerance);
    const LammpsRow row_found = read_lammps_rows(LammpsDirectory{(dir / "out").string()}).back();
    const Energies& e = expected.energy;
    const double largest = sum_of_magnitudes(e) * force_tolerance;
    EXPECT_NEAR(row_found.stretch, e.stretch, largest);
    EXPECT_NEAR(row_found.shear, e.shear, largest);
    EXPECT_NEAR(row_found.bend, e.bend, largest);
    EXPECT_NEAR(row_found.twist, e.twist, largest);
    EXPECT_NEAR(row_found.vdw, e.vdw, largest);
    EXPECT_NEAR(row_found.kinetic, kinetic_energy(prepared.topology, prepared.state), 1e-12 * row_found.kinetic);
    const std::array<double, 6> found = printed_virial(o.out);
    // The engine's tables are off by 1e-11 of the steepest force.
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(found[k], virial[k], (plain ? 1e-12 : 1e-10) * scale) << k;
  }
}

// Single precision in the pairs rounds at 1e-7 of the forces of a pair.
TEST_P(FiveStatesTest, MixedPrecisionIsThatOfTheSimulator) {
  std::string text = driven_scene(GetParam());
  const std::string precision = "precision = \"double\"";
  text.replace(text.find(precision), precision.size(), "precision = \"mixed\"");
  exported(text, "mixed");
  edit("mixed", "fix motion all mdem/nve\n", "fix motion all mdem/nve\nreset_timestep 1\n");
  edit("mixed", "run ${last} upto\n", "run 0\n");
  Scene mixed = read_scene((dir / "scene.toml").string());
  Prepared here = prepare(mixed);
  here.state = start(mixed, here).state();
  const Forces expected = forces_here(here, here.time_step, false);
  const Outcome o = lmp(2, "mixed", "-in in.rope -var steps 0");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("in mixed precision"), std::string::npos) << o.out;
  const Left left = left_by(dir / "mixed", here.topology);
  EXPECT_LT(relative_difference(expected.force, left.force), 1e-6);
  // Both are as far from double precision, up to 6e-6.
  EXPECT_LT(relative_difference(expected.torque, left.torque), 5e-6);
  prepared.state = here.state;
  const Forces full = forces_here(prepared, here.time_step, false);
  EXPECT_GT(relative_difference(full.force, left.force), 1e-10);  // it is not the double one
}

TEST_P(FiveStatesTest, TwoHundredStepsAgree) {
  constexpr int steps = 200;
  Simulation native = start(scene, prepared);
  for (int k = 0; k < steps; ++k) native.step();
  ASSERT_GT(relative_difference(native.state().position, prepared.state.position), 1e-4);  // it has moved
  for (const int ranks : {1, 2, 4}) {
    SCOPED_TRACE(ranks);
    const Outcome o = lmp(ranks, "out", "-in in.rope -var steps " + std::to_string(steps));
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    const Left left = left_by(dir / "out", prepared.topology);
    ASSERT_EQ(left.state.step, steps);
    EXPECT_LT(relative_difference(native.state().position, left.state.position), motion_tolerance);
    EXPECT_LT(difference_of_turns(native.state().orientation, left.state.orientation), motion_tolerance);
    EXPECT_LT(relative_difference(native.state().velocity, left.state.velocity), motion_tolerance);
    EXPECT_LT(relative_difference(native.state().angular_velocity, left.state.angular_velocity), motion_tolerance);
    const LammpsRow row = read_lammps_rows(LammpsDirectory{(dir / "out").string()}).back();
    const double scale = sum_of_magnitudes(native.forces().energy) + std::fabs(native.work());
    EXPECT_NEAR(row.work, native.work(), motion_tolerance * scale);
    EXPECT_NEAR(row.dissipated, native.dissipated(), motion_tolerance * scale);
    EXPECT_NEAR(row.time, native.state().time, 1e-12 * row.time);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FiveStatesTest, ::testing::ValuesIn(five_states()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
