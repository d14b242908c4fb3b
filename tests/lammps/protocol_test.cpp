// Grips, dampings and relaxation in LAMMPS against the simulator; restart files; plugin; `clear`.
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "io/log.hpp"
#include "lammps/model.hpp"
#include "lammps/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

// In double precision, as LAMMPS has it.
std::string rope(std::string tables, const std::string& run = "duration_ps = 100\n") {
  const std::string title = "[contact]\n", precision = "precision = \"double\"\n";
  const std::size_t at = tables.find(title);
  tables = at == std::string::npos ? title + precision + tables : tables.insert(at + title.size(), precision);
  return "format = \"ropewalk-scene-1\"\nname = \"rope\"\nparameters = \"cnt-10-10-paper\"\n"
         "[rope]\ntubes = 7\nlength_nm = 16.3\nperturbation_nm = 0.01\n" +
         tables + "[run]\n" + run;
}

struct Protocol {
  const char* name;
  std::string tables;
  double tolerance = 1e-11;
};

const std::vector<Protocol>& protocols() {
  static const std::vector<Protocol> all = {
      {"PerTube", "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\n"},
      {"Total", "[twist]\nmoment_nN_nm = 60\nrate_nN_nm_per_ps = 100\nreading = \"total\"\n"},
      {"Tangential", "[twist]\nmoment_nN_nm = 10\nrate_nN_nm_per_ps = 30\napplication = \"tangential\"\n"},
      {"Follower",
       "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\napplication = \"follower\"\n"
       "[start]\ntemperature_K = 100\nmay_cool = true\n"},
      {"Conservative",
       "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\napplication = \"conservative\"\n"
       "[start]\ntemperature_K = 100\nmay_cool = true\n"},
      {"Held",
       "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\nlateral = \"held\"\naxial = \"held\"\n"
       "[start]\ntemperature_K = 100\nmay_cool = true\n"},
      // It acts by the sign of a velocity, which rounding turns where the velocity is nothing.
      {"LocalDamping",
       "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\n[damping]\npfc_local = 0.3\n"
       "contact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n",
       1e-6},
      // A disc that turns and pulls, and clamps for each tube in which they spin and tilt. LAMMPS solves for the
      // impulses of a clamp in another order.
      {"Grips",
       "[[grip]]\nend = \"lower\"\nspin_free = true\ntilt_free = true\nas = \"each\"\n"
       "[[grip]]\nend = \"upper\"\nz = { force_nN = 5 }\nabout_x = \"free\"\n"
       "about_z = { rotation_deg = [[0, 0], [1, 3], [2, 0]] }\nsmooth_ps = 0.5\n",
       1e-9},
      // Clamps that reach half of a tube, so that some have elements on two ranks.
      {"DeepGrips",
       "[[grip]]\nend = \"lower\"\nelements = 6\nas = \"each\"\nslide_free = true\nabout_x = \"free\"\n"
       "[[grip]]\nend = \"upper\"\nelements = 5\nz = { force_nN = 5 }\nabout_z = { torque_nN_nm = 30 }\n",
       1e-9},
      // Spins of all tubes, which are cut into parts, and their increments.
      {"GeometricTwist",
       "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\ngeometric_only = true\nincrement_ps = 0.2\n"
       "[start]\ntemperature_K = 100\nmay_cool = true\n",
       1e-10},
      {"LegacyTorque",
       "[start]\ntemperature_K = 100\nmay_cool = true\n[contact]\nlaw = \"paper\"\nlegacy_torque = true\n"},
      // A bath that warms, with clamps whose constrained components it must leave alone.
      {"Thermostat",
       "[[grip]]\nend = \"lower\"\nas = \"each\"\n[[grip]]\nend = \"upper\"\nz = { force_nN = 5 }\n"
       "about_z = { torque_nN_nm = 30 }\n[start]\ntemperature_K = 200\n"
       "[thermostat]\ntemperature_K = [[0, 200], [2, 300]]\ncoupling_per_ps = 2\nseed = 5\n"
       "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n",
       1e-9},
      {"NoContact",
       "[start]\ntemperature_K = 100\nmay_cool = true\n[contact]\nlaw = \"none\"\n"
       "[[load]]\nkind = \"fix\"\nelements = [0]\n"},
      // A bath and a tether without contact, which both act through the engine.
      {"BathWithoutContact",
       "[contact]\nlaw = \"none\"\n[start]\ntemperature_K = 200\n[thermostat]\ntemperature_K = 300\n"
       "coupling_per_ps = 2\nseed = 5\n[damping]\nbond_damping_per_ps = 0\n"
       "[[tether]]\ntube = 1\nelements = [0]\nto_tube = 4\nto_elements = [-1]\nstiffness_nN_per_nm = 0.2\n"
       "rest_nm = 10\n[[load]]\nkind = \"fix\"\nelements = [0]\n",
       1e-9}};
  return all;
}

class ProtocolTest : public Lammps {};

TEST_F(ProtocolTest, HundredStepsAgree) {
  constexpr int steps = 100;
  const std::vector<std::string> variables = {"steps " + std::to_string(steps)};
  const std::string across = "processors 1 1 *", along = "processors * 1 1";
  std::vector<Part> one, three;
  for (const Protocol& p : protocols()) {
    const std::string name = p.name;
    exported(rope(p.tables), name + "-1");
    one.push_back({name + "-1", variables});
    three.push_back({copied(name + "-1", name + "-3"), variables});
    three.push_back({copied(name + "-1", name + "-3-along"), variables});
    edit(name + "-3-along", across, along);  // so that all of them have a part of each grip
  }
  for (const auto& [ranks, parts] : {std::pair{1, one}, {3, three}}) {
    const Outcome o = lmp_each(ranks, parts);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
  }
  for (const Protocol& p : protocols()) {
    spit(dir / "scene.toml", rope(p.tables));
    Scene scene = read_scene((dir / "scene.toml").string());
    Simulation native = start(scene, prepare(scene));
    for (int k = 0; k < steps; ++k) native.step();
    for (const char* way : {"-1", "-3", "-3-along"}) {
      SCOPED_TRACE(p.name + std::string(way));
      const std::string out = (dir / (p.name + std::string(way))).string();
      const Left left = left_by(out, native.topology());
      ASSERT_EQ(left.state.step, steps);
      EXPECT_LT(relative_difference(native.state().position, left.state.position), 1e-11);
      EXPECT_LT(relative_difference(native.state().velocity, left.state.velocity), p.tolerance);
      EXPECT_LT(relative_difference(native.state().angular_velocity, left.state.angular_velocity), p.tolerance);
      const LammpsRow row = read_lammps_rows(LammpsDirectory{out}).back();
      EXPECT_NEAR(row.work, native.work(), p.tolerance * std::fmax(1, native.work()));
      EXPECT_NEAR(row.dissipated, native.dissipated(), p.tolerance * std::fmax(1, native.dissipated()));
      EXPECT_NEAR(row.heat, native.heat(), p.tolerance * std::fmax(1, native.heat()));
      EXPECT_GT(std::fabs(native.work()) + std::fabs(native.dissipated()) + std::fabs(native.heat()), 1e-3);
      if (p.name == std::string("Thermostat") || p.name == std::string("BathWithoutContact")) {
        EXPECT_GT(std::fabs(native.heat()), 1);
      }
    }
  }
}

