// The same state in LAMMPS and here: forces, energies, virial, and a stretch of dynamics, on 1, 2 and 4 ranks. The
// engine inside the ranks is held to the simulator's, the plain styles to the reference.
#include <fmt/format.h>

#include "lammps/states.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/dynamics/loads.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

constexpr double force_tolerance = 1e-12, motion_tolerance = 1e-11;

// One start of LAMMPS for each number of ranks has all five states.
class FiveStatesTest : public Lammps {
 protected:
  struct Case {
    std::string name;
    Scene scene;
    Prepared prepared;
  };

  Case case_of(const FiveStates& state, const std::string& scene_text) const {
    spit(dir / "tubes.csv", state_text(state.tubes, 0.01, 7));
    spit(dir / "scene.toml", scene_text);
    Scene scene = read_scene((dir / "scene.toml").string());
    Prepared prepared = prepare(scene);
    return {state.name, std::move(scene), std::move(prepared)};
  }
  // The same, exported to a folder of its name.
  Case exported_case(const FiveStates& state, const std::string& scene_text) const {
    Case c = case_of(state, scene_text);
    exported(scene_text, c.name);
    return c;
  }
  std::string output(const std::string& folder) const { return slurp(dir / folder / "log.lammps"); }
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

TEST_F(FiveStatesTest, ForcesEnergiesAndVirialAgree) {
  std::string print = "compute w all pressure NULL pair bond\nthermo_style custom step pe vol c_w[1]\n",
              row = "virial";
  for (int k = 1; k <= 6; ++k) {
    const std::string n = std::to_string(k);
    print += "variable w" + n + "_now equal c_w[" + n + "]*vol\nvariable w" + n + " format w" + n + "_now %.17g\n";
    row += " ${w" + n + "}";
  }
  const auto folder = [](const std::string& name, int ranks, const std::string& forces) {
    return name + "-" + forces + "-" + std::to_string(ranks);
  };
  std::vector<Case> cases;
  for (const FiveStates& state : five_states()) {
    cases.push_back(exported_case(state, driven_scene(state)));
    // Step 0 carries the forces of the export along; at step 1 LAMMPS has to find them itself.
    edit(state.name, "fix motion all mdem/nve\n", "fix motion all mdem/nve\nreset_timestep 1\n");
    edit(state.name, "run ${last} upto\n", print + "run 0\nprint \"" + row + "\"\n");
  }
  for (const int ranks : {1, 2, 4}) {
    std::vector<Part> parts;
    for (const Case& c : cases)
      for (const char* forces : {"engine", "plain"})
        parts.push_back(
            {copied(c.name, folder(c.name, ranks, forces)), {"steps 0", std::string("forces ") + forces}});
    const Outcome o = lmp_each(ranks, parts);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
  }
  for (Case& c : cases) {
    Prepared& prepared = c.prepared;
    prepared.state = start(c.scene, prepared).state();  // with the velocities that the constraints allow
    const std::array<double, 6> virial = reference_virial(prepared);
    const double scale = std::fabs(virial[0]) + std::fabs(virial[1]) + std::fabs(virial[2]);
    for (const std::string forces : {"engine", "plain"}) {
      const bool plain = forces == "plain";
      const Forces expected = forces_here(prepared, prepared.time_step, plain);
      const Energies& e = expected.energy;
      ASSERT_GT(std::fabs(e.vdw), 1);  // there is contact to speak of
      for (const int ranks : {1, 2, 4}) {
        const std::string out = folder(c.name, ranks, forces), printed = output(out);
        SCOPED_TRACE(out);
        EXPECT_NE(printed.find(plain ? "Forces by the plain forms" : "Forces by the engine"), std::string::npos)
            << printed;
        const Left left = left_by(dir / out, prepared.topology);
        EXPECT_LT(relative_difference(expected.force, left.force), force_tolerance);
        EXPECT_LT(relative_difference(expected.torque, left.torque), force_tolerance);
        const LammpsRow row_found = read_lammps_rows(LammpsDirectory{(dir / out).string()}).back();
        const double largest = sum_of_magnitudes(e) * force_tolerance;
        EXPECT_NEAR(row_found.stretch, e.stretch, largest);
        EXPECT_NEAR(row_found.shear, e.shear, largest);
        EXPECT_NEAR(row_found.bend, e.bend, largest);
        EXPECT_NEAR(row_found.twist, e.twist, largest);
        EXPECT_NEAR(row_found.vdw, e.vdw, largest);
        EXPECT_NEAR(row_found.kinetic, kinetic_energy(prepared.topology, prepared.state),
                    1e-12 * row_found.kinetic);
        const std::array<double, 6> found = printed_virial(printed);
        // The engine's tables are off by 1e-11 of the steepest force.
        for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(found[k], virial[k], (plain ? 1e-12 : 1e-10) * scale) << k;
      }
    }
  }
}

// A filament with a natural shape and two stiffnesses of bending, by the engine of the ranks and by the plain styles.
TEST_F(FiveStatesTest, AFilamentOfANaturalShapeAgrees) {
  std::string set = slurp(ROPEWALK_SOURCE_DIR "/data/parameters/cellulose-36.toml");
  const auto number = [](const char* key, double value, const char* unit) {
    return fmt::format("{} = {{ value = {}, unit = \"{}\", standard_error = 0, origin = \"chosen\" }}\n", key, value, unit);
  };
  set.insert(set.find("[filament]\n") + 11, number("curvature_1", 0.01, "1/nm") + number("curvature_2", -0.02, "1/nm") +
                                                number("twist_per_length", 0.1, "rad/nm"));
  const std::size_t EI = set.find("\nEI ") + 1;
  set.replace(EI, set.find('\n', EI) + 1 - EI, number("EI_1", 2e3, "nN nm^2") + number("EI_2", 1e3, "nN nm^2"));
  set.erase(set.find("[[correlation]]"));  // of the one EI
  spit(dir / "shaped.toml", set);
  constexpr double length = 3.8;
  const FiveStates state{
      "shaped",
      "parameters = \"shaped.toml\"\nelement_length_nm = 3.8\n[contact]\nlaw = \"line\"\nprecision = \"double\"\n",
      {straight({0, 0, 0}, ez, 12, length), straight({4, 0, 1}, ez, 12, length), straight({0, 4, 2}, ez, 12, length)}};
  const Case c = exported_case(state, driven_scene(state));
  edit(state.name, "fix motion all mdem/nve\n", "fix motion all mdem/nve\nreset_timestep 1\n");
  edit(state.name, "run ${last} upto\n", "run 0\n");
  Prepared prepared = c.prepared;
  prepared.state = start(c.scene, prepared).state();
  for (const char* forces : {"engine", "plain"}) {
    const std::string folder = copied(state.name, std::string("shaped-") + forces);
    const Outcome o = lmp_each(2, {{folder, {"steps 0", std::string("forces ") + forces}}});
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    const Forces expected = forces_here(prepared, prepared.time_step, std::string(forces) == "plain");
    ASSERT_GT(expected.energy.bend, 1);
    const Left left = left_by(dir / folder, prepared.topology);
    EXPECT_LT(relative_difference(expected.force, left.force), force_tolerance) << forces;
    EXPECT_LT(relative_difference(expected.torque, left.torque), force_tolerance) << forces;
  }
}

// Single precision in the pairs rounds at 1e-7 of the forces of a pair.
TEST_F(FiveStatesTest, MixedPrecisionIsThatOfTheSimulator) {
  std::vector<Case> cases;
  std::vector<Part> parts;
  for (const FiveStates& state : five_states()) {
    std::string text = driven_scene(state);
    const std::string precision = "precision = \"double\"";
    text.replace(text.find(precision), precision.size(), "precision = \"mixed\"");
    cases.push_back(exported_case(state, text));
    edit(state.name, "fix motion all mdem/nve\n", "fix motion all mdem/nve\nreset_timestep 1\n");
    edit(state.name, "run ${last} upto\n", "run 0\n");
    parts.push_back({state.name, {"steps 0"}});
  }
  const Outcome o = lmp_each(2, parts);
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const std::string& name = cases[k].name;
    SCOPED_TRACE(name);
    Prepared& here = cases[k].prepared;
    here.state = start(cases[k].scene, here).state();
    const Forces expected = forces_here(here, here.time_step, false);
    EXPECT_NE(output(name).find("in mixed precision"), std::string::npos) << output(name);
    const Left left = left_by(dir / name, here.topology);
    EXPECT_LT(relative_difference(expected.force, left.force), 1e-6);
    // Both are as far from double precision, up to 6e-6.
    EXPECT_LT(relative_difference(expected.torque, left.torque), 5e-6);
    Prepared in_double = case_of(five_states()[k], driven_scene(five_states()[k])).prepared;
    in_double.state = here.state;
    const Forces full = forces_here(in_double, here.time_step, false);
    EXPECT_GT(relative_difference(full.force, left.force), 1e-10);  // it is not the double one
  }
}

