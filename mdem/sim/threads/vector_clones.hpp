// Marks a function that is compiled for several vector units. The loader picks the version for the widest unit of
// the machine, so that one binary runs on every x86-64.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ROPEWALK_VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ROPEWALK_VECTOR_CLONES
#endif
