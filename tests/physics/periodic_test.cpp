// A periodic slice: its forces are those of an endless rope, it keeps energy and momentum, and its torque is that
// of the middle of a long rope.
#include "scene/ends/periodic.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/error.hpp"
#include "observe/loading.hpp"
#include "run/moving_scene.hpp"
#include "scene/finer.hpp"
#include "scene/random.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"
#include "sim/forces/terms/links.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

std::string slice_text(int tubes, int elements, const std::string& more) {
  return fmt::format(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = {}\nlength_nm = {}\n"
      "[contact]\nprecision = \"double\"\n{}",
      tubes, elements * 1.3775870846, more);
}

struct Slice {
  Scene scene;
  Prepared p;
  const PeriodicLoad* load;
  int images, own;  // elements, of a strand

  explicit Slice(const std::string& text)
      : scene(scene_of_text(text, "slice.toml")), p(prepare(scene)), load(p.loads.of<PeriodicLoad>().front()) {
    images = load->images;
    own = strand() - 2 * images;
  }
  int strand() const { return p.topology.elements() / p.topology.strands(); }
  bool is_image(int element) const {
    const int k = element % strand();
    return k < images || k >= images + own;
  }
};

void shake(const Slice& slice, State& s, double by, double speed) {
  Random random(5);
  const auto any = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.position.set(i, Vector3(s.position[i]) + by * any());
    s.orientation.set(i, (Quaternion(Eigen::AngleAxisd(by, any().normalized())) * s.orientation[i]).normalized());
    s.velocity.set(i, speed * any());
    s.angular_velocity.set(i, speed * any());
  }
  slice.load->place(slice.p.topology, s);
}

