// Steps on a device: the kernels as C++ against the model's own forces and runs, and what OpenCL makes of the same
// text against the kernels as C++, bit by bit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "bench/bench_scenes.hpp"
#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "scene/random.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/device/device_stepper.hpp"
#include "sim/dynamics/blow_up.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// PoCL runs OpenCL on the processor. With a GPU: ROPEWALK_TEST_DEVICE=gpu.
std::string by_opencl() {
  const char* const asked = std::getenv("ROPEWALK_TEST_DEVICE");
  return asked ? asked : "opencl:portable computing language";
}

std::string rope_text(const std::string& more, const std::string& sets = "\"cnt-10-10-tersoff\"",
                      double length = 27) {
  return fmt::format(
      "format = \"ropewalk-scene-1\"\nparameters = {}\n[rope]\ntubes = 7\nlength_nm = {}\n[contact]\n"
      "precision = \"mixed\"\n[run]\nduration_ps = 100\n{}",
      sets, length, more);
}
const char* const two_kinds = "[\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]\ntype_shares = [0.5, 0.5]";
const char* const harmonic = "\"cnt-10-10-tersoff\"\nbond.law = \"harmonic\"";
const char* const twisted =
    "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = [[0, 0], [2, 60]] }\n";
const char* const damped = "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 2\nbond_damping_per_ps = 0.5\n";

struct Rope {
  Scene scene;
  Prepared p;

  explicit Rope(const std::string& text) : scene(scene_of_text(text, "rope.toml")), p(prepare(scene)) {}

  // Away from rest, moving.
  void shake(double by, double speed) {
    Random random(11);
    const auto any = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
    State& s = p.state;
    for (std::size_t i = 0; i < s.size(); ++i) {
      s.position.set(i, Vector3(s.position[i]) + by * any());
      s.orientation.set(i, (Quaternion(Eigen::AngleAxisd(by, any().normalized())) * s.orientation[i]).normalized());
      s.velocity.set(i, speed * any());
      s.angular_velocity.set(i, speed * any());
    }
  }
  Simulation on(const std::string& device) const {
    Simulation s(p.topology, p.interaction, p.loads, p.state, p.time_step, 0, p.stepping);
    if (!device.empty()) s.use_device(device);
    return s;
  }
};

