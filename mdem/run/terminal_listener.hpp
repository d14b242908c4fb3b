// Runs on the terminal: remarks and progress on standard error, results on standard output.
#pragma once

#include <optional>

#include "run/progress.hpp"
#include "run/run.hpp"

namespace ropewalk {

// Signals ask a run for an end (io/stop_signals.hpp).
class TerminalListener : public RunListener {
 public:
  // quiet: remarks only.
  explicit TerminalListener(bool quiet) : quiet_(quiet) {}

  void tell(const std::string& line) override;
  void tell_detail(const std::string& line) override;
  void before_files() override;
  std::string asked_to_stop() override;
  void begin_loop(double done, double total) override { progress_.emplace(quiet_, done, total); }
  bool wants_progress() override { return progress_->due(); }
  void progress(double done, const std::string& status) override { progress_->show(done, status); }
  void end_loop() override { progress_->done(); }

 private:
  bool quiet_;
  std::optional<Progress> progress_;
};

// Says how a run ended. Returns the exit code of a program that did nothing else. `again`: the run repeats one that has
// told of the limits it passed.
int tell_end(const RunResult& result, bool again = false);

}  // namespace ropewalk
