#include "core/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "core/case_text.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

// A local static exists when the first registration needs it, whichever file's comes first.
std::vector<Case (*)()>& registered_cases() {
  static std::vector<Case (*)()> makers;
  return makers;
}

std::string change_name(const char* quantity, double factor) {
  if (factor == 1) return "";
  return fmt::format("{}_{}_{:.0f}_percent_", quantity, factor > 1 ? "plus" : "minus", 100 * std::fabs(factor - 1));
}

Case::Group group_of(const CaseText& text) {
  for (const auto& [name, group] :
       {std::pair("theory", Case::Group::theory), std::pair("atoms", Case::Group::atoms),
        std::pair("codes", Case::Group::codes), std::pair("stability", Case::Group::stability)})
    if (text.group == name) return group;
  throw InputError({text.group + "/" + text.name, 0, ""}, "is not in the folder of a group",
                   "move it to theory, atoms, codes or stability");
}

Case with_text(Case c) {
  const CaseText* text = find_case_text(c.name);
  if (!text)
    throw InputError({c.name + "/case.md", 0, ""}, "is missing", "write it in the folder of the case's name");
  c.group = group_of(*text);
  c.title = text->title;
  c.why = text->why;
  c.setup = text->setup;
  c.oracle = text->oracle;
  c.literature = text->literature;
  c.remarks = text->remarks;
  return c;
}

}  // namespace

double Check::difference() const {
  const double d = value - reference;
  return relative ? d / std::fabs(reference) : d;
}

bool Check::holds() const {
  if (!std::isfinite(value)) return false;
  if (known) return std::fabs(difference() - known->expected) <= known->spread;
  return std::fabs(difference()) <= tolerance;
}

bool CaseResult::holds() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.informative || c.holds(); });
}

std::string Fault::name() const {
  std::string text = change_name("EA", EA) + change_name("EI", EI) + change_name("GJ", GJ) +
                     change_name("contact", contact) + change_name("natural_shape", natural) + (missing_torque ? "missing_torque_" : "");
  if (!text.empty()) text.pop_back();
  return text;
}

Fault wrong_EA(double factor) { return {factor, 1, 1, 1, false}; }
Fault wrong_EI(double factor) { return {1, factor, 1, 1, false}; }
Fault wrong_GJ(double factor) { return {1, 1, factor, 1, false}; }
Fault wrong_stiffnesses(double factor) { return {factor, factor, factor, 1, false}; }
Fault wrong_contact(double factor) { return {1, 1, 1, factor, false}; }
Fault wrong_natural_shape(double factor) { return {1, 1, 1, 1, false, factor}; }
Fault without_torque() { return {1, 1, 1, 1, true}; }

void scale_contact(ParameterSet& set, double factor) {
  if (set.law<LineParameters>()) {
    set.law<LineParameters>()->density.K *= factor;
    set.law<LineParameters>()->universal.epsilon *= factor;
  }
  if (set.law<PaperContact>()) set.law<PaperContact>()->epsilon *= factor;
}

ParameterSet CaseContext::model(std::size_t k) const {
  ParameterSet set = sets.at(k);
  set.bond.stretch *= fault.EA;
  set.bond.bend *= fault.EI;
  set.bond.bend_difference *= fault.EI;
  for (double* part : {&set.bond.natural.x, &set.bond.natural.y, &set.bond.natural.z}) *part *= fault.natural;
  set.bond.twist *= fault.GJ;
  scale_contact(set, fault.contact);
  return set;
}

CaseTube CaseContext::tube(std::size_t k) const {
  return {set(k), model(k), tube_name(set(k)), fmt::format("{} (hash {})", set(k).name, set(k).hash)};
}

std::vector<CaseTube> CaseContext::tubes() const {
  std::vector<CaseTube> all;
  for (std::size_t k = 0; k < sets.size(); ++k) all.push_back(tube(k));
  return all;
}

std::string tube_names(const std::vector<ParameterSet>& sets) {
  std::vector<std::string> names;
  for (const ParameterSet& set : sets)
    if (std::find(names.begin(), names.end(), tube_name(set)) == names.end()) names.push_back(tube_name(set));
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 < names.size() ? ", " : " and ") + names[k];
  return text;
}

CaseResult run_case(const Case& c, const CaseContext& context) {
  CaseResult result = c.run(context);
  result.remarks.insert(result.remarks.begin(), c.remarks.begin(), c.remarks.end());
  for (const CaseTube& tube : context.tubes()) result.sources.push_back(tube.source);
  for (const Case::KnownMiss& miss : c.known_misses)
    for (Check& check : result.checks)
      if (check.name == miss.check) check.known = miss.size;
  return result;
}

bool like(const ParameterSet& i, const ParameterSet& j) {
  if (i.filament || j.filament) return i.filament == j.filament && i.name == j.name;
  return tube_name(i) == tube_name(j) &&
         provenance_value(i, "potential_hash") == provenance_value(j, "potential_hash");
}

void check_applicable(const Case& c, const ParameterSet& given, const std::vector<ParameterSet>& shipped) {
  if (given.filament && (c.group == Case::Group::atoms || c.group == Case::Group::codes))
    throw NotApplicable("a filament has no lattice: there are no atoms to compare it with");
  if (is_shaped(given.bond) && !c.shaped)
    throw NotApplicable("the case is of a filament that is straight at rest and bends alike in all directions");
  const bool of_walls = !shipped.empty() && !shipped.front().walls.empty();
  if (!given.walls.empty() && !of_walls && (c.group == Case::Group::atoms || c.group == Case::Group::codes))
    throw NotApplicable("the atoms of this case are those of a tube of one wall");
  if (given.walls.empty() && of_walls) throw NotApplicable("the case is of tubes of several walls");
  if (c.law == Case::Law::line && !given.law<LineParameters>())
    throw NotApplicable("the set has no contact law `line`");
  if (c.law == Case::Law::paper && !given.law<PaperContact>())
    throw NotApplicable("the set has no contact law `paper`");
  const auto is_like = [&](const ParameterSet& set) { return like(set, given); };
  if (!c.only_these.empty() && std::none_of(shipped.begin(), shipped.end(), is_like))
    throw NotApplicable(c.only_these);
}

RegisteredCase::RegisteredCase(Case (*make)()) { registered_cases().push_back(make); }

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> made;
    for (const auto make : registered_cases()) made.push_back(with_text(make()));
    return sorted_cases(std::move(made));
  }();
  return cases;
}

std::vector<Case> sorted_cases(std::vector<Case> cases) {
  const auto key = [](const Case& c) { return std::tie(c.group, c.order, c.name); };
  std::sort(cases.begin(), cases.end(), [&](const Case& a, const Case& b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t j = i + 1; j < cases.size(); ++j)
      if (cases[i].name == cases[j].name)
        throw std::invalid_argument(
            fmt::format("two validation cases have the name \"{}\": give one another name", cases[i].name));
  return cases;
}

}  // namespace ropewalk::validate
