// `ropewalk validate list | run | report`.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "core/reference.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "runner/runner.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

const char* tier_name(Case::Tier t) { return t == Case::Tier::quick ? "quick" : "full"; }

std::vector<const Case*> chosen_cases(const ValidateArguments& a) {
  std::vector<const Case*> chosen;
  for (const std::string& name : a.cases) chosen.push_back(&find_case(name));
  if (!chosen.empty()) return chosen;
  if (a.tier != "quick" && a.tier != "full")
    throw InputError({"", 0, "--tier"}, fmt::format("is \"{}\"", printable(a.tier, 40)), "choose quick or full");
  for (const Case& c : all_cases())
    if ((c.group == Case::Group::stability) == a.stability && (a.tier == "full" || c.tier == Case::Tier::quick))
      chosen.push_back(&c);
  return chosen;
}

// Whether the given set may take the place of the named one: in theory for any tube, for atoms only for the same
// tube.
bool fits(const ParameterSet& given, const ParameterSet& named, Case::Group group) {
  if (!given.line || !named.line) return false;
  const bool same = given.chirality.n == named.chirality.n && given.chirality.m == named.chirality.m;
  return same || group != Case::Group::atoms;
}

CaseContext context_of(const Case& c, const std::optional<ParameterSet>& given, const ValidateArguments& a,
                       const std::string& work) {
  CaseContext context;
  context.parameters = [given, group = c.group](const std::string& name) {
    ParameterSet named = read_parameters(find_parameters(name, ""));
    return given && fits(*given, named, group) ? *given : named;
  };
  context.references = data_directory() + "/references";
  context.work = work;
  context.fresh = a.fresh;
  context.progress = [quiet = a.quiet](const std::string& line) {
    if (!quiet) fmt::print(stderr, "    {}\n", line);
  };
  return context;
}

Outcome run_case(const Case& c, const std::optional<ParameterSet>& given, const ValidateArguments& a,
                 const std::string& key) {
  Outcome o;
  o.name = c.name;
  o.key = key;
  const std::string work = (fs::path(a.out) / ("work-" + c.name)).string();
  fs::remove_all(work);
  fs::create_directories(work);
  const double begin = now();
  try {
    o.result = c.run(context_of(c, given, a, work));
  } catch (const std::exception& e) {
    o.error = e.what();
  }
  o.result.seconds = now() - begin;
  std::error_code ignored;
  if (!a.fresh && o.error.empty()) fs::remove_all(work, ignored);
  return o;
}

std::string result_path(const std::string& dir, const std::string& name) {
  return (fs::path(dir) / (name + ".json")).string();
}

// Of the stored energies of two tubes of atoms that slide along each other, for several turns.
std::string registry_words() {
  std::string text;
  for (const auto& [tube, name] : {std::pair{"(5,5)", "pair-sliding-5-5"}, std::pair{"(10,10)", "pair-sliding"}}) {
    const std::string path = fmt::format("{}/references/{}.csv", data_directory(), name);
    if (!fs::exists(path)) continue;
    const std::vector<double> energy = read_reference(path).column("energy_eV_per_nm");
    const double n = static_cast<double>(energy.size()),
                 mean = std::accumulate(energy.begin(), energy.end(), 0.0) / n;
    double squares = 0;
    for (const double e : energy) squares += (e - mean) * (e - mean) / n;
    text += fmt::format("{}{:.2g} % of the well for {}", text.empty() ? "" : " and ",
                        100 * std::sqrt(squares) / std::fabs(mean), tube);
  }
  if (text.empty()) return text;
  return "Error bar of every result that contact makes: the model leaves out registry, how the lattices of two "
         "tubes lie "
         "on one another. Over turns and shifts of atoms the energy of two tubes side by side has a standard "
         "deviation "
         "of " +
         text +
         " (pair-sliding.csv, pair-sliding-5-5.csv). Twisting energies of ropes of seven tubes move by it as the "
         "rows "
         "\"registry over twisting energy\" of their cases say, most at small angles.";
}

std::vector<std::string> facts() {
  std::vector<std::string> out = {
      registry_words(),
      fmt::format("Ropewalk {} ({}), {}, {}. Every run gives the same numbers, apart from the times.", version,
                  git_id, compiler, build_type)};
  if (out.front().empty()) out.erase(out.begin());
  return out;
}

// All results in the directory, in the order of all_cases().
std::vector<Outcome> outcomes_in(const std::string& dir) {
  std::vector<Outcome> outcomes;
  for (const Case& c : all_cases())
    if (fs::exists(result_path(dir, c.name))) outcomes.push_back(read_outcome(result_path(dir, c.name)));
  return outcomes;
}

