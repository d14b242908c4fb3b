// Errors, Pareto fronts and the files of the points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "chart/chart.hpp"
#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* point_format = "ropewalk-chart-1";
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
      {"contact_every", "", "steps of the bonds per step of the contact"},
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
        "{},{},{},{},{},{:.6g},{:.6g},{},{},{:.6g},{:g},{},{:g},{:g},{},{},{:g},{:.6g},{:.4g},{:.4g},{},{},{},{:."
        "8g},"
        "{:.8g},{},{:.4g}\n",
        p.scene, p.model, p.kind, p.law, p.nodes, p.cutoff, p.element_length, p.integrator, p.contact_every,
        p.time_step / units::fs, p.mass_scale, p.mode, p.contact_viscosity, p.bond_damping, p.precision, p.elements,
        p.simulated, p.element_steps_per_ns(), p.cpu_per_ns(), 1e9 * p.cpu_per_element_step(),
        p.instructions ? fmt::format("{:.5g}", *p.instructions) : "", r.observable, observable_unit(r.observable),
        r.value, r.reference, r.reference_kind, r.error);
  }
  return text;
}

std::string point_json(const ChartPoint& p) {
  Json out = {{"format", point_format},
              {"key", p.key},
              {"error", p.error},
              {"scene", p.scene},
              {"model", p.model},
              {"kind", p.kind},
              {"law", p.law},
              {"integrator", p.integrator},
              {"mode", p.mode},
              {"precision", p.precision},
              {"nodes_per_element", p.nodes},
              {"contact_every", p.contact_every},
              {"elements", p.elements},
              {"cutoff_nm", p.cutoff},
              {"element_length_nm", p.element_length},
              {"time_step_ps", p.time_step},
              {"mass_scale", p.mass_scale},
              {"contact_viscosity_eV_ps_per_nm2", p.contact_viscosity},
              {"bond_damping_per_ps", p.bond_damping},
              {"simulated_ps", p.simulated},
              {"steps", p.steps},
              {"cpu_s", p.cpu},
              {"instructions_per_element_step", p.instructions ? Json(*p.instructions) : Json(nullptr)},
              {"values", p.values}};
  return out.dump(1) + "\n";
}

ChartPoint read_point(const std::string& path) {
  const Json in = Json::parse(read_file(path), nullptr, false);
  const auto wrong = [&] {
    return InputError({path, 0, ""}, "is not a point of this chart", "take it away, or choose another --out");
  };
  try {
    if (!in.is_object() || in.at("format") != point_format) throw wrong();
    ChartPoint p;
    p.key = in.at("key");
    p.error = in.at("error");
    p.scene = in.at("scene");
    p.model = in.at("model");
    p.kind = in.at("kind");
    p.law = in.at("law");
    p.integrator = in.at("integrator");
    p.mode = in.at("mode");
    p.precision = in.at("precision");
    p.nodes = in.at("nodes_per_element");
    p.contact_every = in.at("contact_every");
    p.elements = in.at("elements");
    p.cutoff = in.at("cutoff_nm");
    p.element_length = in.at("element_length_nm");
    p.time_step = in.at("time_step_ps");
    p.mass_scale = in.at("mass_scale");
    p.contact_viscosity = in.at("contact_viscosity_eV_ps_per_nm2");
    p.bond_damping = in.at("bond_damping_per_ps");
    p.simulated = in.at("simulated_ps");
    p.steps = in.at("steps");
    // A point that failed has no cost; JSON has null for NaN.
    p.cpu = in.at("cpu_s").is_null() ? std::numeric_limits<double>::quiet_NaN() : in.at("cpu_s").get<double>();
    if (!in.at("instructions_per_element_step").is_null()) p.instructions = in.at("instructions_per_element_step");
    p.values = in.at("values").get<std::map<std::string, double>>();
    return p;
  } catch (const Json::exception&) {
    throw wrong();
  }
}

}  // namespace ropewalk
