#include "cases/common/slide.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk::validate {
namespace {

// Energy per length (eV/nm) of rows of which the first is shifted by this part of an element.
double rows_energy(const ContactLaw& law, double element_length, const Places& rows, double shift) {
  double sum = 0;
  for (std::size_t t = 0; t < rows.size(); ++t)
    for (std::size_t u = t + 1; u < rows.size(); ++u)
      for (int e = -30; e <= 30; ++e)
        sum += law.energy({},
                          {rows[u].first - rows[t].first, rows[u].second - rows[t].second,
                           (t == 0 ? e - shift : e) * element_length},
                          Vector3::UnitZ(), Vector3::UnitZ());
  return sum / element_length;
}

}  // namespace

double Slide::mean() const {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < energy.size(); ++k) sum += energy[k];
  return sum / static_cast<double>(energy.size() - 1);
}

double Slide::corrugation() const {
  const auto [low, high] = std::minmax_element(energy.begin(), energy.end());
  return *high - *low;
}

std::vector<double> Slide::relative(double well) const {
  std::vector<double> out;
  for (const double e : energy) out.push_back(100 * (e - mean()) / std::fabs(well));
  return out;
}

Slide slide_first(const ContactLaw& law, double element_length, const Places& rows) {
  Slide s;
  for (int k = 0; k <= 40; ++k) {
    s.shift.push_back(k / 40.0);
    s.energy.push_back(rows_energy(law, element_length, rows, s.shift.back()));
  }
  return s;
}

}  // namespace ropewalk::validate