class LammpsRun : public Lammps {
 protected:
  // Makes `steps` steps in LAMMPS, in the folder out-RANKS for each number of ranks, and here. `half`: a run of
  // half of the steps, that is to go on, is in half-RANKS.
  void expect_equal_steps(const std::string& scene_text, int steps, double tolerance,
                          const std::function<void()>& edit_script = {}, bool half = false) const {
    exported(scene_text, "out");
    if (edit_script) edit_script();
    Scene scene = read_scene((dir / "scene.toml").string());
    Simulation native = start(scene, prepare(scene));
    const State before = native.state();
    native.steps(steps);
    ASSERT_GT(relative_difference(native.state().position, before.position), 1e-5);  // it has moved
    for (const int n : {1, 2, 4}) {
      SCOPED_TRACE(n);
      const std::string of_ranks = "-" + std::to_string(n);
      std::vector<Part> parts = {{copied("out", "out" + of_ranks), {"steps " + std::to_string(steps)}}};
      if (half) parts.push_back({copied("out", "half" + of_ranks), {"steps " + std::to_string(steps / 2)}});
      const Outcome o = lmp_each(n, parts);
      ASSERT_EQ(o.code, 0) << o.out << o.err;
      const std::string out = (dir / parts.front().folder).string();
      const Left left = left_by(out, native.topology());
      EXPECT_LT(relative_difference(native.state().position, left.state.position), tolerance);
      EXPECT_LT(relative_difference(native.state().velocity, left.state.velocity), tolerance);
      EXPECT_LT(relative_difference(native.state().angular_velocity, left.state.angular_velocity), tolerance);
      const LammpsRow row = read_lammps_rows(LammpsDirectory{out}).back();
      const Energies& e = native.forces().energy;
      const double scale = std::fabs(e.vdw) + e.bonds();
      EXPECT_NEAR(row.stretch + row.shear + row.bend + row.twist, e.bonds(), tolerance * scale);
      EXPECT_NEAR(row.vdw, e.vdw, tolerance * scale);
      EXPECT_NEAR(row.work, native.work(), tolerance * scale);
      EXPECT_NEAR(row.dissipated, native.dissipated(), tolerance * scale);
    }
  }
};

std::string line_scene(const std::string& precision, const std::string& source, const std::string& rest) {
  return "format = \"ropewalk-scene-1\"\nname = \"line\"\nparameters = \"cnt-10-10-tersoff\"\n" + source +
         "[contact]\nlaw = \"line\"\nprecision = \"" + precision + "\"\n" + rest + "[run]\nduration_ps = 1000\n";
}

const char* const small_rope = "[rope]\ntubes = 19\nlength_nm = 40\nperturbation_nm = 0.01\n";
const char* const hot_twist =
    "[twist]\nmoment_nN_nm = 8\nrate_nN_nm_per_ps = 3\n[start]\ntemperature_K = 300\nmay_cool = true\n";

// Lists are built many times, and elements go from rank to rank.
TEST_F(LammpsRun, ARopeTwistsAsHereOnEveryNumberOfRanks) {
  expect_equal_steps(line_scene("double", small_rope, hot_twist), 300, 1e-10);
}

// Tubes that end inside of a rope, in line, under a bath: ends meet within a rank and across ranks.
TEST_F(LammpsRun, FiniteTubesMeetAsHere) {
  const std::string scene_text =
      line_scene("double", "[rope]\ntubes = 7\nlength_nm = 60\ntube_length_nm = 15\nperturbation_nm = 0.01\n",
                 "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { force_nN = 1 }\n"
                 "[start]\ntemperature_K = 300\n[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 1\n"
                 "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n");
  expect_equal_steps(scene_text, 200, 1e-9);
  Scene scene = read_scene((dir / "scene.toml").string());
  Simulation native = start(scene, prepare(scene));
  native.steps(200);
  const double energy = native.forces().term_energy.at(0);
  EXPECT_LT(energy, -0.1);
  for (const int n : {1, 2, 4}) {
    const std::string out = (dir / ("out-" + std::to_string(n))).string();
    EXPECT_NEAR(read_lammps_rows(LammpsDirectory{out}, 1).back().terms.at(0), energy, 1e-7 * -energy) << n;
  }
  ASSERT_EQ(run("import out-2").code, 0);
  EXPECT_NEAR(read_log((dir / "out-2/log.csv").string()).back()["ends_eV"], energy, 1e-7 * -energy);
}

// A slice that is wound and stretched: its images follow elements that other ranks have.
TEST_F(LammpsRun, TheImagesOfASliceFollowAsHere) {
  expect_equal_steps(line_scene("double", small_rope,
                                "[periodic]\ntwist_deg_per_nm = [[0, 0.2], [3, 1.5]]\nstrain = [[0, 0], [4, 0.02]]\n"
                                "[start]\ntemperature_K = 200\nmay_cool = true\n"),
                     200, 1e-10);
  const Outcome here = run("run scene.toml --out here --steps 200 --quiet");
  ASSERT_EQ(run("import out-2").code, 0) << slurp(dir / "stderr.txt");
  const LogRow a = read_log((dir / "here/log.csv").string()).back();
  const LogRow b = read_log((dir / "out-2/log.csv").string()).back();
  ASSERT_EQ(a["step"], b["step"]) << here.err;
  for (const char* name : {"stored_MJ_per_kg", "ends_apart_nm", "vdw_eV"})
    EXPECT_NEAR(a[name], b[name], 1e-9 * std::fmax(1, std::fabs(a[name]))) << name;
}

