// Shared by the tests of the cases: the faults, and a case run with one of them on the stored references.
#pragma once

#include "cases/cases.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk::test {

inline Fault stiffer_stretch() {
  Fault f;
  f.EA = 1.1;
  return f;
}
inline Fault stiffer_bend() {
  Fault f;
  f.EI = 1.1;
  return f;
}
inline Fault softer_twist() {
  Fault f;
  f.GJ = 0.9;
  return f;
}
inline Fault twice_the_contact() {
  Fault f;
  f.contact = 2;
  return f;
}
inline Fault missing_torque() {
  Fault f;
  f.missing_torque = true;
  return f;
}

inline CaseContext stored_context() {
  CaseContext context;
  context.parameters = [](const std::string& name) { return read_parameters(find_parameters(name, "")); };
  context.references = ROPEWALK_SOURCE_DIR "/data/references";
  context.progress = [](const std::string&) {};
  return context;
}

inline CaseResult run(const Case& c, const Fault& fault = {}) {
  CaseContext context = stored_context();
  context.fault = fault;
  return c.run(context);
}

}  // namespace ropewalk::test
