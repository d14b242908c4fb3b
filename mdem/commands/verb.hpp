// Options and functions that several verbs of `ropewalk` share.
#pragma once

#include <memory>
#include <string>

#include "cli/command_line.hpp"

namespace ropewalk {

// Starts the process anew with an OpenMP runtime that waits briefly, unless it is so, or one thread does all. 0
// threads: all cores.
void wait_briefly(char** argv, int threads);

// --- Options of several verbs ---

CLI::Validator thread_range();
// `of`: what is calculated; `by_default`: in words.
void add_instructions(CLI::App* verb, std::string& name, const char* of, const std::string& by_default);
void add_device(CLI::App* verb, std::string& name, const std::string& by_default);
// `what` is coloured.
CLI::Option* add_colour(CLI::App* verb, std::string& colour, const char* what);

}  // namespace ropewalk
