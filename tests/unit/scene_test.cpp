// Scenes and parameter sets: keys, the words of refusals, and the model built from them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/contact/paper.hpp"
#include "model/error.hpp"
#include "observe/centre_line.hpp"
#include "observe/observe.hpp"
#include "scene/bath/thermostat.hpp"
#include "scene/build.hpp"
#include "scene/ends/twist.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/lattice.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "scene/maxwell.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "scene/templates.hpp"
#include "scene/watch.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/forces/forces.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path source_dir = ROPEWALK_SOURCE_DIR;
const std::string shipped_set = (source_dir / "data/parameters/cnt-10-10-paper.toml").string();

// A folder of its own for each test, gone at its end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("ropewalk-scene-test-" + unique())) {
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  ~Folder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  static std::string unique() {
    return std::to_string(std::random_device{}()) + std::to_string(std::random_device{}());
  }
  fs::path path_;
};

const std::string head = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n";

Scene scene_from(const std::string& body) {
  const Folder folder;
  return read_scene(folder.write("scene.toml", head + body));
}

const TwistLoad& twist_of(const Scene& scene) { return scene.drives_of<TwistDrive>().at(0)->load; }

BuiltScene built_from(const std::string& body) {
  Scene scene = scene_from(body);
  return build(scene);
}

// --- what is refused --------------------------------------------------------------------------------

struct Expectation {
  std::string words;
  int line = -1;  // -1: not said
};

Expectation expectation_of(const fs::path& file) {
  std::ifstream in(file);
  Expectation e;
  for (std::string text; std::getline(in, text) && text.rfind("# ", 0) == 0;) {
    if (text.rfind("# expect: ", 0) == 0) e.words = text.substr(10);
    if (text.rfind("# line: ", 0) == 0) e.line = std::stoi(text.substr(8));
  }
  return e;
}

void expect_refused(const fs::path& file) {
  SCOPED_TRACE(file.filename().string());
  const Expectation expected = expectation_of(file);
  ASSERT_FALSE(expected.words.empty()) << "no # expect: in it";
  try {
    Scene scene = read_scene(file.string());
    const Prepared p = prepare(scene);
    start(scene, p);
    FAIL() << "was read and begun";
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_THAT(message, HasSubstr(expected.words));
    EXPECT_THAT(message, Not(HasSubstr("\n")));
    EXPECT_THAT(message, HasSubstr("; ")) << "names no remedy";
    EXPECT_LT(message.size(), 600u);
    EXPECT_FALSE(e.place().file.empty());
    if (expected.line >= 0) {
      EXPECT_EQ(e.place().line, expected.line) << message;
      EXPECT_THAT(message, HasSubstr(":" + std::to_string(expected.line) + ": "));
    }
  }
}

TEST(BadScenes, AreRefusedInOneLineThatSaysWhereAndWhatToDo) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(source_dir / "tests/cli/bad"))
    if (entry.path().extension() == ".toml") {
      ++files;
      expect_refused(entry.path());
    }
  EXPECT_GE(files, 45);
}

TEST(BadScenes, AFileThatIsNotThere) {
  const Folder folder;
  EXPECT_THROW(read_scene(folder.path() + "/scene.toml"), InputError);
}

TEST(BadScenes, MissingDataIsNamed) {
  const Folder folder;
  try {
    find_parameters("cnt-10-10-paper", "", {"", 0, "--parameters"}, folder.path() + "/data");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("ROPEWALK_DATA"));
    EXPECT_EQ(e.place().key, "--parameters");
  }
}

// Any prefix of a good file, and any of its bytes changed, gives a scene or an InputError, never anything else.
TEST(BadScenes, DamagedFilesThrowNothingElse) {
  const Folder folder;
  const std::string good =
      head +
      "[rope]\ntubes = 7\nlength_nm = 6.78\n[twist]\nmoment_nN_nm = 1\nrate_nN_nm_per_ps = 1\n"
      "[[load]]\nkind = \"fix\"\ntubes = [0]\nelements = [0, -1]\n[run]\ntime_step_fs = \"auto\"\n";
  std::vector<std::string> damaged;
  for (std::size_t i = 0; i < good.size(); ++i) {
    damaged.push_back(good.substr(0, i));
    for (const char c : {'\0', '\n', '"', '9', '[', '\xff'}) {
      damaged.push_back(good);
      damaged.back()[i] = c;
    }
  }
  int refused = 0;
  for (const std::string& text : damaged) {
    try {
      read_scene(folder.write("scene.toml", text));
    } catch (const InputError& e) {
      ++refused;
      ASSERT_THAT(std::string(e.what()), Not(HasSubstr("\n")));
    }
  }
  EXPECT_GT(refused, static_cast<int>(damaged.size()) / 2);
}

TEST(NearestWord, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string> known = {"length_nm", "tubes", "spacing_nm", "contact_viscosity_eV_ps_per_nm2"};
  EXPECT_EQ(nearest_word("tueb", known), "tubes");
  EXPECT_EQ(nearest_word("Tubes", known), "tubes");
  EXPECT_EQ(nearest_word("length", known), "length_nm");
  EXPECT_EQ(nearest_word("length_angstrom", known), "length_nm");
  EXPECT_EQ(nearest_word("length_nm", {"colour", "length_A"}), "length_A");
  EXPECT_EQ(nearest_word("contact_viscosity", known), "contact_viscosity_eV_ps_per_nm2");
  EXPECT_EQ(nearest_word("colour", known), "");
  EXPECT_EQ(nearest_word("", known), "");
}

TEST(Printable, IsOneLine) {
  EXPECT_EQ(printable("a\nb\tc\x7f"), "a\\nb\\x09c\\x7f");
  EXPECT_EQ(printable("123456", 4), "1234...");
  EXPECT_EQ(printable("12\xc3\xa4", 3), "12...");  // no half of a character
}

// --- the shipped set --------------------------------------------------------------------------------

TEST(ShippedSet, HasThePublishedValues) {
  const ParameterSet set = read_parameters(shipped_set);
  EXPECT_EQ(set.name, "cnt-10-10-paper");
  EXPECT_EQ(set.chirality.n, 10);
  EXPECT_EQ(set.chirality.m, 10);
  EXPECT_EQ(set.doi, "10.1016/j.jmps.2012.10.016");
  EXPECT_EQ(set.path, shipped_set);
  EXPECT_FALSE(set.hash.empty());
  EXPECT_DOUBLE_EQ(set.radius, 0.678);
  EXPECT_DOUBLE_EQ(set.element_length, 1.356);
  EXPECT_NEAR(set.atoms_per_length, 162.2419, 5e-5);
  const BondStiffness bond = test::published_bond();
  EXPECT_DOUBLE_EQ(set.bond.stretch, bond.stretch);
  EXPECT_DOUBLE_EQ(set.bond.bend, bond.bend);
  EXPECT_DOUBLE_EQ(set.bond.twist, bond.twist);
  EXPECT_DOUBLE_EQ(set.validity.kink_curvature, 0.087);
  EXPECT_DOUBLE_EQ(set.validity.twist_collapse, 0.05);
  EXPECT_DOUBLE_EQ(set.validity.stretch, 0.07);
  EXPECT_NEAR(set.element_mass(1.356) / test::published_topology().types[0].mass, 1, 1e-10);
}

