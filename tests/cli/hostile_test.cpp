// Hostile scenes: none may crash, hang or give a wrong answer silently. Those that can be seen to fail beforehand
// are refused (exit code 2) and leave no run behind; the others end with the reason (3), do not come to rest (4),
// or go on for a good reason (0).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "cli/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

constexpr const char* rope = "[rope]\ntubes = 7\nlength_nm = 13.6\n";
constexpr const char* chain = "[chain]\nelements = 10\n";
constexpr const char* brief = "[run]\nduration_ps = 2\n";

struct Hostile {
  const char* name;
  std::string scene;  // below format and parameters
  int code;
  const char* says;
  const char* parameters = "cnt-10-10-tersoff";
};

void PrintTo(const Hostile& h, std::ostream* out) { *out << h.name; }

// A straight tube of 6 elements from `start`, with one quaternion for all.
std::string tube(int number, const char* start, double dx, double dz, const char* quaternion, int elements = 6) {
  double x = 0, y = 0, z = 0;
  std::sscanf(start, "%lf,%lf,%lf", &x, &y, &z);
  std::string text;
  for (int i = 0; i < elements; ++i)
    text += fmt::format("{},{},{},{},{}\n", number, x + 1.356 * dx * i, y, z + 1.356 * dz * i, quaternion);
  return text;
}

std::string state_file(const std::string& name) {
  const char *up = "1,0,0,0", *across = "0.70710678118654752,0,0.70710678118654752,0";
  std::string text = "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n";
  if (name == "coincident") return text + tube(0, "0,0,0", 0, 1, up) + tube(1, "0,0,0", 0, 1, up);
  if (name == "coaxial") return text + tube(0, "0,0,0", 0, 1, up) + tube(1, "0.05,0,0.5", 0, 1, up);
  if (name == "overlapping") return text + tube(0, "0,0,0", 0, 1, up) + tube(1, "0.4,0,0", 0, 1, up);
  if (name == "collinear") return text + tube(0, "0,0,0", 0, 1, up) + tube(1, "0,0,8.136", 0, 1, up);
  if (name == "crossed") return text + tube(0, "0,0,-3.39", 0, 1, up) + tube(1, "-3.39,0,0", 1, 0, across);
  if (name == "folded") return text + tube(0, "0,0,0", 0, 1, up, 3) + "0,0,0,1.356,1,0,0,0\n";
  if (name == "slipped")  // the upper half turned by 100 degrees about the tube
    return text + tube(0, "0,0,0", 0, 1, up, 3) +
           tube(0, "0,0,4.068", 0, 1, "0.6427876096865394,0,0,0.766044443118978", 3);
  if (name == "sideways") return text + tube(0, "0,0,0", 1, 0, up);
  if (name == "nan") return text + "0,nan,0,0,1,0,0,0\n0,0,0,1.356,1,0,0,0\n";
  if (name == "no-turn") return text + tube(0, "0,0,0", 0, 1, "0,0,0,0");
  return text + tube(0, "0,0,0", 0, 1, up) + tube(1, "1e12,0,0", 0, 1, up);  // far
}

std::string state(const char* name) { return fmt::format("[state]\nfile = \"{}.csv\"\n", name); }