// 2000 turns per metre lay the surface of a yarn of 20 um at atan(0.04 pi) to its axis, and so the outermost of 19
// tubes, whose axes stand two distances from the middle.
TEST(PeriodicSlice, TurnsPerMetreGiveTheAngleOfAYarn) {
  const std::string turns = "[periodic]\nturns_per_m = [[0, 2000], [50, 1000]]\nyarn_diameter_um = 20\n";
  const Slice slice(slice_text(19, 16, turns));
  const double tangent = 0.04 * units::pi;
  EXPECT_NEAR(slice.load->schedule().value(0), tangent / (2 * slice.p.spacing), 1e-12);
  EXPECT_NEAR(slice.load->schedule().last(), 0.5 * tangent / (2 * slice.p.spacing), 1e-12);
  EXPECT_EQ(slice.p.duration, 50);
  // Wound by as much at the start: elements of a corner lean by that angle.
  double most = 0;
  for (std::size_t i = 0; i < slice.p.state.size(); ++i)
    most = std::max(most, std::acos(axis_of(slice.p.state.orientation[i]).z()));
  EXPECT_NEAR(std::tan(most), tangent, 1e-9);
  EXPECT_THAT(
      slice.scene.drives.front()->words(),
      HasSubstr("twisted to 3.595 degrees at its surface in 50 ps, as a yarn of 20 um is by 1000 turns per metre"));
  const auto message = [](int tubes, const std::string& keys) -> std::string {
    try {
      Slice(slice_text(tubes, 16, "[periodic]\n" + keys));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string yarn = "yarn_diameter_um = 20\n", some = "turns_per_m = [[0, 0], [9, 2000]]\n";
  EXPECT_THAT(message(7, ""),
              HasSubstr("periodic.twist_deg_per_nm: is missing; give twist_deg_per_nm, or turns_per_m"));
  EXPECT_THAT(message(7, some + yarn + "twist_deg_per_nm = [[0, 1]]\n"), HasSubstr("stands beside turns_per_m"));
  EXPECT_THAT(message(7, some), HasSubstr("periodic.yarn_diameter_um: is missing"));
  EXPECT_THAT(message(7, yarn + "turns_per_m = [[0, 20000]]\n"),
              HasSubstr("lays the surface of the yarn at 51.5 degrees"));
  EXPECT_THAT(message(1, some + yarn), HasSubstr("a single tube has no angle at its surface"));
}

// A yarn: tubes of two kinds and several lengths that end inside of the slice, and links.
std::string yarn_text(const std::string& more, const std::string& of_slice = "") {
  return "format = \"ropewalk-scene-1\"\nparameters = [\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]\n"
         "type_shares = [0.5, 0.5]\n[rope]\ntubes = 7\nlength_nm = 60\ntube_length_nm = 17\n"
         "tube_length_deviation_nm = 4\n[contact]\nprecision = \"double\"\n[run]\nduration_ps = 1\n"
         "[periodic]\ntwist_deg_per_nm = [[0, 1.5]]\n" +
         of_slice + more;
}

const char* const linked_and_weak =
    "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 2\n[[links]]\nper_nm = 0.3\nreach_nm = 1\n"
    "stiffness_nN_per_nm = 100\nbreaks_at_nN = 8\n[failure]\nstrain = 0.015\n";

// `periods` of a slice one behind the other, with the images at both ends, and the same links in each.
struct Longer {
  Topology topology;
  State state;
  std::vector<LinkPlace> links;

  Longer(const Slice& slice, int periods, const std::vector<LinkPlace>& links_of_slice) {
    const Topology& of = slice.p.topology;
    const int n = slice.own, g = slice.images, long_strand = periods * n + 2 * g;
    const double turn = slice.load->schedule().value(0) * slice.load->period(),
                 length = slice_length(of, slice.p.state);
    topology.types = of.types;
    topology.groups.strand_begin = {0};
    topology.groups.ends_meet = of.groups.ends_meet;
    state = State(static_cast<std::size_t>(of.strands() * long_strand));
    const auto in_slice = [&](int k) { return k < g + n ? k : g + (k - g) % n; };
    for (int s = 0; s < of.strands(); ++s) {
      const int begin = s * slice.strand();
      int length_of_tube = 0;
      for (int k = 0; k < long_strand; ++k) {
        const int from = begin + in_slice(k), period = k < g + n ? 0 : (k - g) / n;
        if (k > 0 && of.tube_begin[of.tube_of(from)] == from && from != begin) {
          topology.add_tube(length_of_tube, of.tube_type[of.tube_of(from) - 1]);
          length_of_tube = 0;
        }
        ++length_of_tube;
        const auto to = static_cast<std::size_t>(s * long_strand + k), i = static_cast<std::size_t>(from);
        const Quaternion r(Eigen::AngleAxisd(period * turn, Vector3::UnitZ()));
        state.position.set(to, r * Vector3(slice.p.state.position[i]) + Vector3(0, 0, period * length));
        state.orientation.set(to, (r * Quaternion(slice.p.state.orientation[i])).normalized());
      }
      topology.add_tube(length_of_tube, of.tube_type[of.tube_of(begin + in_slice(long_strand - 1))]);
      topology.groups.strand_begin.push_back(topology.tubes());
    }
    // A link may lead into the next period.
    const auto place = [&](int element, int period) {
      return element / slice.strand() * long_strand + element % slice.strand() + period * n;
    };
    for (const LinkPlace& link : links_of_slice)
      for (int period = -1; period <= periods; ++period) {
        LinkPlace copy = link;
        copy.a = place(link.a, period);
        copy.b = place(link.b, period);
        const auto there = [&](int e, int element) {
          return e >= 0 && e / long_strand == element / slice.strand() && e < of.strands() * long_strand;
        };
        if (there(copy.a, link.a) && there(copy.b, link.b)) links.push_back(copy);
      }
  }
};

// Tubes of a yarn, their ends, and their links.
TEST(PeriodicSlice, ForcesOfAYarnAreThoseOfAnEndlessOne) {
  Slice slice(yarn_text(""));
  // A strand that has slid, so that its links lead into the next period.
  for (int e = 0; e < slice.strand(); ++e)
    slice.p.state.position.add(static_cast<std::size_t>(e), Vector3(0, 0, 0.5));
  shake(slice, slice.p.state, 0.01, 0);
  const Topology& of = slice.p.topology;
  ASSERT_GT(of.tubes(), 2 * of.strands());
  LinkLaw law;
  law.stretch = 600;
  law.shear = 300;
  law.density = 2;
  law.reach = 1;
  law.rest = 0.3;
  const std::vector<LinkPlace> links = placed_links(law, of, slice.p.state, {});
  Interaction linked = slice.p.interaction;
  add_term(link_term(law, links, of), linked);
  const Simulation s(of, linked, slice.p.loads, slice.p.state, slice.p.time_step);
  const int periods = 3;
  const Longer longer(slice, periods, links);
  ASSERT_GT(longer.links.size(), 2 * links.size());
  Interaction as_long = interaction_of(slice.scene, slice.p.interaction.law);
  add_end_contacts(slice.scene, longer.topology, as_long);
  add_term(link_term(law, longer.links, longer.topology), as_long);
  const Simulation all(longer.topology, as_long, {}, longer.state, slice.p.time_step);
  const int long_strand = longer.topology.elements() / longer.topology.strands();
  double largest = 0;
  int of_links = 0;
  for (int strand = 0; strand < of.strands(); ++strand)
    for (int k = slice.images; k < slice.images + slice.own; ++k) {
      const auto a = static_cast<std::size_t>(strand * slice.strand() + k),
                 b = static_cast<std::size_t>(strand * long_strand + k + slice.own);
      const double turn = slice.load->schedule().value(0) * slice.load->period();
      const Eigen::Matrix3d r = Eigen::AngleAxisd(turn, Vector3::UnitZ()).toRotationMatrix();
      const Vector3 f = r * s.forces().force[a], h = all.forces().force[b], m = r * s.forces().torque[a],
                    o = all.forces().torque[b];
      largest = std::max(largest, h.norm());
      EXPECT_LT((f - h).norm(), 1e-8) << strand << ' ' << k;
      EXPECT_LT((m - o).norm(), 1e-8) << strand << ' ' << k;
    }
  for (const LinkPlace& link : links) of_links += of.is_image(link.a) || of.is_image(link.b);
  EXPECT_GT(largest, 1);
  EXPECT_GT(of_links, 0);
}

// Three periods and their images, copied out by hand.
TEST(PeriodicSlice, ForcesAreThoseOfAnEndlessRope) {
  const double twist = 1.5;  // deg/nm
  Slice slice(
      slice_text(7, 20, fmt::format("[periodic]\ntwist_deg_per_nm = [[0, {}]]\n[run]\nduration_ps = 1\n", twist)));
  shake(slice, slice.p.state, 0.01, 0);
  const Simulation s = start(slice.scene, slice.p);
  const int n = slice.own, g = slice.images;
  Slice whole(slice_text(7, 3 * n + 2 * g, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n"));
  const double angle = twist * units::degree * slice.load->period();
  for (int t = 0; t < 7; ++t)
    for (int k = 0; k < 3 * n + 2 * g; ++k) {
      const int period = static_cast<int>(std::floor((k - g - n) / static_cast<double>(n)));
      const auto from = static_cast<std::size_t>(slice.p.topology.tube_begin[t] + g + (k - g - n - period * n)),
                 to = static_cast<std::size_t>(whole.p.topology.tube_begin[t] + k);
      const Quaternion r(Eigen::AngleAxisd(period * angle, Vector3::UnitZ()));
      whole.p.state.position.set(
          to, r * Vector3(slice.p.state.position[from]) + Vector3(0, 0, period * slice.load->period()));
      whole.p.state.orientation.set(to, (r * slice.p.state.orientation[from]).normalized());
    }
  const Simulation all(whole.p.topology, whole.p.interaction, {}, whole.p.state, whole.p.time_step);
  double largest = 0;
  for (int t = 0; t < 7; ++t)
    for (int k = 0; k < n; ++k) {
      const auto a = static_cast<std::size_t>(slice.p.topology.tube_begin[t] + g + k),
                 b = static_cast<std::size_t>(whole.p.topology.tube_begin[t] + g + n + k);
      const Vector3 f = s.forces().force[a], h = all.forces().force[b], m = s.forces().torque[a],
                    o = all.forces().torque[b];
      largest = std::max(largest, h.norm());
      EXPECT_LT((f - h).norm(), 1e-9);
      EXPECT_LT((m - o).norm(), 1e-9);
    }
  EXPECT_GT(largest, 1);
}

void expect_conserved(double step_fs, double energy) {
  Slice slice(slice_text(
      7, 20,
      fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 1]]\n[damping]\n"
                  "contact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n[run]\nduration_ps = 1\n"
                  "time_step_fs = {}\n",
                  step_fs)));
  shake(slice, slice.p.state, 0.002, 0.02);
  Simulation s = start(slice.scene, slice.p);
  const auto momenta = [&] {
    Vector3 sum = Vector3::Zero();  // p_z, L_z, and the sum of |p_z| for the scale
    const State& state = s.state();
    for (int e = 0; e < slice.p.topology.elements(); ++e) {
      if (slice.is_image(e)) continue;
      const auto i = static_cast<std::size_t>(e);
      const TubeType& type = slice.p.topology.type_of_element(e);
      const Vector3 x = state.position[i], v = state.velocity[i], w = state.angular_velocity[i];
      sum += Vector3(type.mass * v.z(), type.mass * x.cross(v).z() + type.inertia * w.z(),
                     type.mass * std::fabs(v.z()));
    }
    return sum;
  };
  s.steps(1, true);
  const Vector3 before = momenta();
  const double first = s.total_energy() - s.work(), kinetic = kinetic_energy(slice.p.topology, s.state());
  s.steps(std::lround(20e3 / step_fs), true);
  const Vector3 after = momenta();
  EXPECT_NEAR(after[0], before[0], 1e-9 * before[2]);
  EXPECT_NEAR(after[1], before[1], 1e-8 * before[2]);
  EXPECT_NEAR(s.total_energy() - s.work(), first, energy * kinetic);
  // Images are where they belong, without drift.
  State placed = s.state();
  slice.load->place(slice.p.topology, placed);
  for (std::size_t i = 0; i < placed.size(); ++i)
    EXPECT_LT((Vector3(placed.position[i]) - Vector3(s.state().position[i])).norm(), 1e-10);
}

// The error of the energy goes as the square of the step.
TEST(PeriodicSlice, KeepsEnergyAndMomentum) {
  expect_conserved(8, 8e-3);
  expect_conserved(2, 5e-4);
}

// Its length free, then drawn out until links and tubes break.
TEST(PeriodicSlice, AYarnKeepsMomentumAndEnergyWhileItBreaks) {
  Slice slice(yarn_text(linked_and_weak, "tension_nN = [[0, 0]]\nstrain = [[20, 0], [40, 0.15]]\n"));
  Simulation s = start(slice.scene, slice.p);
  const auto momentum = [&] {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();  // p_z, and the sum of |p_z|
    for (int e = 0; e < slice.p.topology.elements(); ++e) {
      if (slice.is_image(e)) continue;
      const double p = slice.p.topology.type_of_element(e).mass * s.state().velocity.z[e];
      sum += Eigen::Vector2d(p, std::fabs(p));
    }
    return sum;
  };
  const double first = s.total_energy();
  const auto balance = [&] { return s.total_energy() - first - s.account().supplied(); };
  const auto go_to = [&](double time) { s.steps(std::lround((time - s.state().time) / slice.p.time_step), true); };
  go_to(10);
  const double settled = balance();
  go_to(38);
  const Eigen::Vector2d p = momentum();
  EXPECT_LT(std::fabs(p[0]), 1e-9 * p[1]);
  EXPECT_NEAR(balance(), settled, 0.01 * (s.dissipated() + s.work()));
  long links = 0, bonds = 0;
  for (const TermEvent& e : s.term_events()) {
    links += e.what == std::string("link broke");
    bonds += e.what == std::string("tube broke");
  }
  EXPECT_GT(links, 5);
  EXPECT_GT(bonds, 0);
  // Images have broken where their originals have.
  const Topology now = s.tubes_now();
  const auto begins = [&](int e) { return now.tube_begin[static_cast<std::size_t>(now.tube_of(e))] == e; };
  for (int e = 0; e < now.elements(); ++e)
    EXPECT_TRUE(e % slice.strand() == 0 || begins(e) == begins(now.original_of(e))) << e;
  EXPECT_EQ(now.groups.images, slice.images);
}

// Thin tubes in line with wide ones are pressed as thin ones: their neighbours come nearer.
TEST(PeriodicSlice, PressureInAYarnIsThatOfItsTubes) {
  Slice slice(yarn_text("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 10\n"));
  const Observer observer = make_observer(slice.scene, slice.p);
  Simulation s = start(slice.scene, slice.p);
  s.steps(std::lround(40 / slice.p.time_step), true);
  const LogRow row = log_row(observer, slice.scene, slice.p.topology, s.state(), EnergyAccount());
  EXPECT_LT(std::fabs(row["core_pressure_GPa"]), 3);
  for (const double pressure : tube_pressures(slice.p.topology, s.state(), observer.loading))
    EXPECT_LT(std::fabs(pressure / units::nN_nm), 10);
}

// Friction of the images is that of their originals, while strands slide past one another by several elements.
TEST(PeriodicSlice, FrictionKeepsTheMomentum) {
  for (const char* slip : {"dry", "corrugation"}) {
    Slice slice(
        yarn_text(fmt::format("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n[[friction]]\n"
                              "strength_pN_per_nm = 30\nspin_strength_pN_per_nm = 10\nend_strength_pN = 20\n"
                              "drag_eV_ps_per_nm3 = 0.1\nslip = \"{}\"\n",
                              slip)));
    for (int e = 0; e < slice.strand(); ++e)
      slice.p.state.velocity.set(static_cast<std::size_t>(e), Vector3(0, 0, 0.1));
    slice.load->place(slice.p.topology, slice.p.state);
    Simulation s = start(slice.scene, slice.p);
    const auto momentum = [&](int strands) {
      double sum = 0;
      for (int e = 0; e < strands * slice.strand(); ++e)
        if (!slice.is_image(e)) sum += slice.p.topology.type_of_element(e).mass * s.state().velocity.z[e];
      return sum;
    };
    const int all = slice.p.topology.strands();
    const double first = momentum(1), whole = momentum(all);
    ASSERT_DOUBLE_EQ(first, whole);
    s.steps(std::lround(30 / slice.p.time_step), true);
    EXPECT_LT(momentum(1), 0.3 * first) << slip;
    EXPECT_NEAR(momentum(all), whole, 1e-9 * whole);
  }
}

// However many images there are.
TEST(PeriodicSlice, ASlipIsCountedOnce) {
  const auto slips = [](int images) {
    constexpr int own = 16;
    Slice slice(
        slice_text(7, own + 2 * images,
                   fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 0]]\nimages = {}\n[damping]\n"
                               "contact_viscosity_eV_ps_per_nm2 = 0\n[[friction]]\nstrength_pN_per_nm = 30\n"
                               "spin_strength_pN_per_nm = 10\nend_strength_pN = 20\n"
                               "drag_eV_ps_per_nm3 = 0.1\n[run]\nduration_ps = 1\n",
                               images)));
    EXPECT_EQ(slice.own, own);
    for (int e = 0; e < slice.strand(); ++e)
      slice.p.state.velocity.set(static_cast<std::size_t>(e), Vector3(0, 0, 0.1));
    slice.load->place(slice.p.topology, slice.p.state);
    Simulation s = start(slice.scene, slice.p);
    s.steps(std::lround(10 / slice.p.time_step), true);
    double sum = 0;
    for (const TermAccount& a : s.term_accounts()) sum += a.events;
    return sum;
  };
  const double few = slips(3), many = slips(9);
  EXPECT_GT(few, 50);
  EXPECT_NEAR(many, few, 0.02 * few);
}

