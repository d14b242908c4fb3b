#include "io/processes.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <stdexcept>

#include "io/stop_signals.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

pid_t start(const ProcessTask& task, int jobs) {
  std::fflush(nullptr);
  // A child of GCC's OpenMP waits for ever for the threads of its parent, which it does not have: there must be
  // none.
  omp_pause_resource_all(omp_pause_hard);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw std::runtime_error(fmt::format("no process can be started: {}", std::strerror(errno)));
  if (child > 0) return child;
  forget_stop_signals();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(3);
  use_threads(std::max(1, omp_get_num_procs() / jobs));
  const int code = task.work();
  std::fflush(nullptr);
  _exit(code);
}

}  // namespace

void run_processes(const std::vector<ProcessTask>& tasks, int jobs, const volatile std::sig_atomic_t* stop) {
  std::map<pid_t, const ProcessTask*> at_work;
  bool told = false;
  const auto wait_for_one = [&] {
    int status = 0;
    // A signal that asks to stop does not end waitpid(): it is looked for in between.
    const bool look = stop && !told;
    const pid_t child = waitpid(-1, &status, look ? WNOHANG : 0);
    if (look && child == 0) usleep(2000);
    if (stop && *stop && !told)
      for (const auto& [id, task] : at_work) kill(id, SIGTERM);
    told = told || (stop && *stop);
    const auto at = at_work.find(child);
    if (at == at_work.end()) return;
    at->second->finish(status);
    at_work.erase(at);
  };
  for (const ProcessTask& task : tasks) {
    while (at_work.size() >= static_cast<std::size_t>(jobs)) wait_for_one();
    if (stop && *stop) break;
    at_work.emplace(start(task, jobs), &task);
  }
  while (!at_work.empty()) wait_for_one();
}

std::string death_words(int status) {
  return WIFSIGNALED(status) ? fmt::format("its process was ended by signal {}", WTERMSIG(status))
                             : "its result could not be written";
}

}  // namespace ropewalk