TEST(ShippedSet, HasThePublishedContact) {
  const ParameterSet set = read_parameters(shipped_set);
  ASSERT_TRUE(set.law<PaperContact>());
  const PaperContact a = *set.law<PaperContact>(), b = test::published_contact();
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.epsilon, b.epsilon);
  EXPECT_EQ(a.repulsion, b.repulsion);
  EXPECT_EQ(a.attraction, b.attraction);
  EXPECT_EQ(a.angular, b.angular);
  EXPECT_EQ(a.crossing, b.crossing);
  EXPECT_TRUE(a.has_published_powers());
  EXPECT_EQ(a.freeze, 2.75);
  EXPECT_EQ(a.switch_start, 6);
  EXPECT_EQ(a.cutoff_ratio, 8);
  EXPECT_EQ(a.core_gap, 0.4);
}

TEST(ShippedSet, FollowsFromTheSourcesTable) {
  // E and G in GPa = nN/nm^2, the wall's section in nm^2 and nm^4; kn and ks in eV/nm^4.
  const double E = 1030, G = 459, A = 1.427, I = 0.348, J = 0.696, kn = 4740, ks = 2110;
  const ParameterSet set = read_parameters(shipped_set);
  EXPECT_NEAR(set.bond.stretch / (E * A * units::nN_nm), 1, 2e-4);
  EXPECT_NEAR(set.bond.bend / (E * I * units::nN_nm), 1, 2e-4);
  EXPECT_NEAR(set.bond.twist / (G * J * units::nN_nm), 1, 2e-4);
  EXPECT_NEAR(E * units::nN_nm / (kn * set.element_length), 1, 1e-3);
  EXPECT_NEAR(G * units::nN_nm / (ks * set.element_length), 1, 2e-3);
}

TEST(ShippedSet, ListsEveryNumberInTheOrderOfTheFile) {
  const ParameterSet set = read_parameters(shipped_set);
  ASSERT_EQ(set.quantities.size(), 3u + 3u + 16u + 3u);
  EXPECT_EQ(set.quantities.front().key, "tube.radius");
  EXPECT_EQ(set.quantities[3].key, "bond.EA");
  EXPECT_EQ(set.quantities[3].value, 1470);
  EXPECT_EQ(set.quantities[3].unit, "nN");
  EXPECT_EQ(set.quantities.back().key, "validity.stretch");
  for (const Quantity& q : set.quantities) {
    EXPECT_FALSE(q.standard_error) << q.key;
    EXPECT_EQ(q.doi, q.origin == "chosen" || q.key.rfind("validity", 0) == 0 ? "" : "10.1016/j.jmps.2012.10.016")
        << q.key;
  }
}

TEST(ShippedSet, IsFoundByNameAndByFile) {
  const Folder folder;
  EXPECT_TRUE(fs::equivalent(find_parameters("cnt-10-10-paper", folder.path()), shipped_set));
  EXPECT_TRUE(fs::equivalent(find_parameters(shipped_set, ""), shipped_set));
  const std::string own = folder.write("cnt-10-10-paper", "mine");
  EXPECT_TRUE(fs::equivalent(find_parameters("cnt-10-10-paper", folder.path()), own));  // beside the scene first
}

TEST(ShippedSet, IsLookedForInTheEnvironmentsDirectory) {
  const Folder folder;
  fs::create_directories(folder.path() + "/parameters");
  const std::string other = folder.write("parameters/other.toml", "");
  ASSERT_EQ(setenv("ROPEWALK_DATA", folder.path().c_str(), 1), 0);
  const std::string found = find_parameters("other", "");
  unsetenv("ROPEWALK_DATA");
  EXPECT_TRUE(fs::equivalent(found, other));
}

TEST(ParameterSet, StandardErrorsAndNotesAreRead) {
  const Folder folder;
  std::ifstream in(shipped_set);
  std::stringstream text;
  text << in.rdbuf();
  std::string changed = text.str();
  const std::string from = "value = 1470, unit = \"nN\", standard_error = \"not published\", origin = \"derived\"";
  const auto at = changed.find(from);
  ASSERT_NE(at, std::string::npos);
  changed.replace(at, from.size(), "value = 1480, unit = \"nN\", standard_error = 2.5, origin = \"calibrated\"");
  const ParameterSet set = read_parameters(folder.write("set.toml", changed));
  EXPECT_EQ(set.quantities[3].standard_error, 2.5);
  EXPECT_EQ(set.quantities[3].origin, "calibrated");
  EXPECT_NEAR(set.bond.stretch * units::eV_in_nN_nm, 1480, 1e-9);
}

// --- what is read -----------------------------------------------------------------------------------

TEST(SceneFile, EveryKeyReachesTheScene) {
  const Scene s = scene_from(
      "name = \"all\"\nelement_length_nm = 1.356\n"
      "[rope]\ntubes = 19\nlength_nm = 13.56\nspacing_nm = 1.72\nperturbation_nm = 0.001\n"
      "[start]\ntemperature_K = 300\nseed = 7\n"
      "[contact]\nlaw = \"paper\"\nlegacy_torque = true\nexclude_along_tube_nm = 9\nskin_nm = 0.2\n"
      "cutoff_nm = 4.7\n"
      "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 3\nbond_damping_per_ps = 0.5\npfc_local = 0.7\n"
      "[twist]\nmoment_nN_nm = 64\nrate_nN_nm_per_ps = 0.5\nhold_ps = 4\nreading = \"total\"\n"
      "application = \"tangential\"\nlateral = \"held\"\naxial = \"held\"\ngeometric_only = true\nincrement_ps = "
      "2\n"
      "[run]\nmode = \"dynamics\"\ntime_step_fs = 15\nduration_ps = 30\nframes_every_ps = 2\nlog_every_ps = 0.5\n"
      "checkpoint_every_s = 10\nintegrator = \"rk4\"\nmass_scale = 25\n"
      "[observe]\nneighbour_radius_nm = 2.4\n");
  EXPECT_EQ(s.name, "all");
  EXPECT_FALSE(s.hash.empty());
  EXPECT_THAT(s.text, HasSubstr("tubes = 19"));
  const auto& rope = dynamic_cast<const RopeSource&>(*s.source);
  EXPECT_EQ(rope.tubes, 19);
  EXPECT_EQ(rope.length, 13.56);
  EXPECT_EQ(rope.spacing, 1.72);
  EXPECT_EQ(rope.perturbation, 0.001);
  EXPECT_EQ(s.start.temperature, 300);
  EXPECT_EQ(s.start.seed, 7u);
  EXPECT_TRUE(s.contact.legacy_torque);
  EXPECT_EQ(s.contact.exclude_along_tube, 9);
  EXPECT_EQ(s.contact.skin, 0.2);
  EXPECT_EQ(s.contact.cutoff, 4.7);
  EXPECT_EQ(s.damping.contact.eta, 3);
  EXPECT_EQ(s.damping.bond.rate, 0.5);
  EXPECT_EQ(s.damping.local, 0.7);
  ASSERT_EQ(s.drives_of<TwistDrive>().size(), 1u);
  EXPECT_NEAR(twist_of(s).moment, 64 * units::nN_nm, 1e-12);
  EXPECT_NEAR(twist_of(s).ramp_time(), 128, 1e-12);
  EXPECT_EQ(twist_of(s).hold, 4);
  EXPECT_EQ(twist_of(s).reading, TwistLoad::Reading::total);
  EXPECT_EQ(twist_of(s).application, TwistLoad::Application::tangential);
  EXPECT_FALSE(twist_of(s).lateral_free);
  EXPECT_FALSE(twist_of(s).axial_free);
  EXPECT_TRUE(twist_of(s).geometric_only);
  EXPECT_EQ(twist_of(s).increment, 2);
  EXPECT_NEAR(s.run.time_step, 0.015, 1e-15);
  EXPECT_TRUE(s.run.stepping.runge_kutta);
  EXPECT_EQ(s.run.mass_scale, 25);
  EXPECT_EQ(s.run.duration, 30);
  EXPECT_EQ(s.run.frames_every, 2);
  EXPECT_EQ(s.run.log_every, 0.5);
  EXPECT_EQ(s.run.checkpoint_every, 10);
  EXPECT_EQ(s.observe.neighbour_radius, 2.4);
}

