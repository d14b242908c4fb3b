#include "report/loading_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "report/log_figures.hpp"
#include "report/page.hpp"

namespace ropewalk {
namespace {

double largest(const std::vector<LogRow>& log, const char* column) {
  double most = 0;
  for (const LogRow& r : log)
    if (std::isfinite(r[column])) most = std::max(most, std::fabs(r[column]));
  return most;
}

// Against the rotation where there is one.
std::string against_rotation(const std::vector<LogRow>& log) {
  return largest(log, "rotation_deg") > 1 ? "rotation_deg" : "";
}

// Draws the mean torque of both ends with a band from one end to the other if clamps hold both: a wave that travels
// along the rope widens the band. Else it draws the torque at the held end.
Panel torque(const std::vector<LogRow>& log) {
  const LogValue upper = logged("torque_upper_nN_nm"), lower = logged("torque_lower_nN_nm");
  const double most_upper = largest(log, "torque_upper_nN_nm"), most_lower = largest(log, "torque_lower_nN_nm");
  Panel out{"Torque", "", {"torque", "nN nm", false}, {}, false, false, against_rotation(log)};
  if (std::min(most_upper, most_lower) < 1e-3 * std::max(most_upper, most_lower)) {
    out.caption =
        "Torque about z that twists the rope at the end that is held, mean over the time between two rows.";
    out.traces = {most_upper > most_lower ? Trace{"upper", upper, 0} : Trace{"lower", lower, 1}};
    return out;
  }
  const LogValue mean = torque_of(log), half = [=](const LogRow&r) { return 0.5 * std::fabs(upper(r) - lower(r)); };
  double apart = 0, whole = 0;
  for (const LogRow& r : log)
    if (std::isfinite(mean(r))) apart += half(r), whole += std::fabs(mean(r));
  out.caption = fmt::format(
      "Torque about z, averaged over both ends and over the time between two rows. The band spans the two ends; in "
      "equilibrium they agree. Here they differ from their mean by <b>{} %</b> on average.",
      number_text(100 * apart / whole, 2));
  out.traces = {{"mean of both ends", mean, 0, false, half}};
  return out;
}

// The load against what it does, along states of rest. The lines of one kind reach to the next state of another
// kind.
Panel equilibria(const ReportInput& in) {
  using Stability = Equilibrium::Stability;
  const auto changes = [&](const char* column) {
    const double first = in.log.front()[column];
    return std::any_of(in.log.begin(), in.log.end(),
                       [&](const LogRow& r) { return std::isfinite(r[column]) && r[column] != first; });
  };
  const bool turned = largest(in.log, "rotation_deg") > 1, by_moment = changes("moment_nN_nm");
  const LogValue load = by_moment ? logged("moment_nN_nm")
                        : turned  ? torque_of(in.log)
                                  : logged("tension_upper_nN");
  const auto is = [&in](std::size_t k, Stability s) {
    return k < in.equilibria.size() && in.equilibria[k].stability == s;
  };
  const auto only = [&](Stability s) -> LogValue {
    return [=](const LogRow& r) {
      for (std::size_t k = 0; k < in.equilibria.size(); ++k)
        if (in.equilibria[k].step == static_cast<std::int64_t>(r["step"]))
          return is(k, s) || is(k + 1, s) || (k > 0 && is(k - 1, s)) ? load(r)
                                                                     : std::numeric_limits<double>::quiet_NaN();
      return std::numeric_limits<double>::quiet_NaN();
    };
  };
  Panel out{"States of rest",
            fmt::format(
                "{} Equilibrium states along the schedules of the loads, without friction. Solid: stable. Dashed: "
                "unstable, or the stability is not known.",
                escape_markup(in.reason) + "."),
            {by_moment || turned ? "torque" : "tension", by_moment || turned ? "nN nm" : "nN", false},
            {},
            false,
            false,
            turned ? "rotation_deg" : "ends_strain"};
  const auto any = [&](Stability s) {
    return std::any_of(in.equilibria.begin(), in.equilibria.end(), [&](const auto& e) { return e.stability == s; });
  };
  if (any(Stability::stable)) out.traces.push_back({"stable", only(Stability::stable), 0});
  if (any(Stability::unstable)) out.traces.push_back({"unstable", only(Stability::unstable), 1, true});
  if (any(Stability::unknown)) out.traces.push_back({"not told", only(Stability::unknown), 2, true});
  return out;
}

Panel tension(const std::vector<LogRow>& log) {
  return {
      "Tension",
      "Force along z that pulls at either end, mean over the time between two rows. It is not zero at the "
      "start: cohesion would shorten free tubes a little, and the clamps hold them.",
      {"tension", "nN", false},
      {{"upper", logged("tension_upper_nN"), 0}, {"lower", logged("tension_lower_nN"), 1}},
      false,
      false,
      against_rotation(log)};
}

Panel stored(const std::vector<LogRow>& log) {
  return {"Stored energy",
          "Potential energy since the start over the mass of the tubes, and its parts.",
          {"stored", "MJ/kg", false},
          {{"all", logged("stored_MJ_per_kg"), 5},
           {"stretch", logged("stored_stretch_MJ_per_kg"), 2},
           {"bend", logged("stored_bend_MJ_per_kg"), 0},
           {"twist", logged("stored_twist_MJ_per_kg"), 1},
           {"contact", logged("stored_contact_MJ_per_kg"), 3}},
          false,
          false,
          against_rotation(log)};
}

// Per cent of the stored energy, once it is a hundredth of its largest value.
Panel shares(const std::vector<LogRow>& log) {
  const double enough = 0.01 * largest(log, "stored_MJ_per_kg");
  const auto share = [enough](const char* column) -> LogValue {
    return [=, part = logged(column), whole = logged("stored_MJ_per_kg")](const LogRow& r) {
      return whole(r) > enough ? 100 * part(r) / whole(r) : std::numeric_limits<double>::quiet_NaN();
    };
  };
  return {"Shares of the stored energy",
          "Shares of the stored energy, in per cent.",
          {"share", "%", false},
          {{"stretch", share("stored_stretch_MJ_per_kg"), 2},
           {"bend", share("stored_bend_MJ_per_kg"), 0},
           {"twist", share("stored_twist_MJ_per_kg"), 1},
           {"contact", share("stored_contact_MJ_per_kg"), 3}},
          false,
          false,
          against_rotation(log)};
}

Panel length() {
  return {"Length",
          "Change of the distance between both ends, over that of the start.",
          {"strain", "", false},
          {{"strain", logged("ends_strain"), 0}}};
}

// Groups of tubes at the same distance from the axis, in the order of the distance.
std::map<double, std::vector<std::size_t>> rings(const std::vector<double>& radius) {
  std::map<double, std::vector<std::size_t>> out;
  for (std::size_t t = 0; t < radius.size(); ++t) out[std::round(radius[t] * 20) / 20].push_back(t);
  return out;
}

std::string tension_figure(const ReportInput& in, Figures& figures) {
  const ReportLoading& last = in.loading.back();
  // The figure averages the tension over the tubes of a ring, bond by bond. Tubes with different numbers of bonds
  // have no such average.
  for (const std::vector<double>& tube : last.tension_nN)
    if (tube.size() != last.tension_nN.front().size()) return "";
  const std::string title = "Tension along the tubes";
  LineChart chart;
  chart.title = title;
  chart.x = {"position along the rope", "nm", false};
  chart.y = {"tension", "nN", false};
  std::vector<TableColumn> columns;
  const auto all = rings(last.radius);
  std::vector<double> chosen;
  for (const auto& ring : all) chosen.push_back(ring.first);
  const std::vector<std::size_t> some = evenly(chosen.size(), sequential_colours);
  for (std::size_t k = 0; k < some.size(); ++k) {
    const auto& [radius, tubes] = *all.find(chosen[some[k]]);
    ChartLine line;
    line.name = fmt::format("at {} nm", number_text(radius, 3));
    line.colour = sequential_colour(k, some.size());
    for (std::size_t i = 0; i < last.tension_nN[tubes[0]].size(); ++i) {
      double sum = 0;
      for (const std::size_t t : tubes) sum += last.tension_nN[t][i];
      line.x.push_back((static_cast<double>(i) + 0.5) * in.element_length);
      line.y.push_back(sum / static_cast<double>(tubes.size()));
    }
    if (columns.empty()) columns.push_back({"position (nm)", line.x});
    columns.push_back({line.name + " (nN)", line.y});
    chart.lines.push_back(std::move(line));
  }
  if (!can_draw(chart)) return not_drawn(title);
  return fmt::format("<figure><h3>{}</h3>\n", title) + chart_svg(chart) +
         figures.caption(
             "In the last frame, mean over the tubes that start at the same distance from the axis. The "
             "position is counted from the lower end.") +
         data_table(columns, "ropewalk observe --tubes lists every tube.") + "</figure>\n";
}

std::string pressure_figure(const ReportInput& in, Figures& figures) {
  const std::string title = "Pressure against radius";
  LineChart chart;
  chart.title = title;
  chart.x = {"distance from the axis", "nm", false};
  chart.y = {"pressure", "GPa", false};
  std::vector<TableColumn> columns;
  for (std::size_t k = 0; k < in.loading.size(); ++k) {
    const ReportLoading& frame = in.loading[k];
    if (frame.pressure_GPa.empty()) continue;
    ChartLine line;
    line.name = "at " + number_text(frame.time_ps) + " ps";
    line.colour = sequential_colour(k, in.loading.size());
    for (const auto& [radius, tubes] : rings(frame.radius)) {
      double sum = 0;
      for (const std::size_t t : tubes) sum += frame.pressure_GPa[t];
      line.x.push_back(radius);
      line.y.push_back(sum / static_cast<double>(tubes.size()));
    }
    if (columns.empty()) columns.push_back({"distance (nm)", line.x});
    columns.push_back({line.name + " (GPa)", line.y});
    chart.lines.push_back(std::move(line));
  }
  if (!can_draw(chart)) return "";
  return fmt::format("<figure><h3>{}</h3>\n", title) + chart_svg(chart) +
         figures.caption(
             "Pressure of the contacts on a tube in the middle of the rope, averaged over the tubes that start at "
             "the same distance from the axis; negative where tubes are drawn apart. Tension of the outer tubes "
             "presses the inner ones together. Another effect of twist draws them apart: a tube that leans has a "
             "section that is longer than wide, so that the tubes around the axis need more room.") +
         data_table(columns, "ropewalk observe RUN --tubes has the pressure on every tube in the last frame.") +
         "</figure>\n";
}

// Turned and turned back.
std::string loop_words(const std::vector<LogRow>& log) {
  const double most = largest(log, "rotation_deg"), last = std::fabs(log.back()["rotation_deg"]);
  const double in = largest(log, "work_eV"), lost = log.back()["dissipated_eV"];
  if (most < 5 || last > 0.5 * most || !(in > 0)) return "";
  return paragraph(fmt::format(
      "The rope was turned by up to {}° and back to {}°: of {} eV that were put in, {} eV came back, and {} eV, "
      "<b>{} %</b>, are lost to damping or still in motion.",
      number_text(most), last < 0.01 ? "0" : number_text(last, 3), number_text(in),
      number_text(in - log.back()["work_eV"]),
      number_text(log.back()["work_eV"] - (potential_energy(log.back()) - potential_energy(log.front()))),
      number_text(100 * lost / in, 3)));
}

// What the rope stores as long as the model holds.
std::string stored_words(const ReportInput& in) {
  const double most = largest(in.log, "stored_MJ_per_kg"), within = in.results.stored_at_limit;
  std::string text;
  if (in.results.first_limit.empty())
    text = fmt::format("This rope stored up to <b>{} MJ/kg</b> in this run.", number_text(most, 3));
  else
    text = (std::isfinite(within)
                ? fmt::format("This rope stored <b>{} MJ/kg</b> when {} was passed.", number_text(within, 3),
                              escape_markup(in.results.first_limit))
                : fmt::format("{} was passed from the start.", escape_markup(in.results.first_limit))) +
           fmt::format(" Beyond that limit the model reached {} MJ/kg, more than real tubes can store.",
                       number_text(most, 3));
  return text +
         " For scale, what others measured and calculated. One perfect bundle is not a macroscopic rope: a yarn "
         "has bundles that slip, gaps, bent and short tubes, and mass that bears no load.";
}

// The figures of other authors and samples, with their sources.
std::string literature() {
  struct Row {
    const char* what;
    const char* value;
    const char* source;
  };
  constexpr Row rows[] = {
      {"steel spring", "1.4·10⁻⁴",
       "Utsumi et al., Nat. Nanotechnol. 19, 1007 (2024), doi:10.1038/s41565-024-01645-x"},
      {"lithium-ion battery", "≤ 0.72", "the same"},
      {"ropes of single-walled tubes, pristine, turned by a motor: mean, largest", "0.22, 0.45",
       "KAKEN 16K04893 (2018)"},
      {"the same, treated (TPU, microwaves): mean, largest", "0.69, 2.1",
       "KAKEN 19K05215 (2021); Utsumi et al. 2024"},
      {"bundle of carbon nanothreads, molecular dynamics", "1.76",
       "Zhan et al., Nat. Commun. 11, 1905 (2020), doi:10.1038/s41467-020-15807-7"},
      {"limit by calculations of DFT type", "8",
       "KAKEN 16K04893; Fthenakis et al., Phys. Rev. B 95, 245402 (2017)"},
  };
  std::string html =
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>Sample or model</th><th "
      "class=\"number\">MJ/kg</th><th>Source</th></tr></thead><tbody>\n";
  for (const Row& row : rows)
    html += fmt::format("<tr><th>{}</th><td class=\"number\">{}</td><td class=\"soft\">{}</td></tr>\n", row.what,
                        row.value, row.source);
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string loading_part(const ReportInput& in, Figures& figures) {
  if (in.log.size() < 2 || !in.loaded) return "";
  const auto panel = [&](const Panel& p) { return log_figure(in, p, figures); };
  const std::string curve = in.equilibria.size() > 1 ? heading("States of rest") + panel(equilibria(in)) : "";
  const bool twisted =
      in.rope && largest(in.log, "torque_upper_nN_nm") + largest(in.log, "torque_lower_nN_nm") > 0.01;
  const bool pulled = largest(in.log, "tension_upper_nN") + largest(in.log, "tension_lower_nN") > 1e-3;
  if (!twisted && !pulled) return curve;
  std::string html = curve + heading("Loads at both ends");
  const std::string torques = twisted ? panel(torque(in.log)) : "", pull = pulled ? panel(tension(in.log)) : "";
  html += pair_of(torques, pull) + loop_words(in.log);
  if (largest(in.log, "ends_strain") > 1e-6) html += panel(length());
  if (!in.rope) return html;
  html += heading("Stored energy");
  const std::string energy = panel(stored(in.log)), parts = panel(shares(in.log));
  html += pair_of(energy, parts);
  if (twisted && largest(in.log, "stored_MJ_per_kg") > 1e-3) html += paragraph(stored_words(in)) + literature();
  if (in.loading.empty()) return html;
  html += heading("Inside the rope");
  const std::string along = tension_figure(in, figures), across = pressure_figure(in, figures);
  return html + pair_of(along, across);
}

}  // namespace ropewalk
