// docs/outputs.md lists exactly what the tables in the code have.
#include "io/outputs.hpp"

#include <gtest/gtest.h>

#include "campaign/static_rest.hpp"
#include "campaign/static_threshold.hpp"
#include "campaign/threshold.hpp"
#include "io/equilibria.hpp"
#include "io/frames/dump.hpp"
#include "io/frames/gsd.hpp"
#include "io/frames/vtp.hpp"
#include "io/limits_file.hpp"
#include "io/manifest.hpp"
#include "io/mode_table.hpp"
#include "io/tube_table.hpp"
#include "observe/observables.hpp"
#include "outputs_page.hpp"
#include "report/tensile.hpp"
#include "report/torsion.hpp"
#include "run/events_file.hpp"
#include "run/run_directory.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::outputs_table;

TEST(OutputsPage, HasTheTablesOfTheCode) {
  EXPECT_EQ(outputs_table("The directory of a run"), run_files_markdown());
  EXPECT_EQ(outputs_table("`log.csv`"), observables_markdown());
  EXPECT_EQ(outputs_table("`observe --tubes`"), columns_markdown(tube_columns()));
  EXPECT_EQ(outputs_table("`frames.lammpstrj`"), columns_markdown(frame_columns()));
  EXPECT_EQ(outputs_table("`frames.gsd`"), columns_markdown(gsd_chunks()));
  EXPECT_EQ(outputs_table("`rope/frame-*.vtp`"), columns_markdown(vtp_arrays()));
  EXPECT_EQ(outputs_table("`state.csv`, `final.csv` and `failed-state.csv`"), columns_markdown(state_columns()));
  EXPECT_EQ(outputs_table("`manifest.json`"), columns_markdown(manifest_keys()));
  EXPECT_EQ(outputs_table("`equilibria.csv`"), columns_markdown(equilibria_columns()));
  EXPECT_EQ(outputs_table("`events.csv`"), columns_markdown(event_columns()));
  EXPECT_EQ(outputs_table("`ropewalk compare --tensile --csv`"), columns_markdown(tensile_kind().columns));
  EXPECT_EQ(outputs_table("`ropewalk compare --torsion --csv`"), columns_markdown(torsion_kind().columns));
  EXPECT_EQ(outputs_table("Limits in tables of runs"), columns_markdown(limit_columns()));
  EXPECT_EQ(outputs_table("Results in tables of runs"), columns_markdown(result_columns()));
  EXPECT_EQ(outputs_table("`ropewalk modes --csv`"), columns_markdown(mode_columns()));
  EXPECT_EQ(outputs_table("`static-rest.csv`"), columns_markdown(static_rest_columns()));
  EXPECT_EQ(outputs_table("`NAME-static.csv`"), columns_markdown(static_threshold_columns()));
  EXPECT_EQ(outputs_table("`trials.csv`"), columns_markdown(trial_columns()));
  EXPECT_EQ(outputs_table("An entry of `limits`"), columns_markdown(limit_keys()));
  EXPECT_EQ(outputs_table("An entry of `refinements`"), columns_markdown(refinement_keys()));
  EXPECT_EQ(outputs_table("`energy_before_eV` and `energy_after_eV`"), columns_markdown(energy_keys()));
  EXPECT_EQ(outputs_table("`lammps.json`"), columns_markdown(lammps_start_keys()));
  EXPECT_EQ(outputs_table("`tubes.csv`"), columns_markdown(lammps_tube_columns()));
  EXPECT_EQ(outputs_table("`lammps-rows.csv`"), columns_markdown(lammps_row_columns()));
  EXPECT_EQ(outputs_table("`rope.state` and `lammps.states`"), columns_markdown(lammps_state_columns()));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
