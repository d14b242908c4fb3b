// The way back to the last good state, and the shorter steps from there on: run/rollback.hpp, sim/dynamics/step_control.hpp.
#include "run/rollback.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "io/files.hpp"
#include "io/log.hpp"
#include "run/begin_run.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;

// What it says of the way back.
struct Ears : RunListener {
  void tell(const std::string& line) override {
    if (line.find("back to") != std::string::npos) said += line + "\n";
  }
  std::string said;
};

// Two parallel tubes fly at one another, and meet after more steps than a window has.
std::string collision() {
  std::string state =
      "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz,vx_nm_per_ps,vy_nm_per_ps,vz_nm_per_ps,wx_rad_per_ps,wy_rad_per_ps,"
      "wz_rad_per_ps\n";
  for (const int tube : {0, 1})
    for (int k = 0; k < 10; ++k)
      state += fmt::format("{},{},0,{},1,0,0,0,{},0,0,0,0,0\n", tube, tube == 0 ? -10 : 10, 1.356 * k,
                           tube == 0 ? 2 : -2);
  return state;
}

TEST(Rollback, ADeviceDividesTheStepsThatTheProcessorDivides) {
  const fs::path dir = fs::temp_directory_path() / fmt::format("ropewalk-way-back-{}", getpid());
  fs::create_directories(dir);
  write_file_atomically((dir / "pair.csv").string(), collision());
  const Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\nelement_length_nm = 1.356\n[state]\n"
      "file = \"pair.csv\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n[run]\n"
      "duration_ps = 30\nlog_every_ps = 1\n",
      (dir / "scene.toml").string());
  std::string said[2];
  std::vector<LogRow> log[2];
  for (const int k : {0, 1}) {
    const RunDirectory to{(dir / std::to_string(k)).string()};
    RunSettings asked;
    asked.device = k == 0 ? "none" : "c++";
    Ears ears;
    go_through(begin_run(scene, to, asked, ears));
    said[k] = ears.said;
    log[k] = read_log(to.log());
  }
  EXPECT_NE(said[0], "");
  EXPECT_EQ(said[1], said[0]);
  ASSERT_EQ(log[1].size(), log[0].size());
  for (std::size_t row = 0; row < log[0].size(); ++row) {
    EXPECT_EQ(log[1][row]["time_step_fs"], log[0][row]["time_step_fs"]) << row;
    EXPECT_NEAR(log[1][row]["kinetic_eV"], log[0][row]["kinetic_eV"], 1e-3 * log[0][row]["kinetic_eV"]) << row;
  }
  fs::remove_all(dir);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
