// The text of the kernels, which OpenCL compiles at run time. cmake/embed.cmake writes the source file.
#pragma once

namespace ropewalk {

extern const char* const kernel_types_text;    // types.h
extern const char* const kernel_dialect_text;  // dialect.h
extern const char* const kernel_text;          // kernels.h

}  // namespace ropewalk
