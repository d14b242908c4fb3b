// `ropewalk atoms` and `ropewalk coarsen` as a user types them.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "atoms/atom_files.hpp"
#include "atoms/support.hpp"
#include "cli/support.hpp"
#include "exchange/coarsen.hpp"
#include "outputs_page.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

TEST(OutputsPageOfAtoms, HasTheTablesOfCoarsen) {
  EXPECT_EQ(outputs_table("`found-tubes.csv`"), columns_markdown(found_tube_columns()));
  EXPECT_EQ(outputs_table("`sections.csv`"), columns_markdown(section_columns()));
}

// Seven tubes of the kind that the model twists, wound a little.
const char* const twisted_rope = R"(format = "ropewalk-scene-1"
parameters = "cnt-5-5-tersoff"
[rope]
tubes = 7
length_nm = 7
[twist]
moment_nN_nm = 1
rate_nN_nm_per_ps = 1
hold_ps = 2
[run]
frames_every_ps = 1
)";

class Bridge : public Cli {
 protected:
  void make_run() {
    spit(dir / "rope.toml", twisted_rope);
    const Outcome made = run("run rope.toml --out made --threads 1 --quiet");
    ASSERT_EQ(made.code, 0) << made.err;
  }
  State state(const char* file) const {
    Topology topology;
    topology.types[0].element_length = state_element_length((dir / file).string());
    State out;
    read_state_csv((dir / file).string(), topology, out);
    return out;
  }
};

TEST_F(Bridge, ARunBecomesAtomsAndTheAtomsTheSameState) {
  make_run();
  const Outcome atoms = run("atoms made -o rope.data");
  ASSERT_EQ(atoms.code, 0) << atoms.err;
  EXPECT_NE(atoms.out.find("rope-relax.in"), std::string::npos);
  const Outcome coarse = run("coarsen rope.data --state again.csv");
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_NE(coarse.out.find("tube 6: (5,5), "), std::string::npos) << coarse.out;
  // The order of the tubes is that of their places: each one of the run is there, with every element.
  const State before = state("made/final.csv"), after = state("again.csv");
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    double nearest = 1e9, turn = 1e9;
    for (std::size_t j = 0; j < after.size(); ++j) {
      const double d = (before.position[i] - after.position[j]).norm();
      if (d > nearest) continue;
      nearest = d;
      const double angle =
          (before.orientation[i].conjugate() * after.orientation[j]).angularDistance(Quaternion::Identity());
      turn = std::fabs(std::remainder(angle, 2 * units::pi / 5));
    }
    EXPECT_LT(nearest, 1e-3);
    EXPECT_LT(turn, 1e-3);
  }
  // And the same energies, so that a scene can go on from it.
  const auto energy = [&](const std::string& file) {
    const Outcome found = run("energy " + file + " --parameters cnt-5-5-tersoff --json --threads 1");
    EXPECT_EQ(found.code, 0) << found.err;
    return nlohmann::json::parse(found.out)["energy_eV"]["total"].get<double>();
  };
  EXPECT_NEAR(energy("made/final.csv"), energy("again.csv"), 1e-3);
}

TEST_F(Bridge, FramesOfAtomsBecomeARun) {
  make_run();
  std::string all;
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_EQ(run(fmt::format("atoms made --frame {} -o f.xyz --force", frame)).code, 0);
    all += slurp(dir / "f.xyz");
  }
  spit(dir / "md.xyz", all);
  const Outcome coarse = run("coarsen md.xyz -o coarse");
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_NE(coarse.out.find("4 frames"), std::string::npos);
  EXPECT_NE(slurp(dir / "coarse/sections.csv").find("ovality_nm"), std::string::npos);
  EXPECT_NE(slurp(dir / "coarse/found-tubes.csv").find("\n6,5,5,"), std::string::npos);
  for (const char* verb : {"observe coarse", "report coarse", "view coarse --force", "compare coarse made --force",
                           "convert coarse x.lammpstrj", "atoms coarse -o again.data"}) {
    const Outcome done = run(verb);
    EXPECT_EQ(done.code, 0) << verb << ": " << done.err;
  }
  // What the run has in its last frame, the atoms have as well.
  const auto last = [&](const char* verb) { return nlohmann::json::parse(run(verb).out).back(); };
  const nlohmann::json of_atoms = last("observe coarse --json"), of_run = last("observe made --json");
  EXPECT_NEAR(of_atoms["time_ps"].get<double>(), of_run["time_ps"].get<double>(), 1e-6);
  EXPECT_GT(of_run["beta_deg"].get<double>(), 1);
  for (const char* name : {"beta_deg", "ends_apart_nm", "most_curvature_per_nm"})
    EXPECT_NEAR(of_atoms[name].get<double>(), of_run[name].get<double>(), 0.01) << name;
  EXPECT_NE(run("errors coarse").err.find("taken from atoms"), std::string::npos) << "there is nothing to repeat";
  EXPECT_EQ(run("resume coarse").code, 2) << "there is nothing to resume";
  const std::string rows = slurp(dir / "coarse/log.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 5);
}

