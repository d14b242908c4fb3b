#include "run/events_file.hpp"

#include <fmt/format.h>

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

}  // namespace ropewalk
