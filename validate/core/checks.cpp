#include "core/checks.hpp"

#include <utility>

namespace ropewalk::validate {

void CaseResult::check_relative(std::string name, double value, double reference, double tolerance,
                                std::string unit, std::string note) {
  Check c;
  c.name = std::move(name);
  c.value = value;
  c.reference = reference;
  c.tolerance = tolerance;
  c.unit = std::move(unit);
  c.note = std::move(note);
  checks.push_back(std::move(c));
}

void CaseResult::check_absolute(std::string name, double value, double reference, double tolerance,
                                std::string unit, std::string note) {
  check_relative(std::move(name), value, reference, tolerance, std::move(unit), std::move(note));
  checks.back().relative = false;
}

void CaseResult::show_relative(std::string name, double value, double reference, double tolerance, std::string unit,
                               std::string note) {
  check_relative(std::move(name), value, reference, tolerance, std::move(unit), std::move(note));
  checks.back().informative = true;
}

void CaseResult::show_absolute(std::string name, double value, double reference, double tolerance, std::string unit,
                               std::string note) {
  check_absolute(std::move(name), value, reference, tolerance, std::move(unit), std::move(note));
  checks.back().informative = true;
}

CaseFigure case_figure(std::string title, ChartAxis x, ChartAxis y, std::string caption,
                       std::vector<ChartLine> lines) {
  return {{std::move(title), std::move(x), std::move(y), std::move(lines), {}}, std::move(caption)};
}

void CaseResult::figure(std::string title, ChartAxis x, ChartAxis y, std::string caption,
                        std::vector<ChartLine> lines) {
  figures.push_back(
      case_figure(std::move(title), std::move(x), std::move(y), std::move(caption), std::move(lines)));
}

ChartLine theory_curve(std::string name, double from, double to, int colour,
                       const std::function<double(double)>& curve) {
  ChartLine line{std::move(name), {}, {}, colour};
  for (int k = 0; k <= 100; ++k) {
    line.x.push_back(from + 0.01 * k * (to - from));
    line.y.push_back(curve(line.x.back()));
  }
  return line;
}

ChartLine theory_curve(std::string name, double from, double to, const std::function<double(double)>& curve) {
  return theory_curve(std::move(name), from, to, 0, curve);
}

ChartLine model_points(std::string name, std::vector<double> x, std::vector<double> y, int colour) {
  ChartLine line{std::move(name), std::move(x), std::move(y), colour};
  line.points = true;
  return line;
}

}  // namespace ropewalk::validate
