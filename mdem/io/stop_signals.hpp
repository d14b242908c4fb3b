// Signals that ask a program to stop: it saves its state and ends. Those of batch systems are among them.
#pragma once

#include <csignal>

namespace ropewalk {

// The one that came; 0: none.
extern volatile std::sig_atomic_t stop_signal;

// From now on INT, TERM, HUP, XCPU, USR1 and USR2 are noted in stop_signal. A reader that went away (PIPE) ends
// nothing. A signal that is ignored when the program starts, as HUP under nohup, stays ignored; INT does not, since
// a shell has its background jobs ignore it.
void listen_to_stop_signals();

// For a process just forked: they end it again.
void forget_stop_signals();

}  // namespace ropewalk
