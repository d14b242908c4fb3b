#include "run/terminal_listener.hpp"

#include <fmt/format.h>

#include "io/stop_signals.hpp"
#include "run/limit_watch.hpp"
#include "run/tell.hpp"

namespace ropewalk {
namespace {

constexpr int failed_or_incomplete = 3, not_relaxed = 4, at_limit = 5, by_wall_time = 6;

// What a reader has to know first, and what came of the run.
void print_news(const RunResult& r) {
  if (!r.beyond_since.empty()) print(r.beyond_since + "\n");
  for (const std::string& sentence : r.results) print(sentence + "\n");
}

void print_results(const RunResult& r) {
  print_news(r);
  if (!r.passed.empty()) print(fmt::format("Limits passed: {}\n", r.passed));
  if (!r.network.empty()) print("At the end " + r.network + ".\n");
  if (!r.damping.empty()) print(r.damping + "\n");
  for (const Judgement& j : r.expected) print(j.words + "\n");
  const std::string time = r.relaxes ? "" : fmt::format("{:.1f} ps, ", r.time_ps);
  print(fmt::format("{}{} steps, {}{:.0f} s. Report: {}\n", r.reason.empty() ? "" : r.reason + "\n", r.steps, time,
                    r.wall_seconds, r.directory.report()));
}

}  // namespace

void TerminalListener::tell(const std::string& line) { ropewalk::tell(line); }

void TerminalListener::tell_detail(const std::string& line) {
  if (!quiet_) tell(line);
}

void TerminalListener::before_files() { listen_to_stop_signals(); }

std::string TerminalListener::asked_to_stop() {
  return stop_signal ? fmt::format("by signal {}", static_cast<int>(stop_signal)) : "";
}

int tell_end(const RunResult& r, bool again) {
  const std::string& dir = r.directory.path;
  switch (r.end) {
    case RunEnd::finished:
      print_results(r);
      if (r.beyond > far_beyond && !again) tell(r.worst + ". Beyond it the results do not describe real tubes");
      return missed(r.expected) > 0 ? not_as_expected : 0;
    case RunEnd::incomplete:
      print_results(r);
      tell(fmt::format("the run is done, but for {}; write them with: ropewalk resume {}", r.missing, dir));
      return failed_or_incomplete;
    case RunEnd::not_relaxed:
      print_results(r);
      tell(r.remedy.empty()
               ? fmt::format("{}; go on with `ropewalk resume {}`, or raise run.max_steps", r.reason, dir)
               : fmt::format("{}; {}", r.reason, r.remedy));
      return not_relaxed;
    case RunEnd::at_limit:
      print_news(r);
      tell(fmt::format("{}; go on all the same with: ropewalk resume {}", r.reason, dir));
      return at_limit;
    case RunEnd::wall_time:
    case RunEnd::asked:
      tell_as_is(fmt::format("\n{}; go on with: ropewalk resume {}\n", r.reason, dir));
      return r.end == RunEnd::wall_time ? by_wall_time : 128 + stop_signal;
    case RunEnd::failed:
      print_news(r);
      tell_as_is(fmt::format("\nropewalk: {}. State written to {}\n", r.reason, r.directory.failed_state()));
      return failed_or_incomplete;
    case RunEnd::broken_off:
      tell(fmt::format("{}; then go on with: ropewalk resume {}", r.reason, dir));
      return failed_or_incomplete;
  }
  return failed_or_incomplete;
}

}  // namespace ropewalk
