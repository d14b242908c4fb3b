#include "run/events_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>

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

std::string events_header() { return column_names(event_columns()) + "\n"; }

std::string events_csv(const Topology& topology, const std::vector<TermEvent>& events) {
  return events_header() + event_lines(topology, events);
}

std::string event_lines(const Topology& topology, const std::vector<TermEvent>& events) {
  std::string text;
  for (const TermEvent& e : events) {
    const int a = topology.tube_of(e.a), b = topology.tube_of(e.b);
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", e.time, e.what, a, e.a - topology.tube_begin[a], b,
                        e.b - topology.tube_begin[b], e.place.x(), e.place.y(), e.place.z());
  }
  return text;
}

namespace {

// The lines of the file, one by one; none where there is no file.
template <class Line>
void each_event(const std::string& path, Line line) {
  if (!std::filesystem::exists(path)) return;
  CsvReader csv(path);
  const std::vector<OutputColumn> columns = event_columns();
  if (!csv.next() || csv.line_text() != column_names(columns))
    csv.fail("", "has another header", "bring the file back as `ropewalk run` wrote it");
  while (csv.next()) {
    if (csv.cells().size() != columns.size())
      csv.fail("", "has too few or too many columns", "bring the line back");
    line(csv, std::string(csv.cells()[1]));
  }
}

}  // namespace

std::vector<double> heights_of_breaks(const std::string& path) {
  std::vector<double> heights;
  each_event(path, [&](CsvReader& csv, const std::string& what) {
    if (what == "link broke" || what == "tube broke") heights.push_back(csv.finite_number(8, "z_nm"));
  });
  return heights;
}

bool is_break(const TermEvent& event) { return event.what == std::string("tube broke") && event.time > 0; }

std::vector<TubeBreak> tube_breaks(const std::string& path) {
  std::vector<TubeBreak> out;
  each_event(path, [&](CsvReader& csv, const std::string& what) {
    if (what != "tube broke") return;
    const double tube = csv.finite_number(2, "tube"), element = csv.finite_number(3, "element");
    if (!(tube >= 0 && tube < 1e9) || !(element >= 0 && element < 1e9))
      csv.fail("tube", "is no tube of a scene", "bring the line back");
    out.push_back({csv.finite_number(0, "time_ps"), static_cast<int>(tube), static_cast<int>(element)});
  });
  return out;
}

StoredEvents::StoredEvents(const std::string& path, const Topology& topology) : topology_(topology) {
  // The number of an element that the cells from `cell` on name.
  const auto element_at = [&](CsvReader& csv, std::size_t cell, const char* tube_name, const char* element_name,
                              int behind) {
    const double tube = csv.finite_number(cell, tube_name), element = csv.finite_number(cell + 1, element_name);
    if (!(tube >= 0 && tube < topology.tubes()) || tube != std::floor(tube))
      csv.fail(tube_name, "is no tube of the scene", "bring the line back");
    const int t = static_cast<int>(tube);
    if (!(element >= 0 && element + behind < topology.length_of(t)) || element != std::floor(element))
      csv.fail(element_name, behind > 0 ? "has no bond behind it" : "is no element of its tube",
               "bring the line back");
    return topology.tube_begin[static_cast<std::size_t>(t)] + static_cast<int>(element);
  };
  std::map<std::pair<int, int>, std::deque<std::size_t>> holding;  // links by the elements that they join
  each_event(path, [&](CsvReader& csv, const std::string& what) {
    const double time = csv.finite_number(0, "time_ps");
    if (what == "tube broke") {
      breaks_.push_back({time, element_at(csv, 2, "tube", "element", 1)});
    } else if (what == "link formed" || what == "link broke") {
      const int a = element_at(csv, 2, "tube", "element", 0), b = element_at(csv, 4, "to_tube", "to_element", 0);
      if (what == "link formed") {
        holding[{a, b}].push_back(links_.size());
        links_.push_back({a, b, time, std::numeric_limits<double>::infinity()});
        return;
      }
      const auto held = holding.find({a, b});
      if (held == holding.end() || held->second.empty()) return;
      links_[held->second.front()].broke = time;
      held->second.pop_front();
    }
  });
}

std::vector<std::pair<int, int>> StoredEvents::links_at(double time) const {
  std::vector<std::pair<int, int>> held;
  for (const Link& l : links_)
    if (l.formed <= time && time < l.broke) held.emplace_back(l.a, l.b);
  return held;
}

std::vector<char> StoredEvents::broken_at(double time) const {
  std::vector<char> broken;
  for (const Break& b : breaks_)
    if (b.time <= time) {
      broken.resize(static_cast<std::size_t>(topology_.elements()), 0);
      broken[static_cast<std::size_t>(b.element)] = 1;
    }
  return broken;
}

Topology StoredEvents::tubes_at(double time) const {
  const std::vector<char> broken = broken_at(time);
  return broken.empty() ? topology_ : cut_behind(topology_, broken);
}

}  // namespace ropewalk
