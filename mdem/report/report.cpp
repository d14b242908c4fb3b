#include "report/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "io/log_mean.hpp"
#include "report/loading_part.hpp"
#include "report/log_figures.hpp"
#include "report/page.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t max_pictures = 6;

template <class T>
std::vector<T> some(const std::vector<T>& all) {
  std::vector<T> chosen;
  for (const std::size_t k : evenly(all.size(), max_pictures)) chosen.push_back(all[k]);
  return chosen;
}

std::string degrees(double value) { return std::isfinite(value) ? fixed_text(value, 1) + "°" : "–"; }
std::string picoseconds(double value) { return number_text(value) + " ps"; }

Panel bond_energies() {
  return {"Energy of the bonds",
          "Elastic energy of all bonds, by kind of deformation.",
          {"energy", "eV", false},
          {{"stretch", logged("stretch_eV"), 2},
           {"shear", logged("shear_eV"), 4},
           {"bend", logged("bend_eV"), 0},
           {"twist", logged("twist_eV"), 1}}};
}

// The energy columns of the force terms that the run has.
std::vector<std::string> terms_in(const std::vector<LogRow>& log) {
  std::vector<std::string> columns;
  for (const std::string& column : term_energy_columns())
    if (std::any_of(log.begin(), log.end(), [&](const LogRow& row) { return row[column] != 0; }))
      columns.push_back(column);
  return columns;
}
std::string term_of(const std::string& column) {
  std::string name = column.substr(0, column.rfind("_eV"));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Panel other_energies(const ReportInput& in) {
  const bool contacts = in.tubes > 1;
  std::string caption = contacts ? "Change since the start of the van der Waals energy between the tubes, the "
                                   "kinetic energy and the total."
                                 : "Change since the start of the kinetic energy and of the total.";
  if (!in.log.empty()) {
    const LogRow& first = in.log.front();
    caption += " At the start: ";
    if (contacts) caption += fmt::format("van der Waals {} eV, ", number_text(first["vdw_eV"], 6));
    caption += fmt::format("kinetic {} eV, total {} eV.", number_text(first["kinetic_eV"], 5),
                           number_text(total_energy(first), 6));
  }
  Panel panel{contacts ? "Contact, kinetic and total energy" : "Kinetic and total energy",
              caption,
              {"change of energy", "eV", false},
              {{"kinetic", logged("kinetic_eV"), 2}, {"total", total_energy, 5}},
              false,
              true};
  if (contacts) panel.traces.insert(panel.traces.begin(), {"van der Waals", logged("vdw_eV"), 3});
  for (const std::string& column : terms_in(in.log)) panel.traces.push_back({term_of(column), logged(column), 4});
  return panel;
}

Panel packing_charge() {
  return {"Packing charge",
          "Q = Σ (6 − neighbours) over the internal tubes of the middle section: the sum of five-fold (+1) and "
          "seven-fold (−1) defects. Neighbours by distance (solid), and by Delaunay triangulation (dashed), "
          "which takes distances in the plane of the section and misleads beyond β = 54°.",
          {"Q", "", true},
          {{"distance", logged("Q"), 1}, {"Delaunay", logged("Q_delaunay"), 0, true}},
          true};
}

Panel twist_angle() {
  return {"Twist angle",
          "Mean angle β of the outermost tubes to the axis of the rope, over its middle third.",
          {"β", "°", false},
          {{"β", logged("beta_deg"), 0}}};
}

Panel end_twists() {
  return {"Twist, end to end",
          "Physical: stored in the bonds along a tube, mean over the tubes. Geometric: rotation of the tubes about "
          "the centre line of the rope. Positive is right-handed.",
          {"twist", "°", false},
          {{"physical", logged("physical_twist_deg"), 1}, {"geometric", logged("geometric_twist_deg"), 0}}};
}

Panel amplitude(bool rope) {
  return {rope ? "Deflection of the rope" : "Deflection of the tube",
          rope ? "Largest distance of the centre line from its chord. Where it grows to the radius of the rope and "
                 "beyond, the rope as a whole has buckled."
               : "Largest distance of the axis of the tube from its chord.",
          {"amplitude", "nm", false},
          {{"amplitude", logged("amplitude_nm"), 0}}};
}

Panel windings() {
  return {"Windings of the centre line",
          "Turns of the centre line about its chord, positive where right-handed: the helix of a buckled rope.",
          {"windings", "", false},
          {{"windings", logged("windings"), 1}}};
}

Panel curvature() {
  return {"Curvature",
          "Largest curvature of a tube.",
          {"curvature", "1/nm", false},
          {{"curvature", logged("most_curvature_per_nm"), 0}}};
}

Panel tube_twist() {
  return {"Twist, end to end",
          "Stored in the bonds along a tube, mean over the tubes. Positive is right-handed.",
          {"twist", "°", false},
          {{"twist", logged("physical_twist_deg"), 1}}};
}

Panel work_and_heat(const std::vector<LogRow>& log) {
  Panel panel{"Work and dissipation",
              "Work done by the loads, and energy that is lost, since the start.",
              {"energy", "eV", false},
              {{"work", logged("work_eV"), 0}, {"lost", logged("dissipated_eV"), 1}}};
  if (log.empty() || clock_of(log).counts_steps()) return panel;
  int colour = 2;
  for (const auto& [to, column] :
       {std::pair{"to damping", "damping_eV"}, {"to slip", "friction_slip_eV"}, {"to drag", "friction_drag_eV"}})
    if (log.back()[column] != 0 && log.back()[column] != log.back()["dissipated_eV"])
      panel.traces.push_back({to, logged(column), colour++});
  panel.caption += " " + damping_words(log.back());
  return panel;
}

std::string balance_words(const ReportInput& in) {
  double largest = 0;
  for (const LogRow& r : in.log)
    if (std::isfinite(r["balance_eV"])) largest = std::max(largest, std::abs(r["balance_eV"]));
  std::string text = fmt::format("The largest deviation is {} eV.", number_text(largest, 3));
  for (const LimitRecord& r : in.watched.limits)
    if (r.key == "energy_drift" && r.limit > 0)
      text += fmt::format(" It was at most {} % of the energy that was converted; the limit is {} %.",
                          number_text(100 * r.largest, 2), number_text(100 * r.limit, 2));
  return text;
}

Panel balance(const ReportInput& in) {
  return {"Energy balance",
          "Total energy − work + dissipated energy − heat of the thermostat, less its first value. It would stay "
          "at zero if time were "
          "continuous; what is left is the error of the integration. " +
              balance_words(in),
          {"balance", "eV", false},
          {{"balance", logged("balance_eV"), 5}}};
}

// The time of the k-th of n pictures, in words. A relaxation has no times, only a beginning and an end.
std::string when(const ReportInput& in, std::size_t k, std::size_t n, double time) {
  if (!clock_of(in.log).counts_steps()) return picoseconds(time);
  return k == 0 ? "start" : k + 1 == n ? "end" : "between";
}

bool is_beyond(const ReportInput& in, double time) {
  const LimitRecord* first = first_limit(in.watched.limits);
  return first && !clock_of(in.log).counts_steps() && time >= first->passed_at_ps;
}

std::string tag(const ReportInput& in, const std::string& when, double time, double beta) {
  return "<div class=\"tag\">" + when + (in.rope ? " &#160; β = " + degrees(beta) : "") +
         (is_beyond(in, time) ? " <span class=\"soft\">beyond a limit</span>" : "") + "</div>\n";
}

// --- Radius along the rope ----------------------------------------------------------------------------------

std::string radius_figure(const ReportInput& in, const std::vector<ReportSection>& sections, Figures& figures) {
  const std::string title = "Radius along the rope";
  LineChart chart;
  chart.title = title;
  chart.x = {"position along the rope", "nm", false};
  chart.y = {"outer radius", "nm", false};
  std::vector<TableColumn> columns;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    ChartLine line;
    line.name = clock_of(in.log).counts_steps() ? when(in, k, sections.size(), sections[k].time_ps)
                                                : "at " + picoseconds(sections[k].time_ps);
    line.y = sections[k].radius_profile;
    for (std::size_t i = 0; i < line.y.size(); ++i) line.x.push_back(static_cast<double>(i) * in.element_length);
    line.colour = sequential_colour(k, sections.size());
    if (line.y.empty() || (!columns.empty() && columns[0].values.size() != line.y.size())) continue;
    if (columns.empty()) columns.push_back({"position (nm)", line.x});
    columns.push_back({line.name + " (nm)", line.y});
    chart.lines.push_back(std::move(line));
  }
  if (!can_draw(chart)) return not_drawn(title);
  return fmt::format("<figure><h3>{}</h3>\n", title) + chart_svg(chart) +
         figures.caption(
             "Distance of the outermost tube from the centre line, plus the radius of a tube, at the "
             "times of the cross-sections. The position is counted in elements from the lower end.") +
         data_table(columns, "ropewalk observe RUN --json has it for every frame.") + "</figure>\n";
}

