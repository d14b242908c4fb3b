// law = "line": from the sets' [contact.line], and between different tubes from [contact.line.universal].
#include "scene/laws/line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/grade.hpp"
#include "model/contact/line_parameters.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk {
namespace {

std::vector<LineDensity> line_densities(const Scene& scene) {
  std::vector<LineDensity> out;
  for (const ParameterSet& i : scene.sets)
    for (const ParameterSet& j : scene.sets) {
      // One set that is named twice is one kind of tube.
      out.push_back(
          &i == &j || (!i.hash.empty() && i.hash == j.hash)
              ? i.law<LineParameters>()->density
              : i.law<LineParameters>()->universal.density(i.radius, i.law<LineParameters>()->surface_density,
                                                           j.radius, j.law<LineParameters>()->surface_density));
      if (scene.contact.cutoff > 0) out.back() = with_cutoff(out.back(), scene.contact.cutoff);
    }
  return out;
}

// Contact between tubes of two kinds comes from the universal law, which must be one and the same.
void check_mixture(const TomlTable& top, const Scene& scene) {
  const LineParameters& first = *scene.sets[0].law<LineParameters>();
  for (const ParameterSet& set : scene.sets) {
    if (set.filament || scene.sets[0].filament) {
      if (set.hash == scene.sets[0].hash) continue;
      throw top.error("parameters",
                      fmt::format("{} and {} have no contact law between one another: a filament has one with its own kind alone",
                                  scene.sets[0].name, set.name),
                      "take one of them, or [contact] law = \"none\"");
    }
    if (scene.sets.size() > 1 && !set.law<LineParameters>()->has_universal)
      throw top.error("parameters", fmt::format("{} has no [contact.line.universal]", set.name),
                      "tubes of different kinds need it; make the set with `ropewalk calibrate`");
    if (const double error = universal_error(set); scene.sets.size() > 1 && error > unusable_contact)
      throw top.error(
          "parameters",
          fmt::format("{} is not to be mixed: the contact law between tubes of different kinds is off by "
                      "{:.2g} % of the well for it",
                      set.name, 100 * error),
          "take it alone, or another tube");
    if (!(set.law<LineParameters>()->universal == first.universal))
      throw top.error("parameters",
                      fmt::format("{} and {} have different van der Waals laws", scene.sets[0].name, set.name),
                      "calibrate both with the same --lj and --lj-cutoff");
  }
}

// The contacts, and the wells of parallel tubes, which their nodes are chosen by.
struct LinePairs {
  std::vector<LineContact> contacts;
  std::vector<LineWell> wells;
};

LinePairs line_pairs(const Scene& scene) {
  const bool statics =
      scene.run.mode == RunOptions::Mode::relax && scene.run.solver != RunOptions::Solver::fire;
  const std::size_t types = scene.sets.size();
  const double length = scene.element_length;
  LinePairs out;
  std::vector<int> nodes(types, 1);  // of each type: what its most demanding partner needs
  const std::vector<LineDensity> densities = line_densities(scene);
  for (std::size_t k = 0; k < densities.size(); ++k) {
    // A cutoff that leaves no well is refused by the reader.
    out.wells.push_back(line_parallel_well(densities[k]));
    const double rest = out.wells.back().distance, contact = densities[k].contact;
    const int needed = rest > contact ? line_nodes(length, rest, contact, statics) : 1;
    nodes[k / types] = std::max(nodes[k / types], scene.contact.nodes > 0 ? scene.contact.nodes : needed);
  }
  for (std::size_t k = 0; k < densities.size(); ++k)
    out.contacts.push_back({densities[k], length, length, nodes[k / types], nodes[k % types]});
  return out;
}

std::shared_ptr<const ContactLaw> line_law_of(const Scene& scene) {
  LinePairs pairs = line_pairs(scene);
  return std::make_shared<const LineLaw>(std::move(pairs.contacts), std::move(pairs.wells));
}

std::vector<EndContact> contacts_of_ends(const Scene& scene) {
  std::vector<EndContact> out;
  // A filament has round ends: the line law of its like acts between them as well.
  if (scene.sets[0].filament) return out;
  const auto end_of = [](const ParameterSet& set) {
    std::vector<TubeEnd> ends;
    for (const Wall& wall : set.walls) ends.push_back(tube_end(wall.chirality, wall.radius, wall.atoms_per_length));
    if (ends.empty()) ends.push_back(tube_end(set.chirality, set.radius, set.atoms_per_length));
    return ends;
  };
  for (const ParameterSet& i : scene.sets)
    for (const ParameterSet& j : scene.sets) {
      const UniversalLine& atoms = i.law<LineParameters>()->universal;
      out.emplace_back(LennardJones{atoms.epsilon, atoms.sigma, atoms.lj_cutoff}, end_of(i), end_of(j));
    }
  return out;
}

}  // namespace

std::vector<LineContact> line_contacts(const Scene& scene) { return line_pairs(scene).contacts; }

ContactLawKind line_kind() {
  ContactLawKind kind;
  kind.name = "line";
  kind.make = line_law_of;
  kind.in_set = [](const ParameterSet& set) { return set.law<LineParameters>() != nullptr; };
  kind.ends = contacts_of_ends;
  kind.check = check_mixture;
  return kind;
}

}  // namespace ropewalk
