#include "sim/statics/load_steps.hpp"

#include <algorithm>
#include <cmath>

#include "model/contract.hpp"

namespace ropewalk {
namespace {

struct Stretch {
  double begin = 0, end = 0;  // ps
  int steps = 1;
  double share = 0;  // steps that it would have as a part of all

  double length() const { return end - begin; }
};

std::vector<Schedule> courses_of(const LoadsAndConstraints& loads) {
  std::vector<Schedule> out;
  for (const auto& load : loads)
    if (const auto effect = load->effect())
      for (const LoadComponent& c : effect->axes)
        if (!c.course.constant()) out.push_back(c.course);
  return out;
}

std::vector<Stretch> stretches_of(const std::vector<Schedule>& courses) {
  std::vector<double> times;
  for (const Schedule& c : courses)
    for (const Schedule::Point& p : c.points()) times.push_back(p.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<Stretch> out;
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    if (std::any_of(courses.begin(), courses.end(),
                    [&](const Schedule& c) { return c.value(times[k]) != c.value(times[k + 1]); }))
      out.push_back({times[k], times[k + 1]});
  return out;
}

// To the stretches that are the farthest below their shares.
void share_out(int steps, std::vector<Stretch>& all) {
  double length = 0;
  for (const Stretch& s : all) length += s.length();
  for (Stretch& s : all) s.share = steps * s.length() / length;
  for (int left = steps - static_cast<int>(all.size()); left > 0; --left)
    ++std::max_element(all.begin(), all.end(), [](const Stretch& a, const Stretch& b) {
        return a.share - a.steps < b.share - b.steps;
      })->steps;
}

}  // namespace

std::vector<double> load_step_times(const LoadsAndConstraints& loads, int steps) {
  ROPEWALK_EXPECTS(steps > 0);
  std::vector<Stretch> all = stretches_of(courses_of(loads));
  if (all.empty()) return {};
  share_out(steps, all);
  std::vector<double> times{all.front().begin};
  for (const Stretch& s : all)
    for (int k = 1; k <= s.steps; ++k) times.push_back(k == s.steps ? s.end : s.begin + s.length() * k / s.steps);
  return times;
}

}  // namespace ropewalk