double largest(const Vec3Array& a) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, a[i].norm());
  return most;
}
double largest_difference(const Vec3Array& a, const Vec3Array& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

void expect_same_bits(const Simulation& a, const Simulation& b) {
  const State &s = a.state(), &t = b.state();
  for (const auto& [x, y] : {std::pair{&s.position, &t.position},
                             {&s.velocity, &t.velocity},
                             {&s.angular_velocity, &t.angular_velocity},
                             {&a.forces().force, &b.forces().force},
                             {&a.forces().torque, &b.forces().torque}}) {
    EXPECT_EQ(x->x, y->x);
    EXPECT_EQ(x->y, y->y);
    EXPECT_EQ(x->z, y->z);
  }
  EXPECT_EQ(s.orientation.w, t.orientation.w);
  EXPECT_EQ(s.time, t.time);
  EXPECT_EQ(a.work(), b.work());
  EXPECT_EQ(a.dissipated(), b.dissipated());
}

// Largest errors over the largest force, and torque, of one state, against double precision.
struct Errors {
  double force, torque;
};
Errors errors_of(const Forces& f, const Forces& exact) {
  return {largest_difference(f.force, exact.force) / largest(exact.force),
          largest_difference(f.torque, exact.torque) / largest(exact.torque)};
}

// --- forces -------------------------------------------------------------------------------------------

// As near to double as the mixed path of the processor is. In one step of nearly no length, so that forces are
// those of the state.
TEST(Device, ForcesAreThoseOfTheModel) {
  for (const char* const sets : {"\"cnt-10-10-tersoff\"", harmonic, two_kinds}) {
    SCOPED_TRACE(sets);
    Rope rope(rope_text(std::string("[start]\ntwist_deg_per_nm = 2\n") + damped, sets));
    rope.shake(0.01, 0.2);
    rope.p.time_step = 1e-7;
    Simulation s = rope.on("c++");
    s.step();
    const Forces exact = s.forces_at(s.state(), Interaction::Precision::full),
                 mixed = s.forces_at(s.state(), Interaction::Precision::mixed);
    const Errors device = errors_of(s.forces(), exact), processor = errors_of(mixed, exact);
    EXPECT_LT(device.force, std::max(processor.force, 3e-6));
    EXPECT_LT(device.torque, std::max(processor.torque, 3e-6));
    EXPECT_NEAR(s.forces().damping_power, exact.damping_power, 1e-5 * std::fabs(exact.damping_power));
    RecordProperty("force", fmt::format("{:.2g} of {:.2g}", device.force, processor.force));
    std::printf(
        "largest error of a force over the largest force: device %.2g, processor %.2g; of a torque %.2g, %.2g\n",
        device.force, processor.force, device.torque, processor.torque);
  }
}

// Bonds and their damping are one text for both readers, so that the bits agree where both round each operation.
// Tubes of two elements, as sums over more have another order; a step of no length, as velocities must be those of
// the state.
TEST(Device, BondsHaveTheBitsOfTheModel) {
#ifdef __FP_FAST_FMA
  GTEST_SKIP() << "the compiler fuses the products of the model";
#endif
  for (const char* const set : {"cnt-10-10-tersoff", "cnt-5-5-tersoff"})
    for (const std::string law : {"harmonic", "anharmonic", "shaped"}) {
      SCOPED_TRACE(std::string(set) + ", " + law);
      const bool shaped = law == "shaped";
      Rope rope(rope_text("", fmt::format("\"{}\"\nbond.law = \"{}\"", set, shaped ? "harmonic" : law)));
      TubeType type = rope.p.topology.types[0];
      if (shaped) type.bond.natural = {0.1, -0.15, 0.3}, type.bond.bend_difference = 0.3 * type.bond.bend;
      Topology tubes;
      tubes.types = {type};
      constexpr int count = 40;
      for (int t = 0; t < count; ++t) tubes.add_tube(2, 0);
      rope.p.state = State(2 * count);
      for (std::size_t i = 0; i < 2 * count; ++i)
        rope.p.state.position.set(i, Vector3(0, 0, static_cast<double>(i) * type.element_length));
      rope.shake(0.1, 0.3);
      Interaction bonded;
      bonded.damping.bond.rate = 0.5;
      Simulation s(tubes, bonded, {}, rope.p.state, 1e-100);
      s.use_device("c++");
      s.step();
      Forces model;
      compute_reference(tubes, bonded, s.state(), model);
      EXPECT_GT(largest(model.torque), 1);
      if (law != "anharmonic") {
        for (const auto& [a, b] :
             {std::pair{&s.forces().force, &model.force}, {&s.forces().torque, &model.torque}}) {
          EXPECT_EQ(a->x, b->x);
          EXPECT_EQ(a->y, b->y);
          EXPECT_EQ(a->z, b->z);
        }
      } else {  // two functions for the arc tangent
        const Errors e = errors_of(s.forces(), model);
        EXPECT_LT(e.force, 1e-14);
        EXPECT_LT(e.torque, 1e-14);
      }
    }
}

// Tubes that overlap by far: the parabola below the core.
TEST(Device, ForcesOfPressedTubes) {
  Rope rope(rope_text(""));
  rope.p.time_step = 1e-9;
  for (std::size_t i = 0; i < rope.p.state.size(); ++i) {
    rope.p.state.position.x[i] *= 0.83;
    rope.p.state.position.y[i] *= 0.83;
  }
  Simulation s = rope.on("c++");
  s.step();
  const Errors e = errors_of(s.forces(), s.forces_at(s.state(), Interaction::Precision::full));
  EXPECT_LT(e.force, 3e-6);
}

// Every pair whose nodes, or whose centres within the viscosity, are near enough; parts of one tube apart.
TEST(Device, FindsTheNeighboursOfEveryElement) {
  for (const char* const sets : {"\"cnt-10-10-tersoff\"", two_kinds}) {
    SCOPED_TRACE(sets);
    Rope rope(rope_text(damped, sets));
    rope.shake(0.05, 0.1);
    const Simulation s = rope.on("");
    DeviceStepper device(rope.p.topology, rope.p.interaction, "c++");
    device.take(s.state(), s.forces(), {}, s.list());
    const DeviceStepper::Neighbours found = device.neighbours();
    const Topology& of = rope.p.topology;
    const auto& law = dynamic_cast<const LineLaw&>(*rope.p.interaction.law);
    const double skin = s.list().skin, centres = rope.p.interaction.damping.contact.outer + skin;
    const auto near = [&](int i, int j) {
      const int tube_i = of.tube_of(i), tube_j = of.tube_of(j);
      if (tube_i == tube_j && j - i <= of.type_of(tube_i).elements_within(rope.p.interaction.excluded_arc()))
        return false;
      const auto at_i = static_cast<std::size_t>(i), at_j = static_cast<std::size_t>(j);
      const Vector3 apart = s.state().position[at_j] - s.state().position[at_i];
      if (apart.norm() < centres) return true;
      const LineContact& pair =
          law.of({of.tube_type[static_cast<std::size_t>(tube_i)], of.tube_type[static_cast<std::size_t>(tube_j)]});
      const Vector3 n_i = axis_of(s.state().orientation[at_i]), n_j = axis_of(s.state().orientation[at_j]);
      const double rim = line_node(pair.nodes_i - 1, pair.nodes_i, pair.length_i);
      for (int l = 0; l < pair.nodes_j; ++l) {
        const Vector3 d = apart + line_node(l, pair.nodes_j, pair.length_j) * n_j;
        const double along = std::min(std::max(d.dot(n_i), -rim), rim);
        if ((d - along * n_i).norm() < pair.density.cutoff() + skin) return true;
      }
      return false;
    };
    std::vector<std::vector<int>> expected(s.state().size());
    for (int i = 0; i < of.elements(); ++i)
      for (int j = i + 1; j < of.elements(); ++j)
        if (near(i, j))
          expected[static_cast<std::size_t>(i)].push_back(j), expected[static_cast<std::size_t>(j)].push_back(i);
    int in_two_parts = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      std::sort(expected[i].begin(), expected[i].end());
      std::vector<int> listed(found.neighbour.begin() + found.begin[i],
                              found.neighbour.begin() + found.begin[i + 1]);
      const auto second = std::is_sorted_until(listed.begin(), listed.end());  // of the two parts
      EXPECT_TRUE(std::is_sorted(second, listed.end()));
      in_two_parts += second != listed.end();
      std::sort(listed.begin(), listed.end());
      EXPECT_EQ(listed, expected[i]) << i;
    }
    EXPECT_GT(in_two_parts, 10);
    EXPECT_GT(found.neighbour.size(), 10 * expected.size());
  }
}

