#include "fit/least_squares.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <nlopt.hpp>
#include <random>
#include <stdexcept>

#include "io/clocks.hpp"

namespace ropewalk::calibrate {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double on_bound = 1e-9;    // fraction of the box: a parameter so close to a bound is at the bound
constexpr double rank_limit = 1e-8;  // relative to the largest singular value of J with columns of unit length
constexpr double bad_point = 1e12;   // objective where a residual is not finite; elsewhere it is about 1

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

// The problem in box coordinates: every free parameter runs from 0 (lower) to 1 (upper). Counts evaluations, checks
// for numbers that are not finite, and keeps the best point.
class Problem {
 public:
  Problem(const std::vector<FitParameter>& parameters, std::size_t residuals, const Residuals& function,
          const FitOptions& options)
      : parameters_(parameters), function_(function), options_(options), r_(residuals), begin_(steady_seconds()) {
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      p_.push_back(parameters[k].start);
      if (parameters[k].free) free_.push_back(k);
    }
    set_share(1);
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(free_.size()); }
  Eigen::Index residuals() const { return static_cast<Eigen::Index>(r_.size()); }
  const FitParameter& parameter(Eigen::Index j) const { return parameters_[free_[static_cast<std::size_t>(j)]]; }
  double width(Eigen::Index j) const { return parameter(j).upper - parameter(j).lower; }

  Vector start() const {
    Vector x(size());
    for (Eigen::Index j = 0; j < size(); ++j) x[j] = (parameter(j).start - parameter(j).lower) / width(j);
    return x;
  }

  const std::vector<double>& values(const Vector& x) {
    for (Eigen::Index j = 0; j < size(); ++j) {
      const FitParameter& a = parameter(j);
      p_[free_[static_cast<std::size_t>(j)]] = std::clamp(a.lower + x[j] * width(j), a.lower, a.upper);
    }
    return p_;
  }

  // Residuals at x, moved into the box. Returns false if one is not finite or their squares overflow. Throws
  // nlopt::forced_stop at a limit and if the caller's function throws.
  bool evaluate(const Vector& x, Vector& r) {
    if (evaluations >= max_evaluations_ || seconds() >= max_seconds_) throw nlopt::forced_stop();
    ++evaluations;
    std::fill(r_.begin(), r_.end(), 0.0);
    try {
      function_(values(x), r_);
    } catch (...) {
      failure = std::current_exception();
      throw nlopt::forced_stop();
    }
    r = Eigen::Map<const Vector>(r_.data(), residuals());
    const double chi2 = r.squaredNorm();
    if (!std::isfinite(chi2)) {
      ++not_finite;
      return false;
    }
    if (chi2 < best_chi2) {
      best_chi2 = chi2;
      best = x.cwiseMax(0.0).cwiseMin(1.0);
      best_r = r;
    }
    return true;
  }

  // The Jacobian by central differences about r = residuals(x). The steps also suit a parameter far smaller than
  // its box.
  Matrix jacobian(const Vector& x, const Vector& r) {
    Matrix j(residuals(), size());
    for (Eigen::Index k = 0; k < size(); ++k) j.col(k) = column(x, r, k);
    return j;
  }

  // Limits the following evaluations and time to this share of the total.
  void set_share(double share) {
    max_evaluations_ = static_cast<int>(share * options_.max_evaluations);
    max_seconds_ = share * options_.max_seconds;
  }
  // Lifts the limits for the few evaluations that describe the result.
  void lift_limits() {
    max_evaluations_ = std::numeric_limits<int>::max();
    max_seconds_ = infinite;
  }

  double seconds() const { return seconds_since(begin_); }

  int evaluations = 0, not_finite = 0;
  std::exception_ptr failure;
  double best_chi2 = infinite;
  Vector best, best_r;

 private:
  Vector column(const Vector& x, const Vector& r, Eigen::Index k) {
    const double size = std::fabs(values(x)[free_[static_cast<std::size_t>(k)]]) / width(k);
    const double h = 1e-5 * std::clamp(size, 1e-2, 1.0);
    const bool up = x[k] + h <= 1, down = x[k] - h >= 0;
    Vector a = x, b = x, ra, rb;
    a[k] += up ? h : -2 * h;
    b[k] += down ? -h : 2 * h;
    const bool has_a = evaluate(a, ra), has_b = evaluate(b, rb);
    if (has_a && has_b) {
      if (up && down) return (ra - rb) / (2 * h);
      // At a bound: three points on one side.
      return up ? Vector((4 * ra - 3 * r - rb) / (2 * h)) : Vector((3 * r - 4 * rb + ra) / (2 * h));
    }
    if (has_a) return (ra - r) / (a[k] - x[k]);
    if (has_b) return (rb - r) / (b[k] - x[k]);
    return Vector::Zero(residuals());
  }

