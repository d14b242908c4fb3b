#include "io/run_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/measured.hpp"
#include "io/pull.hpp"

namespace ropewalk {
namespace {

constexpr double still_there = 0.95;   // relative to the largest value
constexpr double twisted_from = 0.01;  // nN nm
constexpr double bent_share = 0.05;    // part of the bending moment: a larger torque of a bent rope is no noise
constexpr double bent_beside = 0.2;    // torque over the bending moment; and that over tension times radius
constexpr double drawn_from = 1e-6;    // strain against the start
constexpr double drawn_again = 1e-3;   // strain of a rope that was shorter before
constexpr double stored_from = 1e-3;   // MJ/kg
constexpr double turned_from = 1;      // degrees

double largest(const std::vector<LogRow>& log, std::size_t rows,
               const std::function<double(const LogRow&)>& value) {
  double most = RunResults::none;
  for (std::size_t k = 0; k < rows; ++k)
    if (const double v = std::fabs(value(log[k])); std::isfinite(v) && !(v <= most)) most = v;
  return most;
}
double largest(const std::vector<LogRow>& log, const char* column) {
  return largest(log, log.size(), [column](const LogRow& r) { return r[column]; });
}

double bending_moment(const LogRow& r) {
  return std::fmax(std::hypot(r["torque_upper_x_nN_nm"], r["torque_upper_y_nN_nm"]),
                   std::hypot(r["torque_lower_x_nN_nm"], r["torque_lower_y_nN_nm"]));
}

// Adds the bending moment, only if the rope is bent and not twisted or pulled: clamps have some moment in any test.
void add_bending(const std::vector<LogRow>& log, RunResults& r) {
  const double most = largest(log, log.size(), bending_moment);
  if (!(most > twisted_from) || largest(log, log.size(), torque_of(log)) > bent_beside * most) return;
  const double pull = std::fmax(largest(log, "tension_upper_nN"), largest(log, "tension_lower_nN"));
  if (pull * log.front()["radius_mid_nm"] * bent_beside > most) return;
  const auto at =
      std::find_if(log.begin(), log.end(), [&](const LogRow& row) { return bending_moment(row) == most; });
  r.bending_max = most;
  r.bending_max_ps = (*at)["time_ps"];
  r.bending_fell = bending_moment(log.back()) < still_there * most;
}

void add_torque(const std::vector<LogRow>& log, std::size_t within, RunResults& r) {
  const auto torque = torque_of(log);
  const double most = largest(log, log.size(), torque);
  if (!(most > twisted_from) || most < bent_share * r.bending_max) return;
  r.torque_max = most;
  r.torque_within = largest(log, within, torque);
  const auto at =
      std::find_if(log.begin(), log.end(), [&](const LogRow& row) { return std::fabs(torque(row)) == most; });
  r.torque_max_ps = (*at)["time_ps"];
  r.torque_max_deg = (*at)["rotation_deg"];
  r.torque_fell = std::fabs(torque(log.back())) < still_there * most;
}

void add_strength(const std::vector<LogRow>& log, RunResults& r) {
  const std::optional<LoggedPull> pull = pull_of(log);
  if (!pull) return;
  const LogRow& most = log[pull->most];
  double shortest = most["ends_strain"];
  for (std::size_t k = 0; k < pull->most; ++k) shortest = std::fmin(shortest, log[k]["ends_strain"]);
  const double strain = most["ends_strain"];
  if (!(strain > drawn_from || strain - shortest > drawn_again)) return;
  if (!pull->no_strength.empty()) {
    r.no_strength = fmt::format("Stress came to {:.3g} GPa, which is no strength: {}.", pull->strength,
                                pull->no_strength);
    return;
  }
  r.strength = pull->strength;
  r.strength_N_per_tex = most["specific_stress_N_per_tex"];
  r.strength_strain = pull->strain;
  r.stress_fell = log.back()["stress_GPa"] < still_there * r.strength;
}

struct ResultColumn {
  OutputColumn column;
  double (*value)(const RunResults&);
};
const ResultColumn all_results[] = {
    {{"torque_max_nN_nm", "nN nm",
      "largest torque about z that twists the rope, mean over both ends and over the time between two rows"},
     [](const RunResults& r) { return r.torque_max; }},
    {{"torque_max_at_deg", "deg", "rotation of the upper end at that torque"},
     [](const RunResults& r) { return r.torque_max_deg; }},
    {{"torque_within_nN_nm", "nN nm", "the largest before a limit of the model was passed"},
     [](const RunResults& r) { return r.torque_within; }},
    {{"first_limit_deg", "deg",
      "rotation of the upper end when a limit of the model was passed first, of a rope that is twisted"},
     [](const RunResults& r) { return r.first_limit_deg; }},
    {{"bending_max_nN_nm", "nN nm", "largest moment across z on an end, of a rope that is bent"},
     [](const RunResults& r) { return r.bending_max; }},
    {{"first_break_ps", "ps", "when the first tube broke"}, [](const RunResults& r) { return r.first_break_ps; }},
    {{"first_break_deg", "deg", "rotation of the upper end when the first tube broke"},
     [](const RunResults& r) { return r.first_break_deg; }},
    {{"tubes_broken", "", "tubes that have broken"},
     [](const RunResults& r) { return static_cast<double>(r.tubes_broken); }},
    {{"strength_GPa", "GPa", "largest stress, of a rope whose ends move apart"},
     [](const RunResults& r) { return r.strength; }},
    {{"strength_strain", "", "strain of the ends since the pull began, at that stress"},
     [](const RunResults& r) { return r.strength_strain; }},
    {{"stored_at_limit_MJ_per_kg", "MJ/kg",
      "stored energy over mass in the last row before a limit was passed; without one, the largest"},
     [](const RunResults& r) { return r.stored_at_limit; }},
};

// The sentences of one run. Numbers with a known error have it, and as many digits as it allows.
class ResultWords {
 public:
  ResultWords(const RunResults& r, const std::vector<double>& errors) : r_(r), errors_(errors) {}

