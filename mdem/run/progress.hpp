// One line on the terminal with the progress of a run and its remaining time. If the output is not a terminal:
// plain lines at long intervals.
#pragma once

#include <string>

namespace ropewalk {

class Progress {
 public:
  // total: 0 if the end is not known (relaxation).
  Progress(bool quiet, double done, double total);
  bool due();
  void show(double done, const std::string& status);
  void done();

 private:
  bool quiet_, terminal_;
  double first_, total_, started_, next_ = 0;
  int calls_ = 0;
  bool shown_ = false;
};

}  // namespace ropewalk
