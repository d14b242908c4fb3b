// Targets of the fit of a line density: the parallel and the crossed energy of one pair of tubes on a grid of
// distances. The same two energies of a candidate density are sums over fixed nodes.
#pragma once

#include <vector>

#include "contact/integral.hpp"
#include "fit/least_squares.hpp"
#include "model/contact/line.hpp"

namespace ropewalk::calibrate {

// Gaps at which the closed form is switched off and continued into the core, for an atom-atom law. If this law has
// a cutoff, u ends in a corner at that gap. The smooth switch approximates the corner best if it begins early and
// ends beyond it. Both gaps give the smallest error over radii from 0.2 to 1.4 nm.
struct LineGaps {
  double core, switching, cutoff;  // nm
};
LineGaps line_gaps(const AtomLaw& law);
LineDensity with_gaps(const LineGaps& gaps, double contact);

// The unit of K: eps n_i n_j sigma^2.
double unit_of_K(const AtomLaw& law, const Shell& i, const Shell& j);

class LineTargets {
 public:
  LineTargets(const WallsIntegral& integral, double contact, const LineGaps& gaps);

  std::size_t size() const { return 2 * distance_.size(); }
  // Both energies of a density at all distances.
  void energies(const LineDensity& density, std::vector<double>& parallel, std::vector<double>& crossed) const;
  // Differences relative to the depth of the wells, with small weights in strong repulsion; size() numbers.
  void residuals(const LineDensity& density, double* out) const;
  // The largest difference over the well, from 0.05 nm inside of the minimum outwards.
  double error(const LineDensity& density) const;

  Well parallel_well, crossed_well;
  const std::vector<double>& distances() const { return distance_; }
  const std::vector<double>& parallel() const { return parallel_; }
  const std::vector<double>& crossed() const { return crossed_; }

 private:
  void add_nodes(double end);

  std::vector<double> distance_, parallel_, crossed_;
  std::vector<double> weight_parallel_, weight_crossed_;  // weights of the residuals
  std::vector<double> node_, node_crossed_;               // nodes in rho and their weights in X
  std::vector<double> node_parallel_;                     // weights in E, a row for each distance
};

// Fits the closed form to the targets; the free parameters are written to `density`.
FitResult fit_density(const LineTargets& targets, const AtomLaw& law, double unit, const FitOptions& options,
                      LineDensity& density);

}  // namespace ropewalk::calibrate
