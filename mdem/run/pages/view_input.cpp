#include "run/pages/view_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/page.hpp"
#include "run/pages/colour_fields.hpp"
#include "run/pages/run_views.hpp"
#include "run/results.hpp"

namespace ropewalk {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// The ends of the elements: those of neighbours in a tube meet halfway.
std::vector<Vector3> joints_of(const Topology& topology, const State& state) {
  std::vector<Vector3> out;
  for (int t = 0; t < topology.tubes(); ++t) {
    const double half = 0.5 * topology.type_of(t).element_length;
    const auto end = [&](int e, double side) -> Vector3 {
      const auto i = static_cast<std::size_t>(e);
      return state.position[i] + side * half * axis_of(state.orientation[i]);
    };
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    for (int e = from; e <= to; ++e)
      out.push_back(e == from ? end(e, -1) : e == to ? end(e - 1, 1) : Vector3(0.5 * (end(e - 1, 1) + end(e, -1))));
  }
  return out;
}

// The joints of tubes that break into `pieces` later. Two pieces that `now` still has as one tube share their
// joint.
std::vector<Vector3> joints_of_pieces(const Topology& pieces, const Topology& now, const State& state) {
  const std::vector<Vector3> joints = joints_of(now, state);
  std::vector<Vector3> out;
  for (int t = 0; t < pieces.tubes(); ++t) {
    const int from = pieces.tube_begin[t], to = pieces.tube_begin[t + 1];
    out.push_back(joints[static_cast<std::size_t>(from + now.tube_of(from))]);
    for (int e = from; e < to; ++e) out.push_back(joints[static_cast<std::size_t>(e + now.tube_of(e) + 1)]);
  }
  return out;
}

}  // namespace

ViewInput view_input(const RunDirectory& dir, const Scene& scene, const Prepared& p, std::size_t most_frames) {
  ViewInput in;
  in.name = scene.name;
  const StoredEvents events(dir.events(), p.topology);
  // The page draws each tube in the parts into which it has broken by the end of the run. Until a bond breaks, the
  // parts on both sides of it share a joint.
  const Topology pieces = events.tubes_at(std::numeric_limits<double>::infinity());
  in.tube_begin = pieces.tube_begin;
  for (int t = 0; t < pieces.tubes(); ++t) {
    in.tube_radius.push_back(pieces.type_of(t).radius);
    const int first = pieces.tube_begin[t], tube = p.topology.tube_of(first);
    in.piece_of.push_back({tube, first - p.topology.tube_begin[tube]});
  }
  in.stored_frames = frame_times(dir, p.topology).size();
  const std::vector<StoredFrame> frames = frames_of(dir, p.topology, evenly(in.stored_frames, most_frames));
  for (const StoredFrame& f : frames) {
    in.time_ps.push_back(f.state.time);
    in.step.push_back(f.state.step);
    in.joints.push_back(joints_of_pieces(pieces, events.tubes_at(f.state.time), f.state));
  }
  in.fields = element_fields(events, frames, read_log(dir.log()));
  in.tube_numbers = tube_numbers(scene, p, pieces);
  for (const StoredEvents::Link& l : events.links())
    in.links.push_back({l.a + pieces.tube_of(l.a), l.b + pieces.tube_of(l.b), l.formed, l.broke});
  for (const LimitRecord& r : limits_of(dir))
    if (r.passed && r.passed_tube >= 0)
      in.marks.push_back(
          {r.key, r.passed_held_by, r.passed_at_ps, p.topology.tube_begin[r.passed_tube] + r.passed_element});
  std::stable_sort(in.marks.begin(), in.marks.end(),
                   [](const ViewMark& a, const ViewMark& b) { return a.time_ps < b.time_ps; });
  const std::vector<RopeView> ends = {view_of(events, frames.front(), none), view_of(events, frames.back(), none)};
  const double radius = p.topology.largest_radius();
  const bool film = p.topology.tubes() > 1 && !is_rope(p, make_observer(scene, p));  // lies flat
  in.camera = film ? rope_camera(ends, radius, Vector3::UnitZ(), 1000, 1000) : rope_camera(ends, radius);
  return in;
}

}  // namespace ropewalk
