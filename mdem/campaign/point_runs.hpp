// Runs of a campaign, each in a process of its own.
#pragma once

#include <functional>
#include <string>

#include "io/stop_signals.hpp"
#include "run/limit_watch.hpp"
#include "run/run.hpp"
#include "run/run_directory.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

inline constexpr int point_busy = 75;  // exit code of a process that found its point locked by another one

// Removes a run that was killed before its first checkpoint. Throws InputError where the directory holds anything
// else: more than the first row of a log, or a file that is not of a run.
void remove_hardly_begun(const RunDirectory& dir);
// The exit code of a run of a campaign, which says how it ended. It is 0 also where the run is not as its scene
// expects: the campaign counts that by itself (judged()).
int code_of(const RunResult& result, bool again = false);
// Starts a run on one thread in a directory that is not there. Negative `until_ps`: to the scene's end.
int run_anew(const RunDirectory& dir, const Scene& scene, double until_ps, OnLimit on_limit, RunListener& listener);
// A run that was begun goes on, another one is started.
int run_or_resume(const RunDirectory& dir, const Scene& scene, double until_ps, OnLimit on_limit);

// Prints to the file `messages` and keeps other processes from the same work, by a lock on it: waits for them, or
// returns point_busy. Returns the exit code of `work`, or that of its exception.
int in_a_process(const std::string& messages, bool wait, const std::function<int()>& work);

}  // namespace ropewalk
