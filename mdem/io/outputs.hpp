// Tables of columns and keys, beside the code that writes them. The writers take the names from these tables;
// docs/outputs.md is made from them.
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

// The table in Markdown.
template <class Columns>
std::string columns_markdown(const Columns& columns) {
  std::string text = "| name | unit | meaning |\n|---|---|---|\n";
  for (const OutputColumn& c : columns)
    text += "| `" + std::string(c.name) + "` | " + c.unit + " | " + c.meaning + " |\n";
  return text;
}

}  // namespace ropewalk
