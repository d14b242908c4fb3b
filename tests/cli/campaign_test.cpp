// Campaigns: interrupted, resumed, gathered and compared.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/support.hpp"
#include "io/csv_reader.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

using Json = nlohmann::json;

class Campaign : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    spit(dir / "tube.toml",
         "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
         "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = 10, rate_deg_per_ps = 1 "
         "}\n"
         "[thermostat]\ntemperature_K = 100\ncoupling_per_ps = 0.5\n"
         "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n"
         "[run]\nduration_ps = 12\nlog_every_ps = 1\n");
  }

  void sweep_file(const std::string& rest) const {
    spit(dir / "s.toml", "format = \"ropewalk-sweep-1\"\nscene = \"tube.toml\"\n" + rest);
  }

  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
  }
};

TEST_F(Campaign, TableIsTheSameAfterInterruptions) {
  sweep_file("replicates = 2\n[vary]\nrope.tubes = [1, 7]\nthermostat.temperature_K = [100, 300]\n");
  const Outcome whole = run("sweep s.toml --out whole");
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_NE(whole.out.find("8 points: 8 finished"), std::string::npos) << whole.out;
  const std::string table = slurp(dir / "whole" / "table.csv");
  ASSERT_EQ(lines(table).size(), 9u);
  EXPECT_NE(table.find("tubes-7_temperature_K-300_seed-2,7,300,2,finished,"), std::string::npos) << table;
  // Some points alone, one begun and left in the middle, one with nothing but its directory.
  ASSERT_EQ(run("sweep s.toml --out parts --only 1,tubes-7_temperature_K-100_seed-1").code, 0);
  const fs::path begun = dir / "parts" / "points" / "tubes-1_temperature_K-300_seed-1";
  fs::copy(dir / "whole" / "points" / begun.filename(), dir / "scene-of", fs::copy_options::recursive);
  spit(dir / "point.toml", slurp(dir / "scene-of" / "scene.toml"));
  ASSERT_EQ(run("run point.toml --out " + begun.string() + " --steps 200 --quiet").code, 0);
  std::string manifest = slurp(begun / "manifest.json");
  manifest.replace(manifest.find("\"finished\""), 10, "\"running\"");
  spit(begun / "manifest.json", manifest);
  fs::create_directories(dir / "parts" / "points" / "tubes-7_temperature_K-300_seed-1");
  const Outcome on = run("sweep s.toml --out parts -j 1");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_NE(on.err.find("2 of 8 points are done already"), std::string::npos) << on.err;
  EXPECT_EQ(slurp(dir / "parts" / "table.csv"), table);
  // Gathered otherwise.
  const Outcome means = run("gather parts --columns time_ps,kinetic_eV --mean 4");
  EXPECT_EQ(
      lines(means.out)[0],
      "point,rope.tubes,thermostat.temperature_K,start.seed,status,first_limit,first_limit_ps,time_ps,kinetic_eV,"
      "kinetic_eV_error,kinetic_eV_correlation_ps,limits_passed");
  EXPECT_NE(means.err.find("_seed-1: 4 ps are too short for an error of kinetic_eV"), std::string::npos)
      << means.err;
  EXPECT_EQ(lines(run("gather whole --series --columns time_ps").out).size(), 1 + 8 * 13u);
  EXPECT_EQ(run("gather parts --columns nothing").code, 2);
}

TEST_F(Campaign, ExpectationsAreCounted) {
  spit(dir / "tube.toml", R"(
format = "ropewalk-scene-1"
parameters = "cnt-10-10-paper"
[chain]
elements = 5
[run]
duration_ps = 1
[[expect]]
column = "time_ps"
value = 1
tolerance = 0.2
[[expect]]
column = "kinetic_eV"
value = 0
tolerance = 1e-9
)");
  spit(dir / "t.toml", "format = \"ropewalk-sweep-1\"\nscene = \"tube.toml\"\n[vary]\nrun.duration_ps = [1, 2]\n");
  const Outcome o = run("sweep t.toml --quiet");
  EXPECT_EQ(o.code, 8) << o.err;
  EXPECT_NE(o.out.find("duration_ps-2: time_ps is "), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("3 of 4 expectations hold; 1 of the points miss one"), std::string::npos) << o.out;
  const std::string table = slurp(dir / "t" / "table.csv");
  EXPECT_NE(table.find(",expected,missed,limits_passed\n"), std::string::npos) << table;
  EXPECT_NE(table.find(",2,0,"), std::string::npos) << table;
  EXPECT_NE(table.find(",2,1,"), std::string::npos) << table;
  EXPECT_EQ(run("sweep t.toml --quiet --only 1").code, 0);
}

