// [[links]]: sim/forces/terms/links.hpp and its table, scene/interactions/links.cpp.
#include "sim/forces/terms/links.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "io/log.hpp"
#include "model/error.hpp"
#include "model/units.hpp"
#include "run/events_file.hpp"
#include "scene/finer.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/refine.hpp"
#include "terms_alone.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

Scene rope(const std::string& links, const std::string& run = "duration_ps = 5\n", const std::string& more = "",
           const std::string& of_rope = "") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\n"
      "length_nm = 13.8\n" +
          of_rope + more + links + "[run]\n" + run,
      "links.toml");
}
// The same tubes, as two types.
Scene rope_of_two(const std::string& types, const std::string& links, const std::string& run = "duration_ps = 5\n",
                  const std::string& more = "") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = [\"cnt-10-10-tersoff\", \"cnt-10-10-tersoff\"]\ntube_types = [" +
          types + "]\n[rope]\ntubes = 7\nlength_nm = 13.8\n" + more + links + "[run]\n" + run,
      "links.toml");
}
const std::string stiff = "[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 100\n",
                  lopsided = "[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 100\nshear_stiffness_nN_per_nm = 30\n",
                  breaking = "[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 40\nbreaks_at_nN = 2\n",
                  pulled =
                      "[[grip]]\nend = \"lower\"\n[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\n"
                      "force_nN = [0, 0, 15]\n";

TEST(Links, ForcesAndTorquesAreTheGradientAndKeepMomentum) {
  for (const std::string& table : {stiff, lopsided, lopsided + "rest_nm = 0.4\n"}) {
    TermsAlone links(rope(table));
    const State s = links.shaken(0.05, 3);
    expect_gradient(links, s, every_third(s));
    const NetForce net = net_force(s, links.at(s));
    EXPECT_LT(net.force.norm(), 1e-9);
    EXPECT_LT(net.torque.norm(), 1e-8);
  }
}

TEST(Links, PullAsOneSpringInStretchAndOneInShear) {
  const std::string table =
      "[[links]]\nbetween = [0, 5, 1, 5]\nstiffness_nN_per_nm = 100\nshear_stiffness_nN_per_nm = 30\n";
  TermsAlone links(rope(table));
  EXPECT_EQ(links.energy(links.p.state), 0) << "at rest as they form";
  const int e = links.p.topology.tube_begin[1] + 5;
  const auto i = static_cast<std::size_t>(e);
  const Vector3 out = links.p.state.position[i] - links.p.state.position[5];
  const double k = units::nN_nm;
  for (const auto& [along, stiffness] :
       {std::pair(Vector3(out.normalized()), 100 * k), std::pair(Vector3(Vector3::UnitZ()), 30 * k),
        std::pair(Vector3(Vector3::UnitZ().cross(out.normalized())), 30 * k)}) {
    State s = links.p.state;
    s.position.add(i, 0.01 * along);
    EXPECT_NEAR(links.energy(s), 0.5 * stiffness * 1e-4, 1e-9 * stiffness);
    EXPECT_LT((links.at(s).force[i] + 0.01 * stiffness * along).norm(), 1e-8);
  }
  TermsAlone pressed(rope(table + "rest_nm = 0.4\n"));
  const TubeType& tube = pressed.p.topology.types[0];
  const double stretched = out.norm() - 2 * tube.radius - 0.4;
  EXPECT_NEAR(pressed.energy(pressed.p.state), 50 * k * stretched * stretched, 1e-9);
}

TEST(Links, FeelNoMotionOfTheRopeAsAWhole) {
  TermsAlone links(rope(lopsided + "rest_nm = 0.4\n"));
  const State s = links.shaken(0.05, 5);
  State turned = s;
  const Quaternion q(Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()));
  for (std::size_t i = 0; i < s.size(); ++i) {
    turned.position.set(i, q * s.position[i] + Vector3(3, -2, 1));
    turned.orientation.set(i, q * s.orientation[i]);
  }
  EXPECT_NEAR(links.energy(turned), links.energy(s), 1e-9 * links.energy(s));
}

