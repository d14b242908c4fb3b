#include "sim/dynamics/step_limit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "model/contract.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/forces/pair_stiffness.hpp"

namespace ropewalk {
namespace {

constexpr double pressed = 0.985;  // relative to the spacing

// Second derivative in the spacing of the energy of one element against a parallel row of elements, maximal
// over their offsets; taken where a rope under load may be.
double row_stiffness(const ContactLaw& law, TypePair types, double element_length, double spacing) {
  const Vector3 axis = Vector3::UnitZ();
  double largest = 0;
  for (double shift : {0.0, 0.25, 0.5}) {
    const auto row = [&](double gap) {
      double sum = 0;
      const int reach = static_cast<int>(law.cutoff() / element_length) + 1;
      for (int k = -reach; k <= reach; ++k) {
        const Vector3 separation(gap, 0, (k + shift) * element_length);
        if (separation.norm() < law.cutoff()) sum += law.energy(types, separation, axis, axis);
      }
      return sum;
    };
    const double at = pressed * spacing, h = 1e-3 * spacing;
    largest = std::max(largest, (row(at + h) - 2 * row(at) + row(at - h)) / (h * h));
  }
  return largest;
}

// The stiffest contact of an element of this type: between tubes of one kind at the spacing of the rope; of
// mixed kinds, each pair at its own well.
double contact_stiffness(const Topology& topology, const Interaction& in, const TubeType& type, double spacing) {
  const auto types = static_cast<int>(topology.types.size()), i = static_cast<int>(&type - topology.types.data());
  double largest = 0;
  for (int j = 0; j < types; ++j) {
    const double length = topology.types[static_cast<std::size_t>(j)].element_length;
    const double at = types == 1 ? spacing : in.law->parallel_distance({i, j}, length);
    largest = std::max(largest, row_stiffness(*in.law, {i, j}, length, at));
  }
  return largest;
}

using Matrix6 = Eigen::Matrix<std::complex<double>, 6, 6>;

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 eigenvalues(const Matrix6& m) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(m, Eigen::EigenvaluesOnly).eigenvalues();
}
double largest_eigenvalue(const Matrix6& m) { return eigenvalues(m)[5]; }

// K and C of one wave over the masses; deflections x, y, z, then rotations.
struct Wave {
  Matrix6 stiffness = Matrix6::Zero(), bond_damping = Matrix6::Zero(), contact_damping = Matrix6::Zero();
  double term_damping = 0;  // damping of all deflections and rotations alike, 1/ps

  double largest(double step) const {
    return largest_eigenvalue(step * step * stiffness + 2 * step * (bond_damping + contact_damping)) +
           2 * step * term_damping;
  }
};

// The lattice of one tube type in a rope of its own kind.
struct Lattice {
  const TubeType& type;
  BondDamping bond;
  double spacing = 0;    // nm
  double stiffness = 0;  // stiffness of a neighbouring row, eV/nm^2
  double held = 0;       // stiffness by force terms, eV/nm^2
  double dragged = 0;    // 1/ps, likewise
  ContactViscosity viscosity;

