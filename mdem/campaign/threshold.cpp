#include "campaign/threshold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <unordered_set>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "io/log.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "observe/growth.hpp"
#include "plan/scene_edit.hpp"
#include "run/results.hpp"
#include "run/stop_watch.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr double clear_of_wave = 3, of_the_value = 0.1;  // growth is looked at from the larger of the two on
constexpr std::size_t fewest_rows = 4;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::string value_text(double value) { return fmt::format("{:.6g}", value); }

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

double median(std::vector<double> v) {
  if (v.empty()) return unknown;
  std::sort(v.begin(), v.end());
  return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
}

}  // namespace

Threshold bracketed(std::vector<Trial> trials, double from, double to) {
  Threshold out;
  out.below = from;
  out.above = to;
  std::sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  for (std::size_t k = 1; k < trials.size(); ++k) {
    if (trials[k].passed == trials[k - 1].passed) continue;
    if (++out.changes > 1) continue;
    out.below = trials[k - 1].value;
    out.above = trials[k].value;
    out.falling = trials[k - 1].passed;
  }
  out.outside = out.changes == 0;
  out.trials = std::move(trials);
  return out;
}

std::optional<PowerLaw> power_law(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> lx, ly;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (x[k] > 0 && y[k] > 0) lx.push_back(std::log(x[k])), ly.push_back(std::log(y[k]));
  const std::optional<StraightLine> line = line_through(lx, ly);
  if (!line) return {};
  return PowerLaw{line->b, line->b_error};
}

Trial trial_of(const std::vector<LogRow>& log, const ThresholdQuestion& q, double value, double wave,
               double constant_from, bool by_a_rule) {
  Trial trial;
  trial.value = value;
  const auto passes = [&](const LogRow& row) {
    return q.shape ? shape_of(row, log.front()) == *q.shape : row[q.column] > q.above;
  };
  std::size_t end = 0;
  while (end < log.size() && !passes(log[end])) ++end;
  trial.passed = end < log.size();
  trial.cut_short = !trial.passed && by_a_rule && !log.empty();
  if (log.empty()) return trial;
  const LogRow& last = trial.passed ? log[end] : log.back();
  if (trial.passed || trial.cut_short) trial.time = last["time_ps"];
  if (std::isfinite(last["radius_mid_nm"])) trial.shape = name_of(shape_of(last, log.front()));
  std::vector<double> turns;
  for (std::size_t k = 0; k < std::min(end + 1, log.size()); ++k)
    if (log[k]["time_ps"] >= constant_from && std::isfinite(log[k]["geometric_twist_deg"]))
      turns.push_back(log[k]["geometric_twist_deg"] * units::degree);
  if (!turns.empty()) trial.turn = mean(turns);
  if (!trial.passed) return trial;
  // The last stretch of rows before it in which the observable is clear of the start.
  const double clear = std::max(clear_of_wave * wave, of_the_value * last[q.column]);
  std::vector<double> times, values;
  std::size_t begin = end;
  while (begin > 0 && log[begin - 1][q.column] > clear && log[begin - 1]["time_ps"] >= constant_from) --begin;
  for (std::size_t k = begin; k <= end; ++k) times.push_back(log[k]["time_ps"]), values.push_back(log[k][q.column]);
  if (times.size() < fewest_rows) return trial;
  const Growth growth = growth_of(times, values);
  trial.rate = growth.rate;
  trial.error = growth.error;
  return trial;
}

std::string trial_text(const Sweep& sweep, const SweepPoint& point, double value) {
  const ThresholdQuestion& q = *sweep.threshold;
  return with_value(point.text, q.key, value_text(value), sweep.scene_path) +
         (q.shape ? fmt::format("\n[[stop]]\nwhen = \"shape\"\nshape = \"{}\"\n", name_of(*q.shape))
                  : fmt::format("\n[[stop]]\nwhen = \"above\"\ncolumn = \"{}\"\nvalue = {}\n", q.column, q.above));
}

RunDirectory trial_directory(const CampaignDirectory& dir, const Sweep& sweep, const SweepPoint& point,
                             double value) {
  return {fmt::format("{}/{}-{}", dir.point(point.name).path, leaf_of(sweep.threshold->key), value_text(value))};
}

namespace {

std::string files_of(const SweepPoint& point) {
  std::string all;
  for (const std::string& set : point.sets) all += read_file(set);
  for (const std::string& file : point.files) all += read_file(file);
  if (!point.state.empty()) all += read_file(point.state);
  return all;
}

constexpr double marked = 9.87654e+77;  // a value that no scene has

}  // namespace

std::string trial_hash(const Sweep& sweep, const SweepPoint& point, double value) {
  return hash_hex(trial_text(sweep, point, value) + files_of(point));
}

