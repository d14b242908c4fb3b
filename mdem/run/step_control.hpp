// The step that follows the motion. A run marks a good state every `window` steps. Where the motion blows up, or
// the account of energy does not close over a window, it goes back to the last mark and divides every step in two,
// up to `most` parts, and puts steps together again once the motion has been quiet. Files count by the whole steps.
//
// With a device it looks and marks less often (RunSchedule::look_rarely) as long as steps are whole. Where a long
// window fails, it does that window again and looks closely, so that it divides the same steps as without a device.
//
// All of it depends on the states alone: a run is the same bits on any number of threads and after a resume.
#pragma once

#include <cstdint>

#include "sim/dynamics/shorter_steps.hpp"

namespace ropewalk {

struct StepControl {
  static constexpr std::int64_t window = 128, least_keep = 512, most_keep = 8192;  // steps
  static constexpr int most = most_parts_of_a_step;

  std::int64_t kept_until = 0;     // the step before which steps stay divided
  std::int64_t keep = least_keep;  // for how many they are divided when it happens next
  std::int64_t close_until = 0;    // the step before which a run with a device looks closely

  // Halves the steps after a failure with steps divided into `divided` parts. The simulation stands at the mark
  // again.
  void shorten(int divided, Simulation& simulation);
  // Whether the next window is a short one.
  bool looks_closely(const Simulation& simulation) const;
  // At a mark, after a window without failure.
  void lengthen(Simulation& simulation);
};

// The account of energy at one time.
struct EnergyMark {
  double energy = 0;  // eV, in all; NaN where it is not known
  EnergySupply supply;
};
EnergyMark energy_mark(const Simulation& simulation);

// Whether the account of energy closes since the mark: the work of the loads and of the bath, less what damping
// took, equals the change of the energy. The error may be 3 % of the energies that move. A step that is too long
// adds more than that soon before it blows up. The error of a sound run, cold or hot, is at most 1 %. Its
// sum is judged by the limit energy_drift (observe/limits.hpp). Where next to nothing moves, the error may be as
// large as the rounding of the energies: 1e-9 eV for each element, and in mixed precision 1.2e-7 of the contact
// energy.
bool account_closes(const EnergyMark& mark, const Simulation& simulation);
// The same verdict from energies in eV, for a run of another engine. `contact`: its energy in mixed precision, else
// 0.
bool account_closes(const EnergyMark& mark, const EnergyMark& now, double kinetic, double bonds, double contact,
                    std::size_t elements);

}  // namespace ropewalk