// Seven tubes have twelve contacts of the length of the rope.
TEST(Links, AreAsManyAsTheLengthOfContactHas) {
  double sum = 0;
  const int seeds = 20;
  double contact = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    Scene scene = rope("[[links]]\nper_nm = 1.5\nstiffness_nN_per_nm = 1\nseed = " + std::to_string(seed) + "\n");
    const Prepared p = prepare(scene);
    contact = 12 * p.topology.length_of(0) * p.topology.types[0].element_length;
    sum += static_cast<double>(p.interaction.terms.at(0)->begun_at_start());
  }
  const double expected = 1.5 * contact * seeds;
  EXPECT_NEAR(sum, expected, 4 * std::sqrt(expected));
  Scene ends = rope("[[links]]\nat_ends = 2\nstiffness_nN_per_nm = 1\n");
  EXPECT_EQ(prepare(ends).interaction.terms.at(0)->begun_at_start(), 28) << "two at each of fourteen ends";
}

TEST(Links, BreakAtTheirStrengthAndTheAccountStaysClosed) {
  Scene scene =
      rope(breaking, "duration_ps = 20\ntime_step_fs = 4\n", pulled + "[contact]\nprecision = \"double\"\n");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double total = s.total_energy();
  const TermAccount first = s.term_accounts().at(0);
  EXPECT_GT(first.begun, 20) << "from the first row on";
  for (int n = 0; n < 4000; ++n) {
    s.step();
    ASSERT_NEAR(s.total_energy() - s.account().supplied(), total, 0.01 * (1 + s.work())) << n;
  }
  const TermAccount account = s.term_accounts().at(0);
  EXPECT_GT(account.events, 3);
  EXPECT_EQ(account.begun, first.begun) << "none forms";
  // Each has lost k/2 (F/k)^2 or a little more: it breaks in the first step beyond.
  const double each = 0.5 * 4 / 40 * units::nN_nm;
  EXPECT_GT(account.lost, each * account.events);
  EXPECT_LT(account.lost, 1.3 * each * account.events);
  const std::vector<TermEvent> events = s.term_events();
  ASSERT_EQ(static_cast<double>(events.size()), account.begun + account.events);
  for (std::size_t k = 1; k < events.size(); ++k) EXPECT_GE(events[k].time, events[k - 1].time);
  EXPECT_EQ(events.front().what, "link formed");
  EXPECT_EQ(events.back().what, "link broke");
  EXPECT_GT(events.back().time, 0);
  const std::string csv = events_csv(p.topology, events);
  EXPECT_THAT(csv, HasSubstr(",link broke,"));
  // The file tells which links hold, at any time.
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "links-events.csv";
  std::ofstream(file) << csv;
  const StoredEvents stored(file.string(), p.topology);
  std::filesystem::remove(file);
  EXPECT_EQ(static_cast<double>(stored.links_at(0).size()), first.begun);
  EXPECT_EQ(static_cast<double>(stored.links_at(s.state().time).size()), account.begun - account.events);
  const double middle = 0.5 * s.state().time;
  const auto broken = std::count_if(events.begin(), events.end(), [&](const TermEvent& e) {
    return e.what == std::string("link broke") && e.time <= middle;
  });
  EXPECT_EQ(static_cast<double>(stored.links_at(middle).size()), first.begun - static_cast<double>(broken));
  EXPECT_FALSE(stored.any_breaks());
  // Links that broke are events. The memory has only those that hold: however many come and go, it stays small.
  constexpr double head = 3 + 5, of_account = 3 + 4, link = 3 + 17;
  EXPECT_EQ(static_cast<double>(s.memory().size()), head + of_account + link * (account.begun - account.events));
  s.forget_events();
  EXPECT_TRUE(s.term_events().empty());
}

