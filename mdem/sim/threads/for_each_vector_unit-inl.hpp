// Includes the file ROPEWALK_LOOPS once for each vector unit, see sim/threads/vector_unit.hpp. No guard: a source
// file may have several.
#define ROPEWALK_UNIT in_base
#include ROPEWALK_LOOPS
#undef ROPEWALK_UNIT
#ifdef ROPEWALK_HAS_VECTOR_UNITS
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v3")
#define ROPEWALK_UNIT in_v3
#include ROPEWALK_LOOPS
#undef ROPEWALK_UNIT
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
#define ROPEWALK_UNIT in_v4
#include ROPEWALK_LOOPS
#undef ROPEWALK_UNIT
#pragma GCC pop_options
#endif
#undef ROPEWALK_LOOPS
