// A filament that is curved and twisted at rest, and one that bends more easily about one axis than about the other.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "cases/common/chain.hpp"
#include "model/error.hpp"
#include "sim/statics/newton.hpp"

namespace ropewalk::validate::natural_helix {
namespace {

constexpr double turn_of_bond = 0.24;  // rad, about the axis and across it, where the set has no natural shape

// The oracle, or the model with the fault: a set without a natural shape is given one.
ParameterSet with_shape(ParameterSet set, const ParameterSet& own, double fault) {
  if (own.bond.natural.x == 0 && own.bond.natural.y == 0)
    set.bond.natural = {0, fault * turn_of_bond / own.element_length, fault * turn_of_bond / own.element_length};
  return set;
}

struct Helix {
  double radius = 0, pitch = 0;  // nm
};

Helix rod_at_rest(const ParameterSet& set) {
  const forms::Vec& k = set.bond.natural;
  const double curvature2 = k.x * k.x + k.y * k.y, all2 = curvature2 + k.z * k.z;
  return {std::sqrt(curvature2) / all2, 2 * units::pi * k.z / all2};
}

// The helix through four points in the middle of a chain: second differences point to its axis.
Helix helix_of(const State& s) {
  const std::size_t m = s.size() / 2;
  const auto inward = [&](std::size_t i) -> Vector3 { return s.position[i - 1] - 2 * s.position[i] + s.position[i + 1]; };
  const Vector3 here = inward(m), next = inward(m + 1), axis = here.cross(next).normalized();
  const double angle = std::atan2(here.cross(next).norm(), here.dot(next));
  return {here.norm() / (2 * (1 - std::cos(angle))),
          axis.dot(s.position[m + 1] - s.position[m]) * 2 * units::pi / angle};
}

// Starts straight. left: the energy at rest over that at the start.
struct AtRest {
  Helix helix;
  double left = 0;
};

AtRest at_rest(const ParameterSet& set, int bonds) {
  const Chain chain(set, bonds);
  Simulation s = chain.make();
  const double start = s.forces().energy.bonds();
  NewtonOptions options;
  options.farthest = set.radius;
  const Statics end = NewtonStatics(s, options).relax({1e-8, 1e-8}, 2000, [](long) { return true; });
  if (!end.relaxed.at_rest)
    throw NumericalError(s.state().step, -1, "the filament did not come to rest", "allow more steps");
  return {helix_of(s.state()), s.forces().energy.bonds() / start};
}

void check_helix(const ParameterSet& model, const ParameterSet& oracle, CaseResult& result) {
  constexpr int bonds = 24;
  const Helix rod = rod_at_rest(oracle);
  const double angle = oracle.element_length * vector(oracle.bond.natural).norm();
  std::vector<double> lengths, errors;
  for (const int part : {1, 2, 4}) {
    ParameterSet finer = model;
    finer.element_length /= part;
    const AtRest found = at_rest(finer, bonds * part);
    if (part == 1) {
      result.check_absolute("energy left of the straight start", found.left, 0, 1e-9, "1", "a helix at rest has none");
      result.check_relative("radius of the helix", found.helix.radius, rod.radius, 1e-2, "nm");
    }
    result.check_relative(fmt::format("pitch, elements of {:.3g} nm", finer.element_length), found.helix.pitch, rod.pitch,
                          1e-4, "nm", "of any length: each bond turns and rises as the rod does");
    lengths.push_back(finer.element_length);
    errors.push_back(found.helix.radius / rod.radius - 1);
    result.check_relative(fmt::format("error of the radius, elements of {:.3g} nm", finer.element_length), errors.back(),
                          std::pow(angle / part, 2) / 24, 3e-2, "1", "a bond is a chord as long as the arc: `(a kappa_0)^2/24`");
  }
  for (double& e : errors) e *= 100;
  const double whole = oracle.element_length;
  result.figure("Radius of a filament that is a helix at rest", {"element length", "nm"}, {"error of the radius", "%"},
                "The filament begins straight and comes to rest. Radius of the elements, against "
                "`kappa/(kappa^2 + tau^2)`.",
                {theory_curve("(a kappa_0)^2/24", 0.2 * whole, whole,
                              [&](double a) { return 100 * std::pow(a / whole * angle, 2) / 24; }),
                 model_points("at rest", lengths, errors)});
}

// A closed ring of its own curvature, and the same ring of a filament that is straight at rest.
void check_ring(const ParameterSet& model, double fault, CaseResult& result) {
  constexpr int elements = 50;
  const double a = model.element_length, step = 2 * units::pi / elements, radius = 0.5 * a / std::sin(0.5 * step);
  BondStiffness curved = straightened(model.bond), straight = curved;
  curved.natural = {-fault * step / a, 0, 0};
  const auto frame = [&](int k) { return frame_of(turn_about(Vector3::UnitX(), -k * step)); };
  const Vector3 chord(0, radius * (1 - std::cos(step)), radius * std::sin(step));
  const auto energy = [&](const BondStiffness& k) { return bond_energy(k, a, chord, frame(0), frame(1)).total(); };
  result.check_absolute("energy of a ring of its own curvature, over that of a straight filament",
                        energy(curved) / energy(straight), 0, 1e-12, "1");
}

// The stiffness with which a clamped chain bends under couples about x and y at its end.
std::array<double, 2> stiffness_of(const ParameterSet& set, int bonds) {
  const Chain chain(set, bonds);
  std::vector<int> freedoms;
  for (int k = 6; k < 6 * (bonds + 1); ++k) freedoms.push_back(k);
  const auto lu = tangent_stiffness(set.bond, set.element_length, chain.state, freedoms).fullPivLu();
  std::array<double, 2> out{};
  for (const int axis : {0, 1}) {
    Eigen::VectorXd couple = Eigen::VectorXd::Zero(6 * bonds);
    const Eigen::Index at = 6 * bonds - 3 + axis;
    couple(at) = 1;
    out[static_cast<std::size_t>(axis)] = chain.length() / lu.solve(couple)(at);
  }
  return out;
}

void check_two_stiffnesses(const ParameterSet& of_model, const ParameterSet& of_oracle, CaseResult& result) {
  constexpr int bonds = 40, half_turns = 5;
  ParameterSet model = of_model, oracle = of_oracle;
  for (ParameterSet* set : {&model, &oracle}) {
    set->bond.natural = {};
    if (of_oracle.bond.bend_difference == 0) set->bond.bend_difference = 0.5 * set->bond.bend;
  }
  const double one = oracle.bond.bend + oracle.bond.bend_difference, two = oracle.bond.bend - oracle.bond.bend_difference;
  const auto own = stiffness_of(model, bonds);
  result.check_relative("stiffness about the first axis", own[0], one, 1e-5, "eV nm");
  result.check_relative("stiffness about the second axis", own[1], two, 1e-5, "eV nm");
  model.bond.natural.z = half_turns * units::pi / (bonds * model.element_length);
  const auto twisted = stiffness_of(model, bonds);
  const double mean = 2 / (1 / one + 1 / two);
  for (const std::size_t axis : {0u, 1u})
    result.check_relative(fmt::format("stiffness of five half turns about {}", axis == 0 ? "x" : "y"), twisted[axis], mean,
                          1e-4, "eV nm", "`2/(1/EI_1 + 1/EI_2)`: either axis takes its turn");
}

CaseResult run(const CaseContext& context) {
  const ParameterSet oracle = with_shape(context.set(), context.set(), 1),
                     model = with_shape(context.model(), context.set(), context.fault.natural);
  CaseResult result;
  check_helix(model, oracle, result);
  check_ring(model, context.fault.natural, result);
  check_two_stiffnesses(model, oracle, result);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "natural-helix";
  c.order = 87;
  c.law = Case::Law::none;
  c.sets = {"f-actin"};
  c.shaped = true;
  c.run = run;
  c.turns_red = {{wrong_natural_shape(1.1), {"radius of the helix", "pitch", "energy of a ring"}},
                 {wrong_EI(1.1), {"about the first axis", "about the second axis", "five half turns"}}};
  c.stays_green = {wrong_GJ(1.1), wrong_EA(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::natural_helix
