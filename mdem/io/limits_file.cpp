#include "io/limits_file.hpp"

#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "ropewalk-limits-1";

// One list for writer and reader, in the order of the file.
template <class R, class Visit>
void visit_limit(R& r, const Visit& v) {
  v("key", r.key);
  v("unit", r.unit);
  v("limit", r.limit);
  v("largest", r.largest);
  v("largest_at_ps", r.largest_at_ps);
  v("tube", r.tube);
  v("element", r.element);
  v("passed", r.passed);
  v("passed_at_ps", r.passed_at_ps);
  v("passed_at_step", r.passed_at_step);
}

template <class R, class Visit>
void visit_refinement(R& r, const Visit& v) {
  v("from", r.from);
  v("to", r.to);
  v("time_ps", r.time_ps);
  v("step_before", r.step_before);
  v("step_after", r.step_after);
  v("element_length_before_nm", r.length_before);
  v("element_length_after_nm", r.length_after);
  v("elements_before", r.elements_before);
  v("elements_after", r.elements_after);
}

template <class E, class Visit>
void visit_energies(E& e, const Visit& v) {
  v("stretch", e.potential.stretch);
  v("shear", e.potential.shear);
  v("bend", e.potential.bend);
  v("twist", e.potential.twist);
  v("contact", e.potential.vdw);
  v("kinetic", e.kinetic);
}

auto into(Json& json) {
  return [&json](const char* key, const auto& value) { json[key] = value; };
}
auto out_of(const Json& json) {
  return [&json](const char* key, auto& value) { value = json.at(key).get<std::decay_t<decltype(value)>>(); };
}

}  // namespace

std::string limits_json(const LimitsFile& file) {
  Json json;
  json["format"] = format;
  json["limits"] = Json::array();
  json["refinements"] = Json::array();
  for (const LimitRecord& r : file.limits) visit_limit(r, into(json["limits"].emplace_back()));
  for (const RefinementRecord& r : file.refinements) {
    Json& entry = json["refinements"].emplace_back();
    visit_refinement(r, into(entry));
    visit_energies(r.before, into(entry["energy_before_eV"]));
    visit_energies(r.after, into(entry["energy_after_eV"]));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

LimitsFile read_limits(const std::string& path) {
  const std::string text = read_file(path);
  LimitsFile file;
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != format) throw std::runtime_error("format");
    for (const Json& entry : json.at("limits")) visit_limit(file.limits.emplace_back(), out_of(entry));
    for (const Json& entry : json.at("refinements")) {
      RefinementRecord& r = file.refinements.emplace_back();
      visit_refinement(r, out_of(entry));
      visit_energies(r.before, out_of(entry.at("energy_before_eV")));
      visit_energies(r.after, out_of(entry.at("energy_after_eV")));
    }
  } catch (const std::exception&) {
    throw InputError({path, 0, ""}, "is damaged or of another version", "take it away, or run the scene again");
  }
  return file;
}

}  // namespace ropewalk
