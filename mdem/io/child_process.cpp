#include "io/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <thread>

#include "io/clocks.hpp"

namespace ropewalk {
namespace {

// The process group of the child, which a signal to this process also ends. There is one child at a time; a second
// child would still be ended by its parent-death signal.
std::atomic<pid_t> group_to_end{0};
static_assert(std::atomic<pid_t>::is_always_lock_free, "the signal handler reads it");

void end_group(int signal_number) {
  const pid_t group = group_to_end.load();
  if (group > 0) ::kill(-group, SIGKILL);
  ::signal(signal_number, SIG_DFL);
  ::raise(signal_number);
}

// Handles SIGINT, SIGTERM and SIGHUP unless they already have a handler.
class SignalGuard {
 public:
  explicit SignalGuard(pid_t group) {
    group_to_end = group;
    for (std::size_t i = 0; i < 3; ++i) {
      struct sigaction current {};
      ::sigaction(numbers[i], nullptr, &current);
      taken_[i] = (current.sa_flags & SA_SIGINFO) == 0 && current.sa_handler == SIG_DFL;
      if (!taken_[i]) continue;
      struct sigaction ours {};
      ours.sa_handler = end_group;
      ::sigaction(numbers[i], &ours, &old_[i]);
    }
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
  ~SignalGuard() {
    for (std::size_t i = 0; i < 3; ++i)
      if (taken_[i]) ::sigaction(numbers[i], &old_[i], nullptr);
    group_to_end = 0;
  }

 private:
  static constexpr int numbers[3] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction old_[3] = {};
  bool taken_[3] = {};
};

long long bytes_written(const ChildOptions& options) {
  long long bytes = 0;
  struct stat status {};
  if (!options.output.empty() && ::stat(options.output.c_str(), &status) == 0) bytes += status.st_size;
  for (const std::string& file : options.watched)
    if (::stat(file.c_str(), &status) == 0) bytes += status.st_size;
  return bytes;
}

// Runs in the child between fork and exec: only async-signal-safe calls are allowed.
[[noreturn]] void become(char* const* arguments, char* const* environment, const char* folder, int output,
                         int report, pid_t parent, const struct rlimit& most, bool bounded) {
  const auto give_up = [&] {
    const int code = errno;
    (void)!::write(report, &code, sizeof code);
    ::_exit(127);
  };
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // the parent died before the line above
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int input = ::open("/dev/null", O_RDONLY);
  if (::chdir(folder) != 0) give_up();
  if (::dup2(input, 0) < 0) give_up();
  if (output >= 0 && (::dup2(output, 1) < 0 || ::dup2(output, 2) < 0)) give_up();
  ::setrlimit(RLIMIT_FSIZE, &most);
  if (bounded) ::signal(SIGXFSZ, SIG_DFL);  // the end of a program that would go on without its file
  ::execvpe(arguments[0], arguments, environment);
  give_up();
  ::_exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

std::vector<std::string> one_thread_environment() {
  std::vector<std::string> variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    if (text.rfind("OMP_NUM_THREADS=", 0) != 0) variables.push_back(text);
  }
  variables.push_back("OMP_NUM_THREADS=1");
  // A single process needs no network; Open MPI starts in half the time without the search for one.
  for (const char* setting : {"OMPI_MCA_btl=self", "OMPI_MCA_pml=ob1"}) {
    const std::string name = std::string(setting).substr(0, std::string(setting).find('=') + 1);
    const auto same = [&](const std::string& text) { return text.rfind(name, 0) == 0; };
    if (std::none_of(variables.begin(), variables.end(), same)) variables.push_back(setting);
  }
  return variables;
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& arguments, const ChildOptions& options) {
  const double start = steady_seconds();
  ChildEnd end;
  std::vector<std::string> argument_texts = arguments, environment_texts = one_thread_environment();
  const std::vector<char*> argument_list = pointers(argument_texts), environment = pointers(environment_texts);

  const auto failed = [&](int code) {
    end.kind = ChildEnd::Kind::not_started;
    end.code = code;
    return end;
  };
  const bool own_output = !options.output.empty();
  const int output =
      own_output ? ::open(options.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : -1;
  if (own_output && output < 0) return failed(errno);
  struct rlimit most {};
  ::getrlimit(RLIMIT_FSIZE, &most);
  const bool bounded = options.most_bytes < std::numeric_limits<long long>::max() &&
                       static_cast<rlim_t>(options.most_bytes) < most.rlim_cur;
  if (bounded) most.rlim_cur = static_cast<rlim_t>(options.most_bytes);
  int report[2];  // closes by itself when exec succeeds, else carries errno
  if (::pipe2(report, O_CLOEXEC) != 0) {
    const int code = errno;
    if (own_output) ::close(output);
    return failed(code);
  }
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0)
    become(argument_list.data(), environment.data(), options.folder.c_str(), output, report[1], parent, most,
           bounded);
  const int fork_code = errno;
  if (own_output) ::close(output);
  ::close(report[1]);
  if (child < 0) {
    ::close(report[0]);
    return failed(fork_code);
  }
  ::setpgid(child, child);  // called in parent and child, so that neither call can come too late
  const SignalGuard guard(child);

  int code = 0;
  ssize_t got = 0;
  do got = ::read(report[0], &code, sizeof code);
  while (got < 0 && errno == EINTR);
  ::close(report[0]);

  long long bytes = 0;
  double last_growth = start;
  double pause = 0.001;
  for (;;) {
    int status = 0;
    const pid_t done = ::waitpid(child, &status, WNOHANG);
    if (done == child) {
      end.seconds = seconds_since(start);
      if (got == sizeof code) return failed(code);
      const bool signalled = WIFSIGNALED(status);
      end.kind = signalled ? ChildEnd::Kind::killed_by_signal : ChildEnd::Kind::exited;
      end.code = signalled ? WTERMSIG(status) : WEXITSTATUS(status);
      const bool full = (signalled || end.code != 0) && bytes_written(options) >= options.most_bytes;
      if (bounded && ((signalled && end.code == SIGXFSZ) || full)) end.kind = ChildEnd::Kind::too_much;
      return end;
    }
    if (done < 0 && errno != EINTR) return failed(errno);

    if (const long long now = bytes_written(options); now != bytes) {
      bytes = now;
      last_growth = steady_seconds();
    }
    end.seconds = seconds_since(start);
    const bool asked = options.interrupted && options.interrupted();
    const bool too_long = end.seconds > options.max_seconds, too_much = bytes >= options.most_bytes;
    if (asked || too_long || too_much || seconds_since(last_growth) > options.quiet_seconds) {
      ::kill(-child, SIGKILL);
      ::kill(child, SIGKILL);
      while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
      end.kind = asked      ? ChildEnd::Kind::interrupted
                 : too_long ? ChildEnd::Kind::too_long
                 : too_much ? ChildEnd::Kind::too_much
                            : ChildEnd::Kind::quiet;
      return end;
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(pause));
    pause = std::min(0.05, 1.3 * pause);
  }
}

ProgramEnd run_program(const std::vector<std::string>& words) {
  ChildOptions options;
  options.quiet_seconds = std::numeric_limits<double>::infinity();
  options.max_seconds = 4 * 3600;
  options.most_bytes = std::numeric_limits<long long>::max();
  const ChildEnd end = run_child(words, options);
  if (end.kind == ChildEnd::Kind::not_started && end.code == ENOENT) return ProgramEnd::missing;
  return end.kind == ChildEnd::Kind::exited && end.code == 0 ? ProgramEnd::well : ProgramEnd::failed;
}

}  // namespace ropewalk
