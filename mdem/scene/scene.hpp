// A scene: everything that one run needs, in internal units (eV, nm, ps, rad). The TOML keys, their units and
// defaults stand with the reader of each table: scene/tables/, scene/kinds/ and scene/loads/.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/frames/format.hpp"
#include "model/damping.hpp"
#include "model/parameters.hpp"
#include "observe/limits.hpp"
#include "scene/drive.hpp"
#include "scene/expectation.hpp"
#include "scene/source.hpp"
#include "scene/stop_rule.hpp"
#include "sim/dynamics/relax_goal.hpp"
#include "sim/dynamics/stepping.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

inline constexpr const char* scene_format = "ropewalk-scene-1";

struct StartOptions {
  double temperature = 0;  // temperature of the initial velocities, K
  bool may_cool = false;   // damping may take that heat away
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;
  double turn = 0;     // winding of straight tubes about their axis at first, rad/nm
  double wave = 0;     // amplitude by which straight tubes are bent sideways at first, nm
  int half_waves = 1;  // along them
};

struct BondOptions {
  bool anharmonic = false;  // by the [bond.anharmonic] of the sets
};

struct ContactOptions {
  std::string law = "paper";  // a name in scene/laws/contact_law_kind.hpp, or "none"
  bool legacy_torque = false;
  double exclude_along_tube = 0;  // nm; 0: least_exclusion()
  double skin = 0;                // nm; 0: chosen by the program
  double cutoff = 0;              // cutoff between axes (`line`) or element centres (`paper`), nm; 0: the set's
  int nodes = 0;                  // `line`: per element; 0: as line_nodes chooses
  // Pairs in single precision or all in double; the former by default where nothing is relaxed to tight tolerances.
  std::optional<Interaction::Precision> precision;
};

struct RunOptions {
  enum class Mode { dynamics, relax };
  Mode mode = Mode::dynamics;
  enum class Solver { fire, newton, automatic };
  Solver solver = Solver::fire;  // relax mode
  double time_step = 0;          // ps; 0: chosen from the stiffest mode
  Stepping stepping;
  double mass_scale = 1;         // factor on masses and inertias
  double duration = 0;           // ps; 0: until all drives have ended
  double frames_every = 0;       // ps; 0: 40 frames
  double log_every = 0;          // ps; 0: 400 rows
  double checkpoint_every = 60;  // s of wall time
  RelaxGoal goal;                // relax mode
  long max_steps = 200000;       // relax mode
  FrameFormat frames_format = FrameFormat::gsd;
};

// [statics] states of rest along the schedules of the loads.
struct StaticsOptions {
  int steps = 0;  // 0: there is one state of rest, under the loads as they are in the end
};

struct ObserveOptions {
  double neighbour_radius = 0;  // nm; 0: midway between first and second shell of the hexagonal packing
};

// [limits] what the run watches, in the order of limit_kinds(); those that are not typed are default_limits().
using LimitOptions = std::array<std::optional<double>, limit_count>;

struct Scene {
  std::string name;
  std::string path;
  std::string text;                 // the file as read, for the copy in the run directory
  std::string hash;                 // xxh64 of text, hex
  std::vector<ParameterSet> sets;   // sets of the tube types; never empty
  std::vector<int> tube_types;      // of each tube, an index of `sets`; empty: all are of the first, or drawn:
  std::vector<double> type_shares;  // of each set, the part of the tubes that are of it; empty: tube_types holds
  double element_length = 0;        // nm
  std::string kind;                 // the table of its source: "rope"; empty where it was not read from a file
  std::shared_ptr<const Source> source;
  // Set by build(). Random numbers of the motion are others for another lineage (lineage_key): a scene that goes on
  // from the end of another one has other noise.
  StateMemory memory;
  std::uint64_t lineage = 0;
  StartOptions start;
  BondOptions bond;
  ContactOptions contact;
  Damping damping;
  std::vector<std::shared_ptr<const Drive>> drives;  // kind by kind, as in the register
  RunOptions run;
  StaticsOptions statics;
  ObserveOptions observe;
  LimitOptions limits;
  std::vector<StopRule> stops;
  std::vector<Expectation> expected;
  // Forces of one's own that the run of this scene had, by name (scene/missing_forces.hpp). start() refuses to go on
  // without them.
  std::string missing_forces;

  const ParameterSet& parameters() const { return sets.front(); }
  bool from_file() const { return source && !source->file().empty(); }  // a state with velocities of its own

  // The drives of one class.
  template <class D>
  std::vector<const D*> drives_of() const {
    std::vector<const D*> found;
    for (const auto& drive : drives)
      if (const auto* one = dynamic_cast<const D*>(drive.get())) found.push_back(one);
    return found;
  }
  bool has_ends(Drive::Ends ends) const {
    return std::any_of(drives.begin(), drives.end(), [&](const auto& drive) { return drive->ends() == ends; });
  }
  // Files that any drive reads.
  std::vector<std::string> files_of_drives() const {
    std::vector<std::string> all;
    for (const auto& drive : drives)
      for (const std::string& file : drive->files()) all.push_back(file);
    return all;
  }
  // Null: there is none.
  const ThermostatOptions* bath() const {
    for (const auto& drive : drives)
      if (const ThermostatOptions* found = drive->thermostat()) return found;
    return nullptr;
  }
};

}  // namespace ropewalk