TrialHashes::TrialHashes(const Sweep& sweep, const SweepPoint& point) : sweep_(sweep), point_(point) {
  const std::string text = trial_text(sweep, point, marked), mark = value_text(marked);
  const std::size_t at = text.find(mark);
  plain_ = at != std::string::npos && text.find(mark, at + 1) == std::string::npos;
  if (!plain_) return;
  head_ = text.substr(0, at);
  tail_ = text.substr(at + mark.size()) + files_of(point);
}

std::string TrialHashes::of(double value) const {
  return plain_ ? hash_hex(head_ + value_text(value) + tail_) : trial_hash(sweep_, point_, value);
}

namespace {

// The drives of the rope's ends in the trial with this value of the key.
EndDrives drives_at(const Sweep& sweep, const SweepPoint& point, double value) {
  Scene scene = scene_of_text(trial_text(sweep, point, value), sweep.scene_path);
  scene.stops.clear();  // --static takes relaxations, which know no [[stop]]
  const Prepared p = prepare(scene);
  return end_drives(p.loads, p.topology);
}

// Whether the key is the moment of both ends, as [twist] and a [[grip]] at both ends have it.
bool is_end_moment(const Sweep& sweep, const SweepPoint& point, double now) {
  const auto follows = [&](double moment) {
    try {
      const auto there = end_moment(drives_at(sweep, point, moment / units::nN_nm));
      return there && there->balanced && std::fabs(there->largest() / moment - 1) < 1e-3;
    } catch (const InputError&) {
      return false;  // a key of something else may not take this value
    }
  };
  return follows(now) && follows(0.5 * now);
}

// The runs in the directory.
std::vector<Trial> trials_in(const CampaignDirectory& dir, const Sweep& sweep, const SweepPoint& point) {
  std::vector<Trial> trials;
  const ThresholdQuestion& q = *sweep.threshold;
  const std::string folder = dir.point(point.name).path, begins = leaf_of(q.key) + "-";
  if (!fs::exists(folder)) return trials;
  refuse_strange(folder, true);
  const double wave = scene_of(sweep, point).start.wave;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "threshold.csv") continue;
    const RunDirectory run{entry.path().string()};
    refuse_strange(run.path, true);
    if (name.rfind(begins, 0) != 0 || progress_of(run).stage != PointProgress::Stage::ended) continue;
    const double value = leading_number(std::string_view(name).substr(begins.size())).value_or(0);
    const bool by_a_rule = progress_of(run).reason.rfind(decided_words, 0) == 0;
    trials.push_back(
        trial_of(read_log(run.log()), q, value, wave, whole_from(drives_at(sweep, point, value)), by_a_rule));
    trials.back().scene_hash = trial_hash(sweep, point, value);
    const std::vector<LimitRecord> limits = limits_of(run);
    if (const LimitRecord* first = first_limit(limits)) {
      trials.back().first_limit = first->key;
      trials.back().first_limit_time = first->passed_at_ps;
    }
  }
  return trials;
}

}  // namespace

Threshold threshold_of(const CampaignDirectory& dir, const Sweep& sweep, const SweepPoint& point,
                       const KnownTrials& known) {
  Threshold out;
  const ThresholdQuestion& q = *sweep.threshold;
  out.trials = trials_in(dir, sweep, point);
  std::unordered_set<std::string> here;
  for (const Trial& t : out.trials) here.insert(t.scene_hash);
  if (const auto earlier = known.find(point.name); earlier != known.end())
    for (const Trial& t : earlier->second)
      if (here.insert(t.scene_hash).second) out.trials.push_back(t);
  return bracketed(std::move(out.trials), q.from, q.to);
}

std::vector<OutputColumn> trial_columns() {
  return {{"seed", "", "1, 2, ... in the order of the sweep"},
          {"value", "that of the key", "value of the key in this run"},
          {"passed", "",
           "1: the column passed its value, or the rope took the shape, within the time of the scene; 0: not"},
          {"at_ps", "ps", "when it passed, or when a [[stop]] of the scene ended it before; nan: neither"},
          {"rate_per_ps", "1/ps", "rate of the exponential growth up to then; nan: it cannot be told"},
          {"rate_error_per_ps", "1/ps", "its standard error"},
          {"turn_deg", "deg", "rotation of the tubes about the centre line, mean under the whole load; nan: none"},
          {"shape", "", "of the rope then, or at its end: straight, spindle, helix, brush, cage, snarl"},
          limit_columns()[0],
          limit_columns()[1],
          {"scene_xxh64", "",
           "hash of the scene, its parameter sets and its state file, by which `--known` finds it again"}};
}

