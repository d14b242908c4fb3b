// `compare`: parameter sets side by side. For runs, see compare_runs.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "report/page.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk {
namespace {

constexpr int points = 120;

struct Row {
  const char *name, *key;
};
constexpr Row rows[] = {{"radius", "tube.radius"},
                        {"EA", "bond.EA"},
                        {"EI", "bond.EI"},
                        {"GJ", "bond.GJ"},
                        {"kGA", "bond.kGA"},
                        {"coupling", "atomistic.coupling"},
                        {"natural twist", "atomistic.natural_twist"},
                        {"pair spacing", "contact.line.pair_spacing"},
                        {"pair energy", "contact.line.pair_energy"},
                        {"crossed at 90 deg", "contact.line.cross90_energy"},
                        {"registry", "contact.line.registry"},
                        {"kink curvature", "validity.kink_curvature"},
                        {"collapse, r tau", "validity.twist_collapse"},
                        {"stretch limit", "validity.stretch"}};

std::string cell(const ParameterSet& set, const char* key) {
  const Quantity* q = find_quantity(set, key);
  return q ? measured_text(q->value, q->standard_error.value_or(0)) : "-";
}

std::string unit_of(const std::vector<ParameterSet>& sets, const char* key) {
  for (const ParameterSet& set : sets)
    if (const Quantity* q = find_quantity(set, key)) return q->unit == "1" ? "" : q->unit;
  return "";
}

// "+3.1 % (12 errors)" of a set against the first.
std::string difference(const ParameterSet& first, const ParameterSet& other, const char* key) {
  const Quantity *a = find_quantity(first, key), *b = find_quantity(other, key);
  if (!a || !b || std::fabs(a->value) < 1e-6) return "";
  const double error = std::hypot(a->standard_error.value_or(0), b->standard_error.value_or(0));
  const double change = b->value - a->value;
  return fmt::format("{:+.3g} %{}", 100 * change / std::fabs(a->value),
                     error > 0 && change != 0 ? fmt::format(" ({:.2g} errors)", std::fabs(change) / error) : "");
}

std::vector<std::string> heads(const std::vector<ParameterSet>& sets) {
  std::vector<std::string> out = {"", "unit"};
  for (const ParameterSet& set : sets) out.push_back(set.name);
  for (std::size_t k = 1; k < sets.size(); ++k)
    out.push_back(sets.size() > 2 ? sets[k].name + " against the first" : "difference");
  return out;
}

std::vector<std::vector<std::string>> table(const std::vector<ParameterSet>& sets) {
  std::vector<std::vector<std::string>> out;
  const auto words = [&](const char* name, const std::function<std::string(const ParameterSet&)>& of) {
    out.push_back({name, ""});
    for (const ParameterSet& set : sets) out.back().push_back(of(set));
    for (std::size_t k = 1; k < sets.size(); ++k) out.back().emplace_back();
  };
  words("tube", tube_name);
  words("potential", [](const ParameterSet& set) {
    const std::string name = provenance_value(set, "potential");
    return name.empty() ? "not known" : name;
  });
  for (const Row& row : rows) {
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

void print_table(const std::vector<ParameterSet>& sets) {
  std::vector<std::vector<std::string>> all = {heads(sets)};
  for (auto& row : table(sets)) all.push_back(std::move(row));
  std::vector<std::size_t> widths(all[0].size());
  const auto width = [](const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  };
  for (const auto& row : all)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width(row[k]));
  for (const auto& row : all) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += row[k] + std::string(widths[k] - width(row[k]) + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
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
  return set.line ? line_parallel_energy(set.line->density, distance)
                  : paper_parallel_energy(*set.paper, set.element_length, distance);
}

std::string page(const std::vector<ParameterSet>& sets) {
  Figures figures;
  std::string html = page_head("Parameter sets") +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: parameter sets side by "
                     "side</p>\n<h1>Parameter sets</h1>\n<div class=\"scroll\"><table class=\"facts\"><thead><tr>";
  for (const std::string& head : heads(sets)) html += "<th>" + escape_markup(head) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table(sets)) {
    html += "<tr>";
    for (const std::string& text : row) html += "<td>" + escape_markup(text) + "</td>";
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
       "Twist of one endless tube from its natural twist, up to the collapse of 12 nm."},
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
             return s.line || s.paper;
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
             return s.line.has_value();
           },
           [](const ParameterSet& s, double x) {
             return line_crossed_energy(s.line->density, s.line->pair_spacing, x * units::degree);
           }),
       "Two tubes crossed at the distance of rest of parallel ones, by the line law."}};
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

void print_json(const std::vector<ParameterSet>& sets) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ParameterSet& set : sets) {
    nlohmann::ordered_json j = {{"set", set.name}, {"hash", set.hash}, {"grade", grade_of(set).words()}};
    for (const Row& row : rows)
      if (const Quantity* q = find_quantity(set, row.key)) {
        j[row.key] = {{"value", q->value}, {"unit", q->unit}};
        j[row.key]["standard_error"] =
            q->standard_error ? nlohmann::ordered_json(*q->standard_error) : nlohmann::ordered_json();
      }
    all.push_back(std::move(j));
  }
  fmt::print("{}\n", all.dump(1));
}

}  // namespace

int compare_command(const CompareArguments& a) {
  if (std::any_of(a.names.begin(), a.names.end(), [](const auto& name) { return std::filesystem::is_directory(name); }))
    return compare_runs(a);
  if (a.names.size() < 2)
    throw InputError({"", 0, "names"}, "is one set", "name at least two: files, or names of shipped sets");
  std::vector<ParameterSet> sets;
  for (const std::string& name : a.names)
    sets.push_back(read_parameters(find_parameters(name, "", {"", 0, "names"})));
  if (a.json)
    print_json(sets);
  else
    print_table(sets);
  if (a.page.empty()) return 0;
  refuse_existing(a.page, "--page", a.force);
  write_file_atomically(a.page, page(sets));
  if (!a.json) fmt::print("Page: {}\n", a.page);
  return 0;
}

}  // namespace ropewalk