// --- Pictures -----------------------------------------------------------------------------------------------

// Thick and short ropes stand side by side, a little smaller where that makes them fit: a reader wants the figures that
// follow in sight.
RopeCamera camera_for_page(const std::vector<RopeView>& views, double tube_radius) {
  constexpr double page = 1040, gap = 28;
  RopeCamera camera = rope_camera(views, tube_radius, page, views.size() > 1 ? 160 : 300);
  for (const int columns : {2, 3, 4}) {
    const double column = (page - (columns - 1) * gap) / columns, width = camera.width * camera.scale;
    if (width > column && width < 1.25 * column) camera.scale = column / camera.width;
  }
  return camera;
}

std::string views_figure(const ReportInput& in, Figures& figures) {
  const std::vector<RopeView> views = some(in.views);
  if (views.empty()) return paragraph("There are no frames to draw from.");
  const RopeCamera camera = camera_for_page(views, in.tube_radius);
  std::string html = "<figure class=\"strip\"><div class=\"views\">\n";
  for (std::size_t k = 0; k < views.size(); ++k) {
    const std::string name = fmt::format("v{}t", static_cast<char>('a' + k));
    html += "<div class=\"view\">" +
            tag(in, when(in, k, views.size(), views[k].time_ps), views[k].time_ps, views[k].beta_deg);
    html += rope_picture(views[k], camera, in.tube_radius, name, k + 1 == views.size()) + "</div>\n";
  }
  std::string caption =
      std::string(
          "Seen from the side, at the same scale and from the same direction; the tubes are drawn "
          "at their radius. ") +
      fmt::format("The bar is {:g} nm long.", scale_bar_length(camera));
  html += "</div>\n";
  if (std::any_of(views.begin(), views.end(), [](const RopeView& v) { return !v.links.empty(); }))
    caption += " Red: links, where they can be seen.";
  if (camera.coloured()) {
    html += colour_bar(camera);
    caption +=
        " Colour: modulus of the bending moment of the tube; the scale ends where 99.5 % of the elements lie "
        "below.";
  }
  return html + figures.caption(caption) + "</figure>\n";
}

