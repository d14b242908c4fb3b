// Damping that belongs to a length of tube, whatever the elements.
#include "scene/dissipation.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/error.hpp"
#include "run/run_directory.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double own = 1.3775870846515064;  // nm, elements of the set

Scene scene_with(double element_length, const std::string& damping) {
  return scene_of_text(fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n"
                                   "element_length_nm = {:.17g}\n[rope]\ntubes = 7\nlength_nm = 27.6\n{}"
                                   "[run]\nduration_ps = 1\n",
                                   element_length, damping),
                       "scene.toml");
}

const std::string per_length = "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 13.5\n",
                  per_pair = "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 20\nbond_damping_per_ps = 5\n";

// By the new key, by the old one and by default: one force per length of contact, one viscosity of a tube.
TEST(Dissipation, IsThatOfALengthForAnyElements) {
  for (const std::string& damping : {per_length, per_pair, std::string("[damping]\nbond_damping_per_ps = 5\n")}) {
    const Damping as_typed = scene_with(own, damping).damping;
    for (const double length : {0.25 * own, 0.5 * own, 2 * own}) {
      const double squared = std::pow(length / own, 2);
      const Damping d = scene_with(length, damping).damping;
      EXPECT_NEAR(d.contact.eta / squared, as_typed.contact.eta, 1e-12 * as_typed.contact.eta);
      EXPECT_NEAR(d.bond.rate * squared, as_typed.bond.rate, 1e-12 * as_typed.bond.rate);
    }
  }
  EXPECT_EQ(scene_with(own, per_pair).damping.contact.eta, 20);
  EXPECT_EQ(scene_with(own, per_pair).damping.bond.rate, 5);
  EXPECT_NEAR(scene_with(own, per_length).damping.contact.eta, 0.5 * scene_with(own, "").damping.contact.eta,
              1e-12);
}

TEST(Dissipation, TheKeyPerPairIsReadWithANote) {
  const auto notes = [](double length, const std::string& damping) {
    Scene scene = scene_with(length, damping);
    return warnings_of(scene, prepare(scene));
  };
  EXPECT_THAT(notes(own, per_pair),
              Contains(HasSubstr("_nm2 = 20 stands for pairs of elements of 1.378 nm, the set's "
                                 "own length. damping.contact_viscosity_eV_ps_per_nm3 = 26.4944")));
  EXPECT_THAT(notes(0.5 * own, per_pair), Contains(HasSubstr("own length, and is 5 for those of 0.6888 nm.")));
  for (const std::string& other :
       {per_length, std::string(), std::string("[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\n")})
    EXPECT_THAT(notes(own, other), Not(Contains(HasSubstr("stands for pairs"))));
  try {
    scene_with(own, per_length + "contact_viscosity_eV_ps_per_nm2 = 20\n");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("contact_viscosity_eV_ps_per_nm3 are both given"));
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
