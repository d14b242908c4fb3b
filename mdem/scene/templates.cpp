#include "scene/templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/plain_text.hpp"
#include "scene/expectation.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {
namespace {

// A table of a template, with the keys that are not left at their defaults.
struct Block {
  std::string table;
  std::map<std::string, std::string> set;
};

struct Recipe {
  const char* name;
  const char* description;
  std::vector<Block> blocks;
};

// What takes energy out of a scene whose tubes touch each other, and why.
const char* dissipation_of(const std::vector<Block>& blocks) {
  const auto sets = [&](const char* table, const char* key, const char* value) {
    return std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) {
      const auto at = b.set.find(key);
      return b.table == table && at != b.set.end() && at->second == value;
    });
  };
  if (sets("friction", "from", "\"atoms\""))
    return "The way counts here: tubes rub on each other as atoms do, and contact viscosity is off.";
  if (sets("damping", "contact_viscosity_eV_ps_per_nm3", "0") || sets("contact", "law", "\"none\"") ||
      sets("run", "mode", "\"relax\""))
    return "";
  return "Numerical damping brings it to rest, which atoms do not have: its final state is meaningful, the way "
         "there is not.";
}

std::vector<Block> twisted_rope(const char* length, std::map<std::string, std::string> twist) {
  return {{"rope", {{"tubes", "91"}, {"length_nm", length}, {"perturbation_nm", "0.0005"}}},
          {"twist", std::move(twist)}};
}

std::map<std::string, std::string> calibrated() { return {{"parameters", "\"cnt-10-10-tersoff\""}}; }

Block rope_of(const char* tubes, const char* length) { return {"rope", {{"tubes", tubes}, {"length_nm", length}}}; }

Block grip(const char* end, std::map<std::string, std::string> set = {}) {
  set["end"] = std::string("\"") + end + "\"";
  return {"grip", std::move(set)};
}