// Tethers within a rank and across ranks, one of which breaks on the way; then a run that goes on remembers it.
TEST_F(LammpsRun, TethersHoldAndBreakAsHere) {
  const std::string
      tethers =
          "[[tether]]\ntube = 1\nelements = [0]\nto_tube = 8\nto_elements = [-1]\nstiffness_nN_per_nm = "
          "0.2\nrest_nm = 30\n"
          "[[tether]]\ntube = 3\nelements = [2]\nto_tube = 5\nto_elements = [2]\nstiffness_nN_per_nm = 2\nrest_nm "
          "= 1\n"
          "[[tether]]\ntube = 7\nelements = [-1]\nto_point_nm = [9, 0, 20]\nstiffness_nN_per_nm = 4\n"
          "breaks_at_nm = 6.9\n[[load]]\nkind = \"force\"\ntubes = [7]\nelements = [-1]\nforce_nN = [-15, 0, 0]\n",
      cold = "[start]\ntemperature_K = 100\nmay_cool = true\n";
  const std::string scene_text = line_scene("double", small_rope, tethers + cold);
  expect_equal_steps(scene_text, 300, 1e-10, {}, true);
  Scene scene = read_scene((dir / "scene.toml").string());
  Simulation native = start(scene, prepare(scene));
  native.steps(300);
  const std::vector<double>& energy = native.forces().term_energy;
  ASSERT_EQ(energy.size(), 3u);
  EXPECT_GT(energy[0], 10);
  EXPECT_GT(energy[1], 10);
  EXPECT_EQ(energy[2], 0) << "it has broken";
  for (const int n : {1, 2, 4}) {
    SCOPED_TRACE(n);
    const std::string half = "half-" + std::to_string(n);
    ASSERT_EQ(lmp(n, half, "-in in.rope -var from lammps.states -var steps 300").code, 0);
    const LammpsRow row = read_lammps_rows(LammpsDirectory{(dir / half).string()}, 3).back();
    EXPECT_EQ(row.step, 300);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(row.terms[k], energy[k], 1e-9 * (1 + energy[k])) << k;
    EXPECT_NEAR(row.dissipated, native.dissipated(), 1e-9 * native.dissipated());
    ASSERT_EQ(run("import " + half).code, 0);
    EXPECT_EQ(read_log((dir / half / "log.csv").string()).back()["tether_eV"],
              row.terms[0] + row.terms[1] + row.terms[2]);
  }
}

// Contacts across ranks, tubes that slide over several elements, and a run that goes on.
TEST_F(LammpsRun, FrictionSlidesAsHere) {
  const std::string scene_text =
      line_scene("double", small_rope,
                 "[[friction]]\nstrength_pN_per_nm = 20\nspin_strength_pN_per_nm = 30\nend_strength_pN = "
                 "5\nelastic_slip_nm = 0.005\ndrag_eV_ps_per_nm3 = 0.02\n"
                 "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\nforce_nN = [0, 0, 0.4]\n"
                 "[start]\ntemperature_K = 100\nmay_cool = true\n");
  expect_equal_steps(scene_text, 300, 1e-9, {}, true);
  Scene scene = read_scene((dir / "scene.toml").string());
  Simulation native = start(scene, prepare(scene));
  native.steps(300);
  const double energy = native.forces().term_energy.at(0);
  const TermAccount account = native.term_accounts().at(0);
  EXPECT_GT(energy, 1e-3);
  EXPECT_GT(account.lost, 0.01);
  EXPECT_GT(account.drag, 1e-3);
  EXPECT_GT(account.events, 10);
  for (const int n : {1, 2, 4}) {
    SCOPED_TRACE(n);
    const std::string half = "half-" + std::to_string(n);
    ASSERT_EQ(lmp(n, half, "-in in.rope -var from lammps.states -var steps 300").code, 0);
    const LammpsRow row = read_lammps_rows(LammpsDirectory{(dir / half).string()}, 1).back();
    EXPECT_NEAR(row.terms[0], energy, 1e-8 * energy);
    EXPECT_NEAR(row.dissipated, native.dissipated(), 1e-8 * native.dissipated());
    EXPECT_NEAR(row.accounts[0].lost, account.lost, 1e-8 * account.lost);
    EXPECT_NEAR(row.accounts[0].drag, account.drag, 1e-8 * account.drag);
    EXPECT_NEAR(row.accounts[0].events, account.events, 1 + 0.01 * account.events) << "rounding decides some";
    ASSERT_EQ(run("import " + half).code, 0);
    const LogRow imported = read_log((dir / half / "log.csv").string()).back();
    EXPECT_EQ(imported["friction_slip_eV"], row.accounts[0].lost);
    EXPECT_EQ(imported["friction_slips"], row.accounts[0].events);
  }
}

// Tubes that begin apart: they meet between two lists, on ranks as here, also where both elements are copies of others.
TEST_F(LammpsRun, FrictionBeginsWhereTubesMeet) {
  constexpr int steps = 30;
  const std::string scene_text =
      line_scene("double", "[rope]\ntubes = 19\nlength_nm = 20\nspacing_nm = 1.84\n",
                 "[[friction]]\nstrength_pN_per_nm = 20\nspin_strength_pN_per_nm = 30\nelastic_slip_nm = 0.005\n"
                 "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"all\"\nforce_nN = [0, 0, 0.4]\n"
                 "[start]\ntemperature_K = 100\nmay_cool = true\n[limits]\npress_nm = 0.2\n");
  expect_equal_steps(scene_text, steps, 1e-9);
  Scene scene = read_scene((dir / "scene.toml").string());
  Simulation native = start(scene, prepare(scene));
  native.step();
  EXPECT_EQ(native.forces().term_energy.at(0), 0) << "no tubes have met";
  const long lists = native.list().builds();
  while (native.state().step < steps && native.forces().term_energy.at(0) == 0) native.step();
  EXPECT_EQ(native.list().builds(), lists) << "they met between two lists";
  native.steps(steps - native.state().step);
  const double energy = native.forces().term_energy.at(0);
  EXPECT_GT(energy, 1e-4);
  for (const int n : {1, 2, 4}) {
    const std::string out = (dir / ("out-" + std::to_string(n))).string();
    EXPECT_NEAR(read_lammps_rows(LammpsDirectory{out}, 1).back().terms.at(0), energy, 1e-8 * energy) << n;
  }
}

// What has happened in a run, as its events.csv has it: times apart, which are sums of steps here and products there.
struct Happened {
  std::vector<double> times;
  std::string what;
};
Happened happened(const std::string& events) {
  Happened all;
  std::istringstream lines(events);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(','), places = line.find(',', line.find(',', comma + 1) + 1);
    if (line.rfind("time", 0) == 0) continue;
    all.times.push_back(std::stod(line));
    std::size_t end = comma;  // behind event, tube, element, to_tube and to_element
    for (int k = 0; k < 5; ++k) end = line.find(',', end + 1);
    EXPECT_NE(places, std::string::npos);
    all.what += line.substr(comma, end - comma) + "\n";
  }
  return all;
}

