// The checkpoints of a run: on the disk for `resume`, and in memory to go back to.
#pragma once

#include <cstdint>
#include <memory>

#include "run/limit_guard.hpp"
#include "run/run_checkpoint.hpp"
#include "run/wall_time.hpp"

namespace ropewalk {

class Checkpoints {
 public:
  Checkpoints(MovingScene& moving, RunFiles& files, LimitGuard& limits, const RunClock& clock,
              RunListener& listener)
      : moving_(moving), files_(files), limits_(limits), clock_(clock), listener_(listener) {}

  RunOrigin origin;

  // The last good state; null: none yet.
  const std::shared_ptr<const RunCheckpoint>& snapshot() const { return snapshot_; }
  void take_snapshot();
  void set_snapshot(std::shared_ptr<const RunCheckpoint> earlier) { snapshot_ = std::move(earlier); }

  // Throws InputError where it cannot be written. `ends_for`: see RunCheckpoint.
  void save(StopReason ends_for = StopReason::none);
  // If the checkpoint cannot be written, the earlier one stays, and the next call tries again.
  void save_if_possible();
  void begin_interval();
  void save_if_due();
  // Where a run stops: what it writes from here on, its last row and frame among it, is taken back by `resume`.
  // Throws InputError as save().
  void save_here();
  // The same, written by save_kept().
  void keep_here(StopReason ends_for);
  void save_kept();
  // Writes the files that a run leaves at its end beside log, frames and events: final state and limits.
  void write_results();
  // The run broke off: the last good state is saved if it is newer than the checkpoint.
  void save_snapshot() const;
  // The run went back to the snapshot: a checkpoint later than this would know of more than log and frames then
  // hold.
  void save_snapshot_over_later();
  // The state is that of the checkpoint on the disk.
  void stands_at_checkpoint() { saved_step_ = moving_.state().step; }

  double longest_save() const { return longest_save_; }  // s

 private:
  RunCheckpoint here() const;
  RunCheckpoint with_snapshot() const;
  void write(const RunCheckpoint& checkpoint);
  void bring_files_up_to_date();

  MovingScene& moving_;
  RunFiles& files_;
  LimitGuard& limits_;
  const RunClock& clock_;
  RunListener& listener_;
  std::shared_ptr<const RunCheckpoint> snapshot_;
  RunCheckpoint kept_;
  std::int64_t mark_step_ = 0, saved_step_ = -1;
  double longest_save_ = 0, due_ = 0;  // s
  bool fails_ = false;
};

}  // namespace ropewalk
