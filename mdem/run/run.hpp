// A run of a scene: its loop, and its files from the first to the last.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <string>

#include "run/expectations.hpp"
#include "run/run_parts.hpp"

namespace ropewalk {

enum class RunEnd {
  finished,
  incomplete,  // finished, but for files that could not be written
  not_relaxed,
  at_limit,
  wall_time,
  asked,       // the listener asked for an end
  failed,      // the calculation went wrong
  broken_off,  // a full disk, no memory: `resume` goes on from the last good state
};

class Run;

struct RunResult {
  RunEnd end = RunEnd::finished;
  RunDirectory directory;
  std::string reason;                // why it ended, in words
  std::string remedy;                // what helps a relaxation that resuming does not bring to rest
  std::string passed;                // limits, in words
  std::string beyond_since;          // since when and by which limit, a sentence; empty: within all limits
  std::string worst;                 // how far it was passed, in words
  double beyond = 0;                 // the largest value over its limit, of the limits that were passed
  std::vector<std::string> results;  // a sentence each
  std::string damping;               // its part of the lost energy, in words
  std::string network;               // of a film at its end, in words
  std::vector<Judgement> expected;   // verdicts on the [[expect]] tables
  std::string missing;               // files that could not be written
  std::int64_t steps = 0;
  double time_ps = 0, wall_seconds = 0;
  bool relaxes = false;
  std::exception_ptr error;   // error of a run that failed or broke off
  std::unique_ptr<Run> next;  // the run in which it goes on, elements split
};

class Run {
 public:
  // Writes nothing yet. Throws InputError for a scene that cannot be run.
  Run(RunDirectory dir, Scene scene, const RunSettings& settings, RunListener& listener)
      : parts_(std::move(dir), std::move(scene), settings, listener) {}

  // Throws InputError for settings that the run could not carry out.
  void check_before_start() const;
  void end_at(std::int64_t steps, double ps) { parts_.schedule.end_at(steps, ps); }
  // Throws InputError for an end that lies behind a run that goes on.
  void check_end_lies_ahead() const;
  void hold(DirectoryLock lock) { parts_.files.hold(std::move(lock)); }

  // Tells the listener the notes on the scene.
  void tell_notes() const;
  // The files of a new run, up to the checkpoint at the start, from which even the first minute can be resumed.
  void begin_files();
  // Cuts log and frames back to the checkpoint. Throws InputError if it is of another scene.
  void restore(RunCheckpoint checkpoint);
  void write_manifest(const char* status, const std::string& reason = "");
  void write_limits() { parts_.limits.write(); }

  // Up to the end, or to where the elements are split: `next` then goes on. Throws only where not even the manifest
  // can be written.
  RunResult go();

 private:
  std::string device_name() const;
  void keep_time_step();
  void write_end(const char* status, const std::string& reason);
  RunResult result(RunEnd end, const std::string& reason) const;
  RunResult finish();
  RunResult stopped_at_limit();
  RunResult stopped(RunEnd end);
  RunResult refined();
  RunResult failed(const NumericalError& error);
  void add_results(RunResult& result) const;
  RunResult broken_off(const std::exception& error);

  RunParts parts_;
};

// The run and those in which it goes on.
RunResult go_through(std::unique_ptr<Run> run);

}  // namespace ropewalk
