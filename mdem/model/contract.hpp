// What a function expects of its caller, and ensures where it returns. Conditions are checked in builds without
// NDEBUG (preset asan); a broken one ends the program with its place. Elsewhere they are not evaluated and cost
// nothing.
//
// A contract is about the code that calls. What a user writes is checked in every build, by InputError.
#pragma once

#ifdef NDEBUG
#define ROPEWALK_EXPECTS(condition) static_cast<void>(sizeof(!(condition)))
#define ROPEWALK_ENSURES(condition) static_cast<void>(sizeof(!(condition)))
#else
#include <cstdio>
#include <cstdlib>

namespace ropewalk {

[[noreturn]] inline void contract_broken(const char* kind, const char* condition, const char* function,
                                         const char* file, int line) {
  std::fprintf(stderr, "%s:%d: %s %s: %s\n", file, line, function, kind, condition);
  std::abort();
}

}  // namespace ropewalk

#define ROPEWALK_CONTRACT(kind, condition) \
  ((condition) ? static_cast<void>(0) : ::ropewalk::contract_broken(kind, #condition, __func__, __FILE__, __LINE__))
#define ROPEWALK_EXPECTS(condition) ROPEWALK_CONTRACT("expects", condition)
#define ROPEWALK_ENSURES(condition) ROPEWALK_CONTRACT("ensures", condition)
#endif
