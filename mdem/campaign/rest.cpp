#include "campaign/rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/log.hpp"
#include "io/run_results.hpp"
#include "model/error.hpp"
#include "observe/growth.hpp"

namespace ropewalk {
namespace {

constexpr double below = 0.25, above = 1.5;  // parts of the compact state's winding
constexpr double steepest = 20 * units::degree;
constexpr double defects = 6;       // a rope of a larger packing charge Q counts as one with defects
constexpr double well_known = 0.1;  // of a twist: an estimate with a larger error is none

const char* const longer = "twist.hold_ps, or run.duration_ps where other drives twist";

RestValue value_of(const Approach& a, const Approach& b) {
  return {0.5 * (a.limit + b.limit), 0.5 * std::fabs(a.limit - b.limit), std::max(a.drift, b.drift),
          0.5 * std::hypot(a.statistics, b.statistics)};
}

// The digits that an error leaves of a value.
std::string with_error(double value, double error) {
  const int decimals = error > 0 ? static_cast<int>(std::clamp(1 - std::floor(std::log10(error)), 0.0, 6.0)) : 6;
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, error, decimals);
}

std::string parts_of(const RestValue& v) {
  return fmt::format("{:.1g} by the start, {:.1g} by drift, {:.1g} by noise", v.start, v.drift, v.statistics);
}

}  // namespace

std::array<double, 2> rest_starts(const Prepared& p, const RestTheory& theory) {
  double rim = 0;
  for (std::size_t i = 0; i < p.state.size(); ++i)
    rim = std::max(rim, std::hypot(p.state.position.x[i], p.state.position.y[i]));
  const double most =
      std::copysign(std::min(above * std::fabs(theory.compact), std::tan(steepest) / rim), theory.compact);
  return {below * most / above, most};
}

std::string rest_sweep(const Scene& scene, const Prepared& p, const RestTheory& theory, double viscosity) {
  const std::array<double, 2> starts = rest_starts(p, theory);
  std::string text =
      fmt::format("format = \"ropewalk-sweep-1\"\nscene = {}\n[vary]\nstart.twist_deg_per_nm = [{:.4g}, {:.4g}]\n",
                  nlohmann::json(scene.path).dump(), starts[0] / units::degree, starts[1] / units::degree);
  if (viscosity >= 0) text += fmt::format("damping.contact_viscosity_eV_ps_per_nm3 = [{:.4g}]\n", viscosity);
  return text;
}

std::string RestSide::branch() const {
  if (shape != RopeShape::straight) return fmt::format("open ({})", name_of(shape));
  return std::fabs(Q) < defects ? "compact" : "compact with defects";
}

RestSide rest_side(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits, double start) {
  RestSide out;
  out.start = start;
  out.limits = limits;
  out.time = log.back()["time_ps"];
  std::vector<double> all_times, all_twists, all_betas, times, twists;
  out.least = std::numeric_limits<double>::infinity();
  out.most = -out.least;
  for (const LogRow& row : log) {
    all_times.push_back(row["time_ps"]);
    all_twists.push_back(row["geometric_twist_deg"]);
    all_betas.push_back(row["beta_deg"]);
    if (row["time_ps"] < 0.8 * out.time) continue;
    times.push_back(row["time_ps"]);
    twists.push_back(row["geometric_twist_deg"]);
    out.beta += row["beta_deg"];
    out.least = std::min(out.least, row["beta_deg"]);
    out.most = std::max(out.most, row["beta_deg"]);
    out.Q += row["Q"];
    out.voids += row["void_area_nm2"];
  }
  const auto rows = static_cast<double>(times.size());
  for (const double twist : twists) out.twist += twist / rows;
  out.beta /= rows, out.Q /= rows, out.voids /= rows;
  out.moved = *std::max_element(twists.begin(), twists.end()) - *std::min_element(twists.begin(), twists.end());
  if (const auto line = line_through(times, twists)) out.drift = line->b;
  out.to_twist = approach_of(all_times, all_twists);
  out.to_beta = approach_of(all_times, all_betas);
  out.shape = shape_of(log.back(), log.front());
  return out;
}

