// A scene: everything that one run needs, as plain data in internal units (eV, nm, ps, rad). The TOML keys,
// their units and defaults are listed in scene/scene_keys.cpp, and in the commented scenes that `ropewalk new`
// writes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/damping.hpp"
#include "model/parameters.hpp"
#include "observe/limits.hpp"
#include "sim/dynamics/stepping.hpp"
#include "sim/dynamics/thermostat.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

inline constexpr const char* scene_format = "ropewalk-scene-1";

// [rope] hexagonally packed parallel tubes along z, centred on the origin.
struct RopeSource {
  int tubes = 91;           // a hexagonal number 1, 7, 19, 37, 61, 91, 127, 169, 217, ...
  double length = 0;        // nm, rounded to whole elements
  double spacing = 0;       // nm; 0: that at which two tubes bind best
  double perturbation = 0;  // nm: amplitude of a random lateral displacement of every element
};

// [film] straight tubes flat in a box, at random places and angles, laid one upon another.
struct FilmSource {
  int tubes = 0;
  double length = 0;   // nm, rounded to whole elements
  double width = 0;    // nm, of the box in x
  double depth = 0;    // nm, in y
  double spacing = 0;  // nm: no two axes are closer; 0: where two crossed tubes bind best
};

// [chain] one straight tube along z.
struct ChainSource {
  int elements = 0;
};

// [state] arbitrary elements from a CSV file: tube,x_nm,y_nm,z_nm,qw,qx,qy,qz.
struct StateSource {
  std::string file;
};

struct ContactOptions {
  enum class Law { none, paper, line };
  Law law = Law::paper;
  bool legacy_torque = false;
  int exclude_along_tube = 20;  // pairs of one tube up to this many elements apart do not interact
  double skin = 0;              // nm; 0: chosen by the program
  double cutoff = 0;            // nm, of axes (`line`) or element centres (`paper`); 0: the set's
  int nodes = 0;                // `line`: per element; 0: as line_nodes chooses
  bool all_nodes = false;       // `line`: no sparse sums
  // Pairs in single precision or all in double; the former by default where nothing is relaxed to tight tolerances.
  std::optional<Interaction::Precision> precision;
};

inline const char* law_name(ContactOptions::Law law) {
  return law == ContactOptions::Law::line ? "line" : law == ContactOptions::Law::paper ? "paper" : "none";
}

// Elements that a load acts on: every combination of a tube and an element index; negative indices count
// from the end of the tube.
struct Selection {
  bool all_tubes = true;
  std::vector<int> tubes;
  bool all_elements = false;
  std::vector<int> elements;
};

// [[load]] entries.
struct FixLoad {  // hold where it is
  bool x = true, y = true, z = true, rotation = true;
};
struct ForceLoad {
  Vector3 force = Vector3::Zero();  // eV/nm on each element
};
struct TorqueLoad {
  Vector3 torque = Vector3::Zero();  // eV on each element
};
struct RotateLoad {  // prescribed rotation of the selected elements as one body about a line along z
  double rate = 0;   // rad/ps
  double angle = 0;  // rad: stop there
  Vector3 centre = Vector3::Zero();
  bool axial_free = true;  // z coordinate free
  bool spin_free = false;  // element free to turn about its own axis
};
struct Load {
  Selection on;
  std::variant<FixLoad, ForceLoad, TorqueLoad, RotateLoad> kind;
};

// [twist] the two-stage protocol: the moment on the grip elements (first and last of every tube; + at the
// upper end, - at the lower) is ramped at a rate and then held.
struct TwistProtocol {
  enum class Reading { per_tube, total };         // is the moment that of each grip element, or of all of them
  enum class Application { couple, tangential };  // a couple on each element, or tangential forces on the grip
  double moment = 0;                              // eV
  double rate = 0;                                // eV/ps
  double hold = 0;                                // ps after the ramp
  Reading reading = Reading::per_tube;
  Application application = Application::couple;
  bool lateral_free = true;
  bool axial_free = true;
  bool geometric_only = false;  // relax every spin about the tube axis at each increment
  double increment = 1.0;       // ps between such relaxations

  double ramp_time() const { return rate > 0 ? moment / rate : 0.0; }
};

struct RunOptions {
  enum class Mode { dynamics, relax };
  Mode mode = Mode::dynamics;
  double time_step = 0;  // ps, of bonds; 0: chosen from the stiffest mode
  Stepping stepping;
  double mass_scale = 1;          // of masses and inertias
  double duration = 0;            // ps; 0 with [twist]: ramp plus hold
  double frames_every = 0;        // ps; 0: 40 frames
  double log_every = 0;           // ps; 0: 400 rows
  double checkpoint_every = 60;   // s of wall time
  double force_tolerance = 1e-4;  // eV/nm, relax mode
  long max_steps = 200000;        // relax mode
  bool paraview = false;          // also write VTP/PVD
};

struct ObserveOptions {
  double neighbour_radius = 0;  // nm; 0: midway between first and second shell of the hexagonal packing
};

// [limits] what the run watches, in the order of limit_kinds(); those that are not typed are default_limits().
using LimitOptions = std::array<std::optional<double>, limit_count>;

struct Scene {
  std::string name;
  std::string path;
  std::string text;                // the file as read, for the copy in the run directory
  std::string hash;                // xxh64 of text, hex
  std::vector<ParameterSet> sets;  // of the tube types; never empty
  std::vector<int> tube_types;     // of each tube, an index of `sets`; empty: all are of the first
  double element_length = 0;       // nm
  std::variant<RopeSource, FilmSource, ChainSource, StateSource> source;
  double temperature = 0;  // K, initial
  std::uint64_t seed = 1;
  ContactOptions contact;
  Damping damping;
  std::vector<Load> loads;
  std::optional<TwistProtocol> twist;
  std::optional<ThermostatOptions> thermostat;
  RunOptions run;
  ObserveOptions observe;
  LimitOptions limits;

  const ParameterSet& parameters() const { return sets.front(); }
};

}  // namespace ropewalk
