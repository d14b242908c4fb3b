// The step at which a method fails: by bisection on the method itself, and by the eigenvalues of its forces.
#pragma once

#include "cases/common/chain.hpp"
#include "core/case.hpp"

namespace ropewalk::validate {

// The value at which `fails` turns from false to true, with the relative error `relative`. NaN where `low` fails or
// `high` does not.
double limit_between(const std::function<bool(double)>& fails, double low, double high, double relative = 1e-3);

// Whether a state with tiny random velocities blows up within `steps`: the simulator stops, or the kinetic energy
// grows a millionfold.
bool blows_up(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps = 500);
// The step (ps) between 0.3 and 3 times `about` at which it begins to.
double largest_step(const Topology& topology, const Interaction& interaction, const State& state, double about);

// Factor by which the kinetic energy of such a state grows in `steps`; infinite where the simulator stops.
double growth(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps);

// The largest angular frequency (rad/ps) of small motions about a state at rest, from the eigenvalues of its
// stiffness by differences of the forces.
double stiffest_frequency(const Topology& topology, const Interaction& interaction, const State& state);

// The step (ps) at which the largest eigenvalue of dt^2 K + 2 dt D is 4, with K and D the stiffness and the damping
// over the masses by differences of the forces. Without damping it is 2/w.
double largest_damped_step(const Topology& topology, const Interaction& interaction, const State& state);

// A figure of the largest stable step, for the map of all limits.
CaseFigure step_figure(const std::string& by, const ChartAxis& x, std::string caption,
                       std::vector<ChartLine> lines);

// The set with elements `factor` times as long.
ParameterSet with_elements(ParameterSet set, double factor);

}  // namespace ropewalk::validate