void write_reports(const std::string& dir, const std::vector<Outcome>& outcomes) {
  write_file_atomically(dir + "/report.html", validation_page(outcomes, facts()));
  write_file_atomically(dir + "/report.json", validation_json(outcomes));
}

void make_directory(const std::string& dir) {
  std::error_code error;
  if (fs::exists(dir, error) && !fs::is_directory(dir, error))
    throw InputError({dir, 0, "--out"}, "exists and is not a directory", "choose another name");
  fs::create_directories(dir, error);
  if (error)
    throw InputError({dir, 0, "--out"}, fmt::format("cannot be created: {}", error.message()),
                     "choose a directory that you may write to");
}

int exit_code(const std::vector<Outcome>& outcomes) {
  int code = 0;
  for (const Outcome& o : outcomes) {
    if (o.verdict() == Outcome::Verdict::failed) return 3;
    if (o.verdict() == Outcome::Verdict::misses) code = 1;
  }
  return code;
}

}  // namespace

const char* group_name(Case::Group group) {
  switch (group) {
    case Case::Group::theory:
      return "theory";
    case Case::Group::atoms:
      return "atoms";
    case Case::Group::codes:
      return "other codes";
    case Case::Group::stability:
      return "stability";
  }
  return "";
}

const Case& find_case(const std::string& name) {
  std::vector<std::string> names;
  for (const Case& c : all_cases()) {
    if (c.name == name) return c;
    names.push_back(c.name);
  }
  const std::string near = nearest_word(name, names);
  throw InputError({"", 0, "case"}, fmt::format("there is no case \"{}\"", printable(name, 60)),
                   near.empty() ? "see `ropewalk validate list`" : fmt::format("did you mean \"{}\"?", near));
}

int list_command(const ListArguments& a) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Case& c : all_cases()) {
    if (a.json) {
      all.push_back({{"name", c.name},
                     {"tier", tier_name(c.tier)},
                     {"against", group_name(c.group)},
                     {"title", c.title},
                     {"why", c.why},
                     {"setup", c.setup},
                     {"oracle", c.oracle},
                     {"literature", c.literature}});
    } else {
      fmt::print("{:<22} {:<6} {:<12} {}\n", c.name, tier_name(c.tier), group_name(c.group), c.title);
    }
  }
  if (a.json) fmt::print("{}\n", all.dump(1));
  return 0;
}

int validate_command(const ValidateArguments& a) {
  const std::vector<const Case*> cases = chosen_cases(a);
  std::optional<ParameterSet> given;
  if (!a.parameters.empty()) given = read_parameters(find_parameters(a.parameters, ""));
  make_directory(a.out);
  const std::string key =
      fmt::format("{} {} {}", git_id, given ? given->hash : "shipped", a.fresh ? "fresh" : "stored");
  std::vector<Outcome> run;
  const double begin = now();
  std::size_t done = 0;
  for (const Case* c : cases) {
    const std::string path = result_path(a.out, c->name);
    const bool kept =
        !a.again && fs::exists(path) && read_outcome(path).key == key && read_outcome(path).error.empty();
    if (!a.quiet) {
      const double left =
          done > 0 ? (now() - begin) / static_cast<double>(done) * static_cast<double>(cases.size() - done) : 0;
      fmt::print(stderr, "{}/{} {}{}{}\n", run.size() + 1, cases.size(), c->name, kept ? ": kept" : "",
                 left > 5 ? fmt::format(", about {:.0f} s left", left) : "");
    }
    Outcome o = kept ? read_outcome(path) : run_case(*c, given, a, key);
    if (!kept) write_file_atomically(path, outcome_json(o));
    run.push_back(std::move(o));
    ++done;
    write_reports(a.out, outcomes_in(a.out));
  }
  if (a.json) {
    fmt::print("{}", validation_json(run));
  } else {
    fmt::print("{}Report: {}/report.html\n", validation_table(run), a.out);
  }
  return exit_code(run);
}

int validation_report_command(const ReportArguments& a) {
  const std::vector<Outcome> outcomes = outcomes_in(a.dir);
  if (outcomes.empty())
    throw InputError({a.dir, 0, ""}, "holds no results",
                     "name the directory that `ropewalk validate run --out` made");
  write_reports(a.dir, outcomes);
  fmt::print("{}/report.html\n", a.dir);
  return 0;
}

}  // namespace ropewalk
