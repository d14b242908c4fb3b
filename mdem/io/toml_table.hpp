// A strict reader of TOML. A table remembers which keys were asked for, and finish() refuses the rest; every
// error is an InputError with file, line and key, in one line, and says what to do.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/error.hpp"

namespace ropewalk {

// What a number may be. Infinities and NaN never pass.
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

// The words that a key may have, and what they stand for.
template <class E>
using Words = std::vector<std::pair<const char*, E>>;

class TomlTable {
 public:
  static TomlTable parse(const std::string& text, const std::string& file);

  bool has(const std::string& key) const;
  bool is_string(const std::string& key) const;  // false where the key is missing
  const std::vector<std::string>& keys() const;  // sorted

  // Required keys.
  double number(const std::string& key, const Bounds& bounds) const;
  long integer(const std::string& key, long least, long most) const;
  bool boolean(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::string string(const std::string& key) const;  // never empty
  std::vector<double> numbers(const std::string& key, const Bounds& bounds, std::size_t size) const;
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

  // A table of this table; an empty one where it is missing. `form` is how to write it where that is not
  // [key] and lines below.
  TomlTable table(const std::string& key, const std::string& form = "") const;
  // [[key]]; none where it is missing.
  std::vector<TomlTable> tables(const std::string& key) const;

  // Refuses the first key, here and in the tables taken from here, that nobody asked for. `elsewhere` may
  // know where such a key belongs: it is given the key and returns a remedy, or nothing.
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

// Control characters as escapes, and no longer than a line of a message can bear.
std::string printable(const std::string& text, std::size_t longest = 200);

// The one of `known` that `word` was probably meant to be; empty where none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace ropewalk