// An expectation of another scene is told, and not judged.
TEST_F(Campaign, AnExpectationOfAnotherSceneIsNotJudged) {
  const std::string scene =
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 5\n[run]\nduration_ps "
      "= 1\n";
  const auto expecting = [](const std::string& hash) {
    return "[[expect]]\ncolumn = \"time_ps\"\nvalue = 7\ntolerance = 1\nscene_hash = \"" + hash + "\"\n";
  };
  spit(dir / "a.toml", scene + expecting("0"));
  const Outcome check = run("check a.toml");
  std::smatch hash;
  ASSERT_TRUE(std::regex_search(check.out, hash, std::regex("\nscene_hash \"([0-9a-f]+)\"\n"))) << check.out;
  EXPECT_NE(check.out.find("not judged: time_ps 7"), std::string::npos) << check.out;
  const Outcome other = run("run a.toml --out a --quiet");
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_NE(other.err.find("is not judged"), std::string::npos) << other.err;
  spit(dir / "b.toml", "# a remark\n" + scene + expecting(hash[1].str()));
  EXPECT_EQ(run("run b.toml --out b --quiet").code, 8);
}

TEST_F(Campaign, BranchesGoOnFromOneStart) {
  sweep_file("[vary]\nrope.tubes = [1, 7]\n[branch]\nat_ps = 5\n[branch.vary]\nrun.duration_ps = [6, 8]\n");
  ASSERT_EQ(run("sweep s.toml").code, 0) << slurp(dir / "stderr.txt");
  const auto log = [&](const std::string& point) { return lines(slurp(dir / "s" / "points" / point / "log.csv")); };
  const auto a = log("tubes-7_duration_ps-6"), b = log("tubes-7_duration_ps-8");
  ASSERT_GE(a.size(), 8u);
  ASSERT_GE(b.size(), a.size() + 2);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(a[k], b[k]);
  // It ends where a run of its own ends, bit for bit.
  spit(dir / "alone.toml", slurp(dir / "s" / "points" / "tubes-7_duration_ps-8" / "scene.toml"));
  ASSERT_EQ(run("run alone.toml --out alone --quiet").code, 0);
  EXPECT_EQ(slurp(dir / "alone" / "final.csv"),
            slurp(dir / "s" / "points" / "tubes-7_duration_ps-8" / "final.csv"));
  // Another time of the start makes other runs.
  std::string later = slurp(dir / "s.toml");
  later.replace(later.find("at_ps = 5"), 9, "at_ps = 4");
  spit(dir / "s.toml", later);
  const Outcome o = run("sweep s.toml");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("left its shared start at another time"), std::string::npos) << o.err;
  ASSERT_EQ(run("sweep s.toml --force").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_NEAR(
      std::stod(lines(slurp(dir / "s" / "starts" / "tubes-7" / "log.csv"))
                    .back()
                    .substr(lines(slurp(dir / "s" / "starts" / "tubes-7" / "log.csv")).back().find(',') + 1)),
      4, 0.1);
}

TEST_F(Campaign, FailedPointsAreNamedAndKept) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 13.56\n"
       "[twist]\napplication = \"tangential\"\nmoment_nN_nm = 1\nrate_nN_nm_per_ps = 50000\nhold_ps = 1\n");
  sweep_file("[vary]\ntwist.moment_nN_nm = [1, 20000]\n");
  const Outcome o = run("sweep s.toml");
  EXPECT_EQ(o.code, 3);
  EXPECT_NE(o.out.find("1 failed, 1 finished"), std::string::npos) << o.out;
  EXPECT_NE(o.err.find("ropewalk: not ended: moment_nN_nm-20000"), std::string::npos) << o.err;
  EXPECT_EQ(o.out.find("not ended"), std::string::npos) << o.out;
  EXPECT_NE(slurp(dir / "s" / "table.csv").find("moment_nN_nm-20000,20000,failed,"), std::string::npos);
  const auto written = fs::last_write_time(dir / "s" / "points" / "moment_nN_nm-20000" / "manifest.json");
  EXPECT_EQ(run("sweep s.toml").code, 3);
  EXPECT_EQ(fs::last_write_time(dir / "s" / "points" / "moment_nN_nm-20000" / "manifest.json"), written);
  EXPECT_EQ(run("sweep s.toml --again").code, 3);
  EXPECT_NE(fs::last_write_time(dir / "s" / "points" / "moment_nN_nm-20000" / "manifest.json"), written);
}

TEST_F(Campaign, RefusesWhatIsOfAnotherScene) {
  sweep_file("[vary]\nrope.tubes = [1]\nstart.seed = [1, 2]\n");
  ASSERT_EQ(run("sweep s.toml").code, 0);
  EXPECT_EQ(run("sweep s.toml").code, 0);
  spit(dir / "tube.toml", slurp(dir / "tube.toml") + "# changed\n");
  const Outcome o = run("sweep s.toml");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("was run with another scene"), std::string::npos) << o.err;
  EXPECT_EQ(run("sweep s.toml --force").code, 0);
  fs::create_directories(dir / "mine");
  spit(dir / "mine" / "thesis.txt", "mine");
  EXPECT_EQ(run("sweep s.toml --out mine --force").code, 2);
  EXPECT_EQ(slurp(dir / "mine" / "thesis.txt"), "mine");
  EXPECT_EQ(run("sweep s.toml --only 3").code, 2);
  EXPECT_EQ(run("sweep s.toml --only nobody").code, 2);
  EXPECT_EQ(run("gather mine").code, 2);
}