TEST(SceneFile, KnobsReachTheSimulation) {
  Scene plain = scene_from("[rope]\ntubes = 7\nlength_nm = 6.78\n[run]\nduration_ps = 1\n");
  Scene s = scene_from(
      "[rope]\ntubes = 7\nlength_nm = 6.78\n[contact]\ncutoff_nm = 4.5\n"
      "[run]\nduration_ps = 1\nmass_scale = 4\n");
  const Prepared p = prepare(plain), q = prepare(s);
  EXPECT_EQ(q.topology.types[0].mass, 4 * p.topology.types[0].mass);
  EXPECT_EQ(q.topology.types[0].inertia, 4 * p.topology.types[0].inertia);
  EXPECT_NEAR(q.interaction.cutoff(), 4.5, 1e-12);
  const PaperContact& contact = dynamic_cast<const PaperLaw&>(*q.interaction.law).contact;
  EXPECT_LT(contact.switch_start * contact.radius, 4.5);
  EXPECT_NEAR(q.time_step, cold_step_fraction * q.limit.limit, 1e-15);
  EXPECT_EQ(start(s, q).time_step(), q.time_step);
}

TEST(SceneFile, Loads) {
  const Scene s = scene_from(
      "[chain]\nelements = 5\n[contact]\nlaw = \"none\"\n[run]\nduration_ps = 1\n"
      "[[load]]\nkind = \"fix\"\nelements = [0, 1]\naxes = \"zx\"\nrotation = false\n"
      "[[load]]\nkind = \"fix\"\nelements = \"all\"\naxes = \"\"\n"
      "[[load]]\nkind = \"force\"\ntubes = [0]\nelements = \"ends\"\nforce_nN = [1, 0, -2.5]\n"
      "[[load]]\nkind = \"torque\"\ntubes = \"all\"\nelements = [-1]\ntorque_nN_nm = [0, 0, 3]\n"
      "[[load]]\nkind = \"rotate\"\nelements = [2]\nrate_deg_per_ps = -2\nangle_deg = 90\ncentre_nm = [1, 2]\n"
      "axial_free = false\nspin_free = true\n");
  const auto loads = s.drives_of<LoadDrive>();
  ASSERT_EQ(loads.size(), 5u);
  const auto& fix = dynamic_cast<const FixLoad&>(*loads[0]->load);
  EXPECT_TRUE(fix.x && !fix.y && fix.z && !fix.rotation);
  EXPECT_EQ(loads[0]->on.elements, (std::vector<int>{0, 1}));
  EXPECT_TRUE(loads[0]->on.all_tubes);
  const auto& spin = dynamic_cast<const FixLoad&>(*loads[1]->load);
  EXPECT_TRUE(!spin.x && !spin.y && !spin.z && spin.rotation);
  EXPECT_TRUE(loads[1]->on.all_elements);
  EXPECT_LT((dynamic_cast<const ForceLoad&>(*loads[2]->load).force - units::nN_nm * Vector3(1, 0, -2.5)).norm(),
            1e-14);
  EXPECT_FALSE(loads[2]->on.all_tubes);
  EXPECT_EQ(loads[2]->on.tubes, std::vector<int>{0});
  EXPECT_EQ(loads[2]->on.elements, (std::vector<int>{0, -1}));
  EXPECT_LT((dynamic_cast<const TorqueLoad&>(*loads[3]->load).torque - units::nN_nm * Vector3(0, 0, 3)).norm(),
            1e-14);
  const auto& turn = dynamic_cast<const PrescribedRotation&>(*loads[4]->load);
  EXPECT_NEAR(turn.rate, -2 * units::degree, 1e-15);
  EXPECT_NEAR(turn.angle, -90 * units::degree, 1e-15);  // with the sign of the rate
  EXPECT_EQ(turn.centre, Vector3(1, 2, 0));
  EXPECT_FALSE(turn.axial_free);
  EXPECT_TRUE(turn.spin_free);
}

TEST(SceneFile, OtherElementLengthNeedsNoLaw) {
  Scene s = scene_from(
      "element_length_nm = 0.9\n[chain]\nelements = 5\n[contact]\nlaw = \"none\"\n[run]\nduration_ps = 1\n");
  const BuiltScene b = build(s);
  EXPECT_EQ(b.topology.types[0].element_length, 0.9);
  EXPECT_NEAR(b.topology.types[0].mass, s.parameters().atoms_per_length * 0.9 * units::carbon_mass, 1e-15);
  EXPECT_NEAR(b.topology.types[0].inertia, b.topology.types[0].mass * 0.678 * 0.678, 1e-15);
}

TEST(SceneFile, AnotherSetMayBeGiven) {
  const Folder folder;
  const std::string path = folder.write("scene.toml",
                                        "format = \"ropewalk-scene-1\"\nparameters = \"not-there\"\n"
                                        "[chain]\nelements = 5\n[run]\nduration_ps = 1\n");
  EXPECT_EQ(read_scene(path, {shipped_set}).parameters().name, "cnt-10-10-paper");
  EXPECT_THROW(read_scene(path), InputError);
}

// --- keys and templates -----------------------------------------------------------------------------

const SceneTemplate& template_named(const std::string& name) {
  for (const SceneTemplate& t : scene_templates())
    if (t.name == name) return t;
  throw std::runtime_error("no template " + name);
}

TEST(Templates, AllAreReadAndBuilt) {
  const Folder folder;
  EXPECT_EQ(scene_templates().size(), 23u);
  for (const SceneTemplate& t : scene_templates()) {
    SCOPED_TRACE(t.name + "\n" + t.text);
    Scene scene;
    ASSERT_NO_THROW(scene = read_scene(folder.write(t.name + ".toml", t.text)));
    EXPECT_EQ(scene.name, t.name);
    ASSERT_NO_THROW(build(scene));
    EXPECT_FALSE(t.description.empty());
    // The brief text has the same keys, without tables that set none and without what the scene should give.
    const auto keys_of = [](const std::string& text) {
      std::vector<std::string> keys;
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);)
        if (!line.empty() && std::string("#[ ").find(line[0]) == std::string::npos) keys.push_back(line);
      return keys;
    };
    EXPECT_EQ(keys_of(t.brief), keys_of(t.text.substr(0, t.text.find("\n[[expect]]"))));
    // Not counted are lines that go on with the comment of the line before.
    const std::regex goes_on("\n +#");
    const auto wrapped = std::distance(std::sregex_iterator(t.brief.begin(), t.brief.end(), goes_on), {});
    EXPECT_LE(std::count(t.brief.begin(), t.brief.end(), '\n') - wrapped, 30) << t.brief;
    const std::string first = "\n# " + (t.dissipation.empty() ? std::string("All other keys") : t.dissipation);
    EXPECT_NE(t.brief.find(first), std::string::npos) << t.brief;
    for (const SceneKey& k : scene_keys()) EXPECT_THAT(t.text, HasSubstr(k.key + " = ")) << k.table;
  }
}