// Fewer steps than ranks make before they judge the balance of energy, which does not close in all of these states.
TEST_F(FiveStatesTest, AHundredAndTwentyStepsAgree) {
  constexpr int steps = 120;
  std::vector<Case> cases;
  for (const FiveStates& state : five_states()) cases.push_back(exported_case(state, driven_scene(state)));
  for (const int ranks : {1, 2, 4}) {
    std::vector<Part> parts;
    for (const Case& c : cases)
      parts.push_back({copied(c.name, c.name + "-" + std::to_string(ranks)), {"steps " + std::to_string(steps)}});
    const Outcome o = lmp_each(ranks, parts);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
  }
  for (const Case& c : cases) {
    Simulation native = start(c.scene, c.prepared);
    for (int k = 0; k < steps; ++k) native.step();
    ASSERT_GT(relative_difference(native.state().position, c.prepared.state.position), 1e-4);  // it has moved
    for (const int ranks : {1, 2, 4}) {
      const fs::path out = dir / (c.name + "-" + std::to_string(ranks));
      SCOPED_TRACE(out);
      const Left left = left_by(out, c.prepared.topology);
      ASSERT_EQ(left.state.step, steps);
      EXPECT_LT(relative_difference(native.state().position, left.state.position), motion_tolerance);
      EXPECT_LT(difference_of_turns(native.state().orientation, left.state.orientation), motion_tolerance);
      EXPECT_LT(relative_difference(native.state().velocity, left.state.velocity), motion_tolerance);
      EXPECT_LT(relative_difference(native.state().angular_velocity, left.state.angular_velocity),
                motion_tolerance);
      const LammpsRow row = read_lammps_rows(LammpsDirectory{out.string()}).back();
      const double scale = sum_of_magnitudes(native.forces().energy) + std::fabs(native.work());
      EXPECT_NEAR(row.work, native.work(), motion_tolerance * scale);
      EXPECT_NEAR(row.dissipated, native.dissipated(), motion_tolerance * scale);
      EXPECT_NEAR(row.time, native.state().time, 1e-12 * row.time);
    }
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
