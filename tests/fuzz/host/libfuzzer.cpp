// A target as a program of clang's libFuzzer: FUZZ_TARGET names it.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ropewalk::fuzz::Target target = [] {
    for (const ropewalk::fuzz::Target& t : ropewalk::fuzz::targets())
      if (std::strcmp(t.name, FUZZ_TARGET) == 0) return t;
    __builtin_trap();
  }();
  target.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