TEST(Templates, AreTheScenesOfThePaper) {
  const Folder folder;
  const auto read = [&](const char* name) {
    Scene s = read_scene(folder.write("scene.toml", template_named(name).text));
    const BuiltScene b = build(s);
    return std::make_pair(s, b.topology);
  };
  const auto [rope, topology] = read("spindle");
  EXPECT_EQ(topology.tubes(), 91);
  EXPECT_EQ(topology.length_of(0), 50);
  EXPECT_NEAR(twist_of(rope).moment / units::nN_nm, 35, 1e-9);
  EXPECT_EQ(twist_of(rope).reading, TwistLoad::Reading::per_tube);
  EXPECT_EQ(twist_of(rope).hold, 100);
  EXPECT_EQ(read("bird-cage").second.length_of(0), 30);
  EXPECT_EQ(read("helix").second.length_of(0), 120);
  EXPECT_NEAR(twist_of(read("helix").first).rate / units::nN_nm, 0.68, 1e-12);
  EXPECT_TRUE(twist_of(read("geometric").first).geometric_only);
  const auto [bundle, seven] = read("bundle");
  EXPECT_EQ(seven.elements(), 35);
  EXPECT_EQ(bundle.start.temperature, 10);
  EXPECT_EQ(bundle.damping.contact.eta + bundle.damping.bond.rate + bundle.damping.local, 0);
  EXPECT_EQ(read("chain").first.drives.size(), 2u);
  EXPECT_EQ(read("relax").first.run.mode, RunOptions::Mode::relax);
}

// Every choice of a scene as text, numbers to ten digits: defaults are stated rounded.
std::string choices(const Scene& s) {
  std::string text = fmt::format("{:.10g} {:.10g} {} | {} {} {} {:.10g} | {:.10g} {:.10g} {:.10g} | ",
                                 s.element_length, s.start.temperature, s.start.seed, s.contact.law,
                                 s.contact.legacy_torque, s.contact.exclude_along_tube, s.contact.skin,
                                 s.damping.contact.eta, s.damping.bond.rate, s.damping.local);
  if (const auto* r = dynamic_cast<const RopeSource*>(s.source.get()))
    text += fmt::format("{} {:.10g} {:.10g} {:.10g} | ", r->tubes, r->length, r->spacing, r->perturbation);
  if (!s.drives_of<TwistDrive>().empty())
    text += fmt::format("{:.10g} {:.10g} {:.10g} {} {} {} {} {} {:.10g} | ", twist_of(s).moment, twist_of(s).rate,
                        twist_of(s).hold, static_cast<int>(twist_of(s).reading),
                        static_cast<int>(twist_of(s).application), twist_of(s).lateral_free, twist_of(s).axial_free,
                        twist_of(s).geometric_only, twist_of(s).increment);
  for (const ThermostatDrive* bath : s.drives_of<ThermostatDrive>())
    text += fmt::format("{} {:.10g} {:.10g} {} | ", bath->options.method, bath->options.temperature.first(),
                        bath->options.coupling, bath->options.seed);
  text += fmt::format("{} {:.10g} {:.10g} | ", s.run.stepping.runge_kutta, s.run.mass_scale, s.contact.cutoff);
  return text + fmt::format("{} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.3g} {} | {:.10g}",
                            static_cast<int>(s.run.mode), s.run.time_step, s.run.duration, s.run.frames_every,
                            s.run.log_every, s.run.checkpoint_every, s.run.goal.force, s.run.max_steps,
                            s.observe.neighbour_radius);
}

// The keys of a table with the values of the key list: the required ones, or all whose default is a value.
std::string keys_of(const std::string& table, bool defaults, const std::string& without = "") {
  std::string text;
  for (const SceneKey& k : scene_keys()) {
    const bool wanted = k.required() || (defaults && (k.standard.empty() || k.key == "force_tolerance_nN"));
    if (k.table == table && wanted && (" " + without + " ").find(" " + k.key + " ") == std::string::npos)
      text += k.key + " = " + k.value + "\n";
  }
  return text;
}

// The defaults that the key list states are those of the reader: writing them out changes nothing.
TEST(SceneKeys, StatedDefaultsAreTheDefaults) {
  const auto dynamics = [](bool defaults) {
    std::string text;
    for (const char* table : {"rope", "twist", "start", "thermostat", "contact", "damping", "observe"})
      text += fmt::format("[{}]\n{}", table, keys_of(table, defaults));
    return choices(scene_from(text + "[run]\n" +
                              keys_of("run", defaults, "solver force_tolerance_nN energy_tolerance max_steps")));
  };
  EXPECT_EQ(dynamics(true), dynamics(false));
  const auto relax = [](bool defaults) {
    return choices(scene_from("[rope]\n" + keys_of("rope", defaults) + "[run]\nmode = \"relax\"\n" +
                              keys_of("run", defaults, "mode duration_ps")));
  };
  EXPECT_EQ(relax(true), relax(false));
}

TEST(SceneKeys, ARelaxationHasNoSpeedThatALimitCouldJudge) {
  const auto speed = [](const std::string& run_mode) {
    const Scene s = scene_from("[chain]\nelements = 5\n[limits]\nspeed_nm_per_ps = 0.1\n[run]\n" + run_mode);
    return watched_of(s, empty_topology(s), {}, contact_law(s).get()).limits.at(0).speed;
  };
  EXPECT_EQ(speed("mode = \"relax\"\n"), 0);
  EXPECT_EQ(speed("duration_ps = 1\n"), 0.1);
}

TEST(SceneKeys, StatedLimitsAreTheDefaults) {
  const std::string start = "[chain]\nelements = 5\n[run]\nduration_ps = 1\n";
  const auto limits = [&](const std::string& more) {
    const Scene s = scene_from(start + more);
    return watched_of(s, empty_topology(s), {}, contact_law(s).get()).limits.at(0);
  };
  const Limits silent = limits(""), stated = limits("[limits]\n" + keys_of("limits", true));
  EXPECT_DOUBLE_EQ(silent.bend, stated.bend);
  EXPECT_DOUBLE_EQ(silent.twist, stated.twist);
  const ParameterSet parameters = scene_from(start).parameters();
  const Validity set = parameters.validity;
  EXPECT_EQ(silent.kink_curvature, set.kink_curvature);
  EXPECT_EQ(silent.wall_twist, set.collapse_at(parameters.radius, 0));
  EXPECT_EQ(silent.strain, set.stretch);
  EXPECT_NEAR(silent.overlap, 0.1, 0.03) << "1.713 nm less 2.4 radii";
  const Limits typed = limits(
      "[limits]\nbend_deg = 9\ntwist_deg = 0\nkink_curvature_per_nm = 1\nwall_twist = 2\nstrain = 3\n"
      "speed_nm_per_ps = 4\npress_nm = 5\n");
  EXPECT_DOUBLE_EQ(typed.bend, 9 * units::degree);
  EXPECT_EQ(typed.twist, 0);
  EXPECT_EQ(typed.kink_curvature + 10 * typed.wall_twist + 100 * typed.strain + 1000 * typed.speed +
                10000 * typed.overlap,
            54321);
}

TEST(SceneKeys, StatedLoadDefaultsAreTheDefaults) {
  const std::string start = "[chain]\nelements = 5\n[run]\nduration_ps = 1\n[[load]]\nelements = \"ends\"\n";
  const Scene fix = scene_from(start + "kind = \"fix\"\n");
  const Scene fix_written =
      scene_from(start + "kind = \"fix\"\ntubes = \"all\"\naxes = \"xyz\"\nrotation = true\n");
  const auto& a = dynamic_cast<const FixLoad&>(*fix.drives_of<LoadDrive>().at(0)->load);
  const auto& b = dynamic_cast<const FixLoad&>(*fix_written.drives_of<LoadDrive>().at(0)->load);
  EXPECT_TRUE(a.x && a.y && a.z && a.rotation && b.x && b.y && b.z && b.rotation);
  EXPECT_TRUE(fix.drives_of<LoadDrive>().at(0)->on.all_tubes &&
              fix_written.drives_of<LoadDrive>().at(0)->on.all_tubes);
  const std::string turn = start + "kind = \"rotate\"\nrate_deg_per_ps = 1\nangle_deg = 360\n";
  const Scene plain = scene_from(turn);
  const Scene written = scene_from(turn + "centre_nm = [0, 0]\naxial_free = true\nspin_free = false\n");
  const auto& c = dynamic_cast<const PrescribedRotation&>(*plain.drives_of<LoadDrive>().at(0)->load);
  const auto& d = dynamic_cast<const PrescribedRotation&>(*written.drives_of<LoadDrive>().at(0)->load);
  EXPECT_EQ(c.centre, d.centre);
  EXPECT_EQ(c.axial_free, d.axial_free);
  EXPECT_EQ(c.spin_free, d.spin_free);
}

