// `import` killed at any of its calls that change files: the same command goes on.
#include "lammps/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

class Faults : public Lammps {
 protected:
  Outcome import_with(const std::string& fault) const {
    return run("import d", "env LD_PRELOAD='" ROPEWALK_FAULTS "' GOMP_SPINCOUNT=0 ROPEWALK_FAULTS_BELOW='" +
                               (dir / "d").string() + "' ROPEWALK_FAULT=" + fault + " ROPEWALK_FAULTS_COUNT='" +
                               (dir / "count").string() + "'");
  }
};

TEST_F(Faults, ImportKilledAtAnyCall) {
  spit(dir / "scene.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 5\n[start]\n"
       "temperature_K = 300\nmay_cool = true\n[run]\nduration_ps = 1\ntime_step_fs = 10\n");
  ASSERT_EQ(run("export scene.toml --lammps out").code, 0) << slurp(dir / "stderr.txt");
  const Outcome o = lmp(1, "out", "-in in.rope -var steps 30 -var every 10");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  const auto begin = [&] {
    fs::remove_all(dir / "d");
    fs::copy(dir / "out", dir / "d", fs::copy_options::recursive);
  };
  begin();
  ASSERT_EQ(import_with("none:0").code, 0) << slurp(dir / "stderr.txt");
  fs::rename(dir / "d", dir / "whole");
  const long calls = std::stol("0" + slurp(dir / "count"));
  ASSERT_GT(calls, 20);
  for (const char* how : {"kill", "ENOSPC", "EIO"})
    for (long n = 1; n <= calls; n += how == std::string("kill") ? 1 : 3) {
      begin();
      const std::string when = std::string(how) + " at call " + std::to_string(n);
      const Outcome stopped = import_with(how + (":" + std::to_string(n)));
      const bool killed = how == std::string("kill");
      EXPECT_TRUE(killed || stopped.code == 0 || stopped.code == 2) << when << stopped.err;
      const Outcome again = run("import d");
      const bool had_come_far_enough = again.err.find("no whole state after step 30") != std::string::npos;
      EXPECT_TRUE(again.code == 0 || had_come_far_enough) << when << again.err;
      for (const char* name : {"log.csv", "frames.gsd", "final.csv"})
        ASSERT_TRUE(slurp(dir / "d" / name) == slurp(dir / "whole" / name)) << when << ": " << name;
      for (const auto& entry : fs::directory_iterator(dir / "d"))
        EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << when << entry.path();
      ASSERT_EQ(run("resume d --quiet --steps 35").code, 0) << when << slurp(dir / "stderr.txt");
    }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
