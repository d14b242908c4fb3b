// `ropewalk validate list | run | report`.
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command_line.hpp"
#include "core/own_files.hpp"
#include "core/reference.hpp"
#include "io/clocks.hpp"
#include "io/data_files.hpp"
#include "io/disk_full.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/processes.hpp"
#include "io/removal.hpp"
#include "io/toml_table.hpp"
#include "runner/runner.hpp"
#include "version.hpp"

namespace ropewalk::validate {
namespace {

namespace fs = std::filesystem;

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

ParameterSet shipped_set(const std::string& name) { return read_parameters(find_parameters(name, "")); }

// All that the cases of one command share.
struct Run {
  ValidateArguments arguments;
  std::optional<ParameterSet> given, second;
  std::string key;
  int jobs = 1;
};

// A case to run, its sets and its means.
struct Task {
  const Case* of = nullptr;
  std::vector<ParameterSet> sets;
  std::string not_applicable;
  bool make_atoms = false;
  double seconds = 0;  // estimated time of LAMMPS, s
  std::string no_atoms = "make them with --atoms";
};

// If only the shipped sets make sense, the given one takes the place of that of its tube.
Task task_of(const Case& c, const Run& run) {
  Task t;
  t.of = &c;
  for (const std::string& name : c.sets) t.sets.push_back(shipped_set(name));
  if (!run.given) return t;
  try {
    check_applicable(c, *run.given, t.sets);
    const bool compares_sets = !c.only_these.empty() && c.group != Case::Group::atoms;
    if (!compares_sets) t.sets = {*run.given};
    for (ParameterSet& set : t.sets)
      if (like(set, *run.given)) set = *run.given;
    if (run.second && c.takes_two) t.sets.push_back(*run.second);
  } catch (const NotApplicable& reason) {
    t.not_applicable = reason.what();
    t.sets = {*run.given};
  }
  return t;
}

CaseContext context_of(const Task& task, const Run& run, const std::string& work) {
  CaseContext context;
  context.sets = task.sets;
  context.given = run.given.has_value();
  context.references = data_directory() + "/references";
  context.work = work;
  context.fresh = run.arguments.fresh;
  context.make_atoms = task.make_atoms;
  context.no_atoms = task.no_atoms;
  context.progress = [quiet = run.arguments.quiet, name = task.of->name](const std::string& line) {
    if (!quiet) fmt::print(stderr, "    {}: {}\n", name, line);
  };
  return context;
}

// The estimated time of the LAMMPS runs that a case needs; 0 where its references exist.
double seconds_of_missing(const Case& c, const ParameterSet& set, const CaseContext& context) {
  const auto missing = [&](const std::string& table) { return find_reference(context, set, table).empty(); };
  return c.lammps_seconds && std::any_of(c.tables.begin(), c.tables.end(), missing) ? c.lammps_seconds(set) : 0;
}

// Decides which references of the given set are made: in the order of the cases, as long as the budget lasts.
void allow_atoms(std::vector<Task>& tasks, const Run& run) {
  double sum = 0;
  for (Task& t : tasks) {
    if (!t.not_applicable.empty()) continue;
    t.seconds = seconds_of_missing(*t.of, *run.given, context_of(t, run, ""));
    const double minutes = (sum + t.seconds) / run.jobs / 60;
    if (run.arguments.budget > 0 && minutes > run.arguments.budget) {
      t.no_atoms = fmt::format("they take about {:.2g} min of one core, more than --budget {} leaves",
                               t.seconds / 60, run.arguments.budget);
      t.seconds = 0;
      continue;
    }
    t.make_atoms = true;
    sum += t.seconds;
  }
  if (sum > 0 && !run.arguments.quiet)
    fmt::print(stderr, "LAMMPS makes the atoms of {}: about {:.2g} min on {} cores\n", tube_name(*run.given),
               sum / run.jobs / 60, run.jobs);
}

std::vector<UsedSet> used_sets(const Task& task) {
  std::vector<UsedSet> sets;
  for (const ParameterSet& set : task.sets)
    sets.push_back({set.name, set.hash, tube_name(set), grade_of(set).words(), registry_deviation(set)});
  return sets;
}

void fill_tubes(Outcome& o) {
  for (std::string& text : o.result.remarks) text = o.with_tubes(text);
  for (CaseFigure& figure : o.result.figures) figure.caption = o.with_tubes(figure.caption);
}

Outcome outcome_of(const Task& task, const Run& run) {
  Outcome o;
  o.name = task.of->name;
  o.key = run.key;
  o.tubes = tube_names(task.sets);
  o.sets = used_sets(task);
  o.not_applicable = task.not_applicable;
  if (!o.not_applicable.empty()) return o;
  const std::string work = (fs::path(run.arguments.out) / ("work-" + o.name)).string();
  make_work_folder(work, "--out");
  const double begin = steady_seconds();
  bool names_files = false;  // of the work folder
  try {
    o.result = run_case(*task.of, context_of(task, run, work));
    fill_tubes(o);
  } catch (const NotApplicable& reason) {
    o.not_applicable = reason.what();
  } catch (const std::exception& e) {
    o.error = error_words(e);
    names_files = error_code(e) == 3 && !dynamic_cast<const DiskFull*>(&e);
  }
  o.result.seconds = seconds_since(begin);
  if (!run.arguments.fresh && !names_files) remove_work_folder(work);
  return o;
}

std::string result_path(const std::string& dir, const std::string& name) {
  return (fs::path(dir) / (name + ".json")).string();
}

void store(const Outcome& o, const Run& run) {
  write_file_atomically(result_path(run.arguments.out, o.name), outcome_json(o));
}

// A result with the run's key that is not one of a failure.
bool finished(const Task& task, const Run& run) {
  const std::string path = result_path(run.arguments.out, task.of->name);
  if (run.arguments.again || !fs::exists(path)) return false;
  const Outcome o = read_outcome(path);
  // A case that was not applicable may have become so.
  return o.key == run.key && o.error.empty() && o.not_applicable.empty();
}

void report_of_death(const Task& task, const Run& run, int status) {
  Outcome o;
  o.name = task.of->name;
  o.key = run.key;
  o.tubes = tube_names(task.sets);
  o.sets = used_sets(task);
  o.error = death_words(status);
  store(o, run);
}

// All results in the directory, in the order of all_cases().
std::vector<Outcome> outcomes_in(const std::string& dir) {
  std::vector<Outcome> outcomes;
  for (const Case& c : all_cases())
    if (fs::exists(result_path(dir, c.name))) outcomes.push_back(read_outcome(result_path(dir, c.name)));
  return outcomes;
}

void write_reports(const std::string& dir, const std::vector<Outcome>& outcomes) {
  write_file_atomically(dir + "/report.html", validation_page(outcomes, page_facts(outcomes)));
  write_file_atomically(dir + "/report.json", validation_json(outcomes));
}

int work(const Task& task, const Run& run) {
  try {
    store(outcome_of(task, run), run);
    return 0;
  } catch (const std::exception& e) {
    report_error(fmt::format("ropewalk validate: {}", task.of->name).c_str(), e);
    return 3;
  }
}

void run_all(const std::vector<Task>& tasks, const Run& run) {
  std::vector<ProcessTask> processes;
  std::size_t number = 0;
  const auto tell = [&run, count = tasks.size()](std::size_t at, const Task& task, const std::string& what) {
    if (!run.arguments.quiet) fmt::print(stderr, "{}/{} {}{}\n", at, count, task.of->name, what);
  };
  for (const Task& task : tasks) {
    ++number;
    if (finished(task, run)) {
      tell(number, task, ": kept");
    } else if (!task.not_applicable.empty()) {
      tell(number, task, ": not applicable");
      store(outcome_of(task, run), run);
    } else {
      processes.push_back({[&, number] {
                             tell(number, task,
                                  task.make_atoms && task.seconds > 0
                                      ? fmt::format(": about {:.2g} min of LAMMPS", task.seconds / 60)
                                      : "");
                             return work(task, run);
                           },
                           [&](int status) {
                             if (status != 0) report_of_death(task, run, status);
                             write_reports(run.arguments.out, outcomes_in(run.arguments.out));
                           }});
    }
  }
  run_processes(processes, run.jobs);
  write_reports(run.arguments.out, outcomes_in(run.arguments.out));
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

std::vector<std::string> page_facts(const std::vector<Outcome>& outcomes) {
  std::map<std::string, UsedSet> sets;
  for (const Outcome& o : outcomes)
    for (const UsedSet& set : o.sets) sets[set.hash] = set;
  std::string of_sets;
  for (const auto& [hash, set] : sets)
    of_sets +=
        fmt::format("{}{}, {} (hash {}): {}{}", of_sets.empty() ? "Sets: " : "; ", set.name, set.tube, hash,
                    grade_with_verdicts(set.grade, hash, outcomes),
                    set.registry >= 0 ? fmt::format("; registry {:.2g} % of the well", 100 * set.registry) : "");
  return {
      of_sets + ".",
      "Registry is how the lattices of two tubes lie on one another. The model leaves it out. It is an error bar "
      "of every result that contact makes: over turns and shifts of the atoms, the energy of two tubes side by "
      "side has the standard deviation that stands with its set. Twisting energies of ropes of seven tubes move by "
      "it "
      "as the rows \"registry over twisting energy\" of their cases say, most at small angles.",
      fmt::format("Ropewalk {} ({}), {}, {}. Every run gives the same numbers, apart from the times.", version,
                  git_id, compiler, build_type)};
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

namespace {

struct ListArguments {
  bool json = false;
};

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

}  // namespace

std::vector<Outcome> run_cases(const ValidateArguments& a) {
  Run run;
  run.arguments = a;
  if (!a.parameters.empty()) run.given = read_parameters(find_parameters(a.parameters, ""));
  if (!a.with.empty()) run.second = read_parameters(find_parameters(a.with, ""));
  if (run.second && !run.given)
    throw InputError({"", 0, "--with"}, "is the second of two sets, and the first is not given",
                     "add --parameters SET");
  if (a.atoms && !run.given)
    throw InputError({"", 0, "--atoms"}, "makes atoms of the set of --parameters, and none is given",
                     "add --parameters SET, or make references of shipped sets anew with --fresh");
  if (a.budget > 0 && !a.atoms)
    throw InputError({"", 0, "--budget"}, "limits what --atoms makes, which is not there", "add --atoms");
  const std::vector<const Case*> cases = chosen_cases(a);
  make_directory(a.out);
  refuse_foreign_file(a.out + "/report.html", page_mark);
  refuse_foreign_file(a.out + "/report.json", outcome_format);
  run.key = fmt::format("{} {}{} {}", git_id, run.given ? run.given->hash : "shipped",
                        run.second ? " with " + run.second->hash : "", a.fresh ? "fresh" : "stored");
  run.jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  std::vector<Task> tasks;
  for (const Case* c : cases) tasks.push_back(task_of(*c, run));
  if (a.atoms) allow_atoms(tasks, run);
  // The longest first, so that none is left over at the end.
  std::stable_sort(tasks.begin(), tasks.end(), [](const Task& x, const Task& y) { return x.seconds > y.seconds; });
  run_all(tasks, run);
  std::vector<Outcome> outcomes;
  for (const Case* c : cases) outcomes.push_back(read_outcome(result_path(a.out, c->name)));
  return outcomes;
}

namespace {

// Exit codes: 0 all checks hold, 1 some miss, 2 wrong input, 3 a case failed.
int validate_command(const ValidateArguments& a) {
  const std::vector<Outcome> outcomes = run_cases(a);
  if (a.json) {
    fmt::print("{}", validation_json(outcomes));
  } else {
    fmt::print("{}Report: {}/report.html\n", validation_table(outcomes), a.out);
  }
  return exit_code(outcomes);
}

struct ReportArguments {
  std::string dir;
};

int validation_report_command(const ReportArguments& a) {
  const std::vector<Outcome> outcomes = outcomes_in(a.dir);
  if (outcomes.empty())
    throw InputError({a.dir, 0, ""}, "holds no results",
                     "name the directory that `ropewalk validate run --out` made");
  write_reports(a.dir, outcomes);
  fmt::print("{}/report.html\n", a.dir);
  return 0;
}

void add_run_options(CLI::App* verb, ValidateArguments& a) {
  verb->add_option("cases", a.cases, "Names of cases, see list [default: all]");
  verb->add_option(
      "--parameters", a.parameters,
      "Run the cases with this set. Those that have nothing to compare it with are listed with the reason");
  verb->add_option("--out", a.out, "Directory of results and report; finished cases in it are not run again")
      ->capture_default_str();
  verb->add_option("-j,--jobs", a.jobs, "Cases at a time [default: one for each core]")->check(whole_number(1));
  verb->add_flag("--again", a.again, "Run finished cases again");
  verb->add_flag("--json", a.json, "JSON");
  verb->add_flag("--quiet", a.quiet, "No progress lines");
}

}  // namespace

void add_list(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ListArguments>();
  CLI::App* c = app.add_subcommand("list", "List the cases");
  c->add_flag("--json", a->json, "JSON, with set-up, oracle and literature");
  c->callback([a, &program] { program.code = list_command(*a); });
}

void add_run(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ValidateArguments>();
  CLI::App* c = app.add_subcommand("run", "Run cases and write the report");
  c->add_option("--tier", a->tier, "full, or quick: without ropes and bundles")->capture_default_str();
  c->add_flag("--fresh", a->fresh, "Make the references with LAMMPS and compare them with the stored ones");
  c->add_option("--with", a->with, "A second set: pairs of unlike tubes are compared too");
  c->add_flag(
      "--atoms", a->atoms,
      "Make the references of the set's tube with LAMMPS and the set's potential, beside the set (minutes)");
  c->add_option("--budget", a->budget, "Minutes that these may take [default: any]")
      ->check(number_within(Bounds::positive()));
  add_run_options(c, *a);
  c->callback([a, &program] { program.code = validate_command(*a); });
}

void add_stability(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ValidateArguments>();
  a->stability = true;
  a->out = "stability";
  CLI::App* c = app.add_subcommand("stability", "Find where the methods fail and compare with theory");
  add_run_options(c, *a);
  c->callback([a, &program] { program.code = validate_command(*a); });
}

void add_report(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ReportArguments>();
  CLI::App* c = app.add_subcommand("report", "Write report.html and report.json again from the results");
  c->add_option("dir", a->dir, "Directory of the results")->required();
  c->callback([a, &program] { program.code = validation_report_command(*a); });
}

}  // namespace ropewalk::validate
