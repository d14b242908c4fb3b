#include "core/case.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk {

double Check::difference() const {
  const double d = value - reference;
  return relative ? d / std::fabs(reference) : d;
}

bool Check::holds() const { return std::isfinite(value) && std::fabs(difference()) <= tolerance; }

bool CaseResult::holds() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.informative || c.holds(); });
}

ParameterSet CaseContext::model(const std::string& name) const {
  ParameterSet set = parameters(name);
  set.bond.stretch *= fault.EA;
  set.bond.bend *= fault.EI;
  set.bond.twist *= fault.GJ;
  if (set.line) {
    set.line->density.K *= fault.contact;
    set.line->universal.epsilon *= fault.contact;
  }
  if (set.paper) set.paper->epsilon *= fault.contact;
  return set;
}

}  // namespace ropewalk
