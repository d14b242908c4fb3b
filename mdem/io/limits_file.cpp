#include "io/limits_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "observe/limits.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* limits_format = "ropewalk-limits-1";

// One list for writer, reader and documentation, in the order of the file.
template <class R, class Visit>
void visit_limit(R&& r, const Visit& v) {
  v({"key", "", "key in the [limits] of a scene"}, r.key);
  v({"unit", "", "unit of limit and largest"}, r.unit);
  v({"limit", "`unit`", "the limit, below 0 where a bond is pressed; 0: not watched"}, r.limit);
  v({"largest", "`unit`", "the value farthest beyond its limit so far, below 0 where a bond is pressed"}, r.largest);
  v({"largest_at_ps", "ps", "time of the largest value"}, r.largest_at_ps);
  v({"tube", "", "tube of the largest value, from 0; -1: none, or of the run as a whole"}, r.tube);
  v({"element", "", "element of the largest value, counted in the tube from 0; of a bond the first"}, r.element);
  v({"passed", "", "whether the limit was passed"}, r.passed);
  v({"passed_at_ps", "ps", "time when it was passed first"}, r.passed_at_ps);
  v({"passed_at_step", "", "time step when it was passed first"}, r.passed_at_step);
  v({"passed_tube", "", "tube where it was passed first, from 0; -1: not passed, or of the run as a whole"},
    r.passed_tube);
  v({"passed_element", "", "element where it was passed first, counted in the tube from 0; of a bond the first"},
    r.passed_element);
  v({"passed_held_by", "", "what holds that place, as `the upper clamp`; empty: nothing"}, r.passed_held_by);
}

template <class R, class Visit>
void visit_refinement(R&& r, const Visit& v) {
  v({"from", "", "end of the name of the directory that was refined: none, `.fine`, `.fine2`"}, r.from);
  v({"to", "", "end of the name of the directory that goes on"}, r.to);
  v({"time_ps", "ps", "time of the refinement"}, r.time_ps);
  v({"step_before", "", "time step in the coarse run"}, r.step_before);
  v({"step_after", "", "time step in the fine run"}, r.step_after);
  v({"element_length_before_nm", "nm", "length of an element in the coarse run"}, r.length_before);
  v({"element_length_after_nm", "nm", "length of an element in the fine run"}, r.length_after);
  v({"elements_before", "", "elements of the coarse run"}, r.elements_before);
  v({"elements_after", "", "elements of the fine run"}, r.elements_after);
}

template <class E, class Visit>
void visit_energies(E&& e, const Visit& v) {
  v({"stretch", "eV", "stretch energy of the bonds"}, e.potential.stretch);
  v({"shear", "eV", "shear energy of the bonds"}, e.potential.shear);
  v({"bend", "eV", "bending energy of the bonds"}, e.potential.bend);
  v({"twist", "eV", "torsional energy of the bonds"}, e.potential.twist);
  v({"contact", "eV", "van der Waals energy of the contacts"}, e.potential.vdw);
  v({"terms", "eV", "energy of all force terms"}, e.potential.terms);
  v({"kinetic", "eV", "kinetic energy"}, e.kinetic);
}

auto into(Json& json) {
  return [&json](const OutputColumn& key, const auto& value) { json[key.name] = value; };
}
auto out_of(const Json& json) {
  return [&json](const OutputColumn& key, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    for (const char* later :
         {"passed_tube", "passed_element", "passed_held_by"})  // not written by earlier versions
      if (std::string(later) == key.name && !json.contains(key.name)) return;
    const Json& entry = json.at(key.name);
    if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>)
      if (!entry.is_number_integer()) throw std::runtime_error("no whole number");
    value = entry.get<Value>();
    if constexpr (std::is_same_v<Value, std::string>)
      if (has_control_character(value)) throw std::runtime_error("control character");
  };
}

auto listed_in(std::vector<OutputColumn>& keys) {
  return [&keys](const OutputColumn& key, const auto&) { keys.push_back(key); };
}

}  // namespace

