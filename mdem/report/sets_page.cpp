#include "report/sets_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/potential_spread.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "report/page.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk {
namespace {

constexpr int points = 120;

struct Row {
  const char *name, *key;
};
constexpr Row compared[] = {{"radius", "tube.radius"},
                            {"contact radius", "filament.contact_radius"},
                            {"mass per length", "filament.mass_per_length"},
                            {"EA", "bond.EA"},
                            {"EI", "bond.EI"},
                            {"EI_1", "bond.EI_1"},
                            {"EI_2", "bond.EI_2"},
                            {"GJ", "bond.GJ"},
                            {"kGA", "bond.kGA"},
                            {"coupling", "atomistic.coupling"},
                            {"natural twist", "atomistic.natural_twist"},
                            {"twist at rest", "filament.twist_per_length"},
                            {"curvature_1", "filament.curvature_1"},
                            {"curvature_2", "filament.curvature_2"},
                            {"pair spacing", "contact.line.pair_spacing"},
                            {"pair energy", "contact.line.pair_energy"},
                            {"crossed at 90 deg", "contact.line.cross90_energy"},
                            {"registry", "contact.line.registry"},
                            {"kink curvature", "validity.kink_curvature"},
                            {"collapse, r tau", "validity.twist_collapse"},
                            {"stretch limit", "validity.stretch"}};

std::string cell(const ParameterSet& set, const char* key) {
  const Quantity* q = find_quantity(set, key);
  return q ? measured_text(*q) : "-";
}

std::string unit_of(const std::vector<ParameterSet>& sets, const char* key) {
  for (const ParameterSet& set : sets)
    if (const Quantity* q = find_quantity(set, key)) return q->unit == "1" ? "" : q->unit;
  return "";
}

// The difference of a set from the first, as "+3.1 % (12 errors)". For sets of two potentials the error holds the
// spread between potentials as well.
std::string difference(const ParameterSet& first, const ParameterSet& other, const char* key) {
  const Quantity *a = find_quantity(first, key), *b = find_quantity(other, key);
  if (!a || !b || std::fabs(a->value) < 1e-6) return "";
  const bool alike = provenance_value(first, "potential_hash") == provenance_value(other, "potential_hash");
  const double spread = alike || !a->of_carbon || !b->of_carbon ? 0 : potential_spread(key);
  const double error = std::hypot(std::hypot(a->standard_error.value_or(0), b->standard_error.value_or(0)),
                                  spread * a->value, spread * b->value);
  const double change = b->value - a->value;
  return fmt::format("{:+.3g} %{}", 100 * change / std::fabs(a->value),
                     error > 0 && change != 0 ? fmt::format(" ({:.2g} errors)", std::fabs(change) / error) : "");
}

// A curve of every set that has it.
LineChart chart_of(const std::vector<ParameterSet>& sets, const char* title, const ChartAxis& x, const ChartAxis& y,
                   const std::function<bool(const ParameterSet&, double& from, double& to)>& range,
                   const std::function<double(const ParameterSet&, double)>& value) {
  LineChart chart;
  chart.title = title;
  chart.x = x;
  chart.y = y;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    double from = 0, to = 0;
    if (!range(sets[k], from, to)) continue;
    ChartLine line{sets[k].name, {}, {}, static_cast<int>(k)};
    for (int i = 0; i <= points; ++i) {
      line.x.push_back(from + (to - from) * i / points);
      line.y.push_back(value(sets[k], line.x.back()));
    }
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

double parallel(const ParameterSet& set, double distance) {
  return set.law<LineParameters>() ? line_parallel_energy(set.law<LineParameters>()->density, distance)
                                   : paper_parallel_energy(*set.law<PaperContact>(), set.element_length, distance);
}

std::vector<std::string> heads(const std::vector<ParameterSet>& sets) {
  std::vector<std::string> out = {"", "unit"};
  for (const ParameterSet& set : sets) out.push_back(set.name);
  for (std::size_t k = 1; k < sets.size(); ++k)
    out.push_back(sets.size() > 2 ? sets[k].name + " against the first" : "difference");
  return out;
}

}  // namespace

std::vector<std::vector<std::string>> sets_table(const std::vector<ParameterSet>& sets) {
  std::vector<std::vector<std::string>> out = {heads(sets)};
  const auto words = [&](const char* name, const std::function<std::string(const ParameterSet&)>& of) {
    out.push_back({name, ""});
    for (const ParameterSet& set : sets) out.back().push_back(of(set));
    for (std::size_t k = 1; k < sets.size(); ++k) out.back().emplace_back();
  };
  words("tube", tube_name);
  words("potential", [](const ParameterSet& set) {
    const std::string name = provenance_value(set, "potential");
    return set.filament ? "none: a filament" : name.empty() ? "not known" : name;
  });
  for (const Row& row : compared) {
    if (std::all_of(sets.begin(), sets.end(), [&](const ParameterSet& set) { return cell(set, row.key) == "-"; }))
      continue;
    out.push_back({row.name, unit_of(sets, row.key)});
    for (const ParameterSet& set : sets) out.back().push_back(cell(set, row.key));
    for (std::size_t k = 1; k < sets.size(); ++k) out.back().push_back(difference(sets[0], sets[k], row.key));
  }
  words("bonds", [](const ParameterSet& set) { return set.anharmonic ? "anharmonic" : "harmonic"; });
  words("grade", [](const ParameterSet& set) {
    return grade_of(set).level == Grade::Level::good      ? "good"
           : grade_of(set).level == Grade::Level::limited ? "limited"
                                                          : "unfit";
  });
  return out;
}

std::string sets_page(const std::vector<ParameterSet>& sets) {
  Figures figures;
  std::string html = page_head("Parameter sets") +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: parameter sets side by "
                     "side</p>\n<h1>Parameter sets</h1>\n<div class=\"scroll\"><table class=\"facts whole\"><thead><tr>";
  const std::vector<std::vector<std::string>> rows = sets_table(sets);
  for (const std::string& head : rows.front()) html += "<th>" + escape_markup(head) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t k = 1; k < rows.size(); ++k) {
    html += "<tr>";
    for (const std::string& text : rows[k]) html += "<td>" + escape_markup(text) + "</td>";
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  const ChartAxis energy{"energy per length", "eV/nm"};
  const auto bonds = [](const ParameterSet& set, double strain, double twist, double curvature) {
    return chain_energy(set.anharmonic_bond(0), set.element_length, strain, twist, curvature);
  };
  const std::pair<LineChart, const char*> charts[] = {
      {chart_of(
           sets, "Energy against strain", {"strain", "%"}, energy,
           [](const ParameterSet& s, double& a, double& b) {
             a = -100 * s.validity.stretch, b = -a;
             return true;
           },
           [&](const ParameterSet& s, double x) { return bonds(s, 0.01 * x, 0, 0); }),
       "Stretch of one tube, up to the limits of the sets."},
      {chart_of(
           sets, "Energy against twist", {"radius times twist", "1"}, energy,
           [](const ParameterSet& s, double& a, double& b) {
             b = s.validity.twist_collapse, a = -b;
             return true;
           },
           [&](const ParameterSet& s, double x) { return bonds(s, 0, x / s.radius, 0); }),
       "Twist of one endless tube from its natural twist, up to the collapse of a tube of 12 nm."},
      {chart_of(
           sets, "Energy against curvature", {"radius times curvature", "1"}, energy,
           [](const ParameterSet& s, double& a, double& b) {
             a = 0, b = s.radius * s.validity.kink_curvature;
             return true;
           },
           [&](const ParameterSet& s, double x) { return bonds(s, 0, 0, x / s.radius); }),
       "Bending of one tube, up to the kink."},
      {chart_of(
           sets, "Energy of two parallel tubes", {"distance of the axes minus 2 r", "nm"}, energy,
           [](const ParameterSet& s, double& a, double& b) {
             a = 0.285, b = 0.9;
             if (s.filament && s.law<LineParameters>()) {
               const double gap = s.law<LineParameters>()->pair_spacing - 2 * s.radius;
               a = 0.9 * gap, b = 3 * gap;
             }
             return s.law<LineParameters>() || s.law<PaperContact>();
           },
           [](const ParameterSet& s, double x) {
             const double e = parallel(s, x + 2 * s.radius);
             return e > 0.5 ? std::nan("") : e;
           }),
       "Two parallel tubes, by the line law where the set has it, else by the published law."},
      {chart_of(
           sets, "Energy of crossed tubes", {"crossing angle", "degrees"}, {"energy", "eV"},
           [](const ParameterSet& s, double& a, double& b) {
             a = 15, b = 90;
             return s.law<LineParameters>() != nullptr;
           },
           [](const ParameterSet& s, double x) {
             return line_crossed_energy(s.law<LineParameters>()->density, s.law<LineParameters>()->pair_spacing,
                                        x * units::degree);
           }),
       "Two tubes that cross at the equilibrium distance of parallel ones, by the line law."}};
  std::string pair;
  for (std::size_t k = 0; k < std::size(charts); ++k) {
    const std::string svg = chart_svg(charts[k].first);
    if (k % 2 == 0) html += "<div class=\"pair\">\n";
    if (!svg.empty()) html += "<figure>" + svg + figures.caption(charts[k].second) + "</figure>\n";
    if (k % 2 == 1 || k + 1 == std::size(charts)) html += "</div>\n";
  }
  for (const ParameterSet& set : sets)
    html += paragraph(escape_markup(fmt::format("{} (hash {}): {}", set.name, set.hash, grade_of(set).words())));
  return html + "</main>\n</body>\n</html>\n";
}

std::string sets_json(const std::vector<ParameterSet>& sets) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ParameterSet& set : sets) {
    nlohmann::ordered_json j = {{"set", set.name}, {"hash", set.hash}, {"grade", grade_of(set).words()}};
    for (const Row& row : compared)
      if (const Quantity* q = find_quantity(set, row.key)) {
        j[row.key] = {{"value", q->value}, {"unit", q->unit}};
        j[row.key]["standard_error"] =
            q->standard_error ? nlohmann::ordered_json(*q->standard_error) : nlohmann::ordered_json();
        if (const double spread = q->of_carbon ? potential_spread(row.key) : 0; spread > 0)
          j[row.key]["potential_error"] = spread * std::fabs(q->value);
      }
    all.push_back(std::move(j));
  }
  return all.dump(1);
}

}  // namespace ropewalk
