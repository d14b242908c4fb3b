// How long a program may run, for batch systems that end it after that.
#pragma once

#include <string>

namespace ropewalk {

// "5400" (seconds), "1:30:00" or "2-12:00:00" (days before the hyphen); empty: 0. Throws InputError.
double seconds_of_wall_time(const std::string& text);

// Of this program.
double seconds_since_start();

}  // namespace ropewalk
