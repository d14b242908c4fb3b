// Texts that OpenCL compiles at run time, one after the other. cmake/embed.cmake writes the source file.
#pragma once

namespace ropewalk {

extern const char* const forms_dialect_text;   // model/dialect.h
extern const char* const forms_text;           // model/forms.h
extern const char* const kernel_dialect_text;  // dialect.h
extern const char* const kernel_types_text;    // types.h
extern const char* const kernel_text;          // kernels.h

}  // namespace ropewalk