std::string key_of(const char* name, const char* words) {
  return fmt::format(
      "<span class=\"key\"><svg class=\"section\" width=\"14\" height=\"14\" viewBox=\"0 0 14 14\">"
      "<circle class=\"{}\" cx=\"7\" cy=\"7\" r=\"6\"/></svg> {}</span>\n",
      name, words);
}

std::string section_words(const ReportSection& s) {
  std::string html = fmt::format("<div><b>Q = {}</b> &#160; Delaunay {}</div>", fixed_text(s.section.charge, 0),
                                 fixed_text(s.section.charge_delaunay, 0));
  if (s.section.voids > 0)
    html += fmt::format("<div class=\"soft\">{} {}, {} nm²</div>", s.section.voids,
                        s.section.voids == 1 ? "void" : "voids", number_text(s.section.void_area, 3));
  return html;
}

std::string sections_figure(const ReportInput& in, const std::vector<ReportSection>& sections, Figures& figures) {
  double half = 0;
  for (const ReportSection& s : sections) half = std::max(half, section_half_width(s.section, in.tube_radius));
  const bool few = sections.size() <= 4;  // otherwise six side by side
  std::string html = fmt::format("<figure><div class=\"row{}\">\n", few ? " few" : "");
  for (std::size_t k = 0; k < sections.size(); ++k)
    if (!sections[k].section.points.empty())
      html +=
          "<div class=\"cut\">" +
          section_picture(sections[k].section, in.shells, in.tube_radius, half, few ? 220 : 150) +
          tag(in, when(in, k, sections.size(), sections[k].time_ps), sections[k].time_ps, sections[k].beta_deg) +
          section_words(sections[k]) + "</div>\n";
  html += "</div><div class=\"keys\">" + key_of("n6", "internal, six neighbours") + key_of("n5", "five") +
          key_of("n7", "seven") + key_of("nx", "another number") + key_of("outermost", "outermost") + "</div>\n";
  return html +
         figures.caption(
             "The middle section, normal to the axis of the rope, to scale: circles have the radius "
             "of a tube. A tube that leans by an angle is cut as a longer ellipse, which is not "
             "drawn. Colour: number of neighbours by distance.") +
         "</figure>\n";
}

bool any_internal(const RopeShells& shells) {
  return std::any_of(shells.internal.begin(), shells.internal.end(), [](char c) { return c != 0; });
}

std::string sections_part(const ReportInput& in, const std::vector<ReportSection>& sections, Figures& figures) {
  const bool any = std::any_of(sections.begin(), sections.end(),
                               [](const ReportSection& s) { return s.section.points.size() > 1; });
  if (!any)
    return paragraph("There are no cross-sections: a single tube, or tubes of different lengths, have none.");
  return sections_figure(in, sections, figures);
}

