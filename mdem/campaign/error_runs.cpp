#include "campaign/error_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/manifest.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "run/begin_run.hpp"
#include "run/terminal_listener.hpp"
#include "scene/kinds/state.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Relative change of a parameter: large enough that rounding and the way that a motion takes do not count.
constexpr double least_step = 0.005;

void multiply(ParameterSet& set, const std::vector<std::string>& keys, double factor) {
  for (Quantity& q : set.quantities)
    if (std::find(keys.begin(), keys.end(), q.key) != keys.end()) q.value *= factor;
  // The force of the pull goes on from that of EA.
  if (set.pull && std::find(keys.begin(), keys.end(), "bond.EA") != keys.end())
    for (double& force : set.pull->force) force *= factor;
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

// The run whose numbers are varied has told the notes on its scene.
class VariedRunListener : public TerminalListener {
 public:
  VariedRunListener() : TerminalListener(true) {}
  void tell_note(const std::string&) override {}
};

bool finished(const RunDirectory& dir, const std::string& parameters) {
  return fs::exists(dir.manifest()) && fs::exists(dir.parameters(0)) &&
         read_manifest(dir.manifest()).status == "finished" && read_file(dir.file("changed.toml")) == parameters;
}

}  // namespace

std::vector<VariedNumber> varied_numbers(const Scene& scene, int tubes) {
  std::vector<VariedNumber> all;
  for (std::size_t k = 0; k < scene.sets.size(); ++k) {
    const ParameterSet& set = scene.sets[k];
    const std::string of = scene.sets.size() > 1 ? " of " + set.name : "";
    const auto add = [&](const std::string& name, double sigma, std::vector<std::string> keys,
                         const std::string& correlated) {
      if (!(sigma > 0)) return;
      const std::string folder = (k > 0 ? fmt::format("type-{}-", k) : "") + name;
      all.push_back(
          {{name + of, folder + "-plus", folder + "-minus", sigma, std::max(least_step, sigma), correlated},
           k,
           std::move(keys)});
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
      if (i == j || a.set != b.set || a.error.key.empty() || b.error.key.empty()) continue;
      const auto c = covariance(scene.sets[a.set], {a.error.key, b.error.key});
      out[i][j] = c[0][1] / std::sqrt(c[0][0] * c[1][1]);
    }
  return out;
}

int ErrorRuns::run(const VariedNumber& source, bool plus) const {
  const RunDirectory dir{base_.path + "/errors/" + (plus ? source.error.plus : source.error.minus)};
  refuse_strange_files(base_);
  const std::string text = changed_set(source, plus);
  if (!again_ && fs::exists(dir.file("changed.toml")) && finished(dir, text)) return 0;
  remove_run(dir, "--again");
  fs::create_directories(base_.path + "/errors");
  Draft set(dir.path + ".toml");  // for the time of the run
  set.write(text);
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < scene_.sets.size(); ++k)
    sets.push_back(k == source.set ? set.name() : base_.parameters(k));
  Scene scene = read_scene(base_.scene(), sets);
  if (scene.from_file()) scene.source = std::make_shared<StateSource>(base_.state(), base_.state_memory());
  scene.run.time_step = time_step_;
  scene.run.frames_every = 1e9;  // ps: the logs alone are compared
  VariedRunListener listener;
  const int code = tell_end(go_through(begin_run(scene, dir, {}, listener)));
  write_file_atomically(dir.file("changed.toml"), text);
  return code;
}

std::string ErrorRuns::changed_set(const VariedNumber& source, bool plus) const {
  ParameterSet set = scene_.sets[source.set];
  multiply(set, source.keys, 1 + (plus ? 1 : -1) * source.error.step);
  return parameters_text(set, fmt::format("# {} with {} changed by {:+.3g} %, by `ropewalk errors`.\n", set.name,
                                          source.error.name, (plus ? 100 : -100) * source.error.step));
}

}  // namespace ropewalk