class LammpsEvents : public LammpsRun {
 protected:
  // 200 steps here and on each number of ranks, then there and back: the same motion, account, columns and events in
  // one order. Half of the steps, cut off and gone on with, give no event twice. `least`: of each.
  void expect_equal_events(const std::string& scene_text, const std::vector<std::pair<std::string, int>>& least,
                           const std::function<void()>& edit_script = {}) {
    constexpr int steps = 200;
    constexpr double tolerance = 1e-10;
    exported(scene_text, "out");
    if (edit_script) edit_script();
    ASSERT_EQ(run("run scene.toml --out here --quiet --steps " + std::to_string(steps)).code, 0);
    const Happened here = happened(slurp(dir / "here/events.csv"));
    for (const auto& [what, count] : least) {
      int found = 0;
      for (std::size_t at = 0; (at = here.what.find(what, at)) != std::string::npos; ++at) ++found;
      EXPECT_GE(found, count) << what << "\n" << here.what;
    }
    const LogRow row_here = read_log((dir / "here/log.csv").string()).back();
    Scene scene = read_scene((dir / "scene.toml").string());
    Simulation native = start(scene, prepare(scene));
    native.steps(steps);
    for (const int n : {1, 2, 4, 7}) {
      SCOPED_TRACE(n);
      const std::string there = copied("out", "out-" + std::to_string(n));
      Outcome o = lmp(n, there, "-in in.rope -var steps 100 -var every 50");
      ASSERT_EQ(o.code, 0) << o.out << o.err;
      // Killed in the middle of a state.
      const fs::path states = dir / there / "lammps.states";
      fs::resize_file(states, fs::file_size(states) - 100);
      o = lmp(n, there, "-in in.rope -var steps 200 -var every 50 -var from lammps.states");
      ASSERT_EQ(o.code, 0) << o.out << o.err;
      const Left left = left_by(dir / there, native.topology());
      ASSERT_EQ(left.state.step, steps);
      EXPECT_LT(relative_difference(native.state().position, left.state.position), tolerance);
      EXPECT_LT(relative_difference(native.state().velocity, left.state.velocity), tolerance);
      o = run("import " + there + (edit_script ? " --accept-changes" : ""));
      ASSERT_EQ(o.code, 0) << o.out << o.err;
      const Happened found = happened(slurp(dir / there / "events.csv"));
      EXPECT_EQ(found.what, here.what);
      ASSERT_EQ(found.times.size(), here.times.size());
      for (std::size_t k = 0; k < found.times.size(); ++k) EXPECT_NEAR(found.times[k], here.times[k], 1e-9);
      const LogRow row = read_log((dir / there / "log.csv").string()).back();
      for (const Observable& c : observables()) {
        const double a = row_here[c.name], b = row[c.name];
        // LAMMPS does not tell the work of the ends apart, and has no means of their forces.
        const auto begins = [&](const char* word) { return c.name.rfind(word, 0) == 0; };
        if (begins("work_upper") || begins("work_lower") || begins("torque_") || begins("tension_") ||
            c.name.find("stress_") != std::string::npos)
          continue;
        ASSERT_EQ(std::isnan(a), std::isnan(b)) << c.name;
        if (std::isnan(a)) continue;
        EXPECT_NEAR(a, b, 1e-8 * std::fmax(1, std::fabs(a))) << c.name;
      }
      ASSERT_EQ(run("resume " + there + " --quiet --steps 230").code, 0);
      EXPECT_EQ(happened(slurp(dir / there / "events.csv")).what.rfind(here.what, 0), 0U) << "they go on behind these";
    }
  }
};

// In heat, on elements that are shorter than a tube is wide, so that bonds look at their neighbours, across ranks too.
TEST_F(LammpsEvents, TubesBreakAsHere) {
  expect_equal_events(line_scene("double", "element_length_nm = 0.678\n[rope]\ntubes = 7\nlength_nm = 40\n",
                                 "[failure]\nstrain = 0.02\nstrain_deviation = 0.004\n"
                                 "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n"
                                 "z = { displacement_nm = [[0, 0], [2, 0.8]] }\nsmooth_ps = 0\n"
                                 "[start]\ntemperature_K = 300\nmay_cool = true\n"),
                      {{"tube broke", 5}});
}

std::string linked_scene(const std::string& links) {
  return line_scene("double", "[rope]\ntubes = 7\nlength_nm = 60\ntube_length_nm = 20\nperturbation_nm = 0.01\n",
                    "[[links]]\nstiffness_nN_per_nm = 10\nshear_stiffness_nN_per_nm = 5\n" + links +
                        "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { force_nN = 5 }\n"
                        "[start]\ntemperature_K = 300\nmay_cool = true\n");
}

TEST_F(LammpsEvents, LinksOfTheStartBreakAsHere) {
  expect_equal_events(linked_scene("per_nm = 0.4\nbreaks_at_eV = 0.01\n"), {{"link formed", 200}, {"link broke", 10}});
}

// Their search would compare all elements with each other: a rank knows no place of any when it reads the scene.
TEST_F(LammpsRun, ARankPlacesNoLinks) {
  exported(linked_scene("per_nm = 0.4\nat_ends = 1\nbreaks_at_eV = 0.01\n"), "out");
  const LammpsModel model = load_lammps_model((dir / "out").string());
  ASSERT_EQ(model.interaction.terms.size(), 2U) << "links and the ends of tubes";
  for (const auto& term : model.interaction.terms) EXPECT_EQ(term->begun_at_start(), 0) << term->name();
}

// Links are placed during the run, at ends too, and form from then on wherever an element has room for one.
TEST_F(LammpsEvents, LinksFormAndBreakAsHere) {
  expect_equal_events(linked_scene("per_nm = 0.2\nat_ends = 1\nplaced_at_ps = 0.5\nforming_per_nm_ps = 0.3\n"
                                   "most_per_nm = 0.6\nbreaks_at_nN = 0.04\n"),
                      {{"link formed", 200}, {"link broke", 10}});
}

// A film in a bath that is divided among the ranks anew every 20 steps: all that terms remember goes along.
TEST_F(LammpsEvents, MemoriesGoWithTheElementsOfAFilm) {
  expect_equal_events(
      line_scene("double", "[film]\ntubes = 12\nwidth_nm = 40\ndepth_nm = 40\nlength_nm = 40\n",
                 "[[friction]]\nstrength_pN_per_nm = 20\nelastic_slip_nm = 0.005\n"
                 "[[links]]\nper_nm = 1\nstiffness_nN_per_nm = 10\nbreaks_at_nN = 0.3\nforming_per_nm_ps = 0.5\n"
                 "most_per_nm = 2\n[failure]\nmoment_nN_nm = 3\n[start]\ntemperature_K = 300\n"
                 "[thermostat]\ntemperature_K = 300\ncoupling_per_ps = 1\n"
                 "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n"),
      {{"link formed", 20}, {"link broke", 5}, {"tube broke", 1}},
      [&] { edit("out", "fix even all balance 1000", "fix even all balance 20"); });
}

