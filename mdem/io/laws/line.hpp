// The rows of the universal `line` law in files.
#pragma once

#include <string>

#include "io/toml_table.hpp"
#include "model/contact/line.hpp"

namespace ropewalk {

// The five rows of the universal law, read from their table and as text.
void read_universal_rows(const TomlTable& table, UniversalLine& law);
std::string universal_rows_text(const UniversalLine& law);

}  // namespace ropewalk
