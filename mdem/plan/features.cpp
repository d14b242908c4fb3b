#include "plan/features.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plan/demands.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

// The longest of several courses tells when a limit is passed.
void add_course(const Schedule& course, SceneFeatures& f) {
  if (course.reaches() > f.course.reaches()) f.course = course;
}

// A load on elements that are no ends.
void add_load(const LoadEffect& load, const Prepared& p, SceneFeatures& f) {
  for (std::size_t axis = 0; axis < load.axes.size(); ++axis) {
    const LoadComponent& c = load.axes[axis];
    if (c.is == LoadComponent::Is::free || c.is == LoadComponent::Is::held) continue;
    add_course(c.course, f);
    const bool loaded = c.is == LoadComponent::Is::loaded;
    f.sudden = f.sudden || (loaded && c.course.reaches() <= 0);
    if (axis == LoadEffect::about_z)
      f.turn += c.course.largest() / (loaded ? p.topology.types[0].bond.twist : f.length);
  }
}

// Forces and couples on each tube of an end. Two ends that are loaded balance one another, and the larger counts.
void add_end_loads(const EndDrives& drives, const Prepared& p, SceneFeatures& f) {
  double couple = 0;
  for (std::size_t axis = 0; axis < 6; ++axis)
    for (const End end : {lower_end, upper_end}) {
      const Schedule course = load_of_each(drives, end, axis);
      if (!(course.largest() > 0)) continue;
      if (axis == LoadEffect::about_z) couple = std::max(couple, course.largest());
      add_course(course, f);
      f.sudden = f.sudden || course.reaches() <= 0;
    }
  if (!(couple > 0)) return;
  const std::optional<EndMoment> moment = end_moment(drives);
  const bool relaxes = moment && moment->relaxes_spins;
  const RopeSection::Tubes tubes = relaxes         ? RopeSection::Tubes::slide
                                   : f.length_held ? RopeSection::Tubes::cling_at_kept_length
                                                   : RopeSection::Tubes::cling;
  f.turn += RopeSection(p).winding_under(couple, p.topology.types[0].bond, relaxes, tubes);
}

// Displacements and rotations of one end against the other.
void add_end_motion(const EndDrives& drives, const Prepared& p, SceneFeatures& f) {
  for (const EndDrive& d : drives)
    for (std::size_t axis = 3; axis < LoadEffect::about_z; ++axis)
      if (d.does.axes[axis].is == LoadComponent::Is::moved) add_course(d.does.axes[axis].course, f);
  const Schedule turned = moved_apart(drives, LoadEffect::about_z);
  add_course(turned, f);
  add_course(moved_apart(drives, LoadEffect::z), f);
  f.turned = turned.largest();
  f.turning = turned.fastest();
  f.turn += f.turned / (p.topology.groups.images > 0 ? p.topology.groups.period : f.length);
}

}  // namespace

SceneFeatures features_of(const Scene& scene, const Prepared& p) {
  SceneFeatures f;
  f.tubes = p.topology.tubes();
  f.contact = p.interaction.has_contact() && f.tubes > 1;
  for (int t = 0; t < p.topology.tubes(); ++t) f.length = std::max(f.length, free_length(scene, p.topology, t));
  const EndDrives drives = end_drives(p.loads, p.topology);
  f.turned_between = is_kept_between(drives, LoadEffect::about_z);
  f.length_held = is_kept_between(drives, LoadEffect::z);
  f.prescribes_moment = end_moment(drives).has_value();
  for (const auto& load : p.loads)
    if (const auto effect = load->effect(); effect && end_drives(*load, p.topology).empty())
      add_load(*effect, p, f);
  add_end_motion(drives, p, f);
  add_end_loads(drives, p, f);
  const Demands most = DemandsAhead(scene, p).largest();
  f.curvature = most.curvature;
  f.twist = most.twist;
  f.strain = std::max(most.strain, most.pressed);
  f.pressure = most.pressure;
  return f;
}

}  // namespace ropewalk
