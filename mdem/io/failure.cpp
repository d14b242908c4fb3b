#include "io/failure.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

template <class E>
const E* as(const std::exception& failure) {
  return dynamic_cast<const E*>(&failure);
}

std::string no_output(int code) {
  const char* why = code != 0 ? std::strerror(code) : "a write failed";
  return fmt::format("the standard output cannot be written: {}; {}", why, remedy_for_errno(code));
}

constexpr const char* no_memory =
    "the memory does not suffice; take fewer or shorter tubes or fewer threads, or raise the limit (ulimit -v)";

bool lacks_memory(const std::exception& failure) {
  return as<std::bad_alloc>(failure) || as<std::length_error>(failure);
}

}  // namespace

std::string failure_words(const std::exception& failure) {
  constexpr std::size_t longest = 4000;
  if (lacks_memory(failure)) return no_memory;
  if (as<nlohmann::json::exception>(failure))
    return fmt::format("a JSON file does not hold what it should; restore it or make it again ({})",
                       printable(failure.what(), longest));
  if (const auto* file = as<std::filesystem::filesystem_error>(failure))
    return printable(file_error(file->path1().string(), "cannot be used", file->code().value()).what(), longest);
  const auto* system = as<std::system_error>(failure);
  if (system && std::ferror(stdout)) return no_output(system->code().value());
  if (system)
    return fmt::format("{}; {}", printable(failure.what(), longest), remedy_for_errno(system->code().value()));
  return printable(failure.what(), longest);
}

int failure_code(const std::exception& failure) {
  const bool input = as<InputError>(failure) || as<nlohmann::json::exception>(failure) ||
                     as<std::filesystem::filesystem_error>(failure) ||
                     (as<std::system_error>(failure) && std::ferror(stdout));
  return input ? 2 : 3;
}

int tell_failure(const char* program, const std::exception& failure) {
  try {
    std::fprintf(stderr, "%s: %s\n", program, failure_words(failure).c_str());
  } catch (const std::bad_alloc&) {  // not even for the words
    std::fprintf(stderr, "%s: %s\n", program, no_memory);
  }
  return failure_code(failure);
}

int code_at_exit(const char* program, int code) {
  if (const std::string note = note_of_files(); !note.empty())
    std::fprintf(stderr, "%s: note: %s\n", program, note.c_str());
  errno = 0;
  const bool failed = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !failed) return code;
  std::fprintf(stderr, "%s: %s\n", program, no_output(errno).c_str());
  return code == 0 ? 2 : code;
}

}  // namespace ropewalk
