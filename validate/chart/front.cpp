// Errors, Pareto fronts and the table of the points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "chart/chart.hpp"
#include "io/csv_reader.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

constexpr double min_charge = 6;  // that of an ideally packed twisted rope

const ChartPoint* finest_of(const std::vector<ChartPoint>& points, const std::string& scene) {
  for (const ChartPoint& p : points)
    if (p.scene == scene && p.model == finest_model && p.error.empty()) return &p;
  return nullptr;
}

ChartRow row_of(const ChartPoint& p, const std::string& observable, double reference, const std::string& kind) {
  const double value = p.values.at(observable);
  return {&p, observable, value, reference, kind, error_of(observable, value, reference)};
}

}  // namespace

double error_of(const std::string& observable, double value, double reference) {
  const double size = observable == "Q" ? std::max(std::fabs(reference), min_charge) : std::fabs(reference);
  return std::fabs(value - reference) / size;
}

std::vector<ChartRow> chart_rows(const std::vector<ChartPoint>& points) {
  std::vector<ChartRow> rows;
  for (const ChartScene& scene : chart_scenes()) {
    const ChartPoint* finest = finest_of(points, scene.name);
    const std::vector<ChartReference> atoms = scene.atoms();
    for (const ChartPoint& p : points) {
      if (p.scene != scene.name || !p.error.empty()) continue;
      for (const std::string& o : scene.observables) {
        if (finest) rows.push_back(row_of(p, o, finest->values.at(o), "finest"));
        for (const ChartReference& a : atoms)
          if (a.observable == o) rows.push_back(row_of(p, o, a.value, "md"));
      }
    }
  }
  return rows;
}

std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<std::size_t> order(cost.size()), front;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b];
  });
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t k : order) {
    if (!std::isfinite(cost[k]) || !(error[k] < best)) continue;
    best = error[k];
    front.push_back(k);
  }
  return front;
}

std::vector<OutputColumn> points_columns() {
  return {
      {"scene", "", "scene of the chart"},
      {"model", "", "name of the model"},
      {"kind", "", "knob that the model turns, or finest, default, published"},
      {"law", "", "contact law: line, paper or none"},
      {"nodes_per_element", "", "nodes of the line law; 0: none"},
      {"cutoff_nm", "nm", "cutoff of the contact; 0: none"},
      {"element_length_nm", "nm", "length of an element"},
      {"integrator", "", "integrator"},
      {"time_step_fs", "fs", "time step"},
      {"mass_scale", "", "masses, over those of the tubes"},
      {"mode", "", "dynamics or relax"},
      {"contact_viscosity", "eV ps/nm^2", "viscosity of the contact"},
      {"bond_damping", "1/ps", "damping of the bonds"},
      {"precision", "", "mixed or double"},
      {"elements", "", "elements of the scene"},
      {"simulated_ps", "ps", "simulated time"},
      {"element_steps_per_ns", "1/ns", "element steps per simulated time"},
      {"cpu_s_per_ns", "s/ns", "processor time per simulated time"},
      {"cpu_ns_per_element_step", "ns", "processor time of a step of one element"},
      {"instructions_per_element_step", "",
       "instructions of a step of one element, counted by callgrind; empty: not counted"},
      {"observable", "", "what is compared"},
      {"unit", "", "unit of value and reference"},
      {"value", "`unit`", "value of the model"},
      {"reference", "`unit`", "value of the reference"},
      {"reference_kind", "", "finest: the finest model; md: atoms"},
      {"error", "", "difference of value and reference over the reference"},
      {"failure", "", "why the model could not be run; such a row has no cost and no values"},
  };
}

std::string points_csv(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows) {
  std::string text = column_names(points_columns()) + "\n";
  const auto settings = [](const ChartPoint& p) {
    return fmt::format("{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:g},{},{:g},{:g},{},{},{:g}", p.scene, p.model,
                       p.kind, p.law, p.nodes, p.cutoff, p.element_length, p.integrator, p.time_step / units::fs,
                       p.mass_scale, p.mode, p.contact_viscosity, p.bond_damping, p.precision, p.elements,
                       p.simulated);
  };
  for (const ChartPoint& p : points) {
    if (!p.error.empty()) text += fmt::format("{},,,,,,,,,,,{}\n", settings(p), csv_cell(p.error));
    for (const ChartRow& r : rows)
      if (r.point == &p)
        text += fmt::format("{},{:.6g},{:.4g},{:.4g},{},{},{},{:.8g},{:.8g},{},{:.4g},\n", settings(p),
                            p.element_steps_per_ns(), p.cpu_per_ns(), 1e9 * p.cpu_per_element_step(),
                            p.instructions ? fmt::format("{:.5g}", *p.instructions) : "", r.observable,
                            observable_unit(r.observable), r.value, r.reference, r.reference_kind, r.error);
  }
  return text;
}

