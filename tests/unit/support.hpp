// Shared by the tests: the published set typed once more (the shipped file is held to it by scene_test),
// random poses, and central differences of a pair energy.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "model/contact/line.hpp"
#include "model/contact/paper.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk::test {

inline PaperContact published_contact() {
  PaperContact k;
  k.radius = 0.678;
  k.epsilon = 0.03733;
  k.repulsion = 0.0223;
  k.attraction = 1.31;
  k.angular = {0.35819, 0.03263, -0.00138, -0.00017, 0.00024};
  k.crossing = 90;
  return k;
}

// The line law as calibrate fits it to two (10,10) tubes of graphite density, Lennard-Jones with a cutoff of 1.2
// nm; with other radii a law of the same form.
inline LineDensity line_density(double radius_i = 0.6785, double radius_j = 0.6785) {
  LineDensity d;
  d.contact = radius_i + radius_j;
  d.K = 2.771755179;
  d.s = 0.2727361991;
  d.c = -0.01802027729;
  d.p = 9.121708844;
  d.q = 4.246562049;
  d.core_gap = 0.2006;
  d.switch_gap = 0.5;
  d.cutoff_gap = 1.45;
  return d;
}

inline constexpr double element_length = 1.356;

inline LineContact line_contact(double radius_i, int nodes_i, double radius_j, int nodes_j) {
  return {line_density(radius_i, radius_j), element_length, element_length, nodes_i, nodes_j};
}

inline BondStiffness published_bond() {
  return {1470.0 * units::nN_nm, 358.4 * units::nN_nm, 319.5 * units::nN_nm};
}

// Every term is there, as for a chiral tube; the window is narrow enough to be left by single bonds.
inline BondStiffness anharmonic_bond() {
  BondStiffness k{9480, 2260, 2060, 1715};
  Anharmonic& h = k.anharmonic;
  h.used = true;
  h.radius = 0.69;
  h.coupling = 40;
  h.e3 = -7000, h.e2s = 500, h.es2 = 3000, h.s3 = 400;
  h.e4 = -6000, h.e3s = 900, h.e2s2 = -8000, h.es3 = 700, h.s4 = -4000, h.b4 = -80000;
  h.min_strain = -0.06, h.max_strain = 0.08, h.max_shear = 0.05, h.max_bend = 0.06;
  return k;
}

// The same with a law of stretch beyond the window, whose force rises by less and less to a strain of 0.2.
inline BondStiffness pulled_bond() {
  BondStiffness k = anharmonic_bond();
  set_pull(k.anharmonic, k.stretch, {0.2, {616, 694, 768, 832, 888, 936, 976, 1004, 1018}});
  return k;
}

// With a natural shape and two stiffnesses of bending.
inline BondStiffness shaped_bond() {
  BondStiffness k{1470.0 * units::nN_nm, 358.4 * units::nN_nm, 319.5 * units::nN_nm, 1715};
  k.bend_difference = 0.4 * k.bend;
  k.natural = {0.15, -0.1, 0.3};
  return k;
}

inline Topology published_topology() {
  Topology t;
  const double mass = 220 * units::carbon_mass, radius = 0.678;
  t.types = {{element_length, radius, mass, mass * radius * radius, published_bond()}};
  return t;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  Vector3 direction() {
    std::normal_distribution<double> g;
    return Vector3(g(engine_), g(engine_), g(engine_)).normalized();
  }
  Quaternion orientation() {
    std::normal_distribution<double> g;
    return Quaternion(g(engine_), g(engine_), g(engine_), g(engine_)).normalized();
  }

 private:
  std::mt19937 engine_;
};

inline Quaternion turn(const Vector3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

// Fourth-order central difference of f at 0.
inline double derivative(const std::function<double(double)>& f, double h) {
  return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
}

// A rope of parallel tubes for force tests: seven tubes, bent and turned at random by `disorder`.
inline State disordered_bundle(Topology& topology, int tubes, int elements, double spacing, double disorder,
                               unsigned seed) {
  Random random(seed);
  for (int t = 0; t < tubes; ++t) topology.add_tube(elements);
  State s(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < tubes; ++t) {
    const double angle = t * units::pi / 3;
    const Vector3 at = t == 0 ? Vector3::Zero() : Vector3(spacing * std::cos(angle), spacing * std::sin(angle), 0);
    for (int e = 0; e < elements; ++e) {
      const auto i = static_cast<std::size_t>(topology.tube_begin[t] + e);
      s.position.set(i, at + Vector3(0, 0, e * topology.types[0].element_length) + disorder * random.direction());
      s.orientation.set(i, turn(random.direction(), disorder * random.uniform(0, 2)));
      s.velocity.set(i, random.uniform(0, 0.3) * random.direction());
      s.angular_velocity.set(i, random.uniform(0, 0.3) * random.direction());
    }
  }
  return s;
}

// Maxwell velocities of a bundle of one tube type.
inline void set_velocities(const Topology& topology, double temperature, State& s) {
  std::mt19937 engine(4);
  std::normal_distribution<double> gauss;
  const double v = std::sqrt(units::boltzmann * temperature / topology.types[0].mass);
  const double w = std::sqrt(units::boltzmann * temperature / topology.types[0].inertia);
  for (std::size_t i = 0; i < s.size(); ++i) {
    s.velocity.set(i, v * Vector3(gauss(engine), gauss(engine), gauss(engine)));
    s.angular_velocity.set(i, w * Vector3(gauss(engine), gauss(engine), gauss(engine)));
  }
}

}  // namespace ropewalk::test
