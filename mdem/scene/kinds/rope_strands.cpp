// [rope] of tubes that end inside of it, and slices of endless ropes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/kinds/rope.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/scene_place.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

constexpr double hardest_push = 0.05;  // overlap of ends in line, nm

}  // namespace

double RopeSource::drawn_length(double element_length, Random& random) const {
  const double drawn = deviation > 0 ? tube_length + deviation * random.normal() : tube_length;
  return std::clamp(drawn, least_elements * element_length, 2 * tube_length);
}

std::vector<int> RopeSource::cuts(int strand_shift, double element_length, double gap_here, Random& random) const {
  const int n = whole_elements(length, element_length);
  const auto drawn = [&] { return drawn_length(element_length, random); };
  // The first tube is the rest of one that began below the rope.
  double part = 1;
  if (stagger == Stagger::brick) part = (strand_shift + 1) / 3.0;
  if (stagger == Stagger::random) part = random.uniform();
  std::vector<int> out;
  int last = 0;
  for (double tubes_so_far = part * drawn();; tubes_so_far += drawn()) {
    const int cut = static_cast<int>(std::lround(tubes_so_far / element_length));
    if (tubes_so_far + static_cast<double>(out.size() + 1) * gap_here > (n - least_elements) * element_length)
      return out;
    if (cut < last + least_elements) continue;
    out.push_back(cut);
    last = cut;
  }
}

double RopeSource::least_gap(const Scene& scene) const {
  const double rests = coaxial_gap(scene), least = gap > 0 ? gap : rests;
  if (least < rests - hardest_push)
    throw InputError(
        place_in(scene, "rope.gap_nm"),
        fmt::format("is {:.4g} nm, and ends of tubes rest {:.4g} nm apart by this contact law: they would be "
                    "driven into one another",
                    least, rests),
        fmt::format("take at least {:.3g}", rests - hardest_push));
  return least;
}

namespace {

// 0, 1 or 2: neighbours on the lattice have different ones.
int shift_of(double x, double y, double spacing) {
  const long long j = std::llround(y / (0.5 * std::sqrt(3.0) * spacing)),
                  i = std::llround(x / spacing - 0.5 * static_cast<double>(j));
  return static_cast<int>(((i - j) % 3 + 3) % 3);
}

}  // namespace

// All strands have the same number of elements and the length of the rope; gaps take what the elements leave.
void RopeSource::place_strands(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                               State& state) const {
  const double a = scene.element_length, least_hole = least_gap(scene);
  const std::vector<std::pair<double, double>> at = places(spacing_of_tubes, scene.start.seed);
  std::vector<std::vector<int>> cuts_of;
  std::size_t most = 0;
  for (const auto& [x, y] : at) {
    cuts_of.push_back(cuts(shift_of(x, y, spacing_of_tubes), a, least_hole, random));
    most = std::max(most, cuts_of.back().size());
  }
  const double holes = static_cast<double>(most) * least_hole;
  const int elements = whole_elements(length - holes, a);
  topology.groups.strand_begin = {0};
  std::vector<Vector3> positions;
  for (std::size_t s = 0; s < at.size(); ++s) {
    std::vector<int>& cut = cuts_of[s];
    while (!cut.empty() && cut.back() > elements - least_elements) cut.pop_back();
    cut.push_back(elements);
    const double here = cut.size() > 1 ? holes / static_cast<double>(cut.size() - 1) : 0;
    double z = -0.5 * ((elements - 1) * a + (cut.size() > 1 ? holes : 0));
    int from = 0;
    for (const int to : cut) {
      topology.add_tube(to - from);
      for (; from < to; ++from, z += a) positions.emplace_back(at[s].first, at[s].second, z);
      z += here;
    }
    if (cut.size() > 1) topology.groups.strand_holes = holes;
    topology.groups.strand_begin.push_back(topology.tubes());
  }
  state = State(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) state.position.set(i, positions[i]);
}

