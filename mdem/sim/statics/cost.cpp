#include "sim/statics/cost.hpp"

#include <Eigen/Dense>
#include <ctime>

#include "sim/dynamics/modes.hpp"
#include "sim/statics/allowed_motions.hpp"
#include "sim/statics/solvers.hpp"
#include "sim/statics/stability.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {
namespace {

// As measured; docs/performance.md.
constexpr double first_steps = 20, next_steps = 8, products_of_step = 30, solves_of_modes = 130;
constexpr double sparse_copies = 9;       // copies of K for the modes
constexpr double bytes_per_second = 4e9;  // rate at which each solution reads the decomposition

// Processor time of some work: other programs may use the processor as well.
template <class Work>
double seconds_of(const Work& work) {
  const std::clock_t began = std::clock();
  work();
  return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
}

double operations_per_second() {
  constexpr Eigen::Index n = 256;
  Eigen::setNbThreads(1);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5), b = Eigen::MatrixXd::Constant(n, n, 0.25);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  const double seconds = seconds_of([&] { c.noalias() += a * b; });
  Eigen::setNbThreads(0);
  return c.sum() > 0 && seconds > 0 ? 2.0 * n * n * n / seconds : 1e9;
}

}  // namespace

StaticsCost statics_cost(const Simulation& s) {
  StaticsCost out;
  StiffnessMaker maker(s);
  maker.make(s);
  const BlockMatrix* k = nullptr;
  const double making = seconds_of([&] { k = &maker.make(s); });
  const AllowedMotions allowed(s);
  const Sections sections = sections_of(s.topology(), s.state());
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(allowed.mass().size());
  Eigen::VectorXd y, z;
  const double preparing = seconds_of([&] {
    const Preconditioner m(s.topology(), s.state(), sections, *k, allowed.mass(), 1, allowed.held());
    m.solve(x, z);
  });
  const Preconditioner m(s.topology(), s.state(), sections, *k, allowed.mass(), 1, allowed.held());
  const double product = seconds_of([&] {
    k->multiply(x, y);
    m.solve(y, z);
  });
  const double step = making + preparing + products_of_step * product;
  out.first_seconds = first_steps * step;
  out.next_seconds = next_steps * step;
  const SlabCost decomposition = cost_of_decomposition(s);
  out.bytes = static_cast<double>(k->bytes() + 3 * s.bytes());
  if (decomposition.operations > affordable_operations) return out;
  out.decomposition_bytes = decomposition.numbers * sizeof(double);
  out.bytes += sparse_copies * static_cast<double>(k->bytes());
  out.stability_seconds = 2 * decomposition.operations / operations_per_second() +
                          solves_of_modes * out.decomposition_bytes / bytes_per_second + 2 * making;
  return out;
}

}  // namespace ropewalk
