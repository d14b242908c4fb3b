// How a program ends after an error: whatever was thrown becomes one line with a remedy and an exit code, and output that could
// not be written is an error as well.
#pragma once

#include <exception>
#include <string>

namespace ropewalk {

// One line, without the raw texts of libraries.
std::string error_words(const std::exception& error);
// 2: wrong input. 3: the calculation, the memory or the machine.
int error_code(const std::exception& error);
// Says it on stderr as "PROGRAM: ..."; returns the exit code.
int report_error(const char* program, const std::exception& error);

// The exit code of a program that ends with `code`: 2, with a line, where stdout could not be written.
int code_at_exit(const char* program, int code);

}  // namespace ropewalk
