// Tasks that run side by side, each in a process of its own: they share nothing, and one that dies takes no other
// with it. What a task finds out, it leaves in a file.
#pragma once

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace ropewalk {

struct ProcessTask {
  std::function<int()> work;               // in the process; returns its exit code and does not throw
  std::function<void(int status)> finish;  // here, with the status of waitpid
};

// At most `jobs` at a time, in their order. Threads of a task share the cores with the others'. Once `stop` is not
// 0 (a signal's handler sets it) those at work get SIGTERM and no other is started. Throws std::runtime_error where
// no process can be started.
void run_processes(const std::vector<ProcessTask>& tasks, int jobs,
                   const volatile std::sig_atomic_t* stop = nullptr);

// "its process was ended by signal 9"
std::string death_words(int status);

}  // namespace ropewalk
