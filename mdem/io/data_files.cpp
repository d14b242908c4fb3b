#include "io/data_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "io/toml_table.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::string said_directory;
const char* added_directory = nullptr;  // there before any static variable

// Tells how to make a set that is named by its chirality; empty: it is shipped, or the name has no chirality.
std::string how_to_make(const std::string& name, const std::vector<std::string>& shipped) {
  std::smatch found;
  if (!std::regex_match(name, found, std::regex("cnt-([0-9]{1,3}-[0-9]{1,3}(@[0-9]{1,3}-[0-9]{1,3})*)(-[a-z]*)?")))
    return "";
  std::string walls = found[1].str();
  const std::string begin = fmt::format("cnt-{}-", walls);
  for (const std::string& set : shipped)
    if (set.rfind(begin, 0) == 0) return "";
  std::replace(walls.begin(), walls.end(), '-', ',');
  return fmt::format("`ropewalk calibrate --chirality {}` makes it", walls);
}

std::string instead_of(const std::string& name, const std::string& data) {
  const std::vector<std::string> shipped = shipped_sets(data);
  if (shipped.empty()) return fmt::format("no set is shipped in {}/parameters; is ROPEWALK_DATA right?", data);
  const std::string near = nearest_word(name, shipped), make = how_to_make(name, shipped);
  std::string text = !make.empty()  ? make + "; or "
                     : near.empty() ? ""
                                    : fmt::format("did you mean \"{}\"? Or ", near);
  text += "name a file, or a shipped set";
  const char* before = ": ";
  for (std::string n : shipped) {
    // Tersoff's sets are found without their potential too.
    if (const std::size_t end = n.rfind("-tersoff"); n.rfind("cnt-", 0) == 0 && end != std::string::npos) n.resize(end);
    text += fmt::format("{}\"{}\"", before, n);
    before = ", ";
  }
  return text;
}

}  // namespace

std::string data_directory() {
  const char* set = std::getenv("ROPEWALK_DATA");
  if (set && *set) return set;
  if (!said_directory.empty()) return said_directory;
  // As installed, wherever the tree was moved to.
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "../share/ropewalk";
  if (fs::is_directory(beside / "parameters", error)) return beside.lexically_normal().string();
  return added_directory ? added_directory : ROPEWALK_DATA_DIR;
}

bool add_data_directory(const char* folder) {
  added_directory = folder;
  return true;
}

void set_data_directory(const std::string& folder) { said_directory = folder; }

std::vector<std::string> shipped_sets(const std::string& data) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(data) / "parameters", error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_parameters(const std::string& name, const std::string& folder, const InputError::Place& place,
                            const std::string& data) {
  std::error_code error;
  const fs::path beside = fs::path(folder) / name;
  if (fs::is_regular_file(beside, error)) return beside.string();
  const fs::path shipped = fs::path(data) / "parameters";
  // A tube alone is that of Tersoff's potential.
  for (const std::string& file : {name + ".toml", name, name + "-tersoff.toml"})
    if (fs::is_regular_file(shipped / file, error)) return (shipped / file).string();
  const std::string file = name + ".toml";
  throw InputError(place, fmt::format("there is no parameter set \"{}\"", printable(name)),
                   fs::is_regular_file(fs::path(folder) / file, error)
                       ? fmt::format("write \"{}\" for the file beside the scene", printable(file))
                       : instead_of(name, data));
}

}  // namespace ropewalk
