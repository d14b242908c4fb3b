#include "io/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <initializer_list>

#include "io/failure.hpp"

namespace ropewalk {

namespace {

const char* program_name = "";

[[noreturn]] void end_with_a_line() {
  try {
    if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::exception& e) {
    tell_failure(program_name, e);
  } catch (...) {
  }
  _exit(3);
}

}  // namespace

void begin_program(const char* name) {
  program_name = name;
  std::set_terminate(end_with_a_line);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == STDIN_FILENO ? O_RDONLY : O_WRONLY) != fd) _exit(3);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace ropewalk
