#include "io/removal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* work_mark = ".ropewalk-work";

InputError not_removed(const fs::path& path, const char* option, const std::error_code& error) {
  return InputError({path.string(), 0, option}, fmt::format("cannot be removed: {}", error.message()),
                    "remove it, or choose another directory");
}

// Everything below the directory; what stands in a directory follows it. Links are not followed.
std::vector<fs::path> all_below(const std::string& directory) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::recursive_directory_iterator at(directory, error), end; !error && at != end; at.increment(error))
    all.push_back(at->path());
  if (error && error.value() != ENOENT) throw file_error(directory, "cannot be read", error.value());
  return all;
}

bool has_work_mark(const std::string& directory) {
  std::error_code error;
  return !fs::is_symlink(directory, error) &&
         fs::is_regular_file(fs::symlink_status(directory + "/" + work_mark, error));
}

// Empty, or with nothing but parts of the mark, which a killed process may leave.
bool is_hardly_made(const std::string& directory) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(directory, error))) return false;
  for (const auto& entry : fs::directory_iterator(directory))
    if (without_part(entry.path().filename().string()) != work_mark) return false;
  return true;
}

void remove_whole(const std::string& directory) {
  std::error_code ignored;
  fs::remove_all(directory, ignored);
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::string& in) : process_(::getpid()) {
  const char* named = std::getenv("TMPDIR");
  const fs::path place = !in.empty() ? in : named && *named ? named : "/tmp";
  path_ = (place / "ropewalk-XXXXXX").string();
  if (!::mkdtemp(path_.data()))
    throw InputError({path_, 0, ""}, fmt::format("cannot be made: {}", std::strerror(errno)),
                     in.empty() ? "set TMPDIR to a directory that can be written and has room"
                                : "choose a place that you may write to");
}

TemporaryFolder::~TemporaryFolder() {
  if (process_ == ::getpid()) remove_whole(path_);
}

void refuse_foreign(const std::string& directory, const IsOurs& ours, const char* what, const char* option) {
  for (const fs::path& path : all_below(directory)) {
    const std::string inside = path.lexically_relative(directory).string();
    if (!ours(inside))
      throw InputError({directory, 0, option},
                       fmt::format("holds {}, which is not {}", printable(inside, 120), what),
                       "nothing was removed: take it away, or choose another directory");
  }
}

void remove_inside(const std::string& directory, const IsOurs& ours, const char* what, const char* option,
                   const IsOurs& keep) {
  refuse_foreign(directory, ours, what, option);
  const std::vector<fs::path> all = all_below(directory);
  for (auto path = all.rbegin(); path != all.rend(); ++path) {
    const std::string inside = path->lexically_relative(directory).string();
    std::error_code error;
    if ((keep && keep(inside)) || !ours(inside)) continue;
    fs::remove(*path, error);
    if (error) throw not_removed(*path, option, error);
  }
}

void make_work_folder(const std::string& path, const char* option) {
  std::error_code error;
  remove_work_folder(path);
  if (fs::exists(fs::symlink_status(path, error)) && !is_hardly_made(path))
    throw InputError({path, 0, option}, "is there already, and this program did not make it",
                     "take it away, or choose another directory");
  fs::create_directories(path, error);
  if (error) throw file_error(path, "cannot be made", error.value());
  try {
    write_file_atomically(path + "/" + work_mark, "ropewalk made this directory and removes it.\n");
  } catch (const InputError&) {
    remove_whole(path);
    throw;
  }
}

void remove_work_folder(const std::string& path) {
  if (!has_work_mark(path)) return;
  // The mark is removed last: a process that is killed here leaves a directory that is known as its own.
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.path().filename() != work_mark) remove_whole(entry.path().string());
  std::error_code ignored;
  fs::remove(path + "/" + work_mark, ignored);
  fs::remove(path, ignored);
}

}  // namespace ropewalk