// --- Words --------------------------------------------------------------------------------------------------

std::string ending(const ReportInput& in) {
  std::string reason = in.reason.empty() ? "" : ": " + escape_markup(in.reason);
  while (!reason.empty() && reason.back() == '.') reason.pop_back();
  if (in.status == "finished")
    return (reason.empty() ? "The run finished as planned" : "The run finished" + reason) + ".";
  if (in.status == "taken from atoms") return "Its elements were taken from atoms" + reason + ".";
  if (in.status == "interrupted") return "The run was interrupted" + reason + ". This page shows it up to there.";
  if (in.status == "not relaxed") return "The relaxation did not come to rest" + reason + ".";
  if (in.status == "stopped")
    return "The run was " + escape_markup(in.reason) + ". This page shows it up to there.";
  if (in.status == "refined") return "The run ended here" + reason + ".";
  if (in.status == "failed") return "The run failed" + reason + ". This page shows it up to there.";
  if (in.status == "running") return "The run had not ended when this page was made" + reason + ".";
  return "How the run ended is not known" + reason + ".";
}

// Limits first, then what came of the run, then its end.
std::string lead(const ReportInput& in) {
  std::string html;
  if (const std::string beyond = beyond_sentence(in.watched.limits); !beyond.empty()) {
    html = "<b>" + escape_markup(beyond) + "</b> ";
    if (beyond_limits(in.watched.limits) > far_beyond)
      html += "<b>" + escape_markup(worst_words(in.watched.limits)) + ".</b> ";
    html +=
        "What comes after does not describe real tubes; it is dotted and hatched in the figures. "
        "<a href=\"#limits\">Every limit that was passed</a>. ";
  }
  std::vector<double> errors;
  for (const WholeError& e : in.result_errors) errors.push_back(e.total());
  for (const std::string& sentence : result_sentences(in.results, errors)) html += escape_markup(sentence) + " ";
  return html;
}

// A summary in sentences. Quantities that the scene does not have are left out.
std::string summary(const ReportInput& in) {
  if (in.log.empty()) return ending(in) + " Its log has no rows.";
  const LogRow& r = in.log.back();
  const Clock clock = clock_of(in.log);
  const bool beyond = rows_within(in.log, in.watched.limits) < in.log.size();
  const auto bold = [&](const std::string& value) { return beyond ? value : "<b>" + value + "</b>"; };
  std::string html = clock.counts_steps() ? fmt::format("After {} steps", fixed_text(r["step"], 0))
                                          : fmt::format("After {}", picoseconds(r["time_ps"]));
  if (beyond) html += fmt::format(", beyond {},", escape_markup(in.results.first_limit));
  if (std::isfinite(r["beta_deg"]) && in.rope)
    html += fmt::format(" the outermost tubes stand at {} to the axis of the rope, and",
                        bold("β = " + degrees(r["beta_deg"])));
  const double bonds = r["stretch_eV"] + r["shear_eV"] + r["bend_eV"] + r["twist_eV"];
  html += fmt::format(" the bonds hold {} (stretch {}, shear {}, bend {}, twist {})",
                      bold(number_text(bonds) + " eV"), number_text(r["stretch_eV"], 3),
                      number_text(r["shear_eV"], 3), number_text(r["bend_eV"], 3), number_text(r["twist_eV"], 3));
  for (const std::string& column : terms_in(in.log))
    html += fmt::format(", {} {}", term_of(column), bold(number_text(r[column], 3) + " eV"));
  if (in.tubes > 1) html += fmt::format(", the van der Waals contacts {}", bold(number_text(r["vdw_eV"]) + " eV"));
  html += fmt::format(". The kinetic energy is {} eV, the total {} eV.", number_text(r["kinetic_eV"], 3),
                      number_text(total_energy(r)));
  if (in.rope && any_internal(in.shells))
    html += fmt::format(
        " The packing charge of the middle section, Q, the sum of its five-fold (+1) and seven-fold (−1) defects, "
        "is {} by distance, {} by Delaunay triangulation.",
        bold("Q = " + fixed_text(r["Q"], 0)), fixed_text(r["Q_delaunay"], 0));
  return html + " " + ending(in);
}

struct Limit {
  const char* what;  // "kinked"
  const char* column;
  std::string consequence;  // HTML: which limit
  const char* meaning;
};

