// docs/outputs.md lists exactly the columns that calibrate writes.
#include <gtest/gtest.h>

#include "atomistic/stiffness.hpp"
#include "outputs_page.hpp"
#include "verbs/tables.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

TEST(OutputsPage, HasTheTablesOfCalibrate) {
  EXPECT_EQ(test::outputs_table("`NAME-stiffness.csv`"), columns_markdown(atomistic_columns()));
  EXPECT_EQ(test::outputs_table("`NAME-contact.csv`"), columns_markdown(contact_columns()));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
