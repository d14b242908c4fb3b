// [[friction]]: sim/forces/terms/dry_friction.hpp and its table, scene/interactions/friction.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <random>

#include "io/bath_words.hpp"
#include "io/log.hpp"
#include "model/error.hpp"
#include "model/units.hpp"
#include "run/moving_scene.hpp"
#include "scene/finer.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/refine.hpp"
#include "terms_alone.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

constexpr double pN = 1e-3 * units::nN_nm;  // eV/nm

const std::string both =
                      "[[friction]]\nstrength_pN_per_nm = 40\nspin_strength_pN_per_nm = 60\nend_strength_pN = 5\n",
                  axial = "[[friction]]\nstrength_pN_per_nm = 40\n", ends = "[[friction]]\nend_strength_pN = 5\n",
                  cold =
                      "[contact]\nprecision = \"double\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n"
                      "bond_damping_per_ps = 0\n";

Scene rope(const std::string& friction, const std::string& run = "duration_ps = 5\n",
           const std::string& more = "") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = "
      "13.8\n" +
          more + friction + "[run]\n" + run,
      "friction.toml");
}

// The forces of the friction alone. Contacts begin where the rope starts, and remember.
class Alone : public TermsAlone {
 public:
  explicit Alone(const std::string& friction, const std::string& more = "")
      : TermsAlone(rope(friction, "duration_ps = 5\n", more)) {}
  double length() const { return p.topology.length_of(0) * p.topology.types[0].element_length; }
  // The first tube, in the middle of six others, moved along them and turned about its axis.
  State moved(double along, double turn) const {
    State s = p.state;
    for (int e = p.topology.tube_begin[0]; e < p.topology.tube_begin[1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      s.position.add(i, Vector3(0, 0, along));
      s.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn, Vector3::UnitZ())) * s.orientation[i]);
    }
    return s;
  }
  State shaken(double by) const {
    State s = p.state;
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> any(-by, by);
    for (std::size_t i = 0; i < s.size(); ++i) {
      s.position.add(i, Vector3(any(engine), any(engine), any(engine)));
      const Vector3 turn(any(engine), any(engine), any(engine));
      s.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * s.orientation[i]);
    }
    return s;
  }
};

Vector3 on_first_tube(const Alone& rope, const Vec3Array& rows) {
  Vector3 sum = Vector3::Zero();
  for (int e = 0; e < rope.p.topology.tube_begin[1]; ++e) sum += rows[static_cast<std::size_t>(e)];
  return sum;
}

const std::string pulled =
    "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\nforce_nN = [0, 0, 0.3]\n"
    "[[load]]\nkind = \"fix\"\ntubes = [1, 3, 5]\nelements = [0]\n";

const std::string corrugation = "slip = \"corrugation\"\n";

class FrictionLaw : public ::testing::TestWithParam<std::string> {};

TEST_P(FrictionLaw, ForcesAreTheGradientOfItsEnergyAndBalance) {
  Alone rope(both + GetParam());
  const State s = rope.shaken(0.02);
  const Forces f = rope.at(s);
  EXPECT_GT(f.energy.terms, 0.01);
  const NetForce net = net_force(s, f);
  EXPECT_LT(net.force.norm(), 1e-10);
  EXPECT_LT(net.torque.norm(), 1e-9);
  constexpr double h = 1e-5;
  double largest = 0;
  for (std::size_t i = 0; i < s.size(); i += 3)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy = [&](double move, double turn) {
        State other = s;
        Vector3 unit = Vector3::Zero();
        unit[axis] = 1;
        other.position.set(i, s.position[i] + move * unit);
        other.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn, unit)) * s.orientation[i]);
        return rope.at(other).energy.terms;
      };
      EXPECT_NEAR(f.force[i][axis], -(energy(h, 0) - energy(-h, 0)) / (2 * h), 1e-6) << i;
      EXPECT_NEAR(f.torque[i][axis], -(energy(0, h) - energy(0, -h)) / (2 * h), 1e-6) << i;
      largest = std::max({largest, std::fabs(f.force[i][axis]), std::fabs(f.torque[i][axis])});
    }
  EXPECT_GT(largest, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Each, FrictionLaw, ::testing::Values("", corrugation));