std::vector<Limit> limits(const Validity& v) {
  const auto limit = [](double value, const char* words, const char* unit) {
    return value > 0 ? fmt::format("{} {}{}", words, number_text(value), unit)
                     : std::string(words) + " the limit of the parameter set";
  };
  return {{"Kinked", "kinked", limit(v.kink_curvature, "curvature beyond", " nm⁻¹"),
           "A real tube kinks there: its wall folds and it bends on at a fraction of the stiffness. Harmonic bonds "
           "bend on elastically and overestimate the bending energy. With anharmonic bonds the moment stays "
           "constant, while that of a tube falls by a third."},
          {"Overtwisted", "overtwisted", limit(v.twist_collapse, "radius times twist per length beyond", ""),
           "The wall of a real tube collapses into a ribbon there. Harmonic bonds store more energy of twist than "
           "the tube would. With anharmonic bonds the torque stays constant, as that of a tube does."},
          {"Overstretched", "overstretched", limit(v.largest_tension(), "strain beyond", ""),
           "In compression the wall of a real tube buckles there; in tension harmonic bonds overestimate the "
           "force."}};
}

std::string moment_words(const std::vector<LogRow>& log, const LogRow& row) {
  return clock_of(log).counts_steps() ? "at step " + fixed_text(row["step"], 0)
                                      : "at " + picoseconds(row["time_ps"]);
}

std::string limit_words(const ReportInput& in, const Limit& limit) {
  const double last = in.log.back()[limit.column];
  const LogRow* worst = &in.log.front();
  for (const LogRow& r : in.log)
    if (r[limit.column] > (*worst)[limit.column]) worst = &r;
  const double most = (*worst)[limit.column];
  const std::string of = in.bonds > 0 ? fmt::format(" of {} bonds", fixed_text(in.bonds, 0)) : " bonds";
  std::string html = fmt::format("<li><b>{}</b> ({}): ", limit.what, limit.consequence);
  if (!(most > 0)) return html + (in.bonds > 0 ? "none" + of : "no bond") + " at any logged time.</li>\n";
  html += fixed_text(last, 0) + of + " at the end";
  if (in.bonds > 0) html += fmt::format(" ({} %)", number_text(100 * last / in.bonds, 2));
  if (most > last) html += fmt::format("; most {}: {}", moment_words(in.log, *worst), fixed_text(most, 0));
  return html + ". " + limit.meaning + "</li>\n";
}

std::string passed_words(const LimitRecord& r) {
  const std::string unit = r.unit.empty() ? "" : " " + escape_markup(r.unit);
  const std::string first = place_words(r);
  const std::string place = r.tube >= 0 ? fmt::format(", tube {}, element {}", r.tube, r.element) : "";
  return fmt::format(
      "<li><b>limits.{}</b>, {}{}: passed at {}{}; largest {}{} at {}{}. <code>ropewalk help {}</code> says what "
      "that means and what to change.</li>\n",
      escape_markup(r.key), number_text(r.limit), unit, picoseconds(r.passed_at_ps),
      first.empty() ? "" : ", " + escape_markup(first), number_text(r.largest), unit, picoseconds(r.largest_at_ps),
      place, escape_markup(r.key));
}

std::string limits_part(const ReportInput& in) {
  if (in.log.empty()) return paragraph("The log has no rows, so nothing is known.");
  std::string html = paragraph(
      "Bonds of the model stay elastic at any deformation, and real tubes do not. Forces of bonds beyond these limits "
      "of the parameter set do not describe real tubes.");
  html += "<ul>\n";
  for (const Limit& limit : limits(in.validity)) html += limit_words(in, limit);
  double twist = 0;
  for (const LogRow& r : in.log)
    if (std::isfinite(r["largest_bond_twist_deg"])) twist = std::max(twist, r["largest_bond_twist_deg"]);
  html += fmt::format(
      "<li>Largest twist of one bond: {}. The torque of a bond peaks at 90°, and beyond it the bond "
      "would slip, or, with [failure], breaks.</li>\n",
      degrees(twist));
  for (const LimitRecord& r : in.watched.limits)
    if (r.passed) html += passed_words(r);
  return html + "</ul>\n";
}

std::string energy_words(const EnergyParts& before, const EnergyParts& after) {
  std::string words;
  const auto add = [&](const char* name, double from, double to) {
    words += fmt::format("{}{} {} → {}", words.empty() ? "" : ", ", name, number_text(from, 5), number_text(to, 5));
  };
  const Energies &a = before.potential, &b = after.potential;
  add("stretch", a.stretch, b.stretch);
  add("shear", a.shear, b.shear);
  add("bend", a.bend, b.bend);
  add("twist", a.twist, b.twist);
  add("van der Waals", a.vdw, b.vdw);
  if (a.terms != 0 || b.terms != 0) add("force terms", a.terms, b.terms);
  add("kinetic", before.kinetic, after.kinetic);
  return words;
}

