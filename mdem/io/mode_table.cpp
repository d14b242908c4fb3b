#include "io/mode_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/units.hpp"

namespace ropewalk {
namespace {

struct ModeColumn {
  OutputColumn column;
  double (*value)(const ModeRow&);
};

const std::vector<ModeColumn>& mode_table() {
  static const std::vector<ModeColumn> table = {
      {{"rate_per_ns", "1/ns", "growth rate; negative: the motion decays"},
       [](const ModeRow& r) { return r.rate.real(); }},
      {{"frequency_GHz", "GHz", "of its swing; 0: none"}, [](const ModeRow& r) { return r.frequency(); }},
      {{"residual_per_ns", "1/ns", "error of the rate by the forces that are left over"},
       [](const ModeRow& r) { return r.residual; }},
      {{"neutral", "", "1: cannot be told from a motion that changes nothing"},
       [](const ModeRow& r) { return r.neutral ? 1.0 : 0.0; }},
      {{"sideways", "", "share of the kinetic energy: cross-sections as a whole, across the centre line"},
       [](const ModeRow& r) { return r.shape.shares.sideways; }},
      {{"stretch", "", "likewise, along it"}, [](const ModeRow& r) { return r.shape.shares.stretch; }},
      {{"turn", "", "likewise, about it"}, [](const ModeRow& r) { return r.shape.shares.turn; }},
      {{"slip", "", "tubes along themselves within cross-sections"},
       [](const ModeRow& r) { return r.shape.shares.slip; }},
      {{"section", "", "what else changes the cross-sections"},
       [](const ModeRow& r) { return r.shape.shares.section; }},
      {{"spin", "", "elements about their own axes"}, [](const ModeRow& r) { return r.shape.shares.spin; }},
      {{"tilt", "", "elements about other axes"}, [](const ModeRow& r) { return r.shape.shares.tilt; }},
      {{"windings", "",
        "turns of the centre line about its chord, positive for a right-handed helix; nan: it does not move"},
       [](const ModeRow& r) { return r.shape.windings; }},
      {{"half_waves", "", "of the centre line, in the plane in which it moves most; nan: it does not move"},
       [](const ModeRow& r) { return r.shape.half_waves; }}};
  return table;
}

}  // namespace

double ModeRow::frequency() const { return std::fabs(rate.imag()) / (2 * units::pi); }

std::vector<OutputColumn> mode_columns() {
  std::vector<OutputColumn> columns;
  for (const ModeColumn& c : mode_table()) columns.push_back(c.column);
  return columns;
}

std::string modes_csv(const std::vector<ModeRow>& rows) {
  std::string text = column_names(mode_columns()) + "\n";
  for (const ModeRow& row : rows) {
    std::string line;
    for (const ModeColumn& c : mode_table()) line += (line.empty() ? "" : ",") + fmt::format("{}", c.value(row));
    text += line + "\n";
  }
  return text;
}

}  // namespace ropewalk
