#include "scene/scene_keys.hpp"

#include <fmt/format.h>

namespace ropewalk {

const std::vector<SceneTable>& scene_tables() {
  static const std::vector<SceneTable> tables = {
      {"", "the top of the file, before the first table"},
      {"rope", "parallel tubes along z in hexagonal packing, centred on the origin"},
      {"film", "instead of [rope]: straight tubes at random in a box, flat in x and y, laid one upon another"},
      {"chain", "instead of [rope]: one straight tube along z"},
      {"state", "instead of [rope]: elements from a CSV file tube,x_nm,y_nm,z_nm,qw,qx,qy,qz"},
      {"start", "the state at time zero"},
      {"contact", "van der Waals contact between elements"},
      {"damping", "dissipation; 0 switches a term off"},
      {"thermostat", "a bath that keeps the temperature; without this table there is none"},
      {"twist", "the grips (first and last element of every tube) are twisted about z, + at the upper end"},
      {"load", "any number of these: what else acts on elements"},
      {"run", "what to do"},
      {"observe", "what to measure"},
      {"limits", "the run says so at once where it passes one of these; 0: not watched"},
  };
  return tables;
}

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = {
      {"", "format", "", "\"ropewalk-scene-1\"", "required", "the version of this format"},
      {"", "name", "", "\"my rope\"", "the file's name", "title in reports"},
      {"", "parameters", "", "\"cnt-10-10-paper\"", "required",
       "the tube: a file, looked for beside the scene, or the name of a shipped set; [\"a\", \"b\"]: tube types"},
      {"", "tube_types", "", "[0, 1, 1]", "all of the first", "which of the sets each tube is, from 0"},
      {"", "element_length_nm", "nm", "1.356", "the set's", "length of an element; law \"paper\" needs the set's"},

      {"rope", "tubes", "", "91", "required", "a hexagonal number: 1, 7, 19, 37, 61, 91, 127, 169, 217, ..."},
      {"rope", "length_nm", "nm", "67.8", "required", "length of the tubes, rounded to whole elements"},
      {"rope", "spacing_nm", "nm", "1.713", "where two tubes bind best", "distance between tube axes"},
      {"rope", "perturbation_nm", "nm", "0", "", "each element is displaced at random by up to this in x and y"},

      {"film", "tubes", "", "100", "required", "number of tubes"},
      {"film", "length_nm", "nm", "68.9", "required", "length of the tubes, rounded to whole elements"},
      {"film", "width_nm", "nm", "150", "required", "side of the box in x, not shorter than the tubes"},
      {"film", "depth_nm", "nm", "100", "required", "side of the box in y, not shorter than the tubes"},
      {"film", "spacing_nm", "nm", "1.7", "where two crossed tubes bind best",
       "no two tube axes are closer at the start"},

      {"chain", "elements", "", "41", "required", "number of elements, 2 or more"},

      {"state", "file", "", "\"state.csv\"", "required", "looked for beside the scene"},

      {"start", "temperature_K", "K", "0", "", "temperature of the random initial velocities"},
      {"start", "seed", "", "1", "", "of all random numbers: the same seed gives the same run"},

      {"contact", "law", "", "\"paper\"", "what the set has", "\"line\" (first choice), \"paper\" or \"none\""},
      {"contact", "nodes_per_element", "", "6", "for a corrugation below 1e-3", "line: nodes along an element"},
      {"contact", "all_nodes", "", "false", "",
       "line: all nodes towards nearly parallel elements too, which keeps the symmetry of a rope; two to three "
       "times the cost"},
      {"contact", "precision", "", "\"mixed\"", "mixed; double for mode = \"relax\"",
       "\"mixed\" (pairs in single precision) or \"double\""},
      {"contact", "legacy_torque", "", "false", "",
       "leave out the torque that the published code leaves out; gains energy, for comparison only"},
      {"contact", "cutoff_nm", "nm", "2.5", "the set's",
       "line: of tube axes, paper: of element centres; shorter is faster and binds less"},
      {"contact", "exclude_along_tube_elements", "elements", "20", "",
       "elements of one tube up to this far apart do not touch"},
      {"contact", "skin_nm", "nm", "0.15", "chosen by the program", "margin of the neighbour list; speed only"},

      {"damping", "contact_viscosity_eV_ps_per_nm2", "eV ps/nm^2", "20", "", "against sliding at contact points"},
      {"damping", "bond_damping_per_ps", "1/ps", "1", "", "against relative motion of bonded elements"},
      {"damping", "pfc_local", "", "0", "", "PFC3D's local damping, 0 to 1; breaks momentum conservation"},

      {"thermostat", "method", "", "\"langevin\"", "",
       "\"langevin\": friction and noise on translation and rotation"},
      {"thermostat", "temperature_K", "K", "300", "required", "temperature of the bath"},
      {"thermostat", "coupling_per_ps", "1/ps", "0.1", "required", "friction: velocities decay at this rate"},
      {"thermostat", "seed", "", "1", "that of [start]", "of its random numbers"},

      {"twist", "moment_nN_nm", "nN nm", "35", "required", "moment at the end of the ramp"},
      {"twist", "rate_nN_nm_per_ps", "nN nm/ps", "1", "required", "rate of the ramp; 0: the moment acts at once"},
      {"twist", "hold_ps", "ps", "0", "", "time under the full moment, after the ramp"},
      {"twist", "reading", "", "\"per-tube\"", "", "the moment is that of each grip element, or of all: \"total\""},
      {"twist", "application", "", "\"couple\"", "",
       "a couple on each grip element, or \"tangential\" forces about the rope's axis"},
      {"twist", "lateral", "", "\"free\"", "", "\"held\": the middle of a grip stays on the axis"},
      {"twist", "axial", "", "\"free\"", "", "\"held\": grip elements keep their z"},
      {"twist", "geometric_only", "", "false", "", "relax the tubes' own twist at each increment"},
      {"twist", "increment_ps", "ps", "1", "", "time between such relaxations"},

      {"load", "kind", "", "\"fix\"", "required", "\"fix\", \"force\", \"torque\" or \"rotate\""},
      {"load", "tubes", "", "\"all\"", "", "\"all\" or numbers from 0: [0, 3]"},
      {"load", "elements", "", "\"ends\"", "required",
       "\"all\", \"ends\" or numbers from 0, negative from the end"},
      {"load", "axes", "", "\"xyz\"", "", "fix: coordinates that are held"},
      {"load", "rotation", "", "true", "", "fix: orientation is held"},
      {"load", "force_nN", "nN", "[0.01, 0, 0]", "required by force", "force on each element"},
      {"load", "torque_nN_nm", "nN nm", "[0, 0, 1]", "required by torque", "torque on each element"},
      {"load", "rate_deg_per_ps", "deg/ps", "1", "required by rotate",
       "rotate: speed of the prescribed rotation about z, negative: left-handed"},
      {"load", "angle_deg", "deg", "360", "required by rotate", "rotate: where it stops"},
      {"load", "centre_nm", "nm", "[0, 0]", "", "rotate: x and y of the axis"},
      {"load", "axial_free", "", "true", "", "rotate: z is free"},
      {"load", "spin_free", "", "false", "", "rotate: elements may turn about their own axes"},

      {"run", "mode", "", "\"dynamics\"", "", "\"dynamics\", or \"relax\": to the nearest minimum of the energy"},
      {"run", "time_step_fs", "fs", "\"auto\"", "",
       "\"auto\": 0.9 of the stability limit; 0.6 where warm, from a state file, with contact_every, or to relax"},
      {"run", "contact_every", "", "1", "",
       "contact acts every so many steps of the bonds (r-RESPA); pays where elements are short and bonds therefore "
       "stiffer than contact; log and frames go by these longer steps"},
      {"run", "integrator", "", "\"verlet\"", "",
       "\"rk4\": rotations by 4th-order Runge-Kutta, as in PFC3D, for comparison"},
      {"run", "mass_scale", "", "1", "",
       "masses times this: steps grow and waves slow down by its root, kinetic energies at a given speed grow by "
       "it and "
       "at a given temperature stay; statics stay"},
      {"run", "duration_ps", "ps", "100", "ramp and hold of [twist]", "dynamics: simulated time"},
      {"run", "frames_every_ps", "ps", "1", "40 frames", "time between stored frames"},
      {"run", "log_every_ps", "ps", "0.1", "400 rows", "time between rows of the log"},
      {"run", "checkpoint_every_s", "s", "60", "", "wall time between checkpoints"},
      {"run", "force_tolerance_nN", "nN", "1.6022e-5", "1e-4 eV/nm", "relax: done when no force is larger"},
      {"run", "max_steps", "", "200000", "", "relax: give up after so many steps"},
      {"run", "paraview", "", "false", "", "also write frames for ParaView (VTP)"},

      {"observe", "neighbour_radius_nm", "nm", "2.34", "between first and second shell",
       "tubes closer than this are neighbours"},

      {"limits", "bend_deg", "deg", "19.9", "", "bend of one bond: its energy is then 1 % off the rod's"},
      {"limits", "twist_deg", "deg", "19.9", "", "twist of one bond: likewise; at 90 it slips"},
      {"limits", "kink_curvature_per_nm", "1/nm", "0.086", "the set's", "curvature of a tube"},
      {"limits", "wall_twist", "", "0.043", "the set's twist_collapse",
       "radius of a tube times its twist per length"},
      {"limits", "strain", "", "0.069", "the set's stretch", "of a bond, tension or compression"},
      {"limits", "press_nm", "nm", "0.11", "down to the core gap of the law",
       "how much nearer than at rest tubes are pressed"},
      {"limits", "speed_nm_per_ps", "nm/ps", "2", "a tenth of the speed of sound along the tube", "of an element"},
  };
  return keys;
}

std::string scene_key_help() {
  std::string text = "Keys of a scene (TOML); `ropewalk new` writes commented ones.\n";
  for (const SceneTable& t : scene_tables()) {
    text += t.name.empty() ? fmt::format("\n{}\n", t.meaning) : fmt::format("\n{}  {}\n", t.header(), t.meaning);
    for (const SceneKey& k : scene_keys())
      if (k.table == t.name)
        text += fmt::format("  {:31} {:10} {:30} {}\n", k.key, k.unit, k.standard.empty() ? k.value : k.standard,
                            k.meaning);
  }
  return text;
}

}  // namespace ropewalk