std::vector<Recipe> recipes() {
  return {
      {"rope",
       "91 tubes of 67.8 nm in a torsion machine: turned by 100 degrees at fixed length",
       {{"", calibrated()},
        rope_of("91", "67.8"),
        grip("lower"),
        grip("upper", {{"about_z", "{ rotation_deg = [[0, 0], [200, 100], [230, 100]] }"}})}},
      {"twist-to-failure",
       "19 (5,5) tubes of 20 nm turned at fixed length until they break: the largest torque, its angle, the first "
       "break",
       {{"", {{"parameters", "\"cnt-5-5-tersoff\""}}},
        rope_of("19", "20"),
        grip("lower"),
        grip("upper", {{"about_z", "{ rotation_deg = [[0, 0], [158, 190]] }"}}),
        {"failure", {{"strain", "0.06"}, {"strain_deviation", "0.006"}}}}},
      {"constant-tension",
       "37 tubes of 67.8 nm, pulled with 200 nN and turned: how much does the rope contract?",
       {{"", calibrated()},
        rope_of("37", "67.8"),
        grip("lower"),
        grip("upper", {{"z", "{ force_nN = 200, rate_nN_per_ps = 4 }"},
                       {"about_z", "{ rotation_deg = [[0, 0], [50, 0], [250, 150], [300, 150]] }"}})}},
      {"loop",
       "37 tubes of 67.8 nm turned at fixed length, held, turned back and held: what is lost?",
       {{"", calibrated()},
        rope_of("37", "67.8"),
        grip("lower"),
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0"}}},
        {"friction", {{"from", "\"atoms\""}}},
        grip("upper", {{"about_z", "{ rotation_deg = [[0, 0], [200, 150], [250, 150], [450, 0], [500, 0]] }"}})}},
      {"pull-out",
       "7 tubes of 40.7 nm: the centre tube is drawn out of the rope by 10 nm",
       {{"", calibrated()},
        rope_of("7", "40.7"),
        grip("lower", {{"tubes", "[1, 2, 3, 4, 5, 6]"}}),
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0.1325"}}},
        grip("upper", {{"tubes", "[0]"}, {"z", "{ displacement_nm = 10, rate_nm_per_ps = 0.02 }"}})}},
      {"pull-out-outer",
       "7 tubes of 40.7 nm: an outer tube is drawn along the rope by 10 nm",
       {{"", calibrated()},
        rope_of("7", "40.7"),
        grip("lower", {{"tubes", "[0, 2, 3, 4, 5, 6]"}}),
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0.1325"}}},
        grip("upper", {{"tubes", "[1]"}, {"z", "{ displacement_nm = 10, rate_nm_per_ps = 0.02 }"}})}},
      {"load-transfer",
       "19 tubes of 67.8 nm: the seven inner ones are pulled, the twelve outer ones are held below",
       {{"", calibrated()},
        rope_of("19", "67.8"),
        grip("lower", {{"tubes", "[7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18]"}}),
        grip("upper",
             {{"tubes", "[0, 1, 2, 3, 4, 5, 6]"}, {"z", "{ displacement_nm = 2, rate_nm_per_ps = 0.01 }"}})}},
      {"strands",
       "19 strands of 100 nm, of tubes of 40 nm that end inside of the rope and are linked: pulled until it parts",
       {{"", calibrated()},
        {"rope", {{"tubes", "19"}, {"length_nm", "100"}, {"tube_length_nm", "40"}}},
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "1.325"}}},
        grip("lower"),
        grip("upper", {{"z", "{ strain = 0.04, rate_per_ps = 0.0002 }"}}),
        {"links", {{"per_nm", "0.1"}, {"stiffness_nN_per_nm", "100"}, {"breaks_at_nN", "5"}}}}},
      {"two-ply",
       "two ropes of 7 tubes of 135.6 nm, pulled with 20 nN and turned once: they wind round one another",
       {{"", calibrated()},
        {"plies", {{"ropes", "2"}, {"tubes", "7"}, {"length_nm", "135.6"}}},
        grip("lower"),
        grip("upper", {{"z", "{ force_nN = 20, rate_nN_per_ps = 1 }"},
                       {"about_z", "{ rotation_deg = [[0, 0], [50, 0], [410, 360], [600, 360]] }"}})}},
      {"snarl",
       "7 tubes of 407 nm turned 2.5 times at fixed length; then their ends come nearer: a loop, and a snarl",
       {{"", calibrated()},
        rope_of("7", "407"),
        {"start", {{"wave_nm", "5"}}},
        grip("lower"),
        grip("upper", {{"z", "{ displacement_nm = [[0, 0], [600, 0], [5800, -260], [6000, -260]] }"},
                       {"about_z", "{ rotation_turns = [[0, 0], [600, 2.5], [6000, 2.5]] }"}})}},
      {"untwist",
       "7 tubes of 407 nm that a moment winds into a helix, and that are let go",
       {{"", calibrated()},
        rope_of("7", "407"),
        {"start", {{"wave_nm", "5"}}},
        {"twist",
         {{"moment_nN_nm", "14"},
          {"rate_nN_nm_per_ps", "0.05"},
          {"hold_ps", "900"},
          {"unload_rate_nN_nm_per_ps", "0.03"},
          {"unloaded_ps", "2500"}}}}},
      {"interior",
       "the interior of an endless rope of 91 tubes, twisted by 1.5 degrees per nm: a slice of 22 nm without ends",
       {{"", calibrated()},
        rope_of("91", "22.1"),
        {"periodic", {{"twist_deg_per_nm", "[[0, 0], [60, 1.5], [100, 1.5]]"}}}}},
      {"yarn",
       "a yarn without ends: 19 strands of tubes of 40 nm, twisted at free length, linked, and drawn out until it "
       "parts",
       {{"", calibrated()},
        {"rope",
         {{"tubes", "19"}, {"length_nm", "148"}, {"tube_length_nm", "40"}, {"tube_length_deviation_nm", "10"}}},
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "2.65"}}},
        {"periodic",
         {{"twist_deg_per_nm", "[[0, 0], [200, 2]]"},
          {"tension_nN", "[[0, 0]]"},
          {"strain", "[[330, 0], [580, 0.03]]"}}},
        {"links",
         {{"per_nm", "0.1"}, {"placed_at_ps", "310"}, {"stiffness_nN_per_nm", "100"}, {"breaks_at_nN", "5"}}},
        {"failure", {{"strain", "0.16"}}}}},
      {"bend",
       "37 tubes of 67.8 nm bent by 3 degrees between two clamps, one of which may slide; from 4 or 5 degrees on "
       "the pressed side of the rope buckles",
       {{"", calibrated()},
        {"rope", {{"tubes", "37"}, {"length_nm", "67.8"}, {"perturbation_nm", "0.0005"}}},
        grip("lower", {{"about_y", "{ rotation_deg = -1.5, rate_deg_per_ps = 0.02 }"}}),
        grip("upper",
             {{"x", "\"free\""}, {"z", "\"free\""}, {"about_y", "{ rotation_deg = 1.5, rate_deg_per_ps = 0.02 }"}}),
        {"run", {{"duration_ps", "200"}}}}},
      {"hot-chain",
       "one free tube of 67.8 nm in a bath of 300 K",
       {{"", calibrated()},
        {"chain", {{"elements", "50"}}},
        {"contact", {{"law", "\"none\""}}},
        {"start", {{"temperature_K", "300"}}},
        {"thermostat", {{"temperature_K", "300"}, {"coupling_per_ps", "0.05"}}},
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0"}, {"bond_damping_per_ps", "0"}}},
        {"run", {{"duration_ps", "5000"}}}}},
      {"spindle",
       "91 tubes of 67.8 nm twisted into a spindle (Wang et al. 2015, Fig. 2); real tubes collapse under this "
       "moment (limits.wall_twist)",
       twisted_rope("67.8", {{"moment_nN_nm", "35"}, {"rate_nN_nm_per_ps", "1.0"}, {"hold_ps", "100"}})},
      {"bird-cage",
       "91 tubes of 41 nm: a void opens inside, the bird cage (Fig. 3a); real tubes collapse under this moment "
       "(limits.wall_twist)",
       twisted_rope("41", {{"moment_nN_nm", "35"}, {"rate_nN_nm_per_ps", "1.0"}, {"hold_ps", "200"}})},
      {"helix",
       "91 tubes of 163 nm that buckle into a helix (Fig. 4); real tubes collapse under this moment "
       "(limits.wall_twist)",
       twisted_rope("163", {{"moment_nN_nm", "32"}, {"rate_nN_nm_per_ps", "0.68"}, {"hold_ps", "700"}})},
      {"geometric", "91 tubes of 41 nm under geometric twist alone (Fig. 3b)",
       twisted_rope("41", {{"moment_nN_nm", "12"},
                           {"rate_nN_nm_per_ps", "1.0"},
                           {"hold_ps", "120"},
                           {"geometric_only", "true"},
                           {"increment_ps", "1"}})},
      {"bundle",
       "7 short tubes at 10 K without damping: does energy stay?",
       {{"rope", {{"tubes", "7"}, {"length_nm", "6.78"}}},
        {"start", {{"temperature_K", "10"}}},
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0"}, {"bond_damping_per_ps", "0"}}},
        {"run", {{"duration_ps", "1000"}}}}},
      {"film",
       "a thin film of 100 tubes of 68.9 nm, laid down at random, at 300 K; where tubes fall on one another they "
       "are pressed beyond limits.press_nm for a while",
       {{"", {{"parameters", "\"cnt-10-10-tersoff\""}}},
        {"film", {{"tubes", "100"}, {"length_nm", "68.9"}, {"width_nm", "150"}, {"depth_nm", "100"}}},
        {"start", {{"temperature_K", "300"}}},
        {"thermostat", {{"temperature_K", "300"}, {"coupling_per_ps", "1"}}},
        {"damping", {{"contact_viscosity_eV_ps_per_nm3", "0"}, {"bond_damping_per_ps", "0"}}},
        {"run", {{"duration_ps", "50"}}}}},
      {"chain",
       "a cantilever: one tube, one end fixed, a force on the other",
       {{"chain", {{"elements", "41"}}},
        {"contact", {{"law", "\"none\""}}},
        {"load", {{"kind", "\"fix\""}, {"elements", "[0]"}}},
        {"load", {{"kind", "\"force\""}, {"elements", "[-1]"}, {"force_nN", "[0.01, 0, 0]"}}},
        {"run", {{"mode", "\"relax\""}, {"force_tolerance_nN", "1e-8"}, {"max_steps", "400000"}}}}},
      {"relax",
       "37 tubes relaxed to the nearest minimum of the energy",
       {{"rope", {{"tubes", "37"}, {"length_nm", "27.12"}, {"perturbation_nm", "0.0005"}}},
        {"run", {{"mode", "\"relax\""}}}}},
  };
}

