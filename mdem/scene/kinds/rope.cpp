#include "scene/kinds/rope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/bounds.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

constexpr int least_elements = 3;      // of a tube
constexpr double hardest_push = 0.05;  // nm, of ends in line

}  // namespace

void check_rope_size(const TomlTable& t, const Scene& scene, const RopeSource& rope, int ropes) {
  const auto [below, above] = nearest_hexagonal(rope.tubes);
  if (below != above && rope.packing == RopeSource::Packing::hexagonal)
    throw t.error("tubes", fmt::format("is {}, not a hexagonal number", rope.tubes),
                  fmt::format("the nearest are {} and {}; packing = \"round\" takes any number", below, above));
  const double elements = std::round(rope.length / scene.element_length);
  if (elements < least_elements)
    throw t.error("length_nm",
                  fmt::format("is {} nm, {} elements of {} nm", rope.length, elements, scene.element_length),
                  fmt::format("at least {} elements, {:.4g} nm, are needed", least_elements,
                              least_elements * scene.element_length));
  check_size(t, "length_nm", double{1} * ropes * rope.tubes, elements);
}

namespace {

void check_rope(const TomlTable& t, const Scene& scene, RopeSource& rope) {
  check_rope_size(t, scene, rope, 1);
  const double least = least_elements * scene.element_length;
  const std::pair<const char*, bool> of_ends[] = {{"tube_length_deviation_nm", rope.deviation > 0},
                                                  {"gap_nm", rope.gap > 0},
                                                  {"stagger", rope.stagger != RopeSource::Stagger::random}};
  for (const auto& [key, said] : of_ends)
    if (said && !(rope.tube_length > 0))
      throw t.error(key, "is about tubes that end inside of the rope", "give tube_length_nm too");
  if (rope.tube_length > 0 && rope.tube_length < least)
    throw t.error("tube_length_nm",
                  fmt::format("is {:.4g} nm, less than {} elements", rope.tube_length, least_elements),
                  fmt::format("take at least {:.4g} nm, or shorter elements", least));
  if (rope.tube_length > 0 && rope.deviation > 0.5 * rope.tube_length)
    throw t.error("tube_length_deviation_nm", "is more than half of the mean length",
                  fmt::format("take at most {:.4g}", 0.5 * rope.tube_length));
}

void displace(double amplitude, Random& random, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.position.x[i] += random.uniform(-amplitude, amplitude);
    state.position.y[i] += random.uniform(-amplitude, amplitude);
  }
}

}  // namespace

SceneKind rope_kind() {
  using Key = KeyOf<RopeSource>;
  return scene_kind<RopeSource>(
      {"rope",
       "parallel tubes along z in hexagonal packing, centred on the origin",
       {Key::integer("tubes", 1, max_elements, &RopeSource::tubes, required("91"),
                     "in a cross-section: a hexagonal number 1, 7, 19, 37, 61, 91, 127, 169, 217, ..."),
        Key::word(
            "packing",
            Words<RopeSource::Packing>{{"hexagonal", RopeSource::Packing::hexagonal},
                                       {"round", RopeSource::Packing::round}},
            &RopeSource::packing, standard(),
            "full shells of the lattice, or \"round\": any number of tubes on the places nearest to the axis"),
        Key::number("length_nm", unit::nm, Bounds::positive(1e9), &RopeSource::length, required("67.8"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("spacing_nm", unit::nm, spacing_bounds, &RopeSource::spacing,
                    otherwise("1.713", "where two tubes bind best"), "distance between tube axes"),
        Key::number("perturbation_nm", unit::nm, Bounds::non_negative(0.1), &RopeSource::perturbation, standard(),
                    "each element is displaced at random by up to this in x and y"),
        Key::number(
            "tube_length_nm", unit::nm, Bounds::positive(1e9), &RopeSource::tube_length,
            otherwise("20", "length_nm"),
            "mean length of the tubes: shorter ones follow one another in line, with ends inside of the rope"),
        Key::number("tube_length_deviation_nm", unit::nm, Bounds::non_negative(1e9), &RopeSource::deviation,
                    standard(), "standard deviation of their lengths"),
        Key::word(
            "stagger",
            Words<RopeSource::Stagger>{{"none", RopeSource::Stagger::none},
                                       {"brick", RopeSource::Stagger::brick},
                                       {"random", RopeSource::Stagger::random}},
            &RopeSource::stagger, standard(),
            "ends of neighbouring tubes: \"none\" at one height, \"brick\" a third of a tube apart, \"random\""),
        Key::number("gap_nm", unit::nm, Bounds::positive(10), &RopeSource::gap,
                    otherwise("0.25", "where the ends rest"),
                    "least hole between the walls of two tubes in line; holes grow until all strands have as many "
                    "elements")},
       check_rope});
}

Source::Sizes RopeSource::sizes(double element_length) const {
  return {tube_length > 0 ? 0 : tubes, whole_elements(length, element_length)};
}

std::vector<std::pair<double, double>> RopeSource::places(double spacing_of_tubes) const {
  if (packing == Packing::hexagonal) return hexagonal_lattice(tubes, spacing_of_tubes);
  std::vector<std::pair<double, double>> all = hexagonal_lattice(nearest_hexagonal(tubes).second, spacing_of_tubes);
  // Distances that differ by rounding are one.
  const auto shell = [&](const std::pair<double, double>& p) {
    return std::lround(1e6 * std::hypot(p.first, p.second) / spacing_of_tubes);
  };
  std::stable_sort(all.begin(), all.end(), [&](const auto& p, const auto& q) { return shell(p) < shell(q); });
  all.resize(static_cast<std::size_t>(tubes));
  return all;
}

void RopeSource::place(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                       State& state) const {
  if (topology.images > 0)
    place_slice(scene, spacing_of_tubes, random, topology, state);
  else if (tube_length > 0)
    place_strands(scene, spacing_of_tubes, random, topology, state);
  else
    add_straight_tubes(places(spacing_of_tubes), sizes(scene.element_length).elements, scene.element_length,
                       topology, state);
  if (perturbation > 0) displace(perturbation, random, state);
}

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
        {scene.path, 0, "rope.gap_nm"},
        fmt::format("is {:.4g} nm, and ends of tubes rest {:.4g} nm apart by this contact law: they would be "
                    "driven into one another",
                    least, rests),
        fmt::format("take at least {:.3g}", rests - hardest_push));
  return least;
}

