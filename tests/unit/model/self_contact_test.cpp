// Parts of one tube: which of them attract one another.
#include "model/self_contact.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// A piece of a plane curve: `length` nm along it, turning by `curvature` (1/nm, + to the left).
struct Arc {
  double length = 0, curvature = 0;
};

double length_of(const std::vector<Arc>& curve) {
  double sum = 0;
  for (const Arc& arc : curve) sum += arc.length;
  return sum;
}

// One tube along the curve, as elements of about this length.
State along(const std::vector<Arc>& curve, double element_length, Topology& topology) {
  const auto count = static_cast<int>(std::lround(length_of(curve) / element_length));
  topology.tube_begin = {0};
  topology.tube_type.clear();
  topology.add_tube(count);
  State s(static_cast<std::size_t>(count));
  for (int e = 0; e < count; ++e) {
    double left = (e + 0.5) * element_length, heading = 0;
    Vector3 at = Vector3::Zero();
    for (const Arc& arc : curve) {
      const double ds = std::clamp(left, 0.0, arc.length), half = 0.5 * arc.curvature * ds;
      const double chord = half != 0 ? ds * std::sin(half) / half : ds;
      at += chord * Vector3(std::cos(heading + half), std::sin(heading + half), 0);
      heading += 2 * half;
      left -= ds;
    }
    const auto i = static_cast<std::size_t>(e);
    s.position.set(i, at);
    s.orientation.set(i, test::turn(Vector3::UnitZ(), heading) * test::turn(Vector3::UnitY(), 0.5 * units::pi));
  }
  return s;
}

Scene scene_of(const std::string& set, double element_length, const std::string& contact = "") {
  return scene_of_text(fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\nelement_length_nm = {}\n"
                                   "[chain]\nelements = 5\n[contact]\n{}[run]\nduration_ps = 1\n",
                                   set, element_length, contact),
                       "tube.toml");
}

double contact_energy(const Scene& scene, const std::vector<Arc>& curve) {
  Topology topology = empty_topology(scene);
  const State s = along(curve, scene.element_length, topology);
  Forces f(s.size()), plain(s.size());
  Interaction in = interaction_of(scene);
  compute_reference(topology, in, s, plain);
  in.precision = Interaction::Precision::full;
  NeighbourList list(in, 0.1);
  list.build(topology, s);
  ForceEngine engine;
  engine.compute(topology, in, list, s, f);
  EXPECT_NEAR(f.energy.vdw, plain.energy.vdw, 1e-9 * (1 + std::fabs(plain.energy.vdw)));
  return f.energy.vdw;
}

// Two arms of `arm` nm side by side and a head between them, nowhere curved more than 1/radius. The arms part
// gently, so that the ends of straight elements do not stand into one another there.
std::vector<Arc> racket(double arm, double spacing, double radius) {
  const double gentle = 10 * radius, part = std::acos((0.5 * spacing + gentle) / (gentle + radius));
  const Arc parting{part * gentle, -1 / gentle};
  return {{arm, 0}, parting, {(units::pi + 2 * part) * radius, 1 / radius}, parting, {arm, 0}};
}

TEST(SelfContact, ArcsAndLoopsAreThoseOfACircle) {
  constexpr double kappa = 0.2, d = 3;
  for (const double arc : {nearest_arc(kappa, d), smallest_loop(kappa, d)})
    EXPECT_NEAR(2 / kappa * std::sin(0.5 * kappa * arc), d, 1e-12);
  EXPECT_LT(nearest_arc(kappa, d), 1.05 * d);
  EXPECT_EQ(nearest_arc(0, d), d);
  EXPECT_NEAR(nearest_arc(1, 3), units::pi, 1e-12);  // a circle of 2 nm lies within reach as a whole
  EXPECT_TRUE(std::isinf(smallest_loop(0, d)));
}

TEST(SelfContact, ElementsAreLeftOutByTheirNearestEnds) {
  TubeType type;
  type.element_length = 1.4;
  EXPECT_EQ(type.elements_within(0), 0);
  EXPECT_EQ(type.elements_within(0.1), 1);
  EXPECT_EQ(type.elements_within(1.4), 1);
  EXPECT_EQ(type.elements_within(1.41), 2);
  EXPECT_EQ(type.elements_within(20 * 1.4), 20);
}

