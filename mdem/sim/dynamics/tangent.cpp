#include "sim/dynamics/tangent.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/contract.hpp"
#include "model/counter_random.hpp"

namespace ropewalk {
namespace {

using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;
using Graph = std::vector<std::vector<int>>;  // what acts on each element, and itself; in rising order

constexpr double speed_step = 1e-3;  // nm/ps: forces of viscosities are straight in the velocities

Eigen::Index row_of(int element) { return 6 * static_cast<Eigen::Index>(element); }

VectorXd as_vector(const Forces& f) {
  VectorXd out(row_of(static_cast<int>(f.force.size())));
  for (std::size_t i = 0; i < f.force.size(); ++i)
    out.segment<6>(row_of(static_cast<int>(i))) << f.force[i], f.torque[i];
  return out;
}

// One element, by its unknown 0 to 5.
void move_one(State& s, int element, int unknown, double by) {
  const auto i = static_cast<std::size_t>(element);
  if (unknown < 3) {
    s.position.add(i, by * Vector3::Unit(unknown));
  } else {
    s.orientation.set(i, Quaternion(Eigen::AngleAxisd(by, Vector3::Unit(unknown - 3))) * s.orientation[i]);
  }
}
void speed_one(State& s, int element, int unknown, double by) {
  const auto i = static_cast<std::size_t>(element);
  (unknown < 3 ? s.velocity : s.angular_velocity).add(i, by * Vector3::Unit(unknown % 3));
}
void copy_one(const State& from, int element, State& to) {
  const auto i = static_cast<std::size_t>(element);
  to.position.set(i, from.position[i]);
  to.orientation.set(i, from.orientation[i]);
  to.velocity.set(i, from.velocity[i]);
  to.angular_velocity.set(i, from.angular_velocity[i]);
}

// The pairs of the list, the bonds, and the ends of tubes in line.
Graph who_acts_on_whom(const Topology& topology, const NeighbourList& list, bool pairs) {
  Graph graph(static_cast<std::size_t>(topology.elements()));
  const auto join = [&](int i, int j) {
    graph[static_cast<std::size_t>(i)].push_back(j);
    if (i != j) graph[static_cast<std::size_t>(j)].push_back(i);
  };
  for (int i = 0; i < topology.elements(); ++i) {
    join(i, i);
    if (i + 1 < topology.elements()) join(i, i + 1);  // of the next tube: it follows in line, or is not reached
    if (pairs) list.for_neighbours(i, [&](int j) { join(i, j); });
  }
  for (auto& of : graph) {
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
  }
  return graph;
}

// Groups of elements no two of which act on a common one.
std::vector<std::vector<int>> groups_of(const Graph& graph) {
  std::vector<std::vector<int>> groups;
  std::vector<int> colour(graph.size(), -1), used_by;  // last element that must not have each colour
  for (std::size_t i = 0; i < graph.size(); ++i) {
    for (const int j : graph[i])
      for (const int k : graph[static_cast<std::size_t>(j)])
        if (const int c = colour[static_cast<std::size_t>(k)]; c >= 0)
          used_by[static_cast<std::size_t>(c)] = static_cast<int>(i);
    std::size_t c = 0;
    while (c < groups.size() && used_by[c] == static_cast<int>(i)) ++c;
    if (c == groups.size()) groups.emplace_back(), used_by.push_back(-1);
    groups[c].push_back(static_cast<int>(i));
    colour[i] = static_cast<int>(c);
  }
  return groups;
}

class Differences {
 public:
  Differences(const Simulation& s, double step) : s_(s), in_(s.interaction()), rest_(s.state()), step_(step) {
    in_.precision = Interaction::Precision::full;
    engine_.take_terms_of(s.engine());
    rest_.velocity.set_to_zero();
    rest_.angular_velocity.set_to_zero();
  }

  // `known`: K, and `damped`: C, where they are known otherwise.
  Tangent tangent(const Tangent::Matrix* known = nullptr, const Tangent::Matrix* damped = nullptr) {
    const Topology& topology = s_.topology();
    const Eigen::Index n = row_of(topology.elements());
    Tangent out;
    out.mass.resize(n);
    for (int t = 0; t < topology.tubes(); ++t)
      for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
        const TubeType& type = topology.type_of(t);
        out.mass.segment<6>(row_of(e)) << Vector3::Constant(type.mass), Vector3::Constant(type.inertia);
      }
    out.force = model_forces(rest_) + load_forces(rest_);
    out.order = order_along(rest_);
    Graph graph;
    std::vector<std::vector<int>> groups;
    if (!known || !damped) {
      graph = who_acts_on_whom(topology, s_.list(), s_.list().cutoff > 0);
      groups = groups_of(graph);
    }
    Triplets stiffness, damping;
    for (const std::vector<int>& group : groups)
      for (int unknown = 0; unknown < 6; ++unknown) {
        const auto add = [&](const VectorXd& change, Triplets& to) {
          for (const int i : group)
            for (const int j : graph[static_cast<std::size_t>(i)])
              for (int k = 0; k < 6; ++k)
                if (const double value = change[row_of(j) + k]; value != 0)
                  to.emplace_back(static_cast<int>(row_of(j)) + k, static_cast<int>(row_of(i)) + unknown, -value);
        };
        const auto model = [this](const State& s) { return model_forces(s); };
        if (!known) add(difference(group, unknown, false, model), stiffness);
        if (!damped) add(difference(group, unknown, true, model), damping);
      }
    if (!known || !damped) add_loads(stiffness, damping);
    out.stiffness.resize(n, n);
    out.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
    if (known) out.stiffness = *known;
    out.damping.resize(n, n);
    out.damping.setFromTriplets(damping.begin(), damping.end());
    if (damped) out.damping = *damped;
    out.error = std::max(error_along(out.stiffness, false), error_along(out.damping, true));
    out.evaluations = evaluations_;
    return out;
  }