TEST_F(LammpsRun, AFilmIsCutAndBalancedAgainAndAgain) {
  expect_equal_steps(line_scene("double", "[film]\ntubes = 8\nwidth_nm = 40\ndepth_nm = 40\nlength_nm = 40\n",
                                "[start]\ntemperature_K = 300\nmay_cool = true\n"),
                     120, 1e-10, [&] { edit("out", "fix even all balance 1000", "fix even all balance 20"); });
}

TEST_F(LammpsRun, RanksWithoutElementsAndWithOneTakePart) {
  const std::string tubes = state_text(
      {straight({0, 0, 0}, Vector3::UnitZ(), 9, 1.356), straight({1.7, 0, 0.3}, Vector3::UnitZ(), 9, 1.356),
       straight({0, 0, 90}, Vector3::UnitZ(), 1, 1.356)},
      0.01, 5);
  spit(dir / "tubes.csv", tubes);
  expect_equal_steps(line_scene("double", "element_length_nm = 1.356\n[state]\nfile = \"tubes.csv\"\n",
                                "[start]\ntemperature_K = 300\nmay_cool = true\n"),
                     100, 1e-10, [&] {
                       edit("out", "comm_style tiled\n", "processors 1 1 *\n");
                       edit("out", "balance 1.0 rcb\nfix even all balance 1000 1.01 rcb\n", "");
                     });
}

// Threads inside the ranks leave the bits as they are.
TEST_F(LammpsRun, ThreadsGiveTheSameBits) {
  exported(line_scene("mixed", small_rope, hot_twist), "out");
  Scene scene = read_scene((dir / "scene.toml").string());
  const Topology topology = prepare(scene).topology;
  ASSERT_EQ(lmp(2, "out", "-in in.rope -var steps 60").code, 0);
  const Left one = left_by(dir / "out", topology);
  threads = 2;
  ASSERT_EQ(lmp(2, "out", "-in in.rope -var steps 60").code, 0);
  const Left two = left_by(dir / "out", topology);
  EXPECT_EQ(relative_difference(one.state.position, two.state.position), 0);
  EXPECT_EQ(relative_difference(one.state.velocity, two.state.velocity), 0);
}

TEST_F(LammpsRun, RelaxesToTheSameMinimum) {
  exported(rope("[[load]]\nkind = \"torque\"\nelements = [-1]\ntorque_nN_nm = [0, 0, 2]\n"
                "[[load]]\nkind = \"fix\"\nelements = [0]\n",
                "mode = \"relax\"\nforce_tolerance_nN = 1e-3\n"),
           "out");
  Scene scene = read_scene((dir / "scene.toml").string());
  Simulation native = start(scene, prepare(scene));
  const double before = native.forces().energy.potential();
  ASSERT_TRUE(native.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; }));
  ASSERT_LT(native.forces().energy.potential(), before - 0.1);
  ASSERT_GT(native.forces().energy.twist, 0.1);  // orientations have moved
  for (const int ranks : {1, 2}) {
    SCOPED_TRACE(ranks);
    const Outcome o = lmp(ranks, "out");
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    const Left left = left_by(dir / "out", native.topology());
    const LammpsRow row = read_lammps_rows(LammpsDirectory{(dir / "out").string()}).back();
    EXPECT_NEAR(row.twist, native.forces().energy.twist, 1e-3);
    EXPECT_NEAR(row.vdw, native.forces().energy.vdw, 1e-3);
    EXPECT_NEAR(static_cast<double>(left.state.step), static_cast<double>(native.state().step), 100);
  }
}

// LAMMPS ends where forces are small; the scene asks for the energy as well.
TEST_F(LammpsRun, ARelaxationThatIsNotAtRestSaysSoAndGoesOn) {
  exported(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[chain]\nelements = 30\n[contact]\nlaw = "
      "\"none\"\n[[load]]\nkind = \"fix\"\nelements = [0]\n[[load]]\nkind = \"force\"\nelements = [-1]\nforce_nN = "
      "[0.01, 0, 0]\n[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-5\n",
      "out");
  ASSERT_EQ(lmp(1, "out").code, 0);
  const Outcome o = run("import out");
  EXPECT_EQ(o.code, 4) << o.out << o.err;
  EXPECT_NE(o.err.find("not at rest after steps 0 to"), std::string::npos) << o.err;
  EXPECT_EQ(run("resume out --quiet").code, 0);
  ASSERT_EQ(run("run scene.toml --out whole --quiet").code, 0);
  const auto bend = [&](const char* of) { return read_log((dir / of / "log.csv").string()).back()["bend_eV"]; };
  EXPECT_NEAR(bend("out"), bend("whole"), 2e-3 * bend("whole"));
}

const char* const warm_twist =
    "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\n[start]\ntemperature_K = 100\nmay_cool = true\n";

// A run in two parts and an uninterrupted one: at most so far apart.
void expect_same_run(const Left& whole, const Left& left, double tolerance) {
  ASSERT_EQ(left.state.step, whole.state.step);
  EXPECT_LE(relative_difference(whole.state.position, left.state.position), tolerance);
  EXPECT_LE(difference_of_turns(whole.state.orientation, left.state.orientation), tolerance);
  EXPECT_LE(relative_difference(whole.state.velocity, left.state.velocity), tolerance);
  EXPECT_LE(relative_difference(whole.state.angular_velocity, left.state.angular_velocity), tolerance);
  EXPECT_LE(relative_difference(whole.force, left.force), 100 * tolerance);  // bonds are stiff
}

void expect_same_account(const LammpsRow& whole, const LammpsRow& again) {
  EXPECT_NEAR(again.work, whole.work, 1e-12 * whole.work);
  EXPECT_NEAR(again.dissipated, whole.dissipated, 1e-12 * whole.dissipated);
  EXPECT_NEAR(again.heat, whole.heat, 1e-12 * std::fabs(whole.heat));
}

