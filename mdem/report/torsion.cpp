#include "report/torsion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ropewalk {
namespace {

constexpr double half_torque = 0.5;  // part of the largest torque

// Names of columns in result_columns().
const char* const shown[] = {"torque_max_nN_nm", "torque_max_at_deg", "torque_within_nN_nm", "first_limit_deg",
                             "first_break_deg",  "tubes_broken",      "stored_at_limit_MJ_per_kg"};

template <class Use>
void each_shown(const Use& use) {
  const std::vector<OutputColumn> all = result_columns();
  for (const char* name : shown)
    for (std::size_t k = 0; k < all.size(); ++k)
      if (std::string(all[k].name) == name) use(k, all[k]);
}

}  // namespace

LoadTest torsion_test(const std::vector<LogRow>& log, const RunResults& r) {
  if (!std::isfinite(r.torque_max)) throw std::invalid_argument("nothing twists in it");
  const auto torque = torque_of(log);
  const auto at = std::find_if(log.begin(), log.end(),
                               [&](const LogRow& row) { return std::fabs(torque(row)) == r.torque_max; });
  LoadTest out{*at, {}, std::any_of(at, log.end(), [&](const LogRow& row) {
                 return std::fabs(torque(row)) < half_torque * r.torque_max;
               })};
  const std::vector<double> values = result_values(r);
  each_shown([&](std::size_t k, const OutputColumn&) { out.values.push_back(values[k]); });
  return out;
}

const LoadTestKind& torsion_kind() {
  static const LoadTestKind kind = [] {
    LoadTestKind k{
        "Torsion",
        "Torque about z that twists the rope, averaged over both ends and over the time between two rows. \"To "
        "half\" says in how many runs it has fallen to half of its largest value.",
        "largest torque",
        "nN nm",
        {}};
    each_shown([&](std::size_t, const OutputColumn& column) { k.columns.push_back(column); });
    return k;
  }();
  return kind;
}

}  // namespace ropewalk