TEST_F(Campaign, RefusesAnotherStateFile) {
  sweep_file("[vary]\nrope.tubes = [1]\nstart.seed = [1, 2]\n");
  ASSERT_EQ(run("sweep s.toml").code, 0);
  fs::copy(dir / "s" / "points" / "seed-1" / "final.csv", dir / "begin.csv");
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[state]\nfile = \"begin.csv\"\n"
       "[run]\nduration_ps = 1\n");
  sweep_file("[vary]\ndamping.bond_damping_per_ps = [1, 2]\n");
  ASSERT_EQ(run("sweep s.toml --out from-state").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(run("sweep s.toml --out from-state").code, 0);
  fs::copy(dir / "s" / "points" / "seed-2" / "final.csv", dir / "begin.csv", fs::copy_options::overwrite_existing);
  const Outcome state = run("sweep s.toml --out from-state");
  EXPECT_EQ(state.code, 2);
  EXPECT_NE(state.err.find("another scene, parameter set or state file"), std::string::npos) << state.err;
  EXPECT_EQ(run("sweep s.toml --out from-state --force").code, 0);
}

TEST_F(Campaign, ClusterFilesRunEveryPoint) {
  sweep_file("[vary]\nrope.tubes = [1, 7]\n");
  ASSERT_EQ(run("sweep s.toml --slurm job.sh").code, 0);
  EXPECT_EQ(run("sweep s.toml --slurm job.sh").code, 2) << "it exists";
  const std::string job = slurp(dir / "job.sh");
  EXPECT_NE(job.find("#SBATCH --array=1-2"), std::string::npos) << job;
  for (const char* task : {"1", "2"})
    EXPECT_EQ(
        std::system(("cd / && SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh '" + (dir / "job.sh").string() + "'")
                        .c_str()),
        0)
        << slurp(dir / "s" / "messages" / ("slurm-" + std::string(task) + ".txt"));
  EXPECT_TRUE(fs::exists(dir / "s" / "points" / "tubes-7" / "report.html"));
  ASSERT_EQ(run("sweep s.toml --snakemake Snakefile").code, 0);
  EXPECT_NE(slurp(dir / "Snakefile").find("\"tubes-7\","), std::string::npos);
}