// Elements of the period, from 0, with which a tube begins. Images at both ends of the slice go on with the same
// tubes; those at the very ends shall have enough elements.
std::vector<int> RopeSource::cuts_of_period(int strand_shift, int own, int tubes_in_line, int images,
                                            double element_length, Random& random) const {
  std::vector<double> lengths;
  double sum = 0;
  for (int k = 0; k < tubes_in_line; ++k) {
    lengths.push_back(drawn_length(element_length, random));
    sum += lengths.back();
  }
  double begin = 0;
  if (stagger == Stagger::brick) begin = strand_shift / 3.0 * own / tubes_in_line;
  if (stagger == Stagger::random) begin = random.uniform() * own;
  const int all = own + 2 * images;
  for (int shift = 0;; ++shift) {
    std::vector<int> out;
    double at = begin + shift;
    bool leaves_a_stub = false;
    for (const double l : lengths) {
      const int cut = static_cast<int>(std::lround(at)) % own;
      for (const int place : {cut + images - own, cut + images, cut + images + own})
        leaves_a_stub =
            leaves_a_stub || (place > 0 && place < least_elements) || (place < all && place > all - least_elements);
      out.push_back(cut);
      at += l / sum * own;
    }
    if (leaves_a_stub && shift < own) continue;
    std::sort(out.begin(), out.end());
    return out;
  }
}

void RopeSource::place_slice(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                             State& state) const {
  const double a = scene.element_length;
  const int images = topology.groups.images, all = whole_elements(length, a);
  const bool cut = tube_length > 0;
  const double hole = cut ? least_gap(scene) : 0;
  const double apart = (all - 2 * images) * a;  // nm, about the period
  const int in_line = cut ? std::max(1, static_cast<int>(std::lround(apart / (tube_length + hole)))) : 0;
  const int own = whole_elements(length - in_line * hole, a) - 2 * images;
  if (own < std::max(images, in_line * (least_elements + 1)))
    throw InputError(
        place_in(scene, "rope.length_nm"),
        fmt::format("leaves {} elements between {} images at each end of the slice", std::max(0, own), images),
        fmt::format("make the tubes at least {:.4g} nm long",
                    (std::max(images, in_line * (least_elements + 1)) + 2 * images) * a + in_line * hole));
  topology.groups.period = own * a + in_line * hole;
  if (cut && tube_length > topology.groups.period)
    throw InputError(
        place_in(scene, "rope.tube_length_nm"),
        fmt::format("is {:.4g} nm, and the slice repeats itself after {:.4g} nm: a tube would go on "
                    "beside its own image",
                    tube_length, topology.groups.period),
        fmt::format("make rope.length_nm at least {:.4g}", length + tube_length - topology.groups.period + a));
  std::vector<Vector3> positions;
  if (cut) topology.groups.strand_begin = {0};
  for (const auto& [x, y] : places(spacing_of_tubes, scene.start.seed)) {
    const std::vector<int> begins =
        cut ? cuts_of_period(shift_of(x, y, spacing_of_tubes), own, in_line, images, a, random)
            : std::vector<int>();
    int length_so_far = 0, holes = 0;
    for (int k = 0; k < own + 2 * images; ++k) {
      const int in_period = (k - images + own) % own, period = (k - images - in_period) / own;
      const auto upper = std::upper_bound(begins.begin(), begins.end(), in_period);
      const bool begins_here = upper != begins.begin() && *(upper - 1) == in_period;
      if (begins_here && k > 0) {
        topology.add_tube(length_so_far);
        length_so_far = 0;
        ++holes;
      }
      ++length_so_far;
      positions.emplace_back(x, y,
                             period * topology.groups.period + in_period * a +
                                 static_cast<double>(upper - begins.begin()) * hole -
                                 0.5 * (topology.groups.period - a + hole));
    }
    topology.add_tube(length_so_far);
    topology.groups.strand_holes = std::max(topology.groups.strand_holes, holes * hole);
    if (cut) topology.groups.strand_begin.push_back(topology.tubes());
  }
  state = State(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) state.position.set(i, positions[i]);
}

}  // namespace ropewalk
