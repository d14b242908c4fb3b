#include "sim/statics/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "model/contract.hpp"
#include "model/counter_random.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/forces/pair_stiffness.hpp"

namespace ropewalk {
namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;

Matrix3d cross(const Vector3& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

StiffnessMaker::StiffnessMaker(const Simulation& s) {
  const Topology& topology = s.topology();
  type_.resize(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e)
      type_[static_cast<std::size_t>(e)] = topology.tube_type[static_cast<std::size_t>(t)];
  if (const auto* line = dynamic_cast<const LineLaw*>(s.interaction().law.get()))
    for (const LineContact& pair : line->pairs) nodes_.emplace_back(pair);
}

const BlockMatrix& StiffnessMaker::make(const Simulation& s) {
  find_pattern(s);
  if (s.interaction().law) {
    if (const auto* line = dynamic_cast<const LineLaw*>(s.interaction().law.get()))
      add_line_contact(s, *line);
    else
      add_contact(s);
    drop_what_is_not_reached();
  }
  add_bonds(s);
  add_terms(s);
  add_load_stiffness(s.loads(), s.topology(), s.state(), k_);
  return k_;
}

// Bonds, and pairs within the cutoff.
void StiffnessMaker::find_pattern(const Simulation& s) {
  const Topology& topology = s.topology();
  const State& state = s.state();
  const auto n = static_cast<std::size_t>(topology.elements());
  const double reach = s.interaction().law ? s.interaction().law->cutoff() : 0;
  axis_.resize(n);
  for (std::size_t i = 0; i < n; ++i) axis_[i] = axis_of(state.orientation[i]);
  k_.begin.assign(1, 0);
  k_.column.clear();
  touches_.clear();
  bonded_.clear();
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) {
      const bool bonded = i + 1 < topology.tube_begin[t + 1];
      const Vector3 x = state.position[static_cast<std::size_t>(i)];
      if (bonded) {
        k_.column.push_back(i + 1);
        touches_.push_back(false);
        bonded_.push_back(true);
      }
      if (reach > 0)
        s.list().for_neighbours(i, [&](int j) {
          if ((state.position[static_cast<std::size_t>(j)] - x).squaredNorm() >= reach * reach) return;
          if (bonded && j == i + 1) {
            touches_[static_cast<std::size_t>(k_.begin.back())] = true;
          } else {
            k_.column.push_back(j);
            touches_.push_back(true);
            bonded_.push_back(false);
          }
        });
      k_.begin.push_back(static_cast<int>(k_.column.size()));
    }
  k_.block.assign(k_.column.size(), Block::Zero());
  k_.diagonal.assign(n, Block::Zero());
  k_.single.clear();
}

void StiffnessMaker::add_bonds(const Simulation& s) {
  const Topology& topology = s.topology();
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    const auto forces = [&type](const Pose& i, const Pose& j) {
      const BondForce f = bond_energy_and_gradient(type.bond, type.element_length, j.position - i.position,
                                                   frame_of(i.orientation), frame_of(j.orientation));
      return PairVector((PairVector() << -f.force_j, f.torque_i, f.force_j, f.torque_j).finished());
    };
    for (int i = topology.tube_begin[t]; i + 1 < topology.tube_begin[t + 1]; ++i) {
      const PairMatrix k = pair_stiffness(forces, pose_of(s.state(), i), pose_of(s.state(), i + 1));
      const auto at = static_cast<std::size_t>(i);
      k_.diagonal[at] += k.topLeftCorner<6, 6>();
      k_.diagonal[at + 1] += k.bottomRightCorner<6, 6>();
      k_.at(i, i + 1) += k.topRightCorner<6, 6>();
    }
  }
}

