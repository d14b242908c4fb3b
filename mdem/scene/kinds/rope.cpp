#include "scene/kinds/rope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/counter_random.hpp"
#include "scene/bounds.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

constexpr int least_elements = RopeSource::least_elements;

}  // namespace

void check_rope_size(const TomlTable& t, const Scene& scene, const RopeSource& rope, int ropes) {
  const auto [below, above] = nearest_hexagonal(rope.tubes);
  if (below != above && rope.packing == RopeSource::Packing::hexagonal && rope.typed_places.empty())
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

void read_places(const TomlTable& t, const Scene&, RopeSource& rope) {
  if (!t.has("places_nm")) return;
  for (const std::vector<double>& row : t.rows("places_nm", Bounds::range(-1e6, 1e6), 2))
    rope.typed_places.emplace_back(row[0], row[1]);
}

// Whether tubes overlap or lie inside of one another is for prepare() to see, which knows the type of each.
void check_places(const TomlTable& t, const RopeSource& rope) {
  const auto& places = rope.typed_places;
  if (places.empty()) return;
  if (t.has("packing")) throw t.error("places_nm", "stands beside packing", "take one of the two away");
  if (places.size() != static_cast<std::size_t>(rope.tubes))
    throw t.error("places_nm", fmt::format("has {} places, and the rope has {} tubes", places.size(), rope.tubes),
                  fmt::format("write tubes = {}", places.size()));
}

void check_rope(const TomlTable& t, const Scene& scene, RopeSource& rope) {
  check_rope_size(t, scene, rope, 1);
  check_places(t, rope);
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
       "parallel tubes along z, centred on the origin",
       {Key::integer("tubes", 1, max_elements, &RopeSource::tubes, required("91"),
                     "tubes in a cross-section; a hexagonal one has 1, 7, 19, 37, 61, 91, ..."),
        Key::word("packing",
                  Words<RopeSource::Packing>{{"hexagonal", RopeSource::Packing::hexagonal},
                                             {"round", RopeSource::Packing::round},
                                             {"random", RopeSource::Packing::random}},
                  &RopeSource::packing, standard(),
                  "\"hexagonal\": full shells of the lattice; \"round\": any number of tubes, on the places "
                  "nearest to the axis; \"random\": tubes begin at random places and move together until they "
                  "touch, as those of several types do in any packing"),
        Key::custom("places_nm", "nm", otherwise("[[0, 0], [1.7, 0]]", "by packing"),
                    "x and y of each tube in the cross-section, where they stay", read_places),
        Key::number("length_nm", unit::nm, Bounds::positive(1e9), &RopeSource::length, required("67.8"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("spacing_nm", unit::nm, spacing_bounds, &RopeSource::spacing,
                    otherwise("1.713", "where two tubes bind best"), "distance between tube axes"),
        Key::number("perturbation_nm", unit::nm, Bounds::non_negative(0.1), &RopeSource::perturbation, standard(),
                    "largest random displacement of an element in x and in y; for elements of another length than "
                    "the set's own it is scaled, so that long waves stay the same"),
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
                    "least hole between the walls of two tubes in line; holes are wider in strands with fewer "
                    "ends, so that all have the same number of elements")},
       check_rope});
}

Source::Sizes RopeSource::sizes(double element_length) const {
  return {tube_length > 0 ? 0 : tubes, whole_elements(length, element_length)};
}

namespace {

// Anywhere in a disc that has room for them.
std::vector<std::pair<double, double>> places_at_random(int tubes, double spacing, std::uint64_t seed) {
  constexpr double filled = 0.6, cell = 0.8660254037844386;  // fraction of the disc; sqrt(3)/2
  const double rim = spacing * std::sqrt(tubes * cell / (units::pi * filled));
  std::vector<std::pair<double, double>> out;
  for (int t = 0; t < tubes; ++t) {
    const auto bits = philox({static_cast<std::uint32_t>(t), 1, 0, 0}, seed);
    const double r = rim * std::sqrt(unit_interval(bits[0])), angle = 2 * units::pi * unit_interval(bits[1]);
    out.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return out;
}

}  // namespace

std::vector<std::pair<double, double>> RopeSource::places(double spacing_of_tubes, std::uint64_t seed) const {
  if (!typed_places.empty()) return typed_places;
  if (packing == Packing::random) return places_at_random(tubes, spacing_of_tubes, seed);
  if (packing == Packing::hexagonal) return hexagonal_lattice(tubes, spacing_of_tubes);
  std::vector<std::pair<double, double>> all = hexagonal_lattice(nearest_hexagonal(tubes).second, spacing_of_tubes);
  // Distances that differ by rounding are one.
  const auto shell = [&](const std::pair<double, double>& p) {
    return std::llround(1e6 * std::hypot(p.first, p.second) / spacing_of_tubes);
  };
  std::stable_sort(all.begin(), all.end(), [&](const auto& p, const auto& q) { return shell(p) < shell(q); });
  all.resize(static_cast<std::size_t>(tubes));
  return all;
}

void RopeSource::place(const Scene& scene, double spacing_of_tubes, Random& random, Topology& topology,
                       State& state) const {
  if (topology.groups.images > 0)
    place_slice(scene, spacing_of_tubes, random, topology, state);
  else if (tube_length > 0)
    place_strands(scene, spacing_of_tubes, random, topology, state);
  else
    add_straight_tubes(places(spacing_of_tubes, scene.start.seed), sizes(scene.element_length).elements,
                       scene.element_length, topology, state);
  // The same in all waves that the elements can show, whatever their length.
  if (perturbation > 0)
    displace(perturbation * std::sqrt(own_element_length(scene) / scene.element_length), random, state);
}

std::string RopeSource::description(const Topology& t, const State&, double spacing_of_tubes) const {
  if (!(tube_length > 0))
    return fmt::format("a rope of {:.4g} nm, spacing {:.4g} nm", t.length_of(0) * t.longest_element(),
                       spacing_of_tubes);
  if (t.groups.images > 0) {
    int ends = 0;
    for (int tube = 0; tube < t.tubes(); ++tube)
      ends += !t.ends_strand(tube) && !t.is_image(t.tube_begin[tube + 1] - 1);
    return fmt::format(
        "a slice of an endless rope that repeats itself after {:.4g} nm, spacing {:.4g} nm: {} tubes of {:.4g} nm "
        "in "
        "the mean, in {} strands",
        t.groups.period, spacing_of_tubes, ends,
        t.strands() * (t.elements() / t.strands() - 2 * t.groups.images) * t.longest_element() / ends, t.strands());
  }
  return fmt::format("a rope of {:.4g} nm, spacing {:.4g} nm, of {} tubes of {:.4g} nm in the mean, in {} strands",
                     t.elements() / t.strands() * t.longest_element() + t.groups.strand_holes, spacing_of_tubes,
                     t.tubes(), t.elements() * t.longest_element() / t.tubes(), t.strands());
}

}  // namespace ropewalk
