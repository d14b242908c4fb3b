#include "sim/dynamics/end_drives.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace ropewalk {
namespace {

using Is = LoadComponent::Is;

// Elements of a load at one end of one tube, counted from the end on without a hole.
struct TubeEnd {
  int tube = 0, count = 0;
};

std::vector<TubeEnd> tube_ends_in(const std::vector<int>& elements, const Topology& topology, End end) {
  const auto has = [&](int e) { return std::binary_search(elements.begin(), elements.end(), e); };
  std::vector<TubeEnd> found;
  for (int t = 0; t < topology.tubes(); ++t) {
    const int length = topology.length_of(t), first = topology.tube_begin[t];
    int count = 0;
    while (count < length && has(end == lower_end ? first + count : first + length - 1 - count)) ++count;
    if (count > 0 && count < length) found.push_back({t, count});
  }
  return found;
}

bool ends_rope(const Topology& topology, End end, int tube) {
  return end == lower_end ? topology.begins_strand(tube) : topology.ends_strand(tube);
}

LoadComponent times(const LoadComponent& c, double factor) {
  LoadComponent out = c;
  out.course = sum_of({{factor, c.course}});
  if (c.now) out.now = [now = c.now, factor](double time) { return factor * now(time); };
  return out;
}

EndDrive drive_at(End end, const std::vector<TubeEnd>& ends, const Topology& topology, LoadEffect effect) {
  EndDrive drive;
  drive.end = end;
  int most = 0;
  for (const TubeEnd& e : ends) {
    drive.tubes.push_back(e.tube);
    drive.at_rope_end = drive.at_rope_end && ends_rope(topology, end, e.tube);
    most = std::max(most, e.count);
  }
  for (int t = 0; t < topology.tubes(); ++t) drive.all += ends_rope(topology, end, t);
  drive.one_element = most == 1;
  for (LoadComponent& c : effect.axes) {
    c.each = c.each || ends.size() == 1;
    if (effect.by_element && most > 1 && c.is == Is::loaded) c = times(c, most);
  }
  drive.does = std::move(effect);
  return drive;
}

// The upper ends of all strands against the lower ones, which stay. What is between them counts as tied to both.
void add_between(const LoadEffect& effect, const Topology& topology, EndDrives& out) {
  std::vector<TubeEnd> all;
  for (int t = 0; t < topology.tubes(); ++t) all.push_back({t, 1});
  LoadEffect held;
  held.by = effect.by;
  for (std::size_t axis = 0; axis < held.axes.size(); ++axis)
    if (effect.axes[axis].is != Is::free) held.axes[axis] = LoadComponent::held(effect.axes[axis].each);
  out.push_back(drive_at(lower_end, all, topology, held));
  out.push_back(drive_at(upper_end, all, topology, effect));
}

// The terms of the moment, with the factors that bring them to one reading.
struct MomentTerms {
  struct Term {
    double factor;
    const LoadComponent* of;
  };
  std::vector<Term> terms;
  bool per_tube = true;

