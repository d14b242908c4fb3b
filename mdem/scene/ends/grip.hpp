// [[grip]] one end of some tubes in a clamp, as in a testing machine: a rigid disc that all of them are fastened
// to, or a clamp for each tube.
//
// A clamp is a rigid body of elements with the motion v = V + W x (x - c), w = W, where c is its centre of mass.
// Each of its six components is held at zero, follows a displacement, follows a force or a couple, or is free. The
// free components are those of the rigid motion nearest to the velocities that the elements would have without the
// clamp (Gauss' principle of least constraint), so that momentum and angular momentum are kept. Elements may be
// released from the clamp: to slide along its axis, to spin about their own axes, to tilt.
//
// A drift by v dt leads off a circle: elements drift along the chord to where the turn takes them.
#pragma once

#include <array>

#include "scene/loads/load_kind.hpp"
#include "sim/dynamics/gauges.hpp"
#include "sim/dynamics/schedule.hpp"

namespace ropewalk {

// "x" to "about_z", in the order of GripLoad::axes.
inline constexpr const char* grip_axis_names[] = {"x", "y", "z", "about_x", "about_y", "about_z"};

struct GripAxis {
  using Is = LoadComponent::Is;
  Is is = Is::held;
  std::vector<Schedule::Point> points;  // nm or rad where it is moved, eV/nm or eV where it is loaded
  bool strain = false;                  // the values are strains of the tubes, positive where the clamp pulls
};

class GripLoad : public Load {
 public:
  static constexpr std::size_t z = 2, about_z = 5;

  End end = upper_end;           // first or last elements
  bool both = false;             // the other end does the opposite
  bool each = false;             // a clamp for each tube
  int depth = 1;                 // elements of each tube in the clamp
  std::array<GripAxis, 6> axes;  // displacement along x, y, z, rotation about x, y, z
  bool slide_free = false, spin_free = false, tilt_free = false;
  double smooth =
      -1;  // smoothing of the corners of all schedules, ps; negative: that of motions follows from the travel of sound

  // The grip on these elements of a scene, `depth` of each tube after one another. `free_length`: nm, to which a
  // strain refers; a grip that follows no strain needs none.
  GripLoad on_elements(std::vector<int> on, const Topology& topology, double free_length = 0) const;
  const Schedule& schedule(std::size_t axis) const { return schedules_[axis]; }
  // "upper grip, one disc: z held, about z moved by up to ..." for the user.
  std::string words() const;
  // Whether nothing that the clamp holds feels the load on this axis.
  bool is_unfelt(std::size_t axis, const State& state) const;

  std::shared_ptr<Load> copy() const override { return std::make_shared<GripLoad>(*this); }
  Order order() const override { return Order::grip; }
  void add_forces(const State&, double time, std::vector<PointLoad>& out) const override;
  void constrain(const Topology&, double time, double ahead, State&) const override;
  void keep(const std::vector<std::size_t>& places, const LoadProcesses& others) override;
  std::string needs_time() const override;
  std::optional<LoadEffect> effect() const override;
  void add_ends(EndElements& ends) const override {
    ends[end].insert(ends[end].end(), elements.begin(), elements.end());
  }
  GripLoad at_other_end() const;  // with the opposite motion and load
  std::shared_ptr<Load> opposite() const override { return std::make_shared<GripLoad>(at_other_end()); }
  double lasts() const;  // ps, to the end of the last schedule

 private:
  struct Body;
  std::vector<Body> bodies(const State& state) const;
  void find_inertia(const State& state, std::vector<Body>& all) const;
  template <class Of>
  void add_up(std::vector<Body>& all, int count, const Of& numbers_of) const;
  bool solves() const;  // for components that nothing prescribes

  std::array<Schedule, 6> schedules_;   // courses in nm, rad, eV/nm and eV
  std::vector<double> mass_, inertia_;  // masses and inertias of the elements
  std::vector<int> clamp_;              // clamp of each element, in rising order
  // Clamps with elements on several processes, in rising order, the same on all of these.
  std::vector<int> shared_;
  const LoadProcesses* others_ = nullptr;
};

// One [[grip]] of a scene, and the tubes that it holds.
class GripDrive : public Drive {
 public:
  Selection on;
  GripLoad load;

  SceneTable table() const override;
  std::string words() const override;
  std::string needs_time() const override { return load.needs_time(); }
  bool goes_by_load_steps() const override { return true; }
  std::shared_ptr<const Drive> at_its_end() const override;
  double lasts() const override { return load.lasts(); }
  void add_loads(const Scene&, const Topology&, const Interaction&, LoadsAndConstraints&) const override;
  void refuse_start(const Scene&, const Topology&, const State&, const LoadsAndConstraints&) const override;
  Ends ends() const override { return Ends::clamped; }
  int held(End end, int tube) const override {
    return (load.both || load.end == end) && on.has_tube(tube) ? load.depth : 0;
  }
  std::string why_not_lengthened() const override {
    return load.depth > 1 ? "a grip holds several elements of each tube" : "";
  }

 private:
  GripLoad at(const GripLoad& grip, const Scene&, const Topology&) const;
};

}  // namespace ropewalk
