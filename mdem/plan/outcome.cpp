#include "plan/outcome.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

constexpr double part = 0.25;       // of the time, at the end
constexpr double small_part = 0.1;  // part of the largest value
// Smaller angles, forces and torques are nothing that happens.
constexpr double least_angle = 1, least_force = 0.01;  // degrees; nN or nN nm

bool is_energy(const std::string& name) {
  return name == "energy" || (name.size() > 3 && name.compare(name.size() - 3, 3, "_eV") == 0);
}
double least_scale(const std::string& name) {
  const auto ends_with = [&](const std::string& unit) {
    return name.size() > unit.size() && name.compare(name.size() - unit.size(), unit.size(), unit) == 0;
  };
  if (ends_with("_deg")) return least_angle;
  return ends_with("_nN") || ends_with("_nN_nm") ? least_force : 0;
}

double value_of(const LogRow& row, const LogRow& first, const std::string& name) {
  if (name == "energy") return potential_energy(row) - potential_energy(first);
  return name == "vdw_eV" ? row[name] - first[name] : row[name];
}

double largest(const std::vector<LogRow>& log, const std::string& name) {
  double most = 0;
  for (const LogRow& row : log) {
    const double value = value_of(row, log.front(), name);
    if (std::isfinite(value)) most = std::max(most, std::fabs(value));
  }
  return most;
}

}  // namespace

Outcome outcome_of(const std::vector<LogRow>& log, const std::vector<std::string>& observables, bool relaxed) {
  const double begin = log.front()["time_ps"], end = log.back()["time_ps"];
  const double from = relaxed ? end : end - part * (end - begin);
  const double energy = largest(log, "energy");
  Outcome out;
  for (const std::string& name : observables) {
    double sum = 0;
    int count = 0;
    for (auto row = log.rbegin(); row != log.rend() && ((*row)["time_ps"] >= from || count == 0); ++row) {
      sum += value_of(*row, log.front(), name);
      ++count;
      if (relaxed) break;
    }
    Outcome::Value v{sum / count, 0};
    const double most = largest(log, name);
    if (most > 0) v.scale = std::max(std::fabs(v.value), small_part * (is_energy(name) ? energy : most));
    v.scale = std::max(v.scale, least_scale(name));
    out.of[name] = v;
  }
  return out;
}

const std::vector<std::string>& usual_observables() {
  static const std::vector<std::string> names = {"energy",   "twist_eV",           "bend_eV",
                                                 "beta_deg", "torque_upper_nN_nm", "tension_upper_nN"};
  return names;
}

std::map<std::string, double> differences(const Outcome& run, const Outcome& reference) {
  std::map<std::string, double> out;
  for (const auto& [name, r] : reference.of) {
    const auto at = run.of.find(name);
    if (at == run.of.end() || r.scale <= 0 || !std::isfinite(r.value) || !std::isfinite(at->second.value)) continue;
    out[name] = std::fabs(at->second.value - r.value) / r.scale;
  }
  return out;
}

}  // namespace ropewalk
