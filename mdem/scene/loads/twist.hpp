// [twist] the two-stage protocol: the moment on the grip elements (first and last of every tube; + at the upper
// end, - at the lower) is ramped at a rate and then held. One such load acts on one grip.
#pragma once

#include <array>

#include "scene/key_table.hpp"
#include "sim/dynamics/loads.hpp"

namespace ropewalk {

class TwistLoad : public Load {
 public:
  enum class Reading { per_tube, total };         // the moment is that of each grip element, or of all of them
  enum class Application { couple, tangential };  // a couple on each element, or tangential forces on the grip
  double moment = 0;                              // eV, in its reading
  double rate = 0;                                // eV/ps
  double hold = 0;                                // ps after the ramp
  Reading reading = Reading::per_tube;
  Application application = Application::couple;
  bool lateral_free = true;
  bool axial_free = true;
  bool geometric_only = false;  // relax every spin about the tube axis at each increment
  double increment = 1.0;       // ps between such relaxations
  double sign = 1;              // of the moment: + on the upper grip, - on the lower

  double ramp_time() const { return rate > 0 ? moment / rate : 0.0; }
  // eV, without the sign.
  double moment_at(double time) const {
    const double ramped = rate > 0 ? rate * time : moment;
    return ramped < moment ? ramped : moment;
  }
  TwistLoad on_grip(std::vector<int> grip, double sign_there) const;

  std::shared_ptr<Load> copy() const override { return std::make_shared<TwistLoad>(*this); }
  Order order() const override { return Order::grip; }
  void add_forces(const State&, double time, std::vector<PointLoad>& out) const override;
  void constrain(const Topology&, double time, double ahead, State&) const override;
  double spin_relaxation_interval() const override { return geometric_only ? increment : 0.0; }
  void keep(const std::vector<std::size_t>& places, const LoadProcesses& others) override;

 private:
  double count_of_all() const { return all_ > 0 ? all_ : static_cast<double>(elements.size()); }
  template <std::size_t n>
  void add_up(std::array<double, n>& sums) const {
    if (others_) others_->sum(sums.data(), n);
  }
  void add_tangential(const State& state, double whole, std::vector<PointLoad>& out) const;

  double all_ = 0;  // elements of the grip; 0: they are all here
  // Those with whom the grip's elements are shared; null: nobody.
  const LoadProcesses* others_ = nullptr;
};

// The upper and the lower grip of a scene's [twist].
void add_twist(const TwistLoad& twist, const Topology& topology, LoadsAndConstraints& loads);

const KeyTable<TwistLoad>& twist_table();

}  // namespace ropewalk