TEST(SceneKeys, HelpNamesEveryKey) {
  const std::string help = scene_key_help();
  for (const SceneKey& k : scene_keys()) EXPECT_THAT(help, HasSubstr("  " + k.key + " "));
  // Long lines are wrapped.
  const std::string plain = std::regex_replace(help, std::regex("\\s+"), " ");
  for (const SceneTable& t : scene_tables()) EXPECT_THAT(plain, HasSubstr(t.meaning));
}

// --- what is built ----------------------------------------------------------------------------------

const std::string run = "[run]\nduration_ps = 1\n";

double distance(const State& s, int i, int j) { return (s.position[i] - s.position[j]).norm(); }

TEST(Rope, HexagonalNumbers) {
  EXPECT_EQ(nearest_hexagonal(1), std::make_pair(1, 1));
  EXPECT_EQ(nearest_hexagonal(2), std::make_pair(1, 7));
  EXPECT_EQ(nearest_hexagonal(91), std::make_pair(91, 91));
  EXPECT_EQ(nearest_hexagonal(92), std::make_pair(91, 127));
  EXPECT_EQ(nearest_hexagonal(217), std::make_pair(217, 217));
}

TEST(Rope, IsAHexagonalPackingCentredOnTheOrigin) {
  for (int tubes : {1, 7, 19, 61, 91, 217}) {
    const BuiltScene b = built_from(fmt::format("[rope]\ntubes = {}\nlength_nm = 6.8\n", tubes) + run);
    ASSERT_EQ(b.topology.tubes(), tubes);
    ASSERT_EQ(b.topology.elements(), 5 * tubes);  // 6.8 nm are 5.01 elements
    Vector3 mean = Vector3::Zero();
    int contacts = 0;
    double closest = 1e9;
    for (int i = 0; i < b.topology.elements(); ++i) mean += b.state.position[i] / b.topology.elements();
    for (int t = 0; t < tubes; ++t)
      for (int u = 0; u < t; ++u) {
        const double d = distance(b.state, 5 * t, 5 * u);
        closest = std::min(closest, d);
        contacts += d < 1.01 * b.spacing;
      }
    EXPECT_LT(mean.norm(), 1e-12);
    EXPECT_GE(closest, b.spacing - 1e-12);
    EXPECT_EQ(contacts, std::lround(3 * tubes - std::sqrt(12.0 * tubes - 3)));
    EXPECT_NEAR(b.state.position.z[0], -2 * 1.356, 1e-12);
    EXPECT_NEAR(b.state.position.z[4], 2 * 1.356, 1e-12);
  }
}

TEST(Rope, TubesAreOrderedByShellsAsASpiral) {
  const auto places = hexagonal_lattice(91, 1.0);
  ASSERT_EQ(places.size(), 91u);
  const auto apart = [&](std::size_t t, std::size_t u) {
    return std::hypot(places[t].first - places[u].first, places[t].second - places[u].second);
  };
  std::size_t first = 1;
  for (int shell = 1; shell <= 5; ++shell) {
    const std::size_t next = first + 6 * static_cast<std::size_t>(shell);
    EXPECT_NEAR(places[first].first, shell, 1e-12);
    EXPECT_NEAR(places[first].second, 0, 1e-12);
    for (std::size_t t = first; t < next; ++t) {
      EXPECT_NEAR(apart(t, t + 1 < next ? t + 1 : first), 1, 1e-12);
      EXPECT_LE(apart(t, 0), shell + 1e-12);
      EXPECT_GE(apart(t, 0), shell * std::sqrt(0.75) - 1e-12);
    }
    EXPECT_GT(places[first + 1].second, 0);  // counter-clockwise
    first = next;
  }
}

TEST(Rope, ElementsAreOneLengthApartAndUpright) {
  const BuiltScene b = built_from("[rope]\ntubes = 7\nlength_nm = 67.8\n" + run);
  ASSERT_EQ(b.topology.length_of(3), 50);
  for (int t = 0; t < 7; ++t)
    for (int e = b.topology.tube_begin[t]; e + 1 < b.topology.tube_begin[t + 1]; ++e) {
      EXPECT_NEAR((b.state.position[e + 1] - b.state.position[e] - Vector3(0, 0, 1.356)).norm(), 0, 1e-12);
      EXPECT_EQ(b.state.orientation[e].w(), 1);
      EXPECT_EQ(b.state.velocity[e], Vector3::Zero());
    }
  EXPECT_EQ(b.topology.types[0].radius, 0.678);
  EXPECT_NEAR(b.topology.types[0].mass / test::published_topology().types[0].mass, 1, 1e-10);
  EXPECT_NEAR(b.topology.types[0].inertia / test::published_topology().types[0].inertia, 1, 1e-10);
}

TEST(Rope, PairSpacingIsThePublishedContactsMinimum) {
  const PaperContact k = test::published_contact();
  const double s = pair_spacing(k, 1.356);
  EXPECT_NEAR(s, 1.713, 1e-3);
  EXPECT_NEAR(paper_parallel_energy(k, 1.356, s), -2.19, 0.005);
  const auto slope = test::derivative([&](double h) { return paper_parallel_energy(k, 1.356, s + h); }, 1e-4);
  EXPECT_NEAR(slope, 0, 1e-5);  // 1e-7 nm off
  EXPECT_EQ(paper_parallel_energy(k, 1.356, k.cutoff()), 0);
}

TEST(Rope, SpacingIsTypedOrThatOfTheLaw) {
  const std::string rope = "[rope]\ntubes = 7\nlength_nm = 6.78\n";
  EXPECT_NEAR(built_from(rope + run).spacing, 1.713, 1e-3);
  EXPECT_EQ(built_from(rope + "spacing_nm = 1.8\n" + run).spacing, 1.8);
  EXPECT_NEAR(built_from(rope + "[contact]\nlaw = \"none\"\n" + run).spacing, 2 * 0.678 + 0.335, 1e-12);
}

TEST(Rope, ViscosityReachesFromTheSpacingToOneAndAHalf) {
  Scene s = scene_from("[rope]\ntubes = 7\nlength_nm = 6.78\n" + run);
  const BuiltScene b = build(s);
  EXPECT_EQ(s.damping.contact.eta, 20);
  EXPECT_EQ(s.damping.contact.inner, b.spacing);
  EXPECT_EQ(s.damping.contact.outer, 1.5 * b.spacing);
}

