// Fit of the published one-point form to the integral. No single kind of energy determines its 11 parameters. So
// all are fitted together, to three kinds of energies, each over its own well:
//   rows      two parallel rows of elements, at several shifts along each other: they should slide
//   crossings two rows at 30, 60 and 90 degrees, the mean over the place of the crossing on the elements
//   pairs     two parallel elements alone, at several shifts: these fix Theta
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "contact/fit_contact.hpp"
#include "contact/integral.hpp"
#include "contact/quadrature.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double within = 0.05;      // nm inside of the minimum
constexpr double pair_weight = 0.3;  // of a pair alone: rows and crossings are what a rope consists of
constexpr double min_theta = 0.1;    // the reader of parameter sets asks for 0.05

// Separation and axes of one pair of elements.
struct Pose {
  double r, p, q, c, weight;
};

// A sum over poses that should equal an integral.
struct Target {
  ContactPoint point;
  double weight = 0;
  double scale = 1;  // of the sum: per length, mean over the shifts
  std::vector<Pose> poses;
};

Pose pose(const Vector3& separation, const Vector3& ni, const Vector3& nj, double weight = 1) {
  const double r = separation.norm();
  return {r, ni.dot(separation) / r, nj.dot(separation) / r, ni.dot(nj), weight};
}

double sum_of(const PaperContact& law, const Target& t) {
  const PaperTerms<double> terms(law);
  double sum = 0;
  for (const Pose& x : t.poses) sum += x.weight * terms.of<GeneralPowers>(x.r, x.p, x.q, x.c).energy;
  return t.scale * sum;
}

// All elements of a row against one of the other, which is shifted by a part of an element.
std::vector<Pose> row_poses(double distance, double shift, double length, double reach) {
  std::vector<Pose> poses;
  const Vector3 z(0, 0, 1);
  const int last = static_cast<int>(reach / length) + 1;
  for (int k = -last; k <= last; ++k) {
    const Vector3 d(distance, 0, (k + shift) * length);
    if (d.norm() < reach) poses.push_back(pose(d, z, z));
  }
  return poses;
}

// Two crossing rows, averaged over the position of the crossing: three positions on an element in each direction.
// Positions that differ by half a turn about the normal are equivalent.
std::vector<Pose> crossing_poses(double distance, double angle, double length, double reach) {
  std::vector<Pose> poses;
  const Vector3 ni(1, 0, 0), nj(std::cos(angle), std::sin(angle), 0);
  const int last = static_cast<int>(reach / (length * std::sin(angle))) + 1;
  constexpr double third = 1.0 / 3;
  constexpr double places[][3] = {{0, 0, 1}, {third, 0, 2}, {0, third, 2}, {third, third, 2}, {third, -third, 2}};
  for (const auto& [a, b, weight] : places)
    for (int k = -last; k <= last; ++k)
      for (int l = -last; l <= last; ++l) {
        const Vector3 d = Vector3(0, 0, distance) + (l + b) * length * nj - (k + a) * length * ni;
        if (d.norm() < reach) poses.push_back(pose(d, ni, nj, weight / 9));
      }
  return poses;
}

// Two parallel elements alone, shifted: int (L - |z - shift|) u(sqrt(R^2 + z^2)) dz.
double element_pair(const PairIntegral& integral, double distance, double shift, double length) {
  const auto f = [&](double z) {
    return (length - std::fabs(z - shift)) * integral.line_density(std::hypot(distance, z));
  };
  // The peak at z = 0 and the corner at z = shift.
  std::vector<double> edges = {shift - length, 0.0, shift, shift + length};
  std::sort(edges.begin(), edges.end());
  double sum = 0;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    if (edges[k + 1] > edges[k]) sum += integrate_both_ends(f, edges[k], edges[k + 1]);
  return sum;
}

class PaperTargets {
 public:
  PaperTargets(const PairIntegral& integral, const Shell& shell, double length)
      : integral_(integral), length_(length), reach_(8 * shell.radius) {
    const Well parallel = integral.parallel_well(), crossed = integral.crossed_well();
    for (const double gap : {-within, -0.02, 0.0, 0.03, 0.08, 0.16, 0.28, 0.45, 0.7, 1.0}) {
      for (const double shift : {0.0, 0.25, 0.5}) add_row(parallel.distance + gap, shift, parallel);
      for (const double shift : {0.0, 0.5, 1.0, 1.5}) add_pair(parallel.distance + gap, shift * length, parallel);
    }
    for (const double gap : {-within, 0.0, 0.06, 0.2, 0.5})
      for (const double degrees : {30.0, 60.0, 90.0})
        add_crossing(crossed.distance + gap, degrees * units::degree, crossed);
  }
  std::vector<Target> targets;

