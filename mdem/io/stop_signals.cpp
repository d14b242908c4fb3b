#include "io/stop_signals.hpp"

namespace ropewalk {
namespace {

constexpr int asking[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2};

void on_signal(int signal) { stop_signal = signal; }

}  // namespace

volatile std::sig_atomic_t stop_signal = 0;

void listen_to_stop_signals() {
  for (const int signal : asking)
    if (std::signal(signal, on_signal) == SIG_IGN && signal != SIGINT) std::signal(signal, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void forget_stop_signals() {
  for (const int signal : asking)
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace ropewalk
