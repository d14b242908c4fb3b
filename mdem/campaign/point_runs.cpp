#include "campaign/point_runs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "campaign/campaign.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "run/begin_run.hpp"
#include "run/terminal_listener.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Until the process ends. False: another process has it. Where the file system knows no locks there is none, and
// that of the run's directory alone counts.
bool lock(int file, bool wait) {
  return uninterrupted([&] { return flock(file, LOCK_EX | (wait ? 0 : LOCK_NB)); }) == 0 || errno != EWOULDBLOCK;
}

}  // namespace

void remove_hardly_begun(const RunDirectory& dir) {
  if (!fs::exists(dir.path)) return;
  refuse_strange_files(dir);
  if (fs::exists(dir.log())) {
    const std::string log = read_file(dir.log());
    if (std::count(log.begin(), log.end(), '\n') > 2)
      throw InputError({dir.path, 0, ""}, "holds a log, and no checkpoint with which it could go on",
                       "take it away, or bring checkpoint.bin and manifest.json back from a copy");
  }
  remove_run(dir, "");
}

int code_of(const RunResult& r, bool again) {
  const int code = tell_end(r, again);
  return code == not_as_expected ? 0 : code;
}

int run_anew(const RunDirectory& dir, const Scene& scene, double until_ps, OnLimit on_limit,
             RunListener& listener) {
  use_threads(1);
  RunSettings asked;
  asked.until_ps = until_ps;
  asked.on_limit = on_limit;
  asked.may_refine = false;
  return code_of(go_through(begin_run(scene, dir, asked, listener)));
}

int run_or_resume(const RunDirectory& dir, const Scene& scene, double until_ps, OnLimit on_limit) {
  use_threads(1);
  TerminalListener terminal(true);
  if (progress_of(dir).stage == PointProgress::Stage::begun) {
    ResumeSettings asked;
    asked.until_ps = until_ps;
    asked.on_limit = on_limit;
    asked.may_refine = false;
    return code_of(go_through(resume_run(dir, asked, terminal)));
  }
  remove_hardly_begun(dir);
  return run_anew(dir, scene, until_ps, on_limit, terminal);
}

int in_a_process(const std::string& messages, bool wait, const std::function<int()>& work) {
  try {
    const Descriptor file = opened_to_write(messages, O_RDWR | O_APPEND);
    if (!lock(file.get(), wait)) return point_busy;
    if (dup2(file.get(), STDERR_FILENO) < 0 || dup2(file.get(), STDOUT_FILENO) < 0)
      throw file_error(messages, "cannot be written", errno);
    setvbuf(stdout, nullptr, _IOLBF, 1 << 12);
    return work();
  } catch (const std::exception& e) {
    return report_error("ropewalk", e);
  }
}

}  // namespace ropewalk
