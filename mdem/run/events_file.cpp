#include "run/events_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "io/csv_reader.hpp"

namespace ropewalk {

std::vector<OutputColumn> event_columns() {
  return {{"time_ps", "ps", "when; 0: at the start"},
          {"event", "", "\"link formed\", \"link broke\" or \"tube broke\""},
          {"tube", "", "tube, from 0"},
          {"element", "", "its element, from 0"},
          {"to_tube", "", "the other tube"},
          {"to_element", "", "its element"},
          {"x_nm", "nm", "where"},
          {"y_nm", "nm", "where"},
          {"z_nm", "nm", "where"}};
}

std::string events_csv(const Topology& topology, const std::vector<TermEvent>& events) {
  std::string text = column_names(event_columns()) + "\n";
  for (const TermEvent& e : events) {
    const int a = topology.tube_of(e.a), b = topology.tube_of(e.b);
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", e.time, e.what, a, e.a - topology.tube_begin[a], b,
                        e.b - topology.tube_begin[b], e.place.x(), e.place.y(), e.place.z());
  }
  return text;
}

StoredBreaks::StoredBreaks(const std::string& path, const Topology& topology) : topology_(topology) {
  if (!std::filesystem::exists(path)) return;
  CsvReader csv(path);
  const std::vector<OutputColumn> columns = event_columns();
  if (!csv.next() || csv.line_text() != column_names(columns))
    csv.fail("", "has another header", "bring the file back as `ropewalk run` wrote it");
  while (csv.next()) {
    if (csv.cells().size() != columns.size())
      csv.fail("", "has too few or too many columns", "bring the line back");
    if (csv.cells()[1] != "tube broke") continue;
    const double time = csv.finite_number(0, "time_ps"), tube = csv.finite_number(2, "tube"),
                 element = csv.finite_number(3, "element");
    if (!(tube >= 0 && tube < topology.tubes()) || tube != std::floor(tube))
      csv.fail("tube", "is no tube of the scene", "bring the line back");
    const int t = static_cast<int>(tube);
    if (!(element >= 0 && element + 1 < topology.length_of(t)) || element != std::floor(element))
      csv.fail("element", "has no bond behind it", "bring the line back");
    breaks_.push_back({time, topology.tube_begin[static_cast<std::size_t>(t)] + static_cast<int>(element)});
  }
}

Topology StoredBreaks::tubes_at(double time) const {
  std::vector<char> broken(static_cast<std::size_t>(topology_.elements()), 0);
  bool some = false;
  for (const Break& b : breaks_)
    if (b.time <= time) broken[static_cast<std::size_t>(b.element)] = some = true;
  return some ? cut_behind(topology_, broken) : topology_;
}

}  // namespace ropewalk