// Empty if elements were never split.
std::string refinements_part(const std::vector<RefinementRecord>& refinements) {
  if (refinements.empty()) return "";
  std::string html =
      heading("Elements split on the way") +
      paragraph(
          "A limit was passed that shorter elements cure: every element was split in two, and the "
          "run went on in a directory of its own. The jump of energy is the difference between "
          "the two models of the same state, most of it at the ends, where half an element more of each tube "
          "may now bend, twist and stretch; the energy balance leaves it out.") +
      "<ul>\n";
  for (const RefinementRecord& r : refinements)
    html += fmt::format(
        "<li>At {}: <b>DIR{}</b>, {} elements of {} nm, goes on as <b>DIR{}</b>, {} elements of {} nm. Energy "
        "{} → {} eV ({}).</li>\n",
        picoseconds(r.time_ps), escape_markup(r.from), r.elements_before, number_text(r.length_before),
        escape_markup(r.to), r.elements_after, number_text(r.length_after), number_text(r.before.total(), 6),
        number_text(r.after.total(), 6), energy_words(r.before, r.after));
  return html + "</ul>\n";
}

// The table of `ropewalk errors --numerics`, with the bands that the charts have.
std::string whole_errors(const ReportInput& in) {
  const NumericRuns& runs = in.whole.runs();
  std::string html = paragraph(
      "The whole error of each result, and what decides it: statistics, the scatter of runs from other starts with "
      "other random numbers; numerics, from runs with half the element length, half the time step and half the "
      "rate of all that is prescribed; parameters, the standard errors of the inputs; and potential, the spread "
      "between four interatomic potentials of carbon. The bands of the charts are all of them together; "
      "errors-statistics.csv, errors-numerics.csv, errors.csv and errors-potential.csv have every row. What the "
      "model itself leaves out is not in them.");
  std::vector<ReportFact> facts;
  const auto add = [&](const std::string& name, const std::string& unit, const WholeError& e) {
    if (!std::isfinite(e.value) || e.total() <= 1e-9 * std::max(1.0, std::fabs(e.value))) return;
    std::string remark = fmt::format("statistics {}, numerics {}{}, parameters {}, potential {}; {} decides",
                                     number_text(e.statistics, 2), e.bound ? "≤ " : "", number_text(e.numerics, 2),
                                     number_text(e.parameters, 2), number_text(e.potential, 2), e.decides);
    if (e.without > 0) remark = fmt::format("{} of the repeated runs have no such value", e.without);
    if (std::isfinite(e.correlation_ps))
      remark += fmt::format("; correlated over {}", picoseconds(e.correlation_ps));
    facts.push_back({name, fmt::format("{} {}", measured_text(e.value, e.total()), unit), remark});
  };
  const std::vector<OutputColumn> results = result_columns();
  for (std::size_t k = 0; k < in.result_errors.size(); ++k)
    add(results[k].name, results[k].unit, in.result_errors[k]);
  for (std::size_t k = 0; k < observables().size(); ++k) {
    const Observable& o = observables()[k];
    if (o.group == ObservableGroup::time || o.name == "time_step_fs") continue;
    add(o.name, o.unit, in.whole.at_end([k](const LogRow& row) { return row.values()[k]; }));
  }
  html += facts_part(facts);
  std::string words;
  for (const NumericSource& s : runs.sources) words += fmt::format("{}: {}. ", s.name, s.change);
  for (const std::string& why : runs.remarks) words += fmt::format("{}. ", why);
  if (runs.mean_ps > 0) words += fmt::format("Values are means over the last {} ps.", number_text(runs.mean_ps, 4));
  return html + paragraph(escape_markup(words));
}

