// log.csv: one row per logged time. The columns are described once, here, and writer, reader, report and
// documentation all use the description. Every header carries its unit.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace ropewalk {

struct LogRow {
  double step = 0;
  double time = 0;
  double moment = 0;
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0, kinetic = 0;
  double work = 0;
  double dissipated = 0;
  double heat = 0;
  double balance = 0;
  double beta = 0, physical_twist = 0, geometric_twist = 0;
  double charge = 0, charge_delaunay = 0, contacts = 0;
  double voids = 0, void_area = 0;
  double radius_mid = 0, radius_end = 0, length = 0;
  double amplitude = 0, windings = 0;
  double kinked = 0, overtwisted = 0, overstretched = 0;
  double largest_bond_twist = 0;
};

struct LogColumn {
  const char* name;  // CSV header, with unit
  const char* meaning;
  double LogRow::*value;
  bool whole;  // an integer
};

// In file order.
inline const std::vector<LogColumn>& log_columns() {
  static const std::vector<LogColumn> columns = {
      {"step", "time step", &LogRow::step, true},
      {"time_ps", "time", &LogRow::time, false},
      {"moment_nN_nm", "moment of the twist protocol at this time, in its own reading", &LogRow::moment, false},
      {"stretch_eV", "stretch energy of the bonds", &LogRow::stretch, false},
      {"shear_eV", "shear energy of the bonds", &LogRow::shear, false},
      {"bend_eV", "bending energy of the bonds", &LogRow::bend, false},
      {"twist_eV", "torsional energy of the bonds", &LogRow::twist, false},
      {"vdw_eV", "van der Waals contact energy", &LogRow::vdw, false},
      {"kinetic_eV", "kinetic energy, translation and rotation", &LogRow::kinetic, false},
      {"work_eV", "work done by the loads so far", &LogRow::work, false},
      {"dissipated_eV", "energy taken out by damping so far", &LogRow::dissipated, false},
      {"thermostat_eV", "heat that the thermostat has brought in so far", &LogRow::heat, false},
      {"balance_eV",
       "total energy - work + dissipated - heat, less its first value: zero but for integration error",
       &LogRow::balance, false},
      {"beta_deg", "twist angle of the outermost tubes to the rope axis, middle third", &LogRow::beta, false},
      {"physical_twist_deg", "twist stored in the bonds of a tube, end to end, mean over tubes",
       &LogRow::physical_twist, false},
      {"geometric_twist_deg", "rotation of the tubes about the rope's centre line, end to end",
       &LogRow::geometric_twist, false},
      {"Q", "packing charge of the middle section, by distance", &LogRow::charge, true},
      {"Q_delaunay", "packing charge of the middle section, by Delaunay triangulation", &LogRow::charge_delaunay,
       true},
      {"contacts", "pairs of neighbours in the middle section", &LogRow::contacts, true},
      {"voids", "voids in the middle section", &LogRow::voids, true},
      {"void_area_nm2", "their area", &LogRow::void_area, false},
      {"radius_mid_nm", "outer radius at the middle", &LogRow::radius_mid, false},
      {"radius_end_nm", "outer radius at the ends, mean", &LogRow::radius_end, false},
      {"length_nm", "arc length of the centre line", &LogRow::length, false},
      {"amplitude_nm", "largest distance of the centre line from its chord", &LogRow::amplitude, false},
      {"windings", "turns of the centre line about its chord", &LogRow::windings, false},
      {"kinked", "bonds beyond the kink curvature", &LogRow::kinked, true},
      {"overtwisted", "bonds beyond the twist limit", &LogRow::overtwisted, true},
      {"overstretched", "bonds beyond the stretch limit", &LogRow::overstretched, true},
      {"largest_bond_twist_deg", "largest twist of one bond", &LogRow::largest_bond_twist, false},
  };
  return columns;
}

std::string log_header();
std::string log_line(const LogRow& row);  // full precision: reading it back gives the same bits

// Throws InputError naming line and column. A last line without its newline, as after a kill, is left out: its
// last number may have lost digits.
std::vector<LogRow> read_log(const std::string& path);

}  // namespace ropewalk
