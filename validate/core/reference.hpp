// Reference data of LAMMPS: a table of one tube with its origin. It belongs to a parameter set, whose interatomic
// potential and law between tubes it was made with. data/references/SET/NAME.csv has those of shipped sets; those
// of a user's set lie beside it, in SET-atoms/NAME.csv.
//
//   # title: ...
//   # potential: tersoff (BNC.tersoff, hash ...)     any number of "# key: value" lines
//   # lammps: 29 Sep 2021 - Update 2
//   # input_hash: xxh64 of the LAMMPS inputs, one after another
//   # wall_seconds: 123
//   # command: ropewalk validate run NAME --fresh
//   distance_nm,energy_eV
//   1.60,-12.3
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/case.hpp"

namespace ropewalk::validate {

struct ReferenceTable {
  std::vector<std::pair<std::string, std::string>> origin;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  std::string value(const std::string& key) const;            // empty where there is none
  std::vector<double> column(const std::string& name) const;  // throws std::out_of_range
  void add(const std::string& key, const std::string& value) { origin.emplace_back(key, value); }
};

// Throws InputError with file and line.
ReferenceTable read_reference(const std::string& path);
std::string reference_csv(const ReferenceTable& table);

// The name of the set without what would make a path of it: the name is a text of whoever made the set.
std::string leaf_of_name(const ParameterSet& set);
// The folder in which references of this set are made.
std::string atoms_folder(const ParameterSet& set);
// The stored table of a set: beside it or, for the same tube and potential, among the shipped ones. Empty: none.
std::string find_reference(const CaseContext& context, const ParameterSet& set, const std::string& name);

// The origin that a table must state to be of this set. Throws NotApplicable where it says something else, or
// where the set names no potential that is known.
std::string between_tubes(const ParameterSet& set);
void check_origin(const ReferenceTable& table, const std::string& path, const ParameterSet& set);

// The stored table NAME of a set or, with context.fresh, a new one by make(). The result's sources say which. A
// fresh table is written to context.work/SET/NAME.csv and compared with the stored one, if there is one: the
// largest difference of each column becomes a check ("stored against fresh"), within `tolerance` of the column's
// range. Where none is stored, or one of another potential or law: with context.make_atoms it is made and stored in
// atoms_folder; otherwise throws NotApplicable.
ReferenceTable reference(const CaseContext& context, const ParameterSet& set, const std::string& name,
                         double tolerance, const std::function<ReferenceTable()>& make, CaseResult& result);

}  // namespace ropewalk::validate