// The mean over where two rows of elements stand along each other, for thin and thick tubes, and for finer
// elements.
TEST(Rope, ViscosityPerLengthOfContactIsThatOfThePublishedTubes) {
  const auto per_length = [](const std::string& set, double element) {
    Scene s =
        scene_of_text(fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\nelement_length_nm = {}\n"
                                  "[rope]\ntubes = 7\nlength_nm = 20\n",
                                  set, element) +
                          run,
                      "scene.toml");
    build(s);
    const ContactViscosity& v = s.damping.contact;
    double sum = 0;
    for (int k = -4000; k <= 4000; ++k) sum += v.weight(std::hypot(v.inner, 0.001 * k)) * 0.001;
    return v.eta * sum / (element * element);
  };
  const double published = per_length("cnt-10-10-paper", 1.356);
  EXPECT_NEAR(published, 27, 0.5);
  EXPECT_NEAR(per_length("cnt-5-5-tersoff", 0.694) / published, 1, 0.04);
  EXPECT_NEAR(per_length("cnt-20-20-tersoff", 2.75) / published, 1, 0.04);
  EXPECT_NEAR(per_length("cnt-10-10-tersoff", 0.689) / published, 1, 0.04);
  EXPECT_EQ(scene_from("[rope]\ntubes = 7\nlength_nm = 20\n[damping]\ncontact_viscosity_eV_ps_per_nm2 = 3\n" + run)
                .damping.contact.eta,
            3);
}

TEST(Rope, BeginsWoundByTheTwistOfItsStart) {
  const std::string rope = "[rope]\ntubes = 19\nlength_nm = 27.12\n[start]\n";
  Scene scene = scene_from(rope + "twist_deg_per_nm = -0.8\n" + run);
  const Prepared p = prepare(scene);
  const RopeObservation o = observe(p.topology, p.state, rope_shells(p.topology, p.state, 0),
                                    validities(scene, p.topology), 0, p.spacing);
  // End to end of the mean tube, which leans.
  const double rim = 0.5 * (2 + std::sqrt(3.0)) * p.spacing, turn = 0.8 * units::degree;  // corners and sides
  EXPECT_LT(o.geometric_twist, 0);
  EXPECT_NEAR(-o.geometric_twist, turn * 19 * 1.356, 0.01 * turn * 19 * 1.356);
  EXPECT_NEAR(o.beta, std::atan(rim * turn), 0.02 * rim * turn);
  EXPECT_THROW(built_from(rope + "twist_deg_per_nm = 20\n" + run), InputError);  // the rim at 50 degrees
  EXPECT_THROW(built_from(rope + "twist_deg_per_nm = 1\nwave_nm = 0.1\n" + run), InputError);
  EXPECT_THROW(
      built_from(
          "[film]\ntubes = 5\nlength_nm = 20\nwidth_nm = 40\ndepth_nm = 40\n[start]\ntwist_deg_per_nm = 1\n" + run),
      InputError);
}

TEST(Twist, IsTakenAwayAgainAndMayBeLeftHanded) {
  const std::string rope =
      "[rope]\ntubes = 1\nlength_nm = 13.56\n[twist]\nmoment_nN_nm = 4\nrate_nN_nm_per_ps = 2\nhold_ps = 3\n";
  Scene s = scene_from(rope + "unload_rate_nN_nm_per_ps = 1\nunloaded_ps = 5\nhand = \"left\"\n");
  const double times[] = {0, 1, 2, 5, 7, 9, 12}, moments[] = {0, 2, 4, 4, 2, 0, 0};
  for (int k = 0; k < 7; ++k)
    EXPECT_NEAR(twist_of(s).moment_at(times[k]), moments[k] * units::nN_nm, 1e-12) << times[k];
  const Prepared p = prepare(s);
  EXPECT_NEAR(moment_at(end_drives(p.loads, p.topology), 7), -2 * units::nN_nm, 1e-12) << "in the log";
  EXPECT_NEAR(p.duration, 14, 1e-9);
  std::vector<PointLoad> on;
  for (const auto& load : p.loads) load->add_forces(p.state, 7, on);
  ASSERT_EQ(on.size(), 2u);
  for (const PointLoad& at : on)
    EXPECT_NEAR(at.torque.z(), (at.element == 0 ? 2 : -2) * units::nN_nm, 1e-12)
        << "the lower end turns to the right";
  EXPECT_THROW(scene_from(rope + "unloaded_ps = 5\n"), InputError);
}

TEST(Rope, PerturbationIsLateralBoundedAndOfTheSeed) {
  const auto built = [](int seed, const char* amplitude, const char* top = "") {
    return built_from(
        fmt::format("{}[rope]\ntubes = 7\nlength_nm = 67.8\nperturbation_nm = {}\n[start]\nseed = {}\n", top,
                    amplitude, seed) +
        run);
  };
  const State straight = built(1, "0").state, a = built(1, "0.01").state, b = built(1, "0.01").state,
              c = built(2, "0.01").state;
  double largest = 0, sum2 = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3 d = a.position[i] - straight.position[i];
    EXPECT_EQ(d.z(), 0);
    largest = std::max({largest, std::fabs(d.x()), std::fabs(d.y())});
    sum2 += d.squaredNorm() / static_cast<double>(2 * a.size());
  }
  EXPECT_LE(largest, 0.01 + 1e-12);
  EXPECT_NEAR(sum2, 0.01 * 0.01 / 3, 0.1 * 0.01 * 0.01 / 3);
  EXPECT_EQ(a.position.x, b.position.x);
  EXPECT_NE(a.position.x, c.position.x);
  // Long waves are as large in elements of half the length.
  const char* const finer = "element_length_nm = 0.678\n[contact]\nlaw = \"none\"\n";
  const State flat = built(1, "0", finer).state, fine = built(1, "0.01", finer).state;
  double fine2 = 0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    fine2 += (fine.position[i] - flat.position[i]).squaredNorm() / static_cast<double>(2 * fine.size());
  EXPECT_NEAR(fine2 / sum2, 2, 0.3);
}

TEST(Chain, IsStraightAlongZ) {
  const BuiltScene b = built_from("[chain]\nelements = 4\n" + run);
  ASSERT_EQ(b.topology.tubes(), 1);
  ASSERT_EQ(b.topology.bonds(), 3);
  for (int i = 0; i < 4; ++i) EXPECT_LT((b.state.position[i] - Vector3(0, 0, (i - 1.5) * 1.356)).norm(), 1e-12);
}

// --- thermal velocities -----------------------------------------------------------------------------

BuiltScene warm(const std::string& source, int kelvin, int seed = 1) {
  return built_from(source + fmt::format("[start]\ntemperature_K = {}\nseed = {}\n", kelvin, seed) + run);
}

TEST(Maxwell, TemperatureIsExactAndMomentaVanish) {
  for (const std::string source :
       {"[chain]\nelements = 2\n", "[chain]\nelements = 3\n", "[rope]\ntubes = 7\nlength_nm = 6.78\n",
        "[rope]\ntubes = 19\nlength_nm = 67.8\n"}) {
    const BuiltScene b = warm(source, 300);
    const double kT = units::boltzmann * 300, freedoms = 6.0 * b.topology.elements() - 6;
    EXPECT_EQ(thermal_freedoms(b.state), freedoms);
    EXPECT_NEAR(kinetic_energy(b.topology, b.state) / (0.5 * freedoms * kT), 1, 1e-12) << source;
    const Momenta net = net_momenta(b.topology, b.state);
    const double p = b.topology.elements() * std::sqrt(kT * b.topology.types[0].mass);
    EXPECT_LT(net.linear.norm(), 1e-12 * p);
    EXPECT_LT(net.angular.norm(), 1e-11 * p * 67.8);
  }
}

TEST(Maxwell, EnergyIsSharedEquallyAndNormally) {
  const BuiltScene b = warm("[rope]\ntubes = 91\nlength_nm = 67.8\n", 300);
  const double n = b.topology.elements();
  double v2 = 0, v4 = 0, w2 = 0;
  for (std::size_t i = 0; i < b.state.size(); ++i) {
    v2 += b.state.velocity[i].squaredNorm() / (3 * n);
    w2 += b.state.angular_velocity[i].squaredNorm() / (3 * n);
    for (int a = 0; a < 3; ++a) v4 += std::pow(b.state.velocity[i][a], 4) / (3 * n);
  }
  EXPECT_NEAR(b.topology.types[0].mass * v2 / (b.topology.types[0].inertia * w2), 1, 0.05);
  EXPECT_NEAR(v4 / (v2 * v2), 3, 0.2);  // a normal distribution's kurtosis
}

