// Mass, mass per length and cross-section of ropes, slices, yarns, plies and mixtures of tubes.
#include "observe/rope_size.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/units.hpp"
#include "run/run_directory.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Sized {
  Scene scene;
  Prepared p;
  RopeSize size;

  explicit Sized(const std::string& text, const std::string& sets = "\"cnt-10-10-tersoff\"")
      : scene(scene_of_text("format = \"ropewalk-scene-1\"\nparameters = " + sets + "\n" + text, "rope.toml")),
        p(prepare(scene)),
        size(make_observer(scene, p).size) {}
  double tube(std::size_t set = 0) const { return scene.sets[set].atoms_per_length * units::carbon_mass; }
  double cell() const { return 0.5 * std::sqrt(3.0) * p.spacing * p.spacing; }
};

const std::string run = "[run]\nduration_ps = 1\n", slice = "[periodic]\ntwist_deg_per_nm = [[0, 1]]\n";

void expect_tubes(const Sized& rope, int tubes) {
  EXPECT_NEAR(rope.size.mass_per_length, tubes * rope.tube(), 1e-9 * rope.size.mass_per_length);
  EXPECT_NEAR(rope.size.area, tubes * rope.cell(), 1e-9 * rope.size.area);
}

// Rope, one tube, slice, heavier masses and plied ropes: the tubes side by side, and the rope's own length of them.
TEST(RopeSize, OfEndlessTubesIsThatOfItsTubes) {
  const std::string tubes = "[rope]\ntubes = 7\nlength_nm = 33\n";
  const Sized rope(tubes + run), interior(tubes + slice + run), heavy(tubes + slice + run + "mass_scale = 9\n"),
      plies("[plies]\nropes = 2\ntubes = 7\nlength_nm = 67.5\nply_twist_deg_per_nm = 5\n" + run);
  for (const Sized* one : {&rope, &interior, &heavy}) expect_tubes(*one, 7);
  expect_tubes(Sized("[rope]\ntubes = 1\nlength_nm = 20\n" + run), 1);
  expect_tubes(plies, 14);
  EXPECT_NEAR(rope.size.mass, 7 * rope.tube() * 24 * rope.scene.element_length, 1e-9 * rope.size.mass);
  const Topology& t = interior.p.topology;
  EXPECT_NEAR(interior.size.mass, 7 * interior.tube() * t.groups.period, 1e-9 * interior.size.mass);
  EXPECT_NEAR(heavy.size.mass, interior.size.mass, 1e-9 * interior.size.mass);
}

// 40 atoms of 12.011 u in the 0.2495 nm that a period of relaxed (10,10) has are 3.197e-9 tex a tube.
TEST(RopeSize, InUnitsOfYarns) {
  const Sized rope("[rope]\ntubes = 19\nlength_nm = 20\n" + run);
  const double per_nm = 19 * rope.scene.sets[0].atoms_per_length * 12.011 * 1.66053907e-27,  // kg/nm
      density = per_nm / (19 * rope.cell()) * 1e27;                                          // kg/m^3
  EXPECT_EQ(
      size_words(rope.size),
      fmt::format("linear density {:.4g} tex, cross-section {:.4g} nm^2, {:.4g} g/cm^3: 1 GPa is {:.3g} N/tex",
                  per_nm * 1e15, 19 * rope.cell(), density * 1e-3, 1e3 / density));
  EXPECT_NEAR(per_nm * 1e15, 19 * 3.197e-9, 2e-11);
  EXPECT_EQ(size_words(RopeSize()), "");
}

// Neither the ends of its tubes nor the images at its own ends count in a yarn.
TEST(RopeSize, OfAYarnIsThatOfItsTubes) {
  const std::string tubes = "[rope]\ntubes = 7\nlength_nm = 100\ntube_length_nm = 20\n";
  const Sized yarn(tubes + slice + run), finite(tubes + run);
  for (const Sized* one : {&yarn, &finite}) expect_tubes(*one, 7);
  const Topology& t = yarn.p.topology;
  ASSERT_GT(t.tubes(), 4 * t.strands());
  const int own = t.elements() / t.strands() - 2 * t.groups.images;
  EXPECT_NEAR(yarn.size.mass, 7 * yarn.tube() * own * yarn.scene.element_length, 1e-9 * yarn.size.mass);
}

// Each kind of tube has a cell of its own, in strands that hold both kinds as well.
TEST(RopeSize, OfMixedTubesIsTheSumOfBoth) {
  const std::string both = "[\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]";
  const Sized rope("type_shares = [0.5, 0.5]\n[rope]\ntubes = 7\nlength_nm = 60\ntube_length_nm = 20\n" + run,
                   both);
  const Topology& t = rope.p.topology;
  std::vector<double> cell;
  for (int k = 0; k < 2; ++k) {
    const double apart = rope.p.interaction.law->parallel_distance({k, k}, rope.scene.element_length);
    cell.push_back(0.5 * std::sqrt(3.0) * apart * apart);
  }
  ASSERT_LT(cell[1], 0.7 * cell[0]);
  double mass = 0, area = 0;
  for (int tube = 0; tube < t.tubes(); ++tube) {
    const auto k = static_cast<std::size_t>(t.tube_type[static_cast<std::size_t>(tube)]);
    mass += t.length_of(tube) * rope.scene.element_length * rope.tube(k);
    area += t.length_of(tube) * cell[k] * 7 / t.elements();
  }
  EXPECT_NEAR(rope.size.mass, mass, 1e-9 * mass);
  EXPECT_NEAR(rope.size.area, area, 1e-9 * area);
  // The pressure on a thin tube refers to its own cell.
  EXPECT_EQ(make_observer(rope.scene, rope.p).loading.cells, cell);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
