// The limits of a run: measured values, the meaning of defaults, and the file that keeps them.
#include "observe/limits.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "io/files.hpp"
#include "io/limits_file.hpp"
#include "model/error.hpp"
#include "run/limit_watch.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::published_bond;
using test::published_topology;
using test::turn;

State straight(const Topology& topology) {
  State s(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e)
      s.position.set(static_cast<std::size_t>(e),
                     {5.0 * t, 0, test::element_length * (e - topology.tube_begin[t])});
  return s;
}

const Peak& peak_of(const Peaks& all, const std::string& key) {
  for (std::size_t k = 0; k < limit_count; ++k)
    if (limit_kinds()[k].key == key) return all[k];
  throw std::runtime_error(key);
}

TEST(Limits, BendAndTwistAreWhereTheBondIsOnePercentOffTheRod) {
  const Limits limits;
  const double a = test::element_length;
  const auto off = [&](const Quaternion& q, double rod) {
    const BondEnergy e =
        bond_energy(published_bond(), a, Vector3(0, 0, a), frame_of(Quaternion::Identity()), frame_of(q));
    return 1 - (e.bend + e.twist) / rod;
  };
  const double bend = limits.bend, twist = limits.twist;
  EXPECT_NEAR(off(turn(Vector3::UnitY(), bend), 0.5 * published_bond().bend / a * bend * bend), 0.01, 1e-4);
  EXPECT_NEAR(off(turn(Vector3::UnitZ(), twist), 0.5 * published_bond().twist / a * twist * twist), 0.01, 1e-4);
}

TEST(Limits, PeaksNameTheElement) {
  Topology topology = published_topology();
  topology.add_tube(4);
  topology.add_tube(5);
  State s = straight(topology);
  const Limits limits = default_limits(topology.types[0], {0.087, 0.05, 0.07});
  for (const Peak& p : peaks(topology, s, {}, {{limits}, {}})) EXPECT_FALSE(p.passed());

  s.orientation.set(6, turn(Vector3::UnitX(), 0.1));      // bends the bonds of 5 and 6
  s.orientation.set(2, turn(Vector3::UnitZ(), 0.4));      // twists those of 1 and 2
  s.position.set(8, s.position[8] + Vector3(0, 0, 0.1));  // strains that of 7
  s.velocity.set(3, {0, 3, 0});
  const Peaks p = peaks(topology, s, {}, {{limits}, {}});
  EXPECT_NEAR(peak_of(p, "bend_deg").value, 0.1, 1e-9);
  EXPECT_EQ(peak_of(p, "bend_deg").element, 5);
  EXPECT_FALSE(peak_of(p, "bend_deg").passed());
  EXPECT_NEAR(peak_of(p, "twist_deg").value, 0.4, 1e-9);
  EXPECT_EQ(peak_of(p, "twist_deg").element, 1);
  EXPECT_TRUE(peak_of(p, "twist_deg").passed());
  EXPECT_NEAR(peak_of(p, "kink_curvature_per_nm").value, 0.1 / test::element_length, 1e-9);
  EXPECT_FALSE(peak_of(p, "kink_curvature_per_nm").passed());
  EXPECT_NEAR(peak_of(p, "wall_twist").value, 0.678 * 0.4 / test::element_length, 1e-9);
  EXPECT_TRUE(peak_of(p, "wall_twist").passed());
  EXPECT_NEAR(peak_of(p, "strain").value, 0.1 / test::element_length, 1e-9);
  EXPECT_EQ(peak_of(p, "strain").element, 7);
  EXPECT_TRUE(peak_of(p, "strain").passed());
  EXPECT_EQ(peak_of(p, "speed_nm_per_ps").element, 3);
  EXPECT_TRUE(peak_of(p, "speed_nm_per_ps").passed());
}

