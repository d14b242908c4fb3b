// The runs behind `ropewalk errors`: a run again and again, each time with one number of its parameter sets
// changed.
#pragma once

#include <string>
#include <vector>

#include "io/run_errors.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

struct VariedNumber {
  ErrorSource error;
  std::size_t set = 0;
  std::vector<std::string> keys;  // of the quantities that change together
};

// The numbers of the sets that have a standard error. Throws InputError where there is none. `tubes`: in the scene.
std::vector<VariedNumber> varied_numbers(const Scene& scene, int tubes);
std::vector<std::vector<double>> correlation_of(const std::vector<VariedNumber>& sources, const Scene& scene);

class ErrorRuns {
 public:
  // time_step: of the run that is repeated, ps. again: finished runs too.
  ErrorRuns(const RunDirectory& base, const Scene& scene, double time_step, bool again)
      : base_(base), scene_(scene), time_step_(time_step), again_(again) {}

  // In its directory below `errors`, with the number raised (`plus`) or lowered. Returns the exit code of the run.
  int run(const VariedNumber& source, bool plus) const;

 private:
  std::string changed_set(const VariedNumber& source, bool plus) const;

  RunDirectory base_;
  const Scene& scene_;
  double time_step_;
  bool again_;
};

}  // namespace ropewalk