// The largest force is the strength, each period is like the first, and nothing is lost.
TEST(DryFriction, ACorrugationComesBackInEachPeriod) {
  constexpr double delta = 0.06;
  Alone rope(axial + corrugation);
  const double strength = 40 * pN * 6 * rope.length();
  double lost = 0;
  for (double slip = 0.01; slip < 0.6; slip += 0.01) {
    const Forces f = rope.at(rope.moved(slip, 0), true);
    lost += f.lost;
    EXPECT_NEAR(on_first_tube(rope, f.force).z(), -strength * std::sin(slip / delta), 1e-6 * strength) << slip;
    EXPECT_NEAR(f.energy.terms, strength * delta * (1 - std::cos(slip / delta)), 1e-6 * strength) << slip;
  }
  EXPECT_EQ(lost, 0);
  Alone spins("[[friction]]\nspin_strength_pN_per_nm = 60\n" + corrugation);
  const double radius = spins.p.topology.types[0].radius, most = 60 * pN * 6 * spins.length() * radius;
  for (double turn = 0.02; turn < 2; turn += 0.02)
    EXPECT_NEAR(on_first_tube(spins, spins.at(spins.moved(0, turn), true).torque).z(),
                -most * std::sin(turn * radius / delta), 1e-5 * most)
        << turn;
}

TEST(DryFriction, TubesThatRideOverACorrugationLoseNothing) {
  Scene scene = rope(both + corrugation + pulled, "duration_ps = 20\ntime_step_fs = 2\n", cold);
  Simulation s = start(scene, prepare(scene));
  const double total = s.total_energy();
  double error = 0;
  for (int n = 0; n < 2000; ++n) {
    s.step();
    error = std::max(error, std::fabs(s.total_energy() - s.account().supplied() - total));
  }
  const TermAccount of_friction = s.term_accounts().at(0);
  EXPECT_EQ(of_friction.lost, 0);
  EXPECT_GT(of_friction.events, 20) << "it slides over periods";
  EXPECT_LT(error, 1e-4 * s.work());
}

TEST(DryFriction, ARopeThatMovesAsAWholeFeelsNothing) {
  Alone rope(both);
  const auto whole = [](const State& s) {
    State out = s;
    const Quaternion q(Eigen::AngleAxisd(2.3, Vector3(1, 2, -0.5).normalized()));
    for (std::size_t i = 0; i < s.size(); ++i) {
      out.position.set(i, q * s.position[i] + Vector3(3, -7, 11));
      out.orientation.set(i, q * s.orientation[i]);
    }
    return out;
  };
  EXPECT_LT(rope.at(whole(rope.p.state)).energy.terms, 1e-20);
  const State s = rope.shaken(0.02);
  EXPECT_NEAR(rope.at(whole(s)).energy.terms, rope.at(s).energy.terms, 1e-11);
}