std::vector<OutputColumn> limit_keys() {
  std::vector<OutputColumn> keys;
  visit_limit(LimitRecord(), listed_in(keys));
  return keys;
}

std::vector<OutputColumn> refinement_keys() {
  std::vector<OutputColumn> keys;
  visit_refinement(RefinementRecord(), listed_in(keys));
  keys.push_back({"energy_before_eV", "eV", "energies before the refinement, by kind"});
  keys.push_back({"energy_after_eV", "eV", "energies after the refinement, by kind"});
  return keys;
}

std::vector<OutputColumn> energy_keys() {
  std::vector<OutputColumn> keys;
  visit_energies(EnergyParts(), listed_in(keys));
  return keys;
}

const LimitRecord* first_limit(const std::vector<LimitRecord>& limits) {
  const LimitRecord* first = nullptr;
  for (const LimitRecord& r : limits)
    if (r.passed && (!first || std::tie(r.passed_at_ps, r.passed_at_step) <
                                   std::tie(first->passed_at_ps, first->passed_at_step)))
      first = &r;
  return first;
}

std::string since_words(const LimitRecord& r) {
  if (r.passed_at_step == 0) return "from the start on";
  return r.passed_at_ps > 0 ? fmt::format("from {:.4g} ps on", r.passed_at_ps)
                            : fmt::format("from step {} on", r.passed_at_step);
}

std::string place_words(const LimitRecord& r) {
  if (r.passed_tube < 0) return "";
  return fmt::format("tube {}, element {}{}", r.passed_tube, r.passed_element,
                     r.passed_held_by.empty() ? "" : ", at " + r.passed_held_by);
}

std::string beyond_words(const std::vector<LimitRecord>& limits) {
  const LimitRecord* first = first_limit(limits);
  return first ? fmt::format("beyond {} {}", first->key, since_words(*first)) : "";
}

std::string status_words(const std::string& status, const std::vector<LimitRecord>& limits) {
  const std::string beyond = beyond_words(limits);
  return beyond.empty() ? status : status + ", " + beyond;
}

std::string beyond_sentence(const std::vector<LimitRecord>& limits) {
  const LimitRecord* first = first_limit(limits);
  if (!first) return "";
  std::string since = since_words(*first);
  since[0] = 'F';
  std::string text = fmt::format("{} this run is beyond a limit of its model: {}", since, first->key);
  if (first->passed_tube >= 0) text += ", passed in " + place_words(*first);
  for (const LimitKind& kind : limit_kinds())
    if (first->key == kind.key) text += fmt::format(": {}", kind.consequence);
  const auto others =
      std::count_if(limits.begin(), limits.end(), [](const LimitRecord& r) { return r.passed; }) - 1;
  text += others == 0   ? "."
          : others == 1 ? ". Another limit was passed as well."
                        : fmt::format(". {} other limits were passed as well.", others);
  return text;
}

std::string worst_words(const std::vector<LimitRecord>& limits) {
  const LimitRecord* worst = nullptr;
  const auto ratio = [](const LimitRecord& r) { return r.passed && r.limit != 0 ? r.largest / r.limit : 0; };
  for (const LimitRecord& r : limits)
    if (ratio(r) > (worst ? ratio(*worst) : 0)) worst = &r;
  return worst ? fmt::format("{} reached {:.3g} times its limit", worst->key, ratio(*worst)) : "";
}

double beyond_limits(const std::vector<LimitRecord>& limits) {
  double most = 0;
  for (const LimitRecord& r : limits)
    if (r.passed && r.limit != 0) most = std::max(most, r.largest / r.limit);
  return most;
}

std::string limits_json(const LimitsFile& file) {
  Json json;
  json["format"] = limits_format;
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

LimitsFile read_limits(const std::string& path) { return limits_of_text(read_file(path), path); }

LimitsFile limits_of_text(const std::string& text, const std::string& path) {
  LimitsFile file;
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != limits_format) throw std::runtime_error("format");
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
