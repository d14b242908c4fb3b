// Compiled into each program that links the installed libraries: where these have their data.
#include <io/data_files.hpp>

namespace {
[[maybe_unused]] const bool added = ropewalk::add_data_directory(ROPEWALK_INSTALLED_DATA);
}