  const std::vector<FitParameter>& parameters_;
  const Residuals& function_;
  const FitOptions& options_;
  std::vector<std::size_t> free_;
  std::vector<double> p_, r_;
  double begin_;
  int max_evaluations_ = 0;
  double max_seconds_ = 0;
};

// J = U S V^T of a tall matrix, by way of QR.
struct Svd {
  Vector s;
  Matrix v;
  Matrix ut;  // empty unless asked for

  explicit Svd(const Matrix& j, bool with_u = false) {
    const Eigen::Index n = j.cols();
    Eigen::HouseholderQR<Matrix> qr(j);
    const Matrix r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
    Eigen::JacobiSVD<Matrix> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
    s = svd.singularValues();
    v = svd.matrixV();
    if (!with_u) return;
    Matrix u = Matrix::Zero(j.rows(), n);
    u.topRows(n) = svd.matrixU();
    ut = (qr.householderQ() * u).transpose();
  }
  // Directions that the data hardly determine are stretched by a finite factor.
  Vector floored() const { return s.cwiseMax(1e-7 * s[0]); }
};

// The objective of one round of NLopt, in coordinates y for which the linearised chi2 is round: x = x0 + W y.
// Half the change of chi2 in units of its value at x0, summed from differences so that nothing cancels.
class Round {
 public:
  Round(Problem& problem, const Vector& x0) : problem_(problem), x0_(x0) {
    finite_ = problem.evaluate(x0, r0_);
    if (finite_) jacobian_ = problem.jacobian(x0, r0_);
    const double steepest = finite_ ? jacobian_.norm() : 0;
    unit_ = std::max(r0_.norm(), 1e-12 * steepest);
    usable_ = finite_ && steepest > 0 && std::isfinite(steepest) && unit_ > 0;
  }
  bool usable() const { return usable_; }

  bool by_gradient();  // LD_SLSQP
  bool by_values();    // LN_BOBYQA

 private:
  double objective(const Vector& y, double* gradient) {
    const Vector x = x0_ + w_ * y, inside = x.cwiseMax(0.0).cwiseMin(1.0);
    Vector r;
    const bool finite = problem_.evaluate(inside, r);
    if (gradient != nullptr) {
      Eigen::Map<Vector> g(gradient, y.size());
      g.setZero();
      if (finite) g = w_.transpose() * (problem_.jacobian(inside, r).transpose() * (r / (unit_ * unit_)));
      if (!g.allFinite()) g.setZero();
    }
    if (!finite) return bad_point;
    const double f = 0.5 * ((r - r0_) / unit_).dot((r + r0_) / unit_) + 1e4 * (x - inside).squaredNorm();
    return std::isfinite(f) ? std::min(f, bad_point) : bad_point;
  }

  static double callback(unsigned n, const double* y, double* gradient, void* self) {
    return static_cast<Round*>(self)->objective(Eigen::Map<const Vector>(y, n), gradient);
  }

  // 0 <= x <= 1 as linear constraints on y.
  static void box(unsigned, double* c, unsigned n, const double* y, double* gradient, void* data) {
    const Round& self = *static_cast<Round*>(data);
    const Eigen::Index k = static_cast<Eigen::Index>(n);
    const Vector x = self.x0_ + self.w_ * Eigen::Map<const Vector>(y, k);
    Eigen::Map<Vector>(c, k) = -x;
    Eigen::Map<Vector>(c + n, k) = x.array() - 1.0;
    if (gradient == nullptr) return;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor> g(gradient, 2 * k, k);
    g.topRows(k) = -self.w_;
    g.bottomRows(k) = self.w_;
  }

  void optimize(nlopt::opt& optimizer) {
    std::vector<double> y(static_cast<std::size_t>(w_.cols()), 0.0);
    double value = 0;
    try {
      optimizer.optimize(y, value);
    } catch (const nlopt::forced_stop&) {
      throw;
    } catch (const std::exception&) {
      // Limited by rounding, or no descent: the best point is in problem_.best.
    }
  }