// A link whose walls are too near pushes, and holds.
TEST(Links, DoNotBreakWhereTheyPush) {
  const auto broken = [](const std::string& rest) {
    Scene scene = rope("[[links]]\nbetween = [0, 5, 1, 5]\nrest_nm = " + rest +
                       "\nstiffness_nN_per_nm = 100\nbreaks_at_nN = 2\n");
    const Prepared p = prepare(scene);
    Simulation s = start(scene, p);
    s.steps(3);
    return s.term_accounts().at(0).events;
  };
  EXPECT_EQ(broken("0.4"), 0) << "pushes with 6 nN";
  EXPECT_EQ(broken("0.28"), 1) << "pulls with 6 nN";
}

TEST(Links, OfSeveralTablesStandInPlacesOfTheirOwn) {
  const std::string both = stiff + "types = [0, 0]\n" + stiff + "types = [0, 1]\n";
  Scene scene = rope_of_two("0, 1, 0, 1, 0, 1, 0", both);
  const Prepared p = prepare(scene);
  const Simulation s = start(scene, p);
  std::set<std::pair<double, double>> places;
  for (const TermEvent& e : s.term_events()) places.emplace(e.place.x(), e.place.z());
  EXPECT_EQ(places.size(), s.term_events().size());
  Scene other = rope_of_two("0, 1, 0, 1, 0, 1, 0", both, "duration_ps = 5\n", "[start]\nseed = 2\n");
  const Prepared q = prepare(other);
  EXPECT_NE(start(other, q).term_events().front().place.z(), s.term_events().front().place.z()) << "start.seed";
}

TEST(Links, BreakAtAnEnergyToo) {
  Scene scene =
      rope("[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 40\nbreaks_at_eV = 0.2\n", "duration_ps = 10\n", pulled);
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  s.steps(1500);
  const TermAccount account = s.term_accounts().at(0);
  EXPECT_GT(account.events, 3);
  EXPECT_GT(account.lost, 0.2 * account.events);
}

const std::string
    forming =
        "[[links]]\nforming_per_nm_ps = 0.1\nmost_per_nm = 1\nstiffness_nN_per_nm = 40\nbreaks_at_nN = "
        "2\n",
    warm = "[start]\ntemperature_K = 300\nmay_cool = true\n";

TEST(Links, FormWhereTubesTouchUpToTheirNumber) {
  Scene scene = rope(forming, "duration_ps = 60\n", warm);
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  EXPECT_EQ(s.term_accounts().at(0).begun, 0);
  double before = 0;
  for (const double until : {5.0, 60.0}) {
    while (s.state().time < until) s.step();
    const double begun = s.term_accounts().at(0).begun;
    EXPECT_GT(begun, before);
    before = begun;
  }
  std::vector<int> count(s.state().size(), 0);
  for (const TermEvent& e : s.term_events())
    for (const int element : {e.a, e.b})
      count[static_cast<std::size_t>(element)] += std::string(e.what) == "link formed" ? 1 : -1;
  // One link for each nm is 1.38 links on an element in the mean.
  EXPECT_LE(*std::max_element(count.begin(), count.end()), 2);
  EXPECT_EQ(*std::max_element(count.begin(), count.end()), 2);
}

TEST(Links, ArePlacedAtALaterTimeToo) {
  Scene scene = rope("[[links]]\nper_nm = 0.5\nplaced_at_ps = 2\nstiffness_nN_per_nm = 40\n", "duration_ps = 5\n");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  while (s.state().time < 4) {
    s.step();
    EXPECT_EQ(s.term_accounts().at(0).begun > 0, s.state().time >= 2) << s.state().time;
  }
  const double expected = 0.5 * 12 * p.topology.length_of(0) * p.topology.types[0].element_length;
  EXPECT_NEAR(s.term_accounts().at(0).begun, expected, 4 * std::sqrt(expected));
  EXPECT_GE(s.term_events().front().time, 2);
}

