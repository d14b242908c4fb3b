// `ropewalk calibrate ...` hands over to the program ropewalk-calibrate, as git does with its own.
#pragma once

namespace ropewalk {

// Where argv[1] names a sibling, becomes it; returns otherwise. Throws InputError where it is not to be found.
void hand_over_to_sibling(char** argv);

}  // namespace ropewalk
