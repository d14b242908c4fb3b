// A vector of three numbers with the operations of the bond energy, for loops over elements that GCC 12 does not
// vectorise with Eigen's expressions.
#pragma once

namespace ropewalk {

struct PlainVector {
  double x, y, z;

  friend PlainVector operator+(PlainVector a, PlainVector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend PlainVector operator-(PlainVector a, PlainVector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend PlainVector operator*(double s, PlainVector a) { return {s * a.x, s * a.y, s * a.z}; }
  friend PlainVector operator/(PlainVector a, double s) { return {a.x / s, a.y / s, a.z / s}; }
  PlainVector& operator+=(PlainVector b) { return *this = *this + b; }
  PlainVector operator-() const { return {-x, -y, -z}; }
  double dot(PlainVector b) const { return x * b.x + y * b.y + z * b.z; }
  PlainVector cross(PlainVector b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
  double squaredNorm() const { return dot(*this); }
};

}  // namespace ropewalk
