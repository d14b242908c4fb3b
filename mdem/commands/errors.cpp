// `errors`: how the standard errors of the parameter sets carry through a run.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "commands/commands.hpp"
#include "io/failure.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/manifest.hpp"
#include "io/parameters_toml.hpp"
#include "io/processes.hpp"
#include "io/run_errors.hpp"
#include "model/error.hpp"
#include "run/run_directory.hpp"
#include "run/tell.hpp"
#include "scene/kinds/state.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Relative change of a parameter: large enough that rounding and the way that a motion takes do not count.
constexpr double least_step = 0.005;

struct VariedNumber {
  ErrorSource error;
  std::size_t set = 0;
  std::vector<std::string> keys;  // of the quantities that change together
  std::string correlated;         // the key whose correlations count; empty: independent
};

void multiply(ParameterSet& set, const std::vector<std::string>& keys, double factor) {
  for (Quantity& q : set.quantities)
    if (std::find(keys.begin(), keys.end(), q.key) != keys.end()) q.value *= factor;
}

// Contacts between tubes, about as many as in a hexagonal rope; each has a registry of its own.
double contacts_of(int tubes) { return tubes < 2 ? 1 : std::max(1.0, 3 * tubes - std::sqrt(12.0 * tubes - 3)); }

// Largest relative error of the contact energies: of the closed form, of the relaxed geometry, and of registry,
// which evens out over the contacts of a rope.
double contact_error(const ParameterSet& set, int tubes) {
  const Quantity* well = find_quantity(set, "contact.line.pair_energy");
  const double fit = well ? well->standard_error.value_or(0) / std::fabs(well->value) : 0;
  return std::hypot(fit, std::max(0.0, registry_deviation(set)) / std::sqrt(contacts_of(tubes)));
}

std::vector<VariedNumber> sources_of(const Scene& scene, int tubes) {
  std::vector<VariedNumber> all;
  for (std::size_t k = 0; k < scene.sets.size(); ++k) {
    const ParameterSet& set = scene.sets[k];
    const std::string of = scene.sets.size() > 1 ? " of " + set.name : "";
    const auto add = [&](const std::string& name, double sigma, std::vector<std::string> keys,
                         std::string correlated) {
      if (!(sigma > 0)) return;
      const std::string folder = (k > 0 ? fmt::format("type-{}-", k) : "") + name;
      all.push_back({{name + of, folder + "-plus", folder + "-minus", sigma, std::max(least_step, sigma)},
                     k,
                     std::move(keys),
                     std::move(correlated)});
    };
    const auto relative = [&](const char* key) {
      const Quantity* q = find_quantity(set, key);
      return q && q->value != 0 ? q->standard_error.value_or(0) / std::fabs(q->value) : 0;
    };
    add("EA", relative("bond.EA"), {"bond.EA"}, "bond.EA");
    add("EI", relative("bond.EI"), {"bond.EI"}, "bond.EI");
    add("GJ", relative("bond.GJ"), {"bond.GJ", "bond.kGA"}, "bond.GJ");
    if (scene.contact.law == "line")
      add("contact", contact_error(set, tubes),
          {"contact.line.K", "contact.line.epsilon", "contact.line.pair_energy", "contact.line.cross90_energy"},
          "");
  }
  if (all.empty())
    throw InputError({scene.path, 0, "parameters"}, "has no number with a standard error",
                     "take a calibrated set: the published one gives none");
  return all;
}

std::vector<std::vector<double>> correlation_of(const std::vector<VariedNumber>& sources, const Scene& scene) {
  std::vector<std::vector<double>> out(sources.size(), std::vector<double>(sources.size(), 0));
  for (std::size_t i = 0; i < sources.size(); ++i)
    for (std::size_t j = 0; j < sources.size(); ++j) {
      out[i][j] = i == j ? 1 : 0;
      const VariedNumber &a = sources[i], &b = sources[j];
      if (i == j || a.set != b.set || a.correlated.empty() || b.correlated.empty()) continue;
      const auto c = covariance(scene.sets[a.set], {a.correlated, b.correlated});
      out[i][j] = c[0][1] / std::sqrt(c[0][0] * c[1][1]);
    }
  return out;
}

bool finished(const RunDirectory& dir, const std::string& parameters) {
  return fs::exists(dir.manifest()) && fs::exists(dir.parameters(0)) &&
         read_manifest(dir.manifest()).status == "finished" && read_file(dir.file("changed.toml")) == parameters;
}

// One repetition of the run, with one set changed.
struct Repetition {
  const VariedNumber* source = nullptr;
  bool plus = false;
};

class Repetitions {
 public:
  Repetitions(const RunDirectory& base, const Scene& scene, double time_step, const ErrorsArguments& arguments)
      : base_(base), scene_(scene), time_step_(time_step), arguments_(arguments) {}