// Along the axis and against spin, by hand: elastic up to delta, then the strength times the length and six
// neighbours.
TEST(DryFriction, HoldsUpToItsStrengthAndLosesWhatItSlides) {
  constexpr double delta = 0.06;
  {
    Alone rope(axial);
    const double strength = 40 * pN * 6 * rope.length();
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(delta / 2, 0), true).force).z(), -strength / 2,
                1e-9 * strength);
    double lost = 0;
    for (double slip = 0.04; slip < 0.3005; slip += 0.01) lost += rope.at(rope.moved(slip, 0), true).lost;
    EXPECT_NEAR(lost, strength * (0.3 - delta), 1e-3 * strength);
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(0.3, 0)).force).z(), -strength, 1e-6 * strength);
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(0.3 - delta, 0)).force).z(), 0, 1e-6 * strength)
        << "and backwards";
  }
  {
    Alone rope("[[friction]]\nspin_strength_pN_per_nm = 60\n");
    const double radius = rope.p.topology.types[0].radius, strength = 60 * pN * 6 * rope.length() * radius;
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(0, delta / 2 / radius), true).torque).z(), -strength / 2,
                1e-6);
    for (double turn = 0.1; turn < 7; turn += 0.1) rope.at(rope.moved(0, turn), true);
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(0, 7.0), true).torque).z(), -strength, 1e-6)
        << "after a whole turn";
  }
  {
    Alone rope(ends);
    for (double slip = 0.05; slip < 0.3; slip += 0.05) rope.at(rope.moved(slip, 0), true);
    // Two ends of the first tube and two of each of the six others beside it, of which one pair stands clear by
    // 0.25 nm and is still beside it.
    EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(0.25, 0)).force).z(), -5 * pN * 24, 1e-6);
  }
}

// A tube that is drawn out holds on to what lies beside it.
TEST(DryFriction, FollowsTheOverlap) {
  Alone rope(axial);
  const double a = rope.p.topology.types[0].element_length, n = rope.p.topology.length_of(0);
  double z = 0;
  for (; z < 5.5 * a; z += 0.05) rope.at(rope.moved(z, 0), true);
  const double beside = n - 5.5;  // elements, to one of them
  EXPECT_NEAR(on_first_tube(rope, rope.at(rope.moved(z, 0), true).force).z(), -40 * pN * 6 * beside * a,
              40 * pN * 6 * 1.01 * a);
}

// A tube that leaves the others and comes back, within one neighbour list: what it then slides counts from there.
TEST(DryFriction, BeginsInTheStepInWhichTubesMeet) {
  Alone gone(axial), stayed(axial);
  const auto with_outer_tube = [&](const Vector3& by) {
    State s = gone.p.state;
    for (int e = gone.p.topology.tube_begin[1]; e < gone.p.topology.tube_begin[2]; ++e)
      s.position.add(static_cast<std::size_t>(e), by);
    return s;
  };
  const Vector3 begin = gone.p.state.position[static_cast<std::size_t>(gone.p.topology.tube_begin[1])];
  const Vector3 outwards = Vector3(begin.x(), begin.y(), 0).normalized();
  const State slid = with_outer_tube({0, 0, 0.002});
  gone.at(with_outer_tube(0.3 * outwards), true);
  EXPECT_NEAR(gone.energy(slid), 0, 1e-12) << "it has left";
  gone.at(with_outer_tube(0.09 * outwards), true);
  EXPECT_GT(gone.energy(slid), 0) << "it meets them again";
  Alone back(axial);
  back.at(with_outer_tube(0.3 * outwards), true);
  back.at(back.p.state, true);
  EXPECT_GT(stayed.energy(slid), 1e-6);
  EXPECT_NEAR(back.energy(slid), stayed.energy(slid), 1e-9);
}

TEST(DryFriction, ActsBetweenItsTypesOnly) {
  const auto energy = [](const std::string& types) {
    Scene scene = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = [\"cnt-10-10-tersoff\", \"cnt-17-0-tersoff\"]\n"
        "tube_types = [1, 0, 0, 0, 0, 0, 0]\n[rope]\ntubes = 7\nlength_nm = 13.8\n" +
            axial + types +
            "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\nforce_nN = [0, 0, 0.001]\n"
            "[run]\nduration_ps = 1\ntime_step_fs = 2\n",
        "types.toml");
    Simulation s = start(scene, prepare(scene));
    s.steps(200);
    return s.forces().energy.terms;
  };
  EXPECT_GT(energy("types = [0, 1]\n"), 1e-6);
  EXPECT_GT(energy(""), energy("types = [0, 1]\n") * 0.9);
  EXPECT_LT(energy("types = [1, 1]\n"), 1e-12);
}

