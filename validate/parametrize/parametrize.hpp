// `ropewalk parametrize`: from chiralities to validated parameter sets and one report.
//
// For each tube (n,m) and interatomic potential the set is calibrated with its envelope, its friction is measured
// (friction-*.toml beside the set, where scenes with this set find it), the references of its atoms are made, all
// cases of validation that the set allows are run, and a page says what the set is worth. What is finished is kept,
// so that a stopped command goes on where it was.
#pragma once

#include <string>
#include <vector>

#include "io/friction_toml.hpp"
#include "model/parameters.hpp"
#include "runner/runner.hpp"

namespace ropewalk::validate {

// --- What the pages are made from ---

struct ParametrizedTube {
  std::string name;   // "cnt-7-3-tersoff"
  std::string tube;   // "(7,3)"
  std::string error;  // why there is no set; empty otherwise
  ParameterSet set;
  std::vector<PairFriction> frictions;  // friction between this tube and another one
  std::string no_friction;              // why some are missing; empty: none is
  std::vector<Outcome> outcomes;
  std::string tier = "full";       // cases that are run
  double calibration_seconds = 0;  // wall time

  bool holds() const;
  std::string verdict() const;        // "holds" or "misses", with "quick" where only these cases were run
  std::string grade() const;          // grade in words, with the cases that miss
  double validation_seconds() const;  // sum over the cases, LAMMPS included
};

// The largest relative difference of twisting energies of ropes from those of atoms, with the check; null where no
// rope was compared.
const Check* worst_rope(const ParametrizedTube& tube);

// The page of one tube, and that of several with links to theirs.
std::string tube_page(const ParametrizedTube& tube);
std::string overview_page(const std::vector<ParametrizedTube>& tubes);
// One row a tube, with units in the header.
std::string tubes_csv(const std::vector<ParametrizedTube>& tubes);

}  // namespace ropewalk::validate