void StiffnessMaker::add_line_contact(const Simulation& s, const LineLaw& law) {
  const Vec3Array& position = s.state().position;
  std::vector<LineScratch> scratch;
  for (const LineNodePairs& pair : nodes_) scratch.emplace_back(pair.lanes);
  for (int i = 0; i < k_.rows(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (int at = k_.begin[a]; at < k_.begin[a + 1]; ++at) {
      if (!touches_[static_cast<std::size_t>(at)]) continue;
      const int j = k_.column[static_cast<std::size_t>(at)];
      const auto b = static_cast<std::size_t>(j);
      const auto types = static_cast<std::size_t>(type_[a] * law.types() + type_[b]);
      const Vector3 separation = position[b] - position[a];
      touches_[static_cast<std::size_t>(at)] = add_line_stiffness(
          nodes_[types], separation.data(), axis_[a].data(), axis_[b].data(), scratch[types], k_.diagonal[a].data(),
          k_.diagonal[b].data(), k_.block[static_cast<std::size_t>(at)].data());
    }
  }
}

void StiffnessMaker::add_contact(const Simulation& s) {
  const ContactLaw& law = *s.interaction().law;
  for (int i = 0; i < k_.rows(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (int at = k_.begin[a]; at < k_.begin[a + 1]; ++at) {
      if (!touches_[static_cast<std::size_t>(at)]) continue;
      const int j = k_.column[static_cast<std::size_t>(at)];
      const auto b = static_cast<std::size_t>(j);
      const TypePair types{type_[a], type_[b]};
      const Pose pose_i = pose_of(s.state(), i), pose_j = pose_of(s.state(), j);
      touches_[static_cast<std::size_t>(at)] =
          law.reaches(types, pose_j.position - pose_i.position, axis_[a], axis_[b]);
      if (!touches_[static_cast<std::size_t>(at)]) continue;
      const auto forces = [&](const Pose& p, const Pose& q) {
        const PairForce f =
            law.force(types, q.position - p.position, axis_of(p.orientation), axis_of(q.orientation));
        return PairVector((PairVector() << -f.force_j, f.torque_i, f.force_j, f.torque_j).finished());
      };
      const PairMatrix k = pair_stiffness(forces, pose_i, pose_j);
      k_.diagonal[a] += k.topLeftCorner<6, 6>();
      k_.diagonal[b] += k.bottomRightCorner<6, 6>();
      k_.block[static_cast<std::size_t>(at)] += k.topRightCorner<6, 6>();
    }
  }
}

// Pairs whose points are too far apart cost as much in a product as others.
void StiffnessMaker::drop_what_is_not_reached() {
  std::size_t kept = 0, from = 0;
  for (std::size_t row = 1; row < k_.begin.size(); ++row) {
    for (const auto to = static_cast<std::size_t>(k_.begin[row]); from < to; ++from) {
      if (!touches_[from] && !bonded_[from]) continue;
      k_.column[kept] = k_.column[from];
      k_.block[kept] = k_.block[from];
      ++kept;
    }
    k_.begin[row] = static_cast<int>(kept);
  }
  k_.column.resize(kept);
  k_.block.resize(kept);
}

void StiffnessMaker::add_terms(const Simulation& s) {
  const std::string without = s.engine().terms().add_tangent(s.state(), [&](int i, int j, const Block& block) {
    if (i == j)
      k_.diagonal[static_cast<std::size_t>(i)] += block;
    else
      k_.single.push_back({i, j, block});
  });
  if (!without.empty()) throw std::runtime_error("the force term \"" + without + "\" has no tangent");
}

std::string term_without_tangent(const Simulation& s) {
  return s.engine().terms().add_tangent(s.state(), [](int, int, const Block&) {});
}

Tangent tangent_by_blocks(const Simulation& s) {
  StiffnessMaker maker(s);
  BlockMatrix k = maker.make(s);
  State at_rest = s.state();
  at_rest.velocity.set_to_zero();
  at_rest.angular_velocity.set_to_zero();
  const Forces forces = s.forces_at(at_rest, Interaction::Precision::full);
  VectorXd all = load_forces(s.loads(), at_rest);
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    all.segment<3>(row) += forces.force[i];
    all.segment<3>(row + 3) += forces.torque[i];
  }
  add_left_torque(all, k);
  const Tangent::Matrix stiffness = k.sparse();
  const std::optional<BlockMatrix> c = damping_blocks(s);
  if (!c) return tangent_with(s, stiffness);
  const Tangent::Matrix damping = c->sparse();
  return tangent_with(s, stiffness, &damping);
}

namespace {

// With what the motions (v_i, w_i, v_j, w_j) make of the velocities at their common point, and of the spins.
using PairRows = Eigen::Matrix<double, 3, 12>;
PairRows sliding(const Vector3& separation) {
  const Matrix3d arm = 0.5 * cross(separation);
  PairRows b;
  b << -Matrix3d::Identity(), arm, Matrix3d::Identity(), arm;
  return b;
}
PairRows spinning() {
  PairRows b = PairRows::Zero();
  b.middleCols<3>(3) = -Matrix3d::Identity();
  b.rightCols<3>() = Matrix3d::Identity();
  return b;
}

void add_pair_block(const PairMatrix& c, int i, int j, BlockMatrix& to) {
  to.diagonal[static_cast<std::size_t>(i)] += c.topLeftCorner<6, 6>();
  to.diagonal[static_cast<std::size_t>(j)] += c.bottomRightCorner<6, 6>();
  to.column.push_back(j);
  to.block.push_back(c.topRightCorner<6, 6>());
}

bool loads_feel_speeds(const Simulation& s) {
  State still = s.state(), fast = still;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const auto number = [&](std::uint32_t k) {
      return unit_interval(philox({static_cast<std::uint32_t>(i), k, 0, 0}, 5)[0]);
    };
    fast.velocity.set(i, {number(0), number(1), number(2)});
    fast.angular_velocity.set(i, {number(3), number(4), number(5)});
  }
  still.velocity.set_to_zero();
  still.angular_velocity.set_to_zero();
  return load_forces(s.loads(), fast) != load_forces(s.loads(), still);
}

}  // namespace

