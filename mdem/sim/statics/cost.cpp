#include "sim/statics/cost.hpp"

#include <omp.h>

#include <Eigen/Dense>

#include "sim/dynamics/modes.hpp"
#include "sim/statics/allowed_motions.hpp"
#include "sim/statics/solvers.hpp"
#include "sim/statics/stability.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {
namespace {

// As measured; docs/performance.md.
constexpr double first_steps = 30, next_steps = 9, products_of_step = 60, solves_of_modes = 120;
constexpr double bytes_per_second = 4e9;  // of a decomposition that is read again for each solution

template <class Work>
double seconds_of(const Work& work) {
  const double began = omp_get_wtime();
  work();
  return omp_get_wtime() - began;
}

double operations_per_second() {
  constexpr Eigen::Index n = 256;
  Eigen::setNbThreads(1);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5), b = Eigen::MatrixXd::Constant(n, n, 0.25);
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  const double seconds = seconds_of([&] { c.noalias() += a * b; });
  Eigen::setNbThreads(0);
  return c.sum() > 0 ? 2.0 * n * n * n / seconds : 1e9;
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
  out.stability_seconds = decomposition.operations / operations_per_second() +
                          solves_of_modes * out.decomposition_bytes / bytes_per_second + 2 * making;
  return out;
}

}  // namespace ropewalk