// What has broken is known to a run that goes on, images included.
TEST(PeriodicSlice, AYarnGoesOnFromACheckpoint) {
  Slice slice(yarn_text(linked_and_weak, "tension_nN = [[0, 0]]\nstrain = [[5, 0], [20, 0.08]]\n"));
  Simulation one = start(slice.scene, slice.p), two = start(slice.scene, slice.p);
  const long half = std::lround(14 / slice.p.time_step);
  one.steps(half);
  const std::vector<TermEvent> events = one.term_events();
  ASSERT_TRUE(std::any_of(events.begin(), events.end(),
                          [](const TermEvent& e) { return e.what != std::string("link formed"); }));
  two.restore(one.serialise());
  one.steps(half / 4);
  two.steps(half / 4);
  EXPECT_EQ(one.serialise(), two.serialise());
}

// Seven tubes under a tension, then drawn out by a strain: Hooke's law, by both.
TEST(PeriodicSlice, StrainFollowsTensionAndTensionStrain) {
  const double pull = 20;  // nN
  Slice slice(slice_text(7, 20,
                         fmt::format("[bond]\nlaw = \"harmonic\"\n[periodic]\ntwist_deg_per_nm = [[0, 0]]\n"
                                     "tension_nN = [[0, 0], [160, 0], [200, {}]]\n"
                                     "strain = [[280, 0], [320, 0.004], [370, 0.004]]\n"
                                     "[damping]\nbond_damping_per_ps = 2\n",
                                     pull)));
  Simulation s = start(slice.scene, slice.p);
  const auto go_to = [&](double time) { s.steps(std::lround((time - s.state().time) / slice.p.time_step), true); };
  const auto tension_after = [&](double time) {
    go_to(time);
    s.read_gauges();
    go_to(time + 10);
    return s.read_gauges()[upper_end].force.z() / units::nN_nm;
  };
  const double stiff = 7 * slice.scene.parameters().bond.stretch / units::nN_nm;  // nN
  const auto length = [&] { return slice_length(slice.p.topology, s.state()); };
  const double period = slice.load->period();
  // At rest the contact draws it together a little; its length swings for some 100 ps.
  EXPECT_NEAR(tension_after(148), 0, 0.01 * pull);
  const double free = length();
  EXPECT_NEAR(tension_after(269.5), pull, 1e-3 * pull);
  const double pulled = length();
  EXPECT_NEAR((pulled - free) / period, pull / stiff, 0.03 * pull / stiff);
  EXPECT_NEAR(tension_after(355), pull + 0.004 * stiff, 0.01 * (pull + 0.004 * stiff));
  EXPECT_NEAR(length(), pulled + 0.004 * period, 3e-4);
}

