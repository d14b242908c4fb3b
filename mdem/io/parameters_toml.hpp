// The file of a parameter set; its format is described in model/parameters.hpp.
#pragma once

#include <string>

#include "model/parameters.hpp"

namespace ropewalk {

// Throws InputError for a file that is missing, not of this format, incomplete, without units or origins, or
// physically impossible.
ParameterSet read_parameters(const std::string& path);
// The same from the text of such a file; errors name `path`.
ParameterSet parameters_of_text(const std::string& text, const std::string& path);

// The text of a set with what an older one leaves out of [bond.pull]: another EA then scales its forces. To be taken
// before numbers of the text are changed.
std::string with_start_of_pull(const std::string& text, const std::string& path);
// A number of it, as files have it.
Quantity start_quantity(const std::string& key, double value, const char* unit);

// Why elements of this length (nm) are too long for the natural shape of a bond, and what to do; empty: they are not.
std::string too_turned(const BondStiffness& bond, double element_length);
std::string longest_for(const BondStiffness& bond);

// Null if the set has no such number.
const Quantity* find_quantity(const ParameterSet& set, const std::string& key);
// Covariance of these quantities, in their units: of their standard errors and correlations. A quantity that the
// set lacks, or whose error is not published, has none.
std::vector<std::vector<double>> covariance(const ParameterSet& set, const std::vector<std::string>& keys);
// An entry of [provenance]; empty if the set has none.
std::string provenance_value(const ParameterSet& set, const std::string& key);
// "(10,10)", "(5,5)@(10,10)", "(10,10) BN"; the name of the set for a filament
std::string tube_name(const ParameterSet& set);
// Throws InputError for a filament: "FILE: filament: has no lattice of atoms: SO; INSTEAD".
void refuse_filament(const ParameterSet& set, const std::string& so, const std::string& instead);
// Throws InputError for a tube of several walls: "FILE: meta.walls: are (5,5)@(10,10): SO; INSTEAD".
void refuse_several_walls(const ParameterSet& set, const std::string& so, const std::string& instead);

// Throws InputError for tubes of another honeycomb than carbon: "FILE: lattice: is of BN, and WHAT".
void refuse_other_than_carbon(const ParameterSet& set, const std::string& what);

class TomlTable;
struct Bounds;
// Throw InputError where a word is no chemical symbol, or is no name that a honeycomb other than carbon may have.
void check_element(const TomlTable& table, const std::string& key, const std::string& symbol);
void check_name_of_honeycomb(const TomlTable& table, const std::string& key, const std::string& name);
// One number `key` of a section with its unit, standard error and origin; it must have this unit.
Quantity read_quantity(const TomlTable& section, const std::string& key, const std::string& unit,
                       const Bounds& bounds);
std::string quantity_text(const Quantity& q, const std::string& key);

// The text of a parameter file from its meta data, quantities, universal law and provenance, below `comment`.
// Values have enough digits to be read back bit for bit, standard errors three.
std::string parameters_text(const ParameterSet& set, const std::string& comment);

}  // namespace ropewalk
