// The step that follows the motion: collisions that a whole step does not survive.
#include <fmt/format.h>

#include <cmath>

#include "cli/support.hpp"
#include "io/log.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

class FollowingStep : public Cli {
 protected:
  // Two parallel tubes that fly at one another, each with this speed (nm/ps). Nothing takes energy out.
  void collision(double speed, const std::string& more = "") const {
    std::string state =
        "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz,vx_nm_per_ps,vy_nm_per_ps,vz_nm_per_ps,wx_rad_per_ps,wy_rad_per_ps,"
        "wz_rad_per_ps\n";
    for (const int tube : {0, 1})
      for (int k = 0; k < 10; ++k)
        state += fmt::format("{},{},0,{},1,0,0,0,{},0,0,0,0,0\n", tube, tube == 0 ? -1.5 : 1.5, 1.356 * k,
                             tube == 0 ? speed : -speed);
    spit(dir / "pair.csv", state);
    spit(dir / "s.toml",
         "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\nelement_length_nm = 1.356\n"
         "[state]\nfile = \"pair.csv\"\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"
         "[run]\nduration_ps = 60\nlog_every_ps = 1\n" +
             more);
  }

  std::vector<double> column(const std::string& run, const std::string& name) const {
    std::vector<double> values;
    for (const LogRow& row : read_log((dir / run / "log.csv").string())) values.push_back(row[name]);
    return values;
  }
};

TEST_F(FollowingStep, CollisionKeepsItsEnergyAndTimes) {
  for (const double speed : {2.0, 4.0}) {
    SCOPED_TRACE(speed);
    collision(speed);
    const Outcome o = run("run s.toml --out d --force --quiet");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("back to 0 ps, on with steps of"), std::string::npos) << o.err;
    const std::vector<double> kinetic = column("d", "kinetic_eV"), step = column("d", "time_step_fs"),
                              time = column("d", "time_ps");
    EXPECT_NEAR(kinetic.back(), kinetic.front(), 0.02 * kinetic.front());
    EXPECT_GE(step.back(), 1.99 * step[1]) << "steps are whole again once the tubes have parted";
    ASSERT_EQ(time.size(), 61u) << "no row twice";
    for (std::size_t k = 1; k < time.size(); ++k) EXPECT_GT(time[k], time[k - 1]);
  }
}

TEST_F(FollowingStep, IsTheSameOnOtherThreadsAndAfterAResume) {
  collision(4, "checkpoint_every_s = 1000\n");
  ASSERT_EQ(run("run s.toml --out whole --quiet --threads 1").code, 0);
  ASSERT_EQ(run("run s.toml --out threads --quiet --threads 2").code, 0);
  EXPECT_EQ(slurp(dir / "whole" / "log.csv"), slurp(dir / "threads" / "log.csv"));
  // Before, in the middle of and after the windows that are run again.
  for (const int at : {3, 6, 100, 128, 150, 300}) {
    SCOPED_TRACE(at);
    // 7: it stands within a window that the whole run goes through again, with the tubes far inside of one another.
    const int code = run(fmt::format("run s.toml --out part --force --quiet --steps {}", at)).code;
    ASSERT_TRUE(code == 0 || code == 7) << code;
    ASSERT_EQ(run("resume part --quiet").code, 0);
    for (const char* file : {"final.csv", "log.csv", "limits.json"})
      EXPECT_EQ(slurp(dir / "whole" / file), slurp(dir / "part" / file)) << file;
  }
}

TEST_F(FollowingStep, EndsWhereNoStepHelps) {
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
       "[twist]\napplication = \"tangential\"\nmoment_nN_nm = 20000\nrate_nN_nm_per_ps = 50000\nhold_ps = 2\n");
  const Outcome o = run("run s.toml --out d");
  EXPECT_EQ(o.code, 3);
  EXPECT_TRUE(fs::exists(dir / "d" / "failed-state.csv"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
