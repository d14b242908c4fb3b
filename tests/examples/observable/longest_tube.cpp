// Worked example of docs/how-to/observable.md: a column with the end-to-end length of the longest tube.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/support.hpp"
#include "commands/program.hpp"
#include "io/log.hpp"
#include "observe/observables.hpp"

namespace ropewalk {
namespace {

// Distance between the two ends of the tube, nm; elements are rigid and reach half their length to either side.
double end_to_end(const Topology& topology, const State& state, int tube) {
  const int first = topology.tube_begin[tube], last = topology.tube_begin[tube + 1] - 1;
  const double half = 0.5 * topology.type_of(tube).element_length;
  const Vector3 begin = state.position[first] - half * axis_of(state.orientation[first]);
  const Vector3 end = state.position[last] + half * axis_of(state.orientation[last]);
  return (end - begin).norm();
}

double longest_tube(const Measurement& m) {
  double longest = 0;
  for (int t = 0; t < m.topology.tubes(); ++t) longest = std::max(longest, end_to_end(m.topology, m.state, t));
  return longest;
}

const Observable longest_tube_entry{"longest_tube_nm", "nm", "end-to-end length of the longest tube",
                                    ObservableGroup::shape, longest_tube};

using ObservableExample = test::Cli;

TEST_F(ObservableExample, IsInTheLogTheJsonTheReportAndTheTable) {
  add_observable(longest_tube_entry);
  test::spit(dir / "s.toml",
             "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\n"
             "length_nm = 14\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 5\nhold_ps = 1\n");
  const auto ropewalk = [](std::vector<std::string> words) {
    words.insert(words.begin(), "ropewalk");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return ropewalk_main(static_cast<int>(words.size()), argv.data());
  };
  ASSERT_EQ(ropewalk({"run", dir / "s.toml", "--out", dir / "d", "--threads", "1", "--quiet"}), 0);

  const std::vector<LogRow> log = read_log(dir / "d/log.csv");
  const double straight = 10 * 1.3775870846515064;  // ten elements
  EXPECT_NEAR(log.front()["longest_tube_nm"], straight, 1e-9);
  EXPECT_NE(log.back()["longest_tube_nm"], log.front()["longest_tube_nm"]);
  EXPECT_NEAR(log.back()["longest_tube_nm"], straight, 0.1 * straight);

  testing::internal::CaptureStdout();
  ASSERT_EQ(ropewalk({"observe", dir / "d", "--json"}), 0);
  const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_NEAR(json.back().at("longest_tube_nm"), log.back()["longest_tube_nm"], 1e-4);

  testing::internal::CaptureStdout();
  ASSERT_EQ(ropewalk({"observe", dir / "d"}), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), testing::HasSubstr("longest"));

  EXPECT_THAT(test::slurp(dir / "d/report.html"), testing::HasSubstr("<th>longest_tube_nm</th><td>nm</td>"));
  EXPECT_THAT(observables_markdown(), testing::HasSubstr("| `longest_tube_nm` | nm | end-to-end length of the"));
}

// Every line of code on the page is one of this file.
TEST(ObservableHowTo, ShowsThisCode) {
  const std::string source = test::slurp(ROPEWALK_SOURCE_DIR "/tests/examples/observable/longest_tube.cpp");
  std::istringstream page(test::slurp(ROPEWALK_SOURCE_DIR "/docs/how-to/observable.md"));
  bool code = false;
  int lines = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) {
      code = line == "```cpp";
    } else if (code && ++lines > 0) {
      EXPECT_NE(source.find(line + "\n"), std::string::npos) << line;
    }
  }
  EXPECT_GT(lines, 5);
}

}  // namespace
}  // namespace ropewalk
