// The one place where a text becomes TOML. The parser and what walks through its tables call themselves for each
// level, so that a text of a hundred kilobytes could exhaust the stack: depth and size are bounded before it.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "model/error.hpp"

namespace ropewalk {

// `description`: what is wrong, without file and line.
class TomlError : public InputError {
 public:
  TomlError(const Place& place, std::string what, const std::string& remedy)
      : InputError(place, "is not valid TOML: " + what, remedy), description(std::move(what)) {}
  std::string description;
};

inline constexpr int most_key_parts = 32;                           // a.b.c has 3
inline constexpr int deepest_toml = 32;                             // brackets and braces in one another
inline constexpr std::size_t longest_toml = std::size_t{64} << 20;  // bytes
inline constexpr int most_toml_keys = 200000;                       // tables and keys

// Throws InputError beyond these bounds, and TomlError where the text is not TOML.
toml::table parsed_toml(const std::string& text, const std::string& file);

}  // namespace ropewalk
