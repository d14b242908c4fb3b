// A value prescribed over time by a list of points. Between two points the value changes evenly. Before the first
// point and after the last one the value is constant.
//
// A corner is a jump of the speed, which sends a wave along the rope. With smooth > 0 (ps) the speed changes evenly
// over that time instead, at most over half of the line. Every point is still met at its time: at a reversal, at a
// hold and at either end the speed is zero there, and otherwise that of the slower of the two lines.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace ropewalk {

class Schedule {
 public:
  struct Point {
    double time = 0;  // ps
    double value = 0;
  };

  Schedule() = default;  // zero at all times
  // Times rise from one point to the next.
  explicit Schedule(std::vector<Point> points, double smooth = 0);

  static Schedule always(double value) { return Schedule({{0, value}}); }

  double value(double time) const;
  double rate(double time) const;  // per ps

  const std::vector<Point>& points() const { return points_; }
  double ends() const { return points_.empty() ? 0.0 : points_.back().time; }  // ps
  bool constant() const;                                                       // the same at all times
  double first() const { return points_.empty() ? 0.0 : points_.front().value; }
  double last() const { return points_.empty() ? 0.0 : points_.back().value; }
  double largest() const;  // largest absolute value
  double fastest() const;  // largest absolute rate between two points
  // The first time at which the absolute value is this part of the largest one, along straight lines.
  double reaches(double part = 1) const;
  double leaves() const;  // ps, the last time at which it has the largest
  // Whether the last value is the largest.
  bool stays() const { return std::fabs(last()) >= largest(); }

 private:
  // Between two points: from the speed `enter` to `along` in the time `smooth`, and on to `leave` in the last of
  // it.
  struct Line {
    double begin = 0, length = 0, from = 0;
    double enter = 0, along = 0, leave = 0, smooth = 0;

    double value(double time) const;
    double rate(double time) const;
  };
  const Line* at(double time) const;  // null before the first and after the last point

  std::vector<Point> points_;
  std::vector<Line> lines_;
};

// The sum, with sharp corners, each schedule times its factor.
struct ScheduleTerm {
  double factor = 1;
  Schedule schedule;
};
Schedule sum_of(const std::vector<ScheduleTerm>& terms);

// Its values in order: "300", or "300 to 400 to 300".
std::string words_of(const Schedule& schedule);

}  // namespace ropewalk
