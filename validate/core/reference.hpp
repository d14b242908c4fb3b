// Reference data of LAMMPS: a table with its origin, kept in data/references/NAME.csv.
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

namespace ropewalk {

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

// The stored table NAME.csv or, with context.fresh, a new one by make(). The result's sources say which. A new
// table is written to context.work/NAME.csv and compared with the stored one, if there is one: the largest
// difference of each column becomes a check ("stored against fresh"), within `tolerance` of the column's range.
// Throws InputError with the remedy where no table is stored and context.fresh is not set.
ReferenceTable reference(const CaseContext& context, const std::string& name, double tolerance,
                         const std::function<ReferenceTable()>& make, CaseResult& result);

}  // namespace ropewalk
