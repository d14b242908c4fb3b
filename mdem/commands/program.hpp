// `ropewalk` as a function.
#pragma once

namespace ropewalk {

// Does what the command line says and returns the exit code: 0 done, 2 wrong input, 3 numerical failure or a disk
// that takes no more, 4 a relaxation that did not come to rest, 5 stopped at a limit, 6 stopped by --wall-time, 7
// done but far beyond a limit, 8 done but not as [[expect]] says, 128 + signal when interrupted.
int ropewalk_main(int argc, char** argv);

}  // namespace ropewalk