TEST_F(Bridge, PartsOfARunAreWrittenAlone) {
  make_run();
  const Outcome part = run("atoms made -o part.xyz --tubes 0,2-3 --between 2,5");
  ASSERT_EQ(part.code, 0) << part.err;
  const AtomFrame frame = [&] {
    AtomFiles files({(dir / "part.xyz").string()}, 1);
    AtomFrame read;
    files.next(read);
    return read;
  }();
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  EXPECT_NEAR(static_cast<double>(frame.positions.size()), 3 * 3 * set.atoms_per_length,
              3 * set.element_length * set.atoms_per_length);
  const std::string table = slurp(dir / "part-elements.csv");
  EXPECT_EQ(table.substr(0, table.find('\n')), "tube,element,first_atom,last_atom");
}

// Every atom is where its own element is, though the parts of a tube are far apart.
TEST_F(Bridge, NoAtomStandsBetweenThePartsOfABrokenTube) {
  spit(dir / "torn.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff\"\n[chain]\nelements = 9\n[[grip]]\nend = "
       "\"lower\"\n[[grip]]\nend = \"upper\"\nz = { displacement_nm = 3, rate_nm_per_ps = 1 }\n[failure]\nstrain = "
       "0.05\n[run]\nframes_every_ps = 1\n");
  const Outcome made = run("run torn.toml --out torn --threads 1 --quiet");
  ASSERT_EQ(made.code, 0) << made.err;
  const auto farthest = [&](const std::string& arguments) {
    const Outcome o = run("atoms " + arguments + " -o torn.data --force");
    EXPECT_EQ(o.code, 0) << o.err;
    AtomFiles files({(dir / "torn.data").string()}, 1);
    AtomFrame frame;
    files.next(frame);
    const State elements = state("torn/final.csv");
    std::istringstream table(slurp(dir / "torn-elements.csv"));
    std::string row;
    std::getline(table, row);
    double most = 0;
    while (std::getline(table, row)) {
      int tube = 0, element = 0;
      long first = 0, last = 0;
      std::sscanf(row.c_str(), "%d,%d,%ld,%ld", &tube, &element, &first, &last);
      for (long k = first - 1; k < last; ++k)
        most = std::max(most, (frame.positions[static_cast<std::size_t>(k)] -
                               elements.position[static_cast<std::size_t>(element)])
                                  .norm());
    }
    return most;
  };
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  const double corner = std::hypot(set.radius, 0.5 * set.element_length);
  EXPECT_NEAR(farthest("torn"), corner, 0.1);
  EXPECT_NEAR(farthest("torn/final.csv --parameters cnt-5-5-tersoff"), corner, 0.1);
}

