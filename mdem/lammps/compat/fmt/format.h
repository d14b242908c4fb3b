// Debian ships LAMMPS's headers without the formatting library that they name. They only declare with it, and our
// styles hand over finished std::strings: these names are all that the compiler needs.
#pragma once

namespace fmt {

class string_view;
class format_args;

template <class... Args, class S>
format_args make_args_checked(const S& format, Args&... args);

}  // namespace fmt
