// events.csv: what force terms did in the course of a run (ForceTerm::events), in the order of time.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

std::vector<OutputColumn> event_columns();
std::string events_csv(const Topology& topology, const std::vector<TermEvent>& events);

// The breaks of tubes that the file of a run tells of; none where there is no file. Throws InputError where it
// tells of elements that the scene does not have.
class StoredBreaks {
 public:
  StoredBreaks(const std::string& path, const Topology& topology);
  bool any() const { return !breaks_.empty(); }
  // The tubes at this time (ps), cut where they have broken.
  Topology tubes_at(double time) const;

 private:
  struct Break {
    double time = 0;  // ps
    int element = 0;  // before it
  };
  Topology topology_;
  std::vector<Break> breaks_;
};

}  // namespace ropewalk
