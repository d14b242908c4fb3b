// The tests of the law in install/own_parts/beads.cpp, the example of docs/how-to/contact-law.md.
#include "install/own_parts/beads.cpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "run/colours.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {

using ::testing::HasSubstr;

// Tubes of two types in disorder, with viscosity.
struct BeadBundle {
  Topology topology = test::published_topology();
  Interaction in;
  State state;

  BeadBundle() {
    state = test::disordered_bundle(topology, 7, 80, 1.75, 0.05, 21);
    topology.types.push_back(topology.types[0]);
    for (int t = 1; t < topology.tubes(); t += 2) topology.tube_type[t] = 1;
    in.law = std::make_shared<const BeadLaw>(std::vector<double>{0.678, 0.5}, 0.5, 4.5);
    in.exclude_along_tube = 3 * test::element_length;
    in.damping.contact = {20, 1.713, 2.57};
  }
  Forces fast(int threads) const {
    omp_set_num_threads(threads);
    NeighbourList list(in, 0.2);
    list.build(topology, state);
    ForceEngine engine;
    Forces f(state.size());
    engine.compute(topology, in, list, state, f);
    return f;
  }
};

TEST(BeadLaw, FastForcesEqualTheReferenceOnAnyThreads) {
  ASSERT_TRUE(added);
  const BeadBundle b;
  Forces reference(b.state.size());
  compute_reference(b.topology, b.in, b.state, reference);
  EXPECT_LT(reference.energy.vdw, -50);
  const Forces one = b.fast(1), three = b.fast(3);
  EXPECT_NEAR(one.energy.vdw / reference.energy.vdw, 1, 1e-12);
  EXPECT_NEAR(one.damping_power / reference.damping_power, 1, 1e-12);
  double scale = 0;
  for (std::size_t i = 0; i < b.state.size(); ++i) scale = std::max(scale, reference.force[i].norm());
  for (std::size_t i = 0; i < b.state.size(); ++i) {
    ASSERT_LT((one.force[i] - reference.force[i]).norm(), 1e-12 * scale);
    ASSERT_LT((one.torque[i] - reference.torque[i]).norm(), 1e-12 * scale);
  }
  EXPECT_EQ(one.force.x, three.force.x);
  EXPECT_EQ(one.torque.y, three.torque.y);
  EXPECT_EQ(one.energy.vdw, three.energy.vdw);
}

TEST(BeadLaw, ForceIsTheGradient) {
  const BeadLaw law({0.678, 0.5}, 0.5, 4.5);
  test::Random random(3);
  const Vector3 z = Vector3::UnitZ();
  for (int k = 0; k < 200; ++k) {
    const Vector3 s = (1.4 + 0.015 * k) * random.direction();
    const TypePair types{k % 2, k / 2 % 2};
    const Vector3 f = law.force(types, s, z, z).force_j;
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy = [&](double h) { return law.energy(types, s + h * Vector3::Unit(axis), z, z); };
      ASSERT_NEAR(f[axis], -test::derivative(energy, 1e-4), 1e-6 * (1 + f.norm()));
    }
  }
  EXPECT_EQ(law.energy({}, {4.5, 0, 0}, z, z), 0);
  EXPECT_NEAR(law.energy({}, {4.499, 0, 0}, z, z), 0, 1e-6);
}

Scene bead_scene(const std::string& contact) {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 20.34\n"
      "[start]\ntemperature_K = 300\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"
      "[run]\nduration_ps = 1\n[contact]\n" +
          contact,
      "beads.toml");
}

TEST(BeadLaw, RunsInAScene) {
  Scene scene = bead_scene("law = \"beads\"\n");
  const Prepared p = prepare(scene);
  EXPECT_EQ(p.interaction.law->name(), "beads");
  // Tubes rest where a shifted tube has the least energy; a bit nearer than two beads, whose rows attract one
  // another.
  EXPECT_NEAR(p.spacing, 2 * scene.sets[0].radius + 0.335, 0.15);
  const auto energy = [&](double d) {
    double sum = 0;
    for (double shift : {0.0, 0.25, 0.5, 0.75})
      for (int k = -9; k <= 9; ++k)
        sum += p.interaction.law->energy({}, {d, 0, (k + shift) * scene.element_length}, Vector3::UnitZ(),
                                         Vector3::UnitZ());
    return sum / (4 * scene.element_length);
  };
  EXPECT_NEAR(test::derivative([&](double h) { return energy(p.spacing + h); }, 1e-4), 0, 1e-5);
  EXPECT_NEAR(contact_ranges(scene, contact_law(scene).get())[0].binding, -energy(p.spacing), 1e-9);
  // Undamped, the energy stays.
  Simulation s = start(scene, p);
  const double first = s.total_energy(), kinetic = kinetic_energy(s.topology(), s.state());
  EXPECT_LT(s.forces().energy.vdw, -10);
  double colours = 0;
  for (double half : element_colours(p.topology, p.interaction, p.state).vdw_energy) colours += half;
  EXPECT_NEAR(colours / s.forces().energy.vdw, 1, 1e-12);
  s.steps(400);
  EXPECT_GT(s.list().builds(), 0);
  EXPECT_NEAR(s.total_energy(), first, 0.1 * kinetic);
}

TEST(BeadLaw, IsInHelpAndErrors) {
  EXPECT_THAT(scene_key_help(), HasSubstr("\"line\" (first choice), \"paper\", \"beads\" or \"none\""));
  const auto message = [](const std::string& contact) -> std::string {
    try {
      bead_scene(contact);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message("law = \"pearls\"\n"), HasSubstr("beads"));
  EXPECT_THAT(message("law = \"beads\"\ncutoff_nm = 1.7\n"),
              HasSubstr("of the binding energy of two parallel tubes"));
  EXPECT_THAT(message("law = \"beads\"\nnodes_per_element = 3\n"), HasSubstr("belongs to law = \"line\""));
  EXPECT_EQ(message("law = \"beads\"\n"), "");
}

}  // namespace
}  // namespace ropewalk
