// What files hold, described where it is written: the writer takes names from these tables, docs/outputs.md all of
// it.
#pragma once

#include <string>

namespace ropewalk {

// A column, or a key of a JSON object.
struct OutputColumn {
  const char* name;
  const char* unit;  // empty: a pure number, or text
  const char* meaning;
};

template <class Columns>
std::string column_names(const Columns& columns, const char* separator = ",") {
  std::string text;
  for (const OutputColumn& c : columns) text += (text.empty() ? "" : separator) + std::string(c.name);
  return text;
}

// A table for people.
template <class Columns>
std::string columns_markdown(const Columns& columns) {
  std::string text = "| name | unit | meaning |\n|---|---|---|\n";
  for (const OutputColumn& c : columns)
    text += "| `" + std::string(c.name) + "` | " + c.unit + " | " + c.meaning + " |\n";
  return text;
}

}  // namespace ropewalk