TEST_F(Campaign, PictureIsAFigureInThreeFormats) {
  spit(dir / "rope.toml", slurp(dir / "tube.toml"));
  std::string text = slurp(dir / "rope.toml");
  text.replace(text.find("tubes = 1"), 9, "tubes = 7");
  spit(dir / "rope.toml", text + "frames_every_ps = 2\n");
  ASSERT_EQ(run("run rope.toml --out d --quiet").code, 0);
  ASSERT_EQ(run("picture d -o a.svg --at 0,6,12 --sections --curves twist_eV+bend_eV,beta_deg").code, 0)
      << slurp(dir / "stderr.txt");
  const std::string svg = slurp(dir / "a.svg");
  for (const char* part :
       {">A</text>", ">C</text>", " ps, β", "class=\"section\"", "class=\"chart\"", " nm</text>"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(svg.find("var(--"), std::string::npos) << "few programs know variables";
  EXPECT_EQ(run("picture d -o a.svg").code, 2) << "it exists";
  EXPECT_NE(svg.find(">time (ps)<"), std::string::npos);
  ASSERT_EQ(run("picture d -o r.svg --curves torque_upper_nN_nm --x rotation_deg").code, 0);
  EXPECT_NE(slurp(dir / "r.svg").find(">rotation (deg)<"), std::string::npos) << slurp(dir / "r.svg");
  EXPECT_EQ(run("picture d -o a.png --from 30,20").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(slurp(dir / "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(run("picture d -o a.pdf --from z --at 12").code, 0);
  EXPECT_EQ(slurp(dir / "a.pdf").substr(0, 4), "%PDF");
  EXPECT_FALSE(fs::exists(dir / "a.pdf.svg"));
  for (const char* wrong : {"-o b.jpg", "-o b.svg --at 99", "-o b.svg --from left", "-o b.svg --curves nothing",
                            "-o b.svg --x nothing"})
    EXPECT_EQ(run(std::string("picture d ") + wrong).code, 2) << wrong;
  EXPECT_FALSE(fs::exists(dir / "b.svg"));
  EXPECT_EQ(svg.find("beyond "), std::string::npos) << "no limit was passed";
  spit(dir / "far.toml", text + "frames_every_ps = 2\n[limits]\ntwist_deg = 0.2\n");
  ASSERT_EQ(run("run far.toml --out far --quiet").code, 7) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("picture far -o far.svg --curves torque_nN_nm --x rotation_deg").code, 0);
  EXPECT_NE(slurp(dir / "far.svg").find(">torque (nN nm)<"), std::string::npos) << "of both ends";
  const std::string far = slurp(dir / "far.svg");
  for (const char* part : {">beyond twist_deg<", " beyond\" d="}) EXPECT_NE(far.find(part), std::string::npos) << part;
}

// A tube that is turned by an angle bears GJ angle/L: long tubes do not pass what short ones pass.
TEST_F(Campaign, ThresholdOfAFallingOutcome) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
       "[damping]\nbond_damping_per_ps = 4\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n"
       "about_z = { rotation_deg = [[0, 0], [60, 20]] }\n[run]\nduration_ps = 70\nlog_every_ps = 1\n");
  sweep_file(
      "[threshold]\nkey = \"rope.length_nm\"\nfrom = 7.1\nto = 37\ncolumn = \"torque_upper_nN_nm\"\nabove = 5.5\n"
      "accuracy = 0.05\n");
  const Outcome o = run("threshold s.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("note: runs pass below it\n"), std::string::npos) << o.out;
  const std::vector<std::string> rows = lines(slurp(dir / "s" / "thresholds.csv"));
  ASSERT_EQ(rows.size(), 2u);
  std::vector<std::string> cells;
  std::istringstream in(rows[1]);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  const double expected = 319.5 * (20 * 3.14159265358979 / 180) / 5.5;
  EXPECT_NEAR(std::stod(cells[4]), expected, 0.08 * expected) << rows[1];  // lengths go by elements
  EXPECT_GT(std::stod(cells[5]), 0.1);
  const std::vector<std::string> counts(cells.end() - 4, cells.end());
  EXPECT_EQ(counts, (std::vector<std::string>{"1", "0", "0", "0"})) << rows[1];
}

// The bonds of a warm rope stretch above the limit at no temperature of the range with three of four seeds: there
// is no mean threshold. Then a [[stop]] of the scene ends each run at 0.1 ps.
TEST_F(Campaign, ThresholdSaysWhichSeedsAndRunsAreNoAnswer) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 7\n"
       "[start]\ntemperature_K = 20\nmay_cool = true\n[run]\nduration_ps = 0.5\n");
  sweep_file(
      "replicates = 4\n[threshold]\nkey = \"start.temperature_K\"\nfrom = 10\nto = 20\ncolumn = \"stretch_eV\"\n"
      "above = 0.026\naccuracy = 0.05\n");
  const Outcome o = run("threshold s.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("not in the range"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("the same in all of the range with 3 of 4 seeds"), std::string::npos) << o.out;
  EXPECT_NE(lines(slurp(dir / "s" / "thresholds.csv"))[1].find(",4,nan,nan,"), std::string::npos);
  spit(dir / "tube.toml",
       slurp(dir / "tube.toml") + "[[stop]]\nwhen = \"above\"\ncolumn = \"time_ps\"\nvalue = 0.1\n");
  const Outcome stopped = run("threshold s.toml --out stopped");
  ASSERT_EQ(stopped.code, 0) << stopped.err;
  EXPECT_NE(stopped.out.find("ended by a [[stop]] of the scene before the column passed"), std::string::npos)
      << stopped.out;
  const std::string known = slurp(dir / "stopped" / "thresholds.csv");
  ASSERT_EQ(run("threshold s.toml --out again --known stopped/trials.csv").code, 0);
  EXPECT_EQ(slurp(dir / "again" / "thresholds.csv"), known);
}

TEST_F(Campaign, ThresholdIsThatOfTheFormula) {
  // The ends of a tube turn by ML/GJ: its rotation passes 20 degrees at a moment that the set gives.
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
       "[damping]\nbond_damping_per_ps = 4\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 0.3\nhold_ps = 3\n"
       "[run]\nlog_every_ps = 1\n");
  sweep_file(
      "replicates = 2\n[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 2\nto = 20\ncolumn = \"rotation_deg\"\n"
      "above = 20\naccuracy = 0.01\n[vary]\nrope.length_nm = [13.56, 20.34]\n");
  EXPECT_EQ(run("sweep s.toml").code, 2);
  const Outcome o = run("threshold s.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::vector<std::string> rows = lines(slurp(dir / "s" / "thresholds.csv"));
  ASSERT_EQ(rows.size(), 3u);
  // A bond turned by x bears GJ/a sin(x).
  for (const auto& [k, bonds] : {std::pair(1, 9), std::pair(2, 14)}) {
    std::vector<std::string> cells;
    std::istringstream in(rows[static_cast<std::size_t>(k)]);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    const double angle = 20 * 3.14159265358979 / 180 / bonds, expected = 319.5 / 1.356 * std::sin(angle);
    EXPECT_NEAR(std::stod(cells[5]), expected, 0.02 * expected) << rows[static_cast<std::size_t>(k)];
  }
  // Kept, and refused where the scene has changed.
  const auto written =
      fs::last_write_time(dir / "s" / "points" / "length_nm-13.56_seed-1" / "moment_nN_nm-20" / "log.csv");
  EXPECT_EQ(run("threshold s.toml").code, 0);
  EXPECT_EQ(fs::last_write_time(dir / "s" / "points" / "length_nm-13.56_seed-1" / "moment_nN_nm-20" / "log.csv"),
            written);
  EXPECT_NE(slurp(dir / "s" / "thresholds.html").find("by bisection"), std::string::npos);
  // Its trials are enough to go on from, here and elsewhere: one run more for each of four tubes.
  const auto runs_of = [&](const char* folder) {
    std::size_t runs = 0;
    if (fs::exists(dir / folder / "points"))
      for (const auto& entry : fs::recursive_directory_iterator(dir / folder / "points"))
        runs += entry.path().filename() == "manifest.json" ? 1 : 0;
    return runs;
  };
  const std::string before = slurp(dir / "s/thresholds.csv");
  ASSERT_EQ(run("threshold s.toml --out t --known s/trials.csv").code, 0);
  EXPECT_EQ(slurp(dir / "t/thresholds.csv"), before);
  EXPECT_EQ(runs_of("t"), 0u);
  // Rows of one scene that differ in what came of it.
  const std::string header = lines(slurp(dir / "s/trials.csv")).front();
  std::string row = lines(slurp(dir / "s/trials.csv")).back();
  const auto columns =
      std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(header.find(",passed,") + 1), ',');
  std::size_t at = 0;
  for (int k = 0; k < columns; ++k) at = row.find(',', at) + 1;
  row[at] = row[at] == '1' ? '0' : '1';
  spit(dir / "both.csv", slurp(dir / "s/trials.csv") + row + "\n");
  const Outcome both = run("threshold s.toml --out v --known both.csv");
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.err.find("differ in what came of it"), std::string::npos) << both.err;
  fs::remove_all(dir / "s/points");
  std::string finer = slurp(dir / "s.toml");
  finer.replace(finer.find("0.01"), 4, "0.005");
  spit(dir / "s.toml", finer);
  ASSERT_EQ(run("threshold s.toml").code, 0);
  EXPECT_EQ(runs_of("s"), 4u);
  EXPECT_EQ(lines(slurp(dir / "s/trials.csv")).size(), lines(slurp(dir / "t/trials.csv")).size() + 4);
  spit(dir / "tube.toml", slurp(dir / "tube.toml") + "# changed\n");
  EXPECT_EQ(run("threshold s.toml").code, 2);
  const std::string others = run("threshold s.toml --out t --force --known s/trials.csv").err;
  EXPECT_NE(others.find("trials in s/trials.csv are of other scenes"), std::string::npos) << others;
  EXPECT_GT(runs_of("t"), 8u);
  EXPECT_EQ(run("threshold s.toml --out u --known tube.toml").code, 2);
}

