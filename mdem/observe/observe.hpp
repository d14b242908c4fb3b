// Geometry of a twisted rope. Everything is computed from Topology and State alone, so that `observe` on stored
// frames gives the numbers that the run logged.
//
// Centre line C(s): mean position of the elements of equal index s over all strands. A strand is a tube, or a row
// of tubes in line (TubeGroups::strand_begin); sections follow the material. Strands of unequal numbers of elements
// have no centre line: only the quantities of single tubes are then given, physical twist and the counts of bonds.
// Its tangent is the local rope axis. Twists and windings are positive where they are right-handed.
//
// Ropes that are plied (TubeGroups::rope_begin) have a centre line each, and C is the axis of them all. Twist angle
// beta, neighbours, Q and voids are those of each rope by itself: as if it stood alone.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "model/parameters.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// A bond so long has broken: no tube bears such a strain. Stored frames do not tell otherwise.
inline bool has_parted(const TubeType& type, const Vector3& bond) {
  return bond.norm() > 1.5 * type.element_length;
}

// The internal and the outermost strands, from the untwisted state.
struct RopeShells {
  std::vector<char> internal;   // is enclosed by triangles of neighbours that leave no room for a tube
  std::vector<char> outermost;  // not internal
};

struct CrossSection {
  std::vector<Eigen::Vector2d> points;  // tube positions in the plane normal to the local rope axis, nm
  std::vector<double> radii;            // radii of the tubes, nm
  std::vector<int> neighbours;          // neighbours in order of distance
  std::vector<int> delaunay;            // by Delaunay triangulation of `points`
  int charge = 0;                       // Q = sum over internal tubes of 6 - neighbours
  int charge_delaunay = 0;              // by `delaunay`; in-plane distances mislead it beyond beta = 54 degrees
  int contacts = 0;                     // pairs of neighbours by distance
  int voids = 0;                        // closed groups of triangles too wide for a packed rope: voids.hpp
  double void_area = 0;                 // nm^2, their area less that of the same number of packed triangles
};

struct RopeObservation {
  double beta = 0;              // rad: mean angle of the outermost tubes to the local axis, middle third
  double physical_twist = 0;    // rad: sum of bond twist angles along a tube, against the natural ones; mean over tubes
  double geometric_twist = 0;   // rad: rotation of the tubes about the centre line, end to end, mean over the
                                // tubes that stay away from it; the writhe of a bent rope does not enter
  double ply_angle = 0;         // rad: of the centre lines of plied ropes to C, right-handed positive, middle third
  double radius_mid = 0;        // nm: outer radius (largest axis distance + r) of the middle section
  double radius_end = 0;        // nm: mean of the two end sections
  double length = 0;            // nm: arc length of the centre line
  double amplitude = 0;         // nm: largest distance of the centre line from its chord
  double middle_amplitude = 0;  // nm: the same of its middle 80 %, which open ends do not move
  double writhe = 0;            // turns: centre_line.hpp
  double turned_back = 0;       // the part of its length that runs against the chord
  double windings = 0;          // turns of the centre line about its chord (helix), mean rate times length;
                                // 0 where the amplitude is below one spacing
  double helix_radius =
      std::numeric_limits<double>::quiet_NaN();             // nm: LineHelix of the centre line; nan where the
  double pitch = std::numeric_limits<double>::quiet_NaN();  // amplitude is below one spacing
  std::vector<double> radius_profile;                       // nm: outer radius, per element index
  std::vector<Vector3> centre_line;                         // nm
  CrossSection middle;
  int kinked = 0;                 // bonds whose curvature exceeds the set's kink limit
  int overtwisted = 0;            // bonds whose r * twist per length exceeds the set's limit
  int overstretched = 0;          // bonds whose strain exceeds the set's limit
  double largest_bond_twist = 0;  // rad, absolute
};

// spacing: of the untwisted rope, nm. neighbour_radius: nm; 0 means spacing (1 + sqrt 3)/2. Shells are determined
// in the middle section, with the median distance of a tube to its nearest neighbour as the spacing.
RopeShells rope_shells(const Topology& topology, const State& reference, double neighbour_radius);

// section: element index; distances between tubes are the smallest between elements section-1 .. section+1.
CrossSection cross_section(const Topology& topology, const State& state, const RopeShells& shells, int section,
                           double neighbour_radius, double spacing);

RopeObservation observe(const Topology& topology, const State& state, const RopeShells& shells,
                        const std::vector<Validity>& validity, double neighbour_radius, double spacing);

}  // namespace ropewalk
