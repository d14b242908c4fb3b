// The report's part on loads: torque, tension, stored energy, the tension along tubes, the pressure across them.
#pragma once

#include <string>

#include "report/report.hpp"

namespace ropewalk {

// Empty where no load does anything.
std::string loading_part(const ReportInput& input, Figures& figures);

}  // namespace ropewalk
