// Errors, Pareto fronts and the table of the points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "chart/chart.hpp"

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
    const std::vector<ChartReference> atoms = scene.atoms ? scene.atoms() : std::vector<ChartReference>();
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
  };
}

std::string points_csv(const std::vector<ChartRow>& rows) {
  std::string text = column_names(points_columns()) + "\n";
  for (const ChartRow& r : rows) {
    const ChartPoint& p = *r.point;
    text += fmt::format(
        "{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:g},{},{:g},{:g},{},{},{:g},{:.6g},{:.4g},{:.4g},{},{},{},{:."
        "8g},"
        "{:.8g},{},{:.4g}\n",
        p.scene, p.model, p.kind, p.law, p.nodes, p.cutoff, p.element_length, p.integrator,
        p.time_step / units::fs, p.mass_scale, p.mode, p.contact_viscosity, p.bond_damping, p.precision, p.elements,
        p.simulated, p.element_steps_per_ns(), p.cpu_per_ns(), 1e9 * p.cpu_per_element_step(),
        p.instructions ? fmt::format("{:.5g}", *p.instructions) : "", r.observable, observable_unit(r.observable),
        r.value, r.reference, r.reference_kind, r.error);
  }
  return text;
}

}  // namespace ropewalk::validate
