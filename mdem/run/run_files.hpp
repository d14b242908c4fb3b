// The files that a run writes while it goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/equilibria.hpp"
#include "io/frames/frames.hpp"
#include "io/growing_file.hpp"
#include "run/moving_scene.hpp"
#include "run/pending_files.hpp"
#include "run/run_checkpoint.hpp"

namespace ropewalk {

class RunFiles {
 public:
  RunFiles(RunDirectory dir, RunListener& listener) : dir_(std::move(dir)), pending_(listener) {}

  const RunDirectory& directory() const { return dir_; }
  // From now on no other process writes in the directory.
  void hold(DirectoryLock lock) { lock_ = std::move(lock); }

  // Opens log, frames and events, made or cut back to these marks.
  void open(FrameFormat format, const FileMarks& marks, std::size_t expected_frames);
  void write_header();
  void write_row(const LogRow& row, std::int64_t step);
  void write_frame(const MovingScene& moving);
  // Steps of the last ones; -1: not known.
  std::int64_t row_step() const { return row_step_; }
  std::int64_t frame_step() const { return frame_step_; }
  // What has happened in the simulation since the last call, which then forgets it. To be called before its state is
  // kept, since that does not have it.
  void write_events(MovingScene& moving);
  // That a tube broke, of what this process has written; null: none.
  const TermEvent* first_break() const { return first_break_ ? &*first_break_ : nullptr; }
  // Removes whatever was written after these marks.
  void cut(const FileMarks& marks);
  FileMarks marks() const;
  // Puts log, frames and events on the disk; called before a checkpoint that refers to them.
  void sync();

  // Throws InputError where it cannot be written; the checkpoint before it then stands.
  void write_checkpoint(const RunCheckpoint& checkpoint) const { ropewalk::write_checkpoint(dir_, checkpoint); }
  // These end no run where they cannot be written.
  void write_limits(const LimitsFile& limits) { pending_.write(dir_.limits(), limits_json(limits)); }
  void write_manifest(const Manifest& manifest) { pending_.write(dir_.manifest(), manifest_json(manifest)); }
  void write_equilibria(const Equilibria& all) { pending_.write(dir_.equilibria(), equilibria_csv(all)); }
  void write_final_state(const MovingScene& moving) { write_state(dir_.final_state(), moving); }
  void write_failed_state(const MovingScene& moving) { write_state(dir_.failed_state(), moving); }
  void write_report(std::string page) { pending_.write(dir_.report(), std::move(page)); }
  void try_again() { pending_.try_again(); }
  std::string missing() const { return pending_.names(); }  // could not be written

 private:
  void write_state(const std::string& path, const MovingScene& moving);

  RunDirectory dir_;
  DirectoryLock lock_;
  std::unique_ptr<GrowingFile> log_;
  std::unique_ptr<FrameWriter> frames_;
  std::unique_ptr<GrowingFile> events_;  // null: nothing has happened yet
  std::optional<TermEvent> first_break_;
  std::uint64_t first_break_at_ = 0;  // bytes of the file before it
  std::int64_t row_step_ = -1, frame_step_ = -1;
  PendingFiles pending_;
};

}  // namespace ropewalk
