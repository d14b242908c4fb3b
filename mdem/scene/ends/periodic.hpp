// [periodic] the interior of a long rope: a slice that goes on at both ends as its own image.
//
// The first and the last elements of every strand are images. With the period L along z, its length L0 at the
// start, and the turn tau L0 in it, the image of the element at x one period higher is
//
//   x' = R(tau L0) x + L e_z,   q' = R(tau L0) q,   v' = R(tau L0) v + tau' L0 e_z x R(tau L0) x + L' e_z,
//
// R about the z axis, and one period lower the inverse. So the slice is that of an endless rope that is twisted and
// strained evenly, and that repeats itself after L but for the turn. Images are elements as all others: forces on
// the elements between them are those of the endless rope, as long as the images reach as far as the contact. What
// moves the images gives the gauges: torque and tension of the rope.
//
// L is L0 (1 + strain), or follows a tension F until the first time of the strain. With the energy U of one period,
//
//   W L'' = F - dU/dL,   dU/dL = - sum s f_z/2,
//
// f the forces on the images, s = 1 for the upper ones and -1 for the lower ones: what holds the images to the
// slice's own elements is the derivative of U by L, since forces among the images of one end cancel. The inertia W
// is the mass of as many elements at one end as the contact reaches (TubeGroups::period_inertia). So L, the slice's
// own elements and a thermostat sample the canonical ensemble of an endless rope under F, however many images there
// are. L and L' are kept in the images themselves.
#pragma once

#include <vector>

#include "model/error.hpp"
#include "scene/drive.hpp"
#include "sim/dynamics/schedule.hpp"

namespace ropewalk {

class PeriodicLoad : public Load {
 public:
  int images = 0;                        // elements at each end of a tube; 0: as the contact needs
  std::vector<Schedule::Point> twist;    // rad/nm; from the start, or chosen by turns
  std::vector<Schedule::Point> turns;    // turns of a yarn with the angle of this one at its surface, 1/nm; none: by twist
  double yarn_diameter = 0;              // nm; 0: none is typed
  std::vector<Schedule::Point> strain;   // of the period; none: it stays
  std::vector<Schedule::Point> tension;  // tension of the rope, eV/nm; none: its length is prescribed at all times

  // For the tubes of a slice (TubeGroups::images). `reach` (nm): of the contact, between element centres; `rim`
  // (nm): where the axes of the outermost tubes stand, for turns. Throws InputError where the images do not reach
  // as far.
  PeriodicLoad on_tubes(const Topology& topology, double reach, double rim, const InputError::Place& images_key) const;
  // Winds straight tubes evenly about the z axis where the slice is twisted from the start.
  void wind(State&) const;
  // Puts the images where they belong.
  void place(const Topology&, State&) const;
  double period() const { return period_; }  // nm, L0
  const Schedule& schedule() const { return schedule_; }
  double lasts() const;  // ps

  std::shared_ptr<Load> copy() const override { return std::make_shared<PeriodicLoad>(*this); }
  Order order() const override { return Order::prescribed_motion; }
  std::vector<int> reads(const Topology& topology) const override;  // the originals, one for each image
  // On several processes `elements` then has the images and behind them their originals, in the same order, as
  // elements of a state that has all of them.
  void keep(const std::vector<std::size_t>&, const LoadProcesses&) override { numbers_ = elements; }
  void constrain(const Topology&, double time, double ahead, State&) const override;
  void constrain_after(const Forces& total, double dt, const Topology&, double time, double ahead,
                       State&) const override;
  void add_forces(const State&, double time, std::vector<PointLoad>&) const override;
  std::string needs_time() const override;
  std::optional<LoadEffect> effect() const override;
  // The ends of the rope are the images of its elements.
  void add_ends(EndElements& ends) const override {
    for (const End end : {lower_end, upper_end})
      ends[end].insert(ends[end].end(), ends_[end].begin(), ends_[end].end());
  }
  void begin(const Topology& topology, State& state) const override {
    wind(state);
    place(topology, state);
  }

 private:
  // Calls act(image, original, sign of the period between them).
  template <class Act>
  void for_images(const Topology&, const Act& act) const;
  // L, and its change per time.
  struct Length {
    double now = 0, rate = 0;
  };
  Length measured(const Topology&, const State&) const;
  // When constraints act. `still`: the schedules stand as they are at `time`, and only what is free moves.
  struct When {
    double time = 0, drift = 0;  // ps
    bool still = false;

    double then() const { return still ? time : time + drift; }
  };
  static When when(double time, double ahead, const State&);
  // L at the end of a drift from `time` on, and L' at `time`, which a free length has more than measured.
  Length length_after(const Topology&, const When&, const State&, double more = 0) const;
  bool is_free(double time) const { return !tension.empty() && (strain.empty() || time < strain.front().time); }
  void check_reach(const Topology&, const State&) const;
  void lead(const Topology&, const When&, const Length& then, State&) const;
  void follow(int image, int original, double sign, const When&, const Length& then, State&) const;

  Schedule schedule_;            // course of tau, smoothed
  Schedule stretched_, pulled_;  // courses of strain, smoothed, and of tension
  EndElements ends_;
  std::vector<int> numbers_;  // numbers of the images in the scene, on several processes
  double period_ = 0, reach_ = 0;  // nm
};

class PeriodicDrive : public Drive {
 public:
  PeriodicLoad load;

  SceneTable table() const override;
  std::string words() const override;
  void refuse(const TomlTable& top, const Scene&) const override;
  std::string needs_time() const override { return load.needs_time(); }
  bool goes_by_load_steps() const override { return true; }
  double lasts() const override { return load.lasts(); }
  int images(double reach) const override;
  void add_loads(const Scene&, const Topology&, const Interaction&, LoadsAndConstraints&) const override;
  void refuse_start(const Scene&, const Topology&, const State&, const LoadsAndConstraints&) const override;
  void warn(const Scene&, const Topology&, const LoadsAndConstraints&, std::vector<std::string>&) const override;
  Ends ends() const override { return Ends::endless; }
  std::string why_not_split() const override { return "a periodic slice counts its images in elements"; }
  NotForLammps not_for_lammps() const override {
    if (load.tension.empty()) return {};
    return {"periodic.tension_nN",
            "the period then moves by the forces on all images, which several ranks have; a rope of ten periods "
            "between grips, whose middle is as a slice, takes ten times as long a step"};
  }
};

}  // namespace ropewalk