const std::vector<Hostile> scenes = {
    {"StepTenTimesTheLimit", std::string(chain) + "[run]\nduration_ps = 5\ntime_step_fs = 200\n", 2,
     "not below the stability limit"},
    {"StepJustBeyond", std::string(rope) + "[run]\nduration_ps = 5\ntime_step_fs = 60\n", 2,
     "not below the stability limit"},
    {"StepAbsurd", std::string(chain) + "[run]\nduration_ps = 2e9\ntime_step_fs = 1e9\n", 2, "run.time_step_fs"},
    {"StepZero", std::string(chain) + "[run]\nduration_ps = 2\ntime_step_fs = 0\n", 2, "run.time_step_fs"},
    {"StepNotANumber", std::string(chain) + "[run]\nduration_ps = 2\ntime_step_fs = nan\n", 2, "run.time_step_fs"},
    {"StepsWithoutEnd", std::string(chain) + "[run]\nduration_ps = 2\ntime_step_fs = 1e-12\n", 2, "2e+15 steps"},
    {"ViscosityBeyondTheStep",
     std::string(rope) +
         "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 1e6\n[run]\nduration_ps = 2\ntime_step_fs = 10\n",
     2, "set by the strongest damping"},
    {"BondDampingHuge", std::string(chain) + "[damping]\nbond_damping_per_ps = 1e9\n" + brief, 2,
     "damping.bond_damping_per_ps"},
    {"TooHot", std::string(rope) + "[start]\ntemperature_K = 1e7\n" + brief, 2, "start.temperature_K"},
    {"ColderThanNothing", std::string(rope) + "[start]\ntemperature_K = -5\n" + brief, 2, "start.temperature_K"},
    {"CooledByDamping", std::string(rope) + "[start]\ntemperature_K = 300\n" + brief, 2,
     "start.temperature_K: is 300 K, and damping leaves"},
    {"CooledByLocalDamping",
     std::string(rope) + "[start]\ntemperature_K = 300\n[damping]\npfc_local = 0.1\n" + brief, 2,
     "damping leaves 0 % of that heat at the end of the run"},
    {"EndlesslyHot", std::string(rope) + "[start]\ntemperature_K = inf\n" + brief, 2, "start.temperature_K"},
    {"TubesInsideEachOther", "[rope]\ntubes = 7\nlength_nm = 13.6\nspacing_nm = 0.3\n" + std::string(brief), 2,
     "rope.spacing_nm"},
    {"NoSpacing", "[rope]\ntubes = 7\nlength_nm = 13.6\nspacing_nm = 0\n" + std::string(brief), 2,
     "rope.spacing_nm"},
    {"ShakenApart", "[rope]\ntubes = 7\nlength_nm = 13.6\nperturbation_nm = 2\n" + std::string(brief), 2,
     "rope.perturbation_nm"},
    {"TwistedBeyondWhatABondBears", std::string(chain) + "[twist]\nmoment_nN_nm = 5000\nrate_nN_nm_per_ps = 100\n",
     2, "before it slips, GJ/a = 239.6"},
    // At rest it would bear them, GJ/a being 239.6; at once 2/pi of that make it slip.
    {"TwistedBeyondTheCollapse", std::string(chain) + "[twist]\nmoment_nN_nm = 25\nrate_nN_nm_per_ps = 5\n", 2,
     "more than the tube bears, 20.24: its wall collapses"},
    {"TwistedUntilABondSlips",
     std::string(chain) + "[bond]\nlaw = \"harmonic\"\n[twist]\nmoment_nN_nm = 200\nrate_nN_nm_per_ps = 0\nhold_ps "
                          "= 5\n[run]\ntime_step_fs = 36.7\n",
     3, "cannot carry more torque"},
    {"TwistedAtOnce",
     std::string(rope) +
         "[bond]\nlaw = \"harmonic\"\n[twist]\napplication = \"tangential\"\nmoment_nN_nm = 2000\n"
         "rate_nN_nm_per_ps = 0\nhold_ps = 2\n[run]\ntime_step_fs = 30\n",
     3, "the motion blew up"},
    {"TwistedBeyondTheFirstStep",
     std::string(rope) + "[twist]\nmoment_nN_nm = 9000\nrate_nN_nm_per_ps = 0\nhold_ps = 2\n", 2,
     "more than a bond of 1.378 nm bears before it slips"},
    {"MomentNotANumber", std::string(rope) + "[twist]\nmoment_nN_nm = nan\nrate_nN_nm_per_ps = 1\n", 2,
     "twist.moment_nN_nm"},
    {"ForceHuge",
     std::string(chain) + "[[load]]\nkind = \"force\"\nelements = \"ends\"\nforce_nN = [1e9, 0, 0]\n" + brief, 2,
     "load.force_nN"},
    {"ForceEndless",
     std::string(chain) + "[[load]]\nkind = \"force\"\nelements = \"ends\"\nforce_nN = [inf, 0, 0]\n" + brief, 2,
     "load.force_nN"},
    {"PulledApart",
     std::string(chain) + "[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"force\"\nelements = [-1]\n"
                          "force_nN = [0, 0, 1100]\n[run]\nduration_ps = 50\ntime_step_fs = 36.7\n",
     3, "blew up"},
    {"PulledApartAtOnce",
     std::string(chain) + "[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"force\"\nelements = [-1]\n"
                          "force_nN = [0, 0, 5000]\n[run]\nduration_ps = 50\ntime_step_fs = 36.7\n",
     2, "the first step would move element 9 by 0.76"},
    {"TurnedTooFast",
     std::string(rope) +
         "[[load]]\nkind = \"rotate\"\nelements = \"ends\"\nrate_deg_per_ps = 1e6\nangle_deg = 1e7\n" + brief,
     2, "load.rate_deg_per_ps"},
    {"ElementsTiny", "element_length_nm = 0.001\n" + std::string(chain) + brief, 2, "element_length_nm"},
    {"ElementsHuge", "element_length_nm = 1e6\n" + std::string(chain) + brief, 2, "element_length_nm"},
    {"ElementsLong", "element_length_nm = 10\n" + std::string(chain) + brief, 0, "% off there. Take shorter elements"},
    {"OneElement", "[chain]\nelements = 1\n" + std::string(brief), 2, "chain.elements"},
    {"TooManyElements", "[chain]\nelements = 2000000000\n" + std::string(brief), 2, "chain.elements"},
    {"EightTubes", "[rope]\ntubes = 8\nlength_nm = 13.6\n" + std::string(brief), 2, "the nearest are 7 and 19"},
    {"OneNode", std::string(rope) + "[contact]\nnodes_per_element = 1\n" + brief, 0,
     "5 would keep the corrugation"},
    {"TooManyNodes", std::string(rope) + "[contact]\nnodes_per_element = 100000\n" + brief, 2,
     "contact.nodes_per_element"},
    {"SkinNegative", std::string(rope) + "[contact]\nskin_nm = -1\n" + brief, 2, "contact.skin_nm"},
    {"SkinHuge", std::string(rope) + "[contact]\nskin_nm = 1e9\n" + brief, 2, "contact.skin_nm"},
    {"SkinTiny",
     std::string(rope) + "[contact]\nskin_nm = 1e-9\n[start]\ntemperature_K = 300\nmay_cool = true\n" + brief, 0,
     ""},
    {"TwoSources", std::string(rope) + chain + brief, 2, "exactly one of"},
    {"NoSource", brief, 2, "there is nothing in the scene"},
    {"Coincident", state("coincident") + brief, 2, "tubes 0 and 1 lie inside of one another"},
    {"CoaxialWalls", state("coaxial") + brief, 2, "walls of multi-walled tubes are not supported"},
    {"CoaxialWallsRelaxed", state("coaxial") + "[run]\nmode = \"relax\"\n", 2, "lie inside of one another"},
    {"CollinearAndTouching", state("collinear") + brief, 2, "elements 4 and 6 overlap"},
    {"CrossedThroughEachOther", state("crossed") + brief, 2, "overlap: their axes are"},
    {"BeyondTheSlipAtTheStart", state("slipped") + brief, 2, "the bond after element 2 is twisted by 90 degrees"},
    {"FoldedBack", state("folded") + brief, 2, "folds back"},
    {"AxesAcrossTheTube", state("sideways") + brief, 2, "folds back"},
    {"PlaceNotANumber", state("nan") + brief, 2, "x_nm"},
    {"NoOrientation", state("no-turn") + brief, 2, "the quaternion has length 0"},
    {"FarAway", state("far") + brief, 2, "x_nm"},
    {"RelaxedFromWithin", state("overlapping") + "[run]\nmode = \"relax\"\nmax_steps = 50\n", 4, "not relaxed"},
    {"TornByARelaxation",
     std::string(chain) + "[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"force\"\nelements = [-1]\n"
                          "force_nN = [0, 0, 5000]\n[run]\nmode = \"relax\"\n",
     3, "the relaxation blew up"},
    {"RelaxedUnderAPull",
     std::string(chain) + "[[load]]\nkind = \"force\"\nelements = [0]\nforce_nN = [0.1, 0, 0]\n"
                          "[run]\nmode = \"relax\"\nmax_steps = 500\n",
     4, "not relaxed"},
    {"PaperLawInsideEachOther", "[rope]\ntubes = 7\nlength_nm = 13.56\nspacing_nm = 0.5\n" + std::string(brief), 2,
     "rope.spacing_nm", "cnt-10-10-paper"},
    {"PaperLawCrossed", state("crossed") + brief, 2, "overlap", "cnt-10-10-paper"},
    {"PaperLawCollinear", state("collinear") + brief, 2, "overlap", "cnt-10-10-paper"},
};

