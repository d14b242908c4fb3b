#include "plan/demands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "observe/observe.hpp"

namespace ropewalk {
namespace {

constexpr int parts_of_a_line = 16;
constexpr double least_way = 1;  // nm, over which an element turns against what holds it
constexpr double soon = 1e-6;  // ps, when loads that act at once have begun

bool is_loaded(const LoadEffect& effect, std::size_t axis) {
  return effect.axes[axis].is == LoadComponent::Is::loaded;
}
bool is_moved(const LoadEffect& effect, std::size_t axis) {
  return effect.axes[axis].is == LoadComponent::Is::moved;
}

// Tubes of a film lie across z, where a force along z bends them.
bool stand_upright(const State& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i) sum += std::fabs(axis_of(s.orientation[i]).z());
  return sum > 0.5 * static_cast<double>(s.size());
}

// Curvature at the ends of a tube whose ends are kept upright and lie `aside` of one another: a beam under tension.
double curvature_aside(double aside, double length, double tension, double bend) {
  const double k = std::sqrt(std::max(0.0, tension) / bend), x = 0.5 * k * length;
  return x > 0.01 ? 0.5 * aside * k * k / (x / std::tanh(x) - 1) : 6 * aside / (length * length);
}

// Curvature of a beam that has buckled in one wave. `shortened`: its ends came nearer by this part of its length.
double curvature_buckled(double shortened, double length, bool upright) {
  return (upright ? 4 : 2) * units::pi / length * std::sqrt(shortened);
}

double helix(double radius, double winding) {
  const double slope = radius * winding;
  return slope * winding / (1 + slope * slope);
}

}  // namespace

// One reading of the rope: its winding and length, the twist and the strain of its tubes.
struct DemandsAhead::At {
  double winding = 0;
  double twist = 0;
  Range strain;
  double tension = 0;
};

double DemandsAhead::Range::farthest(double more) const {
  return std::max(std::fabs(low + more), std::fabs(high + more));
}

DemandsAhead::Range DemandsAhead::Range::moved(double one, double other) const {
  return {low + std::min(one, other), high + std::max(one, other)};
}

DemandsAhead::DemandsAhead(const Scene& scene, const Prepared& p, std::size_t type)
    : law_(p.topology.types[type]),
      bond_(p.topology.types[type].bond),
      drives_(end_drives(p.loads, p.topology)),
      terms_(p),
      type_(static_cast<int>(type)) {
  tubes_ = p.topology.tubes();
  for (const End end : {lower_end, upper_end})
    for (std::size_t axis = 0; axis < 6; ++axis) loads_[end][axis] = load_of_each(drives_, end, axis);
  turned_apart_ = moved_apart(drives_, LoadEffect::about_z);
  drawn_apart_ = moved_apart(drives_, LoadEffect::z);
  for (std::size_t axis = 0; axis < moved_aside_.size(); ++axis) moved_aside_[axis] = moved_apart(drives_, axis);
  for (int t = 0; t < tubes_; ++t) length_ = std::max(length_, free_length(scene, p.topology, t));
  period_ = p.topology.groups.images > 0 ? p.topology.groups.period : length_;
  ends_inside_ = p.topology.groups.images > 0 && p.topology.strands() < p.topology.tubes();
  upright_ = stand_upright(p.state);
  if (upright_) section_ = RopeSection(p);
  rope_radius_ = section_.radius();
  column_ = std::pow(units::pi * (rope_radius_ + p.topology.largest_radius()) / length_, 2);
  if (tubes_ > 6) pressure_per_slope4_ = bond_.stretch / (0.5 * std::sqrt(3.0) * p.spacing * p.spacing) / 8;
  length_kept_ = is_kept_between(drives_, LoadEffect::z);
  turn_kept_ = is_kept_between(drives_, LoadEffect::about_z);
  moves_ = scene.run.mode != RunOptions::Mode::relax;
  for (const EndDrive& d : drives_) {
    keeps_tilt_ = keeps_tilt_ || d.does.keeps_tilt;
    relaxes_spins_ = relaxes_spins_ || d.does.relaxes_spins;
    winds_freely_ = winds_freely_ || d.does.relaxes_spins || d.does.by == LoadEffect::By::tangential;
    for (std::size_t axis = 0; axis < 6; ++axis)
      kept_[d.end][axis] = kept_[d.end][axis] || d.does.axes[axis].is_kept();
  }
  read_inner(p);
  if (const double warmest = std::max(scene.start.temperature, scene.bath() ? scene.bath()->temperature.largest() : 0);
      warmest > 0) {
    const double kt = units::boltzmann * warmest, a = p.topology.types[type].element_length;
    warm_curvature_ = std::sqrt(kt / (bond_.bend * a));
    warm_twist_ = std::sqrt(kt / (bond_.twist * a));
  }
  read_start(scene, p);
  times_ = {0, soon};
  for (const EndDrive& d : drives_)
    for (const LoadComponent& c : d.does.axes) add_times(c.course);
  for (const Inner& load : inner_)
    for (const LoadComponent& c : load.does.axes) add_times(c.course);
  std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
}

