// Every error is one line that says what to write instead.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "lammps/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

struct Mistake {
  const char* name;
  std::string what, by;  // in in.rope
  std::string message, remedy;
};

class LammpsErrors : public Lammps {
 protected:
  void scene_with_everything() const {
    exported(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
        "perturbation_nm = 0.01\n[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\n",
        "out");
  }
};

TEST_F(LammpsErrors, NameTheRemedy) {
  scene_with_everything();
  const std::string script = slurp(dir / "out/in.rope");
  const std::vector<Mistake> mistakes = {
      {"no motion", "fix motion all mdem/nve\n", "", "nothing moves", "fix motion all mdem/nve"},
      {"no damping", "fix damping all mdem/damp\n", "", "the scene has damping", "fix damping all mdem/damp"},
      {"no grips", "fix grips all mdem/grip\n", "", "the scene has loads", "fix grips all mdem/grip"},
      {"moved twice", "fix motion all mdem/nve\n", "fix motion all mdem/nve\nfix second all nve\n",
       "more than one fix moves", "leave only one"},
      {"atom style", "atom_style hybrid sphere bond", "atom_style bond", "needs elements that turn",
       "atom_style hybrid sphere bond"},
      {"units", "units lj", "units metal", "units are not those", "units lj"},
      {"newton", "newton on", "newton off", "not sent back", "newton on"},
      {"ghost velocities", "vel yes", "vel no", "ghosts have no velocities", "comm_modify vel yes"},
      {"periodic", "boundary m m m", "boundary m m p", "periodic", "boundary m m m"},
      {"fixed box", "boundary m m m", "boundary f f f", "would be lost", "boundary m m m"},
      {"law", "pair_style mdem/paper", "pair_style mdem/line", "contact is \"paper\"", "pair_style mdem/paper DIR"},
      {"no contact", "pair_style mdem/paper ${dir} ${forces}\npair_coeff * *", "pair_style zero 6\npair_coeff * *",
       "the scene has contact", "pair_style mdem/paper DIR"},
      {"how forces are computed", "variable forces index engine", "variable forces index fast", "takes a directory",
       "DIR plain"},
      {"energies of atoms", "fix motion all",
       "compute each all pe/atom\ndump each all custom 1 each.dump id c_each\nfix motion all",
       "no energies or virials of single elements", "DIR plain"},
      {"directory", "variable dir index .", "variable dir index nowhere", "cannot be opened", "check the name"},
      {"orientations", "d2_quat 4", "d2_other 4", "no orientations", "d2_quat 4 d2_carried 6"},
      {"the file of states", "from ${dir}/${from}", "from nowhere", "nowhere: cannot be opened", "check the name"},
      {"another file", "from ${dir}/${from}", "from scene.toml", "does not begin as a state does", "this export"},
      {"steps between states", "mdem/states ${every}", "mdem/states 0.5", "cannot write every 0.5 steps", "from 1"},
      {"words of states", "from ${dir}/${from}", "${from}", "takes a number of steps", "from rope.state"},
      {"motion before elements", "fix states all", "fix motion all mdem/nve\nfix states all",
       "is there before them", "fix states before fix motion"},
      {"two steps in one", "fix motion all mdem/nve\n", "run_style respa 2 2\nfix motion all mdem/nve\n",
       "run_style respa", "run_style verlet"},
      {"minimizer", "variable now equal", "minimize 0 1e-6 10 10\nvariable now equal", "a minimizer of LAMMPS",
       "fix motion all mdem/relax"},
      {"special bonds", "special_bonds lj/coul 0 0 0", "special_bonds lj/coul 0 0 0.5", "weakens contact",
       "only 0 or 1"},
      {"time step", "timestep 0.0", "timestep 0.00", "the time step is not that", "take it from in.rope"},
      {"masses", "fix motion all", "set group all density 3\nfix motion all", "the mass of element",
       "leave masses"},
      {"lost elements", "fix motion all", "group gone id 5\ndelete_atoms group gone bond yes\nfix motion all",
       "69 of 70 elements are left", "restart file"},
  };
  // Each fix of ours twice: a second one would act again.
  std::vector<Mistake> all = mistakes;
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("fix ", 0) == 0 && line.find(" mdem/") != std::string::npos) {
      const std::string id = line.substr(4, line.find(' ', 4) - 4);
      std::string second = line;
      second.replace(4, id.size(), "again");
      // Of a second file, which begins with no state.
      if (const std::size_t from = second.find(" from "); from != std::string::npos) second.erase(from);
      all.push_back({"twice", line + "\n", line + "\n" + second + "\n",
                     id == "motion" ? "more than one fix moves" : "is there twice",
                     id == "motion" ? "leave only one" : "unfix again"});
    }
  ASSERT_EQ(all.size(), mistakes.size() + 4) << script;
  for (const Mistake& m : all) {
    SCOPED_TRACE(m.name);
    spit(dir / "out/in.rope", script);
    edit("out", m.what, m.by);
    edit("out", "variable now equal", "run 0\nvariable now equal");  // before LAMMPS misses what outputs ask for
    const Outcome o = lmp(1, "out", "-in in.rope -var steps 5");
    EXPECT_NE(o.code, 0);
    const std::size_t at = o.out.find("ERROR");
    ASSERT_NE(at, std::string::npos) << o.out << o.err;
    const std::string line = o.out.substr(at, o.out.find('\n', at) - at);
    EXPECT_NE(line.find(m.message), std::string::npos) << line;
    EXPECT_NE(line.find(m.remedy), std::string::npos) << line;
  }
}

