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

void scale_contact(ParameterSet& set, double factor) {
  if (set.line) {
    set.line->density.K *= factor;
    set.line->universal.epsilon *= factor;
  }
  if (set.paper) set.paper->epsilon *= factor;
}

ParameterSet CaseContext::model(const std::string& name) const {
  ParameterSet set = parameters(name);
  set.bond.stretch *= fault.EA;
  set.bond.bend *= fault.EI;
  set.bond.twist *= fault.GJ;
  scale_contact(set, fault.contact);
  return set;
}

}  // namespace ropewalk
