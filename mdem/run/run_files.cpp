#include "run/run_files.hpp"

#include <algorithm>
#include <filesystem>

#include "run/colours.hpp"
#include "run/events_file.hpp"
#include "scene/state_files.hpp"

namespace ropewalk {

void RunFiles::open(FrameFormat format, const FileMarks& marks, std::size_t expected_frames) {
  const auto& [log, frames, events] = marks;
  log_ = std::make_unique<GrowingFile>(dir_.log(), log.bytes);
  const std::string there = dir_.frames();
  if (std::filesystem::exists(there)) format = format_of(there);
  frames_ = frame_writer(dir_.frames(format), format, frames.bytes, expected_frames);
  row_step_ = log.step;
  frame_step_ = frames.step;
  if (events.bytes > 0)
    events_ = std::make_unique<GrowingFile>(dir_.events(), events.bytes);
  else
    std::filesystem::remove(dir_.events());
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

void RunFiles::write_events(MovingScene& m) {
  const std::vector<TermEvent> events = m.simulation.term_events();
  if (events.empty()) return;
  if (!events_) {
    events_ = std::make_unique<GrowingFile>(dir_.events(), 0);
    events_->write(events_header());
  }
  const std::uint64_t at = events_->size();
  events_->write(event_lines(m.prepared.topology, events));
  m.simulation.forget_events();
  if (first_break_) return;
  const auto first = std::find_if(events.begin(), events.end(), is_break);
  if (first == events.end()) return;
  first_break_ = *first;
  first_break_at_ = at;
}

FileMarks RunFiles::marks() const {
  FileMarks all{log_->mark(), frames_->mark(), events_ ? events_->mark() : FileMark()};
  all.log.step = row_step_;
  all.frames.step = frame_step_;
  return all;
}

void RunFiles::cut(const FileMarks& marks) {
  log_->cut(marks.log.bytes);
  frames_->cut(marks.frames.bytes);
  row_step_ = marks.log.step;
  frame_step_ = marks.frames.step;
  if (first_break_ && marks.events.bytes <= first_break_at_) first_break_.reset();
  if (!events_) return;
  if (marks.events.bytes > 0) {
    events_->cut(marks.events.bytes);
  } else {
    events_.reset();
    std::filesystem::remove(dir_.events());
  }
}

void RunFiles::sync() {
  log_->sync();
  frames_->sync();
  if (events_) events_->sync();
}

void RunFiles::write_state(const std::string& path, const MovingScene& m) {
  const StateFiles files = state_files(m.simulation, path);
  if (!files.memory.empty()) pending_.write(memory_path_of(path), files.memory);
  pending_.write(path, files.state);
}

}  // namespace ropewalk
