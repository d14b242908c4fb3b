// `observe`: the geometry of the stored frames.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands/console_table.hpp"
#include "commands/verb.hpp"
#include "io/frames/frames.hpp"
#include "io/tube_table.hpp"
#include "model/error.hpp"
#include "observe/observables.hpp"
#include "run/events_file.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

struct ObserveArguments {
  std::string dir;
  double neighbour_radius = -1;  // nm; -1: the scene's
  bool json = false;
  bool list = false;   // only the table of observables
  bool tubes = false;  // every tube of the last frame, as CSV
};

using Json = nlohmann::ordered_json;

std::vector<Observable> observables_of_frames() {
  std::vector<Observable> chosen;
  for (const Observable& o : observables())
    if (in_frames(o.group)) chosen.push_back(o);
  return chosen;
}

Json as_json(const Measurement& m, const std::vector<Observable>& chosen) {
  Json out;
  for (const Observable& observable : chosen) {
    const double value = observable.value(m);
    if (observable.whole && std::isfinite(value)) {
      out[observable.name] = static_cast<std::int64_t>(value);
    } else {
      out[observable.name] = value;
    }
  }
  const RopeObservation& o = m.rope;
  out["radius_profile_nm"] = o.radius_profile;
  Json line = Json::array();
  for (const Vector3& c : o.centre_line) line.push_back({c.x(), c.y(), c.z()});
  out["centre_line_nm"] = std::move(line);
  Json section = Json::array();
  for (std::size_t k = 0; k < o.middle.points.size(); ++k)
    section.push_back({{"x_nm", o.middle.points[k].x()},
                       {"y_nm", o.middle.points[k].y()},
                       {"neighbours", o.middle.neighbours[k]},
                       {"delaunay", o.middle.delaunay[k]}});
  out["section"] = std::move(section);
  return out;
}

int observe_command(const ObserveArguments& a) {
  if (a.list) {
    fmt::print("{}", observables_markdown());
    return 0;
  }
  if (a.dir.empty())
    throw InputError({"", 0, "dir"}, "is missing", "name the directory of a run, or see `ropewalk observe --list`");
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  if (!scene.missing_forces.empty())
    fmt::print(stderr, "ropewalk: note: The run had forces of one's own, in Python: {}.\n", scene.missing_forces);
  if (a.neighbour_radius > 0) scene.observe.neighbour_radius = a.neighbour_radius;
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  const auto reader = open_frames(dir.frames());
  const std::vector<Observable> chosen = observables_of_frames();
  const Console console(chosen);
  const StoredEvents breaks(dir.events(), prepared.topology);
  if (a.tubes) {
    const std::optional<StoredFrame> last = last_frame(dir.frames(), prepared.topology);
    if (!last)
      throw InputError({dir.frames(), 0, ""}, "holds no frame", "run the scene further with `ropewalk resume`");
    const Topology now = breaks.tubes_at(last->state.time);
    fmt::print("{}", tube_table_csv(now, last->state, of_parts(observer.loading, prepared.topology, now)));
    return 0;
  }
  if (!a.json) console.print_heading();
  Json all = Json::array();
  const EnergyAccount none;
  StoredFrame frame;
  while (reader->next(prepared.topology, frame)) {
    const Topology now = breaks.tubes_at(frame.state.time);
    const RopeObservation rope = observe(observer, scene, now, frame.state);
    const Loading load = loading(now, frame.state, observer.loading);
    const Measurement measurement{now, frame.state, rope, load, observer.size, none};
    if (a.json) {
      all.push_back(as_json(measurement, chosen));
    } else {
      console.print_row(measurement);
    }
  }
  if (a.json) fmt::print("{}\n", all.dump(1));
  return 0;
}

}  // namespace

void add_observe(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ObserveArguments>();
  CLI::App* c = app.add_subcommand("observe", "Measure the stored frames of a run: twist, packing, shape");
  c->add_option("dir", a->dir, "Directory of the run");
  c->add_flag("--list", a->list, "List the observables: name, unit, meaning (Markdown)");
  c->add_option("--neighbour-radius", a->neighbour_radius,
                "Tubes closer than this are neighbours (nm) [default: the scene's]")
      ->check(number_within(Bounds::positive()));
  c->add_flag("--json", a->json, "JSON, with radius profile and centre line");
  c->add_flag("--tubes", a->tubes,
              "Every tube of the last frame, as CSV: tension, twist, curvature, slip, pressure");
  c->callback([a, &program] { program.code = observe_command(*a); });
}

}  // namespace ropewalk