std::string key_cells(const Sweep& sweep, const std::vector<std::string>& of_keys) {
  const std::vector<std::string> keys = sweep.keys();
  std::string text;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (keys[k] != "start.seed") text += csv_cell(of_keys[k]) + ",";
  return text;
}

TrialTable read_trials(const std::string& path) {
  CsvReader csv(path);
  csv.next();
  const std::vector<std::string> names(csv.cells().begin(), csv.cells().end());
  // The place of a column; that behind the last where there is none.
  const auto place = [&](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const char* needed : {"value", "passed", "at_ps", "scene_xxh64"})
    if (place(needed) == names.size())
      throw InputError({path, 1, ""}, fmt::format("has no column {}", needed),
                       "it is another table, or an earlier version wrote it: take it away");
  const auto column = [&](const char* name) {
    return [&csv, name, at = place(name), count = names.size()] {
      return at < count ? csv.number(at, name) : unknown;
    };
  };
  const auto value = column("value"), passed = column("passed"), at_ps = column("at_ps"),
             rate = column("rate_per_ps"), rate_error = column("rate_error_per_ps"), turn = column("turn_deg"),
             limit_ps = column("first_limit_ps");
  const std::size_t limit = place("first_limit"), shape = place("shape"), hash = place("scene_xxh64"),
                    keys = std::min(place("seed"), place("value"));
  const auto cells_of_keys = [&] {
    std::string text;
    for (std::size_t k = 0; k < keys; ++k) text += csv_cell(std::string(csv.cells()[k])) + ",";
    return text;
  };
  TrialTable table;
  table.keys = cells_of_keys();
  while (csv.next()) {
    if (csv.cells().size() != names.size())
      csv.fail("", fmt::format("has {} columns, the header {}", csv.cells().size(), names.size()),
               "the file was changed or damaged; restore it");
    Trial t;
    t.value = value();
    t.passed = passed() != 0;
    const double time = at_ps();
    t.cut_short = !t.passed && std::isfinite(time);
    if (t.passed || t.cut_short) t.time = time;
    if (const double r = rate(); std::isfinite(r)) {
      t.rate = r;
      t.error = rate_error();
    }
    if (const double turned = turn(); std::isfinite(turned)) t.turn = turned * units::degree;
    if (shape < names.size()) t.shape = csv.cells()[shape];
    if (limit < names.size()) t.first_limit = csv.cells()[limit];
    if (const double time = limit_ps(); std::isfinite(time)) t.first_limit_time = time;
    t.scene_hash = csv.cells()[hash];
    table.trials.push_back(std::move(t));
    table.values.push_back(cells_of_keys());
  }
  return table;
}

bool PhasePoint::begun() const {
  return std::any_of(seeds.begin(), seeds.end(), [](const Threshold& t) { return !t.trials.empty(); });
}

double PhasePoint::by_bisection() const {
  std::vector<double> middles;
  for (const Threshold& t : seeds)
    if (!t.outside) middles.push_back(t.middle());
  return middles.empty() || outside_seeds() > 0 ? std::numeric_limits<double>::quiet_NaN() : mean(middles);
}

// The error of the mean: scatter of the seeds, and a bracket in which every value is as likely.
double PhasePoint::bisection_error() const {
  std::vector<double> middles, widths;
  for (const Threshold& t : seeds)
    if (!t.outside) middles.push_back(t.middle()), widths.push_back(t.above - t.below);
  if (middles.empty() || outside_seeds() > 0) return std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<double>(middles.size());
  double squares = 0;
  for (const double m : middles) squares += std::pow(m - mean(middles), 2);
  const double scatter = n > 1 ? std::sqrt(squares / (n - 1) / n) : 0;
  return std::hypot(scatter, mean(widths) / std::sqrt(12 * n));
}

std::size_t PhasePoint::falling_seeds() const {
  return static_cast<std::size_t>(
      std::count_if(seeds.begin(), seeds.end(), [](const Threshold& t) { return t.falling; }));
}

std::size_t PhasePoint::unclear_seeds() const {
  return static_cast<std::size_t>(
      std::count_if(seeds.begin(), seeds.end(), [](const Threshold& t) { return t.changes > 1; }));
}

// A search that has only begun does not count: nothing is known of it.
std::size_t PhasePoint::outside_seeds() const {
  return static_cast<std::size_t>(std::count_if(
      seeds.begin(), seeds.end(), [](const Threshold& t) { return t.outside && t.trials.size() > 1; }));
}

std::size_t PhasePoint::cut_short_runs() const {
  std::size_t runs = 0;
  for (const Threshold& t : seeds)
    for (const Trial& trial : t.trials) runs += trial.cut_short ? 1 : 0;
  return runs;
}

