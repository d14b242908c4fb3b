// io/friction_toml, and [[friction]] from = ... of a scene.
#include "io/friction_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const std::string valid =
    "[meta]\nformat = \"ropewalk-friction-1\"\nname = \"mine\"\nchirality_a = [10, 10]\nchirality_b = [17, "
    "0]\npotential = "
    "\"tersoff\"\n[friction]\n"
    "strength = { value = 40, unit = \"pN/nm\", standard_error = 1, origin = \"calibrated\" }\n"
    "spin_strength = { value = 60, unit = \"pN/nm\", standard_error = 1, origin = \"calibrated\" }\n"
    "end_strength = { value = 5, unit = \"pN\", standard_error = 1, origin = \"calibrated\" }\n"
    "elastic_slip = { value = 0.04, unit = \"nm\", standard_error = 0, origin = \"calibrated\" }\n"
    "drag = { value = 0.02, unit = \"eV ps/nm^3\", standard_error = 0.1, origin = \"calibrated\", note = \"a "
    "bound\" }\n"
    "[register]\nstrength_largest = { value = 50, unit = \"pN/nm\", standard_error = 0, origin = \"derived\" }\n"
    "[provenance]\ncommand = \"by hand\"\n";

std::string message(const std::string& text) {
  try {
    friction_of_text(text, "mine.toml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}
std::string with(const std::string& from, const std::string& to) {
  std::string text = valid;
  return text.replace(text.find(from), from.size(), to);
}

TEST(FrictionToml, IsReadAndWritten) {
  const PairFriction f = friction_of_text(valid, "mine.toml");
  EXPECT_DOUBLE_EQ(f.strength, 40e-3 * units::nN_nm);
  EXPECT_DOUBLE_EQ(f.end_strength, 5e-3 * units::nN_nm);
  EXPECT_EQ(f.quantities.size(), 6u);
  const PairFriction again = friction_of_text(friction_text(f, "# again\n"), "again.toml");
  EXPECT_EQ(friction_text(again, ""), friction_text(f, ""));
  EXPECT_EQ(again.b.n, 17);
}

TEST(FrictionToml, GradeFollowsFromTheErrors) {
  const auto grade = [](const std::string& text) { return grade_of(friction_of_text(text, "mine.toml")); };
  EXPECT_EQ(grade(valid).words(), "good");
  const Grade limited = grade(with("value = 40, unit = \"pN/nm\", standard_error = 1",
                                   "value = 40, unit = \"pN/nm\", standard_error = 10"));
  EXPECT_EQ(limited.level, Grade::Level::limited);
  EXPECT_THAT(limited.words(), HasSubstr("along the axis 40 +- 10 pN/nm"));
  EXPECT_EQ(grade(with("value = 60, unit = \"pN/nm\", standard_error = 1",
                       "value = 60, unit = \"pN/nm\", standard_error = 40"))
                .level,
            Grade::Level::unfit);
  // Next to nothing, known to be next to nothing.
  EXPECT_EQ(grade(with("value = 40, unit = \"pN/nm\", standard_error = 1",
                       "value = 0.1, unit = \"pN/nm\", standard_error = 0.2"))
                .words(),
            "good");
}

TEST(FrictionToml, BadOnesAreRefused) {
  EXPECT_THAT(message(with("ropewalk-friction-1", "ropewalk-friction-2")), HasSubstr("meta.format"));
  EXPECT_THAT(message(with("[17, 0]", "[17]")), HasSubstr("meta.chirality_b"));
  EXPECT_THAT(message(with("value = 40, unit = \"pN/nm\"", "value = 40, unit = \"N/m\"")), HasSubstr("convert"));
  EXPECT_THAT(message(with("elastic_slip", "slip")), HasSubstr("friction.elastic_slip"));
  EXPECT_THAT(message(with("value = 0.04", "value = 0")), HasSubstr("elastic_slip"));
  EXPECT_THAT(message(with("strength_largest", "strength_greatest")), HasSubstr("strength_greatest"));
  EXPECT_EQ(message(valid), "");
}

TEST(FrictionToml, KindsOfPairs) {
  EXPECT_EQ(kind_of_pair({10, 10}, {5, 5}), "armchair");
  EXPECT_EQ(kind_of_pair({17, 0}, {9, 0}), "zigzag");
  EXPECT_EQ(kind_of_pair({12, 6}, {12, 6}), "chiral");
  EXPECT_EQ(kind_of_pair({12, 6}, {6, 3}), "unlike");
  EXPECT_EQ(kind_of_pair({10, 10}, {17, 0}), "unlike");
}

TEST(FrictionToml, ShippedOnesServeTheirTubesAndThoseNearThem) {
  const InputError::Place place{"scene.toml", 1, "friction.from"};
  const PairFriction own = friction_between({17, 0}, {10, 10}, {}, place);
  EXPECT_EQ(kind_of_pair(own.a, own.b), "unlike");
  EXPECT_EQ(own.a.n + own.b.n, 27);
  const PairFriction near = friction_between({12, 12}, {12, 12}, {}, place);
  EXPECT_EQ(near.a.n, 10);
  EXPECT_EQ(near.b.m, 10);
  EXPECT_GT(near.strength, 20 * own.strength) << "like tubes hold each other, unlike ones slide";
}

// A user's own file serves its pair before a shipped one, and is found by its name.
TEST(FrictionToml, OwnFilesStandBesideTheScene) {
  const fs::path folder = fs::temp_directory_path() / ("ropewalk-friction-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const InputError::Place place{"scene.toml", 1, "friction.from"};
  write_file_atomically((folder / "friction-mine.toml").string(),
                        with("name = \"mine\"", "name = \"friction-mine\""));
  const std::vector<std::string> folders = {folder.string()};
  EXPECT_EQ(friction_between({10, 10}, {17, 0}, folders, place).name, "friction-mine");
  EXPECT_EQ(friction_between({10, 10}, {10, 10}, folders, place).name, "friction-10-10-10-10-tersoff");
  EXPECT_EQ(find_friction("friction-mine", folders, place).name, "friction-mine");
  EXPECT_EQ(find_friction("friction-mine.toml", folders, place).name, "friction-mine");
  // A stranger's file is passed over, and one of ours that is damaged is refused by its name.
  const std::string strange = (folder / "friction-factors.toml").string();
  write_file_atomically(strange, "steel_on_ice = 0.03\n");
  EXPECT_EQ(friction_between({10, 10}, {17, 0}, folders, place).name, "friction-mine");
  EXPECT_THAT(strange_friction_files(folders), ::testing::ElementsAre(strange));
  EXPECT_THROW(find_friction("friction-factors.toml", folders, place), InputError) << "named";
  for (const std::string& damage : {with("[17, 0]", "[17"), with("ropewalk-friction-1", "ropewalk-friction-0")}) {
    write_file_atomically(strange, damage);
    try {
      friction_between({10, 10}, {17, 0}, folders, place);
      ADD_FAILURE() << "a damaged file was read";
    } catch (const InputError& e) {
      EXPECT_EQ(e.place().file, strange);
    }
  }
  fs::remove(strange);
  // As in the directory of a run.
  fs::rename(folder / "friction-mine.toml", folder / "friction-0.toml");
  EXPECT_EQ(find_friction("elsewhere/friction-mine.toml", folders, place).name, "friction-mine");
  fs::rename(folder / "friction-0.toml", folder / "other.toml");
  EXPECT_THROW(find_friction("other.toml", folders, place), InputError) << "two names";
  fs::remove_all(folder);
}

TEST(FrictionToml, AScenesFrictionComesFromAtomsAndSaysWhatIsAnEstimate) {
  const auto words = [](const std::string& friction) {
    const Scene scene = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = [\"cnt-12-12-tersoff\", \"cnt-17-0-tersoff\"]\ntube_types = "
        "[1, 0, 0, 0, "
        "0, 0, 0]\n[rope]\ntubes = 7\nlength_nm = 13.8\n[[friction]]\n" +
            friction + "[run]\nduration_ps = 1\n",
        "atoms.toml");
    std::string text;
    for (const auto& drive : scene.drives) text += drive->words();
    return text;
  };
  const std::string all = words("from = \"atoms\"\n");
  EXPECT_THAT(all, HasSubstr("between types 0 and 0"));
  EXPECT_THAT(all, HasSubstr("between types 0 and 1"));
  EXPECT_THAT(all, HasSubstr("an estimate: (12,12) beside (12,12) was not measured"));
  EXPECT_THAT(all, HasSubstr("of atoms (friction-17-0-17-0-tersoff, good)"));
  EXPECT_THAT(words("from = \"atoms\"\ntypes = [1, 1]\n"), ::testing::Not(HasSubstr("types 0")));
  const std::string two = words("from = \"atoms\"\n[[friction]]\nstrength_pN_per_nm = 7\ntypes = [1, 0]\n");
  EXPECT_THAT(two, HasSubstr("between types 1 and 0, dry: 7 pN/nm"));
  EXPECT_THAT(two, ::testing::Not(HasSubstr("between types 0 and 1")));
  EXPECT_THAT(two, HasSubstr("between types 1 and 1"));
  const auto refused = [&](const std::string& friction) -> std::string {
    try {
      words(friction);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(refused("from = \"atom\"\n"), HasSubstr("friction.from"));
  EXPECT_THAT(refused("from = \"atoms\"\ntypes = [0, 5]\n"), HasSubstr("there is no tube type 5"));
  EXPECT_THAT(refused("from = \"atoms\"\nend_strength_pN = 3\n"), HasSubstr("friction.end_strength_pN"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