  Problem& problem_;
  Vector x0_, r0_;
  Matrix jacobian_, w_;
  double unit_ = 0;
  bool finite_ = false, usable_ = false;
};

bool Round::by_gradient() {
  if (!usable_) return false;
  const Svd svd(jacobian_);
  w_ = svd.v * (unit_ * svd.floored().cwiseInverse()).asDiagonal();
  const unsigned n = static_cast<unsigned>(w_.cols());
  nlopt::opt optimizer(nlopt::LD_SLSQP, n);
  optimizer.set_min_objective(callback, this);
  optimizer.add_inequality_mconstraint(box, this, std::vector<double>(2 * n, 1e-12));
  optimizer.set_ftol_abs(1e-18);
  optimizer.set_xtol_abs(1e-10);
  optimizer.set_maxeval(100);
  optimize(optimizer);
  return true;
}

// BOBYQA has bounds on single coordinates only. So parameters at a bound (A) keep their own coordinate, and the
// others (F) are combined: x_F follows x_A along the valley, and a penalty keeps it in the box.
bool Round::by_values() {
  if (!usable_) return false;
  std::vector<Eigen::Index> inner, edge;
  for (Eigen::Index j = 0; j < x0_.size(); ++j)
    (x0_[j] < on_bound || x0_[j] > 1 - on_bound ? edge : inner).push_back(j);
  const Eigen::Index n = x0_.size(), n_in = static_cast<Eigen::Index>(inner.size());
  Matrix free(jacobian_.rows(), n_in);
  for (Eigen::Index k = 0; k < n_in; ++k) free.col(k) = jacobian_.col(inner[static_cast<std::size_t>(k)]);
  w_ = Matrix::Zero(n, n);
  Matrix pseudo_inverse;
  if (n_in > 0 && free.norm() > 0) {
    const Svd svd(free, true);
    const Matrix in = svd.v * svd.floored().cwiseInverse().asDiagonal();
    pseudo_inverse = in * svd.ut;
    for (Eigen::Index k = 0; k < n_in; ++k)
      w_.row(inner[static_cast<std::size_t>(k)]).head(n_in) = unit_ * in.row(k);
  }
  std::vector<double> lower(static_cast<std::size_t>(n), -HUGE_VAL), upper(static_cast<std::size_t>(n), HUGE_VAL);
  for (Eigen::Index k = n_in; k < n; ++k) {
    const Eigen::Index j = edge[static_cast<std::size_t>(k - n_in)];
    Vector follow = Vector::Zero(n_in);
    if (pseudo_inverse.size() > 0) follow = -pseudo_inverse * jacobian_.col(j);
    const Vector seen = jacobian_.col(j) + free * follow;
    const double scale = std::min(0.25, unit_ / std::max(seen.norm(), 1e-300));
    w_(j, k) = scale;
    for (Eigen::Index a = 0; a < n_in; ++a) w_(inner[static_cast<std::size_t>(a)], k) = scale * follow[a];
    lower[static_cast<std::size_t>(k)] = -x0_[j] / scale;
    upper[static_cast<std::size_t>(k)] = (1 - x0_[j]) / scale;
  }
  // BOBYQA needs two variables at least.
  nlopt::opt optimizer(n > 1 ? nlopt::LN_BOBYQA : nlopt::LN_SBPLX, static_cast<unsigned>(n));
  optimizer.set_min_objective(callback, this);
  optimizer.set_lower_bounds(lower);
  optimizer.set_upper_bounds(upper);
  optimizer.set_initial_step(0.3);
  optimizer.set_ftol_abs(1e-12);
  optimizer.set_xtol_abs(1e-8);
  optimizer.set_maxeval(static_cast<int>(50 + 30 * n));
  optimize(optimizer);
  return true;
}

using Step = bool (Round::*)();

// Rounds of one algorithm until chi2 and x no longer change. Each round has new coordinates about the result of the
// last one. Returns the lowest chi2 of these rounds; the problem keeps the best point of the whole fit.
struct Descent {
  double chi2 = infinite;
  Vector x;
  bool rests = false;
};

