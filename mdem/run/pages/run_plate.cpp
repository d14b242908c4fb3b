#include "run/pages/run_plate.hpp"

#include "io/numeric_errors.hpp"
#include "report/plate.hpp"
#include "run/pages/run_views.hpp"

namespace ropewalk {

std::string run_plate(const RunDirectory& dir, const PlateOptions& o) {
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  PlateInput in;
  in.tube_radius = prepared.topology.largest_radius();
  in.shells = observer.shells;
  in.log = read_log(dir.log());
  if (!o.curves.empty()) in.errors = rows_of_errors(dir.path, in.log);
  in.curves = o.curves;
  in.x = o.x;
  in.width = o.width;
  const StoredEvents events(dir.events(), prepared.topology);
  for (const StoredFrame& frame : frames_at(dir, prepared.topology, o.at, o.usual)) {
    const RopeObservation seen = observe(observer, scene, events.tubes_at(frame.state.time), frame.state);
    const double beta = seen.beta / units::degree;
    in.views.push_back(view_of(events, frame, beta));
    if (o.sections && !seen.middle.points.empty())
      in.sections.push_back({frame.state.time, beta, seen.middle, seen.radius_profile});
  }
  if (in.sections.size() != in.views.size()) in.sections.clear();
  in.camera =
      camera_from(o.from, in.views, in.tube_radius, o.width - 20 - (in.sections.empty() ? 0 : 164), o.highest);
  return plate_svg(in);
}

}  // namespace ropewalk
