// docs/outputs.md lists exactly what validate writes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chart/chart.hpp"
#include "outputs_page.hpp"
#include "runner/runner.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

TEST(OutputsPage, HasTheKeysOfTheReport) {
  Outcome o;
  o.result.checks.emplace_back();
  o.result.limits.emplace_back();
  const auto entry = nlohmann::json::parse(validation_json({o})).at("cases").at(0);
  EXPECT_EQ(ropewalk::test::keys_of(entry), ropewalk::test::outputs_names("An entry of `cases`"));
  EXPECT_EQ(ropewalk::test::keys_of(entry.at("checks").at(0)),
            ropewalk::test::outputs_names("An entry of `checks`"));
  EXPECT_EQ(ropewalk::test::keys_of(entry.at("limits").at(0)),
            ropewalk::test::outputs_names("An entry of the `limits` of a case"));
}

TEST(OutputsPage, HasTheTableOfTheChart) {
  EXPECT_EQ(ropewalk::test::outputs_table("`points.csv`"), columns_markdown(points_columns()));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