Descent descend(Problem& problem, const Vector& from, Step step, double tolerance, int rounds) {
  const double best_before = problem.best_chi2;
  const Vector best_x = problem.best, best_r = problem.best_r;
  Descent d;
  d.x = from;
  // The best point of this descent; the best of all descents is restored at its end.
  problem.best_chi2 = infinite;
  const auto restore = [&] {
    if (problem.best_chi2 < d.chi2) d.chi2 = problem.best_chi2, d.x = problem.best;
    if (best_before <= problem.best_chi2)
      problem.best_chi2 = best_before, problem.best = best_x, problem.best_r = best_r;
  };
  try {
    for (int k = 0; k < rounds && !d.rests; ++k) {
      Round round(problem, d.x);
      const bool moved = (round.*step)();
      if (problem.best_chi2 == infinite) break;
      const double drop = d.chi2 - problem.best_chi2, move = (problem.best - d.x).lpNorm<Eigen::Infinity>();
      const bool still = drop <= tolerance * d.chi2 && (move <= tolerance || drop <= 1e-14 * d.chi2);
      d.rests = !moved || drop <= 0 || (k > 0 && still);
      d.chi2 = problem.best_chi2;
      d.x = problem.best;
    }
  } catch (const nlopt::forced_stop&) {
    restore();
    throw;
  }
  restore();
  return d;
}

class Starts {
 public:
  Starts(Problem& problem, std::uint64_t seed) : problem_(problem), random_(seed) {}

  // The start points: the given one first, then points of the box. Returns false if no residuals are finite.
  bool next(Vector& x, bool first) {
    x = problem_.start();
    Vector r;
    if (first && problem_.evaluate(x, r)) return true;
    for (int attempt = 0; attempt < 50; ++attempt) {
      for (double& value : x) value = uniform();
      if (problem_.evaluate(x, r)) return true;
    }
    return false;
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  Problem& problem_;
  std::mt19937_64 random_;
};

// Gradient descents from every start, then the second algorithm as a check.
class Fit {
 public:
  Fit(Problem& problem, const FitOptions& options)
      : problem_(problem), options_(options), starts_(problem, options.seed) {}

  void run() {
    const bool all = within(0.6, [&] { descend_from_starts(); });
    if (problem_.failure || problem_.best_chi2 == infinite) return;
    const bool heard = within(1.0, [&] { ask_second_algorithm(); });
    // An algorithm that a limit stopped matters only if its result was needed.
    stopped_ = ends_.empty() || !lowest().rests || problem_.best_chi2 < lowest().chi2 - slack(lowest().chi2) ||
               (!heard && !agree_);
    cut_short_ = !all;
  }

  FitResult::Verdict verdict() const {
    if (problem_.best_chi2 == infinite) return FitResult::Verdict::nothing_finite;
    if (stopped_) return FitResult::Verdict::limit_reached;
    return agree_ ? FitResult::Verdict::converged : FitResult::Verdict::disagreement;
  }
  std::string starts_note() const {
    const auto there = std::count_if(ends_.begin(), ends_.end(), [&](const Descent& d) { return same(d.chi2); });
    return std::to_string(there) + " of " + std::to_string(ends_.size()) + " starts end there" +
           (cut_short_ ? " (the limit cut off the others)" : "");
  }
  double second_chi2() const { return second_.chi2; }

 private:
  template <class F>
  bool within(double share, F f) {
    problem_.set_share(share);
    try {
      f();
    } catch (const nlopt::forced_stop&) {
      return false;
    }
    return true;
  }

  void descend_from_starts() {
    Vector x;
    for (int k = 0; k < std::max(1, options_.starts) && starts_.next(x, k == 0); ++k) {
      if (k == 0) first_ = x;
      ends_.push_back(descend(problem_, x, &Round::by_gradient, options_.tolerance, 30));
    }
  }

  void ask_second_algorithm() {
    set_floor();
    second_from(first_);
    if (!agree_) second_from(beside(problem_.best));
  }

  void second_from(const Vector& x) {
    second_ = descend(problem_, x, &Round::by_values, 0.01 * options_.agreement, 20);
    if (ends_.empty() || second_.chi2 < lowest().chi2 - slack(lowest().chi2))
      ends_.push_back(descend(problem_, second_.x, &Round::by_gradient, options_.tolerance, 30));
    agree_ = std::fabs(second_.chi2 - lowest().chi2) <= slack(lowest().chi2);
  }