  // A chain's matrix: `along` of deflections and of rotations about the axis, `sideways` of the rest.
  template <class Mode>
  static void add_chain(double deflection, double rotation, const Mode& sideways, Matrix6& to) {
    const std::complex<double> up(0, sideways.up);
    to(2, 2) += deflection;
    to(5, 5) += rotation;
    for (int a = 0; a < 2; ++a) {
      const int turn = 4 - a;  // a deflection in x goes with a rotation about y, one in y with one about -x
      to(a, a) += sideways.uu;
      to(turn, turn) += sideways.pp;
      to(a, turn) += a == 0 ? up : -up;
      to(turn, a) += a == 0 ? -up : up;
    }
  }
  void add_bonds(double q, Wave& wave) const {
    const double a = type.element_length, m = type.mass, inertia = type.inertia, c = 1 - std::cos(q);
    add_chain(2 * type.bond.stretch / (a * m) * c, 2 * type.bond.twist / (a * inertia) * c,
              chain_mode(type.bond, q, a, m, inertia), wave.stiffness);
    add_chain(bond.rate * c, bond.rate * c, bond.mode(q, a, m, inertia), wave.bond_damping);
  }
  // The neighbours in three of the six directions; the others are their mirror images. An element is pressed along
  // its whole length: where neighbours are tilted against one another, their contact opens at one end and closes at
  // the other, which takes the stiffness times a^2/12.
  void add_contact(const Vector3& k, double q, Wave& wave) const {
    using Row = Eigen::Matrix<std::complex<double>, 1, 6>;
    const double a = type.element_length;
    for (int direction = 0; direction < 3; ++direction) {
      const double angle = direction * units::pi / 3;
      const Vector3 to(std::cos(angle), std::sin(angle), 0);
      const std::complex<double> phase = std::exp(std::complex<double>(0, spacing * k.dot(to)));
      Row open = Row::Zero(), tilt = Row::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        open(axis) = (phase - 1.0) * to[axis];
        tilt(3 + axis) = (phase - 1.0) * Vector3::Unit(axis).cross(Vector3::UnitZ()).dot(to);
      }
      add(open, stiffness, wave.stiffness);
      add(tilt, stiffness * a * a / 12, wave.stiffness);
      for (int offset = -viscous_reach(); offset <= viscous_reach(); ++offset) {
        const Vector3 apart = spacing * to + offset * a * Vector3::UnitZ();
        slide(0.5 * apart, phase * std::exp(std::complex<double>(0, q * offset)),
              viscosity.eta * viscosity.weight(apart.norm()), wave.contact_damping);
      }
    }
  }
  int viscous_reach() const {
    return viscosity.eta > 0 ? static_cast<int>(viscosity.outer / type.element_length) : -1;
  }
  // Sliding at a contact: v_j - v_i - (w_i + w_j) x arm.
  void slide(const Vector3& arm, std::complex<double> phase, double strength, Matrix6& to) const {
    Eigen::Matrix<std::complex<double>, 3, 6> sliding = Eigen::Matrix<std::complex<double>, 3, 6>::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      sliding(axis, axis) = phase - 1.0;
      sliding.block<3, 1>(0, 3 + axis) = -(phase + 1.0) * Vector3::Unit(axis).cross(arm);
    }
    add(sliding, strength, to);
  }
  // A quadratic form of the motion, over the masses.
  template <class Rows>
  void add(Rows rows, double factor, Matrix6& to) const {
    rows.template leftCols<3>() /= std::sqrt(type.mass);
    rows.template rightCols<3>() /= std::sqrt(type.inertia);
    to += factor * rows.adjoint() * rows;
  }

  // A grid of them: half of the wave vectors along the tubes, and across them, where there are neighbours, half of
  // a rhombus that is one cell of the reciprocal lattice. The other halves are mirror images.
  std::vector<Wave> waves() const {
    constexpr int along = 12, across = 12;
    const bool alone = !(spacing > 0 && (stiffness > 0 || viscosity.eta > 0));
    const double cell = spacing > 0 ? 2 * units::pi / spacing : 0;
    std::vector<Wave> all;
    for (int x = 0; x <= (alone ? 0 : across / 2); ++x)
      for (int y = 0; y < (alone ? 1 : across); ++y) {
        const double b1 = cell * x / across, b2 = cell * y / across;
        for (int n = 0; n <= along; ++n) {
          const double q = units::pi * n / along;
          Wave wave;
          if (!alone) add_contact(Vector3(b1, (2 * b2 - b1) / std::sqrt(3.0), 0), q, wave);
          add_bonds(q, wave);
          for (int axis = 0; axis < 3; ++axis) wave.stiffness(axis, axis) += held / type.mass;
          wave.term_damping = dragged;
          all.push_back(wave);
        }
      }
    return all;
  }
};

Lattice lattice_of(const Topology& topology, const Interaction& in, const TubeType& type, double spacing) {
  Lattice out{type, in.damping.bond, spacing, 0, 0, 0, {}};
  for (const auto& term : in.terms) {
    out.held += term->stiffness();
    // An inertia of m r^2 or more: turns are damped no faster.
    out.dragged += term->damping() / std::min(type.mass, type.inertia / (type.radius * type.radius));
  }
  if (!in.has_contact() || topology.tubes() < 2 || spacing <= 0) return out;
  out.stiffness = std::max(contact_stiffness(topology, in, type, spacing), 0.0);
  if (in.damped_contact()) out.viscosity = in.damping.contact;
  return out;
}

// Below which no wave grows; `before` is known to be no less.
double stable_step(const std::vector<Wave>& waves, double before) {
  double limit = before;
  for (const Wave& wave : waves) {
    if (wave.largest(limit) <= 4) continue;
    double below = 0, above = limit;
    while (above - below > 1e-6 * above) {
      const double middle = 0.5 * (below + above);
      (wave.largest(middle) <= 4 ? below : above) = middle;
    }
    limit = below;
  }
  return limit;
}

