// Tubes as elements in a shape of our choice, and heaps of atoms.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "atoms/elements_to_atoms.hpp"
#include "atoms/find_tubes.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk::test {

inline ParameterSet shipped(const std::string& name) { return read_parameters(find_parameters(name, "")); }

// A uniform state of a rod: chords strained, axes and section wound by `twist` (rad/nm), bent to `curvature`
// (1/nm).
struct RodShape {
  double strain = 0, twist = 0, curvature = 0;
};

struct Elements {
  Topology topology;
  State state;
};

inline Elements rod(int elements, double a, const RodShape& shape) {
  Elements out;
  out.topology.types[0].element_length = a;
  out.topology.add_tube(elements);
  out.state = State(static_cast<std::size_t>(elements));
  for (int e = 0; e < elements; ++e) {
    const double s = (e + 0.5) * a * (1 + shape.strain), k = shape.curvature;
    const Vector3 x = k == 0 ? Vector3(0, 0, s) : Vector3((1 - std::cos(k * s)) / k, 0, std::sin(k * s) / k);
    out.state.position.set(static_cast<std::size_t>(e), x);
    out.state.orientation.set(static_cast<std::size_t>(e),
                              Quaternion(Eigen::AngleAxisd(k * s, Vector3::UnitY()) *
                                         Eigen::AngleAxisd(shape.twist * (e + 0.5) * a, Vector3::UnitZ())));
  }
  return out;
}

inline std::vector<Vector3> atoms_of(const Elements& rod, const TubeReference& reference) {
  std::vector<Vector3> out;
  AtomsOfElements(rod.topology, rod.state, {reference}, {{0, 0, rod.topology.length_of(0)}})
      .for_each([&](const PlacedAtom& atom) { out.push_back(atom.position); });
  return out;
}

// A piece of the ideal lattice, about so long (nm), along z.
inline std::vector<Vector3> lattice_atoms(Chirality c, double length) {
  const TubeShape shape = rolled_shape(c);
  const long g = std::gcd(c.n, c.m);
  const long hexagons = g * std::lround(length / (shape.length_per_hexagon * static_cast<double>(g)));
  std::vector<Vector3> out;
  for (const Site& site : strip_sites(c, hexagons)) out.push_back(place(c, site, shape));
  return out;
}

// The same atoms turned and moved as one body, each one displaced at random (nm, per component), in another order.
inline std::vector<Vector3> scrambled(std::vector<Vector3> atoms, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Quaternion turn(normal(random), normal(random), normal(random), normal(random));
  turn.normalize();
  const Vector3 shift(normal(random), normal(random), normal(random));
  for (Vector3& x : atoms) x = turn * x + shift + noise * Vector3(normal(random), normal(random), normal(random));
  std::shuffle(atoms.begin(), atoms.end(), random);
  return atoms;
}

inline FoundTubes found_in(const std::vector<Vector3>& atoms, const AtomBox& box = {}) {
  return find_tubes(atoms, std::vector<char>(atoms.size(), 1), box, "atoms");
}

}  // namespace ropewalk::test
