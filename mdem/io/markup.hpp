// Text that goes into XML, SVG or HTML.
#pragma once

#include <string>
#include <string_view>

namespace ropewalk {

// & < > " ' as entities; control characters, which XML forbids, as question marks.
std::string escape_markup(std::string_view text);

}  // namespace ropewalk
