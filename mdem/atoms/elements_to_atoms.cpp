#include "atoms/elements_to_atoms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ropewalk {

TubeCurve::TubeCurve(const State& state, std::size_t first, int elements, double element_length,
                     const TubeReference& reference, const std::vector<char>& broken)
    : length_(element_length), radius_(reference.shape.radius) {
  for (std::size_t i = first; i + 1 < first + static_cast<std::size_t>(elements); ++i) {
    Bond b;
    b.from = state.position[i];
    b.to = state.position[i + 1];
    const double chord = (b.to - b.from).norm();
    b.start = state.orientation[i];
    b.end = state.orientation[i + 1];
    Eigen::Quaterniond turn = b.start.conjugate() * state.orientation[i + 1];
    if (turn.w() < 0) turn.coeffs() = -turn.coeffs();  // the short way
    const Eigen::AngleAxisd by(turn);
    b.turn = by.angle();
    b.turn_axis = by.axis();
    b.tangent_from = chord * axis_of(state.orientation[i]);
    b.tangent_to = chord * axis_of(state.orientation[i + 1]);
    b.radius = reference.shape.radius * (1 - reference.poisson * (chord / element_length - 1));
    b.broken = !broken.empty() && broken[i] != 0;
    bonds_.push_back(b);
  }
  if (!bonds_.empty()) return;
  Bond alone;
  alone.from = state.position[first];
  alone.start = alone.end = state.orientation[first];
  alone.tangent_from = alone.tangent_to = element_length * axis_of(alone.start);
  alone.to = alone.from + alone.tangent_from;
  alone.turn_axis = Vector3::UnitZ();
  alone.radius = reference.shape.radius;
  bonds_.push_back(alone);
}

TubeSection TubeCurve::at(double s) const {
  const double along = s / length_ - 0.5;
  const int last = static_cast<int>(bonds_.size()) - 1;
  const int k = std::clamp(static_cast<int>(std::floor(along)), 0, last);
  const Bond& b = bonds_[static_cast<std::size_t>(k)];
  const double u = along - k, within = std::clamp(u, 0.0, 1.0);
  if (b.broken) return at_break(static_cast<std::size_t>(k), u);
  TubeSection out;
  out.radius = b.radius;
  out.frame = (b.start * Eigen::AngleAxisd(within * b.turn, b.turn_axis)).toRotationMatrix();
  const double u2 = within * within, u3 = u2 * within;
  out.centre = (2 * u3 - 3 * u2 + 1) * b.from + (3 * u2 - 2 * u3) * b.to + (u3 - 2 * u2 + within) * b.tangent_from +
               (u3 - u2) * b.tangent_to;
  if (u < 0) out.centre += u * b.tangent_from;
  if (u > 1) out.centre += (u - 1) * b.tangent_to;
  return out;
}

TubeSection TubeCurve::at_break(std::size_t k, double u) const {
  const Bond& b = bonds_[k];
  // An element whose bonds have both broken stands alone, at rest.
  const Bond* of_piece = nullptr;
  if (u < 0.5 && k > 0 && !bonds_[k - 1].broken) of_piece = &bonds_[k - 1];
  if (u >= 0.5 && k + 1 < bonds_.size() && !bonds_[k + 1].broken) of_piece = &bonds_[k + 1];
  const double length = of_piece ? (of_piece->to - of_piece->from).norm() : length_;
  TubeSection out;
  out.radius = of_piece ? of_piece->radius : radius_;
  const Eigen::Quaterniond& orientation = u < 0.5 ? b.start : b.end;
  out.frame = orientation.toRotationMatrix();
  out.centre = (u < 0.5 ? b.from : b.to) + (u < 0.5 ? u : u - 1) * length * axis_of(orientation);
  return out;
}

long first_height(const TubeReference& reference, double element_length, int element) {
  // The slack keeps a site on a boundary in the element that begins there.
  return static_cast<long>(std::ceil(3 * element * element_length / reference.shape.length_per_hexagon - 1e-6));
}

AtomsOfElements::AtomsOfElements(const Topology& topology, const State& state,
                                 std::vector<TubeReference> references, std::vector<TubePart> parts,
                                 std::vector<char> broken)
    : topology_(topology),
      state_(state),
      references_(std::move(references)),
      parts_(std::move(parts)),
      broken_(std::move(broken)) {}

const TubeReference& AtomsOfElements::reference_of_tube(int tube) const {
  return references_[static_cast<std::size_t>(topology_.tube_type[static_cast<std::size_t>(tube)])];
}

long AtomsOfElements::count(const TubePart& part) const {
  const TubeReference& reference = reference_of_tube(part.tube);
  const double a = topology_.type_of(part.tube).element_length;
  return SiteRows(reference.chirality)
      .sites_between(first_height(reference, a, part.begin), first_height(reference, a, part.end));
}

long AtomsOfElements::count() const {
  long sum = 0;
  for (const TubePart& part : parts_) sum += count(part);
  return sum;
}

void AtomsOfElements::for_each(const std::function<void(const PlacedAtom&)>& visit) const {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const TubePart& part = parts_[p];
    const TubeReference& reference = reference_of_tube(part.tube);
    const double a = topology_.type_of(part.tube).element_length;
    const TubeCurve curve(state_,
                          static_cast<std::size_t>(topology_.tube_begin[static_cast<std::size_t>(part.tube)]),
                          topology_.length_of(part.tube), a, reference, broken_);
    const SiteRows rows(reference.chirality);
    PlacedAtom atom;
    atom.part = static_cast<int>(p);
    atom.tube = part.tube;
    for (atom.element = part.begin; atom.element < part.end; ++atom.element)
      rows.between(first_height(reference, a, atom.element), first_height(reference, a, atom.element + 1),
                   [&](const SiteRow& row) {
                     const Polar first = polar(reference.chirality, row.first, reference.shape);
                     const TubeSection section = curve.at(first.z);
                     const double lifted = section.radius + (row.first.second ? 0.5 : -0.5) * reference.shape.lift;
                     atom.second = row.first.second;
                     for (int k = 0; k < row.sites; ++k) {
                       const double phi = first.phi + 2 * units::pi * k / row.sites;
                       atom.position = section.centre + lifted * (std::cos(phi) * section.frame.col(0) +
                                                                  std::sin(phi) * section.frame.col(1));
                       visit(atom);
                     }
                   });
  }
}

void AtomsOfElements::bounds(Vector3& low, Vector3& high) const {
  low = Vector3::Constant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const TubePart& part : parts_) {
    // Half an element beyond its centre, stretched and across, lies no atom.
    const double margin = topology_.type_of(part.tube).element_length + 1.5 * topology_.type_of(part.tube).radius;
    for (int e = part.begin; e < part.end; ++e) {
      const Vector3 x =
          state_.position[static_cast<std::size_t>(topology_.tube_begin[static_cast<std::size_t>(part.tube)] + e)];
      low = low.cwiseMin(x - Vector3::Constant(margin));
      high = high.cwiseMax(x + Vector3::Constant(margin));
    }
  }
}

}  // namespace ropewalk
