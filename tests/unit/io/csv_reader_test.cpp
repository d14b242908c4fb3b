#include "io/csv_reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using testing::ElementsAre;
using testing::HasSubstr;

class Csv : public testing::Test {
 protected:
  std::string put(const std::string& text) {
    write_file_atomically(path_, text);
    return path_;
  }
  std::string error(const std::string& text) {
    try {
      CsvReader csv(put(text));
      while (csv.next()) csv.number(0, "x");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  void TearDown() override { std::filesystem::remove(path_); }

  const std::string path_ =
      (std::filesystem::temp_directory_path() / fmt::format("csv-{}.csv", ::getpid())).string();
};

TEST_F(Csv, ReadsWhatOtherProgramsWrite) {
  CsvReader csv(put("\xef\xbb\xbf# one: 1\n\n#two\r\nname , x\r\n\"a, \"\"b\"\"\" ,\t+2e3\n,nan"));
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.comments(), ElementsAre("one: 1", "two"));
  EXPECT_THAT(csv.cells(), ElementsAre("name", "x"));
  ASSERT_TRUE(csv.next());
  EXPECT_TRUE(csv.comments().empty());
  EXPECT_THAT(csv.cells(), ElementsAre("a, \"b\"", "+2e3"));
  EXPECT_EQ(csv.number(1, "x"), 2000);
  ASSERT_TRUE(csv.next());
  EXPECT_THAT(csv.cells(), ElementsAre("", "nan"));
  EXPECT_TRUE(std::isnan(csv.number(1, "x")));
  EXPECT_THROW(csv.finite_number(1, "x"), InputError);
  EXPECT_FALSE(csv.next());
}

TEST_F(Csv, ALineThatIsStillWrittenIsNotRead) {
  CsvReader csv(put("1,2\n3,4"), CsvReader::LastLine::may_be_cut_off);
  ASSERT_TRUE(csv.next());
  EXPECT_FALSE(csv.next());
}

TEST_F(Csv, ACellIsReadAsItWasWritten) {
  for (const std::string text : {"plain", "a,b", "\"", "a \"b\", c", "#x"}) {
    CsvReader csv(put("0," + csv_cell(text) + ",1\n"));
    ASSERT_TRUE(csv.next());
    EXPECT_THAT(csv.cells(), ElementsAre("0", text, "1"));
  }
}

TEST_F(Csv, ErrorsNameTheLine) {
  EXPECT_THAT(error("1\n\nx\n"), HasSubstr(".csv:3: x: \"x\" is not a number; write a number"));
  EXPECT_THAT(error("\n"), "");
  EXPECT_THAT(error("1,\"a\n"), HasSubstr(":1: holds a quote that does not end"));
  EXPECT_THAT(error("1,\"a\"b,2\n"), HasSubstr("text behind a quote"));
  EXPECT_THAT(error(std::string("1,\0\n", 4)), HasSubstr("control character"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
