#include "commands/point_runs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "campaign/campaign.hpp"
#include "commands/commands.hpp"
#include "io/failure.hpp"
#include "run/tell.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Until the process ends.
bool lock(const std::string& path, bool wait) {
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  return file >= 0 && flock(file, LOCK_EX | (wait ? 0 : LOCK_NB)) == 0;
}

}  // namespace

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string duration_text(double s) {
  if (s >= 5400) return fmt::format("{:.1f} h", s / 3600);
  return s >= 90 ? fmt::format("{:.0f} min", s / 60) : fmt::format("{:.0f} s", s);
}

int run_or_resume(const RunDirectory& dir, const Scene& scene, double until_ps, const std::string& on_limit) {
  if (progress_of(dir).stage == PointProgress::Stage::begun) {
    ResumeArguments r;
    r.dir = dir.path;
    r.threads = 1;
    r.until_ps = until_ps;
    r.on_limit = on_limit;
    r.quiet = true;
    return resume_command(r);
  }
  fs::remove_all(dir.path);  // of a run that was killed before its first checkpoint
  RunArguments a;
  a.out = dir.path;
  a.until_ps = until_ps;
  a.on_limit = on_limit;
  a.quiet = true;
  use_threads(1);
  return run_scene(scene, a);
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
