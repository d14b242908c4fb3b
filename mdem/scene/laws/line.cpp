// law = "line": from the sets' [contact.line], and between different tubes from [contact.line.universal].
#include "scene/laws/line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/grade.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk {
namespace {

std::vector<LineDensity> line_densities(const Scene& scene) {
  std::vector<LineDensity> out;
  for (const ParameterSet& i : scene.sets)
    for (const ParameterSet& j : scene.sets) {
      out.push_back(&i == &j ? i.line->density
                             : i.line->universal.density(i.radius, i.line->surface_density, j.radius,
                                                         j.line->surface_density));
      if (scene.contact.cutoff > 0) out.back() = with_cutoff(out.back(), scene.contact.cutoff);
    }
  return out;
}

// Contact between tubes of two kinds comes from the universal law, which must be one and the same.
void check_mixture(const TomlTable& top, const Scene& scene) {
  const LineParameters& first = *scene.sets[0].line;
  for (const ParameterSet& set : scene.sets) {
    if (scene.sets.size() > 1 && !set.line->has_universal)
      throw top.error("parameters", fmt::format("{} has no [contact.line.universal]", set.name),
                      "tubes of different kinds need it; make the set with `ropewalk calibrate`");
    if (const double error = universal_error(set); scene.sets.size() > 1 && error > unusable_contact)
      throw top.error(
          "parameters",
          fmt::format("{} is not to be mixed: the contact law between tubes of different kinds is off by "
                      "{:.2g} % of the well for it",
                      set.name, 100 * error),
          "take it alone, or another tube");
    if (!(set.line->universal == first.universal))
      throw top.error("parameters",
                      fmt::format("{} and {} have different van der Waals laws", scene.sets[0].name, set.name),
                      "calibrate both with the same --lj and --lj-cutoff");
  }
}

}  // namespace

std::vector<LineContact> line_contacts(const Scene& scene) {
  const std::size_t types = scene.sets.size();
  std::vector<LineContact> pairs;
  std::vector<int> nodes(types, 1);  // of each type: what its most demanding partner needs
  const std::vector<LineDensity> densities = line_densities(scene);
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      LineContact pair;
      pair.density = densities[a * types + b];
      // A cutoff that leaves no well is refused by the reader.
      const double rest = line_parallel_well(pair.density).distance;
      const int needed =
          rest > pair.density.contact ? line_nodes(scene.element_length, rest, pair.density.contact) : 1;
      nodes[a] = std::max(nodes[a], scene.contact.nodes > 0 ? scene.contact.nodes : needed);
      pairs.push_back(pair);
    }
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      LineContact& pair = pairs[a * types + b];
      pair = {pair.density, scene.element_length, scene.element_length, nodes[a], nodes[b]};
    }
  return pairs;
}

ContactLawKind line_kind() {
  ContactLawKind kind;
  kind.name = "line";
  kind.make = [](const Scene& scene) { return line_law(line_contacts(scene)); };
  kind.in_set = [](const ParameterSet& set) { return set.line.has_value(); };
  kind.check = check_mixture;
  return kind;
}

}  // namespace ropewalk
