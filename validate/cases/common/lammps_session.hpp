// LAMMPS runs that make one reference table: relaxed tubes, runs with their results, and the table's origin.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "atomistic/runs.hpp"
#include "contact/van_der_waals.hpp"
#include "core/case.hpp"
#include "core/reference.hpp"

namespace ropewalk {

// The tubes of these cases and the sets of the model.
struct ValidatedTube {
  Chirality chirality;
  const char* set;
  const char* name;
};
inline constexpr ValidatedTube tube_5_5{{5, 5}, "cnt-5-5-tersoff", "(5,5)"};
inline constexpr ValidatedTube tube_10_10{{10, 10}, "cnt-10-10-tersoff", "(10,10)"};

// All runs of one table, in one folder. They share the bonded potential; the hash covers all their inputs.
class MdSession {
 public:
  explicit MdSession(const CaseContext& context);

  const Potential& potential() const { return potential_; }
  const AtomLaw& atom_law() const { return atom_law_; }

  // The free tube at zero axial force.
  RelaxedTube relaxed(Chirality c);

  void write(const std::string& name, const std::string& content);
  // Runs an input that appends `rows` lines of `columns` numbers to name.dat, or at least `min_rows` of them if
  // that is given.
  std::vector<std::vector<double>> run(const std::string& name, const std::string& input, std::size_t rows,
                                       std::size_t columns, std::size_t min_rows = 0);

  // An empty table with its origin; call it after the runs. `contact`: the Lennard-Jones law was used.
  ReferenceTable table(const std::string& title, const std::string& case_name, bool contact,
                       std::vector<std::string> columns) const;

 private:
  RunContext context_of(Chirality c, const std::string& folder) const;
  void progress(const std::string& line) const;

  Potential potential_;
  AtomLaw atom_law_;
  StiffnessOptions options_;
  std::string folder_, inputs_;
  double seconds_ = 0;
  std::function<void(const std::string&)> progress_;
};

// Hexagons of the shortest untwisted cell, and its length (nm).
long period_hexagons(Chirality c);
double period_of(Chirality c, const TubeShape& shape);

// The atoms of a relaxed tube: so many hexagons, from z = 0 upwards, turned about its axis (nm, rad).
std::vector<Vector3> tube_atoms(Chirality c, const TubeShape& shape, long hexagons, double turn = 0);

}  // namespace ropewalk