// Rounds of the contact's loop that four elements with eight lanes each go through together, as they do on a GPU of
// NVIDIA: all, and those in which a node is within the cutoff.
struct Rounds {
  double all = 0, with_work = 0;
};
Rounds rounds_of(const Prepared& p, const State& s, const DeviceStepper::Neighbours& list) {
  constexpr int lanes = 8, together = 4;
  const LineContact& pair = dynamic_cast<const LineLaw&>(*p.interaction.law).pairs.front();
  const int nodes = pair.nodes_i, elements = p.topology.elements();
  const double rim = line_node(nodes - 1, nodes, pair.length_i), reach2 = std::pow(pair.density.cutoff(), 2);
  const auto begin = [&](int i) { return list.begin[static_cast<std::size_t>(i)]; };
  const auto meets = [&](int i, int node) {
    const auto own = static_cast<std::size_t>(i),
               other = static_cast<std::size_t>(list.neighbour[static_cast<std::size_t>(begin(i) + node / nodes)]);
    const Vector3 n = axis_of(s.orientation[own]),
                  d = s.position[other] - s.position[own] +
                      line_node(node % nodes, nodes, pair.length_j) * axis_of(s.orientation[other]);
    return (d - std::min(std::max(d.dot(n), -rim), rim) * n).squaredNorm() < reach2;
  };
  Rounds sum;
  for (int first = 0; first + together <= elements; first += together) {
    int most = 0;
    for (int i = first; i < first + together; ++i) most = std::max(most, (begin(i + 1) - begin(i)) * nodes);
    for (int from = 0; from < most; from += lanes) {
      bool work = false;
      for (int i = first; i < first + together; ++i)
        for (int node = from; node < std::min(from + lanes, (begin(i + 1) - begin(i)) * nodes) && !work; ++node)
          work = meets(i, node);
      sum.all += static_cast<double>(together) / elements;
      sum.with_work += work ? static_cast<double>(together) / elements : 0;
    }
  }
  return sum;
}

