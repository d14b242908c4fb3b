#include "parametrize/parametrize.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "atoms/potential.hpp"
#include "cli/command_line.hpp"
#include "core/own_files.hpp"
#include "io/clocks.hpp"
#include "io/draft.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/processes.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::validate {
namespace {

struct ParametrizeArguments {
  std::vector<std::string> tubes;  // "7,3"
  std::vector<std::string> potentials = {"tersoff"};
  std::string out = "parametrized";
  std::string friction = "like";  // pairs to measure: each tube beside its "like", "all" pairs, "none"
  std::string tier = "full";      // as of `validate run`
  double budget = 0;              // minutes of each tube's references; 0: any
  int jobs = 0;                   // processes at a time; 0: one for each core
  bool again = false;
  bool quiet = false;
};

namespace fs = std::filesystem;

// The places of a tube's files.
struct Place {
  std::string tube, potential;  // as typed
  std::string name;             // "cnt-7-3-tersoff"
  fs::path folder;

  std::string file(const char* ending) const { return (folder / (name + ending)).string(); }
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::vector<Place> places(const ParametrizeArguments& a) {
  std::vector<Place> all;
  for (const std::string& text : a.tubes)
    for (const std::string& potential : a.potentials) {
      const Chirality c = calibrate::parse_chirality(text);
      find_potential(potential);
      const Place place{text, potential, fmt::format("cnt-{}-{}-{}", c.n, c.m, potential), a.out};
      const auto twice = [&](const Place& other) { return other.name == place.name; };
      if (std::none_of(all.begin(), all.end(), twice)) all.push_back(place);
    }
  return all;
}

// In a process of its own. The numbers go to NAME-calibration.json, and the reason of a failure to NAME-error.txt.
int calibrate(const Place& place) {
  calibrate::CalibrateArguments c;
  c.chirality = place.tube;
  c.potential = place.potential;
  c.envelope = c.json = c.force = c.quiet = true;
  c.out = place.file(".toml");
  c.command =
      fmt::format("ropewalk calibrate --chirality {} --potential {} --envelope", place.tube, place.potential);
  try {
    Draft numbers(place.file("-calibration.json"));
    if (!std::freopen(numbers.name().c_str(), "w", stdout))
      throw std::runtime_error(fmt::format("{}: {}", numbers.name(), std::strerror(errno)));
    const int code = calibrate::calibrate_command(c);
    if (std::fflush(stdout) != 0) throw std::runtime_error(std::strerror(errno));
    numbers.replace();
    return code;
  } catch (const std::exception& e) {
    write_file_atomically(place.file("-error.txt"), error_words(e) + "\n");
    return 3;
  }
}

// Tells, on standard error, that a stage begins, and after each of its tasks how far it is.
class Stage {
 public:
  Stage(const std::string& name, std::size_t tasks, bool quiet) : tasks_(tasks), quiet_(quiet) {
    if (tasks > 0 && !quiet) fmt::print(stderr, "{}\n", name);
  }
  void ended(const std::string& task) {
    ++done_;
    if (quiet_) return;
    const double passed = seconds_since(began_), each = passed / static_cast<double>(done_);
    fmt::print(stderr, "  {} ended: {} of {}, {} passed{}\n", task, done_, tasks_, duration_text(passed),
               done_ < tasks_
                   ? fmt::format(", about {} left", duration_text(each * static_cast<double>(tasks_ - done_)))
                   : "");
  }

 private:
  std::size_t tasks_, done_ = 0;
  bool quiet_;
  double began_ = steady_seconds();
};

void calibrate_all(const std::vector<Place>& all, const ParametrizeArguments& a, int jobs) {
  std::vector<Place> to_make;
  for (const Place& place : all)
    if (a.again || !fs::exists(place.file(".toml")))
      to_make.push_back(place);
    else if (!a.quiet)
      fmt::print(stderr, "{}: set kept\n", place.name);
  Stage stage(fmt::format("1/3 calibration from atoms: {} of {} sets to make", to_make.size(), all.size()),
              to_make.size(), a.quiet);
  std::vector<ProcessTask> tasks;
  for (const Place& place : to_make) {
    fs::remove(place.file("-error.txt"));
    tasks.push_back({[place, &a] {
                       if (!a.quiet) fmt::print(stderr, "  {}: calibrating\n", place.name);
                       return calibrate(place);
                     },
                     [place, &stage](int status) {
                       stage.ended(place.name);
                       if (status == 0 || fs::exists(place.file("-error.txt"))) return;
                       write_file_atomically(place.file("-error.txt"), death_words(status) + "\n");
                     }});
  }
  run_processes(tasks, jobs);
}

// --- friction ---

// Two sets and the file of their friction.
struct PairPlace {
  Place a, b;
  std::string name;

