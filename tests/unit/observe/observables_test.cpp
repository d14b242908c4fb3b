// The table of observables, and the log that is made of it.
#include "observe/observables.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "io/log.hpp"
#include "model/units.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

double one(const Measurement&) { return 1; }

Observable named(const char* name, const char* unit) { return {name, unit, "", ObservableGroup::shape, one}; }

// Columns and bytes that programs of users rely on: a new column comes behind or between, none changes its name or
// its digits.
TEST(Observables, LogHasTheColumnsAndBytesThatItAlwaysHad) {
  EXPECT_EQ(
      log_header(),
      "step,time_ps,time_step_fs,moment_nN_nm,torque_upper_nN_nm,torque_lower_nN_nm,torque_upper_x_nN_nm,torque_"
      "upper_y_nN_nm,"
      "torque_lower_x_nN_nm,torque_lower_y_nN_nm,tension_upper_nN,tension_lower_nN,rotation_deg,work_upper_eV,"
      "work_lower_eV,stretch_eV,shear_eV,bend_eV,twist_eV,vdw_eV,kinetic_eV,work_eV,dissipated_eV,damping_eV,"
      "thermostat_eV,"
      "balance_eV,stored_MJ_per_kg,stored_stretch_MJ_per_kg,stored_bend_MJ_per_kg,stored_twist_MJ_per_kg,"
      "stored_contact_MJ_per_kg,cohesion_lost,ends_apart_nm,ends_strain,least_tension_nN,most_tension_nN,"
      "most_curvature_per_nm,slip_nm,core_pressure_GPa,beta_deg,physical_twist_deg,geometric_twist_deg,ply_angle_"
      "deg,Q,Q_"
      "delaunay,"
      "contacts,voids,void_area_nm2,radius_mid_nm,radius_end_nm,length_nm,amplitude_nm,windings,helix_radius_nm,"
      "pitch_nm,middle_amplitude_"
      "nm,"
      "writhe,turned_back,kinked,overtwisted,overstretched,largest_bond_twist_deg,stress_GPa,specific_stress_N_per_"
      "tex,"
      "tether_eV,tether_lost_eV,tethers_broken,friction_eV,friction_slip_eV,friction_drag_eV,friction_slips,"
      "links_eV,links_lost_eV,links_formed,links_broken,failure_lost_eV,bonds_broken,ends_eV,own_forces_eV\n");
  const Topology topology;
  State state;
  state.step = 123456789012345;
  state.time = 0.1;
  EnergyAccount a;
  a.time_step = 0.025;
  a.moment = 30 * units::nN_nm;
  a.potential = {1, 2, 3, 4, -1e-300};
  a.kinetic = 0.25;
  a.work = 8;
  a.dissipated = 0.5;
  a.heat = 0.125;
  a.first_energy = 2.375;
  a.first = {0.5, 0.5, 1, 1, -4};
  a.ends[upper_end] = {units::nN_nm * Vector3(1, 2, 4), units::nN_nm * Vector3(4, 2, 8), units::pi, 7};
  a.ends[lower_end] = {units::nN_nm * Vector3(1, 2, -4), units::nN_nm * Vector3(16, 8, -32), -units::pi, 1};
  Loading l;
  l.ends_apart = 66;
  l.strain = -0.0625;
  l.least_tension = -units::nN_nm;
  l.most_tension = 2 * units::nN_nm;
  l.curvature = 0.125;
  l.slip = 0.75;
  l.core_pressure = 2 * units::nN_nm;
  const RopeSize size{2, 0.25 * units::nN_nm, 2};
  RopeObservation o;
  o.beta = 0.5;
  o.physical_twist = 1.25;
  o.geometric_twist = -2.5;
  o.ply_angle = -0.125;
  o.middle.charge = -1;
  o.middle.charge_delaunay = 2;
  o.middle.contacts = 210;
  o.middle.voids = 3;
  o.middle.void_area = 1.0 / 3;
  o.radius_mid = 6.5;
  o.radius_end = 6.25;
  o.length = 66.1;
  o.amplitude = 7e-7;
  o.windings = -0.0;
  o.helix_radius = 2.5;
  o.pitch = 0.375;
  o.middle_amplitude = 0.5;
  o.writhe = -0.75;
  o.turned_back = 0.25;
  o.kinked = 4;
  o.overtwisted = 5;
  o.overstretched = 6;
  o.largest_bond_twist = 0.75;
  EXPECT_EQ(
      log_line(LogRow({topology, state, o, l, size, a})),
      "123456789012345,0.1,25,30,8,32,4,2,16,8,4,4,360,7,1,1,2,3,4,-1e-300,0.25,8,0.5,0.5,0.125,0.25,5.5,1,1,1.5,"
      "2,1,66,"
      "-0.0625,-1,2,0.125,0.75,2,28.64788975654116,71.6197243913529,-143.2394487827058,-7.16197243913529,-1,2,210,"
      "3,"
      "0.3333333333333333,6.5,6.25,66.1,7e-07,-0,2.5,0.375,0.5,-0.75,0.25,4,5,6,42.97183463481174,2,16,0,0,0,0,0,"
      "0,0,0,0,0,"
      "0,0,0,0\n");
}

