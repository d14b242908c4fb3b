#include "scene/memory_size.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "io/files.hpp"
#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

// Where control groups limit the memory, in bytes; without a limit there is a word.
constexpr const char* group_limits[] = {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"};

}  // namespace

double memory_allowed() {
  double least = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  for (const auto limited : {RLIMIT_AS, RLIMIT_DATA}) {
    struct rlimit limit {};
    if (getrlimit(limited, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min(least, static_cast<double>(limit.rlim_cur));
  }
  for (const char* path : group_limits) {
    std::error_code none;
    const double bytes =
        std::filesystem::is_regular_file(path, none) ? leading_number(read_file(path)).value_or(0) : 0;
    if (bytes > 0) least = std::min(least, bytes);
  }
  return least;
}

std::string beyond_memory(double elements) {
  const double needed = memory_needed(elements), allowed = memory_allowed();
  if (needed <= allowed) return "";
  return fmt::format("about {:.2g} GB of memory, and {:.2g} GB may be used here", 1e-9 * needed, 1e-9 * allowed);
}

}  // namespace ropewalk
