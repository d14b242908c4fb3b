// Whether the account of energy closes from one time to another. `run` and the ranks of LAMMPS go back and divide their
// steps where it does not (sim/dynamics/step_control.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// The steps between two marks of a run that looks closely.
inline constexpr std::int64_t account_window = 128;

// The account of energy at one time.
struct EnergyMark {
  double energy = 0;  // total energy, eV; NaN: it is not known
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