std::string PhasePoint::remarks() const {
  const auto of_seeds = [&](std::size_t some) {
    return some < seeds.size() ? fmt::format(" with {} of {} seeds", some, seeds.size()) : std::string();
  };
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : "; ") + words; };
  if (const std::size_t n = falling_seeds(); n > 0) add("runs pass below it" + of_seeds(n));
  if (const std::size_t n = unclear_seeds(); n > 0)
    add("the outcome changes more than once" + of_seeds(n) + ", and this is the lowest change");
  if (const std::size_t n = outside_seeds(); n > 0 && n < seeds.size())
    add("the outcome is the same in all of the range" + of_seeds(n) +
        ": widen it, the other seeds alone are no mean");
  if (const std::size_t n = cut_short_runs(); n > 0)
    add(fmt::format("{} run{} ended by a [[stop]] of the scene before the column passed, and count{} as not passed",
                    n, n > 1 ? "s were" : " was", n > 1 ? "" : "s"));
  return text;
}

double PhasePoint::static_theory() const { return theory ? theory->static_moment / units::nN_nm : unknown; }

double PhasePoint::glued_theory() const { return theory ? theory->glued_over_sliding * static_theory() : unknown; }

double PhasePoint::winding() const {
  std::vector<double> all;
  for (const Threshold& seed : seeds)
    for (const Trial& t : seed.trials)
      if (theory && t.turn && t.value > 0) all.push_back(theory->winding_of(*t.turn, t.value * units::nN_nm));
  return median(all);
}

double PhasePoint::winding_or_free() const {
  const double wound = winding();
  return std::isfinite(wound) ? wound : 1;
}

double PhasePoint::theory_windings() const {
  const double moment = kinetic_theory();
  return std::isfinite(moment) ? theory->windings(moment * units::nN_nm, winding_or_free()) : unknown;
}

double PhasePoint::kinetic_theory() const {
  if (kinetic_) return *kinetic_;
  const double moment = theory ? theory->moment_to_pass(passing, winding_or_free()) : 0;
  kinetic_ = moment > 0 ? moment / units::nN_nm : unknown;
  return *kinetic_;
}

std::vector<double> PhasePoint::rate_ratios() const {
  std::vector<double> ratios;
  for (const Threshold& seed : seeds)
    for (const Trial& t : seed.trials) {
      if (!theory || !t.rate || !t.turn || passing <= 0) continue;
      const double moment = t.value * units::nN_nm,
                   rate = theory->growth(moment, theory->winding_of(*t.turn, moment));
      if (rate > 0) ratios.push_back(*t.rate / rate);
    }
  return ratios;
}

double PhasePoint::rate_over_theory() const { return median(rate_ratios()); }

std::size_t PhasePoint::rates() const { return rate_ratios().size(); }

PhasePoint point_in_theory(const Sweep& sweep, const SweepPoint& p) {
  PhasePoint point;
  Scene scene = scene_of(sweep, p);
  const Prepared prepared = prepare(scene);
  point.tubes = prepared.topology.tubes();
  if (!scene.source->is_parallel() || scene.sets.size() > 1) return point;
  double farthest = 0;
  for (int t = 0; t < point.tubes; ++t)
    farthest = std::max(farthest,
                        Vector3(prepared.state.position[static_cast<std::size_t>(prepared.topology.tube_begin[t])])
                            .head<2>()
                            .norm());
  point.length = prepared.topology.length_of(0) * prepared.topology.longest_element();
  point.radius = farthest + prepared.topology.largest_radius();
  const ThresholdQuestion& q = *sweep.threshold;
  point.theory = helix_theory(scene, prepared);
  const auto moment = end_moment(end_drives(prepared.loads, prepared.topology));
  if (point.theory && !is_end_moment(sweep, p, moment->largest())) point.theory.reset();
  if (q.shape == RopeShape::helix) point.passing = 0.5 * point.radius;
  if (!q.shape && (q.column == "amplitude_nm" || q.column == "middle_amplitude_nm")) point.passing = q.above;
  return point;
}

std::vector<PhasePoint> phase_points(const CampaignDirectory& dir, const Sweep& sweep,
                                     const std::vector<SweepPoint>& points, const KnownTrials& known) {
  std::vector<PhasePoint> out;
  for (const Replicates& r : replicates_of(sweep, points)) {
    PhasePoint point = point_in_theory(sweep, r.points.front());
    point.name = r.name;
    point.values = r.values;
    for (const SweepPoint& p : r.points) point.seeds.push_back(threshold_of(dir, sweep, p, known));
    out.push_back(std::move(point));
  }
  return out;
}

}  // namespace ropewalk
