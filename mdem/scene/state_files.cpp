#include "scene/state_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

#include "model/error.hpp"
#include "scene/interactions/failure.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {

constexpr const char* broken_tubes = "failure";
constexpr const char* or_anew = "to begin anew, take the line \"# memory\" out of the header of the state";

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::set<std::string> names_of(const std::vector<NamedMemory>& terms) {
  std::set<std::string> names;
  for (const NamedMemory& m : terms) names.insert(m.term);
  return names;
}

// All terms of a name, where one of them remembers something. What broken tubes remember is in the header of the
// state.
std::vector<NamedMemory> memories_to_write(const Simulation& simulation) {
  std::vector<NamedMemory> out = simulation.term_memories();
  std::set<std::string> some;
  for (const NamedMemory& m : out)
    if (!m.records.empty() && m.term != broken_tubes) some.insert(m.term);
  out.erase(std::remove_if(out.begin(), out.end(), [&](const NamedMemory& m) { return some.count(m.term) == 0; }),
            out.end());
  return out;
}

long count_in(const std::vector<NamedMemory>& terms, const std::string& name) {
  return std::count_if(terms.begin(), terms.end(), [&](const NamedMemory& m) { return m.term == name; });
}
long count_in(const Interaction& in, const std::string& name) {
  return std::count_if(in.terms.begin(), in.terms.end(), [&](const auto& term) { return term->name() == name; });
}

// Throws where the scene has other terms of a name than the memory, or where the memory is missing.
void check_counts(const StateMemory& memory, const Interaction& in) {
  for (const std::string& name : memory.names) {
    const long here = count_in(in, name), there = count_in(memory.terms, name);
    if (here == 0) continue;
    if (memory.missing)
      throw InputError({memory.state_path, 0, ""},
                       fmt::format("names {}, and there is no such file: the {} of the scene would lose its past",
                                   file_name(memory.path), name),
                       fmt::format("copy it too, from beside the state; {}", or_anew));
    if (here != there)
      throw InputError({memory.path, 0, ""},
                       fmt::format("has the memory of {} \"{}\", and the scene has {}", there, name, here),
                       fmt::format("give those of the scene that the state comes from; {}", or_anew));
  }
}

}  // namespace

StateFiles state_files(const Simulation& simulation, const std::string& state_path) {
  const std::vector<NamedMemory> memories = memories_to_write(simulation);
  StateNotes notes;
  if (!memories.empty())
    notes.memory = fmt::format("{} of {}", std::filesystem::path(memory_path_of(state_path)).filename().string(),
                               fmt::join(names_of(memories), ", "));
  if (const std::vector<char>* broken = simulation.broken_bonds())
    for (std::size_t i = 0; i < broken->size(); ++i)
      if ((*broken)[i]) notes.broken.push_back(static_cast<int>(i));
  StateFiles files{state_csv(simulation.tubes_now(), simulation.state(), notes), ""};
  if (memories.empty()) return files;
  files.memory = state_memory_text(memories, files.state);
  return files;
}

void begin_with(const StateMemory& memory, const Topology& topology, Interaction& in) {
  check_counts(memory, in);
  std::vector<NamedMemory> all = memory.terms;
  if (!memory.broken.empty()) {
    if (count_in(in, broken_tubes) == 0) add_term(broken_tubes_term(topology), in);
    all.push_back({broken_tubes, {}});
    for (const int e : memory.broken) all.back().records.push_back({e, {}});
  }
  std::map<std::string, long> seen;
  for (auto& term : in.terms) {
    long left = seen[term->name()]++;
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const NamedMemory& m) { return m.term == term->name() && left-- == 0; });
    if (at == all.end()) continue;
    std::unique_ptr<ForceTerm> with = term->copy();
    try {
      for (const TermRecord& r : at->records)
        if (r.element >= topology.elements()) throw std::runtime_error("it is of an element that is not there");
      with->begin_with(at->records);
    } catch (const std::runtime_error& e) {
      throw InputError({memory.path.empty() ? memory.state_path : memory.path, 0, ""},
                       fmt::format("does not fit the {} of the scene: {}", term->name(), e.what()),
                       fmt::format("give its table as in the scene that the state comes from; {}", or_anew));
    }
    term = std::move(with);
  }
}

std::vector<std::string> forgotten(const StateMemory& memory, const Interaction& in) {
  std::vector<std::string> out;
  if (memory.state_path.empty()) return out;
  const std::string file = file_name(memory.state_path);
  std::set<std::string> here;
  for (const auto& term : in.terms)
    if (here.insert(term->name()).second && term->remembers() && term->name() != broken_tubes &&
        !memory.has(term->name()))
      out.push_back(fmt::format("The {} of the scene begins anew: {} has no memory of it.", term->name(), file));
  for (const std::string& name : memory.names)
    if (here.count(name) == 0)
      out.push_back(fmt::format("The scene has no {}, which {} has a memory of.", name, file));
  return out;
}

}  // namespace ropewalk
