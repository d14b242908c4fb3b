#include "io/error_exit.hpp"

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
const E* as(const std::exception& error) {
  return dynamic_cast<const E*>(&error);
}

std::string no_output(int code) {
  const char* why = code != 0 ? std::strerror(code) : "a write failed";
  return fmt::format("the standard output cannot be written: {}; {}", why, remedy_for_errno(code));
}

constexpr const char* no_memory =
    "the memory does not suffice; take fewer or shorter tubes or fewer threads, or raise the limit (ulimit -v)";

bool lacks_memory(const std::exception& error) {
  return as<std::bad_alloc>(error) || as<std::length_error>(error);
}

}  // namespace

std::string error_words(const std::exception& error) {
  constexpr std::size_t longest = 4000;
  if (lacks_memory(error)) return no_memory;
  if (as<nlohmann::json::exception>(error))
    return fmt::format("a JSON file does not hold what it should; restore it or make it again ({})",
                       printable(error.what(), longest));
  if (const auto* file = as<std::filesystem::filesystem_error>(error))
    return printable(file_error(file->path1().string(), "cannot be used", file->code().value()).what(), longest);
  const auto* system = as<std::system_error>(error);
  if (system && std::ferror(stdout)) return no_output(system->code().value());
  if (system)
    return fmt::format("{}; {}", printable(error.what(), longest), remedy_for_errno(system->code().value()));
  // An exception of Python goes on with the lines that it came through.
  const std::string what = error.what();
  return printable(what.substr(0, what.find("\n\nAt:\n")), longest);
}

int error_code(const std::exception& error) {
  const bool input = as<InputError>(error) || as<nlohmann::json::exception>(error) ||
                     as<std::filesystem::filesystem_error>(error) ||
                     (as<std::system_error>(error) && std::ferror(stdout));
  return input ? 2 : 3;
}

int report_error(const char* program, const std::exception& error) {
  try {
    std::fprintf(stderr, "%s: %s\n", program, error_words(error).c_str());
  } catch (const std::bad_alloc&) {  // not even for the words
    std::fprintf(stderr, "%s: %s\n", program, no_memory);
  }
  return error_code(error);
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
