#include "io/running_hash.hpp"

#include <fmt/format.h>

#include <cstdint>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ropewalk {

struct RunningHash::Sum {
  XXH64_state_t state;
};

RunningHash::RunningHash() : sum_(std::make_unique<Sum>()) { XXH64_reset(&sum_->state, 0); }

RunningHash::~RunningHash() = default;

void RunningHash::add(std::string_view part) { XXH64_update(&sum_->state, part.data(), part.size()); }

std::string RunningHash::hex() const {
  return fmt::format("{:016x}", static_cast<std::uint64_t>(XXH64_digest(&sum_->state)));
}

}  // namespace ropewalk
