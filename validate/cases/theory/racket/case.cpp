// A tube folded back on itself: two adhering arms and a bent head.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"

namespace ropewalk::validate::racket {
namespace {

constexpr int arm_elements = 20;  // 27 nm of each arm; the contact opens within 5 nm

// The upper half of a head, from where the arms part (s = 0) to the tip on the line of symmetry.
struct ArmPoint {
  double s = 0, x = 0, y = 0;  // nm
  double slope = 0;            // rad
  double curvature = 0;        // 1/nm
};

using Head = std::vector<ArmPoint>;

double contour(const Head& head) { return 2 * head.back().s; }

// Symmetry leaves one component of the force, across the arms: EI k' = -F cos(slope).
Head trace(double curvature, double force_over_bend, double gap) {
  const double ds = 2e-4 / curvature;
  Head head;
  ArmPoint p{0, 0, 0.5 * gap, 0, curvature};
  while (p.slope > -0.5 * units::pi && p.s * curvature < 6) {
    head.push_back(p);
    const double middle = p.slope + 0.5 * ds * p.curvature;
    p.slope += ds * (p.curvature - 0.5 * ds * force_over_bend * std::cos(p.slope));
    p.curvature -= ds * force_over_bend * std::cos(middle);
    p.x += ds * std::cos(middle);
    p.y += ds * std::sin(middle);
    p.s += ds;
  }
  head.push_back(p);
  return head;
}

// Where the arms part, the curvature k is sqrt(Gamma/EI): parting both by ds frees EI k^2 ds and costs Gamma ds.
Head elastica(double bend, double adhesion, double gap) {
  const double k = std::sqrt(adhesion / bend);
  double low = 0.55 * k * k, high = 1.5 * k * k;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (trace(k, middle, gap).back().y < 0 ? high : low) = middle;
  }
  return trace(k, low, gap);
}

double bending(const Head& head, double bend) {  // eV, both halves
  double sum = 0;
  for (std::size_t k = 1; k < head.size(); ++k)
    sum += bend * head[k].curvature * head[k - 1].curvature * (head[k].s - head[k - 1].s);
  return sum;
}

// Attraction of the arms (eV) beyond the point where they part.
double attraction(const Head& head, const WallsIntegral& contact) {
  double sum = 0;
  for (std::size_t k = 1; k < head.size() && head[k].slope > 0; ++k)
    sum += contact.parallel(2 * head[k].y) * (head[k].s - head[k - 1].s);
  return sum;
}

double width(const Head& head) {
  double most = 0;
  for (const ArmPoint& p : head) most = std::max(most, 2 * p.y);
  return most;
}

// Contour around the tip between the places where the arms are this far apart.
double around(const Head& head, double distance) {
  const auto apart = std::find_if(head.begin(), head.end(), [&](const ArmPoint& p) { return 2 * p.y > distance; });
  return 2 * (head.back().s - apart->s);
}

ArmPoint at(const Head& head, double s) {
  if (s <= 0) return {s, s, head.front().y, 0, 0};
  const double step = head[1].s;
  const auto k = std::min(static_cast<std::size_t>(s / step), head.size() - 1);
  return head[k];
}

// A chain along one arm, around the head and back along the other. Its middle is the tip.
Bundle folded(const ParameterSet& set, int elements, const Head& head) {
  Bundle b = line_bundle(set, 1, elements);
  for (int e = 0; e < elements; ++e) {
    const double from_tip = (e - 0.5 * (elements - 1)) * set.element_length, side = from_tip < 0 ? -1 : 1;
    const ArmPoint p = at(head, head.back().s - std::fabs(from_tip));
    const double heading = from_tip < 0 ? -p.slope : units::pi + p.slope;
    const auto i = static_cast<std::size_t>(e);
    b.state.position.set(i, {p.x, side * p.y, 0});
    b.state.orientation.set(i,
                            turn_about(Vector3::UnitZ(), heading) * turn_about(Vector3::UnitY(), 0.5 * units::pi));
  }
  return b;
}

// At rest, either held in its plane, where the oracle holds, or free.
State relaxed(const Bundle& b, const State& start, bool in_plane, Energies& energy) {
  LoadsAndConstraints loads;
  for (int e = 0; in_plane && e < b.topology.elements(); ++e) loads.add(FixLoad({e}, false, false, true, false));
  const Simulation s = at_rest(Simulation(b.topology, b.interaction, loads, start, b.time_step), 1e-5, 150000);
  energy = s.forces().energy;
  return s.state();
}

double apart(const State& state, std::size_t e) {
  return (state.position[e] - state.position[state.size() - 1 - e]).norm();
}

double around(const State& state, double element_length, double distance) {
  const std::size_t half = state.size() / 2;
  std::size_t e = arm_elements / 2;  // away from the ends, within the arms
  while (e < half && apart(state, e + 1) < distance) ++e;
  const double part = (distance - apart(state, e)) / (apart(state, e + 1) - apart(state, e));
  return (static_cast<double>(state.size() - 1) - 2 * (static_cast<double>(e) + part)) * element_length;
}

double width(const State& state) {
  double most = 0;
  for (std::size_t e = 0; e < state.size() / 2; ++e) most = std::max(most, apart(state, e));
  return most;
}

// One arm above the plane and one below, so that the chain can leave it.
State tilted(State state) {
  for (std::size_t e = 0; e < state.size(); ++e) state.position.z[e] = 2 * e < state.size() ? -0.05 : 0.05;
  return state;
}

CaseFigure shape_figure(const Head& head, const State& chain) {
  ChartLine theory;
  theory.name = "elastica";
  for (int side : {1, -1})
    for (std::size_t k = 0; k < head.size(); k += 100) {
      const ArmPoint& p = side > 0 ? head[k] : head[head.size() - 1 - k];
      theory.x.push_back(p.x);
      theory.y.push_back(side * p.y);
    }
  std::vector<double> x, y;
  const double tip = chain.position.x[chain.size() / 2] - head.back().x;
  for (std::size_t e = 0; e < chain.size(); e += 3) {
    x.push_back(chain.position.x[e] - tip);
    y.push_back(chain.position.y[e]);
  }
  return case_figure("Head of a racket", {"along the arms", "nm"}, {"across", "nm"},
                     "The tips are drawn in one place; the arms continue to the left.",
                     {theory, model_points("relaxed chain, every third element", x, y)});
}

CaseFigure curvature_figure(const Head& head, const State& chain, double element_length) {
  ChartLine theory;
  theory.name = "elastica";
  for (std::size_t k = head.size(); k-- > 0;) {
    theory.x.push_back(head.back().s - head[k].s);
    theory.y.push_back(-head[k].curvature);
  }
  const double parting = head.back().s;
  theory.x.insert(theory.x.end(), {parting, 1.15 * parting});
  theory.y.insert(theory.y.end(), {0, 0});
  std::vector<double> s, k;
  for (std::size_t e = chain.size() / 2; e + 1 < chain.size(); ++e) {
    const double from_tip =
        (static_cast<double>(e) + 0.5 - 0.5 * static_cast<double>(chain.size() - 1)) * element_length;
    if (from_tip > 1.15 * parting) break;
    const Vector3 t = axis_of(chain.orientation[e]), u = axis_of(chain.orientation[e + 1]);
    s.push_back(from_tip);
    k.push_back(std::asin(t.cross(u).z()) / element_length);
  }
  return case_figure("Curvature along the tube", {"contour from the tip", "nm"}, {"curvature", "1/nm"},
                     "Theory has a jump to `sqrt(Gamma/EI)` where the arms part; in the chain it spreads over the "
                     "range of the attraction.",
                     {theory, model_points("relaxed chain", s, k)});
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const WallsIntegral contact = surface_integral(oracle);
  const Well pair = contact.parallel_well();
  const double adhesion = -pair.energy, bend = oracle.bond.bend;
  const Head head = elastica(bend, adhesion, pair.distance), start = elastica(0.85 * bend, adhesion, pair.distance),
             closed = elastica(bend, adhesion, 0);
  const int elements = 2 * arm_elements + static_cast<int>(contour(head) / oracle.element_length);
  const Bundle b = folded(model, elements, start);
  Energies energy, lifted_energy;
  const State flat = relaxed(b, b.state, true, energy);
  const State lifted = relaxed(b, tilted(flat), false, lifted_energy);

  const double far = 2 * pair.distance;  // beyond the attraction
  const double before = contour(head) - around(head, far), length = (elements - 1) * model.element_length;
  const std::string soft = "the arms part over the range of the attraction, not in one point: 0.5 % of the energy";
  CaseResult result;
  result.check_relative("contour of the head", around(flat, model.element_length, far) + before, contour(head),
                        1e-2, "nm", soft);
  result.check_relative("width of the head", width(flat), width(head), 1e-2, "nm", soft);
  result.check_relative("energy of the head", energy.bonds(), bending(head, bend), 1e-2, "eV", soft);
  result.check_relative("length above which a racket has less energy than the straight tube",
                        length + 2 * energy.potential() / adhesion,
                        contour(head) + 2 * (bending(head, bend) + attraction(head, contact)) / adhesion, 1e-2,
                        "nm", "as above; ends of the arms: 1 nm");
  result.check_relative("oracle alone: 2 U/Gamma of a head whose arms have no distance",
                        2 * bending(closed, bend) / adhesion, contour(closed), 1e-3, "nm",
                        "`U` goes as 1/contour; at the lowest total energy `U = Gamma contour/2`");
  result.show_relative("contour of the head, free to leave its plane",
                       around(lifted, model.element_length, far) + before, contour(head), 1e-2, "nm",
                       "see the remarks");
  result.figures = {shape_figure(head, flat), curvature_figure(head, flat, model.element_length)};
  result.remarks.push_back(
      fmt::format("The plane racket is not a minimum in space: one arm climbs onto the other, the gap closes, and "
                  "the energy falls from {:.1f} to {:.1f} eV. So the elements are held in the plane.",
                  energy.potential(), lifted_energy.potential()));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "racket";
  c.order = 110;
  c.tier = Case::Tier::full;
  c.run = run;
  c.turns_red = {wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::racket
