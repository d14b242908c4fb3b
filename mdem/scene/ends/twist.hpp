// [twist] the two-stage protocol: the moment on the grip elements (first and last of every tube; + at the upper
// end, - at the lower, or the other way round) is ramped at a rate, held, and taken away again if asked for. One
// such load acts on one grip.
//
// A moment M reaches an element with the axis t as
//
//   couple        M e_z, of fixed direction. It has no potential (H. Ziegler, Principles of Structural Stability
//   (1968)):
//                 an open rope under it turns its tubes for ever, and the load goes on doing work
//   follower      M t: it turns with the tube, and has no potential either
//   conservative  M (e_z + t)/(1 + t_z), from the potential -M psi. psi is the turn about z that is left of the
//                 element's rotation after the shortest turn which tilts its axis: alpha + gamma of Euler's angles
//                 z-x-z. It grows without bound where a tube's end points backwards
//   tangential    forces about the middle of the grip
//
// Two grips with a couple on each tube give the same motion to rounding where everything is free (tests/physics/
// grip_test.cpp). Held sideways, tangential forces and relaxed spins are no motions of rigid clamps.
#pragma once

#include <array>

#include "scene/drive.hpp"

namespace ropewalk {

class TwistLoad : public Load {
 public:
  enum class Application { couple, follower, conservative, tangential };
  enum class Reading { per_tube, total };  // the moment is that of each end element, or of all of them
  double moment = 0;                       // moment at the end of the ramp, in its reading, eV
  double rate = 0;                         // eV/ps; 0: it acts at once
  double hold = 0;                         // ps after the ramp
  double unload_rate = 0;                  // eV/ps, after the hold; 0: the moment stays
  double unloaded = 0;                     // ps without a moment, at the end
  Reading reading = Reading::per_tube;
  bool left_handed = false;     // it turns the upper end to the left
  bool geometric_only = false;  // spins are relaxed, so that no bond holds the moment by its twist
  Application application = Application::couple;
  bool lateral_free = true;
  bool axial_free = true;
  double increment = 1.0;  // ps between relaxations of every spin, where the twist is geometric only
  double sign = 1;         // sign of the moment: + on the upper grip, - on the lower

  double ramp_time() const { return rate > 0 ? moment / rate : 0.0; }                  // ps
  double unload_time() const { return unload_rate > 0 ? moment / unload_rate : 0.0; }  // ps
  // eV, without a sign.
  double moment_at(double time) const {
    if (const double unloading = time - ramp_time() - hold; unload_rate > 0 && unloading > 0)
      return unload_rate * unloading < moment ? moment - unload_rate * unloading : 0;
    const double ramped = rate > 0 ? rate * time : moment;
    return ramped < moment ? ramped : moment;
  }
  double hand() const { return left_handed ? -1 : 1; }

  TwistLoad on_grip(std::vector<int> grip, double sign_there) const;

  std::shared_ptr<Load> copy() const override { return std::make_shared<TwistLoad>(*this); }
  Order order() const override { return Order::grip; }
  void add_forces(const State&, double time, std::vector<PointLoad>& out) const override;
  void constrain(const Topology&, double time, double ahead, State&) const override;
  double spin_relaxation_interval() const override { return geometric_only ? increment : 0.0; }
  void keep(const std::vector<std::size_t>& places, const LoadProcesses& others) override;
  std::optional<LoadEffect> effect() const override;

 private:
  double count_of_all() const { return all_ > 0 ? all_ : static_cast<double>(elements.size()); }
  template <std::size_t n>
  void add_up(std::array<double, n>& sums) const {
    if (others_) others_->sum(sums.data(), n);
  }
  void add_tangential(const State& state, double whole, std::vector<PointLoad>& out) const;

  double all_ = 0;  // elements of the grip; 0: they are all here
  // The processes that share this grip; null in a run on one process.
  const LoadProcesses* others_ = nullptr;
};

// The upper and the lower grip of a scene's [twist].
void add_twist(const TwistLoad& twist, const Topology& topology, LoadsAndConstraints& loads);

class TwistDrive : public Drive {
 public:
  TwistLoad load;
  bool held = false;  // at_its_end()

  SceneTable table() const override;
  std::string words() const override;
  void refuse(const TomlTable& top, const Scene&) const override;
  std::string needs_time() const override;
  bool goes_by_load_steps() const override { return true; }
  std::shared_ptr<const Drive> at_its_end() const override;
  double lasts() const override { return load.ramp_time() + load.hold + load.unload_time() + load.unloaded; }
  void add_loads(const Scene&, const Topology& topology, const Interaction&,
                 LoadsAndConstraints& loads) const override {
    add_twist(load, topology, loads);
  }
  void refuse_start(const Scene&, const Topology&, const State&, const LoadsAndConstraints&) const override;
  Ends ends() const override { return Ends::loaded; }

 private:
  void refuse_in_relaxation(const TomlTable& top, const Scene&) const;
};

}  // namespace ropewalk