std::string key_line(const SceneKey& k, const std::string* value) {
  const std::string setting = fmt::format("{}{} = {}", value ? "" : "# ", k.key, value ? *value : k.value);
  std::string comment = k.unit.empty() ? k.meaning : k.unit + "; " + k.meaning;
  if (!k.required())
    comment += fmt::format(" ({}{})", k.standard.rfind("required", 0) == 0 ? "" : "default: ",
                           k.standard.empty() ? k.value : k.standard);
  constexpr std::size_t column = 41;
  const std::vector<std::string> lines = lines_of(comment, widest_line - column - 2);
  std::string text = fmt::format("{:{}} # {}\n", setting, column - 1, lines.front());
  for (std::size_t n = 1; n < lines.size(); ++n) text += std::string(column, ' ') + "# " + lines[n] + "\n";
  return text;
}

std::string comment_lines(const std::string& words) {
  std::string text;
  for (const std::string& line : lines_of(words, widest_line - 2)) text += "# " + line + "\n";
  return text;
}

// All keys of a table; those that the block does not set stand as comments, or are left out of a brief text.
std::string keys_text(const SceneTable& table, const std::map<std::string, std::string>& set, bool brief) {
  std::string text;
  for (const SceneKey& k : table.keys) {
    const auto at = set.find(k.key);
    if (!brief || at != set.end()) text += key_line(k, at == set.end() ? nullptr : &at->second);
  }
  return text;
}

