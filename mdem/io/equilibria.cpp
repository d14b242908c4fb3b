#include "io/equilibria.hpp"

#include <fmt/format.h>

#include "io/csv_reader.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t count_of_columns = 9;

Equilibrium::Stability read_stability(const CsvReader& csv) {
  for (const Equilibrium::Stability s :
       {Equilibrium::Stability::stable, Equilibrium::Stability::unstable, Equilibrium::Stability::unknown})
    if (csv.cells()[2] == name_of(s)) return s;
  csv.fail("stability", "is none of stable, unstable and unknown", "run the scene anew");
}

}  // namespace

const char* name_of(Equilibrium::Stability stability) {
  switch (stability) {
    case Equilibrium::Stability::stable:
      return "stable";
    case Equilibrium::Stability::unstable:
      return "unstable";
    case Equilibrium::Stability::unknown:
      return "unknown";
  }
  return "";
}

std::vector<OutputColumn> rest_columns() {
  return {
      {"stability", "",
       "stable: no motion grows faster than the error of its rate; unstable: one does; unknown: it cannot be told"},
      {"growth_per_ns", "1/ns", "rate of the motion that grows fastest, negative: all decay; nan: not known"},
      {"error_per_ns", "1/ns", "smaller rates cannot be told from zero; nan: not known"},
      {"force_eV_per_nm", "eV/nm", "largest force that is left on a free element"},
      {"moment_eV", "eV", "largest moment that is left"},
      {"above_eV", "eV", "energy above that of exact rest, by estimate"},
      {"saddles", "", "saddles of the energy that it left on the way from the state before"}};
}

std::string rest_cells(const Equilibrium& e) {
  return fmt::format("{},{},{},{},{},{},{}", name_of(e.stability), e.growth, e.error, e.force, e.moment, e.above,
                     e.saddles);
}

std::vector<OutputColumn> equilibria_columns() {
  std::vector<OutputColumn> all = {{"step", "", "of the row of log.csv with this state"},
                                   {"time_ps", "ps", "in the schedules of the scene"}};
  const std::vector<OutputColumn> of_rest = rest_columns();
  all.insert(all.end(), of_rest.begin(), of_rest.end());
  return all;
}

std::string equilibria_csv(const Equilibria& all) {
  std::string text = column_names(equilibria_columns()) + "\n";
  for (const Equilibrium& e : all) text += fmt::format("{},{},{}\n", e.step, e.time, rest_cells(e));
  return text;
}

Equilibria read_equilibria(const std::string& path) {
  const std::vector<OutputColumn> columns = equilibria_columns();
  CsvReader csv(path);
  Equilibria all;
  if (!csv.next() || csv.line_text() != column_names(columns))
    csv.fail("", "has other columns than this program writes", "run the scene anew");
  while (csv.next()) {
    if (csv.cells().size() != count_of_columns) csv.fail("", "has another number of cells", "run the scene anew");
    const auto number = [&](std::size_t k) { return csv.number(k, columns[k].name); };
    Equilibrium e;
    e.step = static_cast<std::int64_t>(csv.finite_number(0, columns[0].name));
    e.time = csv.finite_number(1, columns[1].name);
    e.stability = read_stability(csv);
    e.growth = number(3);
    e.error = number(4);
    e.force = number(5);
    e.moment = number(6);
    e.above = number(7);
    e.saddles = static_cast<int>(csv.finite_number(8, columns[8].name));
    all.push_back(e);
  }
  return all;
}

}  // namespace ropewalk
