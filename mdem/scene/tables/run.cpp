// [run] what to do.
#include <fmt/format.h>

#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

using Mode = RunOptions::Mode;

// Refuses keys that have no effect in the chosen mode: whoever wrote them expects one.
void read_mode(const TomlTable& t, const Scene&, RunOptions& r) {
  r.mode = t.word_or("mode", r.mode, Words<Mode>{{"dynamics", Mode::dynamics}, {"relax", Mode::relax}});
  const bool relax = r.mode == Mode::relax;
  const std::vector<const char*> others =
      relax ? std::vector<const char*>{"duration_ps"}
            : std::vector<const char*>{"solver", "force_tolerance_nN", "energy_tolerance", "max_steps"};
  for (const char* key : others)
    if (t.has(key))
      throw t.error(key, fmt::format("belongs to mode = \"{}\"", relax ? "dynamics" : "relax"),
                    fmt::format("take it away, or change the mode, now \"{}\"", relax ? "relax" : "dynamics"));
}

void read_time_step(const TomlTable& t, const Scene&, RunOptions& r) {
  r.time_step = t.is_string("time_step_fs") ? t.word("time_step_fs", Words<double>{{"auto", 0.0}})
                                            : t.number_or("time_step_fs", 0, Bounds::positive(1000)) * units::fs;
}

void check_run_keys(const TomlTable& t, const Scene&, RunOptions& r) {
  if (t.has("contact_every"))
    throw t.error("contact_every", "was removed: two-level steps were faster in no scene that was measured",
                  "take it away; time_step_fs is the step of bonds and contact");
  const char* used = r.stepping.runge_kutta ? "integrator" : r.mass_scale != 1 ? "mass_scale" : nullptr;
  if (r.mode == Mode::relax && used)
    throw t.error(used, "belongs to mode = \"dynamics\"", "take it away: relaxation does not depend on it");
}

}  // namespace

const KeyTable<RunOptions>& run_table() {
  using R = RunOptions;
  using Key = KeyOf<RunOptions>;
  const Bounds time = Bounds::positive(longest_time);
  static const KeyTable<R> table = {
      "run",
      "what to do",
      {Key::custom("mode", "", standard("\"dynamics\""),
                   "\"dynamics\", or \"relax\": to a state of rest, under the loads as they are in the end",
                   read_mode),
       Key::word("solver",
                 Words<R::Solver>{
                     {"fire", R::Solver::fire}, {"newton", R::Solver::newton}, {"auto", R::Solver::automatic}},
                 &R::solver, standard(),
                 "relax: \"fire\" follows the forces; \"newton\" uses the tangent stiffness, for ropes near "
                 "equilibrium and under couples; \"auto\": FIRE while contacts form, then Newton"),
       Key::custom(
           "time_step_fs", "fs", standard("\"auto\""),
           "\"auto\": 0.9 of the stability limit; 0.6 for a scene that begins with a state file, has may_cool or "
           "relaxes; so short in a warm scene that positions are at most 2 % hotter than velocities",
           read_time_step),
       Key::word(
           "integrator", Words<bool>{{"verlet", false}, {"rk4", true}},
           [](auto& r) -> auto& { return r.stepping.runge_kutta; }, standard(),
           "\"rk4\": rotations by 4th-order Runge-Kutta, as in PFC3D, for comparison"),
       Key::number("mass_scale", unit::none, Bounds::range(1e-3, 1e6), &R::mass_scale, standard(),
                   "multiplies all masses: time steps grow by its square root, waves slow down by it, and "
                   "equilibrium states stay the same"),
       Key::number("duration_ps", unit::ps, time, &R::duration,
                   otherwise("100", "until [twist] and all grips have done what they do"),
                   "dynamics: simulated time")
           .of_pace(SceneKey::Pace::time),
       Key::number("frames_every_ps", unit::ps, time, &R::frames_every, otherwise("1", "40 frames"),
                   "time between stored frames")
           .of_pace(SceneKey::Pace::time),
       Key::word("frames_format", Words<FrameFormat>{{"gsd", FrameFormat::gsd}, {"lammpstrj", FrameFormat::dump}},
                 &R::frames_format, standard(),
                 "\"gsd\": binary, for OVITO and MDAnalysis; \"lammpstrj\": text, for LAMMPS and ASE as well, four "
                 "times as large"),
       Key::number("log_every_ps", unit::ps, time, &R::log_every, otherwise("0.1", "400 rows"),
                   "time between rows of the log")
           .of_pace(SceneKey::Pace::time),
       Key::number("checkpoint_every_s", unit::seconds, Bounds::positive(1e6), &R::checkpoint_every, standard(),
                   "wall time between checkpoints"),
       Key::number(
           "force_tolerance_nN", unit::nN, Bounds::range(1e-15, 1), [](auto& r) -> auto& { return r.goal.force; },
           otherwise("1.6022e-5", "1e-4 eV/nm"),
           "relax: done when no force, and no torque over the radius of its tube, is larger"),
       Key::number(
           "energy_tolerance", unit::none, Bounds::range(1e-9, 1), [](auto& r) -> auto& { return r.goal.energy; },
           standard(),
           "relax: done when, in addition, the energy of the bonds is estimated to be within this fraction of its "
           "value at the minimum"),
       Key::integer("max_steps", 1, 1000000000, &R::max_steps, standard(), "relax: give up after so many steps")},
      check_run_keys};
  return table;
}

}  // namespace ropewalk
