// Rows of numbers in parameter files: key = { values = [...], standard_errors = [...] }.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "io/toml_table.hpp"

namespace ropewalk {

// Reads a row and its errors. Throws InputError.
template <std::size_t size>
void read_row(const TomlTable& section, const char* key, std::array<double, size>& out,
              std::array<double, size>& errors) {
  const std::string form = "{ values = [...], standard_errors = [...] }";
  if (!section.has(key)) throw section.error(key, "is missing", fmt::format("add {} = {}", key, form));
  const TomlTable q = section.table(key, form);
  const std::vector<double> values = q.numbers("values", Bounds::range(-1e6, 1e6), size);
  const std::vector<double> se = q.numbers("standard_errors", Bounds::non_negative(1e6), size);
  std::copy(values.begin(), values.end(), out.begin());
  std::copy(se.begin(), se.end(), errors.begin());
}

// The line of a row.
template <class Row>
std::string row_text(const char* key, const Row& value, const Row& error) {
  return fmt::format("{:<16} = {{ values = [{}], standard_errors = [{}] }}\n", key, fmt::join(value, ", "),
                     fmt::join(error, ", "));
}

}  // namespace ropewalk
