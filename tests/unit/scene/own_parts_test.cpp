// Parts of one's own whose names are taken.
#include "scene/own_parts.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "observe/observables.hpp"
#include "scene/drive_kind.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::ExitedWithCode;

TEST(TakenNames, EndTheProgramWithOneLine) {
  EXPECT_EXIT(add_load_kind(load_kinds().front()), ExitedWithCode(2),
              "a load of one's own is called \"" + load_kinds().front().name + "\", and this name is taken");
  EXPECT_EXIT(add_contact_law(*contact_law_kind("line")), ExitedWithCode(2), "a contact law .*\"line\"");
  EXPECT_EXIT(add_scene_kind(scene_kinds().front()), ExitedWithCode(2), "a scene kind .*\"rope\"");
  EXPECT_EXIT(add_drive_kind(drive_kinds().front()), ExitedWithCode(2), "a drive .*\"thermostat\"");
}

TEST(TakenNames, OfOtherTablesAndColumnsAreRefused) {
  DriveKind run = drive_kinds().front();
  run.table = [] { return SceneTable{"run", "as another table", {}, false}; };
  EXPECT_EXIT((add_drive_kind(run), scene_tables()), ExitedWithCode(2), "a table .*\"run\"");
  EXPECT_EXIT(
      {
        add_term_kind({"vdw", "energy of another one"});
        try {
          observables();
        } catch (const std::invalid_argument& e) {
          std::fputs(e.what(), stderr);
          std::_Exit(2);
        }
      },
      ExitedWithCode(2), "a force term has the column vdw_eV, and this name is taken");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
