// The critical moment of a twisted shaft.
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::greenhill {
namespace {

enum class Ends { pinned, clamped };

// tan x = x: the clamped rod buckles at M L/2 EI = x.
constexpr double clamped_root = 4.493409457909064;

double lowest_under_moment(const ParameterSet& set, int bonds, Ends ends, double moment) {
  Chain c(set, bonds);
  const double twist = std::asin(moment * set.element_length / set.bond.twist);
  std::vector<int> freedoms;
  for (int i = 0; i <= bonds; ++i) {
    c.state.orientation.set(static_cast<std::size_t>(i), turn_about(Vector3::UnitZ(), i * twist));
    const bool inner = i > 0 && i < bonds;
    for (const int k : {0, 1})
      if (inner) freedoms.push_back(6 * i + k);
    for (const int k : {3, 4})
      if (inner || ends == Ends::pinned) freedoms.push_back(6 * i + k);
  }
  return lowest_eigenvalue(tangent_stiffness(set.bond, set.element_length, c.state, freedoms));
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  refuse_slip(oracle, 2 * clamped_root * oracle.bond.bend / (16 * oracle.element_length));
  CaseResult result;
  CaseFigure figure = case_figure("Critical twisting moment against length", {"length", "nm"}, {"moment", "eV"},
                                  "Moment at which the twisted straight chain loses its lateral stiffness.");
  for (const Ends ends : {Ends::pinned, Ends::clamped}) {
    const bool pinned = ends == Ends::pinned;
    const std::string name = pinned ? "pinned" : "clamped";
    const double factor = pinned ? 2 * units::pi : 2 * clamped_root;
    const auto greenhill = [&](double length) { return factor * oracle.bond.bend / length; };
    std::vector<double> lengths, moments;
    for (const int bonds : {16, 20, 24, 30, 40}) {
      const double length = bonds * model.element_length, expected = greenhill(length);
      const double most = std::min(2.0 * expected, 0.99 * model.bond.twist / model.element_length);
      lengths.push_back(length);
      moments.push_back(
          zero_between([&](double m) { return lowest_under_moment(model, bonds, ends, m); }, 0.5 * expected, most));
    }
    result.check_relative("critical moment, " + name + ", 40 bonds", moments.back(), greenhill(lengths.back()),
                          2e-2, "eV", "a bond twists by 0.15 to 0.3 rad, whose cosine is 1 to 4 % below one");
    figure.chart.lines.push_back(theory_curve(pinned ? "2 pi EI/L" : "8.987 EI/L", lengths.front(), lengths.back(),
                                              pinned ? 0 : 2, greenhill));
    figure.chart.lines.push_back(model_points(name + " chain", lengths, moments, pinned ? 1 : 3));
  }
  result.figures.push_back(figure);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "greenhill";
  c.order = 30;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::greenhill
