// What drives the two ends of a rope: six components each, with their schedules and what they act on.
//
// [twist], a pair of [[grip]] and [[load]] on the ends of tubes are three ways to write one thing. Each load says
// by effect() what it does to its elements, and forecasts, theory, log and reports ask the functions of this file.
// None of them asks which class a load is of.
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

// What one load does to one end of some tubes.
struct EndDrive {
  End end = upper_end;
  std::vector<int> tubes;   // tubes in rising order
  bool at_rope_end = true;  // no tube is inside of a strand
  std::size_t all = 0;      // tubes that end at this end of the rope
  bool one_element = true;  // it holds one element of each tube
  LoadEffect does;          // forces and couples are those on each tube, or on all of these tubes as one body
};
using EndDrives = std::vector<EndDrive>;

// Empty for a load that acts on elements inside of the tubes as well: it drives no end.
EndDrives end_drives(const Load& load, const Topology& topology);
EndDrives end_drives(const LoadsAndConstraints& loads, const Topology& topology);

// Whether this component of some tube is held or moved at both of its ends.
bool is_kept_between(const EndDrives& drives, std::size_t axis);
// The displacement or rotation of the upper end against the lower one, the largest of all tubes; zero if none is
// moved.
Schedule moved_apart(const EndDrives& drives, std::size_t axis);
// The force or couple on the tube that has the largest at this end.
Schedule load_of_each(const EndDrives& drives, End end, std::size_t axis);
// When all forces and couples have reached their full size, ps.
double whole_from(const EndDrives& drives);

// A moment about the axis of a rope, prescribed at one end or at both.
struct EndMoment {
  Schedule course;       // eV, on the upper end, or the opposite of that on the lower end; right-handed: positive
  bool per_tube = true;  // it acts on each tube, not on all of them together
  bool on_all = true;    // tubes of the rope
  LoadEffect::By by = LoadEffect::By::couple;
  bool relaxes_spins = false;
  // The other end has the opposite moment, or its rotation is held; where neither is so the rope turns as a whole.
  bool balanced = false, far_end_held = false;

  double hand() const { return course.last() < 0 ? -1 : 1; }
  double largest() const { return course.largest(); }  // eV, without a sign
  double of_each(int tubes) const { return per_tube ? largest() : largest() / tubes; }
  double ramp_time() const { return course.reaches(); }  // ps
  double rate() const;                                   // eV/ps, the fastest of the ramp; 0: it acts at once
  bool twists() const { return on_all && (balanced || far_end_held); }  // all of the rope
};
// None: no couple about the axis is prescribed.
std::optional<EndMoment> end_moment(const EndDrives& drives);

// The moment at this time, eV, in the reading of the scene; 0: none is prescribed.
double moment_at(const EndDrives& drives, double time);

// What the ends may do while such a moment twists them: of both ends, what the less free one may.
struct EndFreedom {
  enum class Sideways { free, mean_held, held };
  Sideways sideways = Sideways::free;  // mean_held: the mean of the tubes stays on the axis
  bool tilts = true;                   // each tube by itself
  bool otherwise_driven = false;       // more than the moment drives this end
  bool one_element = true;             // of each tube is in the clamp
};
EndFreedom end_freedom(const EndDrives& drives);

}  // namespace ropewalk
