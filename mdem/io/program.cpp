#include "io/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <exception>
#include <initializer_list>
#include <new>

#include "io/error_exit.hpp"

namespace ropewalk {

namespace {

const char* program_name = "";

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
}

}  // namespace ropewalk
