#include "sim/dynamics/langevin.hpp"

#include <algorithm>
#include <cmath>

#include "model/contract.hpp"
#include "model/counter_random.hpp"
#include "model/units.hpp"
#include "sim/threads/for_each.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
namespace {

constexpr int components = 6;  // components of velocity and angular velocity
// Elements whose numbers are made together, always in full: a vector function and its scalar twin, which would take
// a remainder, differ in the last bits.
constexpr int group = 16;

struct Normals {
  double of[components][group];
};

}  // namespace
}  // namespace ropewalk

#define ROPEWALK_LOOPS "sim/dynamics/langevin_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {
namespace {

// Draws the numbers of `group` elements; `number_of` gives the number in the scene of the k-th one.
template <class Number>
void draw(std::uint64_t seed, std::int64_t step, int part, const Number& number_of, Normals& out) {
  double radial[3][group], angular[3][group];
  const auto low = static_cast<std::uint32_t>(step), high = static_cast<std::uint32_t>(step >> 32);
  for (int k = 0; k < group; ++k) {
    const auto element = static_cast<std::uint32_t>(number_of(k));
    const auto of = static_cast<std::uint32_t>(2 * part);
    const auto a = philox({low, high, element, of}, seed), b = philox({low, high, element, of + 1}, seed);
    const std::uint32_t bits[3][2] = {{a[0], a[1]}, {a[2], a[3]}, {b[0], b[1]}};
    for (int pair = 0; pair < 3; ++pair) {
      radial[pair][k] = unit_interval(bits[pair][0]);
      angular[pair][k] = unit_interval(bits[pair][1]);
    }
  }
  ROPEWALK_IN_USE(to_normals)(radial, angular, out);
}

// The number of an element in the scene. The last group may reach beyond the elements; its numbers there are not
// used.
int number_of(const Topology& topology, int element) {
  if (!topology.part || element >= topology.elements()) return element;
  return topology.part->number[static_cast<std::size_t>(element)];
}

// Speed of the period of a slice, nm/ps. Its images have it beside the velocities of their originals.
double period_rate(const Topology& topology, const State& state) {
  const auto original = static_cast<std::size_t>(topology.original_of(0));  // element 0 is an image below it
  return state.velocity.z[original] - state.velocity.z[0];
}
void set_period_rate(const Topology& topology, double rate, State& state) {
  const int strand = topology.elements() / topology.strands();
  for (int first = 0; first < topology.elements(); first += strand)
    for (int k = 0; k < topology.groups.images; ++k)
      for (const int image : {first + k, first + strand - 1 - k}) {
        const int original = topology.original_of(image);
        state.velocity.z[static_cast<std::size_t>(image)] =
            state.velocity.z[static_cast<std::size_t>(original)] + (image > original ? rate : -rate);
      }
}

}  // namespace

void LangevinThermostat::apply(const Topology& topology, double dt, State& state, std::vector<double>&) const {
  ROPEWALK_EXPECTS(dt > 0 && friction_ >= 0 && static_cast<int>(state.size()) == topology.elements());
  const double keep = std::exp(-friction_ * dt);
  const double energy =
      -std::expm1(-2 * friction_ * dt) * units::boltzmann * temperature_.value(state.time);  // (1 - c^2) kT
  const auto n = static_cast<int>(state.size());
  const double rate = topology.groups.images > 0 ? period_rate(topology, state) : 0;
  for_each((n + group - 1) / group, state.size() > parallel_from, [&](int block) {
    const int first = block * group;
    Normals normal;
    draw(
        seed_, state.step, state.part, [&](int k) { return number_of(topology, first + k); }, normal);
    int tube = topology.tube_of(first);
    for (int k = 0; k < std::min(group, n - first); ++k) {
      while (first + k >= topology.tube_begin[tube + 1]) ++tube;
      const auto i = static_cast<std::size_t>(first + k);
      const TubeType& type = topology.type_of(tube);
      const auto& of = normal.of;
      state.velocity.set(
          i, keep * state.velocity[i] + std::sqrt(energy / type.mass) * Vector3(of[0][k], of[1][k], of[2][k]));
      state.angular_velocity.set(i, keep * state.angular_velocity[i] +
                                        std::sqrt(energy / type.inertia) * Vector3(of[3][k], of[4][k], of[5][k]));
    }
  });
  if (topology.groups.images == 0) return;
  Normals normal;  // beyond those of all elements
  const int behind = (n + group - 1) / group * group;
  draw(
      seed_, state.step, state.part, [&](int k) { return behind + k; }, normal);
  set_period_rate(topology, keep * rate + std::sqrt(energy / topology.groups.period_inertia) * normal.of[2][0],
                  state);
}

}  // namespace ropewalk
