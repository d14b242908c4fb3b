// The text of the kernels, for a compiler at run time. Written by cmake/embed.cmake.
#pragma once

namespace ropewalk {

extern const char* const kernel_types_text;    // types.h
extern const char* const kernel_dialect_text;  // dialect.h
extern const char* const kernel_text;          // kernels.h

}  // namespace ropewalk
