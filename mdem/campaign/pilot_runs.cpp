#include "campaign/pilot_runs.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "campaign/point_runs.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "run/run_time.hpp"
#include "run/tell.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

// The last message of a failed run, without the place of its files, which are gone.
std::string last_line(std::string said) {
  while (!said.empty() && said.back() == '\n') said.pop_back();
  const std::size_t begin = said.find_last_of('\n');
  if (begin != std::string::npos) said.erase(0, begin + 1);
  const std::string name = "ropewalk: ";
  if (said.rfind(name, 0) == 0) said.erase(0, name.size());
  return said.substr(0, said.find(". State written to"));
}

PilotEnd end_of(const std::string& run, int status) {
  PilotEnd end;
  constexpr int not_at_rest = 4;
  if (!WIFEXITED(status)) {
    end.failure = death_words(status);
  } else if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != not_at_rest) {
    const std::string said = read_file(run + ".txt");
    end.failure = last_line(said);
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
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const std::string run = folder_.file(std::to_string(count_++));
    processes.push_back({[this, run, &task = tasks[k]] { return work(run, task); },
                         [this, run, &task = tasks[k], &end = ends[k]](int status) {
                           end = end_of(run, status);
                           seconds_ += end.seconds;
                           if (isatty(STDERR_FILENO)) tell_as_is(fmt::format("\r\033[Kpilot: {}", task.name));
                         }});
  }
  run_processes(processes, jobs_, &stop_signal);
  if (isatty(STDERR_FILENO)) tell_as_is("\r\033[K");
  if (stop_signal)
    throw InputError({path_, 0, ""}, "planning was stopped by a signal", "nothing was written; start it again");
  return ends;
}

int PilotRuns::work(const std::string& run, const PilotTask& task) const {
  return in_a_process(run + ".txt", false, [&] {
    const int code = run_anew({run}, scene_of_text(task.text, path_), task.until, OnLimit::warn);
    write_file_atomically(run + ".seconds", fmt::format("{:.6g}", processor_seconds()));
    return code;
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
