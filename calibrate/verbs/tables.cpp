#include "verbs/tables.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "io/csv_reader.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "model/units.hpp"

namespace ropewalk::calibrate {
namespace {

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
  explicit ContactReader(const std::string& path) : csv_(path) {}

  std::vector<ContactRow> read() {
    if (csv_.next()) read_header();
    std::vector<ContactRow> rows;
    while (csv_.next()) rows.push_back(row());
    if (rows.empty()) csv_.fail("", "holds no energies", "a line each: kind,distance_nm,angle_deg,energy");
    return rows;
  }

 private:
  void read_header() {
    columns_ = csv_.cells().size();
    bool right = columns_ == 4 || columns_ == 5;
    for (std::size_t k = 0; right && k < columns_; ++k) right = csv_.cells()[k] == table[k].name;
    if (!right)
      csv_.fail("", "is not the header of a table of contact energies", "write kind,distance_nm,angle_deg,energy");
  }

  ContactRow row() const {
    if (csv_.cells().size() != columns_)
      csv_.fail("", fmt::format("has {} columns, the header {}", csv_.cells().size(), columns_),
                "fill the line up");
    ContactRow r;
    r.line = csv_.line_number();
    r.kind = csv_.cells()[0];
    if (r.kind != "density" && r.kind != "parallel" && r.kind != "crossed")
      csv_.fail("kind", fmt::format("is \"{}\"", printable(r.kind, 40)), "choose density, parallel or crossed");
    r.distance = csv_.finite_number(1, "distance_nm");
    if (!(r.distance > 0)) csv_.fail("distance_nm", fmt::format("is {}", r.distance), "must be positive");
    r.angle = csv_.finite_number(2, "angle_deg") * units::degree;
    if (r.kind == "crossed" && !(r.angle > 0 && r.angle <= 0.5 * units::pi + 1e-12))
      csv_.fail("angle_deg", fmt::format("is {}", csv_.cells()[2]), "crossed tubes need an angle up to 90");
    r.energy = csv_.finite_number(3, "energy");
    r.fit = columns_ == 5 ? csv_.finite_number(4, "fit") : std::numeric_limits<double>::quiet_NaN();
    return r;
  }

  CsvReader csv_;
  std::size_t columns_ = 0;
};

}  // namespace

std::vector<OutputColumn> contact_columns() { return {table.begin(), table.end()}; }

std::vector<ContactRow> read_contact_csv(const std::string& path) { return ContactReader(path).read(); }

}  // namespace ropewalk::calibrate
