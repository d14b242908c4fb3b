// What the force terms of a scene add to its forces, and whether that is the gradient of their energy.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "scene/prepare.hpp"

namespace ropewalk {

class TermsAlone {
 public:
  explicit TermsAlone(Scene scene) : p(prepare(scene)) {
    in_ = p.interaction;
    in_.damping = {};
    in_.precision = Interaction::Precision::full;
    without_ = in_;
    without_.terms.clear();
    list_ = NeighbourList(in_, 2);
    list_.build(p.topology, p.state);
    at(p.state);
  }
  // As in a step when `passed`: the memory of the terms moves on.
  Forces at(const State& state, bool passed = false) {
    Forces with(state.size()), without(state.size());
    engine_.compute(p.topology, in_, list_, state, with,
                    {Parts::all, true, passed ? std::optional(0.01) : std::nullopt});
    plain_.compute(p.topology, without_, list_, state, without);
    for (std::size_t i = 0; i < state.size(); ++i) {
      with.force.add(i, -without.force[i]);
      with.torque.add(i, -without.torque[i]);
    }
    return with;
  }
  double energy(const State& state) { return at(state).energy.terms; }
  State shaken(double by, unsigned seed) const {
    State s = p.state;
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, by);
    for (std::size_t i = 0; i < s.size(); ++i) {
      s.position.add(i, Vector3(normal(engine), normal(engine), normal(engine)));
      const Vector3 turn(normal(engine), normal(engine), normal(engine));
      s.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * s.orientation[i]);
    }
    return s;
  }

  Prepared p;

 private:
  Interaction in_, without_;
  NeighbourList list_;
  ForceEngine engine_, plain_;
};

inline std::vector<std::size_t> every_third(const State& s) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < s.size(); i += 3) out.push_back(i);
  return out;
}

// Forces and torques on these elements against differences of the energy.
inline void expect_gradient(TermsAlone& terms, const State& s, const std::vector<std::size_t>& elements) {
  const Forces at = terms.at(s);
  constexpr double h = 1e-5;
  double largest = 0;
  for (const std::size_t i : elements)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy = [&](double move, double turn) {
        State moved = s;
        moved.position.add(i, move * Vector3::Unit(axis));
        moved.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn, Vector3::Unit(axis))) * moved.orientation[i]);
        return terms.energy(moved);
      };
      EXPECT_NEAR(at.force[i][axis], -(energy(h, 0) - energy(-h, 0)) / (2 * h), 1e-5) << i;
      EXPECT_NEAR(at.torque[i][axis], -(energy(0, h) - energy(0, -h)) / (2 * h), 1e-5) << i;
      largest = std::max({largest, std::fabs(at.force[i][axis]), std::fabs(at.torque[i][axis])});
    }
  EXPECT_GT(largest, 1);
}

}  // namespace ropewalk