// Seven tubes under couples: the search begins where theory puts the threshold, and its table has both.
TEST_F(Campaign, ThresholdOfAHelixBeginsAtTheory) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 54.24\n"
       "perturbation_nm = 0.0005\n[start]\nwave_nm = 0.02\n[twist]\nmoment_nN_nm = 40\nrate_nN_nm_per_ps = 3\n"
       "hold_ps = 100\n[run]\nlog_every_ps = 1\n");
  sweep_file(
      "[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 20\nto = 150\nshape = \"helix\"\naccuracy = 0.05\n");
  const Outcome theory = run("threshold s.toml --out theory --theory");
  ASSERT_EQ(theory.code, 0) << theory.err;
  EXPECT_NE(theory.out.find("not run yet"), std::string::npos) << theory.out;
  EXPECT_NE(theory.out.find("0 runs,"), std::string::npos) << theory.out;
  EXPECT_NE(slurp(dir / "theory/thresholds.html").find("theory, in this time"), std::string::npos);
  const Outcome o = run("threshold s.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("none grows below 59.38"), std::string::npos) << o.out;
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  const std::vector<std::string> rows = lines(slurp(dir / "s" / "thresholds.csv"));
  ASSERT_EQ(rows.size(), 2u);
  const std::vector<std::string> names = cells_of(rows[0]), cells = cells_of(rows[1]);
  const auto number = [&](const char* name) {
    return std::stod(cells[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]);
  };
  EXPECT_NEAR(number("static_theory"), 8.986819 * 358.4 / 54.24, 1e-2);
  EXPECT_GT(number("by_bisection"), number("static_theory"));
  EXPECT_NEAR(number("by_bisection") / number("theory"), 1, 0.2);
  EXPECT_NEAR(number("winding"), 0.95, 0.15);
  EXPECT_NEAR(number("rate_over_theory"), 1, 0.5);
  const std::vector<std::string> trials = lines(slurp(dir / "s" / "trials.csv"));
  EXPECT_LT(trials.size(), 8u) << "a search from both ends takes nine runs";
  int helices = 0;
  for (const std::string& trial : trials) helices += trial.find(",helix,") != std::string::npos ? 1 : 0;
  EXPECT_GE(helices, 1);
  const std::string page = slurp(dir / "s" / "thresholds.html");
  EXPECT_NE(page.find("theory, in this time"), std::string::npos);
  // The states on both sides of the threshold, in pictures.
  EXPECT_NE(page.find(": helix, after"), std::string::npos);
  std::size_t pictures = 0;
  for (std::size_t at = page.find("data:image/svg"); at != std::string::npos;
       at = page.find("data:image/svg", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 2u);
}

// One point after another, as tasks of a cluster search them; the page of all of them takes no run more.
TEST_F(Campaign, ThresholdsPointByPoint) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
       "[damping]\nbond_damping_per_ps = 4\n[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 0.3\nhold_ps = 3\n"
       "[run]\nlog_every_ps = 1\n");
  sweep_file(
      "[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 2\nto = 20\ncolumn = \"rotation_deg\"\n"
      "above = 20\naccuracy = 0.1\n[vary]\nrope.length_nm = [13.56, 20.34]\n");
  ASSERT_EQ(run("threshold s.toml --slurm job.sh").code, 0);
  EXPECT_NE(slurp(dir / "job.sh").find(" threshold "), std::string::npos);
  EXPECT_FALSE(fs::exists(dir / "s"));
  spit(dir / "a b.csv", "");
  ASSERT_EQ(run("threshold s.toml --snakemake Snakefile --known \"a b.csv\"").code, 0);
  EXPECT_NE(slurp(dir / "Snakefile").find("threshold.csv"), std::string::npos);
  EXPECT_NE(slurp(dir / "Snakefile").find("a b.csv'"), std::string::npos) << slurp(dir / "Snakefile");
  EXPECT_EQ(run("threshold s.toml --only 3").code, 2);
  ASSERT_EQ(run("threshold s.toml --only 2").code, 0);
  const fs::path first = dir / "s/points/length_nm-13.56", second = dir / "s/points/length_nm-20.34";
  EXPECT_FALSE(fs::exists(first / "threshold.csv"));
  ASSERT_EQ(lines(slurp(second / "threshold.csv")).size(), 2u);
  ASSERT_EQ(run("threshold s.toml --only length_nm-13.56").code, 0);
  EXPECT_EQ(lines(slurp(first / "threshold.csv"))[1].rfind("13.56,1,", 0), 0u);
  const std::string trials = slurp(dir / "s/trials.csv"), table = slurp(dir / "s/thresholds.csv");
  const auto when = fs::last_write_time(second / "moment_nN_nm-20/log.csv");
  ASSERT_EQ(run("threshold s.toml").code, 0);
  EXPECT_EQ(slurp(dir / "s/trials.csv"), trials);
  EXPECT_EQ(slurp(dir / "s/thresholds.csv"), table);
  EXPECT_EQ(fs::last_write_time(second / "moment_nN_nm-20/log.csv"), when);
}