  std::string torque() const {
    std::string text = fmt::format("Torque {} {} nN nm{} {}", r_.torque_fell ? "passed its maximum," : "rose to",
                                   number("torque_max_nN_nm", 4), r_.torque_fell ? "," : "",
                                   at(r_.torque_max_deg, "torque_max_at_deg", r_.torque_max_ps, ""));
    if (r_.first_limit.empty() || r_.torque_max_ps < r_.first_limit_ps) return text + ".";
    text += fmt::format(", beyond {} from {:.4g} ps on", r_.first_limit, r_.first_limit_ps);
    if (std::fabs(r_.first_limit_deg) >= turned_from) text += fmt::format(" ({:.4g}°)", r_.first_limit_deg);
    if (std::isfinite(r_.torque_within))
      text += fmt::format("; before, it reached {} nN nm", number("torque_within_nN_nm", 4));
    return text + ".";
  }
  std::string bending() const {
    return fmt::format("The bending moment {} {} nN nm{} at {:.4g} ps.",
                       r_.bending_fell ? "passed its maximum," : "rose to", number("bending_max_nN_nm", 4),
                       r_.bending_fell ? "," : "", r_.bending_max_ps);
  }
  std::string first_break() const {
    const TubeBreak& first = r_.first_break;
    std::string text =
        r_.tubes_broken == 1 ? "One tube broke" : fmt::format("{} tubes broke, the first", r_.tubes_broken);
    text += fmt::format(" {}: tube {}, element {}{}",
                        at(r_.first_break_deg, "first_break_deg", r_.first_break_ps, "first_break_ps"), first.tube,
                        first.element, first.held_by.empty() ? "" : ", at " + first.held_by);
    if (!r_.first_limit.empty() && r_.first_break_ps >= r_.first_limit_ps)
      text += fmt::format(", beyond {}", r_.first_limit);
    return text + ".";
  }
  std::string strength() const {
    return fmt::format("Stress {} {} GPa ({:.3g} N/tex){} at a strain of {}.",
                       r_.stress_fell ? "passed its maximum," : "rose to", number("strength_GPa", 3),
                       r_.strength_N_per_tex, r_.stress_fell ? "," : "", number("strength_strain", 3));
  }
  std::string stored() const {
    const std::string energy = number("stored_at_limit_MJ_per_kg", 3);
    return r_.first_limit.empty()
               ? fmt::format("The rope stored up to {} MJ/kg.", energy)
               : fmt::format("When {} was passed, the rope stored {} MJ/kg.", r_.first_limit, energy);
  }

 private:
  std::string number(const std::string& column, int digits) const {
    std::size_t k = 0;
    while (all_results[k].column.name != column) ++k;
    const double value = all_results[k].value(r_);
    return k < errors_.size() && errors_[k] > 0 ? measured_text(value, errors_[k])
                                                : fmt::format("{:.{}g}", value, digits);
  }
  // `ps_column`: empty, where no column has this time.
  std::string at(double deg, const char* deg_column, double ps, const std::string& ps_column) const {
    if (std::fabs(deg) >= turned_from) return fmt::format("at {}°", number(deg_column, 4));
    return fmt::format("at {} ps", ps_column.empty() ? fmt::format("{:.4g}", ps) : number(ps_column, 4));
  }