  std::string file(const char* ending) const { return (a.folder / (name + ending)).string(); }
  bool has_sets() const { return fs::exists(a.file(".toml")) && fs::exists(b.file(".toml")); }
};

std::vector<PairPlace> pairs_of(const std::vector<Place>& all, const std::string& which) {
  std::vector<PairPlace> pairs;
  if (which == "none") return pairs;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i; j < (which == "all" ? all.size() : i + 1); ++j) {
      if (all[i].potential != all[j].potential) continue;
      const Chirality a = calibrate::parse_chirality(all[i].tube), b = calibrate::parse_chirality(all[j].tube);
      pairs.push_back(
          {all[i], all[j], fmt::format("friction-{}-{}-{}-{}-{}", a.n, a.m, b.n, b.m, all[i].potential)});
    }
  return pairs;
}

// Whether the file is there and was made with these sets.
bool friction_is_kept(const PairPlace& pair) {
  if (!fs::exists(pair.file(".toml"))) return false;
  const PairFriction f = read_friction(pair.file(".toml"));
  const auto provenance = [&](const char* key) {
    for (const auto& [name, value] : f.provenance)
      if (name == key) return value;
    return std::string();
  };
  return provenance("set_a_hash") == read_parameters(pair.a.file(".toml")).hash &&
         provenance("set_b_hash") == read_parameters(pair.b.file(".toml")).hash;
}

// In a process of its own. The reason of a failure goes to NAME-error.txt.
int measure_friction(const PairPlace& pair) {
  calibrate::FrictionArguments f;
  f.first = pair.a.file(".toml");
  f.second = pair.b.file(".toml");
  f.out = pair.file(".toml");
  f.drag_ps = 0;
  f.json = f.force = f.quiet = true;
  f.command = fmt::format("ropewalk calibrate friction {}.toml {}.toml --drag-ps 0", pair.a.name, pair.b.name);
  try {
    if (!std::freopen("/dev/null", "w", stdout)) throw std::runtime_error(std::strerror(errno));
    return calibrate::friction_command(f);
  } catch (const std::exception& e) {
    write_file_atomically(pair.file("-error.txt"), error_words(e) + "\n");
    return 3;
  }
}

void measure_frictions(const std::vector<PairPlace>& pairs, const ParametrizeArguments& a, int jobs) {
  std::vector<PairPlace> to_measure;
  for (const PairPlace& pair : pairs) {
    if (!pair.has_sets()) continue;
    fs::remove(pair.file("-error.txt"));
    if (!a.again && friction_is_kept(pair)) {
      if (!a.quiet) fmt::print(stderr, "{}: kept\n", pair.name);
      continue;
    }
    // Hours may be in it.
    if (!a.again && fs::exists(pair.file(".toml"))) {
      write_file_atomically(pair.file("-error.txt"),
                            pair.name + ".toml was measured with other sets: take it away, or give --again\n");
      continue;
    }
    to_measure.push_back(pair);
  }
  Stage stage(fmt::format("2/3 friction: {} of {} pairs to measure", to_measure.size(), pairs.size()),
              to_measure.size(), a.quiet);
  std::vector<ProcessTask> tasks;
  for (const PairPlace& pair : to_measure)
    tasks.push_back({[pair, &a] {
                       if (!a.quiet) fmt::print(stderr, "  {}: measuring\n", pair.name);
                       return measure_friction(pair);
                     },
                     [pair, &stage](int status) {
                       stage.ended(pair.name);
                       if (status == 0 || fs::exists(pair.file("-error.txt"))) return;
                       write_file_atomically(pair.file("-error.txt"), death_words(status) + "\n");
                     }});
  run_processes(tasks, jobs);
}

void take_frictions(const std::vector<PairPlace>& pairs, ParametrizedTube& tube) {
  for (const PairPlace& pair : pairs) {
    if (pair.a.name != tube.name && pair.b.name != tube.name) continue;
    if (fs::exists(pair.file("-error.txt")))
      tube.no_friction += (tube.no_friction.empty() ? "" : "; ") + pair.name + ": " +
                          first_line(read_file(pair.file("-error.txt")));
    else if (fs::exists(pair.file(".toml")))
      tube.frictions.push_back(read_friction(pair.file(".toml")));
  }
}

double calibration_seconds(const Place& place) {
  try {
    return nlohmann::json::parse(read_file(place.file("-calibration.json"))).at("seconds").at("total");
  } catch (const std::exception&) {
    return 0;  // a set that was brought here without it
  }
}

ParametrizedTube validated(const Place& place, const ParametrizeArguments& a, int jobs) {
  ParametrizedTube tube;
  tube.name = place.name;
  const Chirality c = calibrate::parse_chirality(place.tube);
  tube.tube = fmt::format("({},{})", c.n, c.m);
  if (!fs::exists(place.file(".toml"))) {
    tube.error =
        fs::exists(place.file("-error.txt")) ? first_line(read_file(place.file("-error.txt"))) : "was interrupted";
    return tube;
  }
  tube.set = read_parameters(place.file(".toml"));
  tube.calibration_seconds = calibration_seconds(place);
  ValidateArguments v;
  v.parameters = place.file(".toml");
  v.out = place.file("-validation");
  v.atoms = true;
  v.tier = tube.tier = a.tier;
  v.budget = a.budget;
  v.jobs = jobs;
  v.again = a.again;
  v.quiet = a.quiet;
  tube.outcomes = run_cases(v);
  return tube;
}

// One tube has one page, report.html.
void write_pages(const std::vector<ParametrizedTube>& tubes, std::size_t count, const std::string& out) {
  const auto path = [&](const std::string& name) { return (fs::path(out) / name).string(); };
  write_file_atomically(path("tubes.csv"), tubes_csv(tubes));
  if (count == 1 && tubes.front().error.empty()) {
    write_file_atomically(path("report.html"), tube_page(tubes.front()));
    return;
  }
  for (const ParametrizedTube& tube : tubes)
    if (tube.error.empty()) write_file_atomically(path(tube.name + ".html"), tube_page(tube));
  write_file_atomically(path("report.html"), overview_page(tubes));
}

void print_line(const ParametrizedTube& t) {
  if (!t.error.empty()) {
    fmt::print("{:<24} no set: {}\n", t.name, t.error);
    return;
  }
  const Check* rope = worst_rope(t);
  fmt::print("{:<24} {:<7} EA {:.4g} nN, EI {:.4g} nN nm^2, GJ {:.4g} nN nm^2, pair {:.4g} eV/nm{}\n", t.name,
             t.verdict(), t.set.bond.stretch * units::eV_in_nN_nm, t.set.bond.bend * units::eV_in_nN_nm,
             t.set.bond.twist * units::eV_in_nN_nm,
             t.set.law<LineParameters>() ? t.set.law<LineParameters>()->pair_energy : 0,
             rope ? fmt::format(", ropes within {:.1f} %", 100 * std::fabs(rope->difference())) : "");
  for (const PairFriction& f : t.frictions)
    fmt::print("{:<24}         friction {:.3g} pN/nm along the axis, {:.3g} pN/nm against spin: {}.toml\n", "",
               1e3 * f.strength * units::eV_in_nN_nm, 1e3 * f.spin_strength * units::eV_in_nN_nm, f.name);
  if (!t.no_friction.empty()) fmt::print("{:<24}         no friction: {}\n", "", t.no_friction);
}

}  // namespace

