#include "commands/compare_sets.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "report/sets_page.hpp"

namespace ropewalk {
namespace {

void print_table(const std::vector<ParameterSet>& sets) {
  const std::vector<std::vector<std::string>> all = sets_table(sets);
  std::vector<std::size_t> widths(all[0].size());
  const auto width = [](const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  };
  for (const auto& row : all)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width(row[k]));
  for (const auto& row : all) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += row[k] + std::string(widths[k] - width(row[k]) + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

}  // namespace

int compare_sets(const std::vector<std::string>& names, const std::string& page, bool json, bool force) {
  if (names.size() < 2)
    throw InputError({"", 0, "names"}, "is one set", "name at least two: files, or names of shipped sets");
  std::vector<ParameterSet> sets;
  for (const std::string& name : names)
    sets.push_back(read_parameters(find_parameters(name, "", {"", 0, "names"})));
  if (json)
    fmt::print("{}\n", sets_json(sets));
  else
    print_table(sets);
  if (page.empty()) return 0;
  refuse_existing(page, "--page", force);
  write_file_atomically(page, sets_page(sets));
  if (!json) fmt::print("Page: {}\n", page);
  return 0;
}

}  // namespace ropewalk