// LAMMPS itself would only warn, and then leave out forces.
TEST_F(LammpsErrors, ShortGhostCutoffIsRefused) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 20\n"
      "[contact]\nlaw = \"none\"\n[run]\nduration_ps = 1\n",
      "out");
  std::string script = slurp(dir / "out/in.rope");
  const auto replace_all = [&](const std::string& what, const std::string& by) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = script.find(what, at)) != std::string::npos; at += by.size(), ++found)
      script.replace(at, what.size(), by);
    ASSERT_GT(found, 0U) << what;
  };
  replace_all("pair_style mdem/none ${dir} ${forces}", "pair_style zero 0.5 nocoeff");
  replace_all("vel yes cutoff 2.184", "vel yes cutoff 0.6");
  spit(dir / "out/in.rope", script);
  for (const int ranks : {1, 2}) {
    const Outcome o = lmp(ranks, "out", "-in in.rope -var steps 5");
    EXPECT_NE(o.code, 0);
    EXPECT_NE(o.out.find("nm and must reach"), std::string::npos) << o.out << o.err;
    EXPECT_NE(o.out.find("comm_modify mode single vel yes cutoff"), std::string::npos) << o.out;
  }
}

TEST_F(LammpsErrors, BlowUpAndSlipStopTheRun) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
      "[twist]\nmoment_nN_nm = 234\nrate_nN_nm_per_ps = 20\n[run]\nduration_ps = 30\n",
      "out");
  const Outcome o = lmp(2, "out");
  EXPECT_NE(o.code, 0);
  EXPECT_NE(o.out.find("cannot carry more torque; use shorter elements or less twist"), std::string::npos)
      << o.out << o.err;
}

