// Files that a verb writes into a directory that the user names, where others may stand under the same names.
#pragma once

#include <string>

namespace ropewalk::validate {

// Stands in every page of the programs.
inline constexpr const char* page_mark = "<p class=\"kicker\">Ropewalk: ";

// Throws InputError where the file is there and does not hold `mark`, a text that each of its kind has.
void refuse_foreign_file(const std::string& path, const std::string& mark);

}  // namespace ropewalk::validate