 private:
  static double weight(double energy, double well) { return 1 / (std::fabs(well) + 2 * std::max(energy, 0.0)); }

  void add_row(double R, double shift, const Well& well) {
    Target t;
    t.point = {R, 0, 0.5 * units::pi, integral_.parallel(R), 0};
    t.weight = weight(t.point.integral, well.energy);
    t.scale = 1 / length_;
    t.poses = row_poses(R, shift, length_, reach_);
    targets.push_back(std::move(t));
  }
  void add_crossing(double R, double angle, const Well& well) {
    Target t;
    const double sine = std::sin(angle);
    t.point = {R, angle, 0.5 * units::pi, integral_.crossed(R) / sine, 0};
    t.weight = weight(t.point.integral, well.energy / sine);
    t.poses = crossing_poses(R, angle, length_, reach_);
    targets.push_back(std::move(t));
  }
  void add_pair(double R, double shift, const Well& well) {
    Target t;
    t.point = {std::hypot(R, shift), 0, std::atan2(R, shift), element_pair(integral_, R, shift, length_), 0};
    t.weight = pair_weight * weight(t.point.integral, well.energy * length_);
    t.poses = {pose({R, 0, shift}, {0, 0, 1}, {0, 0, 1})};
    targets.push_back(std::move(t));
  }

  const PairIntegral& integral_;
  double length_, reach_;
};

// --- Parameters -------------------------------------------------------------------------------------------

// The constants of the published form that are not fitted. The two that depend on the gap are converted to this
// radius.
PaperContact frame(double radius, double spacing) {
  PaperContact law;
  const double gap = spacing / radius - 2;             // D of the well
  constexpr double published_gap = 1.671 / 0.678 - 2;  // of (10,10), for which core and freeze are published
  law.radius = radius;
  law.epsilon = 0.03733;
  law.core_gap = 0.4 * gap / published_gap;
  law.freeze = 2 + 0.75 * gap / published_gap;
  return law;
}

// A, B and C_gamma change by powers of ten along with the exponents. The search therefore varies three other
// quantities: position and depth of the well of V, and the strength of the crossing term there. A second fit in the
// parameters themselves starts from its result and gives the standard errors.
class Meaning {
 public:
  Meaning(double radius, const Well& well, double length)
      : ratio_(well.distance / radius), depth_(std::fabs(well.energy) * length) {}

  std::vector<FitParameter> box() const {
    const double gap = ratio_ - 2;
    return {{"well of V at D", 1.15 * gap, 0.86 * gap, 2 * gap},
            {"depth of V", 0.7 * depth_, 0.1 * depth_, 2 * depth_},
            {"alpha", 9.5, 6.5, 14},
            {"beta", 4, 2, 6},
            {"C1", -0.3, -0.9, 1},
            {"C2", -0.3, -0.7, 0.7},
            {"C3", -0.12, -0.4, 0.4},
            {"C4", -0.02, -0.3, 0.3},
            {"C5", 0, -0.2, 0.2},
            {"crossing at the well", 0.1, 0, 1},
            {"delta", -7.5, -10, -1}};
  }

  // The parameters of the form: A, B, alpha, beta, C1 .. C5, C_gamma, delta.
  std::vector<double> parameters(std::vector<double> p, double epsilon) const {
    const double D = p[0], alpha = p[2], beta = p[3];
    const double B = p[1] * std::pow(D, beta) / (4 * epsilon * (1 - beta / alpha));
    p[0] = beta / alpha * B * std::pow(D, alpha - beta);
    p[1] = B;
    p[9] *= std::pow(ratio_, -p[10]);
    return p;
  }

 private:
  double ratio_, depth_;
};

// Bounds around the result of the search; exponents and angular terms keep their bounds.
std::vector<FitParameter> box_around(const std::vector<double>& p, std::vector<FitParameter> box) {
  for (std::size_t k = 0; k < box.size(); ++k) {
    box[k].name = paper_parameters[k];
    box[k].start = p[k];
    if (k == 0 || k == 1) box[k].lower = 0.2 * p[k], box[k].upper = 5 * p[k];
    if (k == 9) box[k].lower = 0, box[k].upper = 5 * p[k] + 1;
  }
  return box;
}

