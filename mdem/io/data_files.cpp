#include "io/data_files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "io/toml_table.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::string said_directory;

std::string shipped_sets(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") names.insert("\"" + entry.path().stem().string() + "\"");
  if (names.empty()) return fmt::format("no set is shipped in {}; is ROPEWALK_DATA right?", folder.string());
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
  return "name a file, or a shipped set: " + text;
}

}  // namespace

std::string data_directory() {
  const char* set = std::getenv("ROPEWALK_DATA");
  if (set && *set) return set;
  if (!said_directory.empty()) return said_directory;
  // As installed, wherever the tree was moved to.
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "../share/ropewalk";
  return fs::is_directory(beside / "parameters", error) ? beside.lexically_normal().string() : ROPEWALK_DATA_DIR;
}

void set_data_directory(const std::string& folder) { said_directory = folder; }

std::string find_parameters(const std::string& name, const std::string& folder, const InputError::Place& place,
                            const std::string& data) {
  std::error_code error;
  const fs::path beside = fs::path(folder) / name;
  if (fs::is_regular_file(beside, error)) return beside.string();
  const fs::path shipped = fs::path(data) / "parameters";
  for (const std::string& file : {name + ".toml", name})
    if (fs::is_regular_file(shipped / file, error)) return (shipped / file).string();
  throw InputError(place, fmt::format("there is no parameter set \"{}\"", printable(name)), shipped_sets(shipped));
}

}  // namespace ropewalk