  Schedule course(double sign) const {
    std::vector<ScheduleTerm> all;
    for (const Term& t : terms) all.push_back({sign * t.factor, t.of->course});
    return sum_of(all);
  }
  double now(double time) const {
    double sum = 0;
    for (const Term& t : terms) sum += t.factor * t.of->now(time);
    return sum;
  }
};

std::vector<const EndDrive*> loaded(const EndDrives& drives, End end, std::size_t axis) {
  std::vector<const EndDrive*> found;
  for (const EndDrive& d : drives)
    if (d.end == end && d.does.axes[axis].is == Is::loaded) found.push_back(&d);
  return found;
}

std::set<int> tubes_of(const std::vector<const EndDrive*>& drives) {
  std::set<int> tubes;
  for (const EndDrive* d : drives) tubes.insert(d->tubes.begin(), d->tubes.end());
  return tubes;
}

// What acts on one tube: its part where all tubes share it.
MomentTerms terms_on(int tube, const std::vector<const EndDrive*>& drives, std::size_t axis) {
  MomentTerms out;
  for (const EndDrive* d : drives) {
    if (!std::binary_search(d->tubes.begin(), d->tubes.end(), tube)) continue;
    const LoadComponent& c = d->does.axes[axis];
    out.terms.push_back({c.each ? 1 : 1 / static_cast<double>(d->tubes.size()), &c});
  }
  return out;
}

bool are_equal(const Schedule& a, const Schedule& b) {
  return sum_of({{1, a}, {-1, b}}).largest() <= 1e-9 * std::max(a.largest(), b.largest());
}

// The moment on each tube where the scene gives the same one to each, else the total.
MomentTerms moment_terms(const EndDrives& all, End end) {
  std::vector<const EndDrive*> drives = loaded(all, end, LoadEffect::about_z);
  drives.erase(std::remove_if(drives.begin(), drives.end(), [](const EndDrive* d) { return !d->at_rope_end; }),
               drives.end());
  const bool kept = std::any_of(all.begin(), all.end(), [&](const EndDrive& d) {
    return d.end == end && d.at_rope_end && d.does.axes[LoadEffect::about_z].is_kept();
  });
  if (drives.empty() || kept) return {};  // a clamp bears the moment
  const auto is_each = [](const EndDrive* d) { return d->does.axes[LoadEffect::about_z].each; };
  if (std::all_of(drives.begin(), drives.end(), is_each)) {
    const std::set<int> tubes = tubes_of(drives);
    const MomentTerms first = terms_on(*tubes.begin(), drives, LoadEffect::about_z);
    const bool alike = drives.size() == 1 || std::all_of(tubes.begin(), tubes.end(), [&](int tube) {
                         return are_equal(first.course(1), terms_on(tube, drives, LoadEffect::about_z).course(1));
                       });
    if (alike) return first;
  }
  MomentTerms total;
  total.per_tube = false;
  for (const EndDrive* d : drives)
    total.terms.push_back(
        {is_each(d) ? static_cast<double>(d->tubes.size()) : 1.0, &d->does.axes[LoadEffect::about_z]});
  return total;
}

End other(End end) { return end == upper_end ? lower_end : upper_end; }

}  // namespace

EndDrives end_drives(const Load& load, const Topology& topology) {
  EndDrives out;
  const std::optional<LoadEffect> effect = load.effect();
  if (!effect) return out;
  if (effect->between_ends) {
    add_between(*effect, topology, out);
    return out;
  }
  std::vector<int> elements = load.elements;
  std::sort(elements.begin(), elements.end());
  std::array<std::vector<TubeEnd>, 2> at;
  std::size_t counted = 0;
  for (const End end : {lower_end, upper_end}) {
    at[end] = tube_ends_in(elements, topology, end);
    for (const TubeEnd& e : at[end]) counted += static_cast<std::size_t>(e.count);
  }
  if (counted != elements.size()) return out;
  for (const End end : {lower_end, upper_end})
    if (!at[end].empty()) out.push_back(drive_at(end, at[end], topology, *effect));
  return out;
}

EndDrives end_drives(const LoadsAndConstraints& loads, const Topology& topology) {
  EndDrives out;
  for (const auto& load : loads)
    for (EndDrive& drive : end_drives(*load, topology)) out.push_back(std::move(drive));
  return out;
}

bool is_kept_between(const EndDrives& drives, std::size_t axis) {
  std::array<std::set<int>, 2> tubes;
  for (const EndDrive& d : drives)
    if (d.does.axes[axis].is_kept()) tubes[d.end].insert(d.tubes.begin(), d.tubes.end());
  return std::any_of(tubes[lower_end].begin(), tubes[lower_end].end(),
                     [&](int tube) { return tubes[upper_end].count(tube) > 0; });
}