void DemandsAhead::read_inner(const Prepared& p) {
  for (const auto& load : p.loads) {
    const auto effect = load->effect();
    if (!effect || !end_drives(*load, p.topology).empty()) continue;
    Inner inner{*effect, 0, 0};
    std::map<int, std::vector<int>> by_tube;
    for (const int e : load->elements) by_tube[p.topology.tube_of(e)].push_back(e);
    for (const auto& [tube, elements] : by_tube) {
      if (!(static_cast<double>(elements.size()) > inner.elements)) continue;
      inner.elements = static_cast<double>(elements.size());
      const double middle = std::accumulate(elements.begin(), elements.end(), 0.0) / inner.elements;
      inner.from_lower = (middle - p.topology.tube_begin[static_cast<std::size_t>(tube)]) *
                         p.topology.type_of(tube).element_length;
    }
    inner_.push_back(inner);
  }
}

void DemandsAhead::add_times(const Schedule& course) {
  double before = 0;
  for (const Schedule::Point& point : course.points()) {
    for (int k = 1; k <= parts_of_a_line && point.time > before; ++k)
      times_.push_back(before + (point.time - before) * k / parts_of_a_line);
    before = std::max(before, point.time);
  }
}

void DemandsAhead::read_start(const Scene& scene, const Prepared& p) {
  winding_ = scene.start.turn;
  if (scene.from_file() && tubes_ > 2)
    winding_ = observe(p.topology, p.state, rope_shells(p.topology, p.state, 0), validities(scene, p.topology), 0,
                       p.spacing)
                   .geometric_twist /
               length_;
  bool first = true;
  const auto widen = [&](Range& range, double value) {
    range.low = first ? value : std::min(range.low, value);
    range.high = first ? value : std::max(range.high, value);
  };
  for (int t = 0; t < tubes_; ++t) {
    const double a = p.topology.type_of(t).element_length;
    const auto begin = static_cast<std::size_t>(p.topology.tube_begin[static_cast<std::size_t>(t)]);
    for (std::size_t i = begin; i + 1 < begin + static_cast<std::size_t>(p.topology.length_of(t)); ++i) {
      const auto [fi, fj] =
          bond_ends(p.topology.type_of(t).bond, a, frame_of(p.state.orientation[i]), frame_of(p.state.orientation[i + 1]));
      bent_ = std::max(bent_, 2 * std::asin(std::min(0.5 * (fi.t - fj.t).norm(), 1.0)) / a);
      widen(twist_, bond_twist_angle(fi, fj) / a);
      widen(strain_, (p.state.position[i + 1] - p.state.position[i]).norm() / a - 1);
      first = false;
    }
  }
  bent_ = std::max(0.0, bent_ - helix(rope_radius_, winding_));
  constexpr double rounding = 1e-9;  // nm
  straight_ = scene.start.temperature == 0 && !scene.bath();
  for (int t = 0; t < tubes_ && straight_; ++t) {
    const auto begin = static_cast<std::size_t>(p.topology.tube_begin[static_cast<std::size_t>(t)]);
    const Vector3 first = p.state.position[begin];
    for (std::size_t i = begin; i < begin + static_cast<std::size_t>(p.topology.length_of(t)); ++i)
      straight_ = straight_ && (p.state.position[i] - first).head<2>().norm() < rounding;
  }
}

double DemandsAhead::turned(double time) const {
  double angle = turned_apart_.value(time) / period_;
  for (const Inner& load : inner_)
    if (is_moved(load.does, LoadEffect::about_z)) {
      // Against the nearer end that does not turn with it.
      double over = length_;
      if (kept_[lower_end][LoadEffect::about_z]) over = std::min(over, load.from_lower);
      if (kept_[upper_end][LoadEffect::about_z]) over = std::min(over, length_ - load.from_lower);
      angle += load.does.axes[LoadEffect::about_z].course.value(time) / std::max(over, least_way);
    }
  return angle;
}

