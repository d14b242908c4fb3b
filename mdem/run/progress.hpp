// One line on the terminal that says how far a run is and when it will end; plain lines now and then where
// the output is not a terminal.
#pragma once

#include <string>

namespace ropewalk {

class Progress {
 public:
  // total 0: the end is not known (relaxation).
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
