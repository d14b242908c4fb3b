#include "campaign/point_runs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cstdio>
#include <filesystem>

#include "campaign/campaign.hpp"
#include "io/failure.hpp"
#include "run/begin_run.hpp"
#include "run/terminal_listener.hpp"
#include "run/threads.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Until the process ends.
bool lock(const std::string& path, bool wait) {
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  return file >= 0 && flock(file, LOCK_EX | (wait ? 0 : LOCK_NB)) == 0;
}

}  // namespace

std::string duration_text(double s) {
  if (s >= 5400) return fmt::format("{:.1f} h", s / 3600);
  return s >= 90 ? fmt::format("{:.0f} min", s / 60) : fmt::format("{:.0f} s", s);
}

int run_or_resume(const RunDirectory& dir, const Scene& scene, double until_ps, OnLimit on_limit) {
  use_threads(1);
  TerminalListener terminal(true);
  if (progress_of(dir).stage == PointProgress::Stage::begun) {
    ResumeSettings asked;
    asked.until_ps = until_ps;
    asked.on_limit = on_limit;
    return tell_end(go_through(resume_run(dir, asked, terminal)));
  }
  fs::remove_all(dir.path);  // of a run that was killed before its first checkpoint
  RunSettings asked;
  asked.until_ps = until_ps;
  asked.on_limit = on_limit;
  return tell_end(go_through(begin_run(scene, dir, asked, terminal)));
}

int in_a_process(const std::string& messages, bool wait, const std::function<int()>& work) {
  if (!std::freopen(messages.c_str(), "a", stderr) || !std::freopen(messages.c_str(), "a", stdout)) return 3;
  setvbuf(stdout, nullptr, _IOLBF, 1 << 12);
  if (!lock(messages, wait)) return point_busy;
  try {
    return work();
  } catch (const std::exception& e) {
    return tell_failure("ropewalk", e);
  }
}

}  // namespace ropewalk