// On each tube, positive: a tension, or a couple that winds to the right. Two ends that are loaded balance one
// another, and the larger counts.
double DemandsAhead::axial(std::size_t axis, double time) const {
  const double upper = loads_[upper_end][axis].value(time), lower = -loads_[lower_end][axis].value(time);
  return (std::fabs(upper) >= std::fabs(lower) ? upper : lower) + axial_inside(axis, time);
}

double DemandsAhead::axial_inside(std::size_t axis, double time) const {
  double out = 0;
  for (const Inner& load : inner_)
    if (is_loaded(load.does, axis)) out += load.elements * load.does.axes[axis].course.value(time);
  return out;
}

double DemandsAhead::sideways(std::size_t axis, double time) const {
  double out =
      std::max(std::fabs(force_of(loads_[upper_end][axis], time)), std::fabs(force_of(loads_[lower_end][axis], time)));
  for (const Inner& load : inner_)
    if (is_loaded(load.does, axis)) out += load.elements * std::fabs(force_of(load.does.axes[axis].course, time));
  return out;
}

double DemandsAhead::force_of(const Schedule& course, double time) const {
  return course.value(time) + at_once(course.value(0));
}

// Forces at an end bend a tube that the other end holds; forces inside one that both ends hold, where they do.
double DemandsAhead::bent_by_force(std::size_t axis, double time) const {
  double out = length_ * std::max(std::fabs(force_of(loads_[upper_end][axis], time)),
                                  std::fabs(force_of(loads_[lower_end][axis], time)));
  for (const Inner& load : inner_) {
    if (!is_loaded(load.does, axis)) continue;
    const double force = load.elements * std::fabs(force_of(load.does.axes[axis].course, time)), at = load.from_lower,
                 rest = std::max(0.0, length_ - at);
    const bool lower = kept_[lower_end][axis], upper = kept_[upper_end][axis];
    out += force * (lower && upper ? at * rest / length_ : lower ? at : upper ? rest : length_);
  }
  return out;
}

double DemandsAhead::clinging(double couple, double more) const {
  if (turn_kept_ || more != 0) return winding_ + more;
  return section_.winding_under(couple, bond_, winds_freely_, clings(), winding_);
}

void DemandsAhead::add(const At& what, Demands& out) const {
  const double slope = rope_radius_ * what.winding;
  double curvature = helix(rope_radius_, what.winding);
  // Clamps keep the tilt of the start: between them a tube of the rim goes aside by what the rope has wound since.
  if (keeps_tilt_ && slope != 0)
    curvature = std::max(curvature, curvature_aside(rope_radius_ * std::fabs(what.winding - winding_) * length_,
                                                    length_, what.tension, bond_.bend));
  out.curvature = std::max(out.curvature, curvature);
  out.twist = std::max(out.twist, std::fabs(what.twist));
  out.strain = std::max(out.strain, what.strain.high);
  out.pressed = std::max(out.pressed, -what.strain.low);
  if (length_kept_ && !ends_inside_) out.pressure = std::max(out.pressure, pressure_per_slope4_ * std::pow(slope, 4));
}

