// The curvature of the surface on which the tubes of a twisted rope pack.
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "cases/common/bundle.hpp"

namespace ropewalk::validate::packing_charge {
namespace {

constexpr double ring_radius = 8;  // spacings

// Integrated Gaussian curvature of the metric d rho^2 + (rho cos beta d phi)^2, tan beta = rate rho, in units of
// 2 pi/6.
double ideal_charge(double beta) { return 6 * (1 - std::pow(std::cos(beta), 3)); }

// A helix through a point of the plane z = 0, as a function of its arc length.
struct Helix {
  Eigen::Vector2d position;
  double rate = 0;  // rad/nm of the axis
  double cosine() const { return 1 / std::hypot(1.0, rate * position.norm()); }
  Vector3 point(double s) const {
    const double z = s * cosine();
    const Eigen::Vector2d p = Eigen::Rotation2Dd(rate * z) * position;
    return {p.x(), p.y(), z};
  }
  Vector3 tangent(double s) const {
    const Vector3 p = point(s);
    return cosine() * Vector3(-rate * p.y(), rate * p.x(), 1);
  }
};

// Contact energy per length (eV/nm) of two tubes on a ring, `angle` apart in the section.
double ring_energy(const LineContact& law, double radius, double rate, double angle) {
  const Helix one{{radius, 0}, rate}, two{Eigen::Rotation2Dd(angle) * one.position, rate};
  double sum = 0;
  for (int k = -8; k <= 8; ++k) {
    const double s = k * law.length_i;
    sum += law.energy(two.point(s) - one.point(0), one.tangent(0), two.tangent(s));
  }
  return sum / law.length_i;
}

struct Ring {
  double tubes = 0;   // number that fits around the ring in contact, not rounded
  double energy = 0;  // energy of each contact, eV/nm
  // Circumference in spacings, by the chords of a polygon: an untwisted rope then has no curvature.
  double around() const { return units::pi / std::sin(units::pi / tubes); }
};

Ring fitted_ring(const LineContact& law, double radius, double rate, double spacing) {
  const double cosine = Helix{{radius, 0}, rate}.cosine();
  const LineWell well = detail::lowest_point([&](double angle) { return ring_energy(law, radius, rate, angle); },
                                             0.8 * spacing / radius, 1.6 * spacing / (radius * cosine));
  return {2 * units::pi / well.distance, well.energy};
}

// By Gauss and Bonnet the curvature inside is 2 pi minus the growth of the circumference per radius.
double charge_inside(const LineContact& law, double radius, double rate, double spacing) {
  const double h = 0.5 * spacing;
  const double outer = fitted_ring(law, radius + h, rate, spacing).around();
  const double inner = fitted_ring(law, radius - h, rate, spacing).around();
  return 6 * (1 - (outer - inner) * spacing / (2 * h * 2 * units::pi));
}

CaseResult run(const CaseContext& context) {
  const LineContact law = line_contact_of(context.model());
  const Well pair = pair_well(context.set());
  const double radius = ring_radius * pair.distance;
  CaseResult result;
  std::vector<double> angles, charges, counts;
  for (const int degrees : {0, 10, 20, 30, 40, 50}) {
    const double beta = degrees * units::degree, rate = std::tan(beta) / radius;
    const Ring ring = fitted_ring(law, radius, rate, pair.distance);
    const std::string at = " at " + std::to_string(degrees) + " degrees";
    angles.push_back(degrees);
    charges.push_back(charge_inside(law, radius, rate, pair.distance));
    counts.push_back(ring.tubes);
    result.check_absolute("charge" + at, charges.back(), ideal_charge(beta), 2e-2, "",
                          "finite distance of the tubes: `(spacing/radius)^2 = 0.016`");
    result.check_relative("energy of a contact" + at, ring.energy, pair.energy, 5e-3, "eV/nm",
                          "contact fitted to 1.4e-3; bent tubes: 0.1 %");
  }
  CaseFigure charge = case_figure(
      "Packing charge against twist", {"twist angle", "degrees"}, {"charge", ""},
      "The first five-fold site is expected where the curve passes one half to one, at 14 to 20 degrees.");
  CaseFigure count = case_figure(
      "Tubes that fit around a ring", {"twist angle", "degrees"}, {"tubes", ""},
      "A ring with a radius of 8 spacings. In the cross-section, twisted tubes are wider by `1/cos beta`.");
  charge.chart.lines = {
      theory_curve("6 (1 - cos^3 beta)", 0, 55, [](double d) { return ideal_charge(d * units::degree); }),
      model_points("rings of tubes in contact", angles, charges)};
  count.chart.lines = {
      theory_curve("2 pi rho cos beta/spacing", 0, 55,
                   [](double d) { return 2 * units::pi * ring_radius * std::cos(d * units::degree); }),
      model_points("by the contact law", angles, counts)};
  result.figures = {charge, count};
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "packing-charge";
  c.order = 130;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::packing_charge