TEST(Observables, NamesAreUniqueAndEndInTheirUnit) {
  std::set<std::string> names;
  for (const Observable& o : observables()) {
    EXPECT_TRUE(names.insert(o.name).second) << o.name;
    EXPECT_FALSE(o.meaning.empty()) << o.name;
    EXPECT_NE(o.meaning.back(), '.') << o.name;
    std::string ending = o.unit.rfind("1/", 0) == 0 ? o.unit.substr(1) : o.unit;
    for (const auto& [from, to] : {std::pair{" ", "_"}, std::pair{"^", ""}, std::pair{"/", "_per_"}})
      for (std::size_t at; (at = ending.find(from)) != std::string::npos;) ending.replace(at, 1, to);
    EXPECT_EQ(o.name.substr(o.name.size() - ending.size()), ending) << o.name;
    EXPECT_EQ(observables()[index_of_observable(o.name)].name, o.name);
  }
}

TEST(Observables, WrongEntriesAreRefused) {
  const std::size_t before = observables().size();
  EXPECT_THROW(add_observable(named("beta_deg", "deg")), std::invalid_argument) << "taken";
  EXPECT_THROW(add_observable(named("", "")), std::invalid_argument);
  EXPECT_THROW(add_observable(named("a,b", "")), std::invalid_argument);
  EXPECT_THROW(add_observable(named("gap", "nm")), std::invalid_argument);
  EXPECT_THROW(add_observable(named("_nm", "nm")), std::invalid_argument);
  EXPECT_THROW(add_observable(named("area_nm", "nm^2")), std::invalid_argument);
  EXPECT_THROW(add_observable(named("rate_ps", "1/ps")), std::invalid_argument);
  EXPECT_THROW(add_observable({"gap_nm", "nm", "", ObservableGroup::shape, nullptr}), std::invalid_argument);
  EXPECT_EQ(observables().size(), before);
  EXPECT_THROW(index_of_observable("gap_nm"), std::invalid_argument);
  EXPECT_THROW(LogRow()["gap_nm"], std::invalid_argument);
}

// Only the running simulation knows loads and energies.
TEST(Observables, FramesGiveAllButLoadsAndEnergies) {
  for (const Observable& o : observables()) {
    bool only_run = o.name == "cohesion_lost" || o.name == "rotation_deg" || o.name == "time_step_fs";
    for (const char* part : {"_eV", "moment_", "torque_", "tension_upper", "tension_lower", "stored_", "tethers_",
                             "_slips", "links_", "bonds_broken", "stress_"})
      only_run = only_run || o.name.find(part) != std::string::npos;
    EXPECT_EQ(in_frames(o.group), !only_run) << o.name;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