// A slice of seven shaken tubes whose length is free under a tension.
struct Free {
  Slice slice;
  double tension = 5 * units::nN_nm;

  Free(int images, const std::string& more)
      : slice(slice_text(7, 12 + 2 * images,
                         fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 1]]\nimages = {}\ntension_nN = [[0, 5]]\n"
                                     "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n{}",
                                     images, more))) {
    EXPECT_EQ(slice.own, 12);
  }
  double rate(const State& s) const {
    return s.velocity.z[static_cast<std::size_t>(slice.own)] - s.velocity.z[0];  // element 0 is its image
  }
  // eV, of a period, less the work of the tension.
  double potential(const State& s) const {
    const Simulation still(slice.p.topology, slice.p.interaction, {}, s, slice.p.time_step);
    return energies_of_period(still)->potential() - tension * slice_length(slice.p.topology, s);
  }
  double kinetic(const State& s) const {
    double sum = 0.5 * slice.p.topology.groups.period_inertia * std::pow(rate(s), 2);
    for (int e = 0; e < slice.p.topology.elements(); ++e) {
      const TubeType& type = slice.p.topology.type_of_element(e);
      const auto i = static_cast<std::size_t>(e);
      if (!slice.is_image(e))
        sum += 0.5 * (type.mass * s.velocity[i].squaredNorm() + type.inertia * s.angular_velocity[i].squaredNorm());
    }
    return sum;
  }
};

