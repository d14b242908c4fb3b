#include "verbs/tables.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "io/files.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "model/units.hpp"

namespace ropewalk {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto from = cell.find_first_not_of(" \t\r"), to = cell.find_last_not_of(" \t\r");
    cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
  }
  return cells;
}

constexpr std::array<OutputColumn, 5> table = {{
    {"kind", "", "density, parallel or crossed"},
    {"distance_nm", "nm", "distance of the axes"},
    {"angle_deg", "deg", "angle between the axes"},
    {"energy", "eV/nm^2, eV/nm, eV",
     "surface integral: line density, energy per length of parallel tubes, energy of crossed ones"},
    {"fit", "as energy", "the line law fitted to it"},
}};

class ContactReader {
 public:
  explicit ContactReader(const std::string& path) : path_(path), lines_(read_file(path)) {}

  std::vector<ContactRow> read() {
    std::vector<ContactRow> rows;
    for (std::string line; std::getline(lines_, line);) {
      ++line_;
      const std::vector<std::string> cells = cells_of(line);
      if (cells.empty() || (cells.size() == 1 && cells[0].empty()) || line[0] == '#') continue;
      if (columns_ == 0) {
        read_header(cells);
        continue;
      }
      rows.push_back(row(cells));
    }
    if (rows.empty()) fail("", "holds no energies", "a line each: kind,distance_nm,angle_deg,energy");
    return rows;
  }

 private:
  [[noreturn]] void fail(const std::string& column, const std::string& what, const std::string& remedy) const {
    throw InputError({path_, line_, column}, what, remedy);
  }

  void read_header(const std::vector<std::string>& cells) {
    columns_ = cells.size();
    bool right = columns_ == 4 || columns_ == 5;
    for (std::size_t k = 0; right && k < columns_; ++k) right = cells[k] == table[k].name;
    if (!right)
      fail("", "is not the header of a table of contact energies", "write kind,distance_nm,angle_deg,energy");
  }

  ContactRow row(const std::vector<std::string>& cells) const {
    if (cells.size() != columns_)
      fail("", fmt::format("has {} columns, the header {}", cells.size(), columns_), "fill the line up");
    ContactRow r;
    r.kind = cells[0];
    if (r.kind != "density" && r.kind != "parallel" && r.kind != "crossed")
      fail("kind", fmt::format("is \"{}\"", printable(r.kind, 40)), "choose density, parallel or crossed");
    r.distance = number(cells[1], "distance_nm");
    if (!(r.distance > 0)) fail("distance_nm", fmt::format("is {}", r.distance), "must be positive");
    r.angle = number(cells[2], "angle_deg") * units::degree;
    if (r.kind == "crossed" && !(r.angle > 0 && r.angle <= 0.5 * units::pi + 1e-12))
      fail("angle_deg", fmt::format("is {}", cells[2]), "crossed tubes need an angle up to 90");
    r.energy = number(cells[3], "energy");
    r.fit = columns_ == 5 ? number(cells[4], "fit") : std::numeric_limits<double>::quiet_NaN();
    return r;
  }

  double number(const std::string& text, const char* column) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(column, fmt::format("is \"{}\"", printable(text, 40)), "write a number");
    return value;
  }

  std::string path_;
  std::istringstream lines_;
  std::size_t columns_ = 0;
  int line_ = 0;
};

}  // namespace

std::vector<OutputColumn> contact_columns() { return {table.begin(), table.end()}; }

std::vector<ContactRow> read_contact_csv(const std::string& path) { return ContactReader(path).read(); }

}  // namespace ropewalk
