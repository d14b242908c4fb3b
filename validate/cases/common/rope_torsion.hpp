// Torque, tension, energy and pressure of ropes in a testing machine, against concentric helices.
#pragma once

#include "cases/common/torsion_machine.hpp"
#include "core/case.hpp"

namespace ropewalk::validate {

CaseResult run_rope_torsion(const CaseContext& context, RopeInMachine::Length length);
// The common part of both cases.
Case rope_torsion_case();

}  // namespace ropewalk::validate
