#include "observe/approach.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>

namespace ropewalk {
namespace {

using Vector = Eigen::VectorXd;

struct Fit {
  double limit = 0, time = 0, to_go = 0, statistics = 0, swing = 0;
  double creep = 0;  // slope of a straight line through the window as far as it is beyond two of its errors
};

// How many of the residuals count as independent.
double independent(const Vector& r) {
  const auto n = static_cast<double>(r.size());
  if (!(r.squaredNorm() > 0)) return n;
  const double alike = r.head(r.size() - 1).dot(r.tail(r.size() - 1)) / r.squaredNorm();
  return std::max(1.0, n * (1 - alike) / (1 + std::max(0.0, alike)));
}

double spread(const Vector& r) { return r.maxCoeff() - r.minCoeff(); }

// y0 + A e^(-u/tau), with u = 0 at the end of the window and -1 at its beginning, and e = 1 there.
struct Exponential {
  const Vector &u, &y;
  Eigen::MatrixXd columns(double tau) const {
    Eigen::MatrixXd m(u.size(), 2);
    m.col(0).setOnes();
    m.col(1) = (-(u.array() + 1) / tau).exp();
    return m;
  }
  Eigen::Vector2d coefficients(double tau) const { return columns(tau).colPivHouseholderQr().solve(y); }
  Vector residual(double tau) const { return y - columns(tau) * coefficients(tau); }
  double squares(double tau) const { return residual(tau).squaredNorm(); }
};

double best_time(const Exponential& e) {
  constexpr double shortest = 0.05, longest = 20;
  constexpr int places = 60;
  const auto place = [&](int k) {
    return shortest * std::pow(longest / shortest, static_cast<double>(k) / places);
  };
  int best = 0;
  for (int k = 1; k <= places; ++k)
    if (e.squares(place(k)) < e.squares(place(best))) best = k;
  double low = place(std::max(0, best - 1)), high = place(std::min(places, best + 1));
  for (int step = 0; step < 40; ++step) {
    const double a = low * std::pow(high / low, 0.382), b = low * std::pow(high / low, 0.618);
    (e.squares(a) < e.squares(b) ? high : low) = e.squares(a) < e.squares(b) ? b : a;
  }
  return std::sqrt(low * high);
}

double creep_of(const Vector& u, const Vector& y) {
  const Vector v = u.array() - u.mean();
  const double slope = v.dot(y) / v.squaredNorm();
  const Vector r = (y.array() - y.mean()).matrix() - slope * v;
  const double error = std::sqrt(r.squaredNorm() / independent(r) / v.squaredNorm());
  return std::max(0.0, std::fabs(slope) - 2 * error);
}

// An exponential that leaves more than `noise` of the squares about the mean is none.
Fit fit(const std::vector<double>& times, const std::vector<double>& values, double from, double to, double noise) {
  std::vector<double> t, v;
  for (std::size_t k = 0; k < times.size(); ++k)
    if (times[k] >= from && times[k] <= to) t.push_back(times[k]), v.push_back(values[k]);
  Fit out;
  if (static_cast<int>(t.size()) < least_rows_of_approach) {
    out.limit = v.empty() ? values.back() : v.back();
    out.statistics = std::numeric_limits<double>::infinity();
    return out;
  }
  const double window = t.back() - t.front();
  const Vector y = Eigen::Map<const Vector>(v.data(), static_cast<Eigen::Index>(v.size()));
  const Vector u =
      (Eigen::Map<const Vector>(t.data(), static_cast<Eigen::Index>(t.size())).array() - t.back()) / window;
  const auto n = static_cast<double>(t.size());
  const Vector about_mean = y.array() - y.mean();
  const Exponential e{u, y};
  const double tau = best_time(e);
  const Vector r = e.residual(tau);
  out.creep = creep_of(u, y) / window;
  // Noise, or nothing at all.
  if (!(r.squaredNorm() < noise * about_mean.squaredNorm())) {
    out.limit = y.mean();
    out.statistics = std::sqrt(about_mean.squaredNorm() / n / independent(about_mean));
    out.swing = spread(about_mean);
    return out;
  }
  const Eigen::Vector2d c = e.coefficients(tau);
  const Eigen::MatrixXd m = e.columns(tau);
  Eigen::MatrixXd jacobian(u.size(), 3);
  jacobian.leftCols(2) = m;
  jacobian.col(2) = c[1] * m.col(1).array() * (u.array() + 1) / tau;  // derivative with respect to ln(tau)
  const Eigen::Matrix3d covariance =
      (jacobian.transpose() * jacobian).inverse() * r.squaredNorm() / (n - 3) * n / independent(r);
  out.limit = c[0];
  out.time = tau * window;
  out.to_go = c[1] * m(u.size() - 1, 1);
  out.statistics = covariance(0, 0) >= 0 ? std::sqrt(covariance(0, 0)) : std::numeric_limits<double>::infinity();
  out.swing = spread(r);
  return out;
}

}  // namespace

Approach approach_of(const std::vector<double>& t, const std::vector<double>& y) {
  if (t.empty()) return {};
  const double end = t.back(), quarter = 0.25 * end;
  constexpr double half = 0.5, nearly_all = 0.9;
  const Fit third = fit(t, y, end - 2 * quarter, end - quarter, half), last = fit(t, y, end - quarter, end, half);
  Approach out{last.limit, 0, last.statistics, last.to_go, last.time, last.swing};
  const double apart = third.limit - last.limit;
  double correction = 0;
  if (third.time > 0 && last.time > 0) {
    const double q = std::exp(-2 * quarter / last.time);
    correction = apart * q / (1 - q);
  }
  out.limit -= correction;
  out.to_go += correction;
  out.drift = std::max(std::fabs(correction), 0.5 * std::fabs(apart));
  // A motion that the noise of one quarter hides.
  if (!(last.time > 0))
    out.drift = std::max(
        {out.drift, std::fabs(apart), std::fabs(fit(t, y, end - 2 * quarter, end, nearly_all).limit - last.limit)});
  // A slow motion behind a fast one that dies out: it may go on as long as the record is.
  if (last.time < 0.5 * quarter) out.drift = std::max(out.drift, last.creep * end);
  if (!std::isfinite(third.statistics)) out.drift = third.statistics;
  return out;
}

}  // namespace ropewalk
