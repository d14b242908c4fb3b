#include "plan/term_pulls.hpp"

#include <algorithm>
#include <cmath>

#include "scene/watch.hpp"

namespace ropewalk {
namespace {

bool drives(const EndDrive& d, int tube) { return std::find(d.tubes.begin(), d.tubes.end(), tube) != d.tubes.end(); }

}  // namespace

TermPulls::TermPulls(const Prepared& p) {
  for (const auto& term : p.interaction.terms)
    if (term->forces_follow_from_places()) terms_.push_back(term->copy());
  if (terms_.empty()) return;
  drives_ = end_drives(p.loads, p.topology);
  topology_ = p.topology;
  start_ = p.state;
  const NeighbourList none;
  for (const auto& term : terms_) term->prepare({topology_, none, start_});
  const std::vector<Held> held = held_by(p.loads, p.topology);
  held_.assign(start_.size(), {0, 0, 0});
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] == Held::clamped) held_[i] = {1, 1, 1};
  for (int t = 0; t < topology_.tubes(); ++t) {
    OfTube tube{t, topology_.tube_begin[static_cast<std::size_t>(t)], topology_.length_of(t)};
    for (const EndDrive& d : drives_) {
      if (!drives(d, t)) continue;
      tube.kept[d.end] = tube.kept[d.end] || d.does.axes[LoadEffect::z].is_kept();
      const int element = d.end == lower_end ? tube.begin : tube.begin + tube.length - 1;
      for (std::size_t axis = 0; axis < 3; ++axis)
        held_[static_cast<std::size_t>(element)][axis] = d.does.axes[axis].is_kept();
    }
    tubes_.push_back(tube);
  }
}

State TermPulls::moved(double time) const {
  State out = start_;
  for (const OfTube& tube : tubes_) {
    std::array<Vector3, 2> shift = {Vector3::Zero(), Vector3::Zero()};
    std::array<std::array<bool, 3>, 2> kept = {};
    std::array<double, 2> turn = {};
    std::array<bool, 2> turned = {};
    for (const EndDrive& d : drives_) {
      if (!drives(d, tube.tube)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const LoadComponent& c = d.does.axes[static_cast<std::size_t>(axis)];
        if (!c.is_kept()) continue;
        kept[d.end][static_cast<std::size_t>(axis)] = true;
        if (c.is == LoadComponent::Is::moved) shift[d.end][axis] += c.course.value(time);
      }
      const LoadComponent& c = d.does.axes[LoadEffect::about_z];
      if (d.does.by != LoadEffect::By::body || !c.is_kept()) continue;
      turned[d.end] = true;
      if (c.is == LoadComponent::Is::moved) turn[d.end] += c.course.value(time);
    }
    for (const End end : {lower_end, upper_end}) {  // an end that nothing keeps goes with the other one
      const End other = end == lower_end ? upper_end : lower_end;
      for (int axis = 0; axis < 3; ++axis)
        if (!kept[end][static_cast<std::size_t>(axis)]) shift[end][axis] = shift[other][axis];
      if (!turned[end]) turn[end] = turn[other];
    }
    for (int k = 0; k < tube.length; ++k) {
      const auto i = static_cast<std::size_t>(tube.begin + k);
      const double part = tube.length > 1 ? static_cast<double>(k) / (tube.length - 1) : 0,
                   angle = (1 - part) * turn[lower_end] + part * turn[upper_end];
      const Vector3 at = start_.position[i];
      out.position[i] = Eigen::AngleAxisd(angle, Vector3::UnitZ()) * at +
                        ((1 - part) * shift[lower_end] + part * shift[upper_end]);
    }
  }
  return out;
}

Vec3Array TermPulls::forces(const ForceTerm& term, const State& state) const {
  Vec3Array force(state.size()), torque(state.size());
  const std::unique_ptr<ForceTerm> now = term.copy();
  now->gather(state);
  now->advance(0, state);
  for (const OfTube& tube : tubes_)
    now->add(state, {tube.tube, tube.begin, tube.begin + tube.length}, {force, torque, 0});
  for (std::size_t i = 0; i < state.size(); ++i) {
    Vector3 f = force[i];
    for (int axis = 0; axis < 3; ++axis)
      if (held_[i][static_cast<std::size_t>(axis)]) f[axis] = 0;
    force.set(i, f);
  }
  return force;
}

