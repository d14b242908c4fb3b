// `observe`: the geometry of the stored frames.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "io/frames.hpp"
#include "plan/planner.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const State& s, const RopeObservation& o) {
  Json out;
  out["time_ps"] = s.time;
  out["step"] = s.step;
  out["beta_deg"] = o.beta / units::degree;
  out["physical_twist_deg"] = o.physical_twist / units::degree;
  out["geometric_twist_deg"] = o.geometric_twist / units::degree;
  out["Q"] = o.middle.charge;
  out["Q_delaunay"] = o.middle.charge_delaunay;
  out["contacts"] = o.middle.contacts;
  out["voids"] = o.middle.voids;
  out["void_area_nm2"] = o.middle.void_area;
  out["radius_mid_nm"] = o.radius_mid;
  out["radius_end_nm"] = o.radius_end;
  out["length_nm"] = o.length;
  out["amplitude_nm"] = o.amplitude;
  out["windings"] = o.windings;
  out["kinked"] = o.kinked;
  out["overtwisted"] = o.overtwisted;
  out["overstretched"] = o.overstretched;
  out["largest_bond_twist_deg"] = o.largest_bond_twist / units::degree;
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

void print_row(const State& s, const RopeObservation& o) {
  const double deg = units::degree;
  fmt::print(
      "{:9.2f} {:7.2f} {:9.1f} {:9.1f} {:4d} {:4d} {:8d} {:5d} {:8.2f} {:7.2f} {:7.2f} {:9.2f} {:8.2f} {:6d} "
      "{:6d}\n",
      s.time, o.beta / deg, o.physical_twist / deg, o.geometric_twist / deg, o.middle.charge,
      o.middle.charge_delaunay, o.middle.contacts, o.middle.voids, o.middle.void_area, o.radius_mid, o.radius_end,
      o.amplitude, o.windings, o.kinked, o.overtwisted);
}

}  // namespace

int observe_command(const ObserveArguments& a) {
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  if (a.neighbour_radius > 0) scene.observe.neighbour_radius = a.neighbour_radius;
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  DumpReader reader(dir.frames());
  Json all = Json::array();
  if (!a.json)
    fmt::print(
        "  time_ps beta_deg  physical geometric    Q Qdel contacts voids void_nm2  mid_nm  end_nm amplitude "
        "windings "
        "kinked otwist\n");
  DumpFrame frame;
  while (reader.next(prepared.topology, frame)) {
    const RopeObservation o = look(observer, scene, prepared.topology, frame.state);
    if (a.json) {
      all.push_back(as_json(frame.state, o));
    } else {
      print_row(frame.state, o);
    }
  }
  if (a.json) fmt::print("{}\n", all.dump(1));
  if (a.json || expectations_of(scene.text).errors.empty()) return 0;
  fmt::print("\nThis run was planned; held against a finer model:\n");
  PlanArguments check;
  check.check = a.dir;
  return plan_command(check);
}

}  // namespace ropewalk
