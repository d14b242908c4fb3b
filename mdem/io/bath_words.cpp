#include "io/bath_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ropewalk {

std::string bath_words(const std::vector<LogRow>& log, double coupling) {
  constexpr std::size_t fewest_rows = 4;
  constexpr double well_held = 0.99;
  if (log.size() < fewest_rows || !(coupling > 0)) return "";
  const std::size_t from = log.size() / 2;
  const LogRow &first = log[from], &last = log.back();
  const auto grown = [&](const char* column) { return last[column] - first[column]; };
  // Work of the loads and energy that the rope had stored are dissipated too, and do not come from the bath.
  const double taken = std::min(grown("dissipated_eV") - grown("work_eV"), grown("thermostat_eV"));
  const double rate = taken / grown("time_ps");
  double kinetic = 0;
  for (std::size_t k = from; k < log.size(); ++k)
    kinetic += log[k]["kinetic_eV"] / static_cast<double>(log.size() - from);
  const double held = kinetic / (kinetic + 0.5 * rate / coupling);
  if (!(rate > 0) || held > well_held) return "";
  return fmt::format(
      "Friction and damping took {:.2g} eV/ps from the bath, and the tubes stayed at about {:.2g} % of its temperature: "
      "make thermostat.coupling_per_ps larger, or take away what takes the heat.",
      rate, 100 * held);
}

}  // namespace ropewalk
