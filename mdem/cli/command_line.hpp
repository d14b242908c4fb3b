// Command lines of all programs of Ropewalk: they name mistyped words, and describe themselves to the shell, to
// `man` and to the pages of the documentation.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/error_exit.hpp"
#include "io/toml_table.hpp"  // Bounds

namespace ropewalk {

// The fault in one line, with the nearest verb or option where one was mistyped. `program` as it is typed.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error, const std::string& program);

// Makes --help no wider than a terminal. Call it before verbs are added: they take the setting over.
void keep_help_within_width(CLI::App& app);

// The values that an option takes; the error names them.
CLI::Validator number_within(const Bounds& bounds);
constexpr int unbounded = std::numeric_limits<int>::max();
CLI::Validator whole_number(int least, int most = unbounded);

// What the verbs of a program know, and how they end it. Each verb is a file with its options, one row each in
// add_VERB(app, program), and what it does. Help, man page, completions and the site's page of commands are written from
// the rows.
struct Program {
  char** argv;          // words of the command line
  std::string command;  // the same as typed in a shell, for verbs that write it into a file
  int code = 0;         // exit code of the verb that was called
};

// Parses the words of the program, which runs the verb, after `before`. Returns the exit code. An exception becomes one
// line: a wrong command line a usage error, any other by `failed`. `name` begins the line; in remedies the program is
// called `typed`.
int run_program(CLI::App& app, int argc, const Program& program, const char* name, const std::string& typed,
                const std::function<void()>& before = {},
                int (*failed)(const char* name, const std::exception& error) = report_error);

// How a program describes itself.
struct Description {
  std::string program;  // the name of its file
  std::string version;
  std::string long_text;                                           // ends the man page; lines are kept
  nlohmann::ordered_json more = nlohmann::ordered_json::object();  // what describe json says of a program alone
  // For completion, besides those that an option lists itself: values by the option, as "--kind", or the verb that
  // takes them.
  std::map<std::string, std::vector<std::string>> values = {};
  std::vector<std::string> siblings = {};  // verbs that other programs have, named after this one and the verb
};
std::string man_page(const CLI::App& app, const Description& d);
std::string bash_completion(const CLI::App& app, const Description& d);
std::string zsh_completion(const CLI::App& app, const Description& d);
std::string fish_completion(const CLI::App& app, const Description& d);
// Verbs and options, with all of `more`.
std::string json_description(const CLI::App& app, const Description& d);

// Adds the verb `describe`, which prints one of them, and makes the description then. It is not listed.
void add_describe(CLI::App& app, const std::function<Description()>& describe);

}  // namespace ropewalk