TEST(DryFriction, OfTwoTablesTheOneThatNamesAPairHasItAlone) {
  const auto hold = [](const std::string& tables) {
    TermsAlone rope(
        scene_of_text("format = \"ropewalk-scene-1\"\nparameters = [\"cnt-10-10-tersoff\", \"cnt-10-10-tersoff\"]\n"
                      "tube_types = [1, 0, 0, 0, 0, 0, 0]\n[rope]\ntubes = 7\nlength_nm = 13.8\n" +
                          tables + "[run]\nduration_ps = 1\n",
                      "types.toml"));
    State s = rope.p.state;
    const int first = rope.p.topology.tube_begin[1];
    for (int e = 0; e < first; ++e) s.position.add(static_cast<std::size_t>(e), Vector3(0, 0, 0.03));
    const Forces f = rope.at(s);
    double sum = 0;
    for (int e = 0; e < first; ++e) sum += f.force[static_cast<std::size_t>(e)].z();
    return sum;
  };
  const std::string weak = "[[friction]]\nstrength_pN_per_nm = 10\ntypes = [0, 1]\n";
  const double alone = hold(axial);
  EXPECT_NEAR(alone, -0.5 * 40 * pN * 6 * 13.78, 1e-3 * -alone);
  EXPECT_NEAR(hold(axial + weak), 0.25 * alone, 1e-9);
  EXPECT_NEAR(hold(weak + axial), 0.25 * alone, 1e-9);
}

TEST(DryFriction, TheAccountOfEnergyStaysClosedWhereTubesSlide) {
  Scene scene = rope(both + "drag_eV_ps_per_nm3 = 0.05\n" + pulled, "duration_ps = 20\ntime_step_fs = 2\n", cold);
  Simulation s = start(scene, prepare(scene));
  const double total = s.total_energy();
  double error = 0;
  for (int n = 0; n < 2000; ++n) {
    s.step();
    error = std::max(error, std::fabs(s.total_energy() - s.account().supplied() - total));
  }
  EXPECT_GT(s.dissipated(), 1) << "it slides";
  EXPECT_LT(error, 1e-5 * s.dissipated());
  const TermAccount of_friction = s.term_accounts().at(0);
  EXPECT_GT(of_friction.lost, 0.5);
  EXPECT_GT(of_friction.drag, 0.01);
  EXPECT_GE(of_friction.events, 6 * 10) << "the elements of a tube begin to slide on six others";
  EXPECT_NEAR(of_friction.lost + of_friction.drag, s.dissipated(), 1e-9 * s.dissipated()) << "nothing else loses";
}

// Below the strength nothing slips.
TEST(DryFriction, HeldTubesLoseNothing) {
  Scene scene =
      rope(axial + "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\nforce_nN = [0, 0, 0.05]\n",
           "duration_ps = 20\ntime_step_fs = 2\n", cold);
  Simulation s = start(scene, prepare(scene));
  s.steps(500);
  EXPECT_GT(s.forces().term_energy.at(0), 1e-3);
  const TermAccount of_friction = s.term_accounts().at(0);
  EXPECT_EQ(of_friction.lost, 0);
  EXPECT_EQ(of_friction.events, 0);
}

