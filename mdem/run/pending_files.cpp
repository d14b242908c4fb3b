#include "run/pending_files.hpp"

#include <fmt/format.h>

#include "io/error_exit.hpp"
#include "io/files.hpp"

namespace ropewalk {

void PendingFiles::write(const std::string& path, std::string content) {
  try {
    write_file_atomically(path, content);
    waiting_.erase(path);
  } catch (const InputError& e) {
    if (!waiting_.count(path)) listener_.tell(fmt::format("{}; the run goes on, and it is tried again", e.what()));
    waiting_[path] = std::move(content);
  }
}

void PendingFiles::try_again() {
  const auto all = waiting_;
  for (const auto& [path, content] : all) write(path, content);
}

std::string PendingFiles::names() const {
  std::string words;
  for (const auto& [path, content] : waiting_) words += (words.empty() ? "" : ", ") + path;
  return words;
}

void report_or_tell(const RunDirectory& dir, RunListener& listener, const std::function<void()>& write) {
  try {
    write();
  } catch (const std::exception& e) {
    listener.tell(fmt::format("no report: {}; make it with: ropewalk report {}", error_words(e), dir.path));
  }
}

}  // namespace ropewalk