const char* name_of(RestVerdict::Kind kind) {
  switch (kind) {
    case RestVerdict::Kind::rests:
      return "rests";
    case RestVerdict::Kind::creeps:
      return "creeps";
    case RestVerdict::Kind::moves:
      return "moves";
    case RestVerdict::Kind::apart:
      return "apart";
    case RestVerdict::Kind::several:
      return "several";
  }
  return "";
}

std::string left_out_of_rest() {
  return "Elements, time step and parameters are not in the errors; `ropewalk errors` of either run carries those "
         "of "
         "the parameters.";
}

RestVerdict rest_verdict(const std::array<RestSide, 2>& s, double tolerance) {
  using Kind = RestVerdict::Kind;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto arrived = [&](const RestSide& side) {
    const Approach& a = side.to_twist;
    const double near = tolerance * std::fabs(a.limit);
    return std::fabs(a.to_go) <= near && a.error() <= near && a.swing <= 2 * near;
  };
  RestVerdict out;
  const bool one_branch = s[0].branch() == s[1].branch(), both = arrived(s[0]) && arrived(s[1]);
  out.twist = value_of(s[0].to_twist, s[1].to_twist);
  out.beta = value_of(s[0].to_beta, s[1].to_beta);
  const double size = std::fabs(out.twist.value);
  const double swing = std::max(s[0].to_twist.swing, s[1].to_twist.swing);
  if (both)
    out.kind = !one_branch ? Kind::several : out.twist.start <= tolerance * size ? Kind::rests : Kind::apart;
  else if (one_branch && out.twist.error() <= well_known * size && swing <= 2 * tolerance * size)
    out.kind = Kind::creeps;
  if (out.kind != Kind::rests && out.kind != Kind::creeps) {
    out.twist = out.beta = {nan, nan, nan, nan};
  }
  const auto motion = [&](const RestSide& side) {
    if (std::fabs(side.drift) * 0.2 * side.time < 0.5 * side.moved)
      return fmt::format("swings by {:.2g}", side.moved);
    return fmt::format("{} by {:.2g}", side.drift * side.twist < 0 ? "fell" : "rose", side.moved);
  };
  const std::string of_both = fmt::format(
      "in the last {:.3g} ps the rope that began below {} degrees, to {:.4g} in the mean, and the one that "
      "began above {}, to {:.4g}.",
      0.2 * s[0].time, motion(s[0]), s[0].twist, motion(s[1]), s[1].twist);
  switch (out.kind) {
    case Kind::rests:
      out.words = fmt::format("Rests {}: both sides come to a geometric twist of {} degrees ({}), beta {}.",
                              s[0].branch(), with_error(out.twist.value, out.twist.error()), parts_of(out.twist),
                              with_error(out.beta.value, out.beta.error()));
      break;
    case Kind::creeps: {
      double part = 1;
      for (const RestSide& side : s) {
        part = std::min(part, 0.5 * tolerance * size / std::fabs(side.to_twist.to_go));
        out.further_time = std::max(out.further_time, side.to_twist.wait(part));
      }
      out.words =
          fmt::format("Creeps {}: {} Continued, both come to a geometric twist of {} degrees ({}).", s[0].branch(),
                      of_both, with_error(out.twist.value, out.twist.error()), parts_of(out.twist));
      if (out.further_time > 0)
        out.words += fmt::format(
            " To rest there, hold for {:.2g} ps more ({}), or divide the viscosity by {:.2g} (--viscosity).",
            out.further_time, longer, (s[0].time + out.further_time) / s[0].time);
      else
        out.words += fmt::format(" To know it better, make the hold longer: {}.", longer);
      break;
    }
    case Kind::moves:
      out.words = fmt::format("Not at rest: {} Make the hold longer: {}{}.", of_both, longer,
                              std::isfinite(s[0].to_twist.error() + s[1].to_twist.error())
                                  ? ""
                                  : fmt::format(", with {} rows of the log or more in each quarter of it "
                                                "(run.log_every_ps)",
                                                least_rows_of_approach));
      break;
    case Kind::apart:
      out.words = fmt::format(
          "Both sides stand still {}, at {:.4g} degrees from below and {:.4g} from above: a slow motion, or a band "
          "of friction. Make the hold longer ({}), or the viscosity lower.",
          s[0].branch(), s[0].to_twist.limit, s[1].to_twist.limit, longer);
      break;
    case Kind::several:
      out.words = fmt::format(
          "More than one state of rest: {} at {:.4g} degrees from below, {} at {:.4g} from above. Which of them a "
          "rope reaches depends on how it is loaded.",
          s[0].branch(), s[0].to_twist.limit, s[1].branch(), s[1].to_twist.limit);
      break;
  }
  return out;
}

