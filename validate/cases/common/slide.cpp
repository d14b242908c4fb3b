#include "cases/common/slide.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk::validate {

double Slide::mean() const {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < energy.size(); ++k) sum += energy[k];
  return sum / static_cast<double>(energy.size() - 1);
}

double Slide::corrugation() const {
  const auto [low, high] = std::minmax_element(energy.begin(), energy.end());
  return *high - *low;
}

double Slide::resistance(double element_length) const {
  double largest = 0;
  for (std::size_t k = 1; k < energy.size(); ++k)
    largest = std::max(largest, (energy[k] - energy[k - 1]) / (element_length * (shift[k] - shift[k - 1])));
  return largest;
}

std::vector<double> Slide::relative(double well) const {
  std::vector<double> out;
  for (const double e : energy) out.push_back(100 * (e - mean()) / std::fabs(well));
  return out;
}

double rows_energy(const ContactLaw& law, double element_length, const Places& rows,
                   const std::vector<double>& shift) {
  double sum = 0;
  for (std::size_t t = 0; t < rows.size(); ++t)
    for (std::size_t u = t + 1; u < rows.size(); ++u)
      for (int e = -30; e <= 30; ++e)
        sum += law.energy({},
                          {rows[u].first - rows[t].first, rows[u].second - rows[t].second,
                           (e + shift[u] - shift[t]) * element_length},
                          Vector3::UnitZ(), Vector3::UnitZ());
  return sum / element_length;
}

Slide slide_first(const ContactLaw& law, double element_length, const Places& rows) {
  Slide s;
  std::vector<double> shift(rows.size(), 0.0);
  for (int k = 0; k <= 40; ++k) {
    shift[0] = k / 40.0;
    s.shift.push_back(shift[0]);
    s.energy.push_back(rows_energy(law, element_length, rows, shift));
  }
  return s;
}

}  // namespace ropewalk::validate
