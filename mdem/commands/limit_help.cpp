#include "commands/limit_help.hpp"

#include <sstream>

#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

constexpr const char* heading_mark = "## ";

// Calls use(heading, line) for each line, with the heading above it.
template <class Use>
void each_line(const Use& use) {
  std::istringstream page(limits_page);
  std::string heading;
  for (std::string line; std::getline(page, line);) {
    const bool begins = line.rfind(heading_mark, 0) == 0;
    if (begins) heading = line.substr(3);
    use(heading, line, begins);
  }
}

}  // namespace

std::vector<std::string> limit_headings() {
  std::vector<std::string> out;
  each_line([&](const std::string& heading, const std::string&, bool begins) {
    if (begins) out.push_back(heading);
  });
  return out;
}

std::string limit_help(const std::string& limit) {
  std::string text;
  each_line([&](const std::string& heading, const std::string& line, bool begins) {
    if (!begins && !limit.empty() && heading == limit) text += line + "\n";
  });
  const std::size_t from = text.find_first_not_of('\n'), to = text.find_last_not_of('\n');
  return from == std::string::npos ? "" : markdown_within_width(text.substr(from, to + 1 - from));
}

}  // namespace ropewalk