bool ParametrizedTube::holds() const {
  return error.empty() && std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) {
           return o.verdict() == Outcome::Verdict::holds || o.verdict() == Outcome::Verdict::not_applicable;
         });
}

std::string ParametrizedTube::verdict() const {
  return std::string(holds() ? "holds" : "misses") + (tier == "quick" ? " quick" : "");
}

std::string ParametrizedTube::grade() const {
  return grade_with_verdicts(grade_of(set).words(), set.hash, outcomes);
}

double ParametrizedTube::validation_seconds() const {
  double sum = 0;
  for (const Outcome& o : outcomes) sum += o.result.seconds;
  return sum;
}

const Check* worst_rope(const ParametrizedTube& tube) {
  const Check* worst = nullptr;
  for (const Outcome& o : tube.outcomes) {
    if (o.name.rfind("rope-7-", 0) != 0) continue;
    for (const Check& c : o.result.checks)
      if (!c.informative && c.name.find(": twisting energy, ") != std::string::npos &&
          (!worst || std::fabs(c.difference()) > std::fabs(worst->difference())))
        worst = &c;
  }
  return worst;
}

namespace {

// Exit codes: 0 all checks hold, 1 some miss, 2 wrong input, 3 a tube has no set or a case could not be run.
int parametrize_command(const ParametrizeArguments& a) {
  const std::vector<Place> all = places(a);
  const std::vector<PairPlace> pairs = pairs_of(all, a.friction);
  make_directory(a.out);
  refuse_foreign_file(a.out + "/report.html", page_mark);
  refuse_foreign_file(a.out + "/tubes.csv", "set,n,m,potential,");
  for (const Place& place : all) refuse_foreign_file(place.file(".html"), page_mark);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  calibrate_all(all, a, jobs);
  measure_frictions(pairs, a, jobs);
  std::vector<ParametrizedTube> tubes;
  Stage stage(fmt::format("3/3 validation of {} set{}", all.size(), all.size() == 1 ? "" : "s"), all.size(),
              a.quiet);
  for (const Place& place : all) {
    if (!a.quiet) fmt::print(stderr, "  {}: validating\n", place.name);
    tubes.push_back(validated(place, a, jobs));
    take_frictions(pairs, tubes.back());
    write_pages(tubes, all.size(), a.out);
    print_line(tubes.back());
    std::fflush(stdout);
    stage.ended(place.name);
  }
  fmt::print("Report: {}/report.html; table: {}/tubes.csv\n", a.out, a.out);
  int code = 0;
  for (const ParametrizedTube& tube : tubes) {
    if (!tube.error.empty() || !tube.no_friction.empty()) code = 3;
    for (const Outcome& o : tube.outcomes)
      if (o.verdict() == Outcome::Verdict::failed) code = 3;
    if (code == 0 && !tube.holds()) code = 1;
  }
  return code;
}

}  // namespace

