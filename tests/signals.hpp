// Sets the signals to the dispositions that a terminal gives a program, for tests that send them.
#pragma once

#include <csignal>

namespace ropewalk::test {

// Under nohup HUP is ignored, and in the background of a script INT; programs inherit that, and rightly keep HUP
// so. As long as this lives no signal that the tests send is ignored or blocked, here and in programs started
// meanwhile. Elsewhere tests leave it as it is, so that they outlive the terminal.
class SignalsOfATerminal {
 public:
  SignalsOfATerminal() {
    sigset_t all;
    sigemptyset(&all);
    for (int k = 0; k < count; ++k) {
      sigaddset(&all, numbers[k]);
      struct sigaction usual {};
      usual.sa_handler = SIG_DFL;
      sigaction(numbers[k], &usual, &before_[k]);
    }
    pthread_sigmask(SIG_UNBLOCK, &all, &blocked_);
  }
  SignalsOfATerminal(const SignalsOfATerminal&) = delete;
  SignalsOfATerminal& operator=(const SignalsOfATerminal&) = delete;
  ~SignalsOfATerminal() {
    pthread_sigmask(SIG_SETMASK, &blocked_, nullptr);
    for (int k = 0; k < count; ++k) sigaction(numbers[k], &before_[k], nullptr);
  }

 private:
  static constexpr int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2}, count = 6;
  struct sigaction before_[count] = {};
  sigset_t blocked_ = {};
};

}  // namespace ropewalk::test
