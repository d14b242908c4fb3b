// [thermostat] a bath that keeps the temperature.
#include "scene/schedule_rows.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

Words<std::string> methods() {
  Words<std::string> words;
  for (const ThermostatKind& kind : thermostat_kinds()) words.emplace_back(kind.name, kind.name);
  return words;
}

void read_temperature(const TomlTable& t, const Scene&, ThermostatOptions& o) {
  const Bounds bounds = Bounds::range(0, 3000);
  if (t.is_array("temperature_K"))
    o.temperature = Schedule(points_in_time(t, "temperature_K", bounds));
  else
    o.temperature = Schedule::always(t.number("temperature_K", bounds));
}

void read_seed(const TomlTable& t, const Scene& scene, ThermostatOptions& o) {
  o.seed = static_cast<std::uint64_t>(
      t.integer_or("seed", static_cast<long>(scene.start.seed), 0, std::numeric_limits<long>::max()));
}

}  // namespace

const KeyTable<ThermostatOptions>& thermostat_table() {
  using Key = KeyOf<ThermostatOptions>;
  using O = ThermostatOptions;
  static const KeyTable<O> table = {
      "thermostat",
      "a bath that keeps the temperature; without this table there is none",
      {Key::word("method", methods(), &O::method, standard(),
                 "\"langevin\": friction and noise on translation and rotation"),
       Key::custom("temperature_K", "K", required("300"),
                   "temperature of the bath; a list is points in time, [[ps, K], ...], with straight lines between",
                   read_temperature),
       Key::number("coupling_per_ps", {"1/ps", 1}, Bounds::positive(1e4), &O::coupling, required("0.1"),
                   "friction: velocities decay at this rate"),
       Key::custom("seed", "", otherwise("1", "that of [start]"), "of its random numbers", read_seed)},
      {}};
  return table;
}

}  // namespace ropewalk