TEST_F(LammpsErrors, OtherVersionIsRefused) {
  const Outcome o = lmp(2, ".", "-in none", ROPEWALK_LMP_OTHER_VERSION);
  EXPECT_NE(o.code, 0);
  EXPECT_NE(o.err.find("built against LAMMPS 20200101 and runs with LAMMPS 20"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("build it again"), std::string::npos) << o.err;
}

TEST_F(LammpsErrors, ExportAndImportRefuse) {
  const auto expect = [&](const std::string& arguments, const std::string& message) {
    const Outcome o = run(arguments);
    EXPECT_EQ(o.code, 2) << arguments;
    EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  expect("export nowhere.toml --lammps out", "cannot be opened");
  expect("import nowhere", "was not made by `ropewalk export`");
  spit(dir / "rotations.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
       "[run]\nduration_ps = 1\nintegrator = \"rk4\"\n");
  expect("export rotations.toml --lammps out", "run.integrator: is not for LAMMPS");
  EXPECT_FALSE(fs::exists(dir / "out"));
  scene_with_everything();
  expect("export scene.toml --lammps out", "is not empty");
  expect("import out", "run in.rope with lmp-ropewalk first");
  expect("export out --force --lammps ./out", "is the run itself");
  EXPECT_TRUE(fs::exists(dir / "out/checkpoint.bin"));
  spit(dir / "out/lammps.json", "{");
  expect("import out", "lammps");
}

// What links remember stands behind the elements of a state.
TEST_F(LammpsErrors, ADamagedMemoryIsOneLine) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
      "[[links]]\nper_nm = 0.5\nstiffness_nN_per_nm = 10\nbreaks_at_nN = 1\n[run]\nduration_ps = 1\n",
      "out");
  const std::string good = slurp(dir / "out/rope.state");
  const StateInFile state = find_states((dir / "out/rope.state").string(), 70).back();
  ASSERT_GT(state.header.memory, 100);
  const auto number_at = [&](std::int64_t number, double value) {
    std::string bad = good;
    std::memcpy(&bad[static_cast<std::size_t>(state.record(70) + 8 * number)], &value, sizeof value);
    return bad;
  };
  // The first record is the account: its count of numbers, its element, and a number of the one behind it.
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {number_at(2, 1e9), "the memory of a force term is damaged"},
      {number_at(2, 3), "the memory of"},
      {number_at(1, 1e6), "the memory of a force term is damaged"},
      {number_at(1, -7), "the memory of a force term is damaged"},
      {number_at(12, std::nan("")), "the memory of a force term is damaged"},
      {number_at(0, 5), "the memory of the force terms is damaged"}};
  for (const auto& [bytes, message] : mistakes) {
    spit(dir / "out/rope.state", bytes);
    for (const int ranks : {1, 3}) {
      SCOPED_TRACE(message + " on " + std::to_string(ranks));
      const Outcome o = lmp(ranks, "out", "-in in.rope -var steps 5");
      EXPECT_NE(o.code, 0);
      const std::size_t at = o.out.find("ERROR");
      ASSERT_NE(at, std::string::npos) << o.out << o.err;
      EXPECT_NE(o.out.substr(at, o.out.find('\n', at) - at).find(message), std::string::npos) << o.out.substr(at);
    }
  }
  spit(dir / "out/rope.state", good);
  ASSERT_EQ(lmp(2, "out", "-in in.rope -var steps 5 -var every 5").code, 0);
  // A link of a later state that joins an element which is not there.
  const StateInFile last = find_states((dir / "out/lammps.states").string(), 70).back();
  std::string states = slurp(dir / "out/lammps.states");
  const std::size_t count = static_cast<std::size_t>(last.header.memory);
  std::vector<double> memory(count);
  std::memcpy(memory.data(), &states[static_cast<std::size_t>(last.record(70))], 8 * count);
  const std::size_t link = static_cast<std::size_t>(
      std::find(memory.begin(), memory.end(), 17.0) - memory.begin());  // as many numbers as a link has
  ASSERT_LT(link, count);
  memory[link + 1] = 1e6;
  std::memcpy(&states[static_cast<std::size_t>(last.record(70))], memory.data(), 8 * count);
  spit(dir / "out/lammps.states", states);
  const Outcome o = run("import out");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("the memory of links is damaged"), std::string::npos) << o.err;
}

// All that LAMMPS would obey, in a name.
TEST_F(LammpsErrors, ANameIsNoCommand) {
  exported(
      "format = \"ropewalk-scene-1\"\nname = 'x & \"\"\" $(1/0) ${y} # \" shell touch pwned ; &'\n"
      "parameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 6.78\n[run]\nduration_ps = 0.3\n",
      "out");
  const Outcome o = lmp(1, "out");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_FALSE(fs::exists(dir / "out/pwned"));
  EXPECT_EQ(run("import out").code, 0) << slurp(dir / "stderr.txt");
}

// A script, a row and a set of states that are not those of the export.
TEST_F(LammpsErrors, ImportHoldsWhatItReadsToTheExport) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = "
      "6.78\n[run]\nduration_ps = 0.3\n",
      "out");
  ASSERT_EQ(lmp(1, "out", "-in in.rope -var every 5").code, 0);
  const std::string script = slurp(dir / "out/in.rope"), rows = slurp(dir / "out/lammps-rows.csv");
  const auto expect = [&](const std::string& message) {
    const Outcome o = run("import out");
    EXPECT_EQ(o.code, 2) << message;
    EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  edit("out", "thermo ${every}", "thermo 1");
  expect("in.rope: is not as it was exported");
  spit(dir / "out/in.rope", script);
  // The last row: step, time, four energies of bonds, vdw, kinetic.
  const std::size_t last = rows.rfind('\n', rows.size() - 2) + 1;
  const auto with = [&](int column, double by) {
    std::size_t at = last;
    for (int k = 0; k < column; ++k) at = rows.find(',', at) + 1;
    std::string changed = rows;
    const std::size_t length = rows.find(',', at) - at;
    spit(dir / "out/lammps-rows.csv",
         changed.replace(at, length, std::to_string(std::stod(rows.substr(at, length)) + by)));
  };
  with(1, 0.01);
  expect("by the export");
  with(3, 0.1);
  expect("eV in bonds at step");
  with(6, 0.1);
  expect("eV in contacts at step");
  with(7, 0.1);
  expect("eV in motion at step");
  spit(dir / "out/lammps-rows.csv", rows);
  edit("out", "thermo ${every}", "thermo 1");
  const Outcome o = run("import out --accept-changes");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.err.find("note: out/in.rope is not as it was exported"), std::string::npos) << o.err;
}

