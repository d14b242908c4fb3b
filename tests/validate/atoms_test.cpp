// Facts about one and two tubes of atoms beyond the verdicts of their cases, and a missing reference.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "cases/common/tube_curve.hpp"
#include "core/reference.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"
#include "runner/runner.hpp"
#include "validate/support.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

using test::check_of;

TEST(PaperLaw, BindsAboutTwiceAsStronglyAsTheAtoms) {
  const CaseResult result = test::run(find_case("pair-distance"));
  const Check& ratio = check_of(result, "(10,10) paper law: cohesion over that of the atoms");
  EXPECT_TRUE(ratio.informative);
  EXPECT_NEAR(ratio.value, 2.1, 0.15);
}

TEST(MissingReference, IsNotApplicableAndSaysWhatToDo) {
  CaseContext context = test::stored_context();
  const TemporaryFolder folder;
  context.references = folder.file("references");
  context.sets = {test::shipped("cnt-5-5-tersoff")};
  try {
    find_case("tube-bend").run(context);
    FAIL() << "no reference, no error";
  } catch (const NotApplicable& reason) {
    EXPECT_NE(std::string(reason.what()).find("--atoms"), std::string::npos) << reason.what();
  }
}

TEST(TubeCurve, BreaksWhereTheEnergyLeaps) {
  std::vector<double> curvature, energy;
  for (int k = 0; k <= 20; ++k) {
    curvature.push_back(0.02 * k);
    energy.push_back(900 * curvature.back() * curvature.back() * (1 - curvature.back() * curvature.back()));
  }
  EXPECT_EQ(points_before_break(curvature, energy), 21u);
  energy[15] *= 15;  // as where the ends of a specimen meet
  EXPECT_EQ(points_before_break(curvature, energy), 15u);
}

// The stored atoms of (5,5), made wrong from a curvature on that its kink lies beyond.
CaseResult bent_with(const std::function<void(ReferenceTable&)>& change) {
  namespace fs = std::filesystem;
  CaseContext context = test::stored_context();
  context.sets = {test::shipped("cnt-5-5-tersoff")};
  ReferenceTable table = read_reference(context.references + "/cnt-5-5-tersoff/tube-bend.csv");
  change(table);
  const fs::path folder = fs::temp_directory_path() / ("ropewalk-atoms-test-" + std::to_string(::getpid()));
  fs::create_directories(folder / "cnt-5-5-tersoff");
  write_file_atomically((folder / "cnt-5-5-tersoff/tube-bend.csv").string(), reference_csv(table));
  context.references = folder.string();
  const CaseResult result = find_case("tube-bend").run(context);
  fs::remove_all(folder);
  return result;
}

TEST(TubeBend, ABrokenReferenceIsNamedAndMakesNoVerdict) {
  const auto remark_of = [](const CaseResult& r, const std::string& words) {
    for (const std::string& remark : r.remarks)
      if (remark.find(words) != std::string::npos) return remark;
    return std::string();
  };
  const CaseResult broken = bent_with([](ReferenceTable& t) {
    for (std::vector<double>& row : t.rows)
      if (row[0] > 0.28) row[2] *= 15;  // long_eV
  });
  EXPECT_TRUE(broken.holds());
  EXPECT_NE(remark_of(broken, "long specimen of (5,5) is broken from"), "");
  // Wider bands: the long specimen closes on itself at 0.31/nm.
  const CaseResult closed = bent_with([](ReferenceTable& t) {
    t.add("band_nm", "2");
    for (std::vector<double>& row : t.rows)
      if (row[0] > 0.315) row[2] *= 1.03;
  });
  EXPECT_TRUE(closed.holds());
  EXPECT_NE(remark_of(closed, "long specimen of (5,5) closes on itself at 0.3"), "");
  const CaseResult whole = bent_with([](ReferenceTable&) {});
  EXPECT_EQ(remark_of(whole, "are not compared"), "");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
