#include "run/run_files.hpp"

#include <filesystem>

#include "run/colours.hpp"
#include "run/events_file.hpp"
#include "scene/state_files.hpp"

namespace ropewalk {

void RunFiles::open(FrameFormat format, const FileMark& log, const FileMark& frames, std::size_t expected_frames) {
  log_ = std::make_unique<GrowingFile>(dir_.log(), log.bytes);
  const std::string there = dir_.frames();
  if (std::filesystem::exists(there)) format = format_of(there);
  frames_ = frame_writer(dir_.frames(format), format, frames.bytes, expected_frames);
  row_step_ = log.step;
  frame_step_ = frames.step;
}

void RunFiles::write_header() { log_->write(log_header()); }

void RunFiles::write_row(const LogRow& row, std::int64_t step) {
  log_->write(log_line(row));
  row_step_ = step;
}

void RunFiles::write_frame(const MovingScene& m) {
  frames_->write(m.prepared.topology, m.state(),
                 element_colours(m.prepared.topology, m.prepared.interaction, m.state(), m.simulation.tubes_now()));
  frame_step_ = m.state().step;
}

FileMark RunFiles::log_mark() const {
  FileMark mark = log_->mark();
  mark.step = row_step_;
  return mark;
}

FileMark RunFiles::frames_mark() const {
  FileMark mark = frames_->mark();
  mark.step = frame_step_;
  return mark;
}

void RunFiles::cut(const FileMark& log, const FileMark& frames) {
  log_->cut(log.bytes);
  frames_->cut(frames.bytes);
  row_step_ = log.step;
  frame_step_ = frames.step;
}

void RunFiles::sync() {
  log_->sync();
  frames_->sync();
}

void RunFiles::write_events(const MovingScene& m) {
  const std::vector<TermEvent> events = m.simulation.term_events();
  if (!events.empty()) pending_.write(dir_.events(), events_csv(m.prepared.topology, events));
}

void RunFiles::write_state(const std::string& path, const MovingScene& m) {
  const StateFiles files = state_files(m.simulation, path);
  if (!files.memory.empty()) pending_.write(memory_path_of(path), files.memory);
  pending_.write(path, files.state);
}

}  // namespace ropewalk