TermPulls::Row TermPulls::row_of(const OfTube& tube, const Vec3Array& force) const {
  Row out;
  out.tension.assign(static_cast<std::size_t>(tube.length), 0);
  const auto place = [&](int k) { return static_cast<std::size_t>(tube.begin + k); };
  double all = 0, sum = 0, mean = 0;
  for (int k = 0; k < tube.length; ++k) all += Vector3(force[place(k)]).dot(axis_of(start_.orientation[place(k)]));
  const int bonds = tube.length - 1;
  const Vector3 lower = start_.position[place(0)], upper = start_.position[place(bonds)];
  for (int k = 0; k < bonds; ++k) {
    const Vector3 t = axis_of(start_.orientation[place(k)]);
    sum += Vector3(force[place(k)]).dot(t);
    double& tension = out.tension[static_cast<std::size_t>(k)];
    tension = tube.kept[upper_end] && !tube.kept[lower_end] ? -sum : all - sum;
    if (!tube.kept[upper_end] && !tube.kept[lower_end]) tension -= all * (bonds - k) / tube.length;
    mean += tension / bonds;
  }
  for (int k = 0; k < bonds && tube.kept[upper_end] && tube.kept[lower_end]; ++k)
    out.tension[static_cast<std::size_t>(k)] -= mean;
  for (int k = 0; k <= bonds; ++k) {
    const Vector3 f = force[place(k)], t = axis_of(start_.orientation[place(k)]), at = start_.position[place(k)];
    const double across = (f - f.dot(t) * t).norm(), from_lower = (at - lower).norm(), from_upper = (at - upper).norm();
    // A beam on two supports where both ends are kept.
    const double arm = tube.kept[lower_end] && tube.kept[upper_end]
                           ? from_lower * from_upper / std::max(1e-9, from_lower + from_upper)
                       : tube.kept[upper_end] ? from_upper
                       : tube.kept[lower_end] ? from_lower
                                              : 0.25 * std::min(from_lower, from_upper);
    out.moment += across * arm;
  }
  return out;
}

TermPulls::Pulls TermPulls::at(double time, int type) const {
  Pulls out;
  if (terms_.empty()) return out;
  const State there = moved(time);
  std::vector<Row> sums(tubes_.size());
  for (std::size_t t = 0; t < tubes_.size(); ++t)
    sums[t].tension.assign(static_cast<std::size_t>(tubes_[t].length), 0);
  for (const auto& term : terms_) {
    const Vec3Array force = forces(*term, there);
    std::vector<Row> rows;
    for (const OfTube& tube : tubes_) rows.push_back(row_of(tube, force));
    // The part of these forces that is left where the tubes are drawn out by it.
    const auto left = [&](double part) {
      State state = there;
      for (std::size_t n = 0; n < tubes_.size(); ++n) {
        const OfTube& tube = tubes_[n];
        const TubeType& of = topology_.type_of(tube.tube);
        const auto place = [&](int k) { return static_cast<std::size_t>(tube.begin + k); };
        std::vector<double> way(static_cast<std::size_t>(tube.length), 0);
        for (std::size_t k = 1; k < way.size(); ++k)
          way[k] = way[k - 1] + part * rows[n].tension[k - 1] / of.bond.stretch * of.element_length;
        const double origin = tube.kept[lower_end] ? 0 : tube.kept[upper_end] ? way.back() : 0.5 * way.back();
        for (int k = 0; k < tube.length; ++k)
          state.position[place(k)] = Vector3(there.position[place(k)]) +
                                     (way[static_cast<std::size_t>(k)] - origin) *
                                         axis_of(start_.orientation[place(k)]);
      }
      const Vec3Array now = forces(*term, state);
      double both = 0, own = 0;
      for (std::size_t i = 0; i < now.size(); ++i)
        both += Vector3(now[i]).dot(Vector3(force[i])), own += Vector3(force[i]).squaredNorm();
      return own > 0 ? both / own : 0;
    };
    double low = 0, high = 1;
    for (int k = 0; k < 10; ++k) {
      const double middle = 0.5 * (low + high);
      (left(middle) > middle ? low : high) = middle;
    }
    for (std::size_t t = 0; t < tubes_.size(); ++t) {
      for (std::size_t k = 0; k < sums[t].tension.size(); ++k) sums[t].tension[k] += high * rows[t].tension[k];
      sums[t].moment += high * rows[t].moment;
    }
  }
  for (std::size_t t = 0; t < tubes_.size(); ++t) {
    if (topology_.tube_type[static_cast<std::size_t>(tubes_[t].tube)] != type) continue;
    for (const double tension : sums[t].tension) {
      out.least = std::min(out.least, tension);
      out.most = std::max(out.most, tension);
    }
    out.moment = std::max(out.moment, sums[t].moment);
  }
  return out;
}

}  // namespace ropewalk