 private:
  VectorXd model_forces(const State& s) {
    ++evaluations_;
    Forces f(s.size());
    engine_.compute(s_.topology(), in_, s_.list(), s, f, {Parts::all, false});
    return as_vector(f);
  }
  VectorXd load_forces(const State& s) {
    point_loads(s_.loads(), s, s.time, loads_);
    VectorXd out = VectorXd::Zero(row_of(static_cast<int>(s.size())));
    for (const PointLoad& load : loads_) {
      out.segment<3>(row_of(load.element)) += load.force;
      out.segment<3>(row_of(load.element) + 3) += load.torque;
    }
    return out;
  }

  // The derivative of all forces by one unknown (or by its velocity), which changes in all elements of the group at
  // once.
  template <class ForcesOf>
  VectorXd difference(const std::vector<int>& group, int unknown, bool speeds, const ForcesOf& forces) {
    const double by = (speeds ? speed_step : step_) / (unknown < 3 ? 1 : s_.topology().largest_radius());
    State s = rest_;
    const auto at = [&](double change) {
      for (const int i : group) {
        copy_one(rest_, i, s);
        speeds ? speed_one(s, i, unknown, change) : move_one(s, i, unknown, change);
      }
      return forces(s);
    };
    const VectorXd ahead = at(by);
    return (ahead - at(-by)) / (2 * by);
  }

  // A load may tie all of its elements together; there are few of them.
  void add_loads(Triplets& stiffness, Triplets& damping) {
    for (const int i : loaded_elements(s_.loads()))
      for (int unknown = 0; unknown < 6; ++unknown)
        for (const bool speeds : {false, true}) {
          const VectorXd change =
              difference({i}, unknown, speeds, [this](const State& s) { return load_forces(s); });
          for (Eigen::Index row = 0; row < change.size(); ++row)
            if (change[row] != 0)
              (speeds ? damping : stiffness)
                  .emplace_back(static_cast<int>(row), static_cast<int>(row_of(i)) + unknown, -change[row]);
        }
  }

  double error_along(const Tangent::Matrix& matrix, bool speeds) {
    VectorXd motion(matrix.cols());
    for (Eigen::Index k = 0; k < motion.size(); ++k)
      motion[k] = 2 * unit_interval(philox({static_cast<std::uint32_t>(k), speeds ? 1u : 0u, 0, 0}, 1)[0]) - 1;
    const double by = speeds ? speed_step : step_;
    const auto at = [&](double sign) {
      const VectorXd whole = sign * by * motion, none = VectorXd::Zero(motion.size());
      const State s = speeds ? moved(rest_, none, &whole) : moved(rest_, whole);
      return VectorXd(model_forces(s) + load_forces(s));
    };
    const VectorXd change = -(at(1) - at(-1)) / (2 * by), product = matrix * motion;
    const double size = std::max(change.norm(), product.norm());
    return size > 0 ? (change - product).norm() / size : 0;
  }

  const Simulation& s_;
  Interaction in_;
  State rest_;
  double step_;
  ForceEngine engine_;
  std::vector<PointLoad> loads_;
  long evaluations_ = 0;
};

}  // namespace

std::vector<int> order_along(const State& s) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t i = 0; i < s.size(); ++i) mean += s.position[i] / static_cast<double>(s.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < s.size(); ++i) spread += (s.position[i] - mean) * (s.position[i] - mean).transpose();
  const Vector3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  std::vector<int> order(s.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return s.position[static_cast<std::size_t>(a)].dot(axis) < s.position[static_cast<std::size_t>(b)].dot(axis);
  });
  return order;
}

State moved(const State& state, const VectorXd& u, const VectorXd* velocity) {
  ROPEWALK_EXPECTS(u.size() == row_of(static_cast<int>(state.size())));
  State s = state;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Eigen::Index row = row_of(static_cast<int>(i));
    s.position.add(i, u.segment<3>(row));
    const Vector3 turn = u.segment<3>(row + 3);
    if (const double angle = turn.norm(); angle > 0)
      s.orientation.set(i, (Quaternion(Eigen::AngleAxisd(angle, turn / angle)) * s.orientation[i]).normalized());
    s.velocity.set(i, velocity ? Vector3(velocity->segment<3>(row)) : Vector3::Zero());
    s.angular_velocity.set(i, velocity ? Vector3(velocity->segment<3>(row + 3)) : Vector3::Zero());
  }
  return s;
}

Tangent tangent_of(const Simulation& simulation, double step) {
  ROPEWALK_EXPECTS(step > 0);
  return Differences(simulation, step).tangent();
}

Tangent tangent_with(const Simulation& simulation, const Tangent::Matrix& stiffness,
                     const Tangent::Matrix* damping) {
  constexpr double step = 1e-5;  // length of the motion along which the error is found, nm
  return Differences(simulation, step).tangent(&stiffness, damping);
}

}  // namespace ropewalk