// The table of `ropewalk errors`, likewise.
std::string carried_errors(const ReportInput& in) {
  if (in.log.empty()) return "";
  if (!in.whole.empty()) return whole_errors(in);
  if (in.errors.empty()) return "";
  std::string names;
  for (const ErrorSource& source : in.errors.sources())
    names += fmt::format("{}{} ({:.2g} %)", names.empty() ? "" : ", ", source.name, 100 * source.sigma);
  std::string html = paragraph(
      "Two standard errors that follow from the parameters alone: ± that of the inputs, " + escape_markup(names) +
      ", and ± that of the interatomic potential, from the spread between four potentials of carbon. The bands of "
      "the charts are both together. The run was repeated with each parameter changed; errors.csv and "
      "errors-potential.csv have all rows. What the model itself leaves out is not in them, nor are time step, "
      "length of the elements, rate of loading and noise.");
  std::vector<ReportFact> facts;
  const std::vector<OutputColumn> results = result_columns();
  for (std::size_t k = 0; k < in.result_errors.size(); ++k)
    if (const WholeError& e = in.result_errors[k]; std::isfinite(e.value) && e.total() > 0)
      facts.push_back({results[k].name,
                       fmt::format("{} ± {} ± {} {}", number_text(e.value, 6), number_text(e.parameters, 2),
                                   number_text(e.potential, 2), results[k].unit),
                       ""});
  for (std::size_t k = 0; k < observables().size(); ++k) {
    const Observable& o = observables()[k];
    if (o.name == "step" || o.name == "time_ps") continue;
    const RunErrors::Value value = [k](const LogRow& row) { return row.values()[k]; };
    const ResultError e = in.errors.of(in.log.size() - 1, value);
    if (!has_influence(e, in.log, value)) continue;
    const double moves = movement(in.log, value);
    std::string remark = e.linear ? "" : "not linear in the parameters: an estimate of its size only";
    if (moves > e.error)
      remark += fmt::format("{}still moves by {}", remark.empty() ? "" : "; ", number_text(moves, 2));
    facts.push_back({o.name,
                     fmt::format("{} ± {} ± {} {}", number_text(value(in.log.back()), 6), number_text(e.error, 2),
                                 number_text(e.potential, 2), o.unit),
                     remark});
  }
  return html + facts_part(facts);
}

// The mean over the last half of the log with its error, and its correlation time. `needed`: ps, the longest time
// that a value without an error needs.
std::string mean_cells(const std::vector<LogRow>& log, const std::string& column, double& needed) {
  const LogMean mean = mean_of_last((log.size() + 1) / 2, log, logged(column));
  needed = std::max(needed, mean.needed_ps);
  const bool known = std::isfinite(mean.error) && mean.error > 0;
  return "<td class=\"number\">" + (known ? measured_text(mean.value, mean.error) : std::string("–")) +
         "</td><td class=\"number\">" + (known ? number_text(mean.correlation_ps, 2) : std::string("–")) + "</td>";
}

// The columns of the log, also those that no chart shows, but for those that are zero or nan all the time.
std::string observables_part(const ReportInput& in) {
  const std::vector<LogRow>& log = in.log;
  if (log.empty()) return paragraph("The log has no rows, so nothing is known.");
  const bool timed = log.size() > 2 && !clock_of(log).counts_steps();
  std::string html =
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>Column of log.csv</th><th>Unit</th><th "
      "class=\"number\">Start</th><th class=\"number\">End</th><th class=\"number\">Smallest</th><th "
      "class=\"number\">Largest</th>" +
      std::string(timed ? "<th class=\"number\">Mean of the last half</th><th class=\"number\">Correlated, ps</th>"
                        : "") +
      "<th>Meaning</th></tr></thead><tbody>\n";
  std::string zero;
  double needed = 0;
  for (const Observable& o : observables()) {
    std::vector<double> values = values_of(log, logged(o.name));
    if (std::none_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v != 0; })) {
      zero += (zero.empty() ? "" : ", ") + escape_markup(o.name);
      continue;
    }
    const double start = values.front(), end = values.back();
    const double error = o.group == ObservableGroup::time ? 0 : error_of(in, log.size() - 1, logged(o.name));
    values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
                 values.end());
    const auto number = [&](double v) {
      return "<td class=\"number\">" + (o.whole ? fixed_text(v, 0) : number_text(v)) + "</td>";
    };
    const double none = std::numeric_limits<double>::quiet_NaN();
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    html += "<tr><th>" + escape_markup(o.name) + "</th><td>" + escape_markup(o.unit) + "</td>" + number(start) +
            (error > 0 ? "<td class=\"number\">" + measured_text(end, error) + "</td>" : number(end)) +
            number(values.empty() ? none : *low) + number(values.empty() ? none : *high) +
            (timed ? mean_cells(log, o.name, needed) : "") + "<td class=\"soft\">" + escape_markup(o.meaning) +
            "</td></tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (timed)
    html += paragraph(
        fmt::format("A mean is given where the last half of the run has enough independent values to estimate its "
                    "error, and where the value does not drift.{}",
                    needed > 0 ? fmt::format(" The others would need a run of up to {} ps at the same conditions.",
                                             number_text(needed, 2))
                               : ""));
  return zero.empty() ? html
                      : html + "<p class=\"soft\">Zero, or without a value, in all rows: " + zero + ".</p>\n";
}

