#include "core/case_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

std::vector<std::pair<const char*, const char*>>& registered_texts() {
  static std::vector<std::pair<const char*, const char*>> texts;
  return texts;
}

// One section: its paragraphs and items, each on one line.
struct Section {
  std::string heading;
  int line = 0;
  std::vector<std::string> blocks;
};

std::vector<Section> sections_of(const std::string& path, const std::string& text) {
  std::vector<Section> sections;
  std::istringstream in(text);
  bool open = false;  // the next line continues the last block
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t from = line.find_first_not_of(' ');
    if (from == std::string::npos) {
      open = false;
    } else if (line[0] == '#') {
      sections.push_back({line, number, {}});
      open = false;
    } else if (sections.empty()) {
      throw InputError({path, number, ""}, "text before the title", "begin with a line \"# Title\"");
    } else {
      std::vector<std::string>& blocks = sections.back().blocks;
      const bool item = line.compare(0, 2, "- ") == 0;
      if (open && !item)
        blocks.back() += ' ' + line.substr(from);
      else
        blocks.push_back(line.substr(item ? 2 : from));
      open = true;
    }
  }
  return sections;
}

std::string joined(const std::vector<std::string>& blocks, const char* between) {
  return fmt::format("{}", fmt::join(blocks, between));
}

}  // namespace

CaseText parse_case_text(const std::string& path, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::vector<Section> sections = sections_of(path, text);
  const auto take = [&](const std::string& heading, bool needed) {
    const auto at = std::find_if(sections.begin(), sections.end(),
                                 [&](const Section& s) { return s.heading == heading && !s.blocks.empty(); });
    if (at == sections.end()) {
      if (needed)
        throw InputError({path, 0, ""}, fmt::format("has no section \"{}\" with a text", heading), "write it");
      return std::vector<std::string>();
    }
    std::vector<std::string> blocks = std::move(at->blocks);
    sections.erase(at);
    return blocks;
  };
  CaseText t;
  t.group = folder.parent_path().filename().string();
  t.name = folder.filename().string();
  if (sections.empty() || sections[0].heading.compare(0, 2, "# ") != 0 || !sections[0].blocks.empty())
    throw InputError({path, 1, ""}, "has no title, or a text right below it",
                     "begin with a line \"# Title\" and the section \"## Why\"");
  t.title = sections[0].heading.substr(2);
  sections.erase(sections.begin());
  t.why = joined(take("## Why", true), " ");
  t.setup = joined(take("## Set-up", true), " ");
  t.oracle = joined(take("## Oracle", true), " ");
  t.literature = joined(take("## Literature", true), "; ");
  t.remarks = take("## Remarks", false);
  if (!sections.empty())
    throw InputError({path, sections[0].line, sections[0].heading}, "is not a section of a case, or stands twice",
                     "the sections are Why, Set-up, Oracle, Literature and Remarks");
  return t;
}

RegisteredText::RegisteredText(const char* path, const char* text) { registered_texts().emplace_back(path, text); }

std::string registered_text(const std::string& wanted) {
  for (const auto& [path, text] : registered_texts())
    if (wanted == path) return text;
  throw std::out_of_range("the program was built without " + wanted);
}

std::string case_scene(const std::string& name) {
  for (const auto& [path, text] : registered_texts()) {
    const std::filesystem::path file(path);
    if (file.filename() == "scene.toml" && file.parent_path().filename() == name) return text;
  }
  throw std::out_of_range("the case " + name + " has no scene.toml");
}

const CaseText* find_case_text(const std::string& name) {
  static const std::vector<CaseText> texts = [] {
    std::vector<CaseText> parsed;
    for (const auto& [path, text] : registered_texts())
      if (std::filesystem::path(path).filename() == "case.md") parsed.push_back(parse_case_text(path, text));
    return parsed;
  }();
  const auto at = std::find_if(texts.begin(), texts.end(), [&](const CaseText& t) { return t.name == name; });
  return at == texts.end() ? nullptr : &*at;
}

}  // namespace ropewalk::validate
