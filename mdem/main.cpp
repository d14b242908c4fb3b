// ropewalk: the front door.
#include "commands/program.hpp"

int main(int argc, char** argv) { return ropewalk::ropewalk_main(argc, argv); }
