// The five states: both laws, crossed tubes, bent ends, unlike tubes, a tube that touches itself.
#pragma once

#include "lammps/support.hpp"

namespace ropewalk::test {

struct FiveStates {
  const char* name;
  std::string head;  // of the scene
  std::vector<Curve> tubes;
};

inline constexpr double a = element_length;
inline const Vector3 ex = Vector3::UnitX(), ey = Vector3::UnitY(), ez = Vector3::UnitZ();

inline std::vector<Curve> parallel_tubes() {
  std::vector<Curve> tubes;
  for (int t = 0; t < 7; ++t) {
    const double angle = t * units::pi / 3, r = t == 0 ? 0.0 : 1.72;
    tubes.push_back(straight({r * std::cos(angle), r * std::sin(angle), 0.1 * t}, ez, 12, a));
  }
  return tubes;
}

inline std::vector<Curve> crossed_tubes() {
  return {straight({0, 0, 0}, ex, 14, a), straight({0, 2, 1.7}, Vector3(0.85, 0.5, 0), 14, a),
          straight({1, 0, 3.4}, ey, 14, a), straight({0, 1.75, 0}, Vector3(1, 0.02, 0), 14, a)};
}

inline std::vector<Curve> bent_tubes() {
  return {arc({0, 0, 0}, ez, ex, 25, 16, a), arc({0.2, 1.7, 3}, ez, ex, 20, 12, a),
          arc({-1.75, 0.3, 2}, ez, -ex, 30, 9, a), straight({7.8, -1.75, 18}, ex, 5, a)};
}

inline std::vector<Curve> unlike_tubes() {
  return {straight({0, 0, 0}, ez, 10, a), straight({1.4, 0, 0.3}, ez, 12, a),
          straight({-1.9, 0.2, 0}, Vector3(0, 0.05, 1), 11, a), straight({0.2, 1.7, 0}, ex, 12, a),
          straight({0.1, -1.3, 0}, Vector3(0.1, 0, 1), 8, a)};
}

inline const std::vector<FiveStates>& five_states() {
  static const std::vector<FiveStates> states = {
      {"parallel", "parameters = \"cnt-10-10-paper\"\n[contact]\nlaw = \"paper\"\nprecision = \"double\"\n",
       parallel_tubes()},
      {"crossed",
       "parameters = \"cnt-10-10-tersoff\"\nelement_length_nm = 1.356\n[contact]\nlaw = \"line\"\nprecision = "
       "\"double\"\n",
       crossed_tubes()},
      {"bent",
       "parameters = \"cnt-10-10-tersoff\"\nelement_length_nm = 1.356\n[contact]\nlaw = \"line\"\nprecision = "
       "\"double\"\n",
       bent_tubes()},
      {"unlike",
       "parameters = [\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\", \"cnt-12-6-tersoff\"]\ntube_types = [0, 1, 2, 0, "
       "1]\nelement_length_nm = 1.356\n[contact]\nlaw = \"line\"\nprecision = \"double\"\n",
       unlike_tubes()},
      {"coil",
       "parameters = \"cnt-10-10-paper\"\n[contact]\nlaw = \"paper\"\nprecision = "
       "\"double\"\nexclude_along_tube_nm = 5.6\n",
       {helix(4.0, 1.8, 60, a)}},
  };
  return states;
}

// Loads and constraints of every kind.
inline std::string driven_scene(const FiveStates& s) {
  return std::string("format = \"ropewalk-scene-1\"\nname = \"") + s.name + "\"\n" + s.head +
         "[state]\nfile = \"tubes.csv\"\n[start]\ntemperature_K = 200\nmay_cool = true\n"
         "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 5\nbond_damping_per_ps = 0.5\n"
         "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = [0]\nforce_nN = [0.02, -0.03, 0.01]\n"
         "[[load]]\nkind = \"torque\"\ntubes = [0]\nelements = [-1]\ntorque_nN_nm = [1, 2, 3]\n"
         "[[load]]\nkind = \"fix\"\ntubes = [0]\nelements = [2]\naxes = \"xz\"\nrotation = false\n"
         "[[load]]\nkind = \"rotate\"\ntubes = [0]\nelements = [4]\nrate_deg_per_ps = 5\nangle_deg = 30\n"
         "[run]\nduration_ps = 1000\n";
}

}  // namespace ropewalk::test
