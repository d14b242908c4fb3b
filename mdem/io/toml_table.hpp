// A strict reader of TOML. A table records which keys were read, and finish() refuses the others. Every error is an
// InputError of one line with file, line, key and remedy. No text and no key holds a control character: texts go
// into files that other programs interpret.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/plain_text.hpp"  // printable
#include "model/error.hpp"

namespace ropewalk {

// The allowed range of a number. Infinities and NaN are never allowed, nor numbers so small that products of them
// vanish.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;  // `least` itself is not allowed

  static Bounds any() { return {}; }
  static Bounds positive(double most = std::numeric_limits<double>::infinity()) { return {0, most, true}; }
  static Bounds non_negative(double most = std::numeric_limits<double>::infinity()) { return {0, most, false}; }
  static Bounds range(double least, double most) { return {least, most, false}; }

  bool allow(double value) const;
  std::string words() const;  // "must be positive"
};

// The words that a key may have, with their values.
template <class E>
using Words = std::vector<std::pair<const char*, E>>;

class TomlTable {
 public:
  static TomlTable parse(const std::string& text, const std::string& file);

  bool has(const std::string& key) const;
  bool is_string(const std::string& key) const;  // false where the key is missing
  bool is_array(const std::string& key) const;
  bool is_table(const std::string& key) const;
  const std::vector<std::string>& keys() const;  // sorted

  // From now on number() also reads { value = 1, standard_error = 0.1 }.
  void allow_standard_errors() const;
  // That of a number so written, in the unit of the key; none: the key has a plain number, or is missing.
  std::optional<double> standard_error(const std::string& key) const;

  // Required keys.
  double number(const std::string& key, const Bounds& bounds) const;
  long integer(const std::string& key, long least, long most) const;
  bool boolean(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::string string(const std::string& key) const;  // never empty
  std::vector<double> numbers(const std::string& key, const Bounds& bounds, std::size_t size) const;
  std::vector<double> list(const std::string& key, const Bounds& bounds) const;  // never empty
  // [[1, 2], [3, 4]]: at least one row of `columns` numbers.
  std::vector<std::vector<double>> rows(const std::string& key, const Bounds& bounds, std::size_t columns) const;
  std::vector<std::vector<double>> matrix(const std::string& key, const Bounds& bounds, std::size_t size) const;
  std::vector<long> integers(const std::string& key, long least, long most) const;  // never empty
  std::vector<std::string> strings(const std::string& key) const;                   // never empty, nor any of them
  template <class E>
  E word(const std::string& key, const Words<E>& words) const {
    std::vector<std::string> names;
    for (const auto& w : words) names.emplace_back(w.first);
    return words[word_index(key, names)].second;
  }

  // Optional keys.
  double number_or(const std::string& key, double fallback, const Bounds& bounds) const;
  long integer_or(const std::string& key, long fallback, long least, long most) const;
  bool boolean_or(const std::string& key, bool fallback) const;
  std::string string_or(const std::string& key, const std::string& fallback) const;
  template <class E>
  E word_or(const std::string& key, E fallback, const Words<E>& words) const {
    return has(key) ? word(key, words) : fallback;
  }

  // A table of this table; an empty table if it is missing. `form` says how to write it, unless it is [key] with
  // lines below.
  TomlTable table(const std::string& key, const std::string& form = "") const;
  // [[key]]; empty if it is missing.
  std::vector<TomlTable> tables(const std::string& key) const;

  // Refuses the first key that was not read, in this table and in the tables taken from it. `elsewhere` gets this
  // key and returns a remedy if it knows where the key belongs, otherwise an empty text.
  using Elsewhere = std::function<std::string(const std::string& key)>;
  void finish(const Elsewhere& elsewhere = {}) const;

  int line() const;                        // 0: the whole file, or a table that is missing
  int line(const std::string& key) const;  // that of the table where the key is missing
  const std::string& path() const;         // "contact.paper"; empty: the whole file
  InputError error(const std::string& key, const std::string& what, const std::string& remedy) const;

 private:
  struct Node;
  struct Stray;
  explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::size_t word_index(const std::string& key, const std::vector<std::string>& words) const;
  void find_stray(Stray& first) const;

  std::shared_ptr<Node> node_;
};

// A key as TOML has it, in quotes where it needs them.
std::string toml_key(const std::string& key);
// A text as a string of TOML.
std::string toml_string(const std::string& text);

// The word of `known` that `word` was probably meant to be; empty if none is similar.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace ropewalk