// However many images there are.
TEST(PeriodicSlice, TheForceOnItsLengthIsTheGradientOfTheEnergy) {
  for (const int images : {3, 9, 12}) {
    Free free(images, "[run]\nduration_ps = 1\ntime_step_fs = 0.1\n");
    Slice& slice = free.slice;
    shake(slice, slice.p.state, 0.01, 0);
    const double h = 1e-5;
    const auto lengthened = [&](double by) {
      State s = slice.p.state;
      for (int e = 0; e < slice.p.topology.elements(); ++e) {
        const int k = e % slice.strand();
        if (slice.is_image(e)) s.position.z[static_cast<std::size_t>(e)] += k < images ? -by : by;
      }
      return free.potential(s);
    };
    const double force = -(lengthened(h) - lengthened(-h)) / (2 * h);
    ASSERT_GT(std::fabs(force), 1);
    Simulation s = start(slice.scene, slice.p);
    s.steps(1, true);
    EXPECT_NEAR(free.rate(s.state()) / slice.p.time_step * slice.p.topology.groups.period_inertia, force,
                1e-3 * std::fabs(force));
  }
}

TEST(PeriodicSlice, KeepsTheEnergyOfAFreeLength) {
  Free free(9, "[run]\nduration_ps = 1\ntime_step_fs = 2\n");
  shake(free.slice, free.slice.p.state, 0.002, 0.02);
  Simulation s = start(free.slice.scene, free.slice.p);
  const auto total = [&] { return free.kinetic(s.state()) + free.potential(s.state()); };
  s.steps(1, true);
  const double first = total(), kinetic = free.kinetic(s.state());
  double apart = 0;
  for (int k = 0; k < 20; ++k) {
    s.steps(100, true);
    apart = std::max(apart, std::fabs(total() - first));
  }
  EXPECT_LT(apart, 0.01 * kinetic);
}

