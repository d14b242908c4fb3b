// A force term whose forces do not follow from its energy is found.
#include "plan/energy_check.hpp"

#include <gtest/gtest.h>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// k z^2 / 2 for every element, with a factor on its force.
class Spring : public ForceTerm {
 public:
  explicit Spring(double factor) : factor_(factor) {}
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<Spring>(*this); }
  std::string name() const override { return "spring"; }
  TermSum add(const State& state, const Segment& part, const ForceRows& out) const override {
    TermSum sum;
    for (int i = part.begin; i < part.end; ++i) {
      const double z = state.position[static_cast<std::size_t>(i)].z();
      sum.energy += 0.5 * k * z * z;
      out.force.add(static_cast<std::size_t>(i - out.origin), Vector3(0, 0, -factor_ * k * z));
    }
    return sum;
  }

 private:
  static constexpr double k = 0.1;  // eV/nm^2
  double factor_;
};

TEST(EnergyCheck, FindsForcesThatAreNotTheFallOfTheEnergy) {
  Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 14\n"
      "[run]\nduration_ps = 1\n",
      "scene.toml");
  const Prepared plain = prepare(scene);
  EXPECT_LT(energy_check(start(scene, plain)).error(), 3e-7);
  for (const double factor : {1.0, 1.01, -1.0}) {
    Prepared with = plain;
    add_term(std::make_shared<Spring>(factor), with.interaction);
    const EnergyCheck found = energy_check(start(scene, with));
    if (factor == 1)
      EXPECT_LT(found.error(), 3e-7);
    else
      EXPECT_GT(found.error(), 3e-6) << factor;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
