#include "sim/statics/reduction.hpp"

#include <algorithm>
#include <cmath>

#include "model/counter_random.hpp"
#include "sim/statics/allowed_motions.hpp"

namespace ropewalk {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

VectorXd all_forces(const Simulation& s) {
  State at = s.state();
  at.velocity.set_to_zero();
  at.angular_velocity.set_to_zero();
  const Forces f = s.forces_at(at, Interaction::Precision::full);
  std::vector<PointLoad> loads;
  point_loads(s.loads(), at, at.time, loads);
  VectorXd out(6 * static_cast<Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) out.segment<6>(6 * static_cast<Index>(i)) << f.force[i], f.torque[i];
  for (const PointLoad& load : loads) {
    out.segment<3>(6 * static_cast<Index>(load.element)) += load.force;
    out.segment<3>(6 * static_cast<Index>(load.element) + 3) += load.torque;
  }
  return out;
}

// Motions of the tied unknowns that constraints allow, orthonormal by the masses; from random ones, until these
// bring nothing new. Empty where there are more than `most`.
std::vector<VectorXd> tied_motions(const AllowedMotions& allowed, std::size_t most) {
  constexpr double nothing = 1e-8;
  const VectorXd& mass = allowed.mass();
  std::vector<VectorXd> out;
  for (std::uint32_t k = 0; k <= most; ++k) {
    VectorXd u = VectorXd::Zero(mass.size());
    for (Index q = 0; q < u.size(); ++q)
      if (allowed.tied()[static_cast<std::size_t>(q)])
        u[q] = 2 * unit_interval(philox({static_cast<std::uint32_t>(q), k, 0, 0}, 6)[0]) - 1;
    allowed.constrain_motion(u);
    for (Index q = 0; q < u.size(); ++q)
      if (!allowed.tied()[static_cast<std::size_t>(q)]) u[q] = 0;
    const double before = std::sqrt(u.dot(mass.cwiseProduct(u)));
    for (int pass = 0; pass < 2; ++pass)
      for (const VectorXd& other : out) u -= other.dot(mass.cwiseProduct(u)) * other;
    const double left = std::sqrt(u.dot(mass.cwiseProduct(u)));
    if (!(left > nothing * before)) return out;
    out.push_back(u / left);
  }
  return {};
}

class Making {
 public:
  Making(const Simulation& s, const AllowedMotions& allowed) : s_(s), allowed_(allowed) {}

  Reduction make(const std::vector<VectorXd>& tied) {
    const std::vector<int> order = elimination_order(s_.topology(), s_.state());
    std::vector<Index> tied_at;
    for (std::size_t k = 0; k < order.size(); ++k)
      for (Index row = 6 * static_cast<Index>(order[k]), c = 0; c < 6; ++c, ++row) {
        if (allowed_.held()[static_cast<std::size_t>(row)]) continue;
        // What is tied stands where its first unknown does.
        if (allowed_.tied()[static_cast<std::size_t>(row)]) {
          for (std::size_t t = 0; t < tied.size(); ++t)
            if (std::find(tied_at.begin(), tied_at.end(), static_cast<Index>(t)) == tied_at.end() &&
                tied[t][row] != 0) {
              tied_at.push_back(static_cast<Index>(t));
              add_tied(tied[t]);
            }
          continue;
        }
        add_own(row);
      }
    const VectorXd stretch = allowed_.stretch();
    if (stretch.size() > 0) add_period();
    return finish(tied);
  }

 private:
  void add_own(Index row) {
    motions_.emplace_back(static_cast<int>(row), static_cast<int>(count()), 1.0);
    forces_.emplace_back(static_cast<int>(count()), static_cast<int>(row), 1.0);
    own_.push_back(row);
    mass_.push_back(allowed_.mass()[row]);
  }
  void add_tied(const VectorXd& u) {
    for (Index row = 0; row < u.size(); ++row)
      if (u[row] != 0) {
        motions_.emplace_back(static_cast<int>(row), static_cast<int>(count()), u[row]);
        forces_.emplace_back(static_cast<int>(count()), static_cast<int>(row), u[row]);
      }
    tied_columns_.push_back({count(), u});
    own_.push_back(-1);
    mass_.push_back(1);
  }
  // Alone it moves the images.
  void add_period() {
    const Topology& topology = s_.topology();
    for (int e = 0; e < topology.elements(); ++e) {
      const int o = topology.original_of(e);
      if (o == e) continue;
      const double sign = e > o ? 1 : -1;
      motions_.emplace_back(6 * e + 2, static_cast<int>(count()), sign);
      forces_.emplace_back(static_cast<int>(count()), 6 * e + 2, 0.5 * sign);
    }
    own_.push_back(-1);
    mass_.push_back(topology.groups.period_inertia);
  }
  Index count() const { return static_cast<Index>(mass_.size()); }