Demands DemandsAhead::at(double time) const {
  Demands out;
  const bool begun = time > 0;
  const double couple = begun ? axial(LoadEffect::about_z, time) : 0,
               pull = begun && upright_ ? axial(LoadEffect::z, time) + at_once(axial(LoadEffect::z, 0)) : 0;
  // As the ends keep it; without them, as it starts.
  const double more = turned(time), winding = winding_ + more;
  const double twist = twist_.farthest(ends_inside_ ? 0 : more);
  const double clings = begun ? clinging(couple, more) : winding_;
  Range wound;
  if (!ends_inside_)
    wound = wound.moved(section_.outer_strain(clings, winding_), section_.inner_strain(clings, winding_));
  const double aside = std::hypot(moved_aside_[0].value(time), moved_aside_[1].value(time));
  double stretched = 0;  // extension by the way aside
  double shortened = 0;  // beyond what a column bears
  if (length_kept_) {
    const double drawn = std::hypot(1 + drawn_apart_.value(time) / period_, aside / period_) - 1,
                 along = 1 + (straight_ && more == 0 && aside == 0 ? drawn : std::max(drawn, -column_));
    stretched = std::max(0.0, drawn);
    shortened = std::max(0.0, -drawn - column_);
    const double outer = std::hypot(along, rope_radius_ * clings) / std::hypot(1, rope_radius_ * winding_) - 1;
    Range strain = strain_.moved(along - 1, outer);
    // A force inside draws out what is below it and presses what is above.
    for (const Inner& load : inner_)
      if (begun && upright_ && is_loaded(load.does, LoadEffect::z)) {
        const double force_there = load.elements * force_of(load.does.axes[LoadEffect::z].course, time),
                     part = std::min(1.0, load.from_lower / length_);
        strain = strain.moved(law_.strain_under((1 - part) * force_there, 0),
                              law_.strain_under(-part * force_there, 0));
      }
    add({winding, twist, strain, bond_.stretch * std::max(0.0, outer)}, out);
  } else if (!begun) {
    add({winding, twist, strain_, 0}, out);
  } else {
    const double strain = pull != 0 ? law_.strain_under(pull, couple != 0 ? 0 : twist) : 0;
    add({winding, couple != 0 ? 0 : twist, wound.moved(strain, strain),
         pull + bond_.stretch * wound.high}, out);
  }
  if (couple != 0) {
    const double twisted = law_.twist_under(couple, 0),
                 drawn = !length_kept_ && pull != 0 ? law_.strain_under(pull, twisted) : 0;
    const Range strain = length_kept_ ? Range() : wound.moved(drawn, drawn);
    // The rope as a whole winds no farther than by Hooke's law where its tubes give way.
    const double by_hooke = couple / bond_.twist;
    double winds = std::fabs(twisted) < std::fabs(by_hooke) ? twisted : by_hooke;
    if (winds_freely_) {
      // It belongs to the length of the tubes, which are helices on a rope that gets shorter.
      const double along_tube = section_.winding_under(couple, bond_, true, RopeSection::Tubes::slide),
                   slope = rope_radius_ * along_tube;
      constexpr double steepest = 0.9;  // sine
      winds = along_tube / std::sqrt(1 - std::min(slope * slope, steepest * steepest));
    }
    const double tension = pull + bond_.stretch * wound.high;
    add({winds, twisted, strain, tension}, out);
    if (std::fabs(twisted) < law_.largest_twist() && !winds_freely_)
      add({winding_ + winds, twist_.farthest(twisted), strain, tension}, out);
  }
  // What bends each tube beside the winding.
  double bent = 0, moment = begun ? std::hypot(bent_by_force(0, time), bent_by_force(1, time)) : 0;
  for (const EndDrive& d : drives_)
    for (std::size_t axis = 3; axis < LoadEffect::about_z; ++axis)
      if (is_moved(d.does, axis)) bent += std::fabs(d.does.axes[axis].course.value(time));
  if (!upright_ && begun) moment = std::hypot(moment, bent_by_force(LoadEffect::z, time));
  // The end of a beam that keeps its place as it tilts is bent four times as far as the mean.
  const bool stays = kept_[lower_end][0] && kept_[upper_end][0] && kept_[lower_end][1] && kept_[upper_end][1];
  out.curvature += (stays ? 4 : 1) * bent / length_ + warm_curvature_ + bent_;
  if (shortened > 0) out.curvature += curvature_buckled(shortened, length_, keeps_tilt_);
  if (keeps_tilt_ && aside > 0)
    out.curvature += curvature_aside(aside, length_, bond_.stretch * stretched, bond_.bend);
  out.strain += rope_radius_ * bent / length_;
  out.pressed += rope_radius_ * bent / length_;
  out.twist += warm_twist_;
  if (begun) moment += std::hypot(sideways(3, time), sideways(4, time));
  if (begun && terms_.any()) {
    TermPulls::Pulls pulls = terms_.at(time, type_);
    const TermPulls::Pulls first = terms_.at(0, type_);
    pulls.least += at_once(first.least);
    pulls.most += at_once(first.most);
    pulls.moment += at_once(first.moment);
    const auto more_strain = [&](double tension) {
      return law_.strain_under(pull + tension, 0) - law_.strain_under(pull, 0);
    };
    if (pulls.most > 0) out.strain += more_strain(pulls.most);
    if (pulls.least < 0) out.pressed -= more_strain(pulls.least);
    moment += pulls.moment;
  }
  if (moment > 0)
    out.curvature += law_.curvature_under(moment);
  return out;
}

Demands DemandsAhead::largest() const {
  Demands out;
  for (const double time : times_) {
    const Demands now = at(time);
    out.curvature = std::max(out.curvature, now.curvature);
    out.twist = std::max(out.twist, now.twist);
    out.strain = std::max(out.strain, now.strain);
    out.pressed = std::max(out.pressed, now.pressed);
    out.pressure = std::max(out.pressure, now.pressure);
  }
  return out;
}

}  // namespace ropewalk