// Also the verb `ropewalk parametrize`.
void add_parametrize(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ParametrizeArguments>();
  CLI::App* verb = app.add_subcommand(
      "parametrize", "From chiralities to validated parameter sets: calibrate, make atoms, validate, one report");
  verb->add_option("tubes", a->tubes, "Chiralities, as in 7,3 10,10")->required();
  verb->add_option("--potential", a->potentials, "tersoff, airebo, rebo, lcbop; several, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--out", a->out, "Directory of sets, atoms and reports; what is finished in it is kept")
      ->capture_default_str();
  verb->add_option(
          "--friction", a->friction,
          "Friction from atoms: of each tube beside its like, of all pairs of tubes, or none; some minutes a pair")
      ->check(CLI::IsMember({"like", "all", "none"}))
      ->capture_default_str();
  verb->add_option("--tier", a->tier, "Cases to run: full, or quick: without ropes and bundles")
      ->check(CLI::IsMember({"full", "quick"}))
      ->capture_default_str();
  verb->add_option("--budget", a->budget, "Minutes that the references of one tube may take [default: any]")
      ->check(number_within(Bounds::positive()));
  verb->add_option("-j,--jobs", a->jobs, "Processes at a time [default: one for each core]")
      ->check(whole_number(1));
  verb->add_flag("--again", a->again, "Make sets and results anew; references of atoms are kept");
  verb->add_flag("--quiet", a->quiet, "No progress lines");
  verb->callback([a, &program] { program.code = parametrize_command(*a); });
}

}  // namespace ropewalk::validate