// On the same number of ranks the resumed run has the bits of an uninterrupted one. The skin of the neighbour list
// has changed before the run is cut off.
TEST_F(LammpsRun, GoesOnFromTheLastStateOnAnyNumberOfRanks) {
  exported(line_scene("mixed", small_rope, hot_twist), "out");
  Scene scene = read_scene((dir / "scene.toml").string());
  const Topology topology = prepare(scene).topology;
  struct Run {
    Left left;
    LammpsRow row;
    std::string states, cut;
  };
  std::map<int, Run> whole;
  for (const int ranks : {1, 2, 4}) {
    const std::string out = copied("out", "whole-" + std::to_string(ranks));
    ASSERT_EQ(lmp(ranks, out, "-in in.rope -var steps 240 -var every 80").code, 0);
    const LammpsDirectory files{(dir / out).string()};
    const std::vector<StateInFile> states = find_states(files.states(), topology.elements());
    ASSERT_EQ(states.size(), 3U);
    ASSERT_NE(states[1].header.skin, states[0].header.skin);
    Run& begun = whole[ranks];
    begun = {left_by(dir / out, topology), read_lammps_rows(files).back(), slurp(files.states()), ""};
    // Killed while it wrote the third state: its mark is not there yet.
    begun.cut = begun.states.substr(0, static_cast<std::size_t>(states[2].end()) - 1000);
    std::fill_n(begun.cut.begin() + static_cast<std::ptrdiff_t>(states[2].at), sizeof(StateHeader), '\0');
  }
  for (const int then : {1, 2, 4}) {
    const auto folder = [&](int ranks) { return std::to_string(ranks) + "-then-" + std::to_string(then); };
    std::vector<Part> parts;
    for (const auto& [ranks, begun] : whole) {
      parts.push_back({copied("whole-" + std::to_string(ranks), folder(ranks)),
                       {"steps 240", "every 80", "from lammps.states"}});
      spit(dir / folder(ranks) / "lammps.states", begun.cut);
    }
    const Outcome o = lmp_each(then, parts);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    for (const auto& [ranks, begun] : whole) {
      SCOPED_TRACE(folder(ranks));
      const LammpsDirectory files{(dir / folder(ranks)).string()};
      expect_same_run(begun.left, left_by(dir / folder(ranks), topology), then == ranks ? 0 : 1e-5);
      EXPECT_EQ(find_states(files.states(), topology.elements()).size(), 3U);
      EXPECT_EQ(slurp(files.states()) == begun.states,
                then == ranks && then == 1);  // the account is summed by rank
      const double tolerance = then == ranks ? 1e-12 : 1e-5;
      EXPECT_NEAR(read_lammps_rows(files).back().work, begun.row.work, tolerance * begun.row.work);
    }
  }
}

// LAMMPS's own restart files, also one for each rank. Links that break travel with their elements.
class LammpsRestart : public LammpsRun, public ::testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(AndLinks, LammpsRestart, ::testing::Bool());
TEST_P(LammpsRestart, FilesGoOnOnAnyNumberOfRanks) {
  const std::size_t terms = GetParam() ? 1 : 0;
  exported(GetParam() ? linked_scene("per_nm = 0.4\nbreaks_at_eV = 0.01\n") : rope(warm_twist), "out");
  Scene scene = read_scene((dir / "scene.toml").string());
  const Topology topology = prepare(scene).topology;
  const LammpsDirectory files{(dir / "out").string()};
  edit("out", "run ${last} upto\n", "restart 60 restart.*.%\nrun ${last} upto\n");
  ASSERT_EQ(lmp(2, "out", "-in in.rope -var steps 120").code, 0);
  const Left whole = left_by(dir / "out", topology);
  const LammpsRow row = read_lammps_rows(files, terms).back();
  if (GetParam()) {
    EXPECT_GT(row.accounts[0].events, 5);
  }
  std::string script = slurp(dir / "out/in.rope");
  const std::size_t region = script.find("region box"), elements = script.find("fix elements");
  script.replace(region, elements - region, "read_restart restart.60.%\n");
  spit(dir / "out/in.rope", script);
  edit("out", " from ${dir}/${from}", "");
  fs::resize_file(files.states(), 0);
  for (const int ranks : {1, 2, 4}) {
    SCOPED_TRACE(ranks);
    const Outcome o = lmp(ranks, "out", "-in in.rope -var steps 120");
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    expect_same_run(whole, left_by(dir / "out", topology), GetParam() ? 1e-10 : 1e-12);
    const LammpsRow again = read_lammps_rows(files, terms).back();
    expect_same_account(row, again);
    for (std::size_t k = 0; k < terms; ++k) {
      EXPECT_NEAR(again.terms[k], row.terms[k], 1e-10 * row.terms[k]);
      EXPECT_EQ(again.accounts[k].events, row.accounts[k].events);
      EXPECT_EQ(again.accounts[k].begun, row.accounts[k].begun);
    }
  }
}

TEST_F(LammpsRun, StylesAreThereAgainAfterClear) {
  exported(rope(""), "out");
  const std::string script = slurp(dir / "out/in.rope");
  spit(dir / "out/in.twice", script + "\nclear\nclear\n" + script + "print \"both done\"\n");
  const Outcome o = lmp(2, "out", "-in in.twice -var steps 5");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("both done"), std::string::npos);
}

TEST_F(LammpsRun, PluginDoesTheSame) {
  exported(rope("[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 30\n"), "out");
  Scene scene = read_scene((dir / "scene.toml").string());
  const Topology topology = prepare(scene).topology;
  ASSERT_EQ(lmp(1, "out", "-in in.rope -var steps 50").code, 0);
  const Left ours = left_by(dir / "out", topology);
  fs::remove(dir / "out/lammps.states");
  const Outcome o = lmp(1, "out", "'" ROPEWALK_LMP_PLUGIN "' -in in.rope -var steps 50", ROPEWALK_LMP_HOST);
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  for (const char* style : {"pair mdem/paper", "pair mdem/line", "pair mdem/none", "bond mdem/vbond", "fix mdem/nve",
                            "fix mdem/relax", "fix mdem/damp", "fix mdem/grip", "fix mdem/states"})
    EXPECT_NE(o.out.find(std::string("plugin: ") + style + " for LAMMPS"), std::string::npos) << o.out;
  EXPECT_EQ(relative_difference(ours.state.position, left_by(dir / "out", topology).state.position), 0);
}

// Each rank has 20 nm of a rope whose tubes rub, and one or two neighbours.
TEST_F(LammpsRun, ARankSendsAndHoldsNoMoreWhereThereAreMoreOfThem) {
  struct Largest {
    long long sent = 0, messages = 0, held = 0;
  };
  std::map<int, Largest> largest;
  for (const int ranks : {2, 4, 8}) {
    const std::string out = "out-" + std::to_string(ranks);
    exported(line_scene("mixed", "[rope]\ntubes = 19\nlength_nm = " + std::to_string(20 * ranks) + "\n",
                        "[[friction]]\nstrength_pN_per_nm = 20\nelastic_slip_nm = 0.005\n"
                        "[damping]\ncontact_viscosity_eV_ps_per_nm3 = 0\nbond_damping_per_ps = 0\n"
                        "[start]\ntemperature_K = 300\nmay_cool = true\n"),
             out);
    const Outcome o = lmp(ranks, out, "'" ROPEWALK_LMP_PLUGIN "' -in in.rope -var steps 100 -var every 20",
                          ROPEWALK_LMP_HOST);
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    int told = 0;
    for (std::size_t at = 0; (at = o.out.find(" bytes, ", at)) != std::string::npos; ++at, ++told) {
      const std::size_t number = o.out.rfind(": ", at) + 2;
      Largest of;
      const char* const text = o.out.c_str() + number;
      ASSERT_EQ(std::sscanf(text, "%lld bytes, %lld messages, %lld", &of.sent, &of.messages, &of.held), 3);
      Largest& all = largest[ranks];
      all = {std::max(all.sent, of.sent), std::max(all.messages, of.messages), std::max(all.held, of.held)};
    }
    ASSERT_EQ(told, ranks);
    const LammpsRow row = read_lammps_rows(LammpsDirectory{(dir / out).string()}, 1).back();
    EXPECT_GT(row.terms[0], 0.1) << "contacts remember slips";
    RecordProperty("sent_messages_held_" + std::to_string(ranks),
                   std::to_string(largest[ranks].sent) + " " + std::to_string(largest[ranks].messages) + " " +
                       std::to_string(largest[ranks].held));
  }
  const auto times = [](long long a, long long b) { return static_cast<double>(a) / static_cast<double>(b); };
  EXPECT_LT(times(largest[4].sent, largest[2].sent), 2.1);  // a rank within has two neighbours
  EXPECT_LT(times(largest[8].sent, largest[4].sent), 1.05);
  EXPECT_LT(times(largest[8].messages, largest[4].messages), 1.05);
  EXPECT_LT(times(largest[8].held, largest[4].held), 1.1);
}

