// The register of what contact laws have in parameter sets: a law NAME with numbers reads them from [contact.NAME].
#pragma once

#include <any>
#include <functional>
#include <string>
#include <vector>

#include "io/toml_table.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

// The table [contact.NAME] of a set, as the reader of a law gets the table.
struct LawTable {
  using Number = std::function<double(const TomlTable& section, const std::string& key, const std::string& unit,
                                      const Bounds&)>;

  TomlTable table;          // [contact.NAME]; a key that the reader leaves is refused
  const ParameterSet& set;  // with its tube or filament and its bonds
  // A number with unit, standard error and origin. It becomes a quantity of the set, which tables and reports show
  // and `errors` varies. Throws InputError where it is missing, has another unit or is out of bounds.
  Number number_in;
  double number(const std::string& key, const std::string& unit, const Bounds& bounds) const {
    return number_in(table, key, unit, bounds);
  }
};

struct LawNumbers {
  std::string name;
  // The value of ParameterSet::laws[name]. Throws InputError.
  std::function<std::any(const LawTable&)> read;
  // Lines of a section of the file that are no quantities, "" if it has none; null: no section has any.
  std::string (*rows)(const std::any& numbers, const std::string& section) = nullptr;
};

// The numbers of the shipped laws. A set has no table for a law from elsewhere.
const std::vector<LawNumbers>& law_numbers();

}  // namespace ropewalk
