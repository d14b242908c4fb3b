// Tables of comma-separated values, line by line.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "model/error.hpp"

namespace ropewalk {

// Blank lines are skipped; spaces around cells, a byte order mark and Windows line ends are accepted. A line that
// begins with # is a comment. A cell in double quotes may hold commas, and two quotes for one. Views hold until the
// next line is read.
class CsvReader {
 public:
  // A table that grows while it is written may end within a line, which is then not read.
  enum class LastLine { whole, may_be_cut_off };

  explicit CsvReader(const std::string& path, LastLine last = LastLine::whole);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  // The next line that holds cells; false at the end. Throws InputError where a cell holds a control character.
  bool next();
  const std::vector<std::string_view>& cells() const { return cells_; }
  // Comments before this line, without # and the spaces after it.
  const std::vector<std::string_view>& comments() const { return comments_; }
  std::string_view line_text() const { return line_; }
  int line_number() const { return number_; }

  // A number of this line, NaN and infinities too. Throws InputError with `remedy`.
  double number(std::size_t cell, std::string_view column, const char* remedy = "write a number") const;
  double finite_number(std::size_t cell, std::string_view column, const char* remedy = "write a number") const;

  InputError error(std::string_view column, const std::string& what, const std::string& remedy) const;
  // Throws InputError at this line.
  [[noreturn]] void fail(std::string_view column, const std::string& what, const std::string& remedy) const;

 private:
  void split(std::string_view line);
  std::string_view take_quoted(std::string_view& line);

  std::string path_, text_;
  std::string_view rest_, line_;
  LastLine last_;
  std::vector<std::string_view> cells_, comments_;
  std::deque<std::string> unquoted_;  // cells with a quote in them
  int number_ = 0;
};

// A cell for a line of such a table: in quotes where it holds a comma, a quote or a newline, and with ' before it
// where a table calculation would take it for a formula.
std::string csv_cell(const std::string& text);

}  // namespace ropewalk