TEST_F(Campaign, ReplicatesThatAreOneRunAreSaid) {
  const std::string warm = slurp(dir / "tube.toml"), key = "coupling_per_ps = 0.5\n";
  std::string typed = warm, cold = warm;
  typed.insert(typed.find(key), "seed = 3\n");
  cold.erase(cold.find("[thermostat]"), cold.find("[damping]") - cold.find("[thermostat]"));
  sweep_file("replicates = 2\n[vary]\nrope.tubes = [1]\n");
  for (const auto& [scene, words] : {std::pair{typed, "the noise of the thermostat.seed that is typed"},
                                     std::pair{cold, "nothing in the scene is random"}, std::pair{warm, ""}}) {
    spit(dir / "tube.toml", scene);
    const Outcome o = run("sweep s.toml --dry-run");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err.find("note: replicates ") != std::string::npos, *words != 0) << o.err;
    EXPECT_NE(o.err.find(words), std::string::npos) << o.err;
  }
}

// The rows of a relaxation have no time: what counts is the last of each.
TEST_F(Campaign, RelaxationsAreComparedAtTheirEnds) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 1\nlength_nm = 13.56\n"
       "perturbation_nm = 0.05\n[run]\nmode = \"relax\"\n");
  sweep_file("replicates = 3\n[vary]\nrope.tubes = [1]\n");
  ASSERT_EQ(run("sweep s.toml").code, 0) << slurp(dir / "stderr.txt");
  double sum = 0;
  for (const char* seed : {"1", "2", "3"}) {
    const auto log = lines(slurp(dir / "s" / "points" / (std::string("seed-") + seed) / "log.csv"));
    sum += std::stod(log.back()) / 3;
  }
  ASSERT_EQ(run("compare s --csv c.csv --x step --y kinetic_eV").code, 0) << slurp(dir / "stderr.txt");
  const auto rows = lines(slurp(dir / "c.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(std::stod(rows[1].substr(rows[1].find(",3,") + 3)), sum, 0.1);
  const Outcome mean = run("gather s --mean 5");
  EXPECT_EQ(mean.code, 2);
  EXPECT_NE(mean.err.find("is the log of a relaxation"), std::string::npos) << mean.err;
  EXPECT_EQ(run("gather s").code, 0);
}

// `run` ends with exit code 7 there.
TEST_F(Campaign, PointsFarBeyondALimitAreNamed) {
  spit(dir / "tube.toml", slurp(dir / "tube.toml") + "[limits]\ntwist_deg = 3\n");
  sweep_file("[vary]\ngrip.1.about_z.rotation_deg = [3, 120]\ngrip.1.about_z.rate_deg_per_ps = [20]\n");
  const Outcome o = run("sweep s.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("far beyond a limit: rotation_deg-120, beyond twist_deg from "), std::string::npos) << o.out;
  EXPECT_EQ(o.out.find("far beyond a limit: rotation_deg-3 "), std::string::npos) << o.out;
}

TEST_F(Campaign, CompareDrawsRunsAndEnsembles) {
  sweep_file("replicates = 3\n[vary]\nrope.tubes = [1, 7]\n");
  const Outcome swept = run("sweep s.toml");
  ASSERT_EQ(swept.code, 0);
  EXPECT_EQ(swept.err.find("replicates"), std::string::npos) << swept.err;
  ASSERT_EQ(run("compare s --page page.html --x rotation_deg").code, 0) << slurp(dir / "stderr.txt");
  const std::string page = slurp(dir / "page.html");
  EXPECT_NE(page.find("The ends of 2 ensembles"), std::string::npos);
  EXPECT_NE(page.find("tubes = 7"), std::string::npos);
  EXPECT_NE(page.find("class=\"error"), std::string::npos);
  EXPECT_NE(page.find("Last states"), std::string::npos);
  EXPECT_EQ(run("compare s --page page.html").code, 2) << "it exists";
  ASSERT_EQ(run("compare s/points/tubes-1_seed-1 s/points/tubes-7_seed-1 --y stored_MJ_per_kg --level 0.5:measured "
                "--svg a.svg --csv a.csv")
                .code,
            0);
  EXPECT_NE(slurp(dir / "a.svg").find(">measured</text>"), std::string::npos);
  EXPECT_EQ(lines(slurp(dir / "a.csv")).size(), 1 + 2 * 13u);
  EXPECT_EQ(run("compare s --y nothing").code, 2);
  EXPECT_EQ(run("compare s --level x").code, 2);
  EXPECT_EQ(run("compare s cnt-10-10-tersoff").code, 2);
}

// Two lengths of tubes by two angles, two seeds of each, pulled until they part.
TEST_F(Campaign, TheStrengthOfRopesOfFiniteTubes) {
  spit(dir / "rope.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = "
       "40\ntube_length_nm = 12\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 2\n[start]\ntwist_deg_per_nm = "
       "0\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { strain = [[0, 0], [5, 0], [45, 0.02]] "
       "}\n[[links]]\nper_nm = 0.1\nstiffness_nN_per_nm = 100\nbreaks_at_nN = 3\n[run]\nlog_every_ps = 0.5\n");
  spit(dir / "s.toml",
       "format = \"ropewalk-sweep-1\"\nscene = \"rope.toml\"\nreplicates = 2\n[vary]\nstart.twist_deg_per_nm = "
       "[0, 2]\nrope.tube_length_nm = [10, 20]\n");
  ASSERT_EQ(run("sweep s.toml --quiet").code, 0) << slurp(dir / "stderr.txt");
  ASSERT_EQ(run("compare s --tensile --csv t.csv --svg t.svg").code, 0) << slurp(dir / "stderr.txt");
  CsvReader csv((dir / "t.csv").string());
  ASSERT_TRUE(csv.next());
  const std::vector<std::string> names(csv.cells().begin(), csv.cells().end());
  const auto number = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return csv.number(static_cast<std::size_t>(at - names.begin()), name);
  };
  std::vector<double> angles;
  while (csv.next()) {
    EXPECT_EQ(number("replicates"), 2);
    EXPECT_GT(number("strength_GPa"), number("strength_GPa_standard_error"));
    EXPECT_GT(number("links_broken"), 0);
    EXPECT_GT(number("toughness_MJ_per_m3"), 0);
    angles.push_back(number("beta_deg"));
  }
  ASSERT_EQ(angles.size(), 4u);
  EXPECT_LT(angles[0], 1);
  EXPECT_GT(angles[3], 2);
  const std::string svg = slurp(dir / "t.svg");
  for (const char* words : {">10<", ">20<", "cos²", "strength (GPa)"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  ASSERT_EQ(run("compare s --tensile --page t.html").code, 0) << slurp(dir / "stderr.txt");
  const std::string page = slurp(dir / "t.html");
  for (const char* words :  // names of columns may break behind each underscore
       {"Strength against", "Lines: tube_length_nm.", "toughness_<wbr/>J_<wbr/>per_<wbr/>g", "stress against strain"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(run("compare s --tensile --y beta_deg --force").code, 2);
  spit(dir / "still.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = "
       "4\n[run]\nduration_ps = 0.1\n");
  ASSERT_EQ(run("run still.toml --out still --quiet").code, 0);
  const auto still = run("compare still --tensile --csv still.csv");
  EXPECT_EQ(still.code, 2);
  EXPECT_NE(still.err.find("nothing pulls in it"), std::string::npos) << still.err;
  // The largest stress of a run that still goes on is not its strength.
  ASSERT_EQ(run("run rope.toml --out half --until 20 --quiet").code, 0);
  EXPECT_EQ(slurp(dir / "half/report.html").find("Tension along the tubes"), std::string::npos)
      << "tubes of several lengths have no common place along the rope";
  std::string manifest = slurp(dir / "half/manifest.json");
  const std::string finished = "\"finished\"";
  ASSERT_NE(manifest.find(finished), std::string::npos) << manifest;
  spit(dir / "half/manifest.json", manifest.replace(manifest.find(finished), finished.size(), "\"interrupted\""));
  const auto half = run("compare half --tensile --csv half.csv");
  EXPECT_EQ(half.code, 2);
  EXPECT_NE(half.err.find("has no run that has ended"), std::string::npos) << half.err;
  const auto both = run("compare half s --tensile --csv both.csv");
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_NE(both.err.find("runs have not come to their end"), std::string::npos) << both.err << both.out;
}

// Seven tubes, from both sides; the same command goes on, and a longer hold asks for another directory.
TEST_F(Campaign, RestComesFromBothSides) {
  const auto scene = [&](const char* hold) {
    spit(dir / "rope.toml",
         std::string("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\n"
                     "length_nm = 20.34\n[twist]\nmoment_nN_nm = 35\nrate_nN_nm_per_ps = 1\nhold_ps = ") +
             hold + "\n");
  };
  scene("10");
  const Outcome early = run("rest rope.toml --quiet");
  ASSERT_EQ(early.code, 0) << early.err;
  EXPECT_NE(early.out.find("Not at rest: in the last 9 ps"), std::string::npos) << early.out;
  scene("150");
  EXPECT_NE(run("rest rope.toml --quiet").code, 0) << "runs of another scene are there";
  const Outcome whole = run("rest rope.toml --quiet --out whole");
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_NE(whole.out.find("Rests compact"), std::string::npos) << whole.out;
  const Json found = Json::parse(run("rest rope.toml --quiet --out whole --json").out);
  EXPECT_EQ(found, Json::parse(slurp(dir / "whole" / "rest.json")));
  EXPECT_TRUE(found.at("agree").get<bool>());
  EXPECT_NEAR(found.at("geometric_twist_deg").get<double>(), 94.3, 0.2);
  // From a start apart, the same rest.
  EXPECT_NE(found.at("sides")[0].at("start_deg_per_nm"), found.at("sides")[1].at("start_deg_per_nm"));
  const Outcome no_rope = run("rest tube.toml");
  EXPECT_EQ(no_rope.code, 2);
  EXPECT_NE(no_rope.err.find("7 tubes or more"), std::string::npos) << no_rope.err;
}

// Both starts end in one state, which is stable and at rest to many digits. No run is made.
TEST_F(Campaign, StaticRestIsTheSameFromBothSides) {
  spit(dir / "rope.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 20.34\n"
       "[twist]\nmoment_nN_nm = 15\nrate_nN_nm_per_ps = 1\nhold_ps = 10\n");
  const Outcome o = run("rest rope.toml --static --out still --json");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  const Json found = Json::parse(o.out);
  EXPECT_EQ(found, Json::parse(slurp(dir / "still/static-rest.json")));
  // A command that was killed between its two files is given again; one whose files are there does nothing.
  fs::remove(dir / "still/static-rest.json");
  EXPECT_EQ(run("rest rope.toml --static --out still --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(run("rest rope.toml --static --out still --quiet").code, 2);
  ASSERT_EQ(found.at("states").size(), 2u) << o.out;
  const Json &below = found.at("states")[0], &above = found.at("states")[1];
  EXPECT_GT(below.at("geometric_twist_deg").get<double>(), 10);
  EXPECT_NEAR(below.at("geometric_twist_deg").get<double>() / above.at("geometric_twist_deg").get<double>(), 1,
              1e-3);
  for (const Json& state : found.at("states")) {
    EXPECT_EQ(state.at("stability"), "stable") << o.out;
    EXPECT_LT(state.at("force_eV_per_nm").get<double>(), 1e-4);
  }
  EXPECT_FALSE(fs::exists(dir / "still/points"));
  EXPECT_EQ(run("rest rope.toml --static --out still").code, 2) << "it is there";
  spit(dir / "warm.toml", slurp(dir / "rope.toml") +
                              "[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 0.1\n"
                              "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\n"
                              "bond_damping_per_ps = 0\n");
  EXPECT_NE(run("rest warm.toml --static").err.find("thermostat: keeps the rope warm"), std::string::npos);
}

// Far beyond what the bonds carry statics has no state, which ends no search of other points.
TEST_F(Campaign, StaticThresholdSaysWhereThereIsNoState) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 4\n"
       "perturbation_nm = 0.01\n[twist]\nmoment_nN_nm = 2\nrate_nN_nm_per_ps = 4\n");
  sweep_file("[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 1\nto = 40\ncolumn = \"beta_deg\"\nabove = 5\n");
  const Outcome o = run("threshold s.toml --static");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("note: no state of rest at "), std::string::npos) << o.out;
  const std::vector<std::string> rows = lines(slurp(dir / "s-static.csv"));
  ASSERT_EQ(rows.size(), 2u);
  const double threshold = std::stod(rows[1].substr(rows[1].find(',') + 1));
  EXPECT_GT(threshold, 5);   // the tubes bear this
  EXPECT_LT(threshold, 40);
}

// A tube with free ends under couples of fixed direction: 8.987 EI/L (A. G. Greenhill, 1883).
TEST_F(Campaign, StaticThresholdOfATubeIsGreenhills) {
  spit(dir / "tube.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 41\n"
       "[twist]\nmoment_nN_nm = 40\nrate_nN_nm_per_ps = 3\nhold_ps = 100\n");
  sweep_file("[threshold]\nkey = \"twist.moment_nN_nm\"\nfrom = 40\nto = 75\nshape = \"helix\"\naccuracy = 0.01\n");
  const Outcome o = run("threshold s.toml --static");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  const std::vector<std::string> rows = lines(slurp(dir / "s-static.csv"));
  ASSERT_EQ(rows.size(), 2u);
  std::istringstream cells(rows[1].substr(rows[1].find(',') + 1));
  double threshold = 0;
  cells >> threshold;
  EXPECT_NEAR(threshold / (8.9868 * 358.4 / (41 * 1.3564)), 1, 0.02) << o.out;
  EXPECT_NE(rows[1].find("sideways"), std::string::npos) << rows[1];
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