// The largest angular frequency (1/ps) of an endless chain at its natural shape, a helix: in the body frames of its
// elements all bonds are alike.
double natural_chain_frequency(const TubeType& type) {
  const auto forces = [&type](const Pose& i, const Pose& j) {
    const BondForce f = bond_energy_and_gradient(type.bond, type.element_length, j.position - i.position,
                                                 frame_of(i.orientation), frame_of(j.orientation));
    return PairVector((PairVector() << -f.force_j, f.torque_i, f.force_j, f.torque_j).finished());
  };
  const double a = type.element_length;
  const Pose here{Vector3::Zero(), Quaternion::Identity()},
      next{a * (natural_turn(type.bond, 0.5 * a) * Vector3::UnitZ()), natural_turn(type.bond, a)};
  PairMatrix to_body = PairMatrix::Identity();
  for (const int at : {6, 9}) to_body.block<3, 3>(at, at) = next.orientation.toRotationMatrix();
  PairMatrix k = to_body.transpose() * pair_stiffness(forces, here, next) * to_body;
  PairVector per_mass;
  per_mass << Vector3::Constant(1 / std::sqrt(type.mass)), Vector3::Constant(1 / std::sqrt(type.inertia)),
      Vector3::Constant(1 / std::sqrt(type.mass)), Vector3::Constant(1 / std::sqrt(type.inertia));
  k = per_mass.asDiagonal() * k * per_mass.asDiagonal();
  double largest = 0;
  constexpr int steps = 64;
  for (int n = 0; n <= steps; ++n) {
    const std::complex<double> phase = std::polar(1.0, units::pi * n / steps);
    const Matrix6 across = phase * k.topRightCorner<6, 6>();
    largest = std::max(largest, largest_eigenvalue(k.topLeftCorner<6, 6>() + k.bottomRightCorner<6, 6>() + across +
                                                   across.adjoint()));
  }
  return std::sqrt(largest);
}

// A straight bond that is alike in all directions, and whose chain is as stiff as any of a natural shape.
BondStiffness stiffest_straight(const TubeType& type) {
  BondStiffness k = straightened(stiffest_in_window(type.bond));
  if (!is_shaped(type.bond)) return k;
  k.bend += std::fabs(type.bond.bend_difference);
  const double straight = stiffest_chain_frequency(k, type.element_length, type.mass, type.inertia),
               more = std::max(1.0, std::pow(natural_chain_frequency(type) / straight, 2));
  for (double* stiffness : {&k.stretch, &k.bend, &k.twist, &k.shear}) *stiffness *= more;
  return k;
}

}  // namespace

TimeStepLimit time_step_limit(const Topology& given, const Interaction& in, double spacing) {
  Topology topology = given;
  for (TubeType& t : topology.types) t.bond = stiffest_straight(t);
  TimeStepLimit out;
  const auto raise = [](double& value, double to) { value = std::max(value, to); };
  for (const TubeType& t : topology.types) {
    raise(out.chain_frequency, stiffest_chain_frequency(t.bond, t.element_length, t.mass, t.inertia));
  }
  out.limit = 2 / out.chain_frequency;
  for (const TubeType& t : topology.types) {
    const Lattice lattice = lattice_of(topology, in, t, spacing);
    // A triangular lattice of springs k: largest w^2 = 6 k/m.
    raise(out.contact_frequency, std::sqrt(6 * lattice.stiffness / t.mass));
    const std::vector<Wave> waves = lattice.waves();
    out.limit = stable_step(waves, out.limit);
    out.stiffest.emplace_back();
    for (const Wave& wave : waves) {
      out.stiffest.back().push_back(largest_eigenvalue(wave.stiffness));
      const Vector6 rates = eigenvalues(wave.bond_damping + wave.contact_damping);
      out.damping_rates.insert(out.damping_rates.end(), rates.begin(), rates.end());
      raise(out.damping_rate, rates[5] + lattice.dragged);
    }
  }
  return out;
}

double excess_of_positions(const TimeStepLimit& limit, double step) {
  const auto of_mode = [](double w2, double h) {
    const double left = 1 - 0.25 * w2 * h * h;
    return left > 0 ? 1 / left - 1 : std::numeric_limits<double>::infinity();
  };
  double largest = 0;
  for (const std::vector<double>& waves : limit.stiffest) {
    double sum = 0;
    for (const double w2 : waves) sum += of_mode(w2, step);
    largest = std::max(largest, sum / static_cast<double>(waves.size()));
  }
  return largest;
}

double step_of_excess(const TimeStepLimit& limit, double excess) {
  ROPEWALK_EXPECTS(excess > 0 && limit.chain_frequency > 0);
  double below = 0, above = 2 / limit.chain_frequency;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (below + above);
    (excess_of_positions(limit, middle) < excess ? below : above) = middle;
  }
  return below;
}

double heat_left(const TimeStepLimit& limit, double time, double of_terms) {
  ROPEWALK_EXPECTS(!limit.damping_rates.empty());
  double sum = 0;
  for (const double rate : limit.damping_rates) sum += std::exp(-(rate + of_terms) * time);
  return sum / static_cast<double>(limit.damping_rates.size());
}

double bath_held(const TimeStepLimit& limit, double coupling, double of_terms) {
  double sum = 0;
  for (const double rate : limit.damping_rates) sum += coupling / (coupling + rate + of_terms);
  return sum / static_cast<double>(limit.damping_rates.size());
}

}  // namespace ropewalk