  // The second algorithm starts a tenth of the box away, towards its middle.
  static Vector beside(Vector x) {
    for (double& value : x) value += value < 0.5 ? 0.1 : -0.1;
    return x;
  }

  // chi2 below which residuals are rounding errors, relative to the change of residuals over the box.
  void set_floor() {
    Vector r;
    const Vector x = problem_.best;
    if (problem_.evaluate(x, r)) floor_ = 1e-20 * problem_.jacobian(x, r).squaredNorm();
  }
  double slack(double chi2) const { return options_.agreement * chi2 + floor_; }
  bool same(double chi2) const { return std::fabs(chi2 - problem_.best_chi2) <= slack(problem_.best_chi2); }
  const Descent& lowest() const {
    return *std::min_element(ends_.begin(), ends_.end(),
                             [](const Descent& a, const Descent& b) { return a.chi2 < b.chi2; });
  }

  Problem& problem_;
  const FitOptions& options_;
  Starts starts_;
  Vector first_;
  std::vector<Descent> ends_;
  Descent second_;
  bool stopped_ = false, agree_ = false, cut_short_ = false;
  double floor_ = 0;
};

// Standard errors of the linearised model at x. Columns of J are scaled to length 1 first, so that rank and
// condition do not depend on the parameters' units.
void add_errors(Problem& problem, FitResult& result, const std::vector<std::size_t>& free) {
  const Vector x = problem.best, r = problem.best_r;
  const Matrix j = problem.jacobian(x, r);
  const Vector length = j.colwise().norm();
  const double longest = length.maxCoeff();
  const Eigen::Index n = j.cols(), spare = j.rows() - n;
  Matrix scaled = j;
  std::vector<bool> seen(static_cast<std::size_t>(n));
  for (Eigen::Index k = 0; k < n; ++k) {
    seen[static_cast<std::size_t>(k)] = length[k] > 1e-14 * longest;
    if (seen[static_cast<std::size_t>(k)])
      scaled.col(k) /= length[k];
    else
      scaled.col(k).setZero();
  }
  const Svd svd(scaled);
  const double s2 = spare > 0 ? r.squaredNorm() / static_cast<double>(spare) : nan_value;
  result.condition = svd.s[n - 1] > rank_limit * svd.s[0] ? std::pow(svd.s[0] / svd.s[n - 1], 2) : infinite;
  for (Eigen::Index k = 0; k < n; ++k) {
    double variance = 0;
    bool determined = seen[static_cast<std::size_t>(k)];
    for (Eigen::Index d = 0; d < n; ++d) {
      if (svd.s[d] > rank_limit * svd.s[0])
        variance += std::pow(svd.v(k, d) / svd.s[d], 2);
      else
        determined = determined && std::fabs(svd.v(k, d)) < 1e-4;
    }
    double& error = result.standard_error[free[static_cast<std::size_t>(k)]];
    error = determined ? std::sqrt(s2 * variance) / length[k] * problem.width(k) : nan_value;
    if (!determined) result.undetermined.push_back(problem.parameter(k).name);
  }
  const auto index = [&](Eigen::Index k) { return free[static_cast<std::size_t>(k)]; };
  const auto product = [&](Eigen::Index k, Eigen::Index l) {
    double sum = 0;
    for (Eigen::Index d = 0; d < n; ++d)
      if (svd.s[d] > rank_limit * svd.s[0]) sum += svd.v(k, d) * svd.v(l, d) / (svd.s[d] * svd.s[d]);
    return sum;
  };
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index l = 0; l < k; ++l)
      if (std::isfinite(result.standard_error[index(k)]) && std::isfinite(result.standard_error[index(l)]))
        result.correlation[index(k)][index(l)] = result.correlation[index(l)][index(k)] =
            product(k, l) / std::sqrt(product(k, k) * product(l, l));
}

std::string figures(const FitResult& f) {
  return "rms residual " + number("%.3g", f.rms) + ", largest " + number("%.3g", f.largest) + ", " +
         std::to_string(f.evaluations) + " evaluations";
}