// The elements' length decides nothing: with the same 20 elements left out, a hairpin would bind by its arms, by a
// part of them, or not at all.
TEST(SelfContact, AHairpinBindsTheSameInElementsOfAnyLength) {
  // As long as bonds are bent by 20 degrees at most, or three times that.
  const std::vector<double> lengths = {0.69, 1.38, 2.8, 5.4}, shorter = {0.69, 1.38, 2.8};
  for (const auto& [name, tried] :
       {std::pair("cnt-10-10-tersoff", lengths), std::pair("cnt-5-5-tersoff", shorter)}) {
    const ParameterSet set = scene_of(name, 1).parameters();
    const double spacing = set.law<LineParameters>()->pair_spacing, radius = 1.3 / set.validity.kink_curvature;
    const double head = length_of(racket(0, spacing, radius));
    for (const double length : tried) {
      const double arm = 0.5 * (length * std::round((86.4 + head) / length) - head);  // a whole number of elements
      const double expected = contact_energy(scene_of(name, 0.345), racket(arm, spacing, radius));
      EXPECT_LT(expected, 0.9 * arm * set.law<LineParameters>()->pair_energy);
      EXPECT_NEAR(contact_energy(scene_of(name, length), racket(arm, spacing, radius)) / expected, 1, 0.03)
          << name << ", elements of " << length << " nm";
    }
  }
}

TEST(SelfContact, AFoldBeyondTheKinkBindsToo) {
  const double spacing = scene_of("cnt-10-10-tersoff", 1).parameters().law<LineParameters>()->pair_spacing;
  const std::vector<Arc> fold = {{30, 0}, {0.5 * spacing * units::pi, 2 / spacing}, {30, 0}};
  const double expected = contact_energy(scene_of("cnt-10-10-tersoff", 0.345), fold);
  for (const double length : {0.69, 1.38, 2.8, 5.4})
    EXPECT_NEAR(contact_energy(scene_of("cnt-10-10-tersoff", length), fold) / expected, 1, 0.12) << length;
}

// Neither straight nor bent up to its kink.
TEST(SelfContact, ATubeWithoutALoopDoesNotAttractItself) {
  for (const auto& [name, law] : {std::pair("cnt-10-10-tersoff", "line"), std::pair("cnt-20-20-tersoff", "line"),
                                  std::pair("cnt-5-5-tersoff", "line"), std::pair("cnt-10-10-paper", "paper")}) {
    const std::string contact = fmt::format("law = \"{}\"\n", law);
    const bool paper = contact == "law = \"paper\"\n";
    for (const double length : paper ? std::vector<double>{1.356} : std::vector<double>{0.69, 1.38, 2.8}) {
      const Scene scene = scene_of(name, length, contact);
      const double kappa = scene.parameters().validity.kink_curvature;
      EXPECT_EQ(contact_energy(scene, {{40, 0}}), 0) << name << " straight, " << length;
      EXPECT_EQ(contact_energy(scene, {{units::pi / kappa, kappa}}), 0) << name << " bent, " << length;
    }
  }
}

TEST(SelfContact, TheLengthMayBeTyped) {
  const double spacing = scene_of("cnt-10-10-tersoff", 1).parameters().law<LineParameters>()->pair_spacing;
  const double longer = contact_energy(scene_of("cnt-10-10-tersoff", 1.38, "exclude_along_tube_nm = 200\n"),
                                       racket(40, spacing, 13)),
               whole = contact_energy(scene_of("cnt-10-10-tersoff", 1.38), racket(40, spacing, 13));
  EXPECT_GT(longer / whole, 0.3);
  EXPECT_LT(longer / whole, 0.8);
  for (const auto& [key, message] :
       {std::pair(
            "exclude_along_tube_nm = 1.5",
            "contact.exclude_along_tube_nm: is 1.5 nm, and a straight tube would attract itself; take at least 2."),
        std::pair(
            "exclude_along_tube_elements = 20",
            "contact.exclude_along_tube_elements: is a length now, so that it does not change with the elements; "
            "write exclude_along_tube_nm = 27.6, or leave it out"),
        std::pair("law = \"none\"\nexclude_along_tube_nm = 20", "is of no use without contact")}) {
    SCOPED_TRACE(key);
    try {
      scene_of("cnt-10-10-tersoff", 1.38, std::string(key) + "\n");
      FAIL() << "was read";
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(message));
    }
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