// Frames that are no later than the one before, and atoms that are no tubes any more, would be taken for motion.
TEST_F(Bridge, FramesThatDoNotFollowOneAnotherAreRefused) {
  make_run();
  for (int frame = 0; frame < 2; ++frame)
    ASSERT_EQ(run(fmt::format("atoms made --frame {0} -o f{0}.xyz", frame)).code, 0);
  const std::string first = slurp(dir / "f0.xyz"), second = slurp(dir / "f1.xyz");
  // The second frame twice: with its atoms in another order, and with its lengths in nm.
  std::vector<std::string> lines;
  std::istringstream text(second);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  std::string shuffled = lines[0] + "\n" + lines[1] + "\n", small = shuffled;
  for (std::size_t k = 2; k < lines.size(); ++k) {
    shuffled += lines[2 + (k - 2) * 7919 % (lines.size() - 2)] + "\n";
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(lines[k].c_str(), "C %lf %lf %lf", &x, &y, &z), 3);
    small += fmt::format("C {} {} {} 0 0\n", x / 10, y / 10, z / 10);
  }
  const std::tuple<const char*, std::string, const char*> cases[] = {
      {"fall", second + first, "a frame at 0 ps comes after one at"},
      {"twice", first + first, "a frame at 0 ps comes after one at 0 ps"},
      {"shuffled", first + shuffled, "are they in another order than in the first frame"},
      {"small", first + small, "lengths not in Angstrom"},
  };
  for (const auto& [name, frames, words] : cases) {
    spit(dir / (name + std::string(".xyz")), frames);
    const Outcome o = run(fmt::format("coarsen {0}.xyz -o {0}", name));
    EXPECT_EQ(o.code, 2) << name;
    EXPECT_NE(o.err.find(words), std::string::npos) << name << ": " << o.err;
    EXPECT_FALSE(fs::exists(dir / name / "log.csv")) << name;
  }
}

// Frames are 1 ps apart, and the limit is passed between two of them.
TEST_F(Bridge, ARunIsSteppedAgainToItsLimit) {
  spit(dir / "rope.toml", std::string(twisted_rope) + "[limits]\nwall_twist = 0.007\n");
  ASSERT_EQ(run("run rope.toml --out made --threads 1 --quiet").code, 0);
  const auto passed = [&](const char* run) {
    const nlohmann::json all = nlohmann::json::parse(slurp(dir / run / "limits.json"));
    for (const auto& limit : all["limits"])
      if (limit["key"] == "wall_twist") return limit;
    return nlohmann::json();
  };
  const nlohmann::json limit = passed("made");
  ASSERT_TRUE(limit["passed"].get<bool>());
  const Outcome there = run("atoms made --at wall_twist --length 4 -o there.xyz");
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_NE(there.err.find("stepped again"), std::string::npos) << there.err;
  // The same as of a run that ends there.
  const std::string steps = std::to_string(limit["passed_at_step"].get<int>());
  ASSERT_EQ(run("run rope.toml --out short --threads 1 --quiet --steps " + steps).code, 0);
  ASSERT_EQ(run("atoms short/final.csv --parameters cnt-5-5-tersoff -o short.xyz").code, 0);
  const auto atoms = [&](const char* name) {
    AtomFiles files({(dir / name).string()}, 1);
    AtomFrame frame;
    files.next(frame);
    return frame;
  };
  const AtomFrame place = atoms("there.xyz"), whole = atoms("short.xyz");
  EXPECT_NEAR(place.time, limit["passed_at_ps"].get<double>(), 1e-6);
  ASSERT_LT(place.positions.size(), whole.positions.size());
  for (std::size_t i = 0; i < place.positions.size(); i += 97) {
    double nearest = 1e9;
    for (const Vector3& x : whole.positions) nearest = std::min(nearest, (x - place.positions[i]).norm());
    EXPECT_LT(nearest, 1e-5);
  }
  // A run that this program does not make again: the message says by how much the frame misses.
  spit(dir / "made/scene.toml", slurp(dir / "made/scene.toml") + "[damping]\nbond_damping_per_ps = 9\n");
  const Outcome other = run("atoms made --at wall_twist --length 4 -o other.xyz");
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_NE(other.err.find("ps before that. It was not stepped again: this program"), std::string::npos) << other.err;
}

