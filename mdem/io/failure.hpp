// How a program ends: whatever was thrown becomes one line with a remedy and an exit code, and output that could
// not be written is an error as well.
#pragma once

#include <exception>
#include <string>

namespace ropewalk {

// One line, without the raw texts of libraries.
std::string failure_words(const std::exception& failure);
// 2: wrong input. 3: the calculation, the memory or the machine.
int failure_code(const std::exception& failure);
// Says it on stderr as "PROGRAM: ..."; returns the exit code.
int tell_failure(const char* program, const std::exception& failure);

// The exit code of a program that ends with `code`: 2, with a line, where stdout could not be written.
int code_at_exit(const char* program, int code);

}  // namespace ropewalk