std::string table_text(const SceneTable& table, const std::vector<Block>& blocks, bool brief) {
  std::string text = "\n" + (brief ? "" : comment_lines(table.meaning));
  bool any = false;
  for (const Block& b : blocks) {
    if (b.table != table.name) continue;
    text += (any ? "\n" : "") + table.header() + "\n" + keys_text(table, b.set, brief);
    any = true;
  }
  if (any) return text;
  if (brief) return "";
  // Tables without required keys are always there, for their keys to be switched on by taking a # away.
  return text + (table.optional() ? "# " : "") + table.header() + "\n" + keys_text(table, {}, false);
}

std::string text_without_expectations(const Recipe& recipe, bool brief) {
  std::string text = comment_lines(std::string(recipe.description) + ".") + comment_lines(dissipation_of(recipe.blocks));
  text += brief ? "# All other keys have their defaults; `ropewalk help scene` lists them.\n\n"
                : "# Every key has its unit in its name; lines with a # in front show keys that are not set.\n\n";
  std::map<std::string, std::string> top = {{"format", fmt::format("\"{}\"", scene_format)},
                                            {"parameters", "\"cnt-10-10-paper\""}};
  for (const Block& b : recipe.blocks)
    if (b.table.empty())
      for (const auto& [key, value] : b.set) top[key] = value;
  for (const SceneTable& t : scene_tables())
    text += t.name.empty() ? keys_text(t, top, brief) : table_text(t, recipe.blocks, brief);
  return text;
}

struct Expected {
  const char *kind, *column;
  double value, tolerance;
  double at = -1;  // ps; negative: at the end
};

