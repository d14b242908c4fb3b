// One calibration from chirality to parameter set: what `ropewalk calibrate` does, without its command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atomistic/stiffness.hpp"
#include "contact/fit_contact.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

struct CalibrationRequest {
  Chirality chirality;
  Potential potential;
  AtomLaw law;
  StiffnessOptions stiffness;
  std::string folder;   // of LAMMPS's files
  std::string command;  // as typed, for the record
};

struct Calibration {
  CalibrationRequest request;
  LammpsVersion lammps;
  Stiffness stiffness;
  LineFit line;
  PaperFit paper;
  std::optional<UniversalLine> universal;  // none: there is none for this sigma and cutoff
  double universal_error = 0;              // of the universal law for this tube, as LineFit::error
  // Atom by atom, two tubes side by side at the well, over all turns and shifts; over the surface integral. None
  // without a cutoff.
  std::optional<RegistrySpread> registry;
  std::vector<std::string> warnings;
  double seconds = 0, paper_seconds = 0;

  Shell shell() const { return {stiffness.radius.value, stiffness.surface_density()}; }
  std::string name() const;  // "cnt-10-10-tersoff"
};

// Throws InputError, LammpsError.
Calibration calibrate(const CalibrationRequest& request);

// The tables that the set came from: files beside it, so that anybody can read and fit them again.
std::string contact_csv(const Calibration& calibration);
std::string stiffness_csv(const Calibration& calibration);

// The set; `stiffness_file` and `contact_file` are the names of its tables, recorded with their hashes.
ParameterSet parameter_set(const Calibration& calibration, const std::string& stiffness_file,
                           const std::string& contact_file);
std::string parameter_file_comment(const Calibration& calibration);

// The six numbers of the contact that a user asks for first.
struct ContactSummary {
  Measured pair_spacing, pair_energy, cross90_energy;  // nm, eV/nm, eV
};
ContactSummary contact_summary(const Calibration& calibration);

// data/contact/universal-line.toml: one law for all tubes, made by `ropewalk calibrate universal`.
inline constexpr const char* universal_format = "ropewalk-universal-line-1";
std::string universal_path();
// For this atom-atom law: epsilon enters as a factor; sigma and cutoff must be those that it was fitted for.
std::optional<UniversalLine> universal_law(const AtomLaw& law);
std::string universal_file(const UniversalFit& fit, const std::string& command);

}  // namespace ropewalk
