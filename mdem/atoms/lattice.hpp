// Atoms of a single-walled tube (n,m) by exact integer arithmetic on the graphene lattice.
//
// The sheet, seen from outside of the tube with the axis up: a1 = a (1, 0), a2 = a (1/2, sqrt(3)/2), two atoms per
// hexagon at 0 and (a1 + a2)/3. The chiral vector C = n a1 + m a2 rolls up to the circumference, in the sense in
// which the azimuth phi grows. (n,m) and (m,n) are mirror images.
//
// A lattice vector V = p a1 + q a2 is described by two integers,
//   height  C x V = (n q - m p)              in units of  a^2 sqrt(3)/2 : along the axis
//   arc     C . V = (2 n p + 2 m q + n q + m p)  in units of  a^2/2     : around it
//
// Any V that is not parallel to C may serve as the period. Its axial part is the length of the cell; its
// circumferential part V.C/|C| is nonzero for all but the multiples of the translational vector, and then the cell
// is periodic along z only when the tube is uniformly twisted by
//   rate = -(V.C/|C|) / (r V.T)     (rad per length, T the unit vector of the axis).
// The returned atoms have this twist. So a twisted tube is an exactly periodic cell with |n q - m p| hexagons.
// Source: Saito, Dresselhaus, Dresselhaus, Physical Properties of Carbon Nanotubes (1998), DOI 10.1142/p080.
#pragma once

#include <functional>
#include <vector>

#include "model/bond.hpp"
#include "model/tube.hpp"

namespace ropewalk {

struct LatticeVector {
  int p = 0, q = 0;
};

// The shortest vector along the axis, (-(2m+n), 2n+m)/gcd: the period of the untwisted tube.
LatticeVector translation_vector(Chirality c);

// Hexagons in the cell of period V: n q - m p without its sign.
long cell_hexagons(Chirality c, LatticeVector period);

// Shortest circumferential part of V over |C|, in turns, exactly: V and V + C are the same vector on the tube.
// In (-1/2, 1/2].
double period_turns(Chirality c, LatticeVector period);

// A lattice vector of the given height (in hexagons, a multiple of gcd(n,m)): gcd(n,m) of them are different on
// the tube, by equal parts of a turn.
LatticeVector vector_of_height(Chirality c, long hexagons);

// One atom: the first or the second of hexagon i a1 + j a2.
struct Site {
  int i = 0, j = 0;
  bool second = false;
};

// The sites of one height, evenly spaced around the tube: site k of them is `first` plus k times C/gcd(n,m).
struct SiteRow {
  Site first;
  long height = 0;  // height_in_thirds
  int sites = 0;    // gcd(n,m)
};

// The rows of a tube between two heights.
class SiteRows {
 public:
  explicit SiteRows(Chirality c);

  // Calls `visit` for every row with from <= height_in_thirds < to: those of the first sublattice in rising order,
  // then those of the second one.
  void between(long from, long to, const std::function<void(const SiteRow&)>& visit) const;
  // The number of sites in them.
  long sites_between(long from, long to) const;

 private:
  Chirality c_;
  long g_ = 1, x_ = 0, y_ = 0;  // lattice vector (-y, x) has the height g
};

// All sites with 0 <= height < hexagons, each once: exactly two per hexagon. `hexagons` must be a multiple of
// gcd(n,m); integers alone decide which atoms lie in the strip. Throws std::invalid_argument.
std::vector<Site> strip_sites(Chirality c, long hexagons);

// Height of an atom, exactly, in thirds of that of one hexagon.
long height_in_thirds(Chirality c, const Site& site);

// The cylinder on which the sheet is rolled. The shifts move the second sublattice against the first; a relaxed
// chiral tube has such shifts, and one of two species has a lift.
struct TubeShape {
  double radius = 0;              // nm
  double length_per_hexagon = 0;  // length of the axis, nm
  double twist = 0;               // rad/nm, right-handed positive
  double arc_shift = 0;           // rad
  double height_shift = 0;        // nm
  double lift = 0;  // nm: radius of the second sublattice minus that of the first; `radius` is the mean
};

TubeShape rolled_shape(Chirality c, double a = graphene_lattice_constant);

// A site of the cylinder; site (0,0) lies at phi = 0, z = 0.
struct Polar {
  double phi = 0, z = 0;  // rad, nm
};
Polar polar(Chirality c, const Site& site, const TubeShape& shape);
double radius_of(const Site& site, const TubeShape& shape);  // nm
Vector3 place(Chirality c, const Site& site, const TubeShape& shape);

// The atoms of a piece of a tube: those of strip_sites(), turned about the axis (rad), from z = `bottom` (nm) upwards.
std::vector<Vector3> tube_atoms(Chirality c, const TubeShape& shape, long hexagons, double turn = 0,
                                double bottom = 0);

struct TubeCell {
  std::vector<Vector3> atoms;  // atoms on the cylinder of `radius`, axis z, 0 <= z < length, nm
  double radius = 0;           // nm
  double length = 0;           // nm
  double twist = 0;            // rad/nm, uniform, with respect to the rolled sheet; right-handed positive
};

// The cell of period V, of a sheet of lattice constant a. Throws std::invalid_argument if V is parallel to C.
TubeCell tube_cell(Chirality c, LatticeVector period, double a = graphene_lattice_constant);

// A relaxed tube as a uniformly twisted cell of this period.
struct TwistedCell {
  LatticeVector period;
  long hexagons = 0;
  double length = 0, twist = 0;  // nm, rad/nm
};
// The shortest such cell within 2 % of the wanted twist (not 0); if there is none, the nearest.
TwistedCell twisted_cell_near(Chirality c, const TubeShape& shape, const std::vector<LatticeVector>& periods,
                              double twist);

// Lattice vectors whose cell is at least min_length and at most max_length long, sorted by twist, with |twist|
// times radius (the shear) at most max_shear. One vector for each twist: the shortest.
std::vector<LatticeVector> twisted_periods(Chirality c, double min_length, double max_length, double max_shear,
                                           double a = graphene_lattice_constant);

}  // namespace ropewalk
