// The model that all styles of one LAMMPS instance share, read from an export of `ropewalk export --lammps`. This
// file includes no header of LAMMPS.
#pragma once

#include <memory>
#include <string>

#include "scene/lammps_files.hpp"
#include "scene/scene.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/dynamics/thermostat.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct LammpsModel {
  std::string directory;
  LammpsStart start;
  Topology topology;
  Interaction interaction;
  LoadsAndConstraints loads;
  std::shared_ptr<const Thermostat> thermostat;  // none: no bath
  std::string law = "none";
  bool relax = false;
  double force_tolerance = 0;  // eV/nm
  bool judges_account = true;  // ends a motion whose account does not close

  bool damped() const {
    return interaction.damped_contact() || interaction.damping.bond.rate > 0 || interaction.damping.local > 0;
  }
  bool driven() const { return !loads.empty(); }
  // No time passes in a relaxation.
  double time_at(std::int64_t step) const {
    return relax ? start.time : start.time + static_cast<double>(step - start.step) * start.time_step;
  }
};

// Throws InputError.
LammpsModel load_lammps_model(const std::string& directory);

// The error message if the version of LAMMPS is wrong, else empty. Versions are dates as numbers: 20210929.
std::string version_complaint(int built_against, int found);

}  // namespace ropewalk
