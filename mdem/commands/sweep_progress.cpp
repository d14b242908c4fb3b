#include "commands/sweep_progress.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "campaign/point_runs.hpp"
#include "campaign/static_rest.hpp"
#include "io/clocks.hpp"
#include "io/plain_text.hpp"
#include "io/stop_signals.hpp"
#include "run/tell.hpp"
#include "run/wall_time.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {

SweepProgress::SweepProgress(const CampaignDirectory& dir, const std::vector<SweepPoint>& points,
                             const SweepRuns& runs, bool quiet)
    : dir_(dir), points_(points), runs_(runs), quiet_(quiet), began_(steady_seconds()) {}

void SweepProgress::start_failed(const SweepPoint& start) const {
  say(fmt::format("the shared start {} did not reach its end", start.name));
}

void SweepProgress::begin() {
  for (const SweepPoint& p : points_)
    if (runs_.is_to_run(p))
      work_to_do_ += p.work;
    else
      ++done_;
  if (done_ > 0) say(fmt::format("{} of {} points are done already", done_, points_.size()));
  work_left_ = work_to_do_;
}

void SweepProgress::ended(const SweepPoint& p, int status) {
  using Stage = PointProgress::Stage;
  ++done_;
  work_left_ -= p.work;
  const PointProgress progress = progress_of(dir_.point(p.name));
  if (WIFEXITED(status) && WEXITSTATUS(status) == point_busy)
    say(fmt::format("{} is run by another process", p.name));
  else if (progress.stage == Stage::failed)
    say(fmt::format("{}: {}", p.name, printable(progress.reason)));
  else if (progress.stage != Stage::ended && !stop_signal)
    say(fmt::format("{} did not end; see {}", p.name, dir_.messages(p.name)));
  const double passed = steady_seconds() - began_,
               left = passed * work_left_ / std::max(work_to_do_ - work_left_, 1.0);
  const std::string line = fmt::format("{} of {} points, {} passed, {} left", done_, points_.size(),
                                       duration_text(passed), duration_text(left));
  if (isatty(STDERR_FILENO) && !quiet_)
    tell_as_is("\r\033[K" + line);
  else if (steady_seconds() > next_line_ || done_ == points_.size())
    say(line);
  else
    return;
  next_line_ = steady_seconds() + 10;
}

void SweepProgress::clear_line() const {
  if (isatty(STDERR_FILENO) && !quiet_) tell_as_is("\r\033[K");
}

void SweepProgress::say(const std::string& line) const {
  if (!quiet_) tell_as_is(fmt::format("{}{}\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", line));
}

void tell_not_ended(const CampaignDirectory& dir, const std::string& point) {
  tell(fmt::format("not ended: {}, see {}", point, dir.messages(point)));
}

int tell_stop() {
  tell_as_is(
      fmt::format("ropewalk: stopped by signal {}; go on with the same command\n", static_cast<int>(stop_signal)));
  return 128 + stop_signal;
}

int solve_here(int threads, const std::function<int()>& solve) {
  use_threads(threads);
  listen_to_stop_signals();
  try {
    return solve();
  } catch (const StaticsStopped&) {
    return tell_stop();
  }
}

}  // namespace ropewalk
