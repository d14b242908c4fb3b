// The runs behind `ropewalk errors`: a run again and again, each time with one number changed that has a standard
// error, in its parameter sets, in the files of its drives or in the scene itself.
#pragma once

#include <string>
#include <vector>

#include "io/run_errors.hpp"
#include "run/run_directory.hpp"
#include "scene/input_numbers.hpp"

namespace ropewalk {

struct VariedNumber {
  ErrorSource error;
  InputNumber::Of of = InputNumber::Of::set;
  std::size_t index = 0;  // of the set or the file
  // Keys of values in that file, which change together by the relative step of `error`; a single value that is 0, by
  // the step itself. log_path: key of a logarithm that changes with them.
  std::vector<std::string> paths;
  std::string log_path = {};
};

// The numbers that the errors of a run come from, and those that are left out.
struct ErrorInputs {
  std::vector<VariedNumber> varied;
  std::vector<std::string> without_error;  // "failure.strain = 0.16", numbers of which no error is stated
  std::vector<std::string> not_varied;     // "tube.radius (known to 3e-07)", numbers with an error that is left out
};
// Throws InputError where no number has an error. `tubes`: in the scene.
ErrorInputs error_inputs(const Scene& scene, int tubes);
// The same, which may be none.
ErrorInputs inputs_with_errors(const Scene& scene, int tubes);
std::vector<std::vector<double>> correlation_of(const std::vector<VariedNumber>& sources, const Scene& scene);

class ErrorRuns {
 public:
  // `scene` and `prepared` of the run that is repeated. again: finished runs too.
  ErrorRuns(const RunDirectory& base, const Scene& scene, const Prepared& prepared, bool again)
      : base_(base), scene_(scene), prepared_(prepared), again_(again) {}

  // Runs the scene with the number raised (`plus`) or lowered, in its directory below `errors`; returns the exit code.
  int run(const VariedNumber& source, bool plus) const;

 private:
  std::string original(const VariedNumber& source) const;  // the file that has it

  RunDirectory base_;
  const Scene& scene_;
  const Prepared& prepared_;
  bool again_;
};

}  // namespace ropewalk
