#include "io/potential_spread.hpp"

#include <cmath>

namespace ropewalk {
namespace {

double PotentialStiffness::*stiffness_of(const std::string& key) {
  if (key == "bond.EA") return &PotentialStiffness::EA;
  if (key == "bond.EI") return &PotentialStiffness::EI;
  if (key == "bond.GJ" || key == "bond.kGA") return &PotentialStiffness::GJ;
  return nullptr;
}

double mean_of(double PotentialStiffness::*q) {
  double sum = 0;
  for (const PotentialStiffness& p : potentials_of_carbon) sum += p.*q;
  return sum / static_cast<double>(potentials_of_carbon.size());
}

}  // namespace

double potential_covariance(const std::string& one, const std::string& other) {
  const auto a = stiffness_of(one), b = stiffness_of(other);
  if (!a || !b) return 0;
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  double sum = 0;
  for (const PotentialStiffness& p : potentials_of_carbon) sum += (p.*a / mean_a - 1) * (p.*b / mean_b - 1);
  return sum / static_cast<double>(potentials_of_carbon.size() - 1);
}

double potential_spread(const std::string& key) { return std::sqrt(potential_covariance(key, key)); }

}  // namespace ropewalk
