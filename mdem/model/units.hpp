// Units: eV, nm, ps. Every conversion factor of the program is derived here, once, from the exact SI
// constants of 2019 and the CODATA 2018 atomic mass constant (DOI 10.1103/RevModPhys.93.025010).
#pragma once

namespace ropewalk::units {

inline constexpr double pi = 3.14159265358979323846;

inline constexpr double electron_charge_C = 1.602176634e-19;  // exact
inline constexpr double boltzmann_J_per_K = 1.380649e-23;     // exact
inline constexpr double atomic_mass_kg = 1.66053906660e-27;   // CODATA 2018
inline constexpr double carbon_atomic_weight = 12.011;        // IUPAC standard atomic weight

// The mass unit eV ps^2/nm^2 in kg: 1 J = 1 kg m^2/s^2 and 1 nm/ps = 1000 m/s.
inline constexpr double mass_unit_kg = electron_charge_C * 1e-6;
inline constexpr double carbon_mass = carbon_atomic_weight * atomic_mass_kg / mass_unit_kg;  // eV ps^2/nm^2
inline constexpr double atomic_mass = atomic_mass_kg / mass_unit_kg;                         // u, eV ps^2/nm^2

inline constexpr double boltzmann = boltzmann_J_per_K / electron_charge_C;  // eV/K

// 1 eV/nm in nN; also 1 eV in nN nm and 1 eV nm in nN nm^2.
inline constexpr double eV_in_nN_nm = electron_charge_C * 1e18;
inline constexpr double nN_nm = 1.0 / eV_in_nN_nm;  // one nN nm in eV (or nN in eV/nm, nN nm^2 in eV nm)

inline constexpr double fs = 1e-3;            // ps
inline constexpr double degree = pi / 180.0;  // rad
inline constexpr double rad_in_degree = 180.0 / pi;

}  // namespace ropewalk::units
