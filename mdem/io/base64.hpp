// Bytes as text.
#pragma once

#include <string>
#include <string_view>

namespace ropewalk {

std::string base64(std::string_view bytes);

}  // namespace ropewalk
