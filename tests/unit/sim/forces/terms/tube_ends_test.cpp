// Ends of tubes in line: model/contact/tube_ends.hpp and sim/forces/terms/tube_ends.hpp.
#include "sim/forces/terms/tube_ends.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "model/error.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "sim/forces/forces.hpp"
#include "terms_alone.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

const LennardJones graphene{2.84e-3, 0.34, 1.2};

EndContact ends_of(Chirality a, Chirality b) {
  return {graphene, tube_end(a, tube_radius(a), atoms_per_length(a)),
          tube_end(b, tube_radius(b), atoms_per_length(b))};
}

// Atoms of a tube of whole rows: the sites of the rolled sheet from the height 0 on.
std::vector<Vector3> rolled(Chirality c, int rows) {
  const double a = graphene_lattice_constant, C = circumference(c), r = tube_radius(c),
               length = rows * tube_end(c, r, atoms_per_length(c)).row;
  const Eigen::Vector2d a1(a, 0), a2(0.5 * a, 0.5 * std::sqrt(3.0) * a), around = c.n * a1 + c.m * a2,
                                                                         along(-around.y(), around.x());
  std::vector<Vector3> atoms;
  const int most = static_cast<int>((C + length) / (0.5 * a)) + 2;
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (const double third : {0.0, 1.0 / 3}) {
        const Eigen::Vector2d at = (i + third) * a1 + (j + third) * a2;
        const double turn = at.dot(around) / (C * C), z = at.dot(along) / C;
        if (turn > -1e-9 && turn < 1 - 1e-9 && z > -1e-9 && z < length - 1e-9)
          atoms.emplace_back(r * std::cos(2 * units::pi * turn), r * std::sin(2 * units::pi * turn), z);
      }
  return atoms;
}

// Mean over turns of the energy of two tubes whose last atoms are `apart` from one another along the axis.
double energy_of_atoms(Chirality c, double apart) {
  const std::vector<Vector3> tube = rolled(c, c.m == 0 ? 7 : 12);
  double top = 0;
  for (const Vector3& atom : tube) top = std::max(top, atom.z());
  double bottom = top;
  for (const Vector3& atom : tube) bottom = std::min(bottom, atom.z());
  constexpr int turns = 12;
  double energy = 0;
  for (int k = 0; k < turns; ++k) {
    const Eigen::AngleAxisd turn(2 * units::pi * (k + 0.3) / turns / std::gcd(c.n, c.m), Vector3::UnitZ());
    for (const Vector3& below : tube)
      for (const Vector3& other : tube) {
        const Vector3 above = turn * other + Vector3(0, 0, top - bottom + apart);
        const double rho = (above - below).norm();
        if (rho >= graphene.cutoff) continue;
        const double x6 = std::pow(graphene.sigma / rho, 6);
        energy += 4 * graphene.epsilon * x6 * (x6 - 1) / turns;
      }
  }
  return energy;
}

TEST(EndContact, IsTheSumOverTheAtomsOfTwoTubes) {
  // From the last atoms to the end of the tube.
  const auto margin = [](const TubeEnd& end) { return 0.5 * (end.row - std::fabs(end.split)); };
  for (const Chirality c : {Chirality{5, 5}, Chirality{10, 10}, Chirality{9, 0}}) {
    const EndContact ends = ends_of(c, c);
    const double half = margin(tube_end(c, tube_radius(c), atoms_per_length(c)));
    for (const double gap : {0.2, 0.22, 0.26, 0.34, 0.5, 0.8})
      EXPECT_NEAR(ends.terms(gap).energy, energy_of_atoms(c, gap + 2 * half),
                  0.01 * std::fabs(ends.terms(ends.rest()).energy))
          << c.n << "," << c.m << " " << gap;
  }
}

TEST(EndContact, LeavesTheGapOfGraphite) {
  const Chirality c{10, 10};
  const double row = tube_end(c, tube_radius(c), atoms_per_length(c)).row;
  EXPECT_NEAR(ends_of(c, c).rest() + row, 0.34, 0.005) << "between the last atoms";
  EXPECT_NEAR(ends_of(c, c).terms(ends_of(c, c).rest()).energy, -0.487, 0.002);
  EXPECT_NEAR(ends_of({5, 5}, c).rest(), ends_of(c, {5, 5}).rest(), 1e-6) << "either may be the lower one";
}

TEST(EndContact, IsSmooth) {
  for (const Chirality c : {Chirality{10, 10}, Chirality{12, 6}}) {
    const EndContact ends = ends_of(c, c);
    constexpr double h = 1e-5;
    for (double gap = -0.2; gap < 1.3; gap += 0.007) {
      const RadialTerms here = ends.terms(gap), before = ends.terms(gap - h), behind = ends.terms(gap + h);
      const double scale = 1 + std::fabs(here.energy);
      EXPECT_NEAR(here.derivative, (behind.energy - before.energy) / (2 * h), 1e-3 * scale) << gap;
      EXPECT_NEAR(here.second, (behind.derivative - before.derivative) / (2 * h), 0.02 * ends.stiffness()) << gap;
      EXPECT_LE(here.second, 1.001 * ends.stiffness());
    }
    EXPECT_EQ(ends.terms(ends.reach()).energy, 0);
  }
}