std::optional<BlockMatrix> damping_blocks(const Simulation& s) {
  for (const auto& term : s.interaction().terms)
    if (term->damping() > 0) return std::nullopt;
  if (loads_feel_speeds(s)) return std::nullopt;
  const Topology& topology = s.topology();
  const Interaction& in = s.interaction();
  BlockMatrix c;
  c.diagonal.assign(s.state().size(), Block::Zero());
  const double reach =
      in.has_contact() && in.damped_contact() ? std::min(in.damping.contact.outer, in.cutoff()) : 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) {
      const Vector3 x = s.state().position[static_cast<std::size_t>(i)];
      const auto to = [&](int j) -> Vector3 { return s.state().position[static_cast<std::size_t>(j)] - x; };
      if (in.damping.bond.rate > 0 && i + 1 < topology.tube_begin[t + 1]) {
        const PairRows slip = sliding(to(i + 1)), spin = spinning();
        const double half = 0.5 * in.damping.bond.rate;
        add_pair_block(half * type.mass * slip.transpose() * slip + half * type.inertia * spin.transpose() * spin,
                       i, i + 1, c);
      }
      if (reach > 0)
        s.list().for_neighbours(i, [&](int j) {
          const Vector3 separation = to(j);
          const double distance = separation.norm();
          if (!(distance < reach)) return;
          const PairRows slip = sliding(separation);
          add_pair_block(in.damping.contact.eta * in.damping.contact.weight(distance) * slip.transpose() * slip, i,
                         j, c);
        });
      c.begin.push_back(static_cast<int>(c.column.size()));
    }
  }
  return c;
}

VectorXd load_forces(const LoadsAndConstraints& loads, const State& state) {
  std::vector<PointLoad> point;
  point_loads(loads, state, state.time, point);
  VectorXd out = VectorXd::Zero(6 * static_cast<Eigen::Index>(state.size()));
  for (const PointLoad& load : point) {
    out.segment<3>(6 * load.element) += load.force;
    out.segment<3>(6 * load.element + 3) += load.torque;
  }
  return out;
}

