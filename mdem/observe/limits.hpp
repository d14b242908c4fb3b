// Limits of the model, and the largest values of a state against them.
//
// A chain of rigid elements is a rod as long as an element bends and twists little against its neighbour:
//
//   bend    angle between the axes of two bonded elements, curvature times element length. The energy
//           EI/a (1 - cos) is 1 % below the rod's EI/2a angle^2 at 19.9 degrees.
//   twist   angle of the bond about the axis. GJ/a (1 - cos) is 1 % below the rod's at the same 19.9 degrees; at
//           90 the torque peaks, the bond slips and the run stops.
//
// Shorter elements cure these two. The others belong to the tube, which no finer chain changes:
//
//   kink_curvature, wall_twist (radius times twist per length), strain (of either sign)    the [validity] of the
//           parameter set: there the tube kinks, collapses into a ribbon or buckles in its wall
//   overlap (key press_nm): how much nearer (nm) the axes of two tubes come, at any angle, than two parallel tubes
//           rest. The default is the core gap, below which the contact law is continued by its Taylor polynomial,
//           soft and without a source
//   pressure_GPa: of the contact across a tube (observe/loading.hpp). The default is the pressure at which the wall
//           collapses, P d^3 = 24 D (1 - (b/d)^2) with the bending stiffness D = 1.7 eV of graphene, b = 0.44 nm
//           and the diameter d (A. C. Torres-Dias et al., Carbon 123, 145 (2017),
//           DOI 10.1016/j.carbon.2017.07.036). Computing the pressure takes as long as several steps, so it is
//           looked at where a frame is stored
//   speed   of an element: a tenth of the speed of sound along the tube, sqrt(EA a/m). A tube that is stopped
//           from the speed v is strained by v/c: by 10 % there, more than any of the shipped sets allows.
//
// Two limits are of the run as a whole:
//
//   shock   kinetic energy of a rope that a moment twists, over the energy of twist of its tubes under the whole
//           moment, M^2 L/2GJ of each. Ropes of 19 tubes that were loaded with 0.2 of it came to the same state and
//           grew into helices at the same rate as with 0.01; with 1.1 their ends opened into brushes. Not watched
//           where the rope is warm
//   energy_drift    energy that the account of energy misses, over all energy converted since the start:
//           energy_drift() of observe/observables.hpp. With steps that the program chooses it stays below 0.02,
//           cold and at 300 K. The step control (sim/dynamics/step_control.hpp) goes back where 0.03 are lost within a
//           window; this limit sees what smaller losses add up to. Judged from the end of the first window on,
//           where a row of the log is written
//
// Units nm, ps, rad. A limit of zero is not watched.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "model/parameters.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct Limits {
  double bend = 19.9 * units::degree;   // rad per bond
  double twist = 19.9 * units::degree;  // rad per bond
  double kink_curvature = 0;            // 1/nm
  double wall_twist = 0;
  double strain = 0;       // strain of a pulled bond
  double compression = 0;  // strain of a pressed bond; 0: as of a pulled one
  double overlap = 0;      // nm
  double speed = 0;        // nm/ps
  double pressure = 0;     // eV/nm^3
  double energy_drift = 0.05;
  double shock = 0.25;
};

// All but the overlap, which follows from the contact law.
Limits default_limits(const TubeType& type, const Validity& validity);

struct LimitKind {
  const char* key;  // key in the scene's [limits]
  const char* unit;
  double unit_size;  // unit in internal units
  double Limits::*limit;
  const char* what;         // "the bond to the next element is bent by"
  const char* consequence;  // what is wrong there
  const char* remedy;       // for one who meets it; with `cured_by_finer`, --on-limit refine is another one
  bool cured_by_finer;      // would shorter elements help
  bool whole = false;       // a limit of the run as a whole, at no element
};
inline constexpr std::size_t limit_count = 10;
const std::array<LimitKind, limit_count>& limit_kinds();

// The value with the largest ratio to its limit. If the limits of tube types differ, another value may be larger.
struct Peak {
  double value = 0;
  double limit = 0;
  int element = -1;  // for a bond its first element; -1: no value
  bool pressed = false;  // a strain below zero

  double ratio() const { return limit > 0 ? value / limit : 0; }
  bool passed() const { return ratio() > 1; }
  // Each against its own limit, where both have one.
  bool is_beyond(const Peak& other) const {
    return limit > 0 && other.limit > 0 ? ratio() > other.ratio() : value > other.value;
  }
};
using Peaks = std::array<Peak, limit_count>;  // one peak a limit, in the order of limit_kinds()

// What loads and constraints do to an element.
enum class Held : char { free, loaded, clamped };

// The limits of one scene.
struct Watched {
  std::vector<Limits> limits;  // limits by tube type
  std::vector<double> rest;  // nm: distance of parallel tubes of the types i, j at i * types + j; empty: no contact
  // The pressure on every tube of a state, eV/nm^3; none: not watched.
  std::function<std::vector<double>(const State&)> pressures = {};
  double twist_energy = 0;      // twist energy of the tubes under the whole moment, eV; 0: a shock is not watched
  std::vector<Held> held = {};  // of each element of the scene; empty: all are free
};

// "the upper clamp", "the loaded lower end" or "a loaded place": what holds this element, or that behind it in its
// tube; empty: nothing does.
std::string holder_in_words(const Topology& topology, const std::vector<Held>& held, int element);
// "tube 3, element 12, at the upper clamp": both counted from 0, the element in its tube.
std::string place_in_words(const Topology& topology, const std::vector<Held>& held, int element);

// eV/nm^3, for a tube of this radius (nm).
double collapse_pressure(double radius);

// The peaks of a state, without the pressure and the limits of the whole run; of equal values the first element's.
// The list must be up to date; it may be empty.
Peaks peaks(const Topology& topology, const State& state, const NeighbourList& list, const Watched& watched);
Peak pressure_peak(const Topology& topology, const State& state, const Watched& watched);

}  // namespace ropewalk