// A bath gives a free length kT as well, apart from the elements.
TEST(PeriodicSlice, ABathHoldsItsLength) {
  const double kT = units::boltzmann * 300;
  for (const int images : {3, 9}) {
    const Free free(images, "[run]\nduration_ps = 1\n[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 1\n");
    State s = free.slice.p.state;
    const std::shared_ptr<const Thermostat> bath = free.slice.p.stepping.thermostat;
    const auto below = static_cast<std::size_t>(free.slice.own), above = static_cast<std::size_t>(images);
    double square = 0, both = 0;
    constexpr int draws = 4000;
    std::vector<double> variables = bath->initial_variables();
    for (int k = 0; k < draws; ++k, ++s.step) {
      bath->apply(free.slice.p.topology, 100, s, variables);
      square += std::pow(free.rate(s), 2) / draws;
      both += free.rate(s) * (s.velocity.z[above] - s.velocity.z[below]) / draws;
    }
    const double expected = kT / free.slice.p.topology.groups.period_inertia,
                 of_one = kT / free.slice.p.topology.types[0].mass;
    EXPECT_NEAR(square, expected, 0.1 * expected);
    EXPECT_NEAR(both, 0, 4 * std::sqrt(2 * expected * of_one / draws));
  }
}

// Elements of a shortened slice lie nearer to each other, and more of them are within reach.
TEST(PeriodicSlice, HasTheImagesThatItsLeastLengthNeeds) {
  const auto text = [](int elements, const std::string& more) {
    return slice_text(7, elements,
                      "[periodic]\ntwist_deg_per_nm = [[0, 0]]\nstrain = [[0, 0], [8, -0.4]]\n" + more);
  };
  const Slice free(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n"));
  const Slice slice(text(20, ""));
  EXPECT_GT(slice.images, free.images);
  State shortened = slice.p.state;
  for (double& z : shortened.position.z) z *= 0.6;
  EXPECT_NO_THROW(slice.load->constrain(slice.p.topology, 8, 0, shortened));
  const auto said = [](const std::string& of) {
    try {
      const Slice refused(of);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(said(text(20, fmt::format("images = {}\n", free.images))), HasSubstr("at its least strain, -0.4"));
  EXPECT_THAT(said(text(10, "")), HasSubstr("make the tubes at least"));
  EXPECT_THAT(said(slice_text(7, 20,
                              "[periodic]\ntwist_deg_per_nm = [[0, 0]]\ntension_nN = [[0, -6000]]\n[run]\n"
                              "duration_ps = 1\n")),
              HasSubstr("at its least strain, -0.5"));
}

TEST(PeriodicSlice, RefusesTubesThatMeetTheirImages) {
  try {
    const Slice slice(yarn_text("", ""));
    Scene scene =
        scene_of_text(std::string(slice.scene.text).replace(slice.scene.text.find("= 17"), 4, "= 55"), "yarn.toml");
    prepare(scene);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("a tube would go on beside its own image"));
  }
}

// Strands that slide past their images end the run.
TEST(PeriodicSlice, SaysWhereImagesReachNoFarther) {
  Slice slice(
      yarn_text("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n[[load]]\nkind = \"force\"\nelements = "
                "[-1]\ntubes = [1]\nforce_nN = [0, 0, 3]\n"));
  Simulation s = start(slice.scene, slice.p);
  try {
    s.steps(std::lround(100 / slice.p.time_step));
    FAIL() << s.state().time;
  } catch (const NumericalError& e) {
    EXPECT_THAT(e.what(), HasSubstr("take more images: periodic.images = "));
    EXPECT_EQ(e.shorter_steps(), NumericalError::ShorterSteps::cannot_help);
  }
}

// Images are led to where they will be while the twist grows.
TEST(PeriodicSlice, ImagesFollowATwistThatGrows) {
  Slice slice(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0], [20, 2], [30, 2]]\n"));
  shake(slice, slice.p.state, 0.002, 0.02);
  Simulation s = start(slice.scene, slice.p);
  s.steps(std::lround(22 / slice.p.time_step), true);
  State placed = s.state();
  slice.load->place(slice.p.topology, placed);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_LT((Vector3(placed.position[i]) - Vector3(s.state().position[i])).norm(), 1e-10);
    EXPECT_LT(placed.orientation[i].angularDistance(s.state().orientation[i]), 1e-9);
  }
}