TEST(Maxwell, SameSeedSameVelocities) {
  const std::string rope = "[rope]\ntubes = 7\nlength_nm = 6.78\nperturbation_nm = 0.001\n";
  const State a = warm(rope, 10, 5).state, b = warm(rope, 10, 5).state, c = warm(rope, 10, 6).state;
  EXPECT_EQ(a.velocity.x, b.velocity.x);
  EXPECT_EQ(a.angular_velocity.z, b.angular_velocity.z);
  EXPECT_EQ(a.position.y, b.position.y);
  EXPECT_NE(a.velocity.x, c.velocity.x);
}

// The generator is specified to the bit, and so is our mapping of it: the same in every library.
TEST(Random, IsTheSameEverywhere) {
  Random r(5489);
  EXPECT_EQ(r.uniform(), (static_cast<double>(14514284786278117030ull >> 11) + 0.5) / 9007199254740992.0);
  Random s(1);
  double sum = 0, sum2 = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = s.uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    const double x = s.normal();
    sum += x / 100000;
    sum2 += x * x / 100000;
  }
  EXPECT_NEAR(sum, 0, 0.015);
  EXPECT_NEAR(sum2, 1, 0.02);
}

// --- state files ------------------------------------------------------------------------------------

const std::string columns = "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n";

BuiltScene built_state(const std::string& csv, const std::string& more = run) {
  const Folder folder;
  folder.write("elements.csv", csv);
  Scene scene = read_scene(folder.write("scene.toml", head + "[state]\nfile = \"elements.csv\"\n" + more));
  return build(scene);
}

TEST(StateFile, IsRead) {
  const BuiltScene b = built_state(
      "\xef\xbb\xbf# two tubes, written by hand\r\n" + columns +
      "\r\n0, 0, 0, -0.678, 1, 0, 0, 0\r\n0,0,0,+0.678,1,0,0,0\r\n\n" +
      "  # the second is one element, turned about x by 90 degrees\n1,1.7e0,0,0,0.70710678,0.70710678,0,0");
  ASSERT_EQ(b.topology.tubes(), 2);
  EXPECT_EQ(b.topology.length_of(0), 2);
  EXPECT_EQ(b.topology.length_of(1), 1);
  EXPECT_EQ(b.topology.types[0].element_length, 1.356);
  EXPECT_EQ(b.state.position[1], Vector3(0, 0, 0.678));
  EXPECT_NEAR(b.state.orientation[2].norm(), 1, 1e-15);  // eight digits in the file
  EXPECT_LT((axis_of(b.state.orientation[2]) - Vector3(0, -1, 0)).norm(), 1e-8);
  EXPECT_NEAR(b.spacing, 1.713, 1e-3);  // that of the law: time step and viscosity need it
}

TEST(StateFile, GivesBackWhatWasWritten) {
  Topology t = test::published_topology();
  const State s = test::disordered_bundle(t, 3, 4, 1.7, 0.1, 9);
  std::string text = columns;
  for (int tube = 0; tube < 3; ++tube)
    for (int e = t.tube_begin[tube]; e < t.tube_begin[tube + 1]; ++e) {
      const Vector3 x = s.position[e];
      const Quaternion q = s.orientation[e];
      text += fmt::format("{},{},{},{},{},{},{},{}\n", tube, x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z());
    }
  const BuiltScene b = built_state(text);
  EXPECT_EQ(b.topology.tube_begin, t.tube_begin);
  EXPECT_EQ(b.state.position.x, s.position.x);
  EXPECT_EQ(b.state.position.z, s.position.z);
  for (int i = 0; i < 12; ++i)
    EXPECT_LT((b.state.orientation[i].coeffs() - s.orientation[i].coeffs()).norm(), 1e-15);
}

