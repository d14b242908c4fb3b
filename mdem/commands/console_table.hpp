#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "observe/observables.hpp"

namespace ropewalk {

// A table for the terminal. The words of a name stand one above the other, so that columns are narrow.
class Console {
 public:
  explicit Console(std::vector<Observable> columns) : columns_(std::move(columns)) {
    for (const Observable& o : columns_) {
      words_.push_back(words_of(o.name));
      std::size_t width = o.whole ? 4 : 9;
      for (const std::string& word : words_.back()) width = std::max(width, word.size());
      width_.push_back(width);
    }
  }

  void print_heading() const {
    std::size_t lines = 0;
    for (const auto& words : words_) lines = std::max(lines, words.size());
    for (std::size_t line = 0; line < lines; ++line)
      print_line([&](std::size_t k) { return line < words_[k].size() ? words_[k][line] : std::string(); });
  }

  void print_row(const Measurement& m) const {
    print_line([&](std::size_t k) {
      const double value = columns_[k].value(m);
      return columns_[k].whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
    });
  }

 private:
  static std::vector<std::string> words_of(const std::string& name) {
    std::vector<std::string> words(1);
    for (const char c : name) {
      if (c == '_') {
        words.emplace_back();
      } else {
        words.back() += c;
      }
    }
    return words;
  }

  template <class Cell>
  void print_line(const Cell& cell) const {
    std::string line;
    for (std::size_t k = 0; k < columns_.size(); ++k)
      line += fmt::format("{}{:>{}}", k == 0 ? "" : " ", cell(k), width_[k]);
    fmt::print("{}\n", line);
  }

  std::vector<Observable> columns_;
  std::vector<std::vector<std::string>> words_;
  std::vector<std::size_t> width_;
};

}  // namespace ropewalk