// Stretched tubes against Hooke's law: neither the images nor the ends of the slice count, however many there are.
TEST(PeriodicSlice, EnergyPerMassIsThatOfOnePeriod) {
  const double strain = 0.004;
  const auto row_with = [&](int images, const std::string& more) {
    Slice slice(
        slice_text(7, 12 + 2 * images,
                   fmt::format("[bond]\nlaw = \"harmonic\"\n[periodic]\ntwist_deg_per_nm = [[0, 0]]\nimages = "
                               "{}\n[run]\nduration_ps = 1\n{}",
                               images, more)));
    EXPECT_EQ(slice.own, 12);
    const Observer observer = make_observer(slice.scene, slice.p);
    const Simulation first = start(slice.scene, slice.p);
    State stretched = slice.p.state;
    for (double& z : stretched.position.z) z *= 1 + strain;
    const Simulation s(slice.p.topology, slice.p.interaction, {}, stretched, slice.p.time_step);
    EnergyAccount account = account_of(s, first.forces().energy, 0);
    account.period = EnergyAccount::Period{*energies_of_period(s), *energies_of_period(first)};
    account.ends[upper_end].force.z() = 3, account.ends[lower_end].force.z() = -3;
    return log_row(observer, slice.scene, slice.p.topology, stretched, account);
  };
  const LogRow few = row_with(4, ""), many = row_with(9, ""), heavy = row_with(4, "mass_scale = 4\n");
  const ParameterSet set =
      Slice(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n"))
          .scene.parameters();
  const double mass_per_length = set.atoms_per_length * units::carbon_mass;
  for (const LogRow& row : {few, many, heavy}) {
    EXPECT_NEAR(row["stored_stretch_MJ_per_kg"], 0.5 * set.bond.stretch * strain * strain / mass_per_length,
                1e-9 * row["stored_stretch_MJ_per_kg"]);
    EXPECT_NEAR(row["specific_stress_N_per_tex"], 3 / (7 * mass_per_length), 1e-12);
    EXPECT_NEAR(row["stored_contact_MJ_per_kg"], few["stored_contact_MJ_per_kg"],
                1e-9 * few["stored_contact_MJ_per_kg"]);
    EXPECT_NEAR(row["cohesion_lost"], few["cohesion_lost"], 1e-9 * few["cohesion_lost"]);
  }
  EXPECT_GT(few["stored_contact_MJ_per_kg"], 1e-6);
}

// GJ tau of a single tube.
TEST(PeriodicSlice, ReadsTheTorqueOfATube) {
  Slice slice(
      slice_text(1, 40,
                 "law = \"none\"\n[bond]\nlaw = \"harmonic\"\n[periodic]\ntwist_deg_per_nm = [[0, 0], [50, 1], "
                 "[200, 1]]\n[damping]\nbond_damping_per_ps = 2\n"));
  Simulation s = start(slice.scene, slice.p);
  s.steps(std::lround(190 / slice.p.time_step), true);
  s.read_gauges();
  s.steps(std::lround(10 / slice.p.time_step), true);
  const EndReadings ends = s.read_gauges();
  const double expected = slice.scene.parameters().bond.twist * 1 * units::degree;
  EXPECT_NEAR(ends[upper_end].torque.z(), expected, 1e-4 * expected);
  EXPECT_NEAR(ends[lower_end].torque.z(), -expected, 1e-4 * expected);
}

// 19 tubes against the middle third of a rope five times as long, between discs in which tubes tilt.
TEST(PeriodicSlice, IsTheMiddleOfALongRope) {
  const double twist = 1.5, ramp = 60, hold = 200, read = 40;
  const auto ends_of_run = [&](const std::string& text) {
    Scene scene = scene_of_text(text, "rope.toml");
    const Prepared p = prepare(scene);
    const Observer observer = make_observer(scene, p);
    Simulation s = start(scene, p);
    s.steps(std::lround((ramp + hold - read) / p.time_step), true);
    s.read_gauges();
    s.steps(std::lround(read / p.time_step), true);
    EnergyAccount account;
    account.ends = s.read_gauges();
    account.potential = s.forces().energy;
    return log_row(observer, scene, p.topology, s.state(), account);
  };
  const LogRow slice =
      ends_of_run(slice_text(19, 16,
                             fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 0], [{}, {}], [{}, {}]]\n", ramp,
                                         twist, ramp + hold, twist)));
  const int elements = 60;
  const double turned = twist * (elements - 1) * 1.3775870846;
  const LogRow rope = ends_of_run(slice_text(
      19, elements,
      fmt::format(
          "[[grip]]\nend = \"lower\"\ntilt_free = true\n[[grip]]\nend = \"upper\"\ntilt_free = true\nabout_z = {{ "
          "rotation_deg = [[0, 0], [{}, {}], [{}, {}]] }}\n",
          ramp, turned, ramp + hold, turned)));
  // The long rope still swings: its two ends read alike in the mean.
  const auto torque = [](const LogRow& r) { return 0.5 * (r["torque_upper_nN_nm"] + r["torque_lower_nN_nm"]); };
  EXPECT_NEAR(torque(slice), torque(rope), 0.01 * torque(rope));
  for (const char* same : {"beta_deg", "tension_upper_nN"})
    EXPECT_NEAR(slice[same], rope[same], 0.01 * std::fabs(rope[same])) << same;
  EXPECT_EQ(slice["Q"], rope["Q"]);
  EXPECT_NEAR(slice["torque_lower_nN_nm"], slice["torque_upper_nN_nm"], 1e-4 * torque(slice));
  // Per bond, since a slice has more ends for its length.
  EXPECT_NEAR(slice["twist_eV"] / 15, rope["twist_eV"] / (elements - 1), 5e-3 * slice["twist_eV"] / 15);
}

