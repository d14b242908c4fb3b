#include "core/checks.hpp"

#include <utility>

namespace ropewalk::validate {

Check relative_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note) {
  Check c;
  c.name = std::move(name);
  c.value = value;
  c.reference = reference;
  c.tolerance = tolerance;
  c.unit = std::move(unit);
  c.note = std::move(note);
  return c;
}

Check absolute_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note) {
  Check c = relative_check(std::move(name), value, reference, tolerance, std::move(unit), std::move(note));
  c.relative = false;
  return c;
}

Check information(Check check) {
  check.informative = true;
  return check;
}

ChartLine theory_curve(std::string name, const std::function<double(double)>& curve, double from, double to,
                       int colour) {
  ChartLine line;
  line.name = std::move(name);
  line.colour = colour;
  for (int k = 0; k <= 100; ++k) {
    line.x.push_back(from + 0.01 * k * (to - from));
    line.y.push_back(curve(line.x.back()));
  }
  return line;
}

ChartLine model_points(std::string name, std::vector<double> x, std::vector<double> y, int colour) {
  ChartLine line;
  line.name = std::move(name);
  line.x = std::move(x);
  line.y = std::move(y);
  line.colour = colour;
  line.points = true;
  return line;
}

}  // namespace ropewalk::validate
