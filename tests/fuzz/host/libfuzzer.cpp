// The targets as one program of clang's libFuzzer. ROPEWALK_READER in the environment names the target.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "coverage.hpp"
#include "fuzz/targets.hpp"

extern "C" void __sanitizer_cov_8bit_counters_init(std::uint8_t* begin, std::uint8_t* end);

namespace {

using namespace ropewalk::fuzz;

const Target& chosen() {
  const char* name = std::getenv("ROPEWALK_READER");
  for (const Target& t : targets())
    if (name && t.name == std::string(name)) return t;
  std::fprintf(stderr, "fuzz_readers: ROPEWALK_READER names no reader\n");
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  __sanitizer_cov_8bit_counters_init(branches_taken.begin(), branches_taken.end());
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target target = chosen();
  target.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