// Two tubes of 14 elements and 14 or 15 in line.
Scene in_line(const std::string& of_rope = "", const std::string& more = "") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 1\nlength_nm = 40\n"
      "tube_length_nm = 19.3\nstagger = \"none\"\n" +
          of_rope + more + "[run]\nduration_ps = 20\n",
      "");
}

TEST(TubeEnds, ForcesAndTorquesAreTheGradientAndKeepMomentum) {
  TermsAlone ends(in_line());
  const int above = ends.p.topology.tube_begin[1];
  for (const unsigned seed : {1u, 2u, 3u}) {
    const State s = ends.shaken(0.04, seed);
    expect_gradient(ends, s, {static_cast<std::size_t>(above - 1), static_cast<std::size_t>(above)});
    const NetForce net = net_force(s, ends.at(s));
    EXPECT_LT(net.force.norm(), 1e-9);
    EXPECT_LT(net.torque.norm(), 1e-8);
  }
}

TEST(TubeEnds, RestAtTheGapOfAtoms) {
  Scene scene = in_line();
  const Prepared p = prepare(scene);
  ASSERT_TRUE(p.topology.groups.ends_meet);
  const Simulation s = start(scene, p);
  EXPECT_NEAR(s.forces().energy.terms, -0.470, 0.002);
  EXPECT_NEAR(s.forces().energy.vdw, 0, 1e-9) << "the law of endless tubes has no part in it";
  EXPECT_LT(s.largest_force(), 1e-3);
}

TEST(TubeEnds, FastAndPlainSumsAgree) {
  TermsAlone ends(in_line());
  const State s = ends.shaken(0.03, 5);
  NeighbourList list(ends.p.interaction, 0.5);
  list.build(ends.p.topology, s);
  ForceEngine engine;
  Interaction in = ends.p.interaction;
  in.precision = Interaction::Precision::full;
  Forces fast(s.size()), plain(s.size());
  engine.compute(ends.p.topology, in, list, s, fast);
  compute_reference(ends.p.topology, in, s, plain);
  EXPECT_NEAR(fast.energy.terms, plain.energy.terms, 1e-12);
  EXPECT_NEAR(fast.energy.vdw, plain.energy.vdw, 1e-9);
  for (std::size_t i = 0; i < s.size(); ++i) EXPECT_LT((fast.force[i] - plain.force[i]).norm(), 1e-8);
}

// Driven against each other, and drawn apart beyond the reach.
TEST(TubeEnds, PushAndLetGo) {
  for (const auto& [strain, sign] : {std::pair{-0.004, -1.0}, std::pair{0.03, 0.0}}) {
    Scene scene = in_line("", "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { strain = " +
                                  std::to_string(strain) + ", rate_per_ps = 0.002 }\n");
    const Prepared p = prepare(scene);
    Simulation s = start(scene, p);
    const double first = s.total_energy();
    double moved = 0;
    for (int part = 0; part < 20; ++part) {
      s.steps(std::lround(1 / p.time_step));
      moved = std::max(moved, s.work());
    }
    const double pull = s.read_gauges()[upper_end].force.z();
    if (sign < 0)
      EXPECT_LT(pull, -5) << "eV/nm";
    else
      EXPECT_NEAR(s.forces().energy.terms, 0, 1e-12);
    EXPECT_NEAR(s.total_energy() - s.account().supplied() - first, 0, 0.01 * moved) << moved;
  }
}

// Two tubes of ten elements in line, from a file.
std::string message_of_file(const std::string& comment) {
  const std::string path = ::testing::TempDir() + "ends.csv";
  std::ofstream file(path);
  file << "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n" << comment;
  for (int i = 0; i < 20; ++i) file << i / 10 << ",0,0," << 1.37758708 * i + (i < 10 ? 0 : 0.215) << ",1,0,0,0\n";
  file.close();
  Scene scene =
      scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"" + path +
                        "\"\n[run]\nduration_ps = 1\n",
                    "");
  try {
    const Prepared p = prepare(scene);
    return std::to_string(start(scene, p).forces().energy.terms);
  } catch (const InputError& e) {
    return e.what();
  }
}

TEST(TubeEnds, MeetInAStateFileThatSaysSo) {
  EXPECT_THAT(message_of_file(""), ::testing::HasSubstr("strands_begin_with_tubes: 0"));
  EXPECT_NEAR(std::stod(message_of_file("# strands_begin_with_tubes: 0\n")), -0.470, 0.002);
}

// Ends that have left the common axis do not meet.
TEST(TubeEnds, DoNotMeetBesideOneAnother) {
  TermsAlone ends(in_line());
  State s = ends.p.state;
  for (int i = ends.p.topology.tube_begin[1]; i < ends.p.topology.elements(); ++i)
    s.position.x[static_cast<std::size_t>(i)] += 1.4;
  EXPECT_EQ(ends.energy(s), 0);
  for (int i = ends.p.topology.tube_begin[1]; i < ends.p.topology.elements(); ++i)
    s.position.x[static_cast<std::size_t>(i)] -= 0.7;
  EXPECT_LT(ends.energy(s), -0.1);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
