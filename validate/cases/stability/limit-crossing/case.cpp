// Tubes that cross at any angle, lie in one line or on one another: where the contact laws are not smooth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk::validate::crossing {
namespace {

// Energy (eV) at a point of a path, and its slope by force or torque.
struct EnergyAndSlope {
  double energy = 0, slope = 0;
};
using Path = std::function<EnergyAndSlope(double)>;

// Two rigid straight tubes, evaluated by the simulator's forces.
class RigidTubes {
 public:
  RigidTubes(const ParameterSet& set, Interaction interaction, int elements)
      : in_(std::move(interaction)),
        topology_(straight_tubes(set, elements, {{0, 0}, {0, 0}}).topology),
        elements_(elements) {}

  // The first tube lies along z. The second has its centre at `centre` and its axis at `angle` to z in the plane of
  // y and z.
  void put(const Vector3& centre, double angle) {
    const double a = topology_.types[0].element_length;
    const Vector3 axis(0, -std::sin(angle), std::cos(angle));
    state_ = State(static_cast<std::size_t>(2 * elements_));
    for (int e = 0; e < elements_; ++e) {
      const double s = (e - 0.5 * (elements_ - 1)) * a;
      const auto i = static_cast<std::size_t>(e), j = static_cast<std::size_t>(e + elements_);
      state_.position.set(i, {0, 0, s});
      state_.position.set(j, centre + s * axis);
      state_.orientation.set(j, turn_about(Vector3::UnitX(), angle));
    }
    NeighbourList list(in_, 0.2);
    list.build(topology_, state_);
    ForceEngine engine;
    forces_ = Forces(state_.size());
    engine.compute(topology_, in_, list, state_, forces_);
  }
  double energy() const { return forces_.energy.vdw; }
  Vector3 force() const {  // force on the second tube
    Vector3 sum = Vector3::Zero();
    for (int e = elements_; e < 2 * elements_; ++e) sum += forces_.force[static_cast<std::size_t>(e)];
    return sum;
  }
  Vector3 torque(const Vector3& about) const {
    Vector3 sum = Vector3::Zero();
    for (int e = elements_; e < 2 * elements_; ++e) {
      const auto i = static_cast<std::size_t>(e);
      sum += forces_.torque[i] + (state_.position[i] - about).cross(forces_.force[i]);
    }
    return sum;
  }