namespace {

// 0, 1 or 2: neighbours on the lattice have different ones.
int shift_of(double x, double y, double spacing) {
  const long j = std::lround(y / (0.5 * std::sqrt(3.0) * spacing)),
             i = std::lround(x / spacing - 0.5 * static_cast<double>(j));
  return static_cast<int>(((i - j) % 3 + 3) % 3);
}

}  // namespace

// All strands have the same number of elements and the length of the rope; gaps take what the elements leave.
void RopeSource::place_strands(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                               State& state) const {
  const double a = scene.element_length, least_hole = least_gap(scene);
  const std::vector<std::pair<double, double>> at = places(spacing_of_tubes);
  std::vector<std::vector<int>> cuts_of;
  std::size_t most = 0;
  for (const auto& [x, y] : at) {
    cuts_of.push_back(cuts(shift_of(x, y, spacing_of_tubes), a, least_hole, random));
    most = std::max(most, cuts_of.back().size());
  }
  const double holes = static_cast<double>(most) * least_hole;
  const int elements = whole_elements(length - holes, a);
  topology.strand_begin = {0};
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
    if (cut.size() > 1) topology.strand_holes = holes;
    topology.strand_begin.push_back(topology.tubes());
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
  const int images = topology.images, all = whole_elements(length, a);
  const bool cut = tube_length > 0;
  const double hole = cut ? least_gap(scene) : 0;
  const double apart = (all - 2 * images) * a;  // nm, about the period
  const int in_line = cut ? std::max(1, static_cast<int>(std::lround(apart / (tube_length + hole)))) : 0;
  const int own = whole_elements(length - in_line * hole, a) - 2 * images;
  if (own < std::max(images, in_line * (least_elements + 1)))
    throw InputError(
        {scene.path, 0, "rope.length_nm"},
        fmt::format("leaves {} elements between {} images at each end of the slice", std::max(0, own), images),
        fmt::format("make the tubes at least {:.4g} nm long",
                    (std::max(images, in_line * (least_elements + 1)) + 2 * images) * a + in_line * hole));
  topology.period = own * a + in_line * hole;
  if (cut && tube_length > topology.period)
    throw InputError(
        {scene.path, 0, "rope.tube_length_nm"},
        fmt::format("is {:.4g} nm, and the slice repeats itself after {:.4g} nm: a tube would go on "
                    "beside its own image",
                    tube_length, topology.period),
        fmt::format("make rope.length_nm at least {:.4g}", length + tube_length - topology.period + a));
  std::vector<Vector3> positions;
  if (cut) topology.strand_begin = {0};
  for (const auto& [x, y] : places(spacing_of_tubes)) {
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
                             period * topology.period + in_period * a +
                                 static_cast<double>(upper - begins.begin()) * hole -
                                 0.5 * (topology.period - a + hole));
    }
    topology.add_tube(length_so_far);
    topology.strand_holes = std::max(topology.strand_holes, holes * hole);
    if (cut) topology.strand_begin.push_back(topology.tubes());
  }
  state = State(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) state.position.set(i, positions[i]);
}

std::string RopeSource::description(const Topology& t, const State&, double spacing_of_tubes) const {
  if (!(tube_length > 0))
    return fmt::format("a rope of {:.4g} nm, spacing {:.4g} nm", t.length_of(0) * t.longest_element(),
                       spacing_of_tubes);
  if (t.images > 0) {
    int ends = 0;
    for (int tube = 0; tube < t.tubes(); ++tube)
      ends += !t.ends_strand(tube) && !t.is_image(t.tube_begin[tube + 1] - 1);
    return fmt::format(
        "a slice of an endless rope that repeats itself after {:.4g} nm, spacing {:.4g} nm: {} tubes of {:.4g} nm "
        "in "
        "the mean, in {} strands",
        t.period, spacing_of_tubes, ends,
        t.strands() * (t.elements() / t.strands() - 2 * t.images) * t.longest_element() / ends, t.strands());
  }
  return fmt::format("a rope of {:.4g} nm, spacing {:.4g} nm, of {} tubes of {:.4g} nm in the mean, in {} strands",
                     t.elements() / t.strands() * t.longest_element() + t.strand_holes, spacing_of_tubes, t.tubes(),
                     t.elements() * t.longest_element() / t.tubes(), t.strands());
}

}  // namespace ropewalk