// Shear lag: a tube that is pulled by one end slides as far as its tension N outweighs the friction q per length of
// its six neighbours. With the elastic layer l = sqrt(EA delta/q) before the front, at the depth d behind an end
// that has moved by u,
//   N = sqrt(2 EA q (u - delta/2)) - q d.
TEST(DryFriction, ATubePulledByOneEndSlidesAsFarAsItsTensionReaches) {
  constexpr double u = 0.2, delta = 0.005;
  Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = "
      "69\n[bond]\nlaw = "
      "\"harmonic\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = "
      "2\n[[friction]]\nstrength_pN_per_nm = "
      "100\nelastic_slip_nm = 0.005\n[[load]]\nkind = \"fix\"\ntubes = [1, 2, 3, 4, 5, 6]\nelements = "
      "\"all\"\n[[grip]]\ntubes = "
      "[0]\nend = \"upper\"\nz = { displacement_nm = [[0, 0], [60, 0.2]] }\nsmooth_ps = 5\n[run]\nduration_ps = "
      "75\n",
      "pull.toml");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  s.steps(std::lround(p.duration / p.time_step));
  const TubeType& type = p.topology.types[0];
  const double q = 6 * 100 * pN, EA = type.bond.stretch, front = std::sqrt(2 * EA * q * (u - 0.5 * delta)) / q;
  const int last = p.topology.tube_begin[1] - 1;
  const auto tension = [&](int bonds) {  // so many bonds behind the end
    const auto i = static_cast<std::size_t>(last - bonds);
    return EA * ((s.state().position[i] - s.state().position[i - 1]).norm() / type.element_length - 1);
  };
  EXPECT_NEAR(
      s.state().position[static_cast<std::size_t>(last)].z() - p.state.position[static_cast<std::size_t>(last)].z(),
      u, 1e-6);
  EXPECT_GT(front, 25);
  for (const int bonds : {3, 8, 13, 18}) {
    const double depth = bonds * type.element_length;
    EXPECT_NEAR(tension(bonds), q * (front - depth), 0.03 * q * front) << depth << " nm";
  }
  EXPECT_NEAR(tension(40), 0, 0.02 * q * front) << "nothing moves there";
}

TEST(DryFriction, TheLogTellsItsLossesFromThoseOfDamping) {
  Scene scene = rope(both + "drag_eV_ps_per_nm3 = 0.05\n" + pulled, "duration_ps = 20\ntime_step_fs = 2\n");
  MovingScene moving(scene);
  moving.simulation.steps(1000);
  const LogRow row = moving.row();
  const TermAccount of_friction = moving.simulation.term_accounts().at(0);
  EXPECT_EQ(row["friction_slip_eV"], of_friction.lost);
  EXPECT_EQ(row["friction_drag_eV"], of_friction.drag);
  EXPECT_EQ(row["friction_slips"], of_friction.events);
  EXPECT_GT(row["damping_eV"], 0.1);
  EXPECT_NEAR(row["damping_eV"] + row["friction_slip_eV"] + row["friction_drag_eV"], row["dissipated_eV"], 1e-9);
  EXPECT_THAT(damping_words(row), HasSubstr("which atoms do not have"));
}

// Tubes that rub in a bath are colder than it, by as much as the run says at its end.
TEST(DryFriction, ABathSaysWhatItDoesNotHold) {
  constexpr double coupling = 0.1;
  const auto log_with = [&](const std::string& friction) {
    Scene scene = rope(friction, "duration_ps = 60\n",
                       cold + "[start]\ntemperature_K = 300\n[thermostat]\ntemperature_K = 300\n"
                              "coupling_per_ps = 0.1\n");
    MovingScene moving(scene);
    std::vector<LogRow> log;
    while (moving.simulation.time() < 60) {
      moving.simulation.steps(20);
      log.push_back(moving.row());
    }
    return log;
  };
  EXPECT_EQ(bath_words(log_with("[[friction]]\nend_strength_pN = 0.001\n"), coupling), "");
  const std::vector<LogRow> log = log_with("[[friction]]\nstrength_pN_per_nm = 5\nelastic_slip_nm = 0.003\n");
  const std::string words = bath_words(log, coupling);
  const auto at = words.find("at about ");
  ASSERT_NE(at, std::string::npos) << words;
  double held = 0;
  for (std::size_t k = log.size() / 2; k < log.size(); ++k)
    held += log[k]["kinetic_eV"] / static_cast<double>(log.size() - log.size() / 2);
  held /= 3 * 70 * units::boltzmann * 300;
  EXPECT_LT(held, 0.95);
  EXPECT_NEAR(std::stod(words.substr(at + 9)) / 100, held, 0.06);
}