// The tubes of a slice are endless. Bonds and watched limits take the collapse of an endless tube, whatever the
// length of the slice.
TEST(PeriodicSlice, CollapsesAsAnEndlessTubeDoes) {
  for (const int elements : {9, 16, 44}) {  // 12, 22 and 60 nm
    const Slice slice(
        slice_text(7, elements, "[periodic]\ntwist_deg_per_nm = [[0, 0], [9, 4]]\n[run]\nduration_ps = 1\n"));
    const ParameterSet& set = slice.scene.parameters();
    const double endless = set.validity.collapse_at(set.radius, 0);
    ASSERT_LT(endless, 0.95 * set.validity.collapse_at(set.radius, 60));
    EXPECT_EQ(slice.p.topology.types[0].bond.anharmonic.max_shear, endless);
    EXPECT_EQ(watched_of(slice.scene, slice.p.topology, slice.p.loads, slice.p.interaction.law.get())
                  .limits.at(0)
                  .wall_twist,
              endless);
    EXPECT_EQ(validities(slice.scene, slice.p.topology).at(0).twist_collapse, endless);
  }
}

TEST(PeriodicSlice, IsNotRefined) {
  const Slice slice(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 1]]\n[run]\nduration_ps = 1\n"));
  EXPECT_THAT(why_not_finer(slice.scene, slice.p.topology), HasSubstr("counts its images in elements"));
}

TEST(PeriodicSlice, RefusesWhatHasNoMeaning) {
  const auto said = [](const std::string& text) {
    try {
      Slice slice(text);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(said(slice_text(7, 5, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nduration_ps = 1\n")),
              HasSubstr("make the tubes at least"));
  EXPECT_THAT(
      said(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\nimages = 1\n[run]\nduration_ps = 1\n")),
      HasSubstr("the contact reaches"));
  EXPECT_THAT(said(slice_text(7, 20,
                              "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[twist]\nmoment_nN_nm = "
                              "5\nrate_nN_nm_per_ps = 1\nhold_ps = 1\n")),
              HasSubstr("does not go with [twist]"));
  EXPECT_THAT(said(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\nstrain = [[0, 0.1], [9, 0.2]]\n")),
              HasSubstr("begin with 0"));
  const auto pulled = [&](const char* elements) {
    return said(
        slice_text(7, 20,
                   fmt::format("[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[[load]]\nkind = \"force\"\nelements "
                               "= {}\nforce_nN = [0, 0, 1]\n[run]\nduration_ps = 1\n",
                               elements)));
  };
  EXPECT_THAT(pulled("\"ends\""),
              HasSubstr("element 0 of tube 0 is an image of the slice, and a load on it has no effect"));
  EXPECT_EQ(pulled("[10]"), "");
  EXPECT_EQ(pulled("\"all\""), "");
  EXPECT_THAT(said(slice_text(7, 20, "[periodic]\ntwist_deg_per_nm = [[0, 0]]\n[run]\nmode = \"relax\"\n")),
              HasSubstr("does not go with run.solver = \"fire\""));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
