#include "sim/dynamics/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/contract.hpp"

namespace ropewalk {

Schedule::Schedule(std::vector<Point> points, double smooth) : points_(std::move(points)) {
  ROPEWALK_EXPECTS(smooth >= 0);
  for (std::size_t k = 0; k + 1 < points_.size(); ++k) ROPEWALK_EXPECTS(points_[k].time < points_[k + 1].time);
  std::vector<double> slope;
  for (std::size_t k = 0; k + 1 < points_.size(); ++k)
    slope.push_back((points_[k + 1].value - points_[k].value) / (points_[k + 1].time - points_[k].time));
  const auto speed_at = [&](std::size_t point) {
    if (point == 0 || point == slope.size() || slope[point - 1] * slope[point] <= 0) return 0.0;
    return std::fabs(slope[point - 1]) < std::fabs(slope[point]) ? slope[point - 1] : slope[point];
  };
  for (std::size_t k = 0; k < slope.size(); ++k) {
    Line line{points_[k].time, points_[k + 1].time - points_[k].time, points_[k].value};
    line.smooth = std::min(smooth, 0.5 * line.length);
    line.enter = speed_at(k);
    line.leave = speed_at(k + 1);
    const double rise = slope[k] * line.length;
    line.along = (rise - 0.5 * line.smooth * (line.enter + line.leave)) / (line.length - line.smooth);
    lines_.push_back(line);
  }
}

double Schedule::Line::rate(double time) const {
  ROPEWALK_EXPECTS(time >= begin && length > 0);
  const double since = time - begin, left = length - since;
  if (since < smooth) return enter + (along - enter) * since / smooth;
  if (left < smooth) return leave + (along - leave) * left / smooth;
  return along;
}

double Schedule::Line::value(double time) const {
  const double since = time - begin, left = length - since;
  if (since < smooth) return from + 0.5 * since * (enter + rate(time));
  const double reached = from + 0.5 * smooth * (enter + along);
  if (left < smooth) return reached + along * (length - 2 * smooth) + 0.5 * (smooth - left) * (along + rate(time));
  return reached + along * (since - smooth);
}

const Schedule::Line* Schedule::at(double time) const {
  const auto after = std::upper_bound(lines_.begin(), lines_.end(), time,
                                      [](double t, const Line& line) { return t < line.begin; });
  if (after == lines_.begin() || time >= ends()) return nullptr;
  return &*std::prev(after);
}

double Schedule::value(double time) const {
  if (const Line* line = at(time)) return line->value(time);
  return time < ends() ? first() : last();
}

double Schedule::rate(double time) const {
  const Line* line = at(time);
  return line ? line->rate(time) : 0.0;
}

bool Schedule::constant() const {
  return std::all_of(points_.begin(), points_.end(), [&](const Point& p) { return p.value == first(); });
}

double Schedule::fastest() const {
  double most = 0;
  for (std::size_t k = 1; k < points_.size(); ++k)
    most = std::max(most,
                    std::fabs((points_[k].value - points_[k - 1].value) / (points_[k].time - points_[k - 1].time)));
  return most;
}

double Schedule::largest() const {
  double most = 0;
  for (const Point& p : points_) most = std::max(most, std::fabs(p.value));
  return most;
}

double Schedule::reaches(double part) const {
  const double wanted = part * largest();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& p = points_[k];
    if (std::fabs(p.value) < wanted) continue;
    if (k == 0 || part >= 1) return p.time;
    const Point& before = points_[k - 1];
    const double aim = std::copysign(wanted, p.value);
    return before.time + (p.time - before.time) * (aim - before.value) / (p.value - before.value);
  }
  return ends();
}

double Schedule::leaves() const {
  for (auto p = points_.rbegin(); p != points_.rend(); ++p)
    if (std::fabs(p->value) >= largest()) return p->time;
  return 0;
}

Schedule sum_of(const std::vector<ScheduleTerm>& terms) {
  std::vector<double> times;
  std::vector<Schedule> sharp;
  for (const ScheduleTerm& term : terms) {
    sharp.emplace_back(term.schedule.points());
    for (const Schedule::Point& p : term.schedule.points()) times.push_back(p.time);
  }
  std::sort(times.begin(), times.end());
  // The later of two times that only rounding tells apart: a rate between them would be noise.
  std::vector<double> apart;
  for (const double time : times) {
    if (!apart.empty() && time - apart.back() <= 1e-12 * std::fabs(time)) apart.pop_back();
    apart.push_back(time);
  }
  std::vector<Schedule::Point> points;
  for (const double time : apart) {
    double sum = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) sum += terms[k].factor * sharp[k].value(time);
    points.push_back({time, sum});
  }
  return Schedule(std::move(points));
}

std::string words_of(const Schedule& schedule) {
  std::string text;
  for (const Schedule::Point& p : schedule.points())
    text += fmt::format("{}{:.4g}", text.empty() ? "" : " to ", p.value);
  return text.empty() ? "0" : text;
}

}  // namespace ropewalk
