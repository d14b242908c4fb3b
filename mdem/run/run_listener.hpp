// Who follows a run: the terminal, Python, or nobody. A run prints nothing by itself.
#pragma once

#include <string>

namespace ropewalk {

// All functions are called from the thread that runs, between two steps.
class RunListener {
 public:
  virtual ~RunListener() = default;

  // A remark, one line without the name of the program.
  virtual void tell(const std::string& line) = 0;
  // A remark on the scene, before its first step.
  virtual void tell_note(const std::string& note) { tell("note: " + note); }
  // A remark for a listener that wants to hear everything.
  virtual void tell_detail(const std::string&) {}
  // The input is good, and the first file is about to be written.
  virtual void before_files() {}
  // Names the source of a request to stop, such as "by signal 2"; empty: there is no request. On a request the run
  // saves its state and ends.
  virtual std::string asked_to_stop() { return ""; }

  // The loop begins. `total`: 0 if the end is not known (relaxation).
  virtual void begin_loop(double /*done*/, double /*total*/) {}
  virtual bool wants_progress() { return false; }
  virtual void progress(double /*done*/, const std::string& /*status*/) {}
  // The loop has come to its end.
  virtual void end_loop() {}
};

}  // namespace ropewalk