// --- there and back -----------------------------------------------------------------------------------

TEST_F(LammpsRun, ThereAndBackIsOneRun) {
  const std::string scene = rope(
      "[twist]\nmoment_nN_nm = 20\nrate_nN_nm_per_ps = 20\n[start]\ntemperature_K = 200\nmay_cool = true\n"
      "[thermostat]\ntemperature_K = 200\ncoupling_per_ps = 0.5\n",
      "duration_ps = 6\nframes_every_ps = 1\nlog_every_ps = 1\n");
  spit(dir / "scene.toml", scene);
  ASSERT_EQ(run("run scene.toml --out whole --quiet").code, 0);
  // Two ps here, two on LAMMPS, two here again.
  ASSERT_EQ(run("run scene.toml --out half --steps 120 --quiet").code, 0);
  Outcome o = run("export half --lammps there");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::string readme = slurp(dir / "there/README.txt");
  EXPECT_EQ(std::count(readme.begin(), readme.end(), '\n'), 3);
  o = lmp(2, "there", "-in in.rope -var steps 120");
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  o = run("import there");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("step 240"), std::string::npos) << o.out;
  o = run("import there");  // there is nothing more to take
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("no whole state after step 240"), std::string::npos) << o.err;
  o = run("resume there --quiet");
  ASSERT_EQ(o.code, 0) << o.err;
  ASSERT_EQ(run("report there").code, 0);
  ASSERT_EQ(run("observe there").code, 0);

  const std::vector<LogRow> whole = read_log((dir / "whole/log.csv").string());
  const std::vector<LogRow> parts = read_log((dir / "there/log.csv").string());
  EXPECT_EQ(parts.back()["step"], whole.back()["step"]);
  EXPECT_GE(parts.size(), whole.size());
  for (const Observable& c : observables()) {
    if (c.name == "work_upper_eV" || c.name == "work_lower_eV") continue;  // LAMMPS does not tell the ends apart
    const double a = whole.back()[c.name], b = parts.back()[c.name];
    ASSERT_EQ(std::isnan(a), std::isnan(b)) << c.name;
    if (std::isnan(a)) continue;
    EXPECT_NEAR(a, b, 1e-9 * std::fmax(1, std::fabs(a))) << c.name;
  }
  // The balance of energy goes on as if nothing had happened.
  EXPECT_GT(whole.back()["work_eV"], 1);
  const auto manifest = nlohmann::json::parse(slurp(dir / "there/manifest.json"));
  EXPECT_EQ(manifest["status"], "finished");
  EXPECT_NE(slurp(dir / "there/report.html").find("rope"), std::string::npos);
}

TEST_F(LammpsRun, ExportLosesNoDigit) {
  exported(rope("[start]\ntemperature_K = 300\nmay_cool = true\n"), "out");
  ASSERT_EQ(lmp(2, "out", "-in in.rope -var steps 0").code, 0);
  Scene scene = read_scene((dir / "scene.toml").string());
  const Simulation native = start(scene, prepare(scene));
  const Left left = left_by(dir / "out", native.topology());
  const State& s = native.state();
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_EQ(s.position[i], left.state.position[i]);
    EXPECT_EQ(s.orientation[i].coeffs(), left.state.orientation[i].coeffs());
    EXPECT_EQ(s.velocity[i], left.state.velocity[i]);
    EXPECT_EQ(s.angular_velocity[i], left.state.angular_velocity[i]);
    EXPECT_EQ(native.forces().force[i], left.force[i]);
    EXPECT_EQ(native.forces().torque[i], left.torque[i]);
  }
}

TEST_F(LammpsRun, ImportLooksForLimits) {
  spit(dir / "scene.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 14\n"
       "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = [[0, 0], [3, 80]] }\n"
       "[run]\nduration_ps = 3\nframes_every_ps = 0.5\n");
  ASSERT_EQ(run("run scene.toml --out here --quiet").code, 7);
  ASSERT_EQ(run("export scene.toml --lammps there").code, 0);
  ASSERT_EQ(lmp(2, "there", "-in in.rope").code, 0);
  const Outcome o = run("import there");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("Limits passed: "), std::string::npos) << o.out;
  const auto limits = [&](const char* run) {
    return nlohmann::json::parse(slurp(dir / run / "limits.json"))["limits"];
  };
  const auto here = limits("here"), there = limits("there");
  ASSERT_EQ(here.size(), there.size());
  int passed = 0;
  for (std::size_t k = 0; k < here.size(); ++k) {
    SCOPED_TRACE(here[k].dump());
    if (here[k]["key"] != "twist_deg" && here[k]["key"] != "wall_twist") continue;
    EXPECT_EQ(there[k]["passed"], here[k]["passed"]);
    EXPECT_NEAR(there[k]["largest"], here[k]["largest"], 0.05 * double{here[k]["largest"]});
    passed += there[k]["passed"] ? 1 : 0;
  }
  EXPECT_GE(passed, 1);
}

