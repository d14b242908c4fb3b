// Numbers with their errors as text.
#pragma once

#include <string>

namespace ropewalk {

// Decimals that show two digits of the error.
int decimals_of_error(double error);
// Nothing of the value is left at these decimals. An error that exceeds a value is no reason to hide it.
bool vanishes(double value, int decimals);

// "740.836 ± 0.052": as many digits as two of the error allow, seven where there is no error, and "0 ± 0.0002" for
// less than half of an error.
std::string measured_text(double value, double error);

}  // namespace ropewalk