  int run(const Repetition& r) const {
    const RunDirectory dir{base_.path + "/errors/" + (r.plus ? r.source->error.plus : r.source->error.minus)};
    const std::string text = changed(r);
    if (!arguments_.again && fs::exists(dir.file("changed.toml")) && finished(dir, text)) return 0;
    fs::remove_all(dir.path);
    fs::create_directories(base_.path + "/errors");
    const std::string set = dir.path + ".toml";
    write_file_atomically(set, text);
    std::vector<std::string> sets;
    for (std::size_t k = 0; k < scene_.sets.size(); ++k)
      sets.push_back(k == r.source->set ? set : base_.parameters(k));
    Scene scene = read_scene(base_.scene(), sets);
    if (scene.from_file()) scene.source = std::make_shared<StateSource>(base_.state());
    scene.run.time_step = time_step_;
    scene.run.frames_every = 1e9;  // ps: the logs alone are compared
    scene.run.paraview = false;
    RunArguments a;
    a.out = dir.path;
    a.quiet = true;
    const int code = run_scene(scene, a);
    write_file_atomically(dir.file("changed.toml"), text);
    fs::remove(set);
    return code;
  }

 private:
  std::string changed(const Repetition& r) const {
    ParameterSet set = scene_.sets[r.source->set];
    multiply(set, r.source->keys, 1 + (r.plus ? 1 : -1) * r.source->error.step);
    return parameters_text(set, fmt::format("# {} with {} changed by {:+.3g} %, by `ropewalk errors`.\n", set.name,
                                            r.source->error.name, (r.plus ? 100 : -100) * r.source->error.step));
  }

  RunDirectory base_;
  const Scene& scene_;
  double time_step_;
  const ErrorsArguments& arguments_;
};

void print_table(const RunErrors& errors, const std::vector<LogRow>& log) {
  fmt::print("{:<26} {:>14} {:>12}   {}\n", "at the end", "value", "std. error", "from");
  for (std::size_t k = 0; k < observables().size(); ++k) {
    const Observable& o = observables()[k];
    if (o.name == "step" || o.name == "time_ps") continue;
    const ResultError e = errors.of(log.size() - 1, [k](const LogRow& row) { return row.values()[k]; });
    if (!std::isfinite(e.error) || e.error == 0) continue;
    double sum = 0;
    for (const double part : e.parts) sum += part * part;
    std::vector<std::pair<double, std::string>> shares;
    for (std::size_t i = 0; i < e.parts.size(); ++i)
      shares.emplace_back(e.parts[i] * e.parts[i] / sum, errors.sources()[i].name);
    std::sort(shares.rbegin(), shares.rend());
    std::string from;
    for (const auto& [share, name] : shares)
      if (share > 0.05) from += fmt::format("{}{} {:.0f} %", from.empty() ? "" : ", ", name, 100 * share);
    fmt::print("{:<26} {:>14.6g} {:>12.2g}   {}{}\n", o.name, log.back().values()[k], e.error, from,
               e.linear ? "" : "; not linear: an estimate of its size only");
  }
}

}  // namespace

int errors_command(const ErrorsArguments& a) {
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const Manifest manifest = read_manifest(dir.manifest());
  if (manifest.status != "finished")
    throw InputError({dir.path, 0, ""}, fmt::format("is a run that is {}", manifest.status),
                     "end it with `ropewalk resume`, or run the scene anew");
  const std::vector<LogRow> log = read_log(dir.log());
  if (log.empty()) throw InputError({dir.log(), 0, ""}, "has no rows", "run the scene anew");
  const std::vector<VariedNumber> sources = sources_of(scene, prepared.topology.tubes());
  const Repetitions repetitions(dir, scene, prepared.time_step, a);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  std::vector<ProcessTask> tasks;
  std::vector<std::string> failed;
  std::size_t number = 0;
  if (!a.quiet)
    tell_as_is(fmt::format(
        "{} runs like this one, about {:.2g} min on {} cores\n", 2 * sources.size(),
        2 * static_cast<double>(sources.size()) * manifest.wall_seconds * manifest.threads / jobs / 60, jobs));
  for (const VariedNumber& source : sources)
    for (const bool plus : {true, false}) {
      ++number;
      const std::string name = plus ? source.error.plus : source.error.minus;
      tasks.push_back({[&, plus, number, name] {
                         if (!a.quiet) tell_as_is(fmt::format("{}/{} {}\n", number, 2 * sources.size(), name));
                         try {
                           if (!std::freopen("/dev/null", "w", stdout)) return 3;
                           return repetitions.run({&source, plus});
                         } catch (const std::exception& e) {
                           return tell_failure(fmt::format("ropewalk errors: {}", name).c_str(), e);
                         }
                       },
                       [&failed, name](int status) {
                         if (status != 0) failed.push_back(name);
                       }});
    }
  run_processes(tasks, jobs);
  if (!failed.empty())
    throw std::runtime_error(
        fmt::format("{} of {} runs did not finish ({}): these results are too sensitive for an error "
                    "to be given",
                    failed.size(), tasks.size(), failed.front()));
  std::vector<ErrorSource> described;
  for (const VariedNumber& s : sources) described.push_back(s.error);
  const RunErrors errors(dir.path + "/errors", described, correlation_of(sources, scene), log);
  write_file_atomically(dir.path + "/errors/errors.json", run_errors_json(errors, log));
  write_file_atomically(dir.file("errors.csv"), run_errors_csv(errors, log));
  write_report(dir, scene, prepared);
  if (a.json) {
    fmt::print("{}", run_errors_json(errors, log));
  } else {
    print_table(errors, log);
    fmt::print("Errors of every row: {}; bands in {}\n", dir.file("errors.csv"), dir.report());
  }
  return 0;
}

}  // namespace ropewalk