// Figures of docs/performance.md. Both single precisions are off by some 1e-4 of the largest force. The device has
// the table of AVX-512, whose errors there are 3.8e-4 and 5.8e-4; other processors have the pieces, with smaller
// errors.
TEST(Device, ErrorsAndWorkInARope) {
  for (const auto& [name, by_table] : {std::pair{"rope-91x50", 3.8e-4}, {"rope-91x50-twisted", 5.8e-4}}) {
    SCOPED_TRACE(name);
    Scene scene = bench_scene(name, "line");
    const Prepared p = prepare(scene);
    Simulation run = start(scene, p);
    run.steps(std::lround(std::max(5.0, bench_after(name)) / p.time_step), false);
    Interaction undamped = p.interaction;
    undamped.damping = {};
    Simulation s(p.topology, undamped, {}, run.state(), 1e-9);
    s.use_device("c++");
    s.step();
    const Forces exact = s.forces_at(s.state(), Interaction::Precision::full),
                 mixed = s.forces_at(s.state(), Interaction::Precision::mixed);
    const Errors device = errors_of(s.forces(), exact), processor = errors_of(mixed, exact);
    const double net = net_force(s.state(), s.forces()).force.norm(),
                 net_of_processor = net_force(s.state(), mixed).force.norm();
    std::printf(
        "%s: largest force %.2g eV/nm; errors over it: device %.2g, processor %.2g; sum of all forces: device %.1g "
        "eV/nm, processor %.1g\n",
        name, largest(exact.force), device.force, processor.force, net, net_of_processor);
    EXPECT_LT(device.force, 1.5 * by_table);
    EXPECT_LT(processor.force, 1.5 * by_table);
    EXPECT_LT(net, 3e-3);

    DeviceStepper::Neighbours list = [&] {
      DeviceStepper stepper(p.topology, p.interaction, "c++");
      NeighbourList begun(p.interaction, 0.25);
      begun.begin(p.topology, run.state());
      stepper.take(run.state(), run.forces(), {}, begun);
      return stepper.neighbours();
    }();
    const Rounds near_first = rounds_of(p, run.state(), list);
    for (std::size_t i = 0; i + 1 < list.begin.size(); ++i)
      std::sort(list.neighbour.begin() + list.begin[i], list.neighbour.begin() + list.begin[i + 1]);
    const Rounds by_number = rounds_of(p, run.state(), list);
    std::printf("%s: %.1f neighbours; %.1f rounds, %.1f with work; by number %.1f with work\n", name,
                static_cast<double>(list.neighbour.size()) / p.topology.elements(), near_first.all,
                near_first.with_work, by_number.with_work);
    EXPECT_LT(near_first.with_work, by_number.with_work + 0.1);
  }
}

// --- runs ---------------------------------------------------------------------------------------------

