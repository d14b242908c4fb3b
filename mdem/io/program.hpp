// The first steps of every program.
#pragma once

namespace ropewalk {

// Opens the null device on standard input, output and error where they are closed, as under some daemons: the first
// file opened would take their number, and messages would land in it. Has a file that passes the limit on sizes
// (ulimit -f) be an error and not a signal. Keeps some memory for small requests once large ones fail. An exception
// that nothing catches is one line and exit code 3. More threads than most_threads in OMP_NUM_THREADS, and a stack
// that is too small, are one line and exit code 2.
void begin_program(const char* name);

}  // namespace ropewalk
