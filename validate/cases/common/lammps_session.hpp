// LAMMPS runs that make one reference table: relaxed tubes, runs with their results, and the table's origin.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atomistic/finite_tube.hpp"
#include "atomistic/runs.hpp"
#include "atomistic/walled_tube.hpp"
#include "contact/van_der_waals.hpp"
#include "core/case.hpp"
#include "core/reference.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk::validate {

using calibrate::header_commands, calibrate::data_file;
using calibrate::AtomLaw, calibrate::Shell, calibrate::Well;
using calibrate::extra_hexagons, calibrate::hexagons_in, calibrate::held_band;
using calibrate::FiniteTube, calibrate::RelaxedTube;

// All runs of one table, in one folder. They share the interatomic potential and the law between tubes, those of
// the set; the hash covers all their inputs. Throws NotApplicable where the set's potential is not one that is
// known.
class MdSession {
 public:
  MdSession(const CaseContext& context, const ParameterSet& set);

  const Potential& potential() const { return potential_; }
  const AtomLaw& atom_law() const { return atom_law_; }

  // The tube of the set, free and not twisted, at zero axial force.
  const RelaxedTube& relaxed();
  // The same tube at rest under no torque: with the natural twist of the set.
  TubeShape rest_shape();

  void write(const std::string& name, const std::string& content);
  // Runs an input that appends `rows` lines of `columns` numbers to name.dat, or at least `min_rows` of them if
  // that is given.
  std::vector<std::vector<double>> run(const std::string& name, const std::string& input, std::size_t rows,
                                       std::size_t columns, std::size_t min_rows = 0);

  // An empty table with its origin; call it after the runs. `contact`: the Lennard-Jones law was used.
  ReferenceTable table(const std::string& title, const std::string& case_name, bool contact,
                       std::vector<std::string> columns) const;

 private:
  calibrate::RunContext context_of(const std::string& folder) const;
  void progress(const std::string& line) const;

  ParameterSet set_;
  Potential potential_;
  AtomLaw atom_law_;
  std::optional<RelaxedTube> relaxed_;
  calibrate::StiffnessOptions options_;
  std::string folder_, inputs_;
  double seconds_ = 0;
  std::function<void(const std::string&)> progress_;
};

// Hexagons of the shortest untwisted cell, and its length (nm).
long period_hexagons(Chirality c);
double period_of(Chirality c, const TubeShape& shape);

// Rows of atoms that a symmetry of the tube takes into each other: gcd(n,m) hexagons, and their height (nm). A turn
// by 2 pi/gcd(n,m) about the axis is a symmetry too.
long row_hexagons(Chirality c);
double row_height(Chirality c, const TubeShape& shape);

// Natural twist of the set's tube, rad/nm; 0 where the set has none.
double natural_twist(const ParameterSet& set);

// The walls of a set of several, inside first, as rolled sheets of the set's radii and lengths.
std::vector<calibrate::WallShape> wall_shapes(const ParameterSet& set);
// The law between atoms of two walls of one tube is cut here (nm) and shifted, as in the calibration.
inline constexpr double between_walls_cutoff = 1.2;
std::string between_walls(const ParameterSet& set);

}  // namespace ropewalk::validate