// The first tube stands in the middle: half of the twelve contacts are its own.
TEST(Links, OfTwoTablesTheOneThatNamesAPairHasItAlone) {
  const auto placed = [](const std::string& tables) {
    double sum = 0;
    for (int seed = 0; seed < 20; ++seed) {
      Scene scene = rope_of_two("1, 0, 0, 0, 0, 0, 0", tables, "duration_ps = 5\n",
                                "[start]\nseed = " + std::to_string(seed) + "\n");
      for (const auto& term : prepare(scene).interaction.terms) sum += static_cast<double>(term->begun_at_start());
    }
    return sum;
  };
  const std::string all = "[[links]]\nper_nm = 1.5\nstiffness_nN_per_nm = 1\n", pair = all + "types = [1, 0]\n";
  const double contact = placed(pair) / 1.5, tolerance = 4 * std::sqrt(2 * 1.5 * contact);
  EXPECT_NEAR(contact, 20 * 6 * 13.78, tolerance / 1.5);
  EXPECT_NEAR(placed(all + pair), 2 * 1.5 * contact, tolerance);
  EXPECT_NEAR(placed(pair + all), 2 * 1.5 * contact, tolerance);
  const std::string none = "[[links]]\nper_nm = 0\nstiffness_nN_per_nm = 1\ntypes = [0, 1]\n";
  EXPECT_NEAR(placed(all + none), 1.5 * contact, tolerance);
  Scene scene = rope_of_two("1, 0, 0, 0, 0, 0, 0", all + none);
  EXPECT_THAT(scene.drives[0]->words(), HasSubstr("between all types but 0 and 1"));
}

TEST(Links, SameBitsOnAnyThreadsAndAfterResume) {
  Scene scene =
      rope_of_two("1, 0, 0, 0, 1, 1, 1",
                  forming + "types = [0, 0]\n" + breaking + "types = [0, 1]\nplaced_at_ps = 4\n" + breaking,
                  "duration_ps = 20\ntime_step_fs = 16\n", warm + pulled);
  const auto simulation = [&] {
    const Prepared p = prepare(scene);
    return start(scene, p);
  };
  omp_set_num_threads(1);
  Simulation whole = simulation();
  std::vector<std::string> saved;
  for (int n = 0; n < 800; ++n) {
    if (n % 100 == 0) saved.push_back(whole.serialise());
    whole.step(n % 50 == 49);
  }
  EXPECT_GT(whole.term_accounts().at(0).begun, 0);
  EXPECT_GT(whole.term_accounts().at(1).begun, 0) << "at 4 ps";
  EXPECT_GT(whole.term_accounts().at(2).events, 0);
  const std::string end = whole.serialise();
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    Simulation other = simulation();
    for (int n = 0; n < 800; ++n) other.step(n % 50 == 49);
    EXPECT_EQ(other.serialise(), end) << threads;
  }
  for (std::size_t at = 0; at < saved.size(); ++at) {
    Simulation resumed = simulation();
    resumed.restore(saved[at]);
    EXPECT_EQ(resumed.serialise(), saved[at]);
    for (int n = 100 * static_cast<int>(at); n < 800; ++n) resumed.step(n % 50 == 49);
    EXPECT_EQ(resumed.serialise(), end) << at;
  }
}

TEST(Links, KeepTheirEnergyWhereElementsAreSplit) {
  for (const std::string& grips : {std::string(), std::string("[[grip]]\nend = \"lower\"\n")}) {
    Scene coarse = rope(stiff + "rest_nm = 0.4\n", "duration_ps = 20\n", grips);
    const Prepared p = prepare(coarse);
    Simulation s = start(coarse, p);
    Scene finer = scene_of_text(finer_scene_text(coarse, p, "finer"), "finer.toml");
    Prepared q = prepare(finer);
    q.state = halved(p.topology, s.state(), splitting_of(coarse));
    Simulation split = start(finer, q);
    split.set_memory(s.halved_memory(heirs(p.topology, splitting_of(coarse))));
    EXPECT_GT(s.forces().energy.terms, 0.1);
    EXPECT_NEAR(split.forces().energy.terms, s.forces().energy.terms, 1e-9) << grips;
  }
}

