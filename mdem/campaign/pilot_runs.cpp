#include "campaign/pilot_runs.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "campaign/point_runs.hpp"
#include "io/clocks.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/manifest.hpp"
#include "io/plain_text.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "run/run_time.hpp"
#include "run/tell.hpp"
#include "run/terminal_listener.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// The last message of a failed run, without the place of its files, which are gone.
std::string last_line(std::string said) {
  while (!said.empty() && said.back() == '\n') said.pop_back();
  const std::size_t begin = said.find_last_of('\n');
  if (begin != std::string::npos) said.erase(0, begin + 1);
  const std::string name = "ropewalk: ";
  if (said.rfind(name, 0) == 0) said.erase(0, name.size());
  return said.substr(0, said.find(". State written to"));
}

bool came_to_an_end(int status) {
  constexpr int not_at_rest = 4;
  return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == not_at_rest);
}

// Once a scene is found good, wrong input can only be a directory or a file that cannot be made.
class PilotListener : public TerminalListener {
 public:
  PilotListener() : TerminalListener(true) {}
  void before_files() override {
    TerminalListener::before_files();
    scene_is_good = true;
  }

  bool scene_is_good = false;
};

constexpr int refused = 2, broken_off = 3;  // exit codes of a pilot

// What ended a pilot where it was not its own scene, which was refused or came to no end: a signal, a full disk.
// Empty: it was the scene.
std::string broken_by(const std::string& run, int status) {
  if (came_to_an_end(status)) return "";
  if (!WIFEXITED(status)) return death_words(status);
  const RunDirectory dir{run};
  const bool has_words = fs::exists(run + ".txt"), begun = fs::exists(dir.manifest());
  if (begun && read_manifest(dir.manifest()).status == "failed") return "";
  if (has_words && WEXITSTATUS(status) == refused) return "";
  const std::string said = has_words ? last_line(read_file(run + ".txt")) : "";
  return said.empty() ? "its files could not be written; see whether there is room (TMPDIR names another place)"
                      : said.substr(0, said.find("; then "));
}

PilotEnd end_of(const std::string& run, int status) {
  PilotEnd end;
  if (!came_to_an_end(status)) {
    end.failure = last_line(read_file(run + ".txt"));
  } else {
    end.seconds = leading_number(read_file(run + ".seconds")).value_or(0);
    end.log = read_log(RunDirectory{run}.log());
  }
  return end;
}

}  // namespace

std::vector<PilotEnd> PilotRuns::operator()(const std::vector<PilotTask>& tasks) {
  std::vector<PilotEnd> ends(tasks.size());
  std::vector<ProcessTask> processes;
  std::string broken;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const std::string run = folder_.file(std::to_string(count_++));
    processes.push_back({[this, run, &task = tasks[k]] { return work(run, task); },
                         [this, run, &broken, &task = tasks[k], &end = ends[k]](int status) {
                           if (const std::string why = broken_by(run, status); !why.empty()) {
                             broken = fmt::format("a pilot ({}) was broken off: {}", task.name, why);
                             return;
                           }
                           end = end_of(run, status);
                           seconds_ += end.seconds;
                           if (isatty(STDERR_FILENO)) tell_as_is(fmt::format("\r\033[Kpilot: {}", task.name));
                         }});
  }
  run_processes(processes, jobs_, &stop_signal);
  if (isatty(STDERR_FILENO)) tell_as_is("\r\033[K");
  if (stop_signal)
    throw InputError({path_, 0, ""}, "planning was stopped by a signal", "nothing was written; start it again");
  // A model that the machine left no result of has not been judged: a plan without it would be another one.
  if (!broken.empty()) throw std::runtime_error(broken + "; nothing was written: give the same command again");
  return ends;
}

int PilotRuns::work(const std::string& run, const PilotTask& task) const {
  // Where there is no room for its messages, the plan alone says so.
  if (!std::freopen("/dev/null", "w", stderr)) return broken_off;
  return in_a_process(run + ".txt", false, [&] {
    PilotListener listener;
    try {
      const int code = run_anew({run}, scene_of_text(task.text, path_), task.until, OnLimit::warn, listener);
      write_file_atomically(run + ".seconds", fmt::format("{:.6g}", processor_seconds()));
      return code;
    } catch (const InputError& e) {
      const int code = report_error("ropewalk", e);
      return listener.scene_is_good ? broken_off : code;
    }
  });
}

double seconds_of_run(const PlannedModel& m, const Plan& plan, const std::string& path) {
  if (plan.pilots.empty()) return m.seconds;
  const RunTime whole = time_run(m.text, path), pilot = time_run(m.pilot_text, path);
  if (whole.steps <= 0 || pilot.steps <= 0) return 0;
  Scene scene = scene_of_text(m.pilot_text, path);
  const double part = plan.until >= 0 ? plan.until / prepare(scene).duration : 1;
  const double least = 0.2 * pilot.each;
  const double each = std::max(least, (m.seconds - pilot.outputs) / (part * pilot.steps));
  return whole.outputs + whole.steps * each * whole.at_start / pilot.at_start;
}

}  // namespace ropewalk