// Those of the scene behind the limits that the run passed.
std::vector<std::string> all_warnings(const ReportInput& in) {
  std::vector<std::string> all;
  for (const LimitRecord& r : in.watched.limits)
    if (r.passed)
      all.push_back(fmt::format("{}: limit {}, reached {}{}, beyond it {}{}.", r.key, number_text(r.limit),
                                number_text(r.largest), r.unit.empty() ? "" : " " + r.unit, since_words(r),
                                r.passed_tube < 0 ? "" : ", first in " + place_words(r)));
  all.insert(all.end(), in.warnings.begin(), in.warnings.end());
  return all;
}

// --- The page -----------------------------------------------------------------------------------------------

bool is_zero(const ReportInput& in, const Panel& panel) {
  return std::all_of(in.log.begin(), in.log.end(), [&](const LogRow& row) {
    return std::all_of(panel.traces.begin(), panel.traces.end(), [&](const Trace& t) { return t.value(row) == 0; });
  });
}

// The part on the shape of a rope. Charts that would show a line at zero are named instead.
std::string shape_part(const ReportInput& in, const std::vector<ReportSection>& sections, Figures& figures) {
  std::vector<std::string> charts, zero;
  const auto add = [&](const Panel& panel) {
    if (is_zero(in, panel))
      zero.push_back(panel.title);
    else
      charts.push_back(log_figure(in, panel, figures));
  };
  std::string html;
  if (any_internal(in.shells))
    add(packing_charge());
  else
    html = paragraph("No packing charge: no tube is internal, that is, has six neighbours in the untwisted state.");
  add(twist_angle());
  add(end_twists());
  charts.push_back(radius_figure(in, sections, figures));
  add(amplitude(true));
  add(windings());
  charts.erase(std::remove(charts.begin(), charts.end(), ""), charts.end());
  for (std::size_t k = 0; k < charts.size(); k += 2)
    html += pair_of(charts[k], k + 1 < charts.size() ? charts[k + 1] : "");
  if (!zero.empty()) html += paragraph(fmt::format("Zero at all times: {}.", fmt::join(zero, ", ")));
  return html;
}

std::string log_part(const ReportInput& in, const std::vector<ReportSection>& sections, Figures& figures) {
  if (in.log.size() < 2)
    return heading("Course of the run") + paragraph(in.log.empty()
                                                        ? "The log has no rows, so there are no charts."
                                                        : "The log has one row, so there are no charts over time.");
  const auto panel = [&](const Panel& p) { return log_figure(in, p, figures); };
  // These are statements of their own, since figures are numbered and C++ does not fix the order of evaluation of
  // arguments.
  std::string html = loading_part(in, figures) + heading("Energies");
  const std::string bonds = panel(bond_energies()), others = panel(other_energies(in));
  html += pair_of(bonds, others);
  if (in.rope) {
    html += heading("Packing, twist and shape") + shape_part(in, sections, figures);
  } else {
    html += heading("Shape of the tubes");
    const std::string curved = panel(curvature()), twists = panel(tube_twist());
    html += pair_of(curved, twists);
    if (in.tubes == 1) html += panel(amplitude(false));
  }
  html += heading("Energy balance");
  const std::string work = panel(work_and_heat(in.log)), error = panel(balance(in));
  return html + pair_of(work, error);
}

}  // namespace

std::string report_html(const ReportInput& in) {
  Figures figures;
  const std::vector<ReportSection> sections = some(in.sections);
  std::string html = page_head(in.name) +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: report on a run</p>\n<h1>" +
                     escape_markup(in.name) + "</h1>\n";
  if (const std::string first = lead(in); !first.empty()) html += "<p class=\"lead\">" + first + "</p>\n";
  html += "<p class=\"lead\">" + summary(in) + "</p>\n";
  html += warnings_part(all_warnings(in));
  html += heading(in.rope ? "The rope" : in.tubes == 1 ? "The tube" : "The tubes") + views_figure(in, figures);
  html += paragraph(in.in_space ? "<a href=\"view.html\">In space</a>: turn it, play it, cut through it."
                                : "<code>ropewalk view</code> makes a page that shows the run in space.");
  if (in.rope) html += heading("Cross-sections") + sections_part(in, sections, figures);
  html += log_part(in, sections, figures);
  html += "<a id=\"limits\"></a>" + heading("Beyond the limits of the model") + limits_part(in);
  html += refinements_part(in.watched.refinements);
  if (!in.error_bars.empty() || !in.errors.empty() || !in.whole.empty()) html += heading("Error bars");
  html += carried_errors(in);
  for (const std::string& words : in.error_bars) html += paragraph(escape_markup(words));
  html += heading("All observables") + observables_part(in);
  html += heading("The run") + facts_part(in.facts);
  html += heading("Parameters") + parameters_part(in.parameter_name, in.parameter_reference, in.parameters);
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace ropewalk