class HostileScenes : public test::Cli, public ::testing::WithParamInterface<Hostile> {
 protected:
  // Names of parametrised tests have a slash.
  void SetUp() override {
    dir = test::fs::temp_directory_path() / fmt::format("ropewalk-hostile-{}-{}", GetParam().name, getpid());
    test::fs::create_directories(dir);
  }
};

TEST_P(HostileScenes, EndWithOneClearLine) {
  const Hostile& h = GetParam();
  for (const char* name : {"coincident", "coaxial", "overlapping", "collinear", "crossed", "folded", "slipped",
                           "sideways", "nan", "no-turn", "far"})
    test::spit(dir / fmt::format("{}.csv", name), state_file(name));
  test::spit(dir / "scene.toml",
             fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n{}", h.parameters, h.scene));
  const test::Outcome o = run("run scene.toml --out out --quiet", "timeout 60");
  EXPECT_EQ(o.code, h.code) << o.err;
  EXPECT_THAT(o.out + o.err, HasSubstr(h.says));
  if (h.code == 0) return;
  // Before its error a run may print other lines: limits that it may pass or has passed, and shorter steps that it tried.
  const auto is_news = [](const std::string& text) {
    return text.rfind("ropewalk: limit passed", 0) == 0 || text.rfind("ropewalk: note: The load may", 0) == 0 ||
           text.find(", on with steps of ") != std::string::npos;
  };
  std::string line;
  std::istringstream lines(o.err);
  for (std::string text; std::getline(lines, text);)
    if (!text.empty() && !is_news(text)) line += text + "\n";
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << o.err;
  EXPECT_EQ(line.rfind("ropewalk: ", 0), 0u) << o.err;
  EXPECT_EQ(test::fs::exists(dir / "out"), h.code > 2) << "a refused scene leaves nothing behind";
}

INSTANTIATE_TEST_SUITE_P(Scenes, HostileScenes, ::testing::ValuesIn(scenes),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