std::vector<std::string> beyond_of(const std::array<RestSide, 2>& sides) {
  std::vector<std::string> out;
  for (const RestSide& s : sides)
    if (const std::string beyond = beyond_words(s.limits); !beyond.empty())
      out.push_back(fmt::format("The run from {} is {}: its state of rest is not that of real tubes.",
                                &s == &sides[0] ? "below" : "above", beyond));
  return out;
}

std::string rest_csv(const std::array<RestSide, 2>& sides) {
  std::string text =
      "from,start_deg_per_nm,time_ps,geometric_twist_deg,drift_deg_per_ps,beta_deg,least_beta_deg,most_beta_deg,Q,"
      "void_area_nm2,branch,limit_deg,limit_drift_deg,limit_statistics_deg,approach_ps," +
      column_names(limit_columns()) + "\n";
  for (const RestSide& s : sides)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", &s == &sides[0] ? "below" : "above",
                        s.start, s.time, s.twist, s.drift, s.beta, s.least, s.most, s.Q, s.voids, s.branch(),
                        s.to_twist.limit, s.to_twist.drift, s.to_twist.statistics, s.to_twist.time,
                        limit_cells(s.limits));
  return text;
}

std::string rest_json(const std::array<RestSide, 2>& sides, const RestVerdict& v, const RestTheory& theory,
                      double length) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto if_rests = [&](double x) { return number(v.agree() ? x : nan); };
  const auto value = [&](const RestValue& r) {
    return Json{{"value_deg", number(r.value)},
                {"error_deg", number(r.error())},
                {"by_start_deg", number(r.start)},
                {"by_drift_deg", number(r.drift)},
                {"by_noise_deg", number(r.statistics)}};
  };
  Json out = {{"agree", v.agree()},
              {"verdict", name_of(v.kind)},
              {"words", v.words},
              {"geometric_twist_deg", if_rests(v.twist.value)},
              {"geometric_twist_error_deg", if_rests(v.twist.error())},
              {"beta_deg", if_rests(v.beta.value)},
              {"beta_error_deg", if_rests(v.beta.error())},
              {"estimate", {{"geometric_twist", value(v.twist)}, {"beta", value(v.beta)}}},
              {"further_time_ps", number(v.further_time)},
              {"not_in_the_errors", left_out_of_rest()},
              {"theory",
               {{"compact_deg", theory.compact * length / units::degree},
                {"open_deg", theory.open * length / units::degree}}},
              {"sides", Json::array()}};
  for (const RestSide& s : sides) {
    const LimitRecord* first = first_limit(s.limits);
    out["sides"].push_back({{"from", &s == &sides[0] ? "below" : "above"},
                            {"start_deg_per_nm", s.start},
                            {"time_ps", s.time},
                            {"geometric_twist_deg", number(s.twist)},
                            {"drift_deg_per_ps", number(s.drift)},
                            {"limit_deg", number(s.to_twist.limit)},
                            {"limit_error_deg", number(s.to_twist.error())},
                            {"approach_ps", number(s.to_twist.time)},
                            {"beta_deg", number(s.beta)},
                            {"Q", number(s.Q)},
                            {"branch", s.branch()},
                            {"first_limit", first ? Json(first->key) : Json()},
                            {"first_limit_ps", first ? number(first->passed_at_ps) : Json()}});
  }
  return out.dump(2) + "\n";
}

}  // namespace ropewalk
