// [start] the state at time zero.
#include "scene/tables/tables.hpp"

namespace ropewalk {

const KeyTable<StartOptions>& start_table() {
  using Key = KeyOf<StartOptions>;
  static const KeyTable<StartOptions> table = {
      "start",
      "the state at time zero",
      {Key::number("temperature_K", unit::kelvin, Bounds::range(0, 3000), &StartOptions::temperature, standard(),
                   "temperature of the random initial velocities; bonds at rest take half of that heat"),
       Key::boolean(
           "may_cool", &StartOptions::may_cool, standard(),
           "damping may take this heat, or that of [thermostat], away; without this key such a run is refused"),
       Key::integer("seed", 0, std::numeric_limits<long>::max(), &StartOptions::seed, standard(),
                    "seed of all random numbers: the same seed gives the same run"),
       Key::integer(
           "stream", 0, std::numeric_limits<long>::max(), &StartOptions::stream, standard(),
           "other random numbers of the motion for the same seed, on the same tubes: a sweep gives each of its "
           "points one"),
       Key::number("twist_deg_per_nm", {"deg/nm", units::degree}, Bounds::range(-30, 30), &StartOptions::turn,
                   standard(), "winding of the rope about its axis at the start, for tubes side by side"),
       Key::number("wave_nm", unit::nm, Bounds::range(0, 100), &StartOptions::wave, standard(),
                   "all tubes side by side begin as one sine wave, displaced in x by this amplitude"),
       Key::integer("half_waves", 1, 1000, &StartOptions::half_waves, standard(),
                    "number of half waves of wave_nm, from end to end")},
      {}};
  return table;
}

}  // namespace ropewalk
