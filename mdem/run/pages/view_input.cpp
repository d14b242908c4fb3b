#include "run/pages/view_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/page.hpp"
#include "run/pages/run_views.hpp"

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

// nN: the mean of the bonds of an element.
std::vector<double> tension_of_elements(const Topology& topology, const State& state) {
  std::vector<double> out;
  for (int t = 0; t < topology.tubes(); ++t) {
    const std::vector<double> bonds = tensions(topology, state, t);
    const std::size_t n = bonds.size();
    for (std::size_t k = 0; k <= n; ++k) {
      const double sum = (k > 0 ? bonds[k - 1] : 0) + (k < n ? bonds[k] : 0);
      out.push_back(n == 0 ? none : sum / ((k > 0) + (k < n)) / units::nN_nm);
    }
  }
  return out;
}

// Steps from neighbour to neighbour to the tube on the axis; empty where not all tubes hang together.
std::vector<int> shells_of(const LoadingReference& reference) {
  const std::size_t tubes = reference.radius.size();
  std::vector<int> shell(tubes, -1);
  std::vector<std::size_t> ring = {static_cast<std::size_t>(
      std::min_element(reference.radius.begin(), reference.radius.end()) - reference.radius.begin())};
  for (int k = 0; !ring.empty(); ++k) {
    for (const std::size_t t : ring) shell[t] = k;
    std::vector<std::size_t> next;
    for (const auto& [a, b] : reference.neighbours)
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
        if (shell[static_cast<std::size_t>(from)] == k && shell[static_cast<std::size_t>(to)] < 0)
          next.push_back(static_cast<std::size_t>(to));
    ring = std::move(next);
  }
  return std::count(shell.begin(), shell.end(), -1) > 0 ? std::vector<int>() : shell;
}

double bond_energy_of(const LogRow& r) { return r["stretch_eV"] + r["shear_eV"] + r["bend_eV"] + r["twist_eV"]; }

struct ColourField {
  ViewField field;
  std::vector<double> ElementColours::*values;
  double (*log_total)(const LogRow&);
  double unit = 1;  // of the field, in that of `values`
};

std::vector<ColourField> colour_fields() {
  const auto nothing = [](const LogRow&) { return none; };
  return {{{"Bending moment", "nN nm", "EI times curvature", false, {}, {}},
           &ElementColours::bending_moment,
           nothing,
           units::nN_nm},
          {{"Bond energy", "eV", "half of the energy of each bond of the element", false, {}, {}},
           &ElementColours::bond_energy,
           bond_energy_of},
          {{"van der Waals energy", "eV", "half of the energy of each contact of the element", false, {}, {}},
           &ElementColours::vdw_energy,
           [](const LogRow& r) { return r["vdw_eV"]; }},
          {{"Twist of the bonds", "rad", "twist angle, mean of the bonds of the element", true, {}, {}},
           &ElementColours::twist_angle,
           nothing}};
}

// Quantities that some frame lacks are left out.
std::vector<ViewField> fields_of(const StoredEvents& events, const std::vector<StoredFrame>& frames,
                                 const std::vector<LogRow>& log) {
  std::vector<ViewField> out;
  for (ColourField& colour : colour_fields()) {
    const bool all = std::none_of(frames.begin(), frames.end(),
                                  [&](const StoredFrame& f) { return (f.colours.*colour.values).empty(); });
    if (!all) continue;
    for (const StoredFrame& f : frames) {
      colour.field.values.push_back(f.colours.*colour.values);
      for (double& v : colour.field.values.back()) v /= colour.unit;
      // Times of frames are rounded.
      const auto row = std::find_if(log.begin(), log.end(), [&](const LogRow& r) {
        return r["step"] == static_cast<double>(f.state.step) && std::fabs(r["time_ps"] - f.state.time) < 1e-6;
      });
      colour.field.log_total.push_back(row == log.end() ? none : colour.log_total(*row));
    }
    out.push_back(std::move(colour.field));
  }
  ViewField tension{"Tension", "nN", "along the tube, mean of the bonds of the element; negative: pressed",
                    true,      {},   {}};
  for (const StoredFrame& f : frames) {
    tension.values.push_back(tension_of_elements(events.tubes_at(f.state.time), f.state));
    tension.log_total.push_back(none);
  }
  out.push_back(std::move(tension));
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
  for (int t = 0; t < pieces.tubes(); ++t) in.tube_radius.push_back(pieces.type_of(t).radius);
  in.stored_frames = frame_times(dir, p.topology).size();
  const std::vector<StoredFrame> frames = frames_of(dir, p.topology, evenly(in.stored_frames, most_frames));
  for (const StoredFrame& f : frames) {
    in.time_ps.push_back(f.state.time);
    in.step.push_back(f.state.step);
    in.joints.push_back(joints_of_pieces(pieces, events.tubes_at(f.state.time), f.state));
  }
  in.fields = fields_of(events, frames, read_log(dir.log()));
  const Observer observer = make_observer(scene, p);
  if (is_rope(p, observer))
    if (const std::vector<int> shells = shells_of(observer.loading); !shells.empty()) {
      std::vector<int> of_pieces;
      for (int t = 0; t < pieces.tubes(); ++t)
        of_pieces.push_back(shells[static_cast<std::size_t>(p.topology.tube_of(pieces.tube_begin[t]))]);
      in.tube_numbers.push_back({"Shell", "ring of the rope, 0: the innermost tube", of_pieces});
    }
  if (scene.sets.size() > 1) in.tube_numbers.push_back({"Type of tube", "parameter set, from 0", pieces.tube_type});
  for (const StoredEvents::Link& l : events.links())
    in.links.push_back({l.a + pieces.tube_of(l.a), l.b + pieces.tube_of(l.b), l.formed, l.broke});
  const std::vector<RopeView> ends = {view_of(events, frames.front(), none), view_of(events, frames.back(), none)};
  const double radius = p.topology.largest_radius();
  const bool film = p.topology.tubes() > 1 && !is_rope(p, observer);  // lies flat
  in.camera = film ? rope_camera(ends, radius, Vector3::UnitZ(), 1000, 1000) : rope_camera(ends, radius);
  return in;
}

}  // namespace ropewalk
