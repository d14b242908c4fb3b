#include "run/own_forces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* without_energy = " (no energy)";

// Whether each force in `words` has an energy.
std::vector<bool> energies_of(const std::string& words) {
  std::vector<bool> out;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(", ", begin), words.size());
    out.push_back(words.substr(begin, end - begin).find(without_energy) == std::string::npos);
    begin = end + 2;
  }
  return out;
}

}  // namespace

std::string own_forces_in_words(const std::vector<OwnForceOfRun>& forces) {
  std::string words;
  for (const OwnForceOfRun& f : forces)
    words += (words.empty() ? "" : ", ") + f.name + (f.has_energy ? "" : without_energy);
  return words;
}

void refuse_other_forces(const std::string& before, const std::string& now, const std::string& directory) {
  if (energies_of(before) == energies_of(now)) return;
  const auto named = [](const std::string& words) { return words.empty() ? "none" : words; };
  throw InputError({directory, 0, "forces"},
                   fmt::format("the run was begun with forces of one's own, in Python: {}; it would go on with: {}",
                               named(before), named(now)),
                   fmt::format("give the same: ropewalk.resume(\"{}\", forces=...) in Python", directory));
}

}  // namespace ropewalk