TEST_F(Bridge, BadInputIsOneLine) {
  make_run();
  spit(dir / "water.xyz", "3\nwater\nO 0 0 0\nH 1 0 0\nH 0 1 0\n");
  spit(dir / "overlap.xyz", "3\nno bond\nC 0 0 0\nC 0 0 0.4\nC 0 0 1.8\n");
  spit(dir / "narrow.xyz", "1\nLattice=\"3 0 0 0 9 0 0 0 9\"\nC 0 0 0\n");
  spit(dir / "cut.xyz", "3\ncut off\nC 0 0 0\nC 0 0 1.4\n");
  const std::string dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
                           "ITEM: ATOMS id type x y z\n1 1 0 0 0\n";
  spit(dir / "species.lammpstrj", dump + "2 2 0 0 3\n");
  spit(dir / "cut.lammpstrj", dump);
  const std::pair<const char*, const char*> cases[] = {
      {"coarsen overlap.xyz -o w", "overlap.xyz: atoms 1 and 2 of the file overlap"},
      {"coarsen narrow.xyz -o w", "narrow.xyz: its periodic box is 0.3 nm wide, less than two bonds"},
      {"coarsen cut.xyz -o w", "cut.xyz: ends within its first frame"},
      {"coarsen species.lammpstrj -o w", "species.lammpstrj:11: type: 2 is of no known species"},
      {"coarsen cut.lammpstrj -o w", "cut.lammpstrj: ends within its first frame"},
      {"coarsen water.xyz cut.xyz -o w", "water.xyz: has no carbon nanotube"},
      {"coarsen missing.xyz -o w", "File does not exist: missing.xyz"},
      {"atoms made -o a.data --at wall_twist --step-again", "was not passed"},
      {"atoms made -o a.pdb", "a.pdb: -o: ends in none of"},
      {"atoms made -o a.data --tubes 9", "there is no tube 9"},
      {"atoms made -o a.data --tubes 1-", "names no tubes"},
      {"atoms made -o a.data --between 3", "no stretch of a tube"},
      {"atoms made -o a.data --between 300,400", "no element was asked for"},
      {"atoms made -o a.data --frame 99", "there is no frame 99"},
      {"atoms made -o a.data --at wall_twist", "was not passed"},
      {"atoms made -o a.data --at colour", "there is no limit"},
      {"atoms made/final.csv -o a.data", "--parameters: is missing"},
      {"atoms made -o a.xyz --relax", "needs a file for LAMMPS"},
      {"atoms made -o a.data --potential tersof", "did you mean 'tersoff'"},
      {"coarsen water.xyz -o w", "has no carbon nanotube"},
      {"coarsen rope.toml -o w", "no file of atoms"},
      {"coarsen water.xyz", "-o: is missing"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome failed = run(arguments);
    EXPECT_EQ(failed.code, 2) << arguments;
    EXPECT_NE(failed.err.find(message), std::string::npos) << arguments << ": " << failed.err;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
  }
}

// A warm tube shows the stiffness of its own set.
TEST_F(Bridge, AWarmTubeShowsItsStiffness) {
  spit(dir / "warm.toml", R"(format = "ropewalk-scene-1"
parameters = "cnt-5-5-tersoff"
[chain]
elements = 8
[thermostat]
temperature_K = 300
coupling_per_ps = 5
[damping]
contact_viscosity_eV_ps_per_nm3 = 0
bond_damping_per_ps = 0
[run]
duration_ps = 150
frames_every_ps = 0.2
)");
  const Outcome made = run("run warm.toml --out warm --threads 1 --quiet");
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome found = run("calibrate fluctuations warm --after 4 --json --out again.toml");
  ASSERT_EQ(found.code, 0) << found.err;
  const auto result = nlohmann::json::parse(found.out).at(0);
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  const auto& window = result["windows"][0];
  for (const auto& [name, is] : {std::pair{"EA (nN)", set.bond.stretch}, std::pair{"EI_x (nN nm^2)", set.bond.bend},
                                 std::pair{"GJ (nN nm^2)", set.bond.twist}}) {
    const double value = window[name]["value"], error = window[name]["standard_error"], nN = units::eV_in_nN_nm;
    EXPECT_LT(std::fabs(value - is * nN), 4 * error) << name;
    EXPECT_LT(error, 0.1 * is * nN) << name;
  }
  EXPECT_NEAR(read_parameters((dir / "again.toml").string()).bond.twist * units::eV_in_nN_nm,
              result["rod"]["GJ (nN nm^2)"]["value"].get<double>(), 1e-9);
  EXPECT_NE(run("calibrate fluctuations warm --after 4").out.find("ratio"), std::string::npos);
  EXPECT_NE(run("calibrate fluctuations warm --after 149").err.find("30 are needed"), std::string::npos);
}

// The atoms would stand in the way of the same command. What LAMMPS said stays where the message names it; a stop leaves nothing.
TEST_F(Bridge, ARelaxationThatFailsLeavesNothingInItsOwnWay) {
  make_run();
  fs::create_directory(dir / "there");
  const auto left = [&] {
    std::string names;
    for (const auto& entry : fs::directory_iterator(dir / "there"))
      if (entry.path().filename() != "lmp") names += entry.path().filename().string() + " ";
    return names;
  };
  const auto lammps = [&](const char* lines) {
    spit(dir / "there/lmp", std::string("#!/bin/sh\n") + lines);
    fs::permissions(dir / "there/lmp", fs::perms::owner_all);
  };
  lammps("kill -TERM $PPID\nsleep 60\n");
  const Outcome stopped = run("atoms made -o there/a.data --relax", "ROPEWALK_LMP=$PWD/there/lmp");
  EXPECT_EQ(stopped.code, 143) << stopped.err;
  EXPECT_EQ(left(), "");
  lammps("echo 'ERROR: no atoms today'\nexit 1\n");
  const Outcome failed = run("atoms made -o there/a.data --relax", "ROPEWALK_LMP=$PWD/there/lmp");
  EXPECT_EQ(failed.code, 3) << failed.err;
  const std::string folder = left();
  EXPECT_EQ(folder.rfind("ropewalk-", 0), 0u) << folder;
  EXPECT_NE(failed.err.find("there/" + folder.substr(0, folder.size() - 1) + "/atoms.in"), std::string::npos)
      << failed.err;
  EXPECT_TRUE(fs::exists(dir / "there" / folder.substr(0, folder.size() - 1) / "atoms.out"));
}

// States below the limits, relaxed by LAMMPS: the atoms have the energy that the model gives them.
TEST_F(Bridge, RelaxedAtomsHaveTheEnergyOfTheModel) {
  const double a = shipped("cnt-5-5-tersoff").element_length;
  for (const RodShape& shape : {RodShape{0.01, 0, 0}, RodShape{0, 0.06, 0}, RodShape{0, 0, 0.15}}) {
    const Elements rod10 = rod(10, a, shape);
    spit(dir / "state.csv", state_csv(rod10.topology, rod10.state));
    const Outcome relaxed = run("atoms state.csv --parameters cnt-5-5-tersoff -o a.data --relax --json --force");
    ASSERT_EQ(relaxed.code, 0) << relaxed.err;
    const auto part = nlohmann::json::parse(relaxed.out).at(0);
    const double model = part["model_bonds_eV"], atoms = part["atoms_relaxed_eV"], placed = part["atoms_placed_eV"];
    EXPECT_GT(model, 0.5);
    EXPECT_NEAR(atoms / model, 1, 0.05);
    EXPECT_GT(placed, atoms);
    EXPECT_TRUE(fs::exists(dir / "a-relaxed.data"));
  }
}

// Walls hold below the limit of twist and give way beyond it, where round ones are at rest as well.
TEST_F(Bridge, WallsGiveWayBeyondTheirLimit) {
  const ParameterSet set = shipped("cnt-10-10-tersoff");
  for (const double part : {0.8, 1.3}) {
    const Elements twisted = rod(9, set.element_length, {0, part * set.validity.twist_collapse / set.radius, 0});
    spit(dir / "state.csv", state_csv(twisted.topology, twisted.state));
    const Outcome relaxed = run("atoms state.csv --parameters cnt-10-10-tersoff -o a.data --relax --json --force");
    ASSERT_EQ(relaxed.code, 0) << relaxed.err;
    const double thickness = nlohmann::json::parse(relaxed.out).at(0)["thickness_over_width"];
    if (part < 1)
      EXPECT_GT(thickness, 0.95);
    else
      EXPECT_LT(thickness, 0.8);
  }
}

// Sets have the shift of one sublattice against the other: atoms of a tube at rest are placed where LAMMPS leaves
// them. Without the shift those of (8,2) are 0.08 eV above that, those of (5,5) 0.3 eV.
TEST_F(Bridge, AtomsOfATubeAtRestAreAtRest) {
  for (const std::string name : {"cnt-5-5-tersoff", "cnt-8-2-tersoff"}) {
    const ParameterSet set = shipped(name);
    const Elements straight = rod(8, set.element_length, {});
    spit(dir / "state.csv", state_csv(straight.topology, straight.state));
    const Outcome relaxed = run("atoms state.csv --parameters " + name + " -o a.data --relax --json --force");
    ASSERT_EQ(relaxed.code, 0) << relaxed.err;
    EXPECT_LT(std::fabs(nlohmann::json::parse(relaxed.out).at(0)["atoms_placed_eV"].get<double>()), 1e-3) << name;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
