#include "atoms/lammps.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* install_line = "apt-get install lammps lammps-data";

std::string program_of(const LammpsOptions& options) {
  const char* chosen = std::getenv("ROPEWALK_LMP");
  const std::string program = chosen && *chosen ? chosen : options.program;
  // A relative path refers to the current folder, but the child starts in another one.
  return program.find('/') == std::string::npos ? program : fs::absolute(program).string();
}

InputError not_startable(const std::string& program, int code) {
  const char* why = code == ENOENT ? "there is no such program" : std::strerror(code);
  return InputError({"", 0, "lmp"}, fmt::format("LAMMPS cannot be started as '{}': {}", program, why),
                    fmt::format("install it ({}) or name it with ROPEWALK_LMP", install_line));
}

// The file may be missing or incomplete; the caller reports both.
std::string read_if_there(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? read_file(path) : std::string();
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

struct LammpsComplaint {
  std::string error;         // "ERROR: Lost atoms: original 40 current 39 (src/thermo.cpp:438)"
  std::string last_command;  // "run 100"
};

LammpsComplaint complaint_in(const std::string& output) {
  LammpsComplaint found;
  std::string other;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (found.error.empty() && line.rfind("ERROR", 0) == 0) found.error = trimmed(line);
    if (line.rfind("Last command:", 0) == 0) found.last_command = trimmed(line.substr(13));
    // A message of MPI or of the loader, if LAMMPS itself printed none.
    if (other.empty() && (line.find("ERROR") != std::string::npos || line.find("error") != std::string::npos))
      other = trimmed(line);
  }
  if (found.error.empty()) found.error = other;
  return found;
}

std::string remedy_for(const std::string& error) {
  struct Remedy {
    const char* sign;
    const char* text;
  };
  static constexpr Remedy remedies[] = {
      {"PMIX", "its MPI could not start: a limit on files, memory or disk may be reached (ulimit -a, df, TMPDIR)"},
      {"Lost atoms", "an atom left the box: make the strains smaller, or the potential does not hold this tube"},
      {"Non-numeric", "atoms came too close: make the strains smaller, or the potential does not hold this tube"},
      {"Unrecognized pair style",
       "this lmp lacks the package of the potential: install another, or choose another"},
      {"cannot open", "check the file name; Debian's potential files are in the package lammps-data"},
      {"Cannot open", "check the file name; Debian's potential files are in the package lammps-data"},
      {"pair coefficients", "check the pair_coeff line: one atom type, one element"},
      {"pair_coeff", "check the pair_coeff line: one atom type, one element"},
      {"Unknown command", "this lmp is too old or lacks a package: install another"},
      {"memory", "the tube is too large for this machine: make the cells shorter"}};
  for (const Remedy& remedy : remedies)
    if (error.find(remedy.sign) != std::string::npos) return remedy.text;
  return "its input and log are in that folder";
}

// Unknown: not full.
bool disk_is_full(const std::string& folder) {
  constexpr double least = 1e5;  // bytes for an ordinary user
  struct statvfs status {};
  if (::statvfs(folder.c_str(), &status) != 0) return false;
  return static_cast<double>(status.f_bavail) * static_cast<double>(status.f_frsize) < least;
}

std::string signal_name(int number) {
  const char* name = ::sigabbrev_np(number);
  return name ? fmt::format("SIG{}", name) : fmt::format("signal {}", number);
}

std::string remedy_for_signal(int number) {
  if (number == SIGBUS)
    return "the disk of TMPDIR may be full, which MPI keeps its memory on: free some space (df)";
  if (number == SIGXFSZ) return "the limit on the size of files is reached: raise it (ulimit -f)";
  if (number == SIGXCPU) return "the limit on the processor time is reached: raise it (ulimit -t)";
  if (number == SIGKILL) return "someone killed it, or the memory was full: run it again, with shorter cells";
  return "run it again; if it was LAMMPS itself, look into its log";
}

}  // namespace

bool LammpsVersion::has_pair_style(const std::string& style) const {
  return std::find(pair_styles.begin(), pair_styles.end(), style) != pair_styles.end();
}

void refuse_full_disk(const std::string& folder) {
  if (disk_is_full(folder))
    throw LammpsDiskFull(
        fmt::format("LAMMPS could not write its files: the disk of {} is full; free some space, or choose another "
                    "disk (TMPDIR, --keep DIR)",
                    folder));
}

