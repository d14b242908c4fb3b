#include "scene/film_tube.hpp"

#include <algorithm>
#include <limits>

#include "model/units.hpp"

namespace ropewalk {
namespace {

struct Corner {
  double x = 0, y = 0;
};

double squared(double x) { return x * x; }

double from_segment2(const Corner& p, const Corner& a, const Corner& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double along = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
  const double t = std::min(std::max(along, 0.0), 1.0);
  return squared(p.x - a.x - t * dx) + squared(p.y - a.y - t * dy);
}

// Twice the area of a triangle, positive where it is counter-clockwise.
double area(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Footprint {
  Corner from, to;

  Footprint(const FilmTube& t, double length) {
    const double x = 0.5 * length * std::cos(t.angle), y = 0.5 * length * std::sin(t.angle);
    from = {t.x - x, t.y - y};
    to = {t.x + x, t.y + y};
  }
};

double distance2(const Footprint& a, const Footprint& b) {
  if (area(a.from, a.to, b.from) * area(a.from, a.to, b.to) < 0 &&
      area(b.from, b.to, a.from) * area(b.from, b.to, a.to) < 0)
    return 0;
  return std::min({from_segment2(a.from, b.from, b.to), from_segment2(a.to, b.from, b.to),
                   from_segment2(b.from, a.from, a.to), from_segment2(b.to, a.from, a.to)});
}

constexpr double none = -std::numeric_limits<double>::infinity();

// A support of a tube: how high the middle of the tube must be for it, and where along the tube it is, from the
// middle.
struct Support {
  double height = none, along = 0;  // nm
};

// Where a point that sinks at x, y comes to lie on a rod with round ends, whose middle is the origin. `along` is
// the place on the axis of the rod.
Support on_rod(double x, double y, const Vector3& axis, double half, double radius) {
  const double cosine2 = axis.x() * axis.x() + axis.y() * axis.y();
  const double beside = (x * axis.x() + y * axis.y()) / cosine2;
  const double room = radius * radius - squared(x - beside * axis.x()) - squared(y - beside * axis.y());
  if (!(room > 0)) return {};
  const double along = std::clamp(beside + axis.z() * std::sqrt(room / cosine2), -half, half);
  const double rise2 = room - cosine2 * squared(along - beside);
  if (!(rise2 > 0)) return {};
  return {along * axis.z() + std::sqrt(rise2), along};
}

// That of a tube of direction u, with its middle above the origin, on another one of direction v at o. In turn: one
// axis across the other; an end of the tube on the other; an end of the other one under the tube.
Support support(const Vector3& u, const Vector3& o, const Vector3& v, double half, double spacing) {
  const Vector3 normal = u.cross(v);
  const Vector3 up = normal * (std::copysign(spacing, normal.z()) / normal.norm());
  const double s = ((o.x() + up.x()) * v.y() - (o.y() + up.y()) * v.x()) / normal.z();
  const double t = ((o.x() + up.x()) * u.y() - (o.y() + up.y()) * u.x()) / normal.z();
  if (std::fabs(s) <= half && std::fabs(t) <= half) return {o.z() + t * v.z() + up.z() - s * u.z(), s};
  Support highest;
  const auto take = [&](double height, double along) {
    if (height > highest.height) highest = {height, along};
  };
  for (const double end : {-half, half}) {
    take(o.z() + on_rod(end * u.x() - o.x(), end * u.y() - o.y(), v, half, spacing).height - end * u.z(), end);
    const Vector3 under = o + end * v;
    const Support mirrored = on_rod(under.x(), under.y(), {u.x(), u.y(), -u.z()}, half, spacing);
    take(under.z() + mirrored.height, mirrored.along);
  }
  return highest;
}

}  // namespace

double projected_distance2(const FilmTube& a, const FilmTube& b, double length) {
  return distance2(Footprint(a, length), Footprint(b, length));
}

// The highest of all supports counts. While it is on the right, the right end can rise and the middle sinks: the
// tilt follows by bisection.
void let_down(FilmTube& tube, const std::vector<FilmTube>& others, double length, double spacing) {
  const double half = 0.5 * length;
  const auto highest = [&](double tilt) {
    tube.tilt = tilt;
    const Vector3 axis = tube.axis(), origin(tube.x, tube.y, 0);
    Support found{half * std::fabs(axis.z()), tilt == 0 ? 0 : std::copysign(half, -tilt)};  // the plane
    for (const FilmTube& other : others) {
      const Support on = support(axis, other.middle() - origin, other.axis(), half, spacing);
      if (on.height > found.height) found = on;
    }
    return found;
  };
  double low = -0.5 * units::pi, high = 0.5 * units::pi;
  while (high - low > 1e-13) {
    const double tilt = 0.5 * (low + high), along = highest(tilt).along;
    if (along >= 0) low = tilt;
    if (along <= 0) high = tilt;
  }
  const double on_low = highest(low).height, on_high = highest(high).height;
  tube.tilt = on_low < on_high ? low : high;
  tube.z = std::min(on_low, on_high);
}

}  // namespace ropewalk