  // An image moves as its original, turned.
  void add_images() {
    const Topology& topology = s_.topology();
    if (topology.groups.images == 0) return;
    std::vector<Index> column(static_cast<std::size_t>(allowed_.mass().size()), -1);
    for (std::size_t k = 0; k < own_.size(); ++k)
      if (own_[k] >= 0) column[static_cast<std::size_t>(own_[k])] = static_cast<Index>(k);
    for (int e = 0; e < topology.elements(); ++e) {
      const int o = topology.original_of(e);
      if (o == e) continue;
      const auto i = static_cast<std::size_t>(e), from = static_cast<std::size_t>(o);
      const Eigen::Matrix3d turn =
          Quaternion(s_.state().orientation[i] * s_.state().orientation[from].conjugate()).toRotationMatrix();
      for (int part = 0; part < 6; part += 3)
        for (int c = 0; c < 3; ++c) {
          const Index at = column[static_cast<std::size_t>(6 * o + part + c)];
          if (at < 0) continue;
          for (int r = 0; r < 3; ++r)
            if (turn(r, c) != 0) motions_.emplace_back(6 * e + part + r, static_cast<int>(at), turn(r, c));
        }
    }
  }

  Reduction finish(const std::vector<VectorXd>& tied) {
    add_images();
    const Index n = allowed_.mass().size();
    Reduction out;
    out.mass = Eigen::Map<const VectorXd>(mass_.data(), count());
    out.motions.resize(n, count());
    out.motions.setFromTriplets(motions_.begin(), motions_.end());
    out.forces.resize(count(), n);
    out.forces.setFromTriplets(forces_.begin(), forces_.end());
    if (!tied.empty()) {
      VectorXd borne = all_forces(s_), free = borne;
      allowed_.constrain_force(free);
      borne -= free;
      Triplets entries;
      for (const auto& [column, u] : tied_columns_) {
        VectorXd resistance = VectorXd::Zero(n);
        allowed_.add_constraint_stiffness(borne, u, resistance);
        const VectorXd on = out.forces * resistance;
        for (Index row = 0; row < on.size(); ++row)
          if (on[row] != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), on[row]);
      }
      out.stiffness.resize(count(), count());
      out.stiffness.setFromTriplets(entries.begin(), entries.end());
    }
    const auto coordinates = [&](const VectorXd& u) {
      const VectorXd momentum = out.forces * VectorXd(allowed_.mass().cwiseProduct(u));
      VectorXd q = momentum.cwiseQuotient(out.mass);
      return VectorXd(q / std::sqrt(q.dot(out.mass.cwiseProduct(q))));
    };
    for (const auto& all : {allowed_.spins(), allowed_.wholes()})
      for (const VectorXd& u : all) out.neutral.push_back(coordinates(u));
    return out;
  }

  const Simulation& s_;
  const AllowedMotions& allowed_;
  Triplets motions_, forces_;
  std::vector<double> mass_;
  std::vector<Index> own_;  // the unknown that each coordinate is, or -1
  std::vector<std::pair<Index, VectorXd>> tied_columns_;
};

}  // namespace

std::optional<Reduction> reduction_of(const Simulation& s, std::string& why) {
  constexpr std::size_t most = 60;  // motions of clamps
  const AllowedMotions allowed(s);
  if (!allowed.keeps_momentum()) return why = "constraints act on the same elements", std::nullopt;
  std::vector<VectorXd> tied;
  if (allowed.turns()) {
    tied = tied_motions(allowed, most);
    if (tied.empty()) return why = "clamps leave their elements more than 60 motions", std::nullopt;
  }
  return Making(s, allowed).make(tied);
}

double largest_free_force(const Simulation& s, const VectorXd& force) {
  VectorXd left = force;
  AllowedMotions(s).constrain_force(left);
  double largest = 0;
  for (int e = 0; e < s.topology().elements(); ++e) {
    const auto row = 6 * static_cast<Index>(e);
    largest = std::max({largest, left.segment<3>(row).norm(),
                        left.segment<3>(row + 3).norm() / s.topology().type_of_element(e).radius});
  }
  return largest;
}

}  // namespace ropewalk