// Files of another run in the place of this one's: as many elements, and other tubes.
TEST_F(LammpsErrors, FilesOfAnotherRunAreRefused) {
  const auto scene = [](int tubes, const char* length) {
    return "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = " +
           std::to_string(tubes) + "\nlength_nm = " + length + "\n[run]\nduration_ps = 0.3\n";
  };
  exported(scene(19, "9.492"), "other");
  exported(scene(7, "25.764"), "out");
  for (const char* folder : {"out", "other"}) ASSERT_EQ(lmp(2, folder, "-in in.rope -var steps 10 -var every 5").code, 0);
  const std::string states = slurp(dir / "out/lammps.states"), others = slurp(dir / "other/lammps.states");
  ASSERT_EQ(states.size(), others.size());
  const auto expect = [&](const Outcome& o, const std::string& text, const std::string& message) {
    EXPECT_NE(o.code, 0) << message;
    EXPECT_NE(text.find(message), std::string::npos) << text;
  };
  spit(dir / "out/lammps.states", others);
  for (const int ranks : {1, 2}) {
    const Outcome o = lmp(ranks, "out", "-in in.rope -var steps 20 -var every 5 -var from lammps.states");
    expect(o, o.out, "lammps.states: state 1: is of another export");
    EXPECT_EQ(slurp(dir / "out/lammps.states"), others) << "it is left as it was";
  }
  Outcome o = run("import out");
  expect(o, o.err, "lammps.states: state 1: is of another export");
  spit(dir / "out/lammps.states", states);
  spit(dir / "out/events.csv",
       "time_ps,event,tube,element,to_tube,to_element,x_nm,y_nm,z_nm\n0.01,tube broke,1,2,1,3,0,0,0\n");
  o = run("import out");
  expect(o, o.err, "events.csv: has events of another run");
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  fs::remove(dir / "out/events.csv");
  spit(dir / "out/lammps-rows.csv", "step,temp\n0,300\n");
  o = run("import out");
  expect(o, o.err, "lammps-rows.csv:1: has another title");
}

// Most ranks then have no element.
TEST_F(LammpsErrors, MoreRanksThanElementsGoOn) {
  exported("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 3\n[start]\n"
           "temperature_K = 300\nmay_cool = true\n[run]\nduration_ps = 1\n", "out");
  const Outcome o = lmp(8, "out", "-in in.rope -var steps 40 -var every 20");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_EQ(run("import out").code, 0) << slurp(dir / "stderr.txt");
}

// Nothing is written before all of it is read.
TEST_F(LammpsErrors, AnImportThatFailsLeavesTheRunAsItWas) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = "
      "6.78\n[run]\n"
      "duration_ps = 0.3\n",
      "out");
  ASSERT_EQ(lmp(1, "out").code, 0);
  std::map<std::string, std::string> before;
  const auto files = [&] {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(dir / "out"))
      all[entry.path().filename().string()] = slurp(entry.path());
    return all;
  };
  const std::string right = slurp(dir / "out/lammps.states"), manifest = slurp(dir / "out/manifest.json");
  const double three = 3;  // in the place of qw of the last element
  std::string wrong = right;
  wrong.replace(wrong.size() - sizeof(StateRecord) + 3 * sizeof three, sizeof three,
                reinterpret_cast<const char*>(&three), sizeof three);
  spit(dir / "out/lammps.states", wrong);
  before = files();
  const Outcome o = run("import out");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("the quaternion has length"), std::string::npos) << o.err;
  EXPECT_EQ(files(), before);
  spit(dir / "out/lammps.states", right);
  spit(dir / "out/manifest.json", "{");
  before = files();
  EXPECT_EQ(run("import out").code, 2);
  EXPECT_EQ(files(), before);
  spit(dir / "out/manifest.json", manifest);
  EXPECT_EQ(run("import out").code, 0) << slurp(dir / "stderr.txt");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
