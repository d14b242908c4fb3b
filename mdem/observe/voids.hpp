// Voids of a cross-section: places where the packing is open although tubes close it off from outside.
//
// The rule. A triangle of the Delaunay triangulation is wide if its circumradius exceeds 1.35 times that of a
// packed triangle, spacing/sqrt 3. Two tubes leave a passage between them if they are farther apart than
// spacing (1 + sqrt 3)/2, midway between touching and second neighbours. Wide triangles that share a passage
// form one void; a group with a passage on the convex hull lies open to the outside, is a bay of the outline
// (or a sliver along a straight side) and no void. So a vacancy just below the surface counts although slivers
// adjoin it beyond the two tubes that close it, and a missing corner tube does not.
//
// Lengths are taken normal to the tubes: a triangle is projected along the mean tangent of its three tubes
// before it is measured. In the plane itself tubes in contact at a twist angle beta are 1/cos beta apart along
// the azimuth, which would make voids of perfect packing from about 50 degrees on. This is the metric of
// Bruss and Grason, PNAS 109, 10781 (2012), DOI 10.1073/pnas.1205606109.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/bond.hpp"
#include "observe/delaunay.hpp"

namespace ropewalk {

struct Voids {
  int count = 0;
  // nm^2, above that of as many packed triangles with the mean side of the void, at most the spacing; one missing
  // tube: sqrt(3)/2 spacing^2. Never negative.
  double area = 0;
};

// points: in coordinates whose z is the rope axis (z = 0 in the section); tangents: unit vectors, same axes.
Voids find_voids(const std::vector<Triangle>& triangles, const std::vector<Vector3>& points,
                 const std::vector<Vector3>& tangents, double spacing);

}  // namespace ropewalk
