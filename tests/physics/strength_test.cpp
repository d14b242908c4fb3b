// What a tube bears until it breaks, against the pull of its atoms by LAMMPS from which the sets have their law.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "run/moving_scene.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Broken {
  double force = 0, strain = 0;  // nN, the largest, and the strain of the ends then
};

// A tube of about `length` nm in elements of `per_own` times the set's own length that is drawn out at one rate.
// The force is the mean over its middle third; in heat the mean over some ps as well.
Broken pulled(const std::string& tube, const std::string& failure, double length, double per_own,
              double kelvin = 0) {
  const ParameterSet set =
      read_parameters(find_parameters(fmt::format("cnt-{}-tersoff", tube), "", {"", 0, "set"}));
  const double element = per_own * set.element_length, time = 10 * length;
  const Scene scene = scene_of_text(
      fmt::format(
          "format = \"ropewalk-scene-1\"\nparameters = \"{}\"\nelement_length_nm = {:.17g}\n[chain]\n"
          "elements = {}\n[contact]\nlaw = \"none\"\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = "
          "\"upper\"\nz = {{ strain = [[0, 0], [{:.6g}, 0.3]] }}\n[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\n"
          "bond_damping_per_ps = {}\n"
          "[failure]\n{}\n{}[run]\nduration_ps = {:.6g}\n",
          set.name, element, std::lround(length / element) + 1, time, kelvin > 0 ? 0 : 2, failure,
          kelvin > 0 ? fmt::format("[start]\ntemperature_K = {0}\n[thermostat]\ntemperature_K = {0}\n"
                                   "coupling_per_ps = 1\n",
                                   kelvin)
                     : "",
          time),
      "strength.toml");
  MovingScene m(scene);
  Broken out;
  const double share = kelvin > 0 ? 0.05 : 1;  // of each 0.1 ps in the mean
  double mean = 0;
  while (m.state().time < time && m.simulation.term_accounts().at(0).events == 0) {
    m.simulation.steps(std::max(1L, std::lround(0.1 / m.prepared.time_step)));
    const LogRow row = m.row();
    mean += share * (row["most_tension_nN"] - mean);
    if (mean > out.force) out = {mean, row["ends_strain"]};
  }
  return out;
}

// Forces of LAMMPS at the strains at which tubes break (the virial, nN).
TEST(Strength, OfOneTubeIsThatOfItsAtoms) {
  struct Atoms {
    const char* tube;
    double at_10, at_16, strength;  // at strains of 0.1 and 0.16, and at the end of the pull
  };
  for (const Atoms& a : {Atoms{"10-10", 116.460, 155.822, 184.87}, Atoms{"5-5", 56.878, 76.160, 91.35},
                         Atoms{"9-0", 57.149, 76.570, 79.10}, Atoms{"8-2", 58.969, 79.375, 86.42}}) {
    SCOPED_TRACE(a.tube);
    const auto compare = [&](const char* failure, double atoms) {
      const Broken tube = pulled(a.tube, failure, 12, 1);
      std::printf("(%s) %s: %.2f nN at %.4f, atoms %.2f\n", a.tube, failure, tube.force, tube.strain, atoms);
      EXPECT_NEAR(tube.force / atoms, 1, 0.03) << failure;
    };
    compare("strain = 0.1", a.at_10);
    compare("strain = 0.16", a.at_16);
    compare("from = \"atoms\"", a.strength);
  }
}

TEST(Strength, DoesNotDependOnTheElements) {
  for (const double kelvin : {0.0, 300.0}) {
    const Broken own = pulled("10-10", "strain = 0.16", 22, 1, kelvin);
    std::printf("%.0f K: %.2f nN at %.4f\n", kelvin, own.force, own.strain);
    for (const double per_own : {0.5, 2.0}) {
      const Broken other = pulled("10-10", "strain = 0.16", 22, per_own, kelvin);
      std::printf("  elements of %.1f: %.2f nN at %.4f\n", per_own, other.force, other.strain);
      EXPECT_NEAR(other.force / own.force, 1, 0.02) << kelvin << " K, elements of " << per_own;
    }
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