namespace {

// What one load does to the elements that it knows of, as they are in the state.
class OneLoad {
 public:
  OneLoad(const Load& load, const Topology& topology, const State& state) : load_(load), state_(state) {
    elements = load.elements;
    for (const int e : load.reads(topology)) elements.push_back(e);
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    for (std::size_t k = 0; k < elements.size(); ++k) place_[elements[k]] = static_cast<Eigen::Index>(k);
  }
  // With elements[k] moved by `by` along its unknown, or all of them at random (k < 0).
  VectorXd forces(int k, int unknown, double by) {
    const auto move = [&](int element, int c, double distance) {
      const auto i = static_cast<std::size_t>(element);
      if (c < 3)
        state_.position.add(i, distance * Vector3::Unit(c));
      else
        state_.orientation.set(
            i, Quaternion(Eigen::AngleAxisd(distance, Vector3::Unit(c - 3))) * state_.orientation[i]);
    };
    const std::size_t from = k < 0 ? 0 : static_cast<std::size_t>(k), to = k < 0 ? elements.size() : from + 1;
    std::vector<Pose> before;
    for (std::size_t m = from; m < to; ++m) {
      before.push_back(pose_of(state_, elements[m]));
      for (int c = k < 0 ? 0 : unknown; c < (k < 0 ? 6 : unknown + 1); ++c)
        move(elements[m], c,
             k < 0 ? by * (unit_interval(
                               philox({static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(c), 0, 0}, 3)[0]) -
                           0.5)
                   : by);
    }
    point_.clear();
    load_.add_forces(state_, state_.time, point_);
    VectorXd out = VectorXd::Zero(6 * static_cast<Eigen::Index>(elements.size()));
    for (const PointLoad& p : point_) {
      const Eigen::Index at = 6 * place_.at(p.element);
      out.segment<3>(at) += p.force;
      out.segment<3>(at + 3) += p.torque;
    }
    for (std::size_t m = from; m < to; ++m) {
      state_.position.set(static_cast<std::size_t>(elements[m]), before[m - from].position);
      state_.orientation.set(static_cast<std::size_t>(elements[m]), before[m - from].orientation);
    }
    return out;
  }
  std::vector<int> elements;

 private:
  const Load& load_;
  State state_;
  std::vector<PointLoad> point_;
  std::map<int, Eigen::Index> place_;
};

}  // namespace

void add_load_stiffness(const LoadsAndConstraints& loads, const Topology& topology, const State& state,
                        BlockMatrix& k) {
  constexpr double step = 1e-3, rounding = 1e-11;
  std::map<std::pair<int, int>, Block> found;
  for (const auto& load : loads) {
    OneLoad one(*load, topology, state);
    if (one.elements.empty()) continue;
    const VectorXd at_rest = one.forces(0, 0, 0);
    const double size = at_rest.cwiseAbs().maxCoeff();
    if (!(size > 0)) continue;
    for (std::size_t m = 0; m < one.elements.size(); ++m) {
      const int e = one.elements[m];
      k.diagonal[static_cast<std::size_t>(e)].bottomRightCorner<3, 3>() -=
          0.5 * cross(at_rest.segment<3>(6 * static_cast<Eigen::Index>(m) + 3));
    }
    if ((one.forces(-1, 0, 0.1) - at_rest).cwiseAbs().maxCoeff() <= rounding * size) continue;  // it is constant
    for (std::size_t m = 0; m < one.elements.size(); ++m)
      for (int c = 0; c < 6; ++c) {
        const VectorXd change = derivative([&](double by) { return one.forces(static_cast<int>(m), c, by); }, step);
        for (std::size_t row = 0; row < one.elements.size(); ++row) {
          const auto part = change.segment<6>(6 * static_cast<Eigen::Index>(row));
          if (part.cwiseAbs().maxCoeff() <= rounding * size) continue;
          auto [at, is_new] = found.try_emplace({one.elements[row], one.elements[m]}, Block::Zero());
          at->second.col(c) -= part;
        }
      }
  }
  for (const auto& [at, block] : found) {
    if (at.first == at.second)
      k.diagonal[static_cast<std::size_t>(at.first)] += block;
    else
      k.single.push_back({at.first, at.second, block});
  }
}

void add_left_torque(const VectorXd& force, BlockMatrix& k) {
  for (int i = 0; i < k.rows(); ++i)
    k.diagonal[static_cast<std::size_t>(i)].bottomRightCorner<3, 3>() += 0.5 * cross(force.segment<3>(6 * i + 3));
}

}  // namespace ropewalk