TEST(StateFile, KeepsVelocitiesAndSpins) {
  Topology t = test::published_topology();
  const State s = test::disordered_bundle(t, 3, 4, 1.7, 0.1, 9);
  const BuiltScene b = built_state(state_csv(t, s));
  EXPECT_EQ(b.topology.tube_begin, t.tube_begin);
  EXPECT_EQ(b.state.position.y, s.position.y);
  EXPECT_EQ(b.state.velocity.x, s.velocity.x);
  EXPECT_EQ(b.state.angular_velocity.z, s.angular_velocity.z);
  const auto message = [](const std::string& csv, const std::string& more = run) -> std::string {
    try {
      built_state(csv, more);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message(state_csv(t, s), "[start]\ntemperature_K = 300\n" + run),
              HasSubstr("start.temperature_K: would replace the velocities of "));
  const std::string moving = state_csv(t, s).substr(0, state_csv(t, s).find('\n') + 1);
  EXPECT_THAT(message(moving + "0,0,0,0,1,0,0,0\n"), HasSubstr("has 8 columns; 14 are needed, as the header has"));
  EXPECT_THAT(message(moving + "0,0,0,0,1,0,0,0,0,nan,0,0,0,0\n"), HasSubstr("vy_nm_per_ps"));
  EXPECT_THAT(message("tube,x_nm\n0,0\n"), HasSubstr("wz_rad_per_ps"));
}

// A state with a line or a unit amiss would be 10^3 to 10^7 eV of stretch, or a tube that is too short, without a
// word.
TEST(StateFile, EveryLineAndEveryNumberIsAsItWasWritten) {
  Topology t = test::published_topology();
  const State s = test::disordered_bundle(t, 3, 4, 1.7, 0.1, 9);
  const std::string text = state_csv(t, s);
  std::vector<std::string> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  const std::size_t first = lines.size() - 12;
  const auto message = [](const std::vector<std::string>& changed) -> std::string {
    std::string csv;
    for (const std::string& line : changed) csv += line + "\n";
    try {
      built_state(csv);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  ASSERT_EQ(message(lines), "");
  for (std::size_t k = first; k < lines.size(); ++k) {
    std::vector<std::string> without = lines;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_NE(message(without), "") << "without line " << k + 1;
  }
  // Each column, all of its numbers, as another unit would have them.
  for (std::size_t column = 1; column < 14; ++column)
    for (const double factor : {10.0, 0.1, -1.0, 1000.0}) {
      std::vector<std::string> scaled = lines;
      for (std::size_t k = first; k < lines.size(); ++k) {
        std::vector<std::string> cells;
        std::istringstream line(lines[k]);
        for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
        cells[column] = fmt::format("{}", factor * std::stod(cells[column]));
        scaled[k] = fmt::format("{}", fmt::join(cells, ","));
      }
      EXPECT_NE(message(scaled), "") << "column " << column << " times " << factor;
    }
  // A file of 0.2.0 has no sum, and one by hand no length either.
  std::vector<std::string> old = lines;
  old.erase(std::find_if(old.begin(), old.end(), [](const auto& line) { return line.find("_sum") != line.npos; }));
  ASSERT_EQ(message(old), "");
  old.erase(old.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  EXPECT_THAT(message(old), HasSubstr(fmt::format("elements.csv:{}: lies ", first + 2)));
  EXPECT_THAT(message(old), HasSubstr("is a line missing, or are lengths not in nm?"));
  // Numbers that another program has written in its own way are the same ones.
  std::vector<std::string> same = lines;
  for (std::size_t k = first; k < lines.size(); ++k) same[k] = "0" + lines[k];
  EXPECT_EQ(message(same), "");
}

// Clamps and moments need to know which end is up: of a tube that runs down, and of tubes that run against one
// another.
TEST(StateFile, TubesUpsideDownAreNotHeldByTheirEnds) {
  const auto file = [](const std::vector<int>& ways) {
    std::string text = columns;
    for (std::size_t t = 0; t < ways.size(); ++t)
      for (int k = 0; k < 4; ++k)
        text += fmt::format("{},{},0,{},{}\n", t, 3 * t, ways[t] * 1.356 * k - ways[t] * 2,
                            ways[t] > 0 ? "1,0,0,0" : "0,1,0,0");
    return text;
  };
  const auto said = [&](const std::vector<int>& ways, const std::string& drives) -> std::string {
    try {
      const Folder folder;
      folder.write("elements.csv", file(ways));
      Scene scene = read_scene(folder.write("scene.toml", head + "[state]\nfile = \"elements.csv\"\n" + drives));
      prepare(scene);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string clamp = "[[grip]]\nend = \"upper\"\n[run]\nduration_ps = 1\n",
                    moment = "[twist]\nmoment_nN_nm = 1\nrate_nN_nm_per_ps = 1\n";
  for (const std::string& drive : {clamp, moment}) {
    EXPECT_EQ(said({1, 1}, drive), "");
    EXPECT_THAT(said({-1, -1}, drive), HasSubstr("tube 0 stands upside down"));
    EXPECT_THAT(said({1, -1}, drive), HasSubstr("tube 1 stands upside down"));
  }
  EXPECT_EQ(said({1, -1}, run), "") << "nothing holds an end";
}

// A thin tube between wide ones, read by the set of the wide ones alone, lies inside of them: 10^5 eV without a
// word.
TEST(StateFile, OfSeveralSetsIsNotReadWithOne) {
  Topology t = test::published_topology();
  t.types.push_back(t.types[0]);
  for (int tube = 0; tube < 2; ++tube) t.add_tube(2);
  State s(4);
  for (int i = 0; i < 4; ++i)
    s.position.set(static_cast<std::size_t>(i), Vector3(3.0 * (i / 2), 0, t.types[0].element_length * (i % 2)));
  EXPECT_THAT(state_csv(t, s), HasSubstr("\n# tube_types: 0,0\n# elements_and_sum: 4, "));
  EXPECT_NO_THROW(built_state(state_csv(t, s)));
  t.tube_type = {0, 1};
  const auto message = [&](const std::string& csv) -> std::string {
    try {
      built_state(csv);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string mixed = state_csv(t, s);
  EXPECT_THAT(message(mixed),
              HasSubstr("tubes of this file are of 2 parameter sets, and 1 is given; give all of them"));
  const Folder folder;
  Topology both;
  both.types = t.types;
  State read;
  read_state_csv(folder.write("mixed.csv", mixed), both, read);
  EXPECT_EQ(both.tubes(), 2);
  std::string unreadable = mixed;
  unreadable.replace(unreadable.find("0,1\n"), 3, "0;1");
  EXPECT_THAT(message(unreadable), HasSubstr("says \"0;1\" of the types of tubes"));
}

// Elements of 0.678 nm read as those of 1.356 nm are stretched by half: 10^5 eV without a word.
TEST(StateFile, StatesTheLengthOfItsElements) {
  Topology t = test::published_topology();
  t.types[0].element_length = 0.678;
  t.add_tube(5);
  State s(5);
  for (int i = 0; i < 5; ++i) s.position.set(static_cast<std::size_t>(i), Vector3(0, 0, 0.678 * i));
  const std::string stated = state_csv(t, s);
  EXPECT_THAT(stated, HasSubstr("wz_rad_per_ps\n# element_length_nm: 0.678\n# elements_and_sum: 5, "));
  const auto message = [](const std::string& csv, const std::string& more) -> std::string {
    try {
      const Folder folder;
      folder.write("elements.csv", csv);
      Scene scene = read_scene(folder.write(
          "scene.toml", head + more + "[state]\nfile = \"elements.csv\"\n[contact]\nlaw = \"none\"\n" + run));
      build(scene);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string finer = "element_length_nm = 0.678\n";
  EXPECT_EQ(message(stated, finer), "");
  EXPECT_THAT(message(stated, ""),
              HasSubstr("are 0.678 nm long, and are read as 1.356 nm; take element_length_nm = 0.678"));
  std::string silent = stated;
  silent.erase(silent.find('#'), silent.find('\n', silent.find('#')) + 1 - silent.find('#'));
  EXPECT_EQ(message(silent, finer), "");
  EXPECT_THAT(message(silent, ""),
              HasSubstr("elements of tube 0 follow one another at 0.678 nm, and are read as 1.356 nm long"));
  EXPECT_THAT(message(silent, "element_length_nm = 0.339\n"), HasSubstr("follow one another at 0.678 nm"));
  EXPECT_EQ(message(silent, "element_length_nm = 0.6\n"), "");  // stretched, but of this length
  std::string unreadable = stated;
  unreadable.replace(unreadable.find("0.678\n# "), 5, "long");
  EXPECT_THAT(message(unreadable, finer), HasSubstr("says \"long\" of the element length"));
}

TEST(StateFile, OneElementHasNoTemperature) {
  EXPECT_THROW(built_state(columns + "0,0,0,0,1,0,0,0\n", "[start]\ntemperature_K = 1\n" + run), InputError);
  EXPECT_EQ(built_state(columns + "0,0,0,0,1,0,0,0\n").topology.elements(), 1);
}

// A straight rope of a state file is bent as that of a scene; a wound one keeps its sections.
TEST(StartWave, BendsStatesAsItBendsRopes) {
  const std::string rope = "[rope]\ntubes = 7\nlength_nm = 27.12\n", wave = "[start]\nwave_nm = 0.2\n",
                    run = "[run]\nduration_ps = 1\n";
  const BuiltScene straight = built_from(rope + run), bent = built_from(rope + wave + run);
  const BuiltScene read = built_state(state_csv(straight.topology, straight.state), wave + run);
  ASSERT_EQ(read.state.size(), bent.state.size());
  for (std::size_t i = 0; i < read.state.size(); ++i) {
    EXPECT_LT((Vector3(read.state.position[i]) - Vector3(bent.state.position[i])).norm(), 1e-12);
    EXPECT_LT((axis_of(read.state.orientation[i]) - axis_of(bent.state.orientation[i])).norm(), 1e-12);
  }
  // Wound by a turn, and tilted.
  State wound = straight.state;
  for (std::size_t i = 0; i < wound.size(); ++i) {
    const Vector3 x = wound.position[i];
    const Quaternion turned(Eigen::AngleAxisd(2 * units::pi * x.z() / 27.12, Vector3::UnitZ()));
    const Quaternion tilt(Eigen::AngleAxisd(0.3, Vector3::UnitY()));
    wound.position.set(i, tilt * (turned * x));
    wound.orientation.set(i, tilt * (turned * wound.orientation[i]));
  }
  const BuiltScene still = built_state(state_csv(straight.topology, wound), run),
                   moved = built_state(state_csv(straight.topology, wound), wave + run);
  EXPECT_NEAR(chord_amplitude(centre_line(moved.topology, moved.state).points), 0.2, 1e-3);
  for (int t = 1; t < 7; ++t)
    for (int k = 0; k < moved.topology.length_of(0); ++k) {
      const auto first = static_cast<std::size_t>(k),
                 i = static_cast<std::size_t>(moved.topology.tube_begin[t] + k);
      const auto apart = [&](const State& s) {
        return (Vector3(s.position[i]) - Vector3(s.position[first])).norm();
      };
      EXPECT_NEAR(apart(moved.state), apart(still.state), 1e-9);
    }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
