// Loads and constraints, resolved to elements. Forces and couples are added to the model's; constraints act
// on the velocities after each kick, so that a constrained component never moves off its path.
//
// The simulator knows the interface `Load` alone. Each kind of load is one file of scene/loads/.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/schedule.hpp"
#include "sim/forces/forces.hpp"
#include "sim/state/processes.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct PointLoad {
  int element = 0;
  Vector3 force = Vector3::Zero();   // eV/nm
  Vector3 torque = Vector3::Zero();  // eV
};

enum End : std::size_t { lower_end, upper_end };
using EndElements = std::array<std::vector<int>, 2>;  // of the lower and of the upper end

// One component of what a load does to its elements, known before it is run.
struct LoadComponent {
  enum class Is { free, held, moved, loaded };

  Is is = Is::free;
  bool each = true;  // for each tube by itself, or for all tubes as one body
  // Displacement from the start (nm, rad) where it is moved, force or couple (eV/nm, eV) where it is loaded; with
  // sharp corners.
  Schedule course;
  std::function<double(double)> now;  // the same at a time (ps), with the corners as they are applied

  static LoadComponent held(bool each = true) { return {Is::held, each, {}, {}}; }
  static LoadComponent follows(Is is, Schedule course, bool each = true) {
    const auto at = [course](double time) { return course.value(time); };
    return {is, each, std::move(course), at};
  }
  bool is_kept() const { return is == Is::held || is == Is::moved; }
};

struct LoadEffect {
  static constexpr std::size_t z = 2, about_z = 5;
  // What acts about the axis: a couple of fixed direction, one that turns with its element, forces about the middle
  // of the end, or the rigid body of a clamp.
  enum class By { couple, turning_couple, tangential, body };

  std::array<LoadComponent, 6> axes;  // along x, y, z, about x, y, z; on each element of a tube or on its clamp
  By by = By::couple;
  bool by_element = true;      // each element of a tube has the load, or the clamp of several has it
  bool keeps_tilt = false;     // the tubes keep their tilt
  bool between_ends = false;   // it acts between the upper end and the lower one
  bool relaxes_spins = false;  // no bond holds a moment by its twist
};
// The effect of the same force and couple on each element at all times.
LoadEffect constant_effect(const Vector3& force, const Vector3& couple);

// The processes that have the elements of a load together.
using LoadProcesses = Processes;

class Load {
 public:
  // Loads act in this order. Where two of them set one velocity, the later one decides.
  enum class Order { force, grip, fix, prescribed_motion };

  std::vector<int> elements;  // that it acts on

  virtual ~Load() = default;
  virtual std::shared_ptr<Load> copy() const = 0;
  virtual Order order() const { return Order::force; }
  // The elements that the load reads besides `elements`. It must read no others.
  virtual std::vector<int> reads(const Topology&) const { return {}; }

  // Appends the forces and torques at this time.
  virtual void add_forces(const State&, double /*time*/, std::vector<PointLoad>&) const {}
  // Sets the constrained velocity components. `ahead` (ps) is half of the drift with these velocities.
  virtual void constrain(const Topology&, double /*time*/, double /*ahead*/, State&) const {}
  // The same after a kick of `dt` (ps) by the forces `total`, for a load with a motion of its own under them.
  virtual void constrain_after(const Forces& /*total*/, double /*dt*/, const Topology& topology, double time,
                               double ahead, State& state) const {
    constrain(topology, time, ahead, state);
  }

  // Appends the elements at the ends of the rope where it says which ones they are.
  virtual void add_ends(EndElements&) const {}
  // Puts elements where it needs them at the start.
  virtual void begin(const Topology&, State&) const {}

  // ps between relaxations of all spins (relax_spins); 0: never.
  virtual double spin_relaxation_interval() const { return 0; }
  // For a process that has only those of its elements that stand at these places of `elements`, in rising order.
  // All processes call it at once. A load that needs sums over all its elements keeps `others` for them.
  virtual void keep(const std::vector<std::size_t>& places, const LoadProcesses& others);
  // Why the load has no meaning in a relaxation; empty: it has.
  virtual std::string needs_time() const { return ""; }
  // What it does, component by component; none where it cannot be said beforehand.
  virtual std::optional<LoadEffect> effect() const { return std::nullopt; }
  // The load that does the opposite, for the other end of a rope; null: it has none.
  virtual std::shared_ptr<Load> opposite() const { return nullptr; }

 protected:
  explicit Load(std::vector<int> on = {}) : elements(std::move(on)) {}
  Load(const Load&) = default;
  Load& operator=(const Load&) = default;
};

// The entries of `all` at these places.
template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& places) {
  std::vector<T> out;
  out.reserve(places.size());
  for (const std::size_t k : places) out.push_back(all[k]);
  return out;
}

// Loads and constraints in the order in which they act. Copies share the loads, which never change.
class LoadsAndConstraints {
 public:
  void add(std::shared_ptr<const Load> load);
  template <class L>
  void add(L load) {
    add(std::shared_ptr<const Load>(std::make_shared<L>(std::move(load))));
  }

  bool empty() const { return all_.empty(); }
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }
  // The loads of one class. They live as long as these loads, so a temporary has none to give.
  template <class L>
  std::vector<const L*> of() const&& = delete;
  template <class L>
  std::vector<const L*> of() const& {
    std::vector<const L*> found;
    for (const auto& load : all_)
      if (const auto* one = dynamic_cast<const L*>(load.get())) found.push_back(one);
    return found;
  }
  // ps; 0: spins are never relaxed.
  double spin_relaxation_interval() const;

 private:
  std::vector<std::shared_ptr<const Load>> all_;
};

// The elements that any of them acts on, in rising order.
std::vector<int> loaded_elements(const LoadsAndConstraints& loads);

// The loads at this time, element by element; an element may appear more than once.
void point_loads(const LoadsAndConstraints& loads, const State& state, double time, std::vector<PointLoad>& out);

// Work per time of these loads at the present velocities, eV/ps.
double load_power(const std::vector<PointLoad>& loads, const State& state);

// Applies all constraints (Load::constrain).
void constrain(const Topology& topology, const LoadsAndConstraints& loads, double time, double ahead, State& state);

// A time at which no prescribed motion has begun: constraints let free components move alone.
inline constexpr double before_all_motion = -1;  // ps

// The impulse that the constraints gave to an element in a kick.
struct ConstraintImpulse {
  int element = 0;
  Vector3 linear = Vector3::Zero();   // eV ps/nm
  Vector3 angular = Vector3::Zero();  // eV ps, about its centre
  double work = 0;                    // eV; zero where it is held at rest
};

// The same after a kick by the forces `total`, with the impulse of the constraints on each of `elements`, which
// must be all that they act on.
void constrain(const Topology& topology, const LoadsAndConstraints& loads, const std::vector<int>& elements,
               double time, double ahead, const Forces& total, double kick, State& state,
               std::vector<ConstraintImpulse>& out);

// The reactions of the constraints on `elements` at rest: they balance the forces `total` along every constrained
// component. The result holds forces and torques (eV/nm, eV) in the place of impulses.
std::vector<ConstraintImpulse> reactions_at_rest(const Topology& topology, const LoadsAndConstraints& loads,
                                                 const std::vector<int>& elements, const Forces& total,
                                                 const State& state);

// Turns every element about its own axis such that no bond is twisted, keeping the middle element of each
// tube and all tube axes, and takes away the spin velocities: the exact minimum of the twist energy over the
// spins. Geometric twist (the shape of the centre line) is untouched.
void relax_spins(const Topology& topology, State& state);

}  // namespace ropewalk