Schedule moved_apart(const EndDrives& drives, std::size_t axis) {
  std::array<Schedule, 2> most;
  for (const EndDrive& d : drives)
    if (const LoadComponent& c = d.does.axes[axis]; c.is == Is::moved && c.course.largest() > most[d.end].largest())
      most[d.end] = c.course;
  return sum_of({{1, most[upper_end]}, {-1, most[lower_end]}});
}

Schedule load_of_each(const EndDrives& all, End end, std::size_t axis) {
  const std::vector<const EndDrive*> drives = loaded(all, end, axis);
  Schedule most;
  for (const int tube : tubes_of(drives))
    if (const Schedule course = terms_on(tube, drives, axis).course(1); course.largest() > most.largest())
      most = course;
  return most;
}

double whole_from(const EndDrives& drives) {
  double last = 0;
  for (const EndDrive& d : drives)
    for (const LoadComponent& c : d.does.axes)
      if (c.is == Is::loaded) last = std::max(last, c.course.reaches());
  return last;
}

double EndMoment::rate() const {
  std::vector<Schedule::Point> ramp = course.points();
  const double whole = ramp_time();
  ramp.erase(std::remove_if(ramp.begin(), ramp.end(), [&](const auto& p) { return p.time > whole; }), ramp.end());
  return Schedule(std::move(ramp)).fastest();
}

double moment_at(const EndDrives& drives, double time) {
  const MomentTerms upper = moment_terms(drives, upper_end);
  return upper.terms.empty() ? 0 - moment_terms(drives, lower_end).now(time) : upper.now(time);
}

std::optional<EndMoment> end_moment(const EndDrives& drives) {
  const MomentTerms upper = moment_terms(drives, upper_end), lower = moment_terms(drives, lower_end);
  if (upper.terms.empty() && lower.terms.empty()) return std::nullopt;
  const bool by_upper = !upper.terms.empty();
  const End end = by_upper ? upper_end : lower_end;
  const MomentTerms& own = by_upper ? upper : lower;
  EndMoment out;
  out.course = own.course(by_upper ? 1 : -1);
  out.per_tube = own.per_tube;
  const std::vector<const EndDrive*> on = loaded(drives, end, LoadEffect::about_z);
  out.on_all = tubes_of(on).size() == on.front()->all;
  out.by = on.front()->does.by;
  for (const EndDrive* d : on) {
    if (d->does.by != out.by) out.by = LoadEffect::By::body;
    out.relaxes_spins = out.relaxes_spins || d->does.relaxes_spins;
  }
  if (by_upper && !lower.terms.empty()) {
    const auto below = loaded(drives, lower_end, LoadEffect::about_z);
    out.balanced = lower.per_tube == upper.per_tube && are_equal(out.course, lower.course(-1)) &&
                   tubes_of(below) == tubes_of(on);
  }
  std::set<int> held;
  for (const EndDrive& d : drives)
    if (d.end == other(end) && d.does.axes[LoadEffect::about_z].is == Is::held)
      held.insert(d.tubes.begin(), d.tubes.end());
  out.far_end_held = !held.empty() && held.size() == on.front()->all;
  return out;
}

EndFreedom end_freedom(const EndDrives& drives) {
  using Sideways = EndFreedom::Sideways;
  EndFreedom out;
  for (const EndDrive& d : drives) {
    out.one_element = out.one_element && d.one_element;
    out.tilts = out.tilts && !d.does.keeps_tilt;
    for (std::size_t axis = 0; axis < d.does.axes.size(); ++axis) {
      const LoadComponent& c = d.does.axes[axis];
      const bool turns = axis == LoadEffect::about_z;
      if (c.is == Is::moved || (c.is == Is::loaded && !turns) || (c.is == Is::held && turns) || !d.at_rope_end)
        out.otherwise_driven = true;
      if (axis < LoadEffect::z && c.is == Is::held)
        out.sideways = std::max(out.sideways, c.each ? Sideways::held : Sideways::mean_held);
    }
  }
  return out;
}

}  // namespace ropewalk
