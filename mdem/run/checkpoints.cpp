#include "run/checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.hpp"

namespace ropewalk {

RunCheckpoint Checkpoints::here() const {
  RunCheckpoint c;
  c.files = files_.marks();
  c.first_energy = moving_.first_energy;
  c.energy = energy_mark(moving_.simulation);
  c.wall_seconds = clock_.seconds();
  c.control = moving_.control;
  c.on_limit = limits_.on_limit();
  c.limits = limits_.file();
  c.simulation = moving_.simulation.serialise();
  return c;
}

void Checkpoints::take_snapshot() {
  files_.write_events(moving_);
  snapshot_ = std::make_shared<const RunCheckpoint>(here());
  mark_step_ = moving_.state().step;
}

RunCheckpoint Checkpoints::with_snapshot() const {
  RunCheckpoint c = here();
  if (snapshot_ && snapshot_->simulation != c.simulation) c.snapshot = snapshot_;
  c.origin = origin;
  return c;
}

void Checkpoints::write(const RunCheckpoint& c) {
  const double began = steady_seconds();
  files_.write_checkpoint(c);
  saved_step_ = moving_.state().step;
  fails_ = false;
  limits_.write();
  files_.try_again();
  longest_save_ = std::max(longest_save_, steady_seconds() - began);
}

// Before a checkpoint knows of them.
void Checkpoints::bring_files_up_to_date() {
  files_.write_events(moving_);
  files_.sync();
}

void Checkpoints::save(StopReason ends_for) {
  bring_files_up_to_date();
  RunCheckpoint c = with_snapshot();
  c.ends_for = ends_for;
  write(c);
}

void Checkpoints::save_if_possible() {
  bring_files_up_to_date();
  try {
    write(with_snapshot());
  } catch (const InputError& e) {
    if (!fails_) listener_.tell(fmt::format("{}; the run goes on, and it is tried again", e.what()));
    fails_ = true;
  }
}

void Checkpoints::begin_interval() { due_ = steady_seconds() + moving_.scene.run.checkpoint_every; }

void Checkpoints::save_if_due() {
  if (steady_seconds() <= due_) return;
  save_if_possible();
  begin_interval();
}

void Checkpoints::save_here() {
  save_if_possible();
  if (fails_) save();
}

void Checkpoints::keep_here(StopReason ends_for) {
  bring_files_up_to_date();
  kept_ = with_snapshot();
  kept_.ends_for = ends_for;
}

void Checkpoints::save_kept() {
  try {
    files_.write_checkpoint(kept_);
  } catch (const InputError&) {
    // The one before stands.
  }
}

void Checkpoints::write_results() {
  moving_.simulation.end_relaxation();  // saved as it was; final.csv is of a state at rest
  files_.write_final_state(moving_);
  limits_.write();
}

void Checkpoints::save_snapshot() const {
  if (!snapshot_ || mark_step_ <= saved_step_) return;
  files_.sync();
  RunCheckpoint c = *snapshot_;
  c.origin = origin;
  files_.write_checkpoint(c);
}

void Checkpoints::save_snapshot_over_later() {
  if (saved_step_ <= moving_.state().step) return;
  RunCheckpoint c = with_snapshot();
  c.files = snapshot_->files;
  write(c);
}

}  // namespace ropewalk
