#include "scene/state_memory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "io/toml_table.hpp"  // printable
#include "model/error.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {

constexpr const char *memory_header = "term,which,element,numbers", *sum_words = "state: ";

constexpr int no_element = -1;  // marks the first line of each term

// A sum over the lines of a state file that hold elements.
std::string sum_of_rows(const std::string& state) {
  std::string rows;
  for (std::size_t at = 0; at < state.size();) {
    const std::size_t end = std::min(state.find('\n', at), state.size());
    if (state[at] != '#') rows.append(state, at, end - at - (end > at && state[end - 1] == '\r')) += '\n';
    at = end + 1;
  }
  return hash_hex(rows);
}

// The number of force terms with this name.
std::size_t count_of(const std::vector<NamedMemory>& terms, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(terms.begin(), terms.end(), [&](const NamedMemory& m) { return m.term == name; }));
}

std::vector<double> numbers_in(const CsvReader& csv, std::string_view cell) {
  std::vector<double> numbers;
  const std::string text(cell);
  const char* at = text.c_str();
  for (char* end = nullptr; *at != '\0'; at = end) {
    numbers.push_back(std::strtod(at, &end));
    if (end == at)
      csv.fail("numbers", fmt::format("is \"{}\"", printable(text, 40)), "bring the file back from a copy");
    while (*end == ' ') ++end;
  }
  return numbers;
}

void read_records(StateMemory& memory, const std::string& sum) {
  CsvReader csv(memory.path);
  const char* remedy = "bring the file back from a copy";
  if (!csv.next() || csv.line_text() != memory_header) csv.fail("", "is no memory of force terms", remedy);
  std::map<std::pair<std::string, std::size_t>, TermState> records;
  bool belongs = false;
  while (csv.next()) {
    for (const std::string_view comment : csv.comments()) belongs = belongs || comment == sum_words + sum;
    if (!belongs)
      throw InputError(
          {memory.path, 0, ""}, fmt::format("is not the memory of {}", memory.state_path),
          "copy both files of one run; one that was changed has no memory: take the line \"# memory\" out "
          "of its header");
    if (csv.cells().size() != 4) csv.fail("", fmt::format("has {} columns, not 4", csv.cells().size()), remedy);
    const double which = csv.number(1, "which"), element = csv.number(2, "element");
    if (!(which >= 0 && which < 1e6) || !(element >= no_element && element < 1e9))
      csv.fail("", "names no element", remedy);
    TermState& of = records[{std::string(csv.cells()[0]), static_cast<std::size_t>(which)}];
    if (element != no_element) of.push_back({static_cast<int>(element), numbers_in(csv, csv.cells()[3])});
  }
  for (auto& [term, of] : records) {
    if (term.second != count_of(memory.terms, term.first))
      throw InputError({memory.path, 0, ""}, fmt::format("leaves out one of \"{}\"", printable(term.first, 20)),
                       remedy);
    memory.terms.push_back({term.first, std::move(of)});
  }
}

}  // namespace

std::string memory_path_of(const std::string& state_path) {
  const std::filesystem::path path(state_path);
  return (path.parent_path() / (path.stem().string() + "-memory.csv")).string();
}

std::string state_memory_text(const std::vector<NamedMemory>& memories, const std::string& state) {
  std::string text = fmt::format("{}\n# {}{}\n", memory_header, sum_words, sum_of_rows(state));
  std::map<std::string, std::size_t> seen;
  for (const NamedMemory& m : memories) {
    const std::size_t which = seen[m.term]++;
    text += fmt::format("{},{},{},\n", m.term, which, no_element);
    for (const TermRecord& r : m.records)
      text += fmt::format("{},{},{},{}\n", m.term, which, r.element, fmt::join(r.numbers, " "));
  }
  return text;
}

bool StateMemory::has(const std::string& term) const {
  return std::find(names.begin(), names.end(), term) != names.end();
}

StateMemory read_state_memory(const std::string& state_path, const std::string& path) {
  const StateNotes notes = read_state_notes(state_path);
  const std::string sum = sum_of_rows(read_file(state_path));
  StateMemory memory;
  memory.state_path = state_path;
  memory.broken = notes.broken;
  memory.lineage = std::strtoull(sum.c_str(), nullptr, 16);
  if (notes.memory.empty()) return memory;
  const std::size_t of = notes.memory.find(" of ");
  const std::string name = notes.memory.substr(0, of);
  for (std::size_t at = of == std::string::npos ? notes.memory.size() : of + 4; at < notes.memory.size();) {
    const std::size_t end = std::min(notes.memory.find(", ", at), notes.memory.size());
    memory.names.push_back(notes.memory.substr(at, end - at));
    at = end + 2;
  }
  if (name.find('/') != std::string::npos || memory.names.empty())
    throw InputError(
        {state_path, 0, ""}, fmt::format("its comment says \"memory: {}\"", printable(notes.memory, 60)),
        "name a file beside it, as \"memory: final-memory.csv of friction\", or take the comment away");
  memory.path = path.empty() ? (std::filesystem::path(state_path).parent_path() / name).string() : path;
  memory.missing = !std::filesystem::exists(memory.path);
  if (!memory.missing) read_records(memory, sum);
  return memory;
}

}  // namespace ropewalk
