// Changes of single keys in the text of a scene, which keeps its comments and its order.
#pragma once

#include <string>

namespace ropewalk {

// Sets a key of a table ("": the top), replacing the line that sets it, else one where it stands as a comment, else
// as the first key of the table, which is made where there is none. `value` as TOML.
std::string with_key(const std::string& text, const std::string& table, const std::string& key,
                     const std::string& value);

// Makes the line that sets a key a comment; the text itself where there is none.
std::string without_key(const std::string& text, const std::string& table, const std::string& key);

}  // namespace ropewalk