TEST_P(FrictionLaw, SameBitsOnAnyThreadsAndAfterResume) {
  Scene scene = rope(
      "[[friction]]\nstrength_pN_per_nm = 10\nspin_strength_pN_per_nm = 10\nend_strength_pN = 5\nelastic_slip_nm = "
      "0.01\n" +
          GetParam() + "drag_eV_ps_per_nm3 = 0.05\n" + pulled,
      "duration_ps = 20\ntime_step_fs = 20\n", "[start]\ntemperature_K = 300\nmay_cool = true\n");
  const auto begun = [&] { return start(scene, prepare(scene)); };
  omp_set_num_threads(1);
  Simulation whole = begun();
  std::vector<std::string> saved;
  for (int n = 0; n < 400; ++n) {
    if (n % 50 == 0) saved.push_back(whole.serialise());
    whole.step(n % 50 == 49);
  }
  EXPECT_GT(whole.forces().term_energy[0], 1e-4);
  EXPECT_GT(whole.term_accounts()[0].events, 10);
  const std::string end = whole.serialise();
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    Simulation other = begun();
    for (int n = 0; n < 400; ++n) other.step(n % 50 == 49);
    EXPECT_EQ(other.serialise(), end) << threads;
  }
  for (std::size_t at = 0; at < saved.size(); ++at) {
    Simulation resumed = begun();
    resumed.restore(saved[at]);
    EXPECT_EQ(resumed.serialise(), saved[at]);
    for (int n = 50 * static_cast<int>(at); n < 400; ++n) resumed.step(n % 50 == 49);
    EXPECT_EQ(resumed.serialise(), end) << at;
  }
}

TEST(DryFriction, IsCarriedOverWhereElementsAreSplit) {
  Scene coarse =
      rope("[[friction]]\nstrength_pN_per_nm = 20\n" + pulled, "duration_ps = 20\ntime_step_fs = 2\n", cold);
  const Prepared p = prepare(coarse);
  Simulation s = start(coarse, p);
  s.steps(1000);
  Scene finer = scene_of_text(finer_scene_text(coarse, p, "finer"), "finer.toml");
  Prepared q = prepare(finer);
  q.state = halved(p.topology, s.state(), splitting_of(coarse));
  Simulation split = start(finer, q);
  split.set_memory(s.halved_memory(heirs(p.topology, splitting_of(coarse))));
  EXPECT_GT(s.forces().term_energy[0], 0.05);
  EXPECT_NEAR(split.forces().term_energy[0] / s.forces().term_energy[0], 1, 0.1)
      << "the overlap counts in whole elements";
  EXPECT_GT(s.term_accounts()[0].lost, 0);
  EXPECT_EQ(split.term_accounts()[0].lost, s.term_accounts()[0].lost);
}

TEST(DryFriction, BadOnesAreRefused) {
  const auto message = [](const std::string& friction, const std::string& more = "") -> std::string {
    try {
      Scene scene = rope(friction, "duration_ps = 5\n", more);
      prepare(scene);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message("[[friction]]\n"), HasSubstr("friction.strength_pN_per_nm"));
  EXPECT_THAT(message(axial + "types = [0]\n"), HasSubstr("two entries"));
  EXPECT_THAT(message(axial + "types = [0, 1]\n"), HasSubstr("there is no tube type 1"));
  EXPECT_THAT(message(axial + ends),
              HasSubstr("claims all pairs of types, as [[friction]] of line 6; put both into one table"));
  EXPECT_THAT(message(axial + "elastic_slip_nm = 0\n"), HasSubstr("elastic_slip_nm"));
  EXPECT_THAT(message(axial, "[contact]\nlaw = \"none\"\n"), HasSubstr("contact.law"));
  EXPECT_THAT(message(axial, "[periodic]\n"), HasSubstr("periodic.twist_deg_per_nm"));
  EXPECT_THAT(log_header(), HasSubstr(",friction_eV"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
