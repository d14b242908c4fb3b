#include "run/pages/run_plate.hpp"

#include <filesystem>

#include "io/numeric_errors.hpp"
#include "report/plate.hpp"
#include "run/pages/colour_fields.hpp"
#include "run/pages/run_views.hpp"

namespace ropewalk {

PlateInput plate_of(const RunDirectory& dir, const PlateOptions& o) {
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  PlateInput in;
  in.tube_radius = prepared.topology.largest_radius();
  in.shells = observer.shells;
  in.log = read_log(dir.log());
  if (std::filesystem::exists(dir.limits())) in.limits = read_limits(dir.limits()).limits;
  if (!o.curves.empty()) in.errors = rows_of_errors(dir.path, in.log);
  in.curves = o.curves;
  in.x = o.x;
  in.width = o.width;
  const StoredEvents events(dir.events(), prepared.topology);
  const std::vector<StoredFrame> frames = frames_at(dir, prepared.topology, o.at, o.usual);
  for (const StoredFrame& frame : frames) {
    const RopeObservation seen = observe(observer, scene, events.tubes_at(frame.state.time), frame.state);
    const double beta = seen.beta / units::degree;
    in.views.push_back(view_of(events, frame, beta));
    if (o.sections && !seen.middle.points.empty())
      in.sections.push_back({frame.state.time, beta, seen.middle, seen.radius_profile});
  }
  if (in.sections.size() != in.views.size()) in.sections.clear();
  if (!o.colour.empty()) colour_by(o.colour, events, frames, scene, prepared, in.views);
  in.camera =
      camera_from(o.from, in.views, in.tube_radius, o.width - 20 - (in.sections.empty() ? 0 : 164), o.highest);
  return in;
}

std::string run_plate(const RunDirectory& dir, const PlateOptions& options) {
  return plate_svg(plate_of(dir, options));
}

}  // namespace ropewalk