TEST(Device, OpenClGivesTheBitsOfTheKernelsInCpp) {
  try {
    Rope(rope_text("")).on(by_opencl());
  } catch (const std::invalid_argument& e) {
    GTEST_SKIP() << e.what() << " (Debian: pocl-opencl-icd)";
  }
  for (const char* const sets : {"\"cnt-10-10-tersoff\"", harmonic, two_kinds}) {
    SCOPED_TRACE(sets);
    Rope rope(rope_text(std::string(twisted) + damped, sets, 20));
    rope.shake(0.005, 0.1);
    Simulation a = rope.on("c++"), b = rope.on(by_opencl());
    for (int part = 0; part < 4; ++part) {
      a.steps(25);
      b.steps(25);
      expect_same_bits(a, b);
    }
    EXPECT_GT(a.list().builds(), 1);
  }
}

TEST(Device, TwistsLikeTheProcessor) {
  Rope rope(rope_text(std::string(twisted) + damped));
  Simulation here = rope.on(""), there = rope.on("c++");
  const long steps = std::lround(2 / rope.p.time_step);
  here.steps(steps);
  there.steps(steps);
  EXPECT_EQ(here.state().step, there.state().step);
  const EndReadings a = here.read_gauges(), b = there.read_gauges();
  EXPECT_NEAR(a[upper_end].torque.z(), b[upper_end].torque.z(), 1e-4 * std::fabs(a[upper_end].torque.z()));
  EXPECT_NEAR(a[upper_end].turned, b[upper_end].turned, 1e-12);
  EXPECT_NEAR(here.work(), there.work(), 1e-4 * here.work());
  EXPECT_NEAR(here.dissipated(), there.dissipated(), 1e-3 * here.dissipated());
  EXPECT_LT(largest_difference(here.state().position, there.state().position), 1e-4);
  EXPECT_NEAR(here.total_energy(), there.total_energy(), 1e-5 * std::fabs(here.total_energy()));
}

TEST(Device, KeepsTheAccountOfEnergy) {
  Rope rope(rope_text(std::string(twisted) + damped));
  rope.shake(0.005, 0.1);
  const auto error_on = [&](const std::string& device) {
    Simulation s = rope.on(device);
    const double first = s.total_energy();
    s.steps(std::lround(4 / rope.p.time_step));
    EXPECT_GT(s.work(), 10);
    return s.total_energy() - first - s.account().supplied();
  };
  const double here = error_on(""), there = error_on("c++");
  std::printf("error of the account after 4 ps: %.4g eV, and %.4g eV without a device\n", there, here);
  EXPECT_NEAR(there, here, 1e-2 * std::fabs(here));
}

// Nothing holds the rope: gathered forces are opposite up to rounding.
TEST(Device, AFreeRopeStaysWhereItIs) {
  Rope rope(rope_text("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"));
  rope.shake(0.01, 0.1);
  struct Gained {
    double speed, energy;
  };
  const auto gained_on = [&](const std::string& device) {
    Simulation s = rope.on(device);
    const auto momentum = [&] {
      Vector3 sum = Vector3::Zero();
      for (std::size_t i = 0; i < s.state().size(); ++i) sum += s.state().velocity[i];
      return (sum / static_cast<double>(s.state().size())).eval();
    };
    const Vector3 before = momentum();
    const double energy = s.total_energy();
    s.steps(std::lround(20 / rope.p.time_step));
    return Gained{(momentum() - before).norm(), s.total_energy() - energy};
  };
  const Gained here = gained_on(""), there = gained_on("c++");
  std::printf("after 20 ps: speed of the centre %.2g nm/ps (without a device %.2g), energy %+.4g eV (%+.4g)\n",
              there.speed, here.speed, there.energy, here.energy);
  EXPECT_LT(there.speed, 1e-6);
  EXPECT_NEAR(there.energy, here.energy, 0.1 * std::fabs(here.energy));
}