// Atoms that were pulled further than the terms of strain raise the limit of tension alone.
TEST(Limits, TensionAndCompressionHaveLimitsOfTheirOwn) {
  Topology topology = published_topology();
  topology.add_tube(5);
  Validity validity{0.087, 0.05, 0.07};
  validity.tension = 0.26;
  const Limits limits = default_limits(topology.types[0], validity);
  const auto peak = [&](double move) {
    State s = straight(topology);
    s.position.set(4, s.position[4] + Vector3(0, 0, move * test::element_length));
    return peak_of(peaks(topology, s, {}, {{limits}, {}}), "strain");
  };
  EXPECT_NEAR(peak(0.2).value, 0.2, 1e-12);
  EXPECT_FALSE(peak(0.2).passed());
  EXPECT_TRUE(peak(0.27).passed());
  EXPECT_TRUE(peak(-0.08).passed());
  EXPECT_NEAR(peak(-0.08).limit, 0.07, 1e-12);
  EXPECT_FALSE(peak(-0.06).passed());
  EXPECT_EQ(peak(-0.06).element, 3);
  EXPECT_TRUE(peak(-0.08).pressed);
  EXPECT_FALSE(peak(0.27).pressed);
}

// A pull of 0.2, which is within its limit, does not hide that bonds were pressed beyond theirs.
TEST(Limits, RecordsHoldWhatWentFarthestBeyondItsOwnLimit) {
  Topology topology = published_topology();
  topology.add_tube(5);
  Validity validity{0.087, 0.05, 0.07};
  validity.tension = 0.26;
  LimitWatch watch({{default_limits(topology.types[0], validity)}, {}});
  std::string lines;
  for (const double move : {0.05, -0.08, 0.2}) {
    State s = straight(topology);
    s.position.set(4, s.position[4] + Vector3(0, 0, move * test::element_length));
    for (const std::string& line : watch.check(topology, s, {}, {}, false)) lines += line;
  }
  EXPECT_NE(lines.find("is strained by -0.08, beyond limits.strain = -0.07"), std::string::npos) << lines;
  EXPECT_NE(passed_words(watch.records()).find("strain up to -0.08 (limit -0.07)"), std::string::npos);
}

// A tenth of the speed of sound along graphene, 22 nm/ps.
TEST(Limits, SpeedIsATenthOfThatOfSound) {
  const Limits limits = default_limits(published_topology().types[0], {});
  EXPECT_NEAR(limits.speed, 2.15, 0.05);
}

// If tube types have limits of their own, the one that is nearest to its own counts, not the largest number.
TEST(Limits, AreThoseOfTheTubeType) {
  Topology topology = published_topology();
  topology.types.push_back(topology.types[0]);
  topology.add_tube(3, 0);
  topology.add_tube(3, 1);
  State s = straight(topology);
  s.orientation.set(2, turn(Vector3::UnitX(), 0.3));
  s.orientation.set(5, turn(Vector3::UnitX(), 0.2));
  Limits wide, narrow;
  wide.bend = 0.6;
  narrow.bend = 0.25;
  const Peaks p = peaks(topology, s, {}, {{wide, narrow}, {}});
  EXPECT_EQ(peak_of(p, "bend_deg").element, 4);
  EXPECT_NEAR(peak_of(p, "bend_deg").ratio(), 0.8, 1e-9);
  wide.pressure = 3;
  narrow.pressure = 1;
  Watched watched{{wide, narrow}, {}};
  watched.pressures = [](const State&) { return std::vector<double>{2.5, 2}; };
  EXPECT_EQ(pressure_peak(topology, s, watched).element, 4);
  EXPECT_TRUE(pressure_peak(topology, s, watched).passed());
  narrow.bend = 0;  // not watched
  EXPECT_EQ(peak_of(peaks(topology, s, {}, {{narrow, narrow}, {}}), "bend_deg").passed(), false);
}

