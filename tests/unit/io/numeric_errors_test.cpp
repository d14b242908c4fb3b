// The whole error of a result from repeated runs.
#include "io/numeric_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/files.hpp"
#include "io/removal.hpp"
#include "observe/time_mean.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Course = std::function<double(double)>;

std::vector<LogRow> log_of(int rows, double apart, const Course& torque) {
  std::vector<LogRow> log(static_cast<std::size_t>(rows));
  for (int k = 0; k < rows; ++k) {
    LogRow& row = log[static_cast<std::size_t>(k)];
    row["step"] = k;
    row["time_ps"] = k * apart;
    row["torque_upper_nN_nm"] = torque(k * apart);
  }
  return log;
}

double torque(const LogRow& row) { return row["torque_upper_nN_nm"]; }

class Repeated {
 public:
  void add(const std::string& name, const std::vector<LogRow>& log) {
    const std::string directory = folder_.path() + "/errors/" + name;
    std::filesystem::create_directories(directory);
    std::string text = log_header();
    if (text.back() != '\n') text += '\n';
    for (const LogRow& row : log) {
      text += log_line(row);
      if (text.back() != '\n') text += '\n';
    }
    write_file_atomically(directory + "/log.csv", text);
  }
  NumericErrors of(NumericRuns runs, const std::vector<LogRow>& log) const {
    return {folder_.path() + "/errors", std::move(runs), RunErrors(), log};
  }
  std::string path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

// f = 10 + c h^p of a setting h = 1: from h and h/2 the error c of the run follows exactly.
TEST(NumericErrors, AreThoseOfTheOrder) {
  for (const double p : {1.0, 2.0}) {
    Repeated runs;
    runs.add("half-step", log_of(9, 1, [&](double) { return 10 + 3 * std::pow(0.5, p); }));
    NumericRuns what;
    what.sources = {{"time step", "half-step", 1 / (1 - std::pow(0.5, p)), 1, "", ""}};
    const WholeError e = runs.of(what, log_of(9, 1, [](double) { return 13; })).at_end(torque);
    EXPECT_NEAR(e.numerics, 3, 1e-12);
    EXPECT_EQ(e.decides, "time step");
    EXPECT_FALSE(e.bound);
  }
}

// A run of half the rate has its rows at twice the times, and other runs at times of their own.
TEST(NumericErrors, CompareRowsOfTheSameMoment) {
  Repeated runs;
  runs.add("half-rate", log_of(21, 1, [](double t) { return t; }));
  runs.add("half-step", log_of(41, 0.25, [](double t) { return 2 * t + 0.5; }));
  NumericRuns what;
  what.sources = {{"rate", "half-rate", 2, 2, "", ""}, {"time step", "half-step", 1, 1, "", ""}};
  const std::vector<LogRow> log = log_of(11, 1, [](double t) { return 2 * t; });
  const NumericErrors errors = runs.of(what, log);
  for (const std::size_t k : {0, 3, 10}) {
    const WholeError e = errors.of(k, torque);
    EXPECT_NEAR(e.parts.at(0), 0, 1e-12) << k;
    EXPECT_NEAR(e.parts.at(1), 0.5, 1e-12) << k;
  }
}

// Four runs of one value; what a refined run differs by within their scatter is a bound, and does not decide.
TEST(NumericErrors, TellScatterFromNumerics) {
  Repeated runs;
  int k = 0;
  for (const double value : {11.0, 9.0, 12.0})
    runs.add("start-" + std::to_string(++k), log_of(5, 1, [=](double) { return value; }));
  NumericRuns what;
  what.starts = {"start-1", "start-2", "start-3"};
  what.sources = {{"elements", "half-elements", 1, 1, "", ""}};
  const std::vector<LogRow> log = log_of(5, 1, [](double) { return 8; });
  runs.add("half-elements", log_of(5, 1, [](double) { return 12; }));
  WholeError e = runs.of(what, log).at_end(torque);
  EXPECT_NEAR(e.statistics, std::sqrt((1 + 1 + 4 + 4) / 3.0), 1e-12);
  EXPECT_EQ(e.numerics, 4);
  EXPECT_TRUE(e.bound);
  EXPECT_EQ(e.decides, "statistics");
  EXPECT_NEAR(e.total(), std::hypot(e.statistics, 4), 1e-12);
  runs.add("half-elements", log_of(5, 1, [](double) { return 20; }));
  e = runs.of(what, log).at_end(torque);
  EXPECT_FALSE(e.bound);
  EXPECT_EQ(e.decides, "elements");
}

TEST(NumericErrors, OfAMeanAreBlocksAndScatter) {
  Repeated runs;
  const Course swings = [](double t) { return 5 + std::sin(77.7 * t * t); };
  runs.add("start-1", log_of(400, 0.5, swings));
  NumericRuns what;
  what.starts = {"start-1"};
  what.mean_ps = 99.5;
  const std::vector<LogRow> log = log_of(400, 0.5, swings);
  const WholeError e = runs.of(what, log).at_end(torque);
  std::vector<double> last;
  for (std::size_t k = 200; k < 400; ++k) last.push_back(torque(log[k]));
  const TimeMean mean = time_mean(last);
  EXPECT_EQ(e.value, mean.mean);
  EXPECT_EQ(e.statistics, mean.error);
  EXPECT_NEAR(e.correlation_ps, 0.5 * mean.rows, 1e-12);
  what.mean_ps = 3;
  const WholeError few = runs.of(what, log).at_end(torque);
  EXPECT_GT(few.needed_ps, 3);
  EXPECT_EQ(few.statistics, 0) << "the other start is the same run";
}

// What came of a run: no rows are compared, a time is twice as long at half the rate, and what one run lacks is not
// known.
TEST(NumericErrors, OfAResultCompareRunsAsTheyAre) {
  Repeated runs;
  for (const char* name : {"half-rate", "start-1"}) runs.add(name, log_of(3, 1, [](double t) { return t; }));
  NumericRuns what;
  what.sources = {{"rate", "half-rate", 2, 2, "", ""}};
  what.starts = {"start-1"};
  const NumericErrors errors = runs.of(what, log_of(3, 1, [](double t) { return t; }));
  const auto results = [](double own, double slower, double other) {
    return [=](const std::string& folder) { return folder.empty() ? own : folder == "start-1" ? other : slower; };
  };
  const WholeError torque = errors.of_runs(results(100, 130, 102), false);
  EXPECT_EQ(torque.value, 100);
  EXPECT_NEAR(torque.numerics, 60, 1e-12);
  EXPECT_NEAR(torque.statistics, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(torque.decides, "rate");
  EXPECT_NEAR(errors.of_runs(results(10, 22, 10), true).numerics, 2 * 1, 1e-12) << "11 ps of its own time";
  const WholeError lacking = errors.of_runs(results(10, std::nan(""), 10), false);
  EXPECT_EQ(lacking.without, 1);
  EXPECT_TRUE(std::isnan(lacking.total()));
}

TEST(NumericErrors, AreReadAsTheyWereWritten) {
  Repeated runs;
  runs.add("half-rate", log_of(9, 2, [](double t) { return 3 + t; }));
  NumericRuns what;
  what.sources = {{"rate", "half-rate", 2, 2, "slower", "slower still"}};
  what.remarks = {"elements: why"};
  const std::vector<LogRow> log = log_of(9, 1, [](double t) { return t; });
  const std::string text = numeric_errors_json(runs.of(what, log), log, {});
  write_file_atomically(runs.path() + "/errors/numerics.json", text);
  EXPECT_EQ(numeric_errors_json(read_numeric_errors(runs.path(), log), log, {}), text);
  const std::vector<LogRow> rows = rows_of_errors(runs.path(), log);
  EXPECT_NEAR(rows.at(4)["torque_upper_nN_nm"], 2 * (3 + 8 - 4), 1e-12);
  EXPECT_EQ(rows.at(4)["time_ps"], 4);
  std::string elsewhere = text;
  elsewhere.replace(elsewhere.find("half-rate"), 9, "../secret");
  write_file_atomically(runs.path() + "/errors/numerics.json", elsewhere);
  EXPECT_THROW(read_numeric_errors(runs.path(), log), InputError);
  write_file_atomically(runs.path() + "/errors/numerics.json", "{}");
  EXPECT_THROW(read_numeric_errors(runs.path(), log), InputError);
  EXPECT_TRUE(rows_of_errors(runs.path() + "/none", log).empty());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