// Steps that are divided on the way, and whole again later. States and rows of the steps that were made again are those
// of the second time: `import` holds every row to its state.
TEST_F(LammpsRun, StepsFollowTheMotionAsHere) {
  const std::string scene_text =
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 13.8\n"
      "[contact]\nlaw = \"line\"\nprecision = \"double\"\n"
      "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = { rotation_deg = [[0, 0], [1, 60]] }\n"
      "smooth_ps = 0\n[run]\nduration_ps = 12\nframes_every_ps = 1\nlog_every_ps = 0.1\n";
  spit(dir / "scene.toml", scene_text);
  constexpr int steps = 300;
  const Outcome here = run("run scene.toml --out here --steps " + std::to_string(steps));
  const std::size_t told = here.err.find("the energy balance did not close; back to 0 ps, on with steps of");
  ASSERT_NE(told, std::string::npos) << here.err;
  const std::string line = here.err.substr(told, here.err.find('\n', told) - told);
  const LogRow last = read_log((dir / "here/log.csv").string()).back();
  ASSERT_EQ(last["step"], steps);
  exported(scene_text, "out");
  for (const int ranks : {1, 2, 4}) {
    SCOPED_TRACE(ranks);
    const std::string there = copied("out", "out-" + std::to_string(ranks));
    Outcome o = lmp(ranks, there, "-in in.rope -var every 60 -var steps " + std::to_string(steps));
    ASSERT_EQ(o.code, 0) << o.out << o.err;
    EXPECT_NE(o.out.find(line), std::string::npos) << line << o.out;
    o = run("import " + there);
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("5 states taken over, up to step 300"), std::string::npos) << o.out;
    const LogRow row = read_log((dir / there / "log.csv").string()).back();
    for (const char* name :
         {"time_ps", "stretch_eV", "bend_eV", "twist_eV", "vdw_eV", "kinetic_eV", "work_eV", "dissipated_eV"})
      EXPECT_NEAR(row[name], last[name], 1e-8 * std::fmax(1, std::fabs(last[name]))) << name;
    // `resume` goes on with steps as short.
    o = run("resume " + there + " --quiet --steps 320");
    EXPECT_TRUE(o.code == 0 || o.code == 7) << o.err;
  }
}

// Of a killed run all whole states are taken.
TEST_F(LammpsRun, ImportLeavesOutWhatIsCutOff) {
  exported(rope(""), "out");
  ASSERT_EQ(lmp(1, "out", "-in in.rope -var steps 30 -var every 10").code, 0);
  const fs::path states = dir / "out/lammps.states", rows = dir / "out/lammps-rows.csv";
  fs::resize_file(states, fs::file_size(states) - 100);
  fs::resize_file(rows, fs::file_size(rows) - 5);
  const Outcome o = run("import out");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("step 20"), std::string::npos) << o.out;
  ASSERT_EQ(run("resume out --steps 25 --quiet").code, 0);
}

// With stand-ins for srun and sbatch. The first job has no time for the scene, the second one ends it.
TEST_F(LammpsRun, AJobWhoseTimeIsOverSubmitsTheNextOne) {
  exported(line_scene("mixed", small_rope, hot_twist), "out");
  const fs::path stand_ins = dir / "bin";
  fs::create_directories(stand_ins);
  fs::create_symlink(ROPEWALK_LMP, stand_ins / "lmp-ropewalk");
  spit(stand_ins / "srun", "#!/bin/sh\nexec \"$@\"\n");
  spit(stand_ins / "sbatch", "#!/bin/sh\necho \"submitted $1\"\n");
  for (const char* name : {"srun", "sbatch"}) fs::permissions(stand_ins / name, fs::perms::owner_all);
  const auto job = [&](int seconds, int steps) {
    edit("out", "variable steps index", "variable steps index " + std::to_string(steps) + " # ");
    const std::string command = "cd '" + (dir / "out").string() + "' && PATH='" + stand_ins.string() +
                                "':$PATH OMP_NUM_THREADS=1 " + leaks_allowed + " SLURM_JOB_END_TIME=$(($(date +%s) + " +
                                std::to_string(seconds) + ")) sh job.sh > out.txt 2>&1";
    const int status = std::system(command.c_str());
    return std::pair(WEXITSTATUS(status), slurp(dir / "out/out.txt"));
  };
  const auto [first, told] = job(2, 1000000);
  EXPECT_EQ(first, 0) << told;
  EXPECT_NE(told.find("submitted job.sh"), std::string::npos) << told;
  Scene scene = read_scene((dir / "scene.toml").string());
  const int elements = prepare(scene).topology.elements();
  const auto reached = [&] {
    return find_states((dir / "out/lammps.states").string(), elements).back().header.step;
  };
  const std::int64_t after_first = reached();
  EXPECT_GT(after_first, 0);
  const auto [second, done] = job(1000, static_cast<int>(after_first) + 40);
  EXPECT_EQ(second, 0) << done;
  EXPECT_EQ(done.find("submitted"), std::string::npos) << done;
  EXPECT_EQ(reached(), after_first + 40);
  EXPECT_EQ(run("import out --accept-changes").code, 0);  // of the number of steps
}

// Two pieces that end where their seconds are over, and a third one, against one run of as many steps.
TEST_F(LammpsRun, ThreePiecesHaveTheBitsOfOneRun) {
  exported(line_scene("mixed", small_rope, hot_twist), "pieces");
  const std::string whole = copied("pieces", "whole"), every = " -var every 16";
  Scene scene = read_scene((dir / "scene.toml").string());
  const int elements = prepare(scene).topology.elements();
  const auto last = [&](const std::string& folder) {
    return find_states((dir / folder / "lammps.states").string(), elements).back();
  };
  std::string goes_on;
  std::int64_t reached = 0;
  for (int piece = 0; piece < 2; ++piece) {
    const Outcome o = lmp(2, "pieces", "-in in.rope -var wall 4 -var steps 100000000" + every + goes_on);
    ASSERT_EQ(o.code, 6) << o.out << o.err;
    EXPECT_GT(last("pieces").header.step, reached);
    reached = last("pieces").header.step;
    EXPECT_TRUE(reached % 16 == 0 || reached % 512 == 0) << reached;
    goes_on = " -var from lammps.states";
  }
  const std::string end = " -var steps " + std::to_string(reached + 100) + every;
  ASSERT_EQ(lmp(2, "pieces", "-in in.rope" + end + goes_on).code, 0);
  ASSERT_EQ(lmp(2, whole, "-in in.rope" + end).code, 0);
  const auto bytes = [&](const std::string& folder) {
    const StateInFile state = last(folder);
    return slurp(dir / folder / "lammps.states").substr(static_cast<std::size_t>(state.record(0)));
  };
  EXPECT_EQ(last("pieces").header.step, reached + 100);
  EXPECT_TRUE(bytes("pieces") == bytes(whole));
}

TEST_F(LammpsRun, ImportRefusesALogOfOtherColumns) {
  exported(rope(""), "out");
  ASSERT_EQ(lmp(1, "out", "-in in.rope -var steps 10 -var every 10").code, 0);
  std::string log = slurp(dir / "out/log.csv");
  spit(dir / "out/log.csv", log.replace(log.find("beta_deg"), 8, "beta_rad"));
  const Outcome o = run("import out");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("log.csv:1: column 40 of the header is \"beta_rad\", \"beta_deg\" is needed"),
            std::string::npos)
      << o.err;
  EXPECT_EQ(slurp(dir / "out/log.csv"), log) << "nothing is written";
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
