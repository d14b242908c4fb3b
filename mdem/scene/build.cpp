#include "scene/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/error.hpp"
#include "scene/kinds/film.hpp"
#include "scene/maxwell.hpp"
#include "scene/random.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {

constexpr double graphite_gap = 0.335;   // nm, between the walls of tubes for which there is no law
constexpr double viscosity_reach = 1.5;  // spacings
constexpr double right_angle = 0.5 * units::pi;

// Between two points that bracket a minimum.
template <class F>
double golden_section(F f, double a, double b, double tolerance) {
  const double part = 0.5 * (std::sqrt(5.0) - 1);
  double x1 = b - part * (b - a), x2 = a + part * (b - a);
  double f1 = f(x1), f2 = f(x2);
  while (b - a > tolerance) {
    if (f1 < f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      x1 = b - part * (b - a);
      f1 = f(x1);
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      x2 = a + part * (b - a);
      f2 = f(x2);
    }
  }
  return 0.5 * (a + b);
}

// The distance at which two tubes bind best, their energy given. `key` is what to type where they do not bind.
template <class F>
double lowest(const PaperContact& contact, const char* key, F energy) {
  // The well is found on a grid first: beyond it the energy is not convex.
  constexpr int grid = 400;
  const double from = 2 * contact.radius, step = (contact.cutoff() - from) / grid;
  std::vector<double> at;
  for (int k = 0; k <= grid; ++k) at.push_back(energy(from + k * step));
  const auto well = static_cast<int>(std::min_element(at.begin(), at.end()) - at.begin());
  if (well == 0 || well == grid || at[static_cast<std::size_t>(well)] >= 0)
    throw InputError({"", 0, "contact.paper"}, "does not bind two tubes", fmt::format("type {}", key));
  return golden_section(energy, from + (well - 1) * step, from + (well + 1) * step, 1e-9);
}

double graphite_spacing(const Scene& scene) {
  double largest = 0;
  for (const ParameterSet& set : scene.sets) largest = std::max(largest, set.radius);
  return 2 * largest + graphite_gap;
}

double spacing_of(const Scene& scene, double element_length) {
  const auto* rope = std::get_if<RopeSource>(&scene.source);
  if (rope && rope->spacing > 0) return rope->spacing;
  double largest = 0;
  switch (scene.contact.law) {
    case ContactOptions::Law::paper:
      return pair_spacing(paper_contact(scene), element_length);
    case ContactOptions::Law::line:
      for (const LineContact& pair : line_contacts(scene))
        largest = std::max(largest, line_parallel_well(pair.density).distance);
      return largest;
    case ContactOptions::Law::none:
      break;
  }
  return graphite_spacing(scene);
}

// Straight tubes along z, centred on the origin.
void add_tubes(const std::vector<std::pair<double, double>>& places, int elements, double element_length,
               BuiltScene& out) {
  for (std::size_t t = 0; t < places.size(); ++t) out.topology.add_tube(elements);
  out.state = State(static_cast<std::size_t>(out.topology.elements()));
  std::size_t i = 0;
  for (const auto& [x, y] : places)
    for (int e = 0; e < elements; ++e)
      out.state.position.set(i++, {x, y, (e - 0.5 * (elements - 1)) * element_length});
}

void displace(double amplitude, Random& random, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.position.x[i] += random.uniform(-amplitude, amplitude);
    state.position.y[i] += random.uniform(-amplitude, amplitude);
  }
}

void place_elements(const Scene& scene, Random& random, BuiltScene& out) {
  if (const auto* rope = std::get_if<RopeSource>(&scene.source)) {
    add_tubes(hexagonal_lattice(rope->tubes, out.spacing), whole_elements(rope->length, scene.element_length),
              scene.element_length, out);
    if (rope->perturbation > 0) displace(rope->perturbation, random, out.state);
  } else if (const auto* film = std::get_if<FilmSource>(&scene.source)) {
    const int elements = whole_elements(film->length, scene.element_length);
    const double spacing = film->spacing > 0 ? film->spacing : crossed_spacing(scene);
    add_film(lay_film(*film, elements, scene.element_length, spacing, random), elements, scene.element_length,
             out.topology, out.state);
  } else if (const auto* chain = std::get_if<ChainSource>(&scene.source)) {
    add_tubes({{0.0, 0.0}}, chain->elements, scene.element_length, out);
  } else {
    read_state_csv(std::get<StateSource>(scene.source).file, out.topology, out.state);
  }
}

void set_tube_types(const Scene& scene, Topology& topology) {
  if (scene.tube_types.empty()) return;
  if (static_cast<int>(scene.tube_types.size()) != topology.tubes())
    throw InputError(
        {scene.path, 0, "tube_types"},
        fmt::format("has {} numbers, and the scene has {} tubes", scene.tube_types.size(), topology.tubes()),
        "write one for each tube");
  topology.tube_type = scene.tube_types;
}

// What a state file may lack for the rest of the scene.
void check_state(const Scene& scene, const BuiltScene& built) {
  if (scene.temperature > 0 && built.state.size() < 2)
    throw InputError({scene.path, 0, "start.temperature_K"},
                     "one element alone has no thermal motion about its centre", "take 0");
  if (!scene.twist) return;
  if (scene.twist->application == TwistProtocol::Application::tangential && built.topology.tubes() == 1)
    throw InputError({scene.path, 0, "twist.application"},
                     "tangential forces about the axis of one tube have no arm", "take \"couple\"");
  for (int t = 0; t < built.topology.tubes(); ++t)
    if (built.topology.length_of(t) < 2)
      throw InputError({scene.path, 0, "twist"}, fmt::format("tube {} has one element and no two grips", t),
                       "take tubes of two elements or more");
}

}  // namespace

double pair_spacing(const PaperContact& contact, double element_length) {
  return lowest(contact, "rope.spacing_nm",
                [&](double spacing) { return paper_parallel_energy(contact, element_length, spacing); });
}

double crossed_spacing(const Scene& scene) {
  double largest = 0;
  switch (scene.contact.law) {
    case ContactOptions::Law::paper: {
      const PaperContact contact = paper_contact(scene);
      return lowest(contact, "film.spacing_nm", [&](double spacing) {
        return paper_crossed_energy(contact, scene.element_length, spacing, right_angle);
      });
    }
    case ContactOptions::Law::line:
      for (const LineContact& pair : line_contacts(scene))
        largest = std::max(largest, line_crossed_well(pair.density, right_angle).distance);
      return largest;
    case ContactOptions::Law::none:
      break;
  }
  return graphite_spacing(scene);
}

BuiltScene build(Scene& scene) {
  BuiltScene out;
  out.topology = empty_topology(scene);
  out.spacing = spacing_of(scene, scene.element_length);
  scene.damping.contact.inner = out.spacing;
  scene.damping.contact.outer = viscosity_reach * out.spacing;
  Random random(scene.seed);
  place_elements(scene, random, out);
  set_tube_types(scene, out.topology);
  check_state(scene, out);
  if (scene.temperature > 0) set_thermal_velocities(out.topology, scene.temperature, random, out.state);
  return out;
}

}  // namespace ropewalk
