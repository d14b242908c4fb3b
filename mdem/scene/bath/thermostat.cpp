#include "scene/bath/thermostat.hpp"

#include <fmt/format.h>

#include "model/counter_random.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "scene/schedule_rows.hpp"

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
                   read_temperature)
           .of_pace(SceneKey::Pace::course),
       Key::number("coupling_per_ps", {"1/ps", 1}, Bounds::positive(1e4), &O::coupling, required("0.1"),
                   "friction: velocities decay at this rate"),
       Key::custom("seed", "", otherwise("1", "that of [start]"), "seed of its random numbers", read_seed)},
      {}};
  return table;
}

}  // namespace

DriveKind thermostat_drive() {
  return {[] { return thermostat_table().doc(); },
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            auto drive = std::make_shared<ThermostatDrive>();
            drive->options = thermostat_table().read(t, scene);
            return drive;
          }};
}

SceneTable ThermostatDrive::table() const { return thermostat_table().doc(); }

void ThermostatDrive::set_stepping(std::uint64_t lineage, Stepping& stepping) const {
  ThermostatOptions of_scene = options;
  of_scene.seed = lineage_key(options.seed, lineage);
  stepping.thermostat = make_thermostat(of_scene);
}

std::string ThermostatDrive::words() const {
  return fmt::format("thermostat: {}, {} K, coupling {:.4g} 1/ps, seed {}", options.method,
                     words_of(options.temperature), options.coupling, options.seed);
}

void ThermostatDrive::refuse(const TomlTable& top, const Scene& scene) const {
  const auto refuse = [&](const std::string& table, const char* key, const char* why) {
    throw top.table(table).error(key, fmt::format("does not go with [thermostat]: {}", why),
                                 "take one of the two away");
  };
  if (scene.run.mode == RunOptions::Mode::relax) refuse("run", "mode", "a relaxation has no temperature");
  if (scene.damping.local > 0) refuse("damping", "pfc_local", "it brakes every velocity that the bath gives");
}

}  // namespace ropewalk