LammpsVersion lammps_version(const LammpsOptions& options) {
  const std::string program = program_of(options);
  const TemporaryFolder folder;

  ChildOptions child;
  child.folder = folder.path();
  child.output = folder.file("help.out");
  child.quiet_seconds = std::min(options.quiet_seconds, 30.0);
  child.max_seconds = 60;
  child.interrupted = options.interrupted;
  const ChildEnd end = run_child({program, "-h"}, child);
  refuse_full_disk(folder.path());
  if (end.kind == ChildEnd::Kind::not_started) throw not_startable(program, end.code);
  if (end.kind == ChildEnd::Kind::killed_by_signal)
    throw InputError({"", 0, "lmp"}, fmt::format("'{} -h' was ended by {}", program, signal_name(end.code)),
                     remedy_for_signal(end.code));
  const std::string help = read_if_there(child.output);

  LammpsVersion version;
  const std::string title = "Massively Parallel Simulator - ";
  if (const auto at = help.find(title); at != std::string::npos)
    version.text = trimmed(help.substr(at + title.size(), help.find('\n', at) - at - title.size()));
  const std::string complaint = complaint_in(help).error;
  if (end.kind != ChildEnd::Kind::exited || end.code != 0 || version.text.empty())
    throw InputError({"", 0, "lmp"},
                     fmt::format("'{} -h' does not answer as LAMMPS does{}", program,
                                 complaint.empty() ? "" : " (" + complaint + ")"),
                     complaint.find("PMIX") != std::string::npos
                         ? remedy_for(complaint)
                         : fmt::format("install it ({}) or name it with ROPEWALK_LMP", install_line));

  // Two lists of words: one up to an empty line, one up to the next heading.
  const auto words_after = [&](const char* heading, const char* stop) {
    std::vector<std::string> words;
    const auto at = help.find(heading);
    if (at == std::string::npos) return words;
    const auto from = help.find_first_not_of(" \n", at + std::strlen(heading));
    if (from == std::string::npos) return words;
    std::istringstream stream(help.substr(from, help.find(stop, from) - from));
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  };
  version.packages = words_after("Installed packages:", "\n\n");
  version.pair_styles = words_after("* Pair styles:", "\n*");
  return version;
}

void run_lammps(const std::string& folder, const std::string& name, const std::string& input,
                const LammpsOptions& options) {
  const std::string program = program_of(options);
  std::error_code code;
  fs::create_directories(folder, code);
  if (code)
    throw InputError({folder, 0, ""}, "cannot be made: " + code.message(), "name a writable folder (--keep DIR)");
  const std::string place = fs::absolute(folder).lexically_normal().string();
  const std::string base = place + "/" + name;
  write_file_atomically(base + ".in", input);

  ChildOptions child;
  child.folder = place;
  child.output = base + ".out";
  child.watched = {base + ".log", base + ".dat"};
  child.quiet_seconds = options.quiet_seconds;
  child.max_seconds = options.max_seconds;
  child.most_bytes = options.most_bytes;
  child.interrupted = options.interrupted;
  for (const std::string& old : {base + ".log", base + ".dat", base + ".out"}) fs::remove(old, code);
  const ChildEnd end = run_child({program, "-in", name + ".in", "-log", name + ".log", "-nocite"}, child);

  const auto fail = [&](const std::string& what, const std::string& remedy) {
    refuse_full_disk(place);
    const LammpsComplaint complaint = complaint_in(read_if_there(base + ".out") + read_if_there(base + ".log"));
    std::string text = fmt::format("LAMMPS ({}.in) {}", base, what);
    if (!complaint.error.empty()) text += fmt::format(": {}", complaint.error);
    if (!complaint.last_command.empty()) text += fmt::format("; its last command was '{}'", complaint.last_command);
    text += "; " + (remedy.empty() ? remedy_for(complaint.error) : remedy);
    throw LammpsError(text);
  };
  switch (end.kind) {
    case ChildEnd::Kind::not_started:
      throw not_startable(program, end.code);
    case ChildEnd::Kind::killed_by_signal:
      fail(fmt::format("was ended by {}", signal_name(end.code)), remedy_for_signal(end.code));
      break;
    case ChildEnd::Kind::quiet:
      fail(fmt::format("wrote nothing for {:g} s and was ended", options.quiet_seconds),
           "the machine may be overloaded: run it again, or look into its log");
      break;
    case ChildEnd::Kind::too_long:
      fail(fmt::format("took longer than {:g} s and was ended", options.max_seconds),
           "the tube may be too large: choose a smaller one or shorter cells");
      break;
    case ChildEnd::Kind::too_much:
      fail(fmt::format("wrote more than {} MiB and was ended", child.most_bytes >> 20),
           "it repeats itself or is not LAMMPS: look into its log");
      break;
    case ChildEnd::Kind::interrupted:
      fail("was interrupted", "run it again");
      break;
    case ChildEnd::Kind::exited:
      break;
  }
  if (end.code != 0) fail(fmt::format("stopped with status {}", end.code), "");
  if (read_if_there(base + ".log").find("Total wall time") == std::string::npos)
    fail("left an incomplete log", "check the disk and the folder");
}

}  // namespace ropewalk
