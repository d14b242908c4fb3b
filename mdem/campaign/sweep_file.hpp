// The file of a campaign: a scene, and the keys that vary.
//
//   format = "ropewalk-sweep-1"
//   scene = "rope.toml"          # looked for beside this file
//   combine = "grid"             # every value with every other, or "zip": the first values, the second ones, ...
//   replicates = 3               # each point with start.seed 1, 2, 3
//   common_noise = true          # all points have the random numbers of one; without it each has its own
//   [vary]
//   rope.tubes = [7, 19, 37]
//   thermostat.temperature_K = { from = 200, to = 400, points = 5 }   # or step = 50; log = true: even ratios
//   [threshold]                  # for `ropewalk threshold`: at each point, where this key begins to do this
//   key = "twist.moment_nN_nm"
//   from = 10
//   to = 60
//   column = "amplitude_nm"
//   above = 1
//   accuracy = 0.02            # or, in place of column and above: shape = "helix"
//   [branch]                     # points that differ only below here share one run up to this time
//   at_ps = 135
//   [branch.vary]
//   damping.contact_viscosity_eV_ps_per_nm3 = [11, 27]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace ropewalk {

struct SweepAxis {
  std::string key;                  // "rope.tubes"
  std::vector<std::string> values;  // as TOML
  int line = 0;                     // line in the file of the sweep
};

// [threshold] the critical value of a key, for `ropewalk threshold`.
struct ThresholdQuestion {
  std::string key, column = "amplitude_nm";
  double from = 0, to = 0;
  double above = 1;                     // bound in the unit of the column
  std::optional<RopeShape> shape = {};  // that the rope takes, in place of a column that passes a value
  double accuracy = 0.02;               // the bracket is narrowed to this part of its middle
};

struct Sweep {
  std::string path, text;
  std::string scene_path, scene_text;
  bool zip = false;
  int replicates = 0;                        // 0: the seed is not varied
  bool common_noise = false;                 // points that differ in more than the seed share random numbers
  std::vector<SweepAxis> axes, branch_axes;  // in the order of the file; the seed is the last of `axes`
  double branch_at = 0;                      // ps; 0: nothing is shared
  std::optional<ThresholdQuestion> threshold;
  std::vector<std::string> keys() const;      // keys of all axes
  bool varies(const std::string& key) const;  // has more than one value
};

// Throws InputError for anything that is not right, unknown keys of the sweep included.
Sweep read_sweep(const std::string& path);
// `scene` is read instead of the one that the text names where it is not empty.
Sweep sweep_of_text(const std::string& text, const std::string& path, const std::string& scene = "");

struct SweepPoint {
  std::string name;                 // name of its directory: "tubes-7_seed-1"
  std::vector<std::string> values;  // values of keys(), as TOML
  std::string text;                 // its scene
  std::string start;                // name of the run that it goes on from; empty: none
  // Found out where its scene was checked:
  std::vector<std::string> sets;   // files of the parameter sets
  std::vector<std::string> files;  // that drives were read from
  std::string state;               // file of the start; empty: the scene makes it
  double work = 0;                 // elements times ps, which the time of a run goes by; a guess for relaxations
};

// What is found out about the points; each takes more time than the one before.
enum class PointsAs {
  names,   // with values and starts, and without scenes
  scenes,  // their texts
  read,    // every scene is read once, so that a key or a value that is wrong is found: InputError
  built,   // and made, as at the begin of a run
};
std::vector<SweepPoint> points_of(const Sweep& sweep, PointsAs as = PointsAs::built);
// Makes the same of a point that is known by name.
void complete(const Sweep& sweep, SweepPoint& point, PointsAs as = PointsAs::built);
// The runs with which the branches of these points begin, each listed once.
std::vector<SweepPoint> starts_of(const Sweep& sweep, const std::vector<SweepPoint>& points);

// Points that differ in their seed alone.
struct Replicates {
  // "tubes = 7, moment_nN_nm = 35": the keys that have more than one value. Without such keys, "4 seeds".
  std::string name;
  std::vector<std::string> values;  // values of the keys without the seed
  std::vector<SweepPoint> points;
};
// One entry for each setting, in the order of the points.
std::vector<Replicates> replicates_of(const Sweep& sweep, const std::vector<SweepPoint>& points);
// Whether two scenes that differ in their seeds move apart: by random places, velocities or strengths at the start,
// or by random numbers on the way. Both are prepared.
bool seeds_differ(Scene& one, Scene& other);
// Why replicates would be one and the same run, and their scatter no error; empty: they differ. Two seeds of the
// first point are built.
std::string why_replicates_are_equal(const Sweep& sweep, const std::vector<SweepPoint>& points);

// "moment_nN_nm" of "twist.moment_nN_nm".
std::string leaf_of(const std::string& key);

// The scene of a point, as one at the sweep's scene.
Scene scene_of(const Sweep& sweep, const SweepPoint& point);

}  // namespace ropewalk
