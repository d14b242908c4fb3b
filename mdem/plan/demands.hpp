// What the start and the loads of a scene ask of its tubes together, with their signs, at any time of the run.
//
// Where both ends are kept, a rope is as long and as wound as they ask for: by what it is at the start, and by
// what they have moved since. Where a force or a couple acts, a tube comes to the strain or twist at which its
// own bonds bear it (tube_law.hpp). The strain of the start is then gone; its twist and winding lie between
// what they were and nothing, and the larger of both sums counts. Everything is even along the rope, and the
// rope as a whole winds no farther than its tubes twist. Where their spins are relaxed it winds until the
// tubes, which slide on one another, bear the couple by their bending. A rope whose length is free and that
// winds draws its outer tubes out and presses its inner ones as long as they do not slide (rope_section.hpp).
// Ends that come nearer press the tubes up to the strain at which a column of the rope's width buckles, and
// bend them from there on; tubes that begin straight and cold may stay straight, and are pressed all the way as
// well. A force that acts at once counts twice: what it moves goes as far again beyond its rest. These are
// upper estimates of motions without other shocks.
#pragma once

#include <array>
#include <vector>

#include "plan/rope_section.hpp"
#include "plan/term_pulls.hpp"
#include "plan/tube_law.hpp"
#include "scene/prepare.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

// Largest values, without their signs.
struct Demands {
  double curvature = 0, twist = 0;  // 1/nm, rad/nm
  double strain = 0, pressed = 0;  // strain of the bond drawn out farthest, and of the one pressed most
  double pressure = 0;             // pressure on the innermost tube, eV/nm^3
};

class DemandsAhead {
 public:
  // `type`: of which tubes.
  DemandsAhead(const Scene& scene, const Prepared& prepared, std::size_t type = 0);

  Demands at(double time) const;                               // at 0: of the start alone
  const std::vector<double>& times() const { return times_; }  // ps: 0, the corners of all courses, and in between
  Demands largest() const;

 private:
  struct Range {
    double low = 0, high = 0;
    double farthest(double more) const;  // from zero, of both ends moved by `more`
    Range moved(double one, double other) const;  // over all values between both moves
  };
  struct At;

  void read_start(const Scene& scene, const Prepared& p);
  void add_times(const Schedule& course);
  double turned(double time) const;  // rad/nm, since the start
  double axial(std::size_t axis, double time) const;
  double axial_inside(std::size_t axis, double time) const;  // the part of loads that are on no end
  double bent_by_force(std::size_t axis, double time) const;  // eV, the bending moment of the forces along this axis
  double sideways(std::size_t axis, double time) const;
  double force_of(const Schedule& course, double time) const;
  double at_once(double force) const { return moves_ ? force : 0; }  // what a force from the start on adds to itself
  void read_inner(const Prepared& p);
  RopeSection::Tubes clings() const {
    return length_kept_ ? RopeSection::Tubes::cling_at_kept_length : RopeSection::Tubes::cling;
  }
  double clinging(double couple, double more) const;  // rad/nm: winding of a rope whose tubes do not slide
  void add(const At& what, Demands& out) const;

  TubeLaw law_;
  BondStiffness bond_;
  EndDrives drives_;
  RopeSection section_;
  TermPulls terms_;
  int type_ = 0;
  std::array<std::array<Schedule, 6>, 2> loads_;  // of each tube, by end and axis
  Schedule turned_apart_, drawn_apart_;           // of the upper end against the lower one
  std::array<Schedule, 2> moved_aside_;           // likewise, along x and y
  // A load on elements that are no ends.
  struct Inner {
    LoadEffect does;
    double elements = 1;    // largest number in one tube
    double from_lower = 0;  // nm, along the tube: of their middle
  };
  std::vector<Inner> inner_;
  double length_ = 0, period_ = 0, rope_radius_ = 0, column_ = 0, pressure_per_slope4_ = 0;
  bool length_kept_ = false, turn_kept_ = false, relaxes_spins_ = false, winds_freely_ = false,
       ends_inside_ = false;  // of tubes, in a slice: nothing but contact turns or draws one
  bool moves_ = true, keeps_tilt_ = false, upright_ = true, straight_ = true;
  std::array<std::array<bool, 6>, 2> kept_ = {};  // by end and axis
  int tubes_ = 0;
  double warm_curvature_ = 0, warm_twist_ = 0;
  // The start.
  Range twist_, strain_;
  double bent_ = 0, winding_ = 0;  // 1/nm, beside that of the winding (rad/nm) of the rope
  std::vector<double> times_;
};

}  // namespace ropewalk
