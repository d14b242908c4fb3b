// A mean over time with its standard error, from one record whose neighbouring values are alike.
//
// With the autocovariance G(k) of values k rows apart, the variance of the mean of n values is C/n,
//
//   C = G(0) + 2 (G(1) + ... + G(w)),   tau = C/2 G(0)
//
// tau is the correlation time in rows (0.5 for independent values), and n/2 tau values count as independent. The
// sum ends at the first w above 5 tau. Deviations are from the mean of the record, which makes each G too small by
// C/n; this is added. U. Wolff, Comput. Phys. Commun. 156, 143 (2004), DOI 10.1016/S0010-4655(03)00467-3. A value
// that drifts has a long correlation time and no error.
#pragma once

#include <vector>

namespace ropewalk {

struct TimeMean {
  double mean = 0;
  double error = 0;        // nan: the record is too short for one
  double rows = 0;         // tau
  double independent = 0;  // values
  double rows_needed = 0;  // for an error, where there is none
};

inline constexpr double least_independent = 30;

// Mean of values at even times.
TimeMean time_mean(const std::vector<double>& values);

}  // namespace ropewalk
