#include "atoms/atoms_to_elements.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

constexpr double converged = 1e-7;  // nm and rad
constexpr int most_rounds = 40;
// The means over elements damp the shortest waves along a tube: those of turns to a half, those of positions to
// 5/8. These factors make the iteration converge alike for the shortest and the longest wave.
constexpr double over_turn = 4.0 / 3, over_shift = 16.0 / 13;

Vector3 rotation_vector(const Eigen::Matrix3d& r) {
  const Eigen::AngleAxisd turn(r);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d rotation_of(const Vector3& v) {
  const double angle = v.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

}  // namespace

ElementFit::ElementFit(const TubeReference& reference, double element_length, int elements,
                       const std::vector<LabelledAtom>& atoms)
    : reference_(reference), element_length_(element_length) {
  std::vector<long> first;
  for (int e = 0; e <= elements; ++e) first.push_back(first_height(reference, element_length, e));
  std::vector<std::pair<int, LabelledAtom>> sorted;
  sorted.reserve(atoms.size());
  for (const LabelledAtom& atom : atoms) {
    const long height = height_in_thirds(reference.chirality, atom.site);
    const auto e = std::upper_bound(first.begin(), first.end(), height) - first.begin() - 1;
    if (e >= 0 && e < elements) sorted.push_back({static_cast<int>(e), atom});
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  begin_.assign(static_cast<std::size_t>(elements) + 1, 0);
  for (const auto& [e, atom] : sorted) {
    ++begin_[static_cast<std::size_t>(e) + 1];
    atoms_.push_back(atom);
    const Polar at = polar(reference.chirality, atom.site, reference.shape);
    places_.push_back({at.z, std::cos(at.phi), std::sin(at.phi)});
  }
  for (std::size_t e = 1; e < begin_.size(); ++e) begin_[e] += begin_[e - 1];
  for (int e = 0; e < elements; ++e) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    for (std::size_t k = begin_[static_cast<std::size_t>(e)]; k < begin_[static_cast<std::size_t>(e) + 1]; ++k) {
      const Eigen::Vector4d basis(1, places_[k].s - centre_of(e), places_[k].cosine, places_[k].sine);
      normal += basis * basis.transpose();
    }
    inverse_.push_back(normal.inverse());
  }
}

double ElementFit::filled(int element) const {
  const auto e = static_cast<std::size_t>(element);
  const long sites = SiteRows(reference_.chirality)
                         .sites_between(first_height(reference_, element_length_, element),
                                        first_height(reference_, element_length_, element + 1));
  return static_cast<double>(begin_[e + 1] - begin_[e]) / static_cast<double>(sites);
}

template <class Position>
std::vector<ElementFit::Section> ElementFit::sections(const Position& position) const {
  std::vector<Section> out;
  out.reserve(static_cast<std::size_t>(elements()));
  for (int e = 0; e < elements(); ++e) {
    Eigen::Matrix<double, 4, 3> sums = Eigen::Matrix<double, 4, 3>::Zero();
    const double middle = centre_of(e);
    for (std::size_t k = begin_[static_cast<std::size_t>(e)]; k < begin_[static_cast<std::size_t>(e) + 1]; ++k) {
      const Eigen::RowVector3d x = position(k).transpose();
      sums.row(0) += x;
      sums.row(1) += (places_[k].s - middle) * x;
      sums.row(2) += places_[k].cosine * x;
      sums.row(3) += places_[k].sine * x;
    }
    const Eigen::Matrix<double, 4, 3> fit = inverse_[static_cast<std::size_t>(e)] * sums;
    Section section;
    section.centre = fit.row(0).transpose();
    section.slope = fit.row(1).transpose();
    // The orthonormal pair nearest to (p, q): (p, q) G^(-1/2) with G = (p, q)^T (p, q). By the theorem of Cayley
    // and Hamilton G^(1/2) = (G + det 1)/(trace + 2 det)^(1/2) for a 2 x 2 matrix, det being that of the root.
    Eigen::Matrix<double, 3, 2> pair;
    pair << fit.row(2).transpose(), fit.row(3).transpose();
    const Eigen::Matrix2d g = pair.transpose() * pair;
    const double det = std::sqrt(std::max(0.0, g.determinant()));
    const Eigen::Matrix2d root =
        (g + det * Eigen::Matrix2d::Identity()) / std::sqrt(std::max(1e-300, g.trace() + 2 * det));
    section.radius = 0.5 * root.trace();
    const Eigen::Matrix<double, 3, 2> axes = pair * root.inverse();
    section.frame << axes, Vector3(axes.col(0)).cross(Vector3(axes.col(1)));
    out.push_back(section);
  }
  return out;
}

Vector3 ElementFit::placed(const TubeCurve& curve, std::size_t k) const {
  const TubeSection section = curve.at(places_[k].s);
  return section.centre +
         section.radius * (places_[k].cosine * section.frame.col(0) + places_[k].sine * section.frame.col(1));
}

void ElementFit::fit(const std::vector<Vector3>& positions, State& state, std::size_t first) const {
  const std::vector<Section> wanted = sections([&](std::size_t k) { return positions[atoms_[k].atom]; });
  for (std::size_t e = 0; e < wanted.size(); ++e) {
    state.position.set(first + e, wanted[e].centre);
    state.orientation.set(first + e, Quaternion(wanted[e].frame).normalized());
  }
  for (int round = 0; round < most_rounds; ++round) {
    const TubeCurve curve(state, first, elements(), element_length_, reference_);
    const std::vector<Section> now = sections([&](std::size_t k) { return placed(curve, k); });
    double change = 0;
    for (std::size_t e = 0; e < wanted.size(); ++e) {
      const Vector3 shift = over_shift * (wanted[e].centre - now[e].centre);
      const Vector3 turn = over_turn * rotation_vector(now[e].frame.transpose() * wanted[e].frame);
      change = std::max({change, shift.norm(), turn.norm()});
      state.position.set(first + e, state.position[first + e] + shift);
      state.orientation.set(first + e, (state.orientation[first + e] * Quaternion(rotation_of(turn))).normalized());
    }
    if (!(change > converged)) break;
  }
}

void ElementFit::fit_velocities(const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                                State& state, std::size_t first) const {
  for (std::size_t e = 0; e + 1 < begin_.size(); ++e) {
    Vector3 mean = Vector3::Zero(), centre = Vector3::Zero(), moment = Vector3::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    const double n = static_cast<double>(begin_[e + 1] - begin_[e]);
    for (std::size_t k = begin_[e]; k < begin_[e + 1]; ++k) {
      mean += velocities[atoms_[k].atom] / n;
      centre += positions[atoms_[k].atom] / n;
    }
    for (std::size_t k = begin_[e]; k < begin_[e + 1]; ++k) {
      const Vector3 arm = positions[atoms_[k].atom] - centre;
      moment += arm.cross(Vector3(velocities[atoms_[k].atom] - mean));
      inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
    }
    const Vector3 spin = inertia.ldlt().solve(moment);
    state.angular_velocity.set(first + e, spin);
    state.velocity.set(first + e, mean + spin.cross(Vector3(state.position[first + e] - centre)));
  }
}

std::vector<SectionShape> ElementFit::shapes(const std::vector<Vector3>& positions, const State& state,
                                             std::size_t first) const {
  const std::vector<Section> found = sections([&](std::size_t k) { return positions[atoms_[k].atom]; });
  const TubeCurve curve(state, first, elements(), element_length_, reference_);
  std::vector<SectionShape> out;
  for (std::size_t e = 0; e < found.size(); ++e) {
    const Section& section = found[e];
    SectionShape shape;
    const Vector3 slope = section.frame.transpose() * section.slope;
    shape.radius = section.radius;
    shape.shear_x = slope.x() / slope.z();
    shape.shear_y = slope.y() / slope.z();
    double cosine = 0, sine = 0;
    for (std::size_t k = begin_[e]; k < begin_[e + 1]; ++k) {
      const TubeSection here = curve.at(places_[k].s);
      const Vector3 out_of = places_[k].cosine * here.frame.col(0) + places_[k].sine * here.frame.col(1);
      const double rho = (positions[atoms_[k].atom] - here.centre).dot(out_of);
      cosine += rho * (places_[k].cosine * places_[k].cosine - places_[k].sine * places_[k].sine);
      sine += rho * 2 * places_[k].cosine * places_[k].sine;
    }
    shape.ovality = 2 * std::hypot(cosine, sine) / static_cast<double>(begin_[e + 1] - begin_[e]);
    out.push_back(shape);
  }
  return out;
}

std::vector<double> ElementFit::misfits(const std::vector<Vector3>& positions, const State& state,
                                        std::size_t first) const {
  const TubeCurve curve(state, first, elements(), element_length_, reference_);
  std::vector<double> out;
  for (std::size_t k = 0; k < atoms_.size(); ++k)
    out.push_back((positions[atoms_[k].atom] - placed(curve, k)).norm());
  return out;
}

}  // namespace ropewalk
