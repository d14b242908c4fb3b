#include "run/limit_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/error.hpp"

namespace ropewalk {
namespace {

// "deg" with a space before it; nothing for numbers without a unit.
std::string with_space(const std::string& unit) { return unit.empty() ? "" : " " + unit; }

// It ends with the heading of docs/limits.md, which `help` prints.
std::string line_of(const LimitKind& kind, const std::string& place, const Peak& peak, double time,
                    bool may_refine) {
  const double unit = peak.pressed ? -kind.unit_size : kind.unit_size;
  return fmt::format(
      "limit passed at {:.4g} ps{}{}: {} {:.4g}{}, beyond limits.{} = {:.4g}: {}; {}{}; see ropewalk "
      "help {}",
      time, place.empty() ? "" : ", ", place, kind.what, peak.value / unit, with_space(kind.unit),
      kind.key, peak.limit / unit, kind.consequence, kind.remedy,
      kind.cured_by_finer && may_refine ? ", or --on-limit refine" : "", kind.key);
}

}  // namespace

OnLimit on_limit_of(const std::string& word) {
  if (word == "warn") return OnLimit::warn;
  if (word == "stop") return OnLimit::stop;
  if (word == "refine") return OnLimit::refine;
  throw InputError({"", 0, "--on-limit"}, fmt::format("there is no '{}'", word), "take warn, stop or refine");
}

void LimitWatch::inherit_from(const std::vector<LimitRecord>& earlier, std::int64_t step) {
  records_ = earlier;
  for (LimitRecord& r : records_)
    if (r.passed_at_step > step) r.passed = false;
}

std::vector<std::string> LimitWatch::check(const Topology& topology, const Topology& tubes_now, const State& state,
                                           const NeighbourList& list, const RunEnergies& energies,
                                           bool with_pressure) {
  std::vector<std::string> lines;
  Peaks now = peaks(tubes_now, state, list, watched_);
  for (std::size_t k = 0; k < limit_count; ++k) {
    const auto limit = limit_kinds()[k].limit;
    if (limit == &Limits::pressure && with_pressure) now[k] = pressure_peak(topology, state, watched_);
    if (limit == &Limits::energy_drift) now[k] = {energies.drift, watched_.limits.front().energy_drift};
    if (limit == &Limits::shock)
      now[k] = {watched_.twist_energy > 0 ? energies.kinetic / watched_.twist_energy
                                          : std::numeric_limits<double>::quiet_NaN(),
                watched_.limits.front().shock};
  }
  records_.resize(limit_count);
  finer_would_help_ = false;
  for (std::size_t k = 0; k < limit_count; ++k) {
    const LimitKind& kind = limit_kinds()[k];
    const Peak& peak = now[k];
    LimitRecord& r = records_[k];
    r.key = kind.key;
    r.unit = kind.unit;
    if (kind.whole ? !std::isfinite(peak.value) : peak.element < 0) continue;
    const double sign = peak.pressed ? -1 : 1;
    const bool first = peak.passed() && !r.passed;
    const bool none_yet = kind.whole ? r.limit == 0 && r.largest == 0 : r.element < 0;
    if (none_yet || peak.is_beyond({std::fabs(r.largest) * kind.unit_size, std::fabs(r.limit) * kind.unit_size})) {
      r.limit = sign * peak.limit / kind.unit_size;
      r.largest = sign * peak.value / kind.unit_size;
      r.largest_at_ps = state.time;
      r.tube = kind.whole ? -1 : topology.tube_of(peak.element);
      r.element = kind.whole ? -1 : peak.element - topology.tube_begin[r.tube];
    }
    finer_would_help_ = finer_would_help_ || (peak.passed() && kind.cured_by_finer);
    if (!first) continue;
    r.passed = true;
    r.passed_at_ps = state.time;
    r.passed_at_step = state.step;
    r.passed_tube = kind.whole ? -1 : topology.tube_of(peak.element);
    r.passed_element = kind.whole ? -1 : peak.element - topology.tube_begin[r.passed_tube];
    r.passed_held_by = kind.whole ? "" : holder_in_words(topology, watched_.held, peak.element);
    lines.push_back(line_of(kind, place_words(r), peak, state.time, may_refine_));
  }
  return lines;
}

std::string passed_words(const std::vector<LimitRecord>& records) {
  std::string words;
  for (const LimitRecord& r : records)
    if (r.passed)
      words += fmt::format("{}{} up to {:.4g}{} (limit {:.4g})", words.empty() ? "" : ", ", r.key, r.largest,
                           with_space(r.unit), r.limit);
  return words;
}

}  // namespace ropewalk
