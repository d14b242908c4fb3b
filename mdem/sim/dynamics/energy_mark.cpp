#include "sim/dynamics/energy_mark.hpp"

#include <cmath>
#include <limits>

namespace ropewalk {

EnergyMark energy_mark(const Simulation& s) { return {s.total_energy(), s.account()}; }

bool account_closes(const EnergyMark& mark, const EnergyMark& now, double kinetic, double bonds, double contact,
                    std::size_t elements) {
  constexpr double part = 0.03, part_of_bonds = 1e-3, rounding = 1e-9;  // rounding: eV for each element
  constexpr double single = std::numeric_limits<float>::epsilon();
  if (!std::isfinite(mark.energy)) return true;
  const double error = now.energy - mark.energy - (now.supply.supplied() - mark.supply.supplied());
  const double moving = kinetic + std::fabs(now.supply.dissipated - mark.supply.dissipated);
  return std::fabs(error) <= part * moving + part_of_bonds * bonds + rounding * static_cast<double>(elements) +
                                 single * std::fabs(contact);
}

bool account_closes(const EnergyMark& mark, const Simulation& s) {
  const bool mixed = s.interaction().precision == Interaction::Precision::mixed;
  return account_closes(mark, energy_mark(s), kinetic_energy(s.topology(), s.state()), s.forces().energy.bonds(),
                        mixed ? s.forces().energy.vdw : 0, s.state().size());
}

}  // namespace ropewalk