namespace {

// The cells of a row by the names of their columns.
class PointCells {
 public:
  explicit PointCells(const CsvReader& csv) : csv_(csv) {}

  std::string text(const char* column) const { return std::string(csv_.cells()[at(column)]); }
  double number(const char* column) const { return csv_.finite_number(at(column), column); }
  int whole(const char* column) const {
    const double v = number(column);
    if (v != std::floor(v) || std::fabs(v) > 1e9) csv_.fail(column, "is not a whole number", "restore the file");
    return static_cast<int>(v);
  }

 private:
  static std::size_t at(const std::string& column) {
    static const std::vector<OutputColumn> columns = points_columns();
    std::size_t k = 0;
    while (columns[k].name != column) ++k;
    return k;
  }
  const CsvReader& csv_;
};

// Whether this program has such a model, which the page names in words.
bool is_known(const ChartPoint& p) {
  for (const ChartScene& scene : chart_scenes())
    if (scene.name == p.scene)
      for (const ChartModel& m : chart_models(scene, false))
        if (m.name == p.model) return m.kind == p.kind;
  return false;
}

bool has_observable(const std::string& scene, const std::string& observable) {
  const std::vector<std::string>& all = find_chart_scene(scene).observables;
  return std::count(all.begin(), all.end(), observable) > 0;
}

ChartPoint point_of(const PointCells& cells) {
  ChartPoint p;
  p.scene = cells.text("scene");
  p.model = cells.text("model");
  p.kind = cells.text("kind");
  p.law = cells.text("law");
  p.nodes = cells.whole("nodes_per_element");
  p.cutoff = cells.number("cutoff_nm");
  p.element_length = cells.number("element_length_nm");
  p.integrator = cells.text("integrator");
  p.time_step = cells.number("time_step_fs") * units::fs;
  p.mass_scale = cells.number("mass_scale");
  p.mode = cells.text("mode");
  p.contact_viscosity = cells.number("contact_viscosity");
  p.bond_damping = cells.number("bond_damping");
  p.precision = cells.text("precision");
  p.elements = cells.whole("elements");
  p.simulated = cells.number("simulated_ps");
  p.error = cells.text("failure");
  if (!p.error.empty()) return p;
  p.steps = cells.number("element_steps_per_ns") * 1e-3 * p.simulated / p.elements;
  p.cpu = cells.number("cpu_s_per_ns") * 1e-3 * p.simulated;
  if (!cells.text("instructions_per_element_step").empty())
    p.instructions = cells.number("instructions_per_element_step");
  return p;
}

}  // namespace

ChartTable read_points_csv(const std::string& path) {
  CsvReader csv(path);
  const std::string names = csv.next() ? std::string(csv.line_text()) : "";
  if (names != column_names(points_columns()))
    throw InputError({path, 1, ""}, "is not a table of points of this chart",
                     "give a points.csv that `ropewalk validate chart` has written");
  ChartTable table;
  std::vector<std::size_t> point_of_row;
  const PointCells cells(csv);
  while (csv.next()) {
    if (csv.cells().size() != points_columns().size())
      csv.fail("", "has another number of cells than there are columns", "restore the file");
    const ChartPoint p = point_of(cells);
    const bool known =
        !table.points.empty() && table.points.back().scene == p.scene && table.points.back().model == p.model;
    if (!known) {
      if (!is_known(p)) csv.fail("model", "is not a model of this program", "measure the chart anew");
      table.points.push_back(p);
    }
    if (!p.error.empty()) continue;
    if (!(p.elements > 0 && p.simulated > 0 && p.cpu > 0)) csv.fail("", "has no cost", "restore the file");
    ChartRow r;
    r.observable = cells.text("observable");
    if (!has_observable(p.scene, r.observable))
      csv.fail("observable", "is not measured in this scene", "restore the file");
    r.value = cells.number("value");
    r.reference = cells.number("reference");
    r.reference_kind = cells.text("reference_kind");
    r.error = cells.number("error");
    table.points.back().values[r.observable] = r.value;
    table.rows.push_back(r);
    point_of_row.push_back(table.points.size() - 1);
  }
  for (std::size_t k = 0; k < table.rows.size(); ++k) table.rows[k].point = &table.points[point_of_row[k]];
  return table;
}

}  // namespace ropewalk::validate