TEST(Links, LowerTheStabilityLimit) {
  Scene soft = rope("[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 1\n"),
        hard = rope("[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 3000\n", "duration_ps = 5\n", warm);
  const Prepared a = prepare(soft), b = prepare(hard);
  EXPECT_LT(b.limit.limit, 0.5 * a.limit.limit);
  Simulation s = start(hard, b);
  const double total = s.total_energy();
  s.steps(3000);
  EXPECT_NEAR(s.total_energy() - s.account().supplied(), total, 0.05 * std::fabs(total));
}

TEST(Links, BadOnesAreRefused) {
  const auto message = [](const std::string& links, const std::string& more = "") -> std::string {
    try {
      Scene scene = rope(links, "duration_ps = 5\n", more);
      const Prepared p = prepare(scene);
      return "none";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  const std::string k = "stiffness_nN_per_nm = 1\n";
  EXPECT_THAT(message("[[links]]\n" + k), HasSubstr("give per_nm, at_ends, between or forming_per_nm_ps"));
  EXPECT_THAT(message("[[links]]\nper_nm = 1\nreach_nm = 0.1\n" + k), HasSubstr("none is placed"));
  EXPECT_THAT(message("[[links]]\nbetween = [0, 1, 2]\n" + k), HasSubstr("a link takes four"));
  EXPECT_THAT(message("[[links]]\nbetween = [0, 1, 0, 2]\n" + k), HasSubstr("links tube 0 with itself"));
  EXPECT_THAT(message("[[links]]\nbetween = [0, 1, 7, 2]\n" + k), HasSubstr("there is no tube 7"));
  EXPECT_THAT(message("[[links]]\nbetween = [0, 1, 1, 10]\n" + k), HasSubstr("tube 1 has no element 10"));
  EXPECT_THAT(message("[[links]]\nbetween = [0, 1, 1, 8]\n" + k), HasSubstr("nm apart; name elements that touch"));
  EXPECT_THAT(message("[[links]]\nper_nm = 1\nrest_nm = 0.6\n" + k), HasSubstr("take at most reach_nm"));
  EXPECT_EQ(message("[[links]]\nper_nm = 0\n" + k), "none") << "the control of a sweep";
  EXPECT_THAT(message("[[links]]\nforming_per_nm_ps = 1\n" + k), HasSubstr("most_per_nm: is missing"));
  EXPECT_THAT(message("[[links]]\nper_nm = 1\ntypes = [0, 1]\n" + k), HasSubstr("there is no tube type 1"));
  // Each would place its links, and each would count them up to its own limit.
  const std::string both = "[[links]]\nforming_per_nm_ps = 1\nmost_per_nm = 0.3\n" + k;
  EXPECT_EQ(message(both + both),
            "links.toml:10: links.types: is missing, so that the table claims all pairs of types, as [[links]] of "
            "line 6; put both into one table, or give one of them other types");
  EXPECT_THAT(message(both + "types = [0, 0]\n" + both + "types = [0, 0]\n"),
              HasSubstr("is [0, 0], the same pair as [[links]] of line 6"));
  EXPECT_THAT(message(both + "types = [0, 0]\n" + both), HasSubstr("this one would do nothing"));
  EXPECT_EQ(message(both + "[[links]]\nbetween = [0, 5, 1, 5]\n" + k), "none")
      << "named elements are no pair of types";
  EXPECT_THAT(message("[[links]]\nper_nm = 1\n" + k, "[contact]\nlaw = \"none\"\n"),
              HasSubstr("contact.law is \"none\""));
}

TEST(Links, HaveTheirColumnsInTheLog) {
  EXPECT_THAT(log_header(), HasSubstr(",links_eV,links_lost_eV,links_formed,links_broken"));
  EXPECT_THAT(scene_key_help(), HasSubstr("[[links]]"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