TEST(Device, ManyStepsAreTheBitsOfSingleOnes) {
  Rope rope(rope_text(std::string(twisted) + damped));
  Simulation at_once = rope.on("c++"), one_by_one = rope.on("c++");
  at_once.steps(60);
  for (int k = 0; k < 60; ++k) {
    one_by_one.step(k % 7 == 0);
    if (k % 5 == 0) {
      EXPECT_GT(one_by_one.state().velocity.size(), 0U);
    }
  }
  one_by_one.steps(0);
  expect_same_bits(at_once, one_by_one);
}

TEST(Device, ACheckpointGoesOnWithTheSameBits) {
  Rope rope(rope_text(std::string(twisted) + damped));
  rope.shake(0.005, 0.1);
  Simulation whole = rope.on("c++"), first = rope.on("c++"), second = rope.on("c++");
  whole.steps(130);
  first.steps(70);
  second.restore(first.serialise());
  second.steps(60);
  expect_same_bits(whole, second);
  EXPECT_EQ(whole.total_energy(), second.total_energy());
}

// The processor takes over in the middle, and gives back.
TEST(Device, ComesBackForARelaxation) {
  Rope rope(rope_text("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 2\n"));
  rope.shake(0.01, 0.1);
  Simulation s = rope.on("c++");
  s.steps(20);
  EXPECT_TRUE(s.relax(1e-2, 5000, [](long) { return true; }));
  EXPECT_LT(s.largest_force(), 1e-2);
  s.steps(20);
  EXPECT_LT(s.largest_force(), 0.1);
}

// A slice, whose images the host moves.
TEST(Device, RunsASliceWithoutEnds) {
  Rope rope(rope_text(std::string(damped) + "[periodic]\ntwist_deg_per_nm = [[0, 0], [2, 2]]\n"));
  Simulation here = rope.on(""), there = rope.on("c++");
  const long steps = std::lround(2 / rope.p.time_step);
  here.steps(steps);
  there.steps(steps);
  EXPECT_NEAR(here.work(), there.work(), 1e-3 * here.work());
  EXPECT_LT(largest_difference(here.state().position, there.state().position), 1e-3);
}

// --- what it refuses ----------------------------------------------------------------------------------

std::string refusal(const Rope& rope, const std::string& device = "c++") {
  try {
    rope.on(device);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Device, SaysWhatItCannotDo) {
  EXPECT_THAT(
      refusal(Rope(rope_text("[thermostat]\ntemperature_K = 300\ncoupling_per_ps = "
                             "1\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"))),
      HasSubstr("no thermostat"));
  EXPECT_THAT(refusal(Rope(rope_text("[damping]\npfc_local = 0.5\n"))), HasSubstr("damping.pfc_local"));
  EXPECT_THAT(refusal(Rope(rope_text("[[links]]\nper_nm = 0.3\nreach_nm = 1\nstiffness_nN_per_nm = 100\n"))),
              HasSubstr("links"));
  const std::string gpu = refusal(Rope(rope_text("")), "gpu");
  if (!gpu.empty()) {  // there is none
    EXPECT_THAT(gpu, ::testing::AnyOf(HasSubstr("no GPU was found"), HasSubstr("without the headers")));
  }
  EXPECT_THAT(refusal(Rope(rope_text("")), "opencl:nobody has this"), HasSubstr("no device has"));
  EXPECT_THAT(refusal(Rope(rope_text("")), "cuda"), HasSubstr("name gpu, opencl:TEXT or c++"));
}

TEST(Device, SaysWhereTheMotionBlewUp) {
  Rope rope(rope_text("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"));
  rope.p.state.velocity.set(33,
                            {0, 0, 2 * MotionBound::radii * rope.p.topology.largest_radius() / rope.p.time_step});
  Simulation s = rope.on("");
  s.use_device("c++");
  try {
    s.steps(3);
    FAIL() << "nothing was thrown";
  } catch (const NumericalError& e) {
    EXPECT_THAT(e.what(), HasSubstr("blew up"));
    EXPECT_EQ(e.element(), 33);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