std::string describe(const FitResult& f, const Fit& fit, const FitOptions& options) {
  std::string text;
  switch (f.verdict) {
    case FitResult::Verdict::nothing_finite:
      return "nothing finite: the residuals are NaN or infinite at all " + std::to_string(f.evaluations) +
             " points tried; check the data and the box";
    case FitResult::Verdict::converged:
      text = "converged: two algorithms agree, " + fit.starts_note();
      break;
    case FitResult::Verdict::at_bound:
      text =
          "converged at a bound of " + joined(f.at_bound) + ": widen the box or fix it there; two algorithms agree";
      break;
    case FitResult::Verdict::disagreement:
      text = "two algorithms disagree: chi2 " + number("%.6g", f.chi2) + " and " +
             number("%.6g", fit.second_chi2()) + "; narrow the box, start nearer or allow more evaluations";
      break;
    case FitResult::Verdict::limit_reached:
      text = "stopped by the limit of " + std::to_string(options.max_evaluations) + " evaluations" +
             (std::isfinite(options.max_seconds) ? " or " + number("%.3g", options.max_seconds) + " s" : "") +
             " before it converged: raise it or start nearer";
      break;
  }
  text += "; " + figures(f);
  if (f.not_finite > 0) text += ", not finite at " + std::to_string(f.not_finite) + " of them";
  if (!f.undetermined.empty()) text += "; the data do not determine " + joined(f.undetermined);
  return text;
}

void check(const std::vector<FitParameter>& parameters, std::size_t residuals, const FitOptions& options) {
  std::size_t free = 0;
  for (const FitParameter& p : parameters) {
    if (!p.free) continue;
    ++free;
    if (!(p.lower < p.upper) || !std::isfinite(p.upper - p.lower))
      throw std::invalid_argument("fit: the box of " + p.name + " is empty, inverted or not finite (" +
                                  number("%g", p.lower) + " to " + number("%g", p.upper) + "): give lower < upper");
    if (!(p.start >= p.lower && p.start <= p.upper))
      throw std::invalid_argument("fit: the start of " + p.name + ", " + number("%g", p.start) +
                                  ", is outside of its box (" + number("%g", p.lower) + " to " +
                                  number("%g", p.upper) + ")");
  }
  if (residuals == 0 || residuals < free)
    throw std::invalid_argument("fit: " + std::to_string(residuals) + " residuals cannot determine " +
                                std::to_string(free) + " free parameters: add data or fix parameters");
  if (options.max_evaluations < 1 || !(options.max_seconds > 0))
    throw std::invalid_argument("fit: the limits on evaluations and seconds must be positive");
}

void add_values(Problem& problem, FitResult& result) {
  result.value = problem.values(problem.best);
  result.chi2 = problem.best_chi2;
  result.rms = std::sqrt(result.chi2 / static_cast<double>(problem.residuals()));
  result.largest = problem.best_r.lpNorm<Eigen::Infinity>();
  for (Eigen::Index j = 0; j < problem.size(); ++j)
    if (problem.best[j] < on_bound || problem.best[j] > 1 - on_bound)
      result.at_bound.push_back(problem.parameter(j).name);
}

}  // namespace

FitResult fit_least_squares(const std::vector<FitParameter>& parameters, std::size_t residuals,
                            const Residuals& function, const FitOptions& options) {
  check(parameters, residuals, options);
  Problem problem(parameters, residuals, function, options);
  FitResult result;
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    result.value.push_back(parameters[k].start);
    result.standard_error.push_back(parameters[k].free ? nan_value : 0);
    if (parameters[k].free) free.push_back(k);
    result.correlation.emplace_back(parameters.size(), 0.0);
    result.correlation.back()[k] = 1;
  }
  Fit fit(problem, options);
  fit.run();
  if (problem.failure) std::rethrow_exception(problem.failure);
  result.verdict = fit.verdict();
  if (result.verdict == FitResult::Verdict::nothing_finite) {
    result.chi2 = result.rms = result.largest = nan_value;
  } else {
    add_values(problem, result);
  }
  if (!free.empty() && (result.usable() || result.verdict == FitResult::Verdict::disagreement)) {
    problem.lift_limits();
    add_errors(problem, result, free);
  }
  if (result.verdict == FitResult::Verdict::converged && !result.at_bound.empty())
    result.verdict = FitResult::Verdict::at_bound;
  result.evaluations = problem.evaluations;
  result.not_finite = problem.not_finite;
  result.message = describe(result, fit, options);
  return result;
}

}  // namespace ropewalk::calibrate
