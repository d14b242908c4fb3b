#include "run/pages/colour_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// nN: the mean of the bonds of an element.
std::vector<double> tension_of_elements(const Topology& topology, const State& state) {
  std::vector<double> out;
  for (int t = 0; t < topology.tubes(); ++t) {
    const std::vector<double> bonds = tensions(topology, state, t);
    const std::size_t n = bonds.size();
    for (std::size_t k = 0; k <= n; ++k) {
      const double sum = (k > 0 ? bonds[k - 1] : 0) + (k < n ? bonds[k] : 0);
      out.push_back(n == 0 ? no_number : sum / ((k > 0) + (k < n)) / units::nN_nm);
    }
  }
  return out;
}

// Steps from neighbour to neighbour to the tube on the axis; empty where not all tubes hang together.
std::vector<int> shells_of(const LoadingReference& reference) {
  const std::size_t tubes = reference.radius.size();
  std::vector<int> shell(tubes, -1);
  std::vector<std::size_t> ring = {static_cast<std::size_t>(
      std::min_element(reference.radius.begin(), reference.radius.end()) - reference.radius.begin())};
  for (int k = 0; !ring.empty(); ++k) {
    for (const std::size_t t : ring) shell[t] = k;
    std::vector<std::size_t> next;
    for (const auto& [a, b] : reference.neighbours)
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
        if (shell[static_cast<std::size_t>(from)] == k && shell[static_cast<std::size_t>(to)] < 0)
          next.push_back(static_cast<std::size_t>(to));
    ring = std::move(next);
  }
  return std::count(shell.begin(), shell.end(), -1) > 0 ? std::vector<int>() : shell;
}

double bond_energy_of(const LogRow& r) { return r["stretch_eV"] + r["shear_eV"] + r["bend_eV"] + r["twist_eV"]; }

struct ColourField {
  ViewField field;
  std::vector<double> ElementColours::*values;
  double (*log_total)(const LogRow&);
  double unit = 1;  // unit of the field, in that of `values`
};

std::vector<ColourField> colour_fields() {
  const auto nothing = [](const LogRow&) { return no_number; };
  return {{{"Bending moment", "nN nm", "EI times curvature", false, {}, {}},
           &ElementColours::bending_moment,
           nothing,
           units::nN_nm},
          {{"Bond energy", "eV", "half of the energy of each bond of the element", false, {}, {}},
           &ElementColours::bond_energy,
           bond_energy_of},
          {{"van der Waals energy", "eV", "half of the energy of each contact of the element", false, {}, {}},
           &ElementColours::vdw_energy,
           [](const LogRow& r) { return r["vdw_eV"]; }},
          {{"Twist of the bonds", "rad", "twist angle, mean of the bonds of the element", true, {}, {}},
           &ElementColours::twist_angle,
           nothing}};
}

// Words of --colour, and the names of the page in space.
constexpr std::pair<const char*, const char*> named_colours[] = {
    {"moment", "Bending moment"},    {"bond-energy", "Bond energy"}, {"vdw", "van der Waals energy"},
    {"twist", "Twist of the bonds"}, {"tension", "Tension"},         {"shell", "Shell"},
    {"type", "Type of tube"}};

}  // namespace

std::vector<ViewField> element_fields(const StoredEvents& events, const std::vector<StoredFrame>& frames,
                                      const std::vector<LogRow>& log) {
  std::vector<ViewField> out;
  for (ColourField& colour : colour_fields()) {
    const bool all = std::none_of(frames.begin(), frames.end(),
                                  [&](const StoredFrame& f) { return (f.colours.*colour.values).empty(); });
    if (!all) continue;
    for (const StoredFrame& f : frames) {
      colour.field.values.push_back(f.colours.*colour.values);
      for (double& v : colour.field.values.back()) v /= colour.unit;
      // Times of frames are rounded.
      const auto row = std::find_if(log.begin(), log.end(), [&](const LogRow& r) {
        return r["step"] == static_cast<double>(f.state.step) && std::fabs(r["time_ps"] - f.state.time) < 1e-6;
      });
      colour.field.log_total.push_back(row == log.end() ? no_number : colour.log_total(*row));
    }
    out.push_back(std::move(colour.field));
  }
  ViewField tension{"Tension", "nN", "along the tube, mean of the bonds of the element; negative: pressed",
                    true,      {},   {}};
  for (const StoredFrame& f : frames) {
    tension.values.push_back(tension_of_elements(events.tubes_at(f.state.time), f.state));
    tension.log_total.push_back(no_number);
  }
  out.push_back(std::move(tension));
  return out;
}

std::vector<ViewTubeNumber> tube_numbers(const Scene& scene, const Prepared& p, const Topology& pieces) {
  std::vector<ViewTubeNumber> out;
  const Observer observer = make_observer(scene, p);
  if (is_rope(p, observer))
    if (const std::vector<int> shells = shells_of(observer.loading); !shells.empty()) {
      std::vector<int> of_pieces;
      for (int t = 0; t < pieces.tubes(); ++t)
        of_pieces.push_back(shells[static_cast<std::size_t>(p.topology.tube_of(pieces.tube_begin[t]))]);
      out.push_back({"Shell", "ring of the rope, 0: the innermost tube", of_pieces});
    }
  if (scene.sets.size() > 1) out.push_back({"Type of tube", "parameter set, from 0", pieces.tube_type});
  return out;
}

std::vector<std::string> colour_words() {
  std::vector<std::string> out;
  for (const auto& [word, name] : named_colours) out.emplace_back(word);
  return out;
}

void colour_by(const std::string& word, const StoredEvents& events, const std::vector<StoredFrame>& frames,
               const Scene& scene, const Prepared& prepared, std::vector<RopeView>& views) {
  std::string name;
  for (const auto& [of_option, of_page] : named_colours)
    if (word == of_option) name = of_page;
  std::vector<std::string> there;
  const auto is_it = [&](const std::string& other) {
    for (const auto& [of_option, of_page] : named_colours)
      if (other == of_page) there.emplace_back(of_option);
    return other == name;
  };
  std::string quantity = name;
  quantity[0] = static_cast<char>(quantity[0] | 0x20);
  for (const ViewField& field : element_fields(events, frames, {})) {
    if (!is_it(field.name)) continue;
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Topology pieces = events.tubes_at(frames[k].state.time);
      views[k].coloured_by = {quantity, field.unit, field.is_signed};
      views[k].colour.clear();
      for (int t = 0; t < pieces.tubes(); ++t)
        views[k].colour.emplace_back(field.values[k].begin() + pieces.tube_begin[t],
                                     field.values[k].begin() + pieces.tube_begin[t + 1]);
    }
    return;
  }
  for (const ViewTubeNumber& number : tube_numbers(scene, prepared, prepared.topology)) {
    if (!is_it(number.name)) continue;
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Topology pieces = events.tubes_at(frames[k].state.time);
      views[k].coloured_by = {quantity, "", false};
      views[k].colour.clear();
      for (int t = 0; t < pieces.tubes(); ++t)
        views[k].colour.emplace_back(
            static_cast<std::size_t>(pieces.length_of(t)),
            number.values[static_cast<std::size_t>(prepared.topology.tube_of(pieces.tube_begin[t]))]);
    }
    return;
  }
  throw InputError({"", 0, "--colour"}, fmt::format("this run has no \"{}\" of its tubes", printable(word, 30)),
                   fmt::format("it has {}", fmt::join(there, ", ")));
}

}  // namespace ropewalk
