// Changes of single keys in the text of a scene, which keeps its comments and its order.
#pragma once

#include <string>

namespace ropewalk {

// Sets a key of a table ("": the top), replacing the line that sets it, else one where it stands as a comment, else
// as the first key of the table, which is made where there is none. `value` as TOML.
std::string with_key(const std::string& text, const std::string& table, const std::string& key,
                     const std::string& value);

// Sets the value at a path, whose parts are separated by points and count from 0 in lists: "rope.tubes",
// "grip.1.about_z.rotation_deg". Everything else stays as it is, comments included. A missing key is set where it
// stands as a comment, else as the first of its table, which is made where there is none. Throws InputError where
// the path leads through something that is no table, or past the end of a list; `file` names the scene in it.
std::string with_value(const std::string& text, const std::string& path, const std::string& value,
                       const std::string& file);

// The number at such a path, or in { value = 1, standard_error = 0.1 } there. Throws InputError where there is
// none.
double number_at(const std::string& text, const std::string& path, const std::string& file);

}  // namespace ropewalk
