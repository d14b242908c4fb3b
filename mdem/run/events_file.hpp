// events.csv: what force terms did in the course of a run (ForceTerm::events), in the order of time. It grows with the
// run as the log does.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/outputs.hpp"
#include "io/run_results.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

std::vector<OutputColumn> event_columns();
std::string events_header();
std::string event_lines(const Topology& topology, const std::vector<TermEvent>& events);
std::string events_csv(const Topology& topology, const std::vector<TermEvent>& events);

// Whether a bond of a tube broke after the start.
bool is_break(const TermEvent& event);

// The bonds of tubes that broke; none where there is no file. Throws InputError where a line is not right.
std::vector<TubeBreak> tube_breaks(const std::string& path);

// Heights of the links and tubes that broke, nm; none where there is no file. Throws InputError where a line is wrong.
std::vector<double> heights_of_breaks(const std::string& path);

// What the file of a run tells of its links and tubes; nothing where there is no file. Throws InputError where it
// tells of elements that the scene does not have.
class StoredEvents {
 public:
  struct Link {
    int a = 0, b = 0;              // elements
    double formed = 0, broke = 0;  // ps; broke: infinity, it holds at the end
  };
  StoredEvents(const std::string& path, const Topology& topology);
  bool any_breaks() const { return !breaks_.empty(); }
  // Whether the tube has broken behind each element at this time (ps); empty: none has.
  std::vector<char> broken_at(double time) const;
  // The tubes at this time (ps), cut where they have broken.
  Topology tubes_at(double time) const;
  // All that ever held.
  const std::vector<Link>& links() const { return links_; }
  // The elements that links join at this time (ps). A file whose lines were taken away may lack some.
  std::vector<std::pair<int, int>> links_at(double time) const;

 private:
  struct Break {
    double time = 0;  // ps
    int element = 0;  // before it
  };
  Topology topology_;
  std::vector<Break> breaks_;
  std::vector<Link> links_;
};

}  // namespace ropewalk
