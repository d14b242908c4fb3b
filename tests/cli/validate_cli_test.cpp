// `ropewalk validate` as a user meets it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "cli/support.hpp"
#include "io/parameters_toml.hpp"
#include "outputs_page.hpp"

namespace {
namespace UNIT {

using ropewalk::test::Outcome;
using ropewalk::test::slurp;
using ropewalk::test::spit;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class Validate : public ropewalk::test::Cli {};

TEST_F(Validate, ListDescribesEveryCase) {
  const Outcome o = run("validate list --json");
  ASSERT_EQ(o.code, 0) << o.err;
  const Json all = Json::parse(o.out);
  ASSERT_GE(all.size(), 5u);
  for (const Json& c : all)
    for (const char* key : {"name", "tier", "against", "title", "why", "setup", "oracle"})
      EXPECT_FALSE(c.at(key).get<std::string>().empty()) << c;
  const Outcome table = run("validate list");
  EXPECT_EQ(static_cast<std::size_t>(std::count(table.out.begin(), table.out.end(), '\n')), all.size());
  const Outcome full = run("validate list", "sh -c '\"$0\" \"$@\" > /dev/full'");
  EXPECT_EQ(full.code, 2);
  EXPECT_NE(full.err.find("the standard output cannot be written"), std::string::npos) << full.err;
}

TEST_F(Validate, WrongInputGetsOneLine) {
  spit(dir / "file", "");
  for (const auto& [line, words] :
       {std::pair{"validate", "subcommand"},
        std::pair{"validate run no-such-case", "there is no case"},
        std::pair{"validate run euler-bucklin", "did you mean \"euler-buckling\"?"},
        std::pair{"validate chrt", "there is no verb \"chrt\"; did you mean chart?"},
        std::pair{"validate run --tier medium", "choose quick or full"},
        std::pair{"validate run euler-buckling --out file", "not a directory"},
        std::pair{"validate run euler-buckling --parameters nowhere", "no parameter set"},
        std::pair{"validate run --atoms", "add --parameters SET"},
        std::pair{"validate run --with cnt-5-5-tersoff", "add --parameters SET"},
        std::pair{"validate run --parameters cnt-5-5-tersoff --budget 3", "add --atoms"},
        std::pair{"validate report nowhere", "holds no results"},
        std::pair{"parametrize", "tubes is required"},
        std::pair{"parametrize 7,3 7-4", "is \"7-4\""},
        std::pair{"parametrize 7,3 --potential tersof", "did you mean"},
        std::pair{"parametrize 7,3 --out file", "not a directory"},
        std::pair{"validate chart --scenes no-such-scene", "there is no scene"},
        std::pair{"validate chart --scenes tube-twist,rope7-m", "did you mean \"rope7-md\"?"},
        std::pair{"validate chart --quick --out file", "not a directory"},
        std::pair{"validate chart --from file", "is not a table of points of this chart"},
         std::pair{"validate chart --from nowhere.csv", "nowhere.csv"},
         std::pair{"validate chart --from file --scenes ring", "--scenes"},
         std::pair{"validate chart --scene", "--scene"},
        std::pair{"validate chart --scenes", "--scenes"}}) {
    const Outcome o = run(line);
    EXPECT_EQ(o.code, 2) << line;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << line << "\n" << o.err;
    EXPECT_NE(o.err.find(words), std::string::npos) << line << "\n" << o.err;
  }
}

TEST_F(Validate, OneCaseIsRunKeptAndReported) {
  const Outcome o = run("validate run euler-buckling --out v");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("holds"), std::string::npos);
  const std::string page = slurp(dir / "v/report.html");
  EXPECT_NE(page.find("1 of 1 cases hold"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  const Json report = Json::parse(slurp(dir / "v/report.json"));
  EXPECT_EQ(report.at("cases").at(0).at("verdict"), "holds");

  using ropewalk::test::keys_of;
  using ropewalk::test::outputs_names;
  for (const auto& entry : fs::directory_iterator(dir / "v")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(outputs_names("`ropewalk validate`").count(name == "euler-buckling.json" ? "CASE.json" : name))
        << name;
  }
  const Json entry = report.at("cases").at(0);
  std::set<std::string> keys = outputs_names("An entry of `cases`");
  EXPECT_EQ(keys_of(entry), keys);
  EXPECT_EQ(keys_of(entry.at("checks").at(0)), outputs_names("An entry of `checks`"));
  keys.insert({"format", "figures"});
  EXPECT_EQ(keys_of(Json::parse(slurp(dir / "v/euler-buckling.json"))), keys);

  const Outcome again = run("validate run euler-buckling --out v --json");
  ASSERT_EQ(again.code, 0);
  EXPECT_NE(again.err.find("kept"), std::string::npos) << again.err;
  EXPECT_EQ(Json::parse(again.out).at("cases").at(0).at("checks"), report.at("cases").at(0).at("checks"));
  EXPECT_EQ(run("validate report v").code, 0);
  EXPECT_EQ(slurp(dir / "v/report.html"), page) << "the page is the same in every run";
}

// Theory of chains, and the reasons of all that a set without the line law and without a potential cannot show.
TEST_F(Validate, APublishedSetIsHeldToTheory) {
  const Outcome o = run("validate run --tier quick --parameters cnt-10-10-paper --quiet --out v");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  const Json report = Json::parse(slurp(dir / "v/report.json"));
  int holds = 0;
  for (const Json& c : report.at("cases")) {
    for (const Json& set : c.at("sets")) EXPECT_EQ(set.at("name"), "cnt-10-10-paper") << c.at("case");
    const std::string verdict = c.at("verdict");
    EXPECT_TRUE(verdict == "holds" || verdict == "not applicable") << c;
    EXPECT_EQ(verdict == "not applicable", !c.at("not_applicable").get<std::string>().empty());
    if (c.at("case") == "stretch-and-cantilever") {
      EXPECT_NEAR(c.at("checks").at(0).at("value").get<double>(), 9175, 10) << "its own EA, in eV/nm";
    }
    holds += verdict == "holds";
  }
  EXPECT_GE(holds, 6);
}

// A set that is there is kept, stored references of its tube and potential are used, and those that fit into the
// budget are made with LAMMPS.
TEST_F(Validate, ParametrizeGoesOnWithWhatIsThere) {
  fs::create_directories(dir / "p");
  for (const char* file : {".toml", "-stiffness.csv", "-contact.csv"})
    fs::copy(std::string(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-5-5-tersoff") + file, dir / "p");
  // Its friction belongs to this very set, whichever one it was shipped with.
  const std::string own =
      "hash       = \"" + ropewalk::read_parameters((dir / "p/cnt-5-5-tersoff.toml").string()).hash + "\"";
  spit(dir / "p/friction-5-5-5-5-tersoff.toml",
       std::regex_replace(slurp(ROPEWALK_SOURCE_DIR "/data/friction/friction-5-5-5-5-tersoff.toml"),
                          std::regex("(set_[ab]_)hash +=[^\n]*"), "$1" + own));
  const Outcome o = run("parametrize 5,5 --tier quick --out p --budget 0.1");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.err.find("set kept"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("friction-5-5-5-5-tersoff: kept"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("3/3 validation of 1 set\n"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("  cnt-5-5-tersoff ended: 1 of 1, "), std::string::npos) << o.err;
  EXPECT_TRUE(fs::exists(dir / "p/cnt-5-5-tersoff-atoms/pair-sliding.csv"));
  EXPECT_FALSE(fs::exists(dir / "p/cnt-5-5-tersoff-atoms/crossed-tubes.csv"));
  const std::string page = slurp(dir / "p/report.html");
  EXPECT_NE(page.find("What the set is for"), std::string::npos);
  EXPECT_NE(page.find("(5,5) beside (5,5)"), std::string::npos);
  EXPECT_NE(page.find("--budget 0.1"), std::string::npos);
  EXPECT_NE(page.find("Quick cases alone (--tier quick)"), std::string::npos);
  const std::string table = slurp(dir / "p/tubes.csv");
  EXPECT_NE(table.find("cnt-5-5-tersoff,5,5,tersoff,30.0000,"), std::string::npos) << table;
  EXPECT_NE(table.find(",holds quick,"), std::string::npos) << table;
}

// Counting leaves earlier measurements unchanged.
TEST_F(Validate, ChartCountsInstructions) {
  const std::string chart = "validate chart --quick --quiet --scenes tube-twist --out c";
  const auto point = [&](const std::string& model) {
    return Json::parse(slurp(dir / "c" / "points" / ("tube-twist--" + model + ".json")));
  };
  ASSERT_EQ(run(chart).code, 0);
  const Json before = point("default");
  EXPECT_TRUE(before.at("instructions_per_element_step").is_null());
  ASSERT_EQ(run(chart + " --instructions").code, 0);
  const Json ours = point("default"), published = point("published");
  EXPECT_EQ(ours.at("cpu_s"), before.at("cpu_s"));
  const double count = ours.at("instructions_per_element_step");
  EXPECT_GT(count, 50);
  EXPECT_LT(count, 5000);
  // Both are the same step of a lone tube.
  EXPECT_NEAR(published.at("instructions_per_element_step").get<double>(), count, 0.3 * count);
  EXPECT_NE(slurp(dir / "c" / "chart.html").find("instructions per ns"), std::string::npos);
}

}  // namespace UNIT
}  // namespace
