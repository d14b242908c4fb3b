#include "chart/point.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* point_format = "ropewalk-chart-1";

}  // namespace

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
  const auto whole = [&](const char* key) {
    if (!in.at(key).is_number_integer()) throw wrong();
    return in.at(key).get<int>();
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
    p.nodes = whole("nodes_per_element");
    p.elements = whole("elements");
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

}  // namespace ropewalk::validate
