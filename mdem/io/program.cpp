#include "io/program.hpp"

#include <fcntl.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <new>

#include "io/error_exit.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {

namespace {

const char* program_name = "";

constexpr rlim_t least_stack = 256 << 10;  // bytes

// Gives back what the program began with, so that small requests succeed from then on. Libraries do not bear that
// one of these fails: nlohmann-json 3.11 crashes as it unwinds, and toml++ takes the number that it reads for a
// wrong one. A large request that fails all the same is an exception as any other.
constexpr std::size_t reserve_bytes = 1 << 20;
std::atomic<char*> reserve{nullptr};

void give_up_the_reserve() {
  char* const kept = reserve.exchange(nullptr);
  if (!kept) throw std::bad_alloc();
  delete[] kept;
}

[[noreturn]] void end_with_a_line() {
  try {
    if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::exception& e) {
    report_error(program_name, e);
  } catch (...) {
  }
  _exit(3);
}

}  // namespace

void begin_program(const char* name) {
  program_name = name;
  std::set_terminate(end_with_a_line);
  reserve = new char[reserve_bytes];
  std::set_new_handler(give_up_the_reserve);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == STDIN_FILENO ? O_RDONLY : O_WRONLY) != fd) _exit(3);
  std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit stack {};
  if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < least_stack) {
    std::fprintf(stderr, "%s: the stack may have %llu kB, and %llu are needed; raise the limit (ulimit -s 8192)\n",
                 name, static_cast<unsigned long long>(stack.rlim_cur >> 10),
                 static_cast<unsigned long long>(least_stack >> 10));
    std::exit(2);
  }
  if (omp_get_max_threads() > most_threads && std::getenv("OMP_NUM_THREADS")) {
    std::fprintf(stderr, "%s: OMP_NUM_THREADS: asks for %d threads; set it to 1 to %d\n", name,
                 omp_get_max_threads(), most_threads);
    std::exit(2);
  }
}

}  // namespace ropewalk