 private:
  Interaction in_;
  Topology topology_;
  State state_;
  Forces forces_;
  int elements_ = 0;
};

Path turning(RigidTubes& pair, const Vector3& centre) {
  return [&pair, centre](double angle) {
    pair.put(centre, angle);
    return EnergyAndSlope{pair.energy(), -pair.torque(centre).x()};
  };
}

Path shifting(RigidTubes& pair, const Vector3& from, const Vector3& direction, double angle) {
  return [&pair, from, direction, angle](double by) {
    pair.put(from + by * direction, angle);
    return EnergyAndSlope{pair.energy(), -pair.force().dot(direction)};
  };
}

struct Smoothness {
  double energy_jump = 0, slope_jump = 0;  // the largest change that is left over an interval of 1e-9
  double energy_at = 0, slope_at = 0;      // places of these changes
  double steepest = 0;
  double gradient = 0;  // slope against the difference of energies, over the largest slope
  double highest = -1e300;
  bool finite = true;
};

constexpr double narrowest = 1e-9;  // rad, nm

// Halves the interval repeatedly and keeps the half in which the value changes more; `change` is that between two
// points.
std::pair<double, double> largest_jump(const std::function<double(double)>& value, double a, double b) {
  double at_a = value(a), at_b = value(b);
  while (b - a > narrowest) {
    const double middle = 0.5 * (a + b), at = value(middle);
    if (std::fabs(at - at_a) > std::fabs(at_b - at)) {
      b = middle;
      at_b = at;
    } else {
      a = middle;
      at_a = at;
    }
  }
  return {std::fabs(at_b - at_a), 0.5 * (a + b)};
}

Smoothness smoothness(const Path& path, double from, double to, int steps) {
  Smoothness out;
  const double h = (to - from) / steps;
  std::vector<EnergyAndSlope> points;
  for (int k = 0; k <= steps; ++k) {
    points.push_back(path(from + k * h));
    out.finite = out.finite && std::isfinite(points.back().energy) && std::isfinite(points.back().slope);
    out.highest = std::max(out.highest, points.back().energy);
    out.steepest = std::max(out.steepest, std::fabs(points.back().slope));
  }
  if (!out.finite) return out;
  // Some of the intervals in which energy or slope change most, compared with their neighbours.
  std::vector<std::pair<double, int>> energy, slope;
  for (int k = 0; k < steps; ++k) {
    const EnergyAndSlope &a = points[static_cast<std::size_t>(k)], &b = points[static_cast<std::size_t>(k + 1)];
    energy.push_back({-std::fabs(b.energy - a.energy - 0.5 * h * (a.slope + b.slope)), k});
    slope.push_back({-std::fabs(b.slope - a.slope), k});
  }
  std::sort(energy.begin(), energy.end());
  std::sort(slope.begin(), slope.end());
  for (std::size_t n = 0; n < 5; ++n) {
    const double e = from + energy[n].second * h, s = from + slope[n].second * h;
    const auto [change, at] = largest_jump([&](double x) { return path(x).energy; }, e, e + h);
    const double jump = std::max(0.0, change - 2 * narrowest * out.steepest);  // less what the slope accounts for
    if (jump > out.energy_jump) out.energy_jump = jump, out.energy_at = at;
    const auto [kink, kink_at] = largest_jump([&](double x) { return path(x).slope; }, s, s + h);
    if (kink > out.slope_jump) out.slope_jump = kink, out.slope_at = kink_at;
  }
  constexpr double d = 1e-4;
  for (int k = 0; k < steps; k += 7) {
    const double x = from + (k + 0.5) * h;
    const auto e = [&](double by) { return path(x + by).energy; };
    const double numeric = (8 * (e(d) - e(-d)) - (e(2 * d) - e(-2 * d))) / (12 * d);
    out.gradient = std::max(out.gradient, std::fabs(numeric - path(x).slope) / out.steepest);
  }
  return out;
}

// --- A second implementation of the paper law, as published ---

// Centre line against the bisector of the axes, and the angle between these, both by arc cosines.
double published_energy(const PaperContact& c, const Vector3& separation, const Vector3& ni, const Vector3& nj) {
  const double r = separation.norm();
  // Axes have no direction: the bisector of the smaller angle.
  const Vector3 bisector = (ni.dot(nj) >= 0 ? Vector3(ni + nj) : Vector3(ni - nj)).normalized();
  const double theta = std::acos(separation.dot(bisector) / r), gamma = std::acos(ni.dot(nj));
  double big_theta = 1;
  for (int i = 1; i <= 5; ++i)
    big_theta += c.angular[static_cast<std::size_t>(i - 1)] * ((i % 2 ? 1 : -1) + std::cos(2 * i * theta));
  const double d = r / (c.radius * big_theta) - 2;
  const double ratio = std::max(r / c.radius, c.freeze),
               k = std::max((r / c.radius - c.switch_start), 0.0) / (c.cutoff_ratio - c.switch_start);
  const double crossing = 1 + c.crossing * std::pow(ratio, c.delta) * (1 - std::cos(2 * gamma));
  return crossing * (1 - k * k * (3 - 2 * k)) * 4 * c.epsilon *
         (c.repulsion / std::pow(d, c.alpha) - c.attraction / std::pow(d, c.beta));
}

Interaction line_interaction(const ParameterSet& set) {
  Interaction in;
  in.law = line_law({line_contact_of(set)});
  return in;
}

Interaction paper_interaction(const ParameterSet& set, bool legacy) {
  Interaction in;
  in.law = paper_law(*set.law<PaperContact>(), legacy);
  return in;
}

struct Named {
  std::string name;
  Path path;
  double from, to;
};

// All paths for one law.
void check_law(const std::string& law, const std::vector<Named>& paths, CaseResult& result) {
  bool finite = true;
  double gradient = 0, jump = 0, kink = 0, highest = 0;
  std::string where, kink_where;
  for (const Named& n : paths) {
    const Smoothness s = smoothness(n.path, n.from, n.to, 900);
    finite = finite && s.finite;
    gradient = std::max(gradient, s.gradient);
    highest = std::max(highest, s.highest);
    if (s.energy_jump >= jump) jump = s.energy_jump, where = fmt::format("{} at {:.4g}", n.name, s.energy_at);
    if (s.slope_jump / s.steepest >= kink)
      kink = s.slope_jump / s.steepest, kink_where = fmt::format("{} at {:.4g}", n.name, s.slope_at);
  }
  result.check_absolute(law + ": finite everywhere (1: yes)", finite ? 1 : 0, 1, 0, "",
                        fmt::format("highest energy {:.3g} eV", highest));
  result.check_absolute(law + ": largest jump of the energy", jump, 0, 1e-5, "eV", where);
  result.check_absolute(law + ": largest jump of force or torque", kink, 0, 1e-6, "1",
                        "over the largest on the path; " + kink_where);
  result.check_absolute(law + ": forces against differences of the energy", gradient, 0, 1e-5, "1",
                        "over the largest on the path");
}

// `overlap`: the smallest distance of the centres of two elements in one line.
std::vector<Named> paths_of(RigidTubes& rows, RigidTubes& single, double spacing, double overlap) {
  const double right = 0.5 * units::pi;
  const Vector3 x = Vector3::UnitX(), z = Vector3::UnitZ(), none = Vector3::Zero();
  return {{"rows turned in the well (rad)", turning(rows, {spacing, 0.1, 0.3}), -0.1, right + 0.2},
          {"rows turned, pressed by 0.1 nm (rad)", turning(rows, {spacing - 0.1, 0.1, 0.3}), -0.1, right + 0.2},
          {"elements turned, one above the other (rad)", turning(single, {0.6 * spacing, 0.5, 0.9 * spacing}), -0.1,
           right + 0.2},
          {"one axis, nose to nose (nm)", shifting(single, none, z, 0), overlap, 3.2},
          // Off the axis by as much as keeps the middle node from meeting another one: see check_coinciding_nodes.
          {"close to one axis, turned to a right angle (nm)", shifting(single, 0.05 * x, z, right), 1e-3, 3.2},
          {"parallel, one through the other (nm)", shifting(single, none, x, 0), 1e-3, 3.2},
          {"crossed, one through the other (nm)", shifting(single, none, x, right), 1e-3, 3.2}};
}

void check_published_jump(const ParameterSet& model, const ParameterSet& oracle, CaseResult& result) {
  PaperContact published = *model.law<PaperContact>();
  published.bisector_blend = 1e-12;
  ParameterSet sharp = model;
  sharp.laws[PaperContact::law] = published;
  RigidTubes pair(sharp, paper_interaction(sharp, false), 1);
  const Vector3 centre(1.9, 0.4, 0.9);
  const Path path = turning(pair, centre);
  const double right = 0.5 * units::pi;
  const auto [jump, at] = largest_jump([&](double g) { return path(g).energy; }, right - 0.2, right + 0.3);
  const auto by_hand = [&](double angle) {
    return published_energy(*oracle.law<PaperContact>(), centre, Vector3::UnitZ(),
                            {0, -std::sin(angle), std::cos(angle)});
  };
  const double theory = std::fabs(by_hand(right + 1e-9) - by_hand(right - 1e-9));
  result.check_relative("published form: angle at which it jumps", at * units::rad_in_degree, 90, 1e-4, "degrees",
                        "the bisector changes to the other pair of angles");
  result.check_relative("published form: height of the jump", jump, theory, 0.05, "eV",
                        "one pair, against a second implementation of the published form");
  result.limits.push_back({"angle at which the published law jumps", at * units::rad_in_degree, 90, "degrees",
                           Limit::Guard::none, "not needed: blended within 10 degrees, with exact forces"});
}

// Two elements in one line, shifted by one spacing of their nodes: all nodes but one coincide, and their forces
// change sign as they pass. Theory is u'(0) of the parabola that continues u below the core gap.
void check_coinciding_nodes(RigidTubes& single, const ParameterSet& oracle, CaseResult& result) {
  const LineContact law = line_contact_of(oracle);
  const LineDensity& u = law.density;
  const double spacing = law.length_i / law.nodes_i, x = u.core_gap + u.c;
  const double rep = u.K * std::pow(u.s / x, u.p), att = u.K * std::pow(u.s / x, u.q);
  const double first = (u.q * att - u.p * rep) / x,
               second = (u.p * (u.p + 1) * rep - u.q * (u.q + 1) * att) / (x * x);
  const double at_zero = first - second * (u.core_gap + u.contact);
  const double theory = 2 * (law.nodes_i - 1) * spacing * spacing * std::fabs(at_zero);
  const Path path = shifting(single, Vector3::Zero(), Vector3::UnitZ(), 0);
  const double at = largest_jump([&](double z) { return path(z).slope; }, 0.8 * spacing, 1.3 * spacing).second;
  // The distance of two nodes is rounded off at 1e-6 nm.
  const double jump = std::fabs(path(at + 1e-5).slope - path(at - 1e-5).slope);
  single.put({0, 0, at}, 0);
  result.check_relative("line law, tubes inside one another in one line: shift at which nodes coincide", at,
                        spacing, 1e-3, "nm", "place of the largest jump of the force");
  result.check_relative("line law, nodes that coincide: jump of the force", jump, theory, 0.05, "eV/nm",
                        fmt::format("at an energy of {:.3g} eV", single.energy()));
  result.limits.push_back({"jump of the line law's force where nodes coincide", jump, theory, "eV/nm",
                           Limit::Guard::refused, "elements that overlap at the start; a run stops long before"});
}

CaseFigure figure_of(RigidTubes& line_rows, RigidTubes& paper_rows, const ParameterSet& line, double line_at,
                     double paper_at) {
  std::vector<double> angle, by_line, by_paper;
  for (int degrees = 0; degrees <= 90; degrees += 3) {
    angle.push_back(degrees);
    line_rows.put({line_at, 0, 0}, degrees * units::degree);
    by_line.push_back(line_rows.energy());
    paper_rows.put({paper_at, 0, 0}, degrees * units::degree);
    by_paper.push_back(paper_rows.energy());
  }
  const double crossed = line_crossed_energy(line.law<LineParameters>()->density, line_at, 0.5 * units::pi);
  return case_figure("Energy of two crossing tubes", {"crossing angle", "degrees"}, {"energy", "eV"},
                     "Two tubes of nine elements that cross in the middle, at the distance of two parallel ones.",
                     {theory_curve("endless tubes, E90/sin", 12, 90,
                                   [&](double d) { return crossed / std::sin(d * units::degree); }),
                      model_points("line law", angle, by_line, 0), model_points("paper law", angle, by_paper)});
}

CaseResult run(const CaseContext& context) {
  const ParameterSet line = context.model(0), paper = context.model(1);
  const ParameterSet line_oracle = context.set(0), paper_oracle = context.set(1);
  const double line_at = line_parallel_well(line_oracle.law<LineParameters>()->density).distance, paper_at = 1.713;
  RigidTubes line_rows(line, line_interaction(line), 9), line_single(line, line_interaction(line), 1);
  const Interaction published = paper_interaction(paper, context.fault.missing_torque);
  RigidTubes paper_rows(paper, published, 9), paper_single(paper, published, 1);
  CaseResult result;
  check_law("line law", paths_of(line_rows, line_single, line_at, 0.9 * line_oracle.element_length), result);
  check_law("paper law", paths_of(paper_rows, paper_single, paper_at, 1e-3), result);
  const double right = 0.5 * units::pi;
  line_rows.put({line_at, 0, 0}, right);
  const double crossed = line_crossed_energy(line_oracle.law<LineParameters>()->density, line_at, right);
  result.check_relative("line law: energy at 90 degrees", line_rows.energy(), crossed, 0.01, "eV",
                        "nine elements against the closed integral of endless tubes");
  check_coinciding_nodes(line_single, line_oracle, result);
  check_published_jump(paper, paper_oracle, result);
  result.figures.push_back(figure_of(line_rows, paper_rows, line_oracle, line_at, paper_at));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-crossing";
  c.order = 70;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.only_these = "it compares the contact laws of two shipped sets";
  c.run = run;
  c.turns_red = {wrong_contact(2), without_torque()};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::crossing
