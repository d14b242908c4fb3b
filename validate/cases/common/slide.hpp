// The energy of a row of elements or beads that slides along others by one element: its mean and its corrugation.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace ropewalk::validate {

struct Slide {
  std::vector<double> shift, energy;  // in elements, both ends of the period included; eV/nm

  double mean() const {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < energy.size(); ++k) sum += energy[k];
    return sum / static_cast<double>(energy.size() - 1);
  }
  // Highest less lowest energy.
  double corrugation() const {
    const auto [low, high] = std::minmax_element(energy.begin(), energy.end());
    return *high - *low;
  }
  // Largest force per length that resists sliding, eV/nm^2.
  double resistance(double element_length) const {
    double largest = 0;
    for (std::size_t k = 1; k < energy.size(); ++k)
      largest = std::max(largest, (energy[k] - energy[k - 1]) / (element_length * (shift[k] - shift[k - 1])));
    return largest;
  }
  // Difference from the mean, in percent of the well.
  std::vector<double> relative(double well) const {
    std::vector<double> out;
    for (const double e : energy) out.push_back(100 * (e - mean()) / std::fabs(well));
    return out;
  }
};

}  // namespace ropewalk::validate
