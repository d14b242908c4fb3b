// Parts of the program's HTML pages. A page is one file, without references to other files; only the page in space
// (view/) has scripts.
#pragma once

#include <string>
#include <vector>

#include "io/measured.hpp"
#include "model/parameters.hpp"
#include "report/svg.hpp"

namespace ropewalk {

std::string paragraph(const std::string& html);
std::string heading(const std::string& text);

// The name of a column, which a narrow table may break behind each underscore; with its meaning for who points at it.
std::string head_cell(const std::string& name, const std::string& meaning = "");

// The number of the next figure.
class Figures {
 public:
  std::string caption(const std::string& html);

 private:
  int number_ = 0;
};

// Indices of at most `most` of n things, evenly spaced, with the first and the last.
std::vector<std::size_t> evenly(std::size_t n, std::size_t most);

struct TableColumn {
  std::string title;
  std::vector<double> values;
};
// A folded table under a figure, of at most 60 rows. `source` says where to find all rows.
std::string data_table(const std::vector<TableColumn>& columns, const char* source);

// A number of a set with its errors: "1518.960 ± 0.037 ± 205 (potential)", that of the fit and the spread between
// potentials. `and_unit`: with its unit, where it has one.
std::string measured_text(const Quantity& q, bool and_unit = false);

struct ReportFact {
  std::string key, value, remark;  // the remark may be empty
};
std::string facts_part(const std::vector<ReportFact>& facts);
std::string parameters_part(const std::string& name, const std::string& reference,
                            const std::vector<Quantity>& parameters);
std::string warnings_part(const std::vector<std::string>& warnings);

// Everything before <body>.
std::string page_head(const std::string& name);
// The head of a page with scripts in itself, and with more rules for its style.
std::string scripted_page_head(const std::string& name, const std::string& css, const std::string& nonce);

}  // namespace ropewalk