// Measured by runs of the templates. The tolerance is at least twice the largest difference to two runs that begin
// with velocities of 0.01 K and take shorter steps, and not less than 1e-4 of the value: processors differ in last
// digits, which ropes amplify that buckle, slip or break. Such scenes are judged before they do. Means of heat are
// those of equipartition, within four standard deviations of a single row.
const Expected all_expected[] = {
    {"rope", "torque_upper_nN_nm", 3382.3, 1},
    {"rope", "tension_upper_nN", 1717.9, 0.5},
    {"twist-to-failure", "torque_upper_nN_nm", 169.83, 0.05, 100},
    {"twist-to-failure", "work_eV", 867.5, 0.2, 100},
    {"constant-tension", "ends_strain", -0.008238, 5e-6},
    {"constant-tension", "torque_upper_nN_nm", 806.5, 1.6},
    {"pull-out", "work_eV", 63.87, 0.02},
    {"pull-out", "vdw_eV", -438.29, 0.05},
    {"pull-out-outer", "work_eV", 31.962, 0.01},
    {"pull-out-outer", "vdw_eV", -467.36, 0.05},
    {"load-transfer", "work_eV", 623.1, 0.2},
    {"load-transfer", "stretch_eV", 19.95, 0.1},
    {"strands", "tension_upper_nN", 78.45, 0.2, 25},
    {"strands", "work_eV", 133.42, 0.05, 25},
    {"snarl", "torque_upper_nN_nm", 42.673, 0.005, 300},
    {"snarl", "twist_eV", 1096.08, 0.11, 300},
    {"spindle", "geometric_twist_deg", 274.11, 0.05, 45},
    {"spindle", "vdw_eV", -29505.3, 3, 45},
    {"bird-cage", "geometric_twist_deg", 145.624, 0.02, 45},
    {"bird-cage", "vdw_eV", -17895.9, 1.8, 45},
    {"helix", "geometric_twist_deg", 277.91, 0.1, 45},
    {"helix", "beta_deg", 8.2, 0.025, 45},
    {"untwist", "geometric_twist_deg", 405.83, 0.05, 100},
    {"untwist", "twist_eV", 906.34, 0.2, 100},
    {"yarn", "beta_deg", 6.2994, 0.001, 300},
    {"yarn", "work_eV", 92.35, 0.03, 300},
    {"interior", "torque_upper_nN_nm", 2949.7, 0.4},
    {"interior", "tension_upper_nN", 1626.5, 0.2},
    {"bend", "work_eV", 54.81, 0.02},
    {"bend", "torque_upper_y_nN_nm", 334.86, 0.15},
    {"hot-chain", "kinetic_eV", 3.88, 1.27},
    {"bundle", "balance_eV", 0, 0.003},
    {"film", "kinetic_eV", 387.8, 13},
    {"geometric", "beta_deg", 42.7, 0.1},
    {"chain", "bend_eV", 0.046255, 5e-5},
    {"chain", "amplitude_nm", 0.28541, 3e-4},
    {"relax", "vdw_eV", -5224.5, 0.5},
    {"relax", "stretch_eV", 2.134, 0.003},
};

// What a template expects ends with the first change of it.
std::string text_with_expectations(const Recipe& recipe) {
  const std::string hash = what_is_run_hash(text_without_expectations(recipe, false));
  Recipe expecting = recipe;
  for (const Expected& e : all_expected) {
    if (e.kind != std::string(recipe.name)) continue;
    Block block{"expect",
                {{"column", fmt::format("\"{}\"", e.column)},
                 {"value", as_toml(e.value)},
                 {"tolerance", as_toml(e.tolerance)},
                 {"scene_hash", fmt::format("\"{}\"", hash)}}};
    if (e.at >= 0) block.set["at_ps"] = as_toml(e.at);
    expecting.blocks.push_back(std::move(block));
  }
  return text_without_expectations(expecting, false);
}

std::vector<SceneTemplate> all_templates() {
  std::vector<SceneTemplate> out;
  for (const Recipe& r : recipes())
    out.push_back({r.name, r.description, dissipation_of(r.blocks), text_with_expectations(r),
                   text_without_expectations(r, true)});
  return out;
}

}  // namespace

const std::vector<SceneTemplate>& scene_templates() {
  static const std::vector<SceneTemplate> templates = all_templates();
  return templates;
}

}  // namespace ropewalk
