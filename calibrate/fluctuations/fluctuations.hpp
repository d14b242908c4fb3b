// Stiffnesses of a rod from how it moves in heat.
//
// Between element i and the next of a chain at rest there are a stretch s along their mean axis, two bends b_x and
// b_y and a twist t about the mean axes, as rotation vector of the one against the other. Summed over a window of w
// bonds, of length L = w a, they have in thermal equilibrium (equipartition; for DNA: W. K. Olson et al., PNAS 95,
// 11163 (1998), DOI 10.1073/pnas.95.19.11163)
//
//   <b_x b_x> = kT L/EI_x,   <b_y b_y> = kT L/EI_y,   <(s,t) (s,t)^T> = kT L ((EA, D), (D, GJ))^-1
//
// where bonds are independent of one another, which those of this program are. Elements that are means over atoms
// are not quite: part of the motion within an element goes into its neighbours or is lost, the same part at both
// ends of every window. So the variance is kT L/K plus a constant, and the stiffness is taken from the difference
// of the longest window and the shortest; the stiffness of each window stands beside it, and all agree where the
// bond is local.
//
// Variances are those about a bond's own mean over the time: atoms at a free end lie otherwise than those of the
// middle, and a tube may be bent or twisted at rest. A mean of correlated frames moves too, with a variance that is
// added again: the one of means over sixteenths of the time, over 16. Standard errors are those of time_mean(), of what each
// frame adds to a stiffness (jackknife); nan where fewer than 30 frames are independent. Units eV, nm, rad, K.
#pragma once

#include <array>
#include <vector>

#include "atomistic/stiffness.hpp"
#include "sim/state/state.hpp"

namespace ropewalk::calibrate {

// The motion of one bond: shear_x, shear_y, s, b_x, b_y, t.
using BondMotion = std::array<double, 6>;
// `i` and the element behind it; the body's z is the axis.
BondMotion bond_motion(const State& state, std::size_t i);

// Stiffnesses over a window.
struct RodStiffness {
  int window = 0;                         // bonds; 0: from the difference of windows
  Measured EA, EI_x, EI_y, GJ, coupling;  // eV/nm, eV nm, eV nm, eV nm, eV
};

struct Fluctuation {
  std::vector<RodStiffness> windows;
  RodStiffness rod;          // difference of the longest and the shortest window
  double static_part = 0;    // largest part of a bond's mean square, over bends and twist, that is left out
  double frames_needed = 0;  // for all errors, where there are none; 0: all are known
  long frames = 0, bonds = 0;
  // Whether stiffnesses of all windows agree with those of `rod` within three standard errors.
  bool local = false;
};

// Chains of equal elements of `element_length` (nm), of which frame after frame is given.
class FluctuationSums {
 public:
  explicit FluctuationSums(double element_length) : element_length_(element_length) {}
  // The elements first .. first + elements - 1 of a state are a chain. All frames have the same chains, in this
  // order; end_frame() closes one.
  void add_chain(const State& state, std::size_t first, int elements);
  void end_frame() { ++frames_; }
  long frames() const { return frames_; }

  // At `temperature` (K). Throws std::invalid_argument for fewer than 30 frames, or where no chain has two bonds.
  Fluctuation evaluate(double temperature) const;

 private:
  double element_length_;
  long frames_ = 0;
  std::vector<int> bonds_;           // number of bonds of each chain
  std::vector<BondMotion> motions_;  // frame by frame, chain by chain
};

}  // namespace ropewalk::calibrate
