// One calibration from chirality to parameter set: the work of `ropewalk calibrate` without its command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atomistic/stiffness.hpp"
#include "atomistic/walls.hpp"
#include "contact/fit_contact.hpp"
#include "model/parameters.hpp"

namespace ropewalk::calibrate {

struct CalibrationRequest {
  Chirality chirality;           // of the outer wall
  std::vector<Chirality> walls;  // of several walls, inside first; empty for a tube of one wall
  bool outer_carries = false;    // several walls: the outer one alone carries stretch and torsion
  Potential potential;
  AtomLaw law;
  StiffnessOptions stiffness;
  std::string folder;   // of LAMMPS's files
  std::string command;  // as typed, for the record

  const Honeycomb& honeycomb() const { return potential.honeycomb; }
  std::string tube() const;  // "(10,10)", "(5,5)@(10,10)", "(10,10) BN"
  std::string name() const;  // "cnt-10-10-tersoff", "cnt-5-5@10-10-tersoff", "bn-10-10-extep"
  // Between the atoms of both species; `law` is what they are together in continuous shells.
  SpeciesLaws laws() const;
};

struct Calibration {
  CalibrationRequest request;
  LammpsVersion lammps;
  Stiffness stiffness;  // of several walls: as they carry
  std::optional<WalledStiffness> walled;
  LineFit line;
  double cutoff_loss = 0;  // several walls: the part of the well that the cutoff of the atom-atom law leaves out
  PaperFit paper;
  std::optional<UniversalLine> universal;  // empty: no universal law for this sigma and cutoff
  double universal_error = 0;              // error of the universal law for this tube, as LineFit::error
  // Energies from sums over atoms of two parallel tubes at the well, over all turns and shifts, relative to the
  // surface integral. Empty without a cutoff.
  std::optional<RegistrySpread> registry;
  std::vector<std::string> warnings;
  double seconds = 0, paper_seconds = 0;

  Shell shell() const { return shells().back(); }  // of the outer wall
  std::vector<Shell> shells() const;               // inside first
};

// Throws InputError, LammpsError.
Calibration calibrate(const CalibrationRequest& request);

// The tables from which the set was made. They are files beside the set, so that anybody can fit them again.
std::string contact_csv(const Calibration& calibration);
std::string stiffness_csv(const Calibration& calibration);

// The set; `stiffness_file` and `contact_file` are the names of its tables, recorded with their hashes.
ParameterSet parameter_set(const Calibration& calibration, const std::string& stiffness_file,
                           const std::string& contact_file);
// Puts a pull behind the anharmonic terms of a set, in place of an earlier one.
void put_pull(ParameterSet& set, const PullFit& pull);
std::string parameter_file_comment(const Calibration& calibration);

// The main numbers of the contact.
struct ContactSummary {
  Measured pair_spacing, pair_energy, cross90_energy;  // nm, eV/nm, eV
};
ContactSummary contact_summary(const Calibration& calibration);

// data/contact/universal-line.toml: one law for all tubes, made by `ropewalk calibrate universal`.
inline constexpr const char* universal_format = "ropewalk-universal-line-1";
std::string universal_path();
// The universal law for this atom-atom law. epsilon is a factor; sigma and cutoff must be those of the fit.
std::optional<UniversalLine> universal_law(const AtomLaw& law);
std::string universal_file(const UniversalFit& fit, const std::string& command);

}  // namespace ropewalk::calibrate