  const RunResults& r_;
  const std::vector<double>& errors_;
};

}  // namespace

std::size_t rows_within(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits) {
  const LimitRecord* first = first_limit(limits);
  if (!first) return log.size();
  const bool by_time = first->passed_at_ps > 0;
  const double since = by_time ? first->passed_at_ps * (1 - 1e-12) : static_cast<double>(first->passed_at_step);
  const auto beyond = [&](const LogRow& row) { return row[by_time ? "time_ps" : "step"] >= since; };
  return static_cast<std::size_t>(std::find_if(log.begin(), log.end(), beyond) - log.begin());
}

std::function<double(const LogRow&)> torque_of(const std::vector<LogRow>& log) {
  const char *upper = "torque_upper_nN_nm", *lower = "torque_lower_nN_nm";
  const double most_upper = largest(log, upper), most_lower = largest(log, lower);
  const double least = std::fmin(most_upper, most_lower), most = std::fmax(most_upper, most_lower);
  if (!(least >= 1e-3 * most)) {
    const char* held = most_lower == most ? lower : upper;
    return [held](const LogRow& r) { return r[held]; };
  }
  return [=](const LogRow& r) { return 0.5 * (r[upper] + r[lower]); };
}

CurveColumn curve_column(const std::string& name, const std::vector<LogRow>& log, const InputError::Place& place) {
  if (name == "torque_nN_nm")
    return {"torque", "nN nm",
            "torque about z that twists the rope, mean over both ends where both are held, and over the time between "
            "two rows",
            false, torque_of(log)};
  const std::size_t k = column_of_log(name, place);
  const Observable& o = observables()[k];
  return {quantity_of(o), o.unit, o.meaning, o.whole, [k](const LogRow& row) { return row.values()[k]; }};
}

double rotation_at(const std::vector<LogRow>& log, double time) {
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (log[k]["time_ps"] < time) continue;
    const double to = log[k]["rotation_deg"];
    if (k == 0) return to;
    const double begin = log[k - 1]["time_ps"], from = log[k - 1]["rotation_deg"];
    if (!(begin < time)) return to;
    return from + (to - from) * (time - begin) / (log[k]["time_ps"] - begin);
  }
  return log.empty() ? RunResults::none : log.back()["rotation_deg"];
}

RunResults run_results(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits,
                       const std::vector<TubeBreak>& breaks) {
  RunResults r;
  if (const LimitRecord* first = first_limit(limits)) {
    r.first_limit = first->key;
    r.first_limit_ps = first->passed_at_ps;
  }
  const std::size_t within = rows_within(log, limits);
  add_bending(log, r);
  add_torque(log, within, r);
  if (const LimitRecord* first = first_limit(limits);
      first && std::isfinite(r.torque_max) && (first->passed_at_ps > 0 || first->passed_at_step == 0))
    r.first_limit_deg = rotation_at(log, first->passed_at_ps);
  add_strength(log, r);
  if (!breaks.empty()) {
    r.first_break = *std::min_element(breaks.begin(), breaks.end(),
                                      [](const TubeBreak& a, const TubeBreak& b) { return a.time_ps < b.time_ps; });
    r.first_break_ps = r.first_break.time_ps;
    r.first_break_deg = rotation_at(log, r.first_break_ps);
    std::vector<int> tubes;
    for (const TubeBreak& b : breaks) tubes.push_back(b.tube);
    std::sort(tubes.begin(), tubes.end());
    r.tubes_broken = static_cast<int>(std::unique(tubes.begin(), tubes.end()) - tubes.begin());
  }
  const auto stored = [](const LogRow& row) { return row["stored_MJ_per_kg"]; };
  if (within == log.size())
    r.stored_at_limit = largest(log, within, stored);
  else if (within > 0)
    r.stored_at_limit = stored(log[within - 1]);
  if (!log.empty()) {
    r.links_formed = log.back()["links_formed"];
    r.links_broken = log.back()["links_broken"];
    r.bonds_broken = log.back()["bonds_broken"];
  }
  return r;
}

std::vector<OutputColumn> limit_columns() {
  return {{"first_limit", "", "key of the limit that was passed first; empty: none was"},
          {"first_limit_ps", "ps", "when it was passed: what comes after is beyond the model"}};
}
std::string limit_cells(const std::vector<LimitRecord>& limits) {
  const LimitRecord* first = first_limit(limits);
  return first ? fmt::format("{},{}", first->key, first->passed_at_ps) : ",nan";
}

std::vector<OutputColumn> result_columns() {
  std::vector<OutputColumn> out;
  for (const ResultColumn& c : all_results) out.push_back(c.column);
  return out;
}
std::vector<double> result_values(const RunResults& results) {
  std::vector<double> out;
  for (const ResultColumn& c : all_results) out.push_back(c.value(results));
  return out;
}
std::string result_cells(const RunResults& results) {
  std::string text;
  for (const double v : result_values(results))
    text += (text.empty() ? "" : ",") + (std::isfinite(v) ? fmt::format("{}", v) : std::string("nan"));
  return text;
}

std::vector<std::string> result_sentences(const RunResults& r, const std::vector<double>& errors) {
  const ResultWords words(r, errors);
  std::vector<std::string> out;
  if (std::isfinite(r.bending_max)) out.push_back(words.bending());
  if (std::isfinite(r.torque_max)) out.push_back(words.torque());
  if (r.tubes_broken > 0) out.push_back(words.first_break());
  if (std::isfinite(r.strength)) out.push_back(words.strength());
  if (!r.no_strength.empty()) out.push_back(r.no_strength);
  if (r.links_broken > 0)
    out.push_back(fmt::format("{:.0f} of {:.0f} links broke.", r.links_broken, r.links_formed));
  if (r.stored_at_limit > stored_from) out.push_back(words.stored());
  return out;
}

}  // namespace ropewalk
