// How long elements may be, and how far apart the nodes of the contact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "scene/build.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk::validate::element_length {
namespace {

// --- Curvature: a tube bent by couples at its ends ---

constexpr int bonds = 4;

// Angle of a bond (rad) in a tube at rest under the moment m EI/a.
double bend_of_bond(const ParameterSet& set, double m) {
  Chain c(set, bonds);
  c.loads.add(FixLoad({0}));
  c.loads.add(TorqueLoad({c.last}, Vector3(m * set.bond.bend / set.element_length, 0, 0)));
  const State s = c.relaxed(1e-7).state();
  const Vector3 first = axis_of(s.orientation[0]), last = axis_of(s.orientation[static_cast<std::size_t>(bonds)]);
  return std::atan2(first.cross(last).norm(), first.dot(last)) / bonds;
}

// The angle per bond at which moment over curvature differs from the rod's EI by the fraction `allowed`.
double bend_limit(const ParameterSet& model, const ParameterSet& oracle, double allowed) {
  const double over = model.bond.bend / oracle.bond.bend;
  const auto fails = [&](double m) { return std::fabs(m * over / bend_of_bond(model, m) - 1) > allowed; };
  const double m = limit_between(fails, 0.02, 0.85, 2e-3);
  return std::isnan(m) ? m : bend_of_bond(model, m);
}

// That difference for a polygon, whose chords lie at half the angle to both axes: dU/d(delta) of a bond over delta
// EI/a, minus 1.
double polygon_error(double shear_share, double delta) {
  const double shear = 24 * shear_share * std::pow(std::sin(delta / 4), 3) * std::cos(delta / 4);
  return (std::sin(delta) + shear) / delta - 1;
}

double polygon_limit(const ParameterSet& set, double allowed) {
  // The share of shear in a Timoshenko beam: s = 1/(1 + 12 EI/(kGA a^2)), 1 where it does not shear.
  const double a = set.element_length, kGA = set.bond.shear;
  const double share = kGA > 0 ? 1 / (1 + 12 * set.bond.bend / (kGA * a * a)) : 1;
  return limit_between([&](double d) { return std::fabs(polygon_error(share, d)) > allowed; }, 0.02, 1.0, 1e-5);
}

void check_bending(const CaseContext& context, CaseResult& result) {
  struct Tube {
    std::size_t set;
    double factor;
  };
  for (const Tube& t : {Tube{0, 1}, Tube{0, 4}, Tube{1, 1}})
    for (const double allowed : {0.01, 0.05}) {
      const ParameterSet model = with_elements(context.model(t.set), t.factor),
                         oracle = with_elements(context.set(t.set), t.factor);
      const double found = bend_limit(model, oracle, allowed), theory = polygon_limit(oracle, allowed);
      const std::string name = fmt::format("bend of an element of {:.2f} nm ({}) for {:.0f} % in EI",
                                           oracle.element_length, oracle.name, 100 * allowed);
      result.check_relative(name, found, theory, 0.05, "rad", "curvature times element length");
      if (t.factor == 1 && allowed < 0.02)
        result.limits.push_back({fmt::format("curvature times element length, 1 % in EI, {}", oracle.name), found,
                                 theory, "rad", Limit::Guard::told,
                                 "elements so long that they pass this before the tube kinks"});
    }
}

CaseFigure bending_figure(const CaseContext& context) {
  CaseFigure figure =
      case_figure("Error of the bending stiffness", {"curvature times element length", "rad"}, {"error", "%"},
                  "Moment over curvature against `EI`. Bonds without shear (paper) stiffen, bonds with shear "
                  "soften. The curve is the leading term; the checks use the whole expression.");
  int colour = 0;
  for (const CaseTube& tube : context.tubes()) {
    const ParameterSet &model = tube.model, &oracle = tube.set;
    std::vector<double> angle, error;
    for (double m = 0.1; m < 0.8; m += 0.1) {
      angle.push_back(bend_of_bond(model, m));
      error.push_back(100 * (m * model.bond.bend / oracle.bond.bend / angle.back() - 1));
    }
    const double share = shear_share(oracle.bond, oracle.element_length);
    figure.chart.lines.push_back(theory_curve(fmt::format("(3 s/8 - 1/6) d^2, {}", oracle.name), 0, angle.back(),
                                              colour,
                                              [&](double d) { return 100 * (0.375 * share - 1.0 / 6) * d * d; }));
    figure.chart.lines.push_back(model_points("chain at rest", angle, error, colour));
    ++colour;
  }
  return figure;
}

// --- Corrugation: one element that slides along a row ---

// Energy (eV) of one element beside a long row, shifted along it.
class Slide {
 public:
  Slide(Interaction interaction, ParameterSet set, double element_length, double distance)
      : in_(std::move(interaction)), a_(element_length), distance_(distance) {
    set.element_length = element_length;
    topology_ = straight_tubes(set, 1).topology;
    reach_ = static_cast<int>(in_.cutoff() / a_) + 2;
    topology_.add_tube(2 * reach_ + 1);  // no scene has a tube and a longer row beside it
  }
  double energy(double shift) const {
    State s(static_cast<std::size_t>(topology_.elements()));
    s.position.set(0, {0, 0, shift});
    for (int k = -reach_; k <= reach_; ++k)
      s.position.set(static_cast<std::size_t>(k + reach_ + 1), {distance_, 0, k * a_});
    NeighbourList list(in_, 0.1);
    list.build(topology_, s);
    ForceEngine engine;
    Forces f(s.size());
    engine.compute(topology_, in_, list, s, f);
    return f.energy.vdw;
  }
  // Highest minus lowest energy per length (eV/nm) over a period.
  double corrugation(double period) const {
    double low = 1e9, high = -1e9;
    for (int k = 0; k < 8; ++k) {
      const double e = energy(period * k / 8) / a_;
      low = std::min(low, e);
      high = std::max(high, e);
    }
    return high - low;
  }