// Two tubes cross 1.6 nm apart, and would rest at 1.7; a third one is out of reach.
TEST(Limits, PressIsTheNearestDistanceOfTheAxes) {
  Topology topology = published_topology();
  for (int t = 0; t < 3; ++t) topology.add_tube(3);
  State s = straight(topology);
  for (int e = 0; e < 3; ++e) {
    const auto i = static_cast<std::size_t>(3 + e);
    s.position.set(i, {1.6, test::element_length * (e - 1.3), 0.4 * test::element_length});
    s.orientation.set(i, turn(Vector3::UnitX(), -0.5 * units::pi));
  }
  NeighbourList list;
  list.cutoff = 4;
  list.skin = 0.2;
  list.excluded_arc = 3 * test::element_length;
  list.build(topology, s);
  Limits limits;
  limits.overlap = 0.08;
  const Peak p = peak_of(peaks(topology, s, list, {{limits}, {1.7}}), "press_nm");
  EXPECT_NEAR(p.value, 0.1, 1e-12);
  EXPECT_EQ(p.element, 0);
  EXPECT_TRUE(p.passed());
  EXPECT_FALSE(peak_of(peaks(topology, s, list, {{limits}, {1.5}}), "press_nm").passed());
}

// A bond belongs to both of its elements.
TEST(Limits, PlacesNameTheClamp) {
  Topology topology = published_topology();
  topology.add_tube(6);
  topology.add_tube(6);
  std::vector<Held> held(12, Held::free);
  held[0] = held[11] = Held::clamped;
  held[6] = held[8] = Held::loaded;
  EXPECT_EQ(place_in_words(topology, held, 0), "tube 0, element 0, at the lower clamp");
  EXPECT_EQ(place_in_words(topology, held, 1), "tube 0, element 1");
  EXPECT_EQ(place_in_words(topology, held, 5), "tube 0, element 5") << "the next element is of another tube";
  EXPECT_EQ(place_in_words(topology, held, 6), "tube 1, element 0, at the loaded lower end");
  EXPECT_EQ(place_in_words(topology, held, 7), "tube 1, element 1, at a loaded place");
  EXPECT_EQ(place_in_words(topology, held, 10), "tube 1, element 4, at the upper clamp");
  EXPECT_EQ(place_in_words(topology, {}, 10), "tube 1, element 4");
}

TEST(LimitsFile, ReadsBackWhatWasWritten) {
  LimitsFile out;
  out.limits = {{"bend_deg", "deg", 19.9, 23.4, 1.5, 2, 17, true, 1.25, 640}, {}};
  RefinementRecord r;
  r.from = "a";
  r.to = "a.fine";
  r.time_ps = 0.1 + 0.2;
  r.step_before = 12;
  r.step_after = 25;
  r.length_before = 1.378;
  r.length_after = 0.689;
  r.elements_before = 10;
  r.elements_after = 20;
  r.before = {{1, 2, 3, 4, -5}, 6};
  r.after = {{1.5, 2, 3.5, 4, -5.25}, 6.5};
  out.refinements = {r};
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("ropewalk-limits-" + std::to_string(std::random_device{}()) + ".json"))
                               .string();
  write_file_atomically(path, limits_json(out));
  const LimitsFile in = read_limits(path);
  EXPECT_EQ(limits_json(in), limits_json(out));
  ASSERT_EQ(in.limits.size(), 2u);
  EXPECT_EQ(in.limits[0].passed_at_step, 640);
  EXPECT_EQ(in.refinements.at(0).time_ps, r.time_ps);
  EXPECT_EQ(in.refinements.at(0).after.total(), r.after.total());
  write_file_atomically(path, "{\"format\": \"ropewalk-limits-1\", \"limits\": [{}], \"refinements\": []}");
  EXPECT_THROW(read_limits(path), InputError);
  write_file_atomically(path, "{");
  EXPECT_THROW(read_limits(path), InputError);
  std::filesystem::remove(path);
}

// Sentences for users, without names of the code.
TEST(LimitKinds, AreToldInPlainWords) {
  for (const LimitKind& kind : limit_kinds())
    for (const std::string words : {kind.what, kind.consequence})
      EXPECT_EQ(words.find('_'), std::string::npos) << words;
  EXPECT_STREQ(limit_kinds()[5].what, "the tube is pressed into another one by");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
