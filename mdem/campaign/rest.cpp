#include "campaign/rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/log.hpp"
#include "model/error.hpp"
#include "observe/growth.hpp"

namespace ropewalk {
namespace {

constexpr double below = 0.25, above = 1.5;  // of the winding of the compact state
constexpr double steepest = 20 * units::degree;
constexpr double defects = 6;  // of Q, from which on a rope counts as one with defects

}  // namespace

std::string rest_sweep(const Scene& scene, const Prepared& p, const RestTheory& theory, double viscosity) {
  double rim = 0;
  for (std::size_t i = 0; i < p.state.size(); ++i)
    rim = std::max(rim, std::hypot(p.state.position.x[i], p.state.position.y[i]));
  const double most =
      std::copysign(std::min(above * std::fabs(theory.compact), std::tan(steepest) / rim), theory.compact);
  std::string text =
      fmt::format("format = \"ropewalk-sweep-1\"\nscene = {}\n[vary]\nstart.twist_deg_per_nm = [{:.4g}, {:.4g}]\n",
                  nlohmann::json(scene.path).dump(), below * most / above / units::degree, most / units::degree);
  if (viscosity >= 0) text += fmt::format("damping.contact_viscosity_eV_ps_per_nm3 = [{:.4g}]\n", viscosity);
  return text;
}

std::string RestSide::branch() const {
  if (shape != RopeShape::straight) return fmt::format("open ({})", name_of(shape));
  return std::fabs(Q) < defects ? "compact" : "compact with defects";
}

RestSide rest_side(const std::vector<LogRow>& log, double start) {
  RestSide out;
  out.start = start;
  out.time = log.back()["time_ps"];
  std::vector<double> times, twists;
  out.least = std::numeric_limits<double>::infinity();
  out.most = -out.least;
  for (const LogRow& row : log) {
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
  out.shape = shape_of(log.back(), log.front());
  return out;
}

RestVerdict rest_verdict(const std::array<RestSide, 2>& s, double tolerance) {
  RestVerdict out;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double mean = 0.5 * (s[0].twist + s[1].twist), apart = 0.5 * std::fabs(s[1].twist - s[0].twist);
  const auto still = [&](const RestSide& side) { return side.moved <= 2 * tolerance * std::fabs(side.twist); };
  const bool both_still = still(s[0]) && still(s[1]);
  out.agree = both_still && s[0].branch() == s[1].branch() && apart <= tolerance * std::fabs(mean);
  out.twist = out.agree ? mean : nan;
  out.twist_error = out.agree ? apart : nan;
  out.beta = out.agree ? 0.5 * (s[0].beta + s[1].beta) : nan;
  out.beta_error = out.agree ? 0.5 * std::fabs(s[1].beta - s[0].beta) : nan;
  if (out.agree) {
    out.words = fmt::format(
        "Rests {}: both sides come to a geometric twist of {:.4g} ± {:.2g} degrees, beta {:.3g} ± {:.1g}.",
        s[0].branch(), out.twist, out.twist_error, out.beta, out.beta_error);
    return out;
  }
  const auto motion = [&](const RestSide& side) {
    if (std::fabs(side.drift) * 0.2 * side.time < 0.5 * side.moved)
      return fmt::format("swings by {:.2g}", side.moved);
    return fmt::format("{} by {:.2g}", side.drift * side.twist < 0 ? "fell" : "rose", side.moved);
  };
  if (!both_still)
    out.words = fmt::format(
        "Not at rest: in the last {:.3g} ps the rope that began below {} degrees, to {:.4g} in the mean, and the "
        "one that began above {}, to {:.4g}. Make the hold longer: twist.hold_ps, or run.duration_ps where other "
        "drives twist.",
        0.2 * s[0].time, motion(s[0]), s[0].twist, motion(s[1]), s[1].twist);
  else if (s[0].branch() == s[1].branch())
    out.words = fmt::format(
        "Both sides stand still {}, at {:.4g} degrees from below and {:.4g} from above: a slow motion, or a band "
        "of friction. Make the hold longer (twist.hold_ps, or run.duration_ps where other drives twist), or the "
        "viscosity lower.",
        s[0].branch(), s[0].twist, s[1].twist);
  else
    out.words = fmt::format(
        "More than one state of rest: {} at {:.4g} degrees from below, {} at {:.4g} from above. The way of loading "
        "chooses between them.",
        s[0].branch(), s[0].twist, s[1].branch(), s[1].twist);
  return out;
}

std::string rest_csv(const std::array<RestSide, 2>& sides) {
  std::string text =
      "from,start_deg_per_nm,time_ps,geometric_twist_deg,drift_deg_per_ps,beta_deg,least_beta_deg,most_beta_deg,Q,"
      "void_area_nm2,branch\n";
  for (const RestSide& s : sides)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", &s == &sides[0] ? "below" : "above", s.start, s.time,
                        s.twist, s.drift, s.beta, s.least, s.most, s.Q, s.voids, s.branch());
  return text;
}

std::string rest_json(const std::array<RestSide, 2>& sides, const RestVerdict& v, const RestTheory& theory,
                      double length) {
  const auto number = [](double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json out = {{"agree", v.agree},
                                {"words", v.words},
                                {"geometric_twist_deg", number(v.twist)},
                                {"geometric_twist_error_deg", number(v.twist_error)},
                                {"beta_deg", number(v.beta)},
                                {"beta_error_deg", number(v.beta_error)},
                                {"theory",
                                 {{"compact_deg", theory.compact * length / units::degree},
                                  {"open_deg", theory.open * length / units::degree}}},
                                {"sides", nlohmann::ordered_json::array()}};
  for (const RestSide& s : sides)
    out["sides"].push_back({{"from", &s == &sides[0] ? "below" : "above"},
                            {"start_deg_per_nm", s.start},
                            {"time_ps", s.time},
                            {"geometric_twist_deg", number(s.twist)},
                            {"drift_deg_per_ps", number(s.drift)},
                            {"beta_deg", number(s.beta)},
                            {"Q", number(s.Q)},
                            {"branch", s.branch()}});
  return out.dump(2) + "\n";
}

}  // namespace ropewalk
