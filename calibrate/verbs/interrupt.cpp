#include <csignal>

#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

volatile std::sig_atomic_t caught = 0;

void note_signal(int signal) { caught = signal; }

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

int interrupted_by() { return caught; }

}  // namespace ropewalk::calibrate
