// The prose of a case: what a file says, and what is wrong with one that cannot be read.
#include "core/case_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "io/files.hpp"
#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* path = "cases/theory/my-question/case.md";
const std::string good =
    "# My question\n\n## Why\n\nA rope\nasks it.\n\n## Set-up\n\nTwo {tube} tubes.\n\nThey rest.\n\n## Oracle\n\n"
    "`F = 0`.\n\n## Literature\n\n- A. Author,\n  Journal 1\n- B. Author, Book\n\n## Remarks\n\n- One.\n- Two\n  lines.\n";

std::string replaced(const std::string& part, const std::string& by) {
  std::string text = good;
  return text.replace(text.find(part), part.size(), by);
}

std::string error_of(const std::string& text) {
  try {
    parse_case_text(path, text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(CaseText, JoinsLinesOfAParagraphAndOfAnItem) {
  const CaseText t = parse_case_text(path, good);
  EXPECT_EQ(t.group + "/" + t.name, "theory/my-question");
  EXPECT_EQ(t.title, "My question");
  EXPECT_EQ(t.why, "A rope asks it.");
  EXPECT_EQ(t.setup, "Two {tube} tubes. They rest.");
  EXPECT_EQ(t.oracle, "`F = 0`.");
  EXPECT_EQ(t.literature, "A. Author, Journal 1; B. Author, Book");
  EXPECT_THAT(t.remarks, ElementsAre("One.", "Two lines."));
}

TEST(CaseText, NeedsAllSectionsButRemarks) {
  EXPECT_EQ(error_of(good.substr(0, good.find("## Remarks"))), "");
  EXPECT_THAT(error_of(replaced("## Oracle\n\n`F = 0`.", "")), HasSubstr("case.md: has no section \"## Oracle\""));
  EXPECT_THAT(error_of(replaced("A rope\nasks it.", "")), HasSubstr("has no section \"## Why\""));
}

TEST(CaseText, NamesTheLineOfWhatItCannotPlace) {
  EXPECT_THAT(error_of("Words\n" + good), HasSubstr("case.md:1: text before the title"));
  EXPECT_THAT(error_of(replaced("## Why", "Words\n\n## Why")), HasSubstr("case.md:1: has no title, or a text"));
  EXPECT_THAT(error_of(replaced("## Remarks", "## Remark")), HasSubstr("case.md:24: ## Remark: is not a section"));
  EXPECT_THAT(error_of(good + "## Why\n\nAgain.\n"), HasSubstr("case.md:29: ## Why: is not a section"));
}

// Without the values that the case writes there.
TEST(CaseScenes, ArePreparedAsTheyAre) {
  namespace fs = std::filesystem;
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(ROPEWALK_SOURCE_DIR "/validate/cases")) {
    if (entry.path().filename() != "scene.toml") continue;
    Scene scene = read_scene(entry.path().string());
    EXPECT_GT(prepare(scene).topology.elements(), 0) << entry.path();
    EXPECT_EQ(case_scene(entry.path().parent_path().filename().string()), read_file(entry.path().string()));
    ++scenes;
  }
  EXPECT_GE(scenes, 7);
  EXPECT_THROW(case_scene("euler-buckling"), std::out_of_range);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