double theta_factor(const PaperContact& law, double theta) {
  double sum = 1;
  for (int i = 1; i <= 5; ++i)
    sum += law.angular[static_cast<std::size_t>(i - 1)] * ((i % 2 ? 1 : -1) + std::cos(2 * i * theta));
  return sum;
}

// Penalties: residuals that are 0 while a condition on parameter sets holds and rise when it is violated.
constexpr std::size_t limits = 3;
void add_limits(const PaperContact& law, double* out) {
  double least = 1;
  for (int degree = 0; degree <= 90; degree += 2)
    least = std::min(least, theta_factor(law, degree * units::degree));
  const double lowest =
      std::pow(law.alpha * law.repulsion / (law.beta * law.attraction), 1 / (law.alpha - law.beta));
  out[0] = 10 * std::max(0.0, min_theta - least);
  out[1] = 10 * std::max(0.0, 1.03 * law.core_gap / lowest - 1);
  out[2] = std::max(0.0, lowest + 2 - 0.95 * law.switch_start);
}

Well well_of(const std::vector<double>& grid, const std::function<double(double)>& energy) {
  const LineWell w = detail::lowest_point(energy, grid.front(), grid.back());
  return {w.distance, w.energy};
}

void describe(const PairIntegral& integral, double length, PaperFit& out) {
  const double reach = out.law.cutoff();
  const Well parallel = integral.parallel_well(), crossed = integral.crossed_well();
  const auto rows = [&](double R) {
    double sum = 0;
    for (const double shift : {0.0, 0.25, 0.25, 0.5})  // even about 0 and 1/2
      sum += sum_of(out.law, {{}, 0, 1 / (4 * length), row_poses(R, shift, length, reach)});
    return sum;
  };
  const auto crossings = [&](double R) {
    return sum_of(out.law, {{}, 0, 1, crossing_poses(R, 0.5 * units::pi, length, reach)});
  };
  out.parallel = well_of({parallel.distance - 0.1, parallel.distance + 0.3}, rows);
  out.crossed = well_of({crossed.distance - 0.1, crossed.distance + 0.3}, crossings);
  for (double gap = -within; gap < 1.2; gap += 0.01) {
    const double Rp = parallel.distance + gap, Rx = crossed.distance + gap;
    out.error = std::max({out.error, std::fabs((rows(Rp) - integral.parallel(Rp)) / parallel.energy),
                          std::fabs((crossings(Rx) - integral.crossed(Rx)) / crossed.energy)});
  }
}

}  // namespace

void set_form(const std::vector<double>& p, PaperContact& law) {
  law.repulsion = p[0], law.attraction = p[1], law.alpha = p[2], law.beta = p[3];
  std::copy(p.begin() + 4, p.begin() + 9, law.angular.begin());
  law.crossing = p[9], law.delta = p[10];
}

PaperFit fit_paper(const AtomLaw& law, const Shell& shell, double element_length, const FitOptions& options) {
  if (!(element_length > 0)) throw std::invalid_argument("paper contact: the element length must be positive");
  const PairIntegral integral(law, shell, shell);
  const Well parallel = integral.parallel_well();
  PaperTargets wanted(integral, shell, element_length);
  PaperFit out;
  out.law = frame(shell.radius, parallel.distance);
  const std::size_t size = wanted.targets.size() + limits;
  const auto residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    set_form(p, out.law);
    for (std::size_t k = 0; k < wanted.targets.size(); ++k) {
      const Target& t = wanted.targets[k];
      r[k] = t.weight * (sum_of(out.law, t) - t.point.integral);
    }
    add_limits(out.law, r.data() + wanted.targets.size());
  };
  const Meaning meaning(shell.radius, parallel, element_length);
  const auto by_meaning = [&](const std::vector<double>& p, std::vector<double>& r) {
    residuals(meaning.parameters(p, out.law.epsilon), r);
  };
  // All starts that were tried gave the same result: two are enough, and the search takes seconds.
  FitOptions few = options;
  few.starts = std::min(options.starts, 2);
  few.max_evaluations = std::min(options.max_evaluations, 5000);
  const FitResult search = fit_least_squares(meaning.box(), size, by_meaning, few);
  const std::vector<double> found = meaning.parameters(search.value, out.law.epsilon);
  FitOptions once = few;
  once.starts = 1;
  out.fit = fit_least_squares(box_around(found, meaning.box()), size, residuals, once);
  set_form(out.fit.value, out.law);
  for (Target& t : wanted.targets) {
    t.point.fit = sum_of(out.law, t);
    out.points.push_back(t.point);
  }
  describe(integral, element_length, out);
  return out;
}

}  // namespace ropewalk::calibrate