 private:
  Interaction in_;
  Topology topology_;
  double a_ = 0, distance_ = 0;
  int reach_ = 0;
};

constexpr int nodes = 4;  // on each element: their spacing follows from its length

double line_corrugation(const ParameterSet& set, double spacing, double distance) {
  Interaction in;
  const double a = nodes * spacing;
  in.law = line_law({{set.law<LineParameters>()->density, a, a, nodes, nodes}});
  return Slide(in, set, a, distance).corrugation(spacing);
}

double paper_corrugation(const ParameterSet& set, double length, double distance) {
  Interaction in;
  in.law = paper_law(*set.law<PaperContact>());
  return Slide(in, set, length, distance).corrugation(length);
}

// Poisson's summation formula: the energy of a row of period d has the Fourier transform F of one pair's energy at
// the multiples of 2 pi/d. The first of them sets the corrugation, 4 F(2 pi/d) per length.
double transform(const std::function<double(double)>& pair, double reach, double wave) {
  return 2 * detail::simpson([&](double z) { return pair(z) * std::cos(wave * z); }, 0, reach, 4000);
}

double poisson_corrugation(const std::function<double(double)>& pair, double reach, double period) {
  return 4 * std::fabs(transform(pair, reach, 2 * units::pi / period));
}

std::function<double(double)> line_pair_energy(const ParameterSet& set, double distance) {
  return [d = set.law<LineParameters>()->density, distance](double z) { return d.energy(std::hypot(distance, z)); };
}

void check_nodes(const CaseContext& context, CaseResult& result) {
  const ParameterSet model = context.model(0), oracle = context.set(0);
  const LineWell well = line_parallel_well(oracle.law<LineParameters>()->density);
  const double reach = oracle.law<LineParameters>()->density.cutoff();
  CaseFigure figure = case_figure(
      "Corrugation of a row of nodes", {"tube distance over node spacing", ""},
      {"corrugation over the well", "", false, true},
      "The corrugation falls exponentially with the number of nodes per tube distance. The default spacing is a "
      "seventh of that distance.");
  int colour = 0;
  for (const double inside : {0.0, 0.05}) {
    const double distance = well.distance - inside;
    const auto pair = line_pair_energy(oracle, distance);
    const auto predicted = [&](double d) { return poisson_corrugation(pair, reach, d) / -well.energy; };
    const auto seen = [&](double d) { return line_corrugation(model, d, distance) / -well.energy; };
    const double theory = limit_between([&](double d) { return predicted(d) > 1e-3; }, 0.2, 1.4, 1e-5);
    const double found = limit_between([&](double d) { return seen(d) > 1e-3; }, 0.2, 1.4, 2e-3);
    const std::string where = inside > 0 ? "0.05 nm inside of the well" : "in the well";
    result.check_relative("node spacing over distance for 1e-3, " + where, found / distance, theory / distance,
                          0.05, "", "line law, parallel rows");
    result.limits.push_back({"node spacing over tube distance, corrugation 1e-3, " + where, found / distance,
                             theory / distance, "", Limit::Guard::told,
                             "fewer nodes than 1e-3 takes; the default has more"});
    std::vector<double> at, corrugation;
    for (double d = 0.4; d < 1.05; d += 0.1) {
      at.push_back(distance / d);
      corrugation.push_back(seen(d));
    }
    figure.chart.lines.push_back(theory_curve("Poisson sum, " + where, at.back(), at.front(), colour,
                                              [&](double x) { return predicted(distance / x); }));
    figure.chart.lines.push_back(model_points("sliding element", at, corrugation, colour));
    ++colour;
  }
  result.figures.push_back(figure);
  const int taken = line_nodes(oracle.element_length, well.distance, oracle.law<LineParameters>()->density.contact);
  result.show_absolute("node spacing over distance that `auto` takes",
                       oracle.element_length / taken / well.distance, 0, 0, "",
                       "every row of a scene has this spacing or less");
}

void check_paper(const CaseContext& context, CaseResult& result) {
  const ParameterSet model = context.model(1), oracle = context.set(1);
  const double distance = pair_spacing(*oracle.law<PaperContact>(), oracle.element_length),
               reach = oracle.law<PaperContact>()->cutoff();
  const auto pair = [&](double z) {
    return oracle.law<PaperContact>()->energy({distance, 0, z}, Vector3::UnitZ(), Vector3::UnitZ());
  };
  const double mean = std::fabs(transform(pair, reach, 0));
  const auto predicted = [&](double a) { return poisson_corrugation(pair, reach, a) / mean; };
  const auto seen = [&](double a) { return paper_corrugation(model, a, distance) * a * a / mean; };
  const double set = oracle.element_length;
  for (const bool longer : {true, false}) {
    // As a part of the set's length above or below one.
    const auto limit = [&](const std::function<double(double)>& corrugation) {
      const auto length = [&](double off) { return set * (longer ? 1 + off : 1 - off); };
      return length(limit_between([&](double off) { return corrugation(length(off)) > 1e-2; }, 0, 0.1, 1e-3));
    };
    const double theory = limit(predicted), found = limit(seen);
    const std::string name =
        fmt::format("{} element of the paper law, corrugation 1e-2", longer ? "longest" : "shortest");
    result.check_relative(name, found, theory, 2e-3, "nm", "one point per element");
    result.limits.push_back(
        {name, found, theory, "nm", Limit::Guard::refused, "any element length other than the set's, 1.356 nm"});
  }
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  check_bending(context, result);
  result.figures.push_back(bending_figure(context));
  check_nodes(context, result);
  check_paper(context, result);
  const ParameterSet set = context.set(0);
  result.remarks.push_back(fmt::format(
      "At the curvature at which the tube kinks, {:.3g}/nm, an element of its set is bent by only {:.2f} rad: the "
      "tube fails before its elements do. A run warns of elements so long that this does not hold.",
      set.validity.kink_curvature, set.validity.kink_curvature * set.element_length));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-element-length";
  c.order = 60;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.only_these = "it compares the contact laws of two shipped sets";
  c.run = run;
  c.turns_red = {wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::element_length
