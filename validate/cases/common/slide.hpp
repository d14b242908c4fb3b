// Long parallel rows of elements or beads that slide along one another: mean energy and corrugation.
#pragma once

#include <vector>

#include "cases/common/straight_tubes.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk::validate {

struct Slide {
  std::vector<double> shift, energy;  // in elements, both ends of the period included; eV/nm

  double mean() const;
  double corrugation() const;  // highest less lowest energy
  // Difference from the mean, in percent of the well.
  std::vector<double> relative(double well) const;
};

// The first row slides by one element along the others.
Slide slide_first(const ContactLaw& law, double element_length, const Places& rows);

}  // namespace ropewalk::validate
