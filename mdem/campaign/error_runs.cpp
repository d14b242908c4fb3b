#include "campaign/error_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "campaign/repeated_run.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "scene/scene_place.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Relative change of a parameter: large enough that rounding and the way that a motion takes do not count.
constexpr double least_step = 0.005, largest_step = 0.9;
// Relative error of a size of the tube or of its mass below which its influence is none.
constexpr double exact = 1e-5;
constexpr std::size_t all_sets = std::numeric_limits<std::size_t>::max();  // for VariedNumber::index

// Contacts between tubes, about as many as in a hexagonal rope; each has a registry of its own.
double contacts_of(int tubes) { return tubes < 2 ? 1 : std::max(1.0, 3 * tubes - std::sqrt(12.0 * tubes - 3)); }

double relative_error(const InputNumber& q) {
  return q.value != 0 ? q.standard_error.value_or(0) / std::fabs(q.value) : 0;
}

// Largest relative error of the contact energies: of the closed form, of the relaxed geometry, and of registry,
// which evens out over the contacts of a rope.
double contact_error(const ParameterSet& set, int tubes) {
  const Quantity* well = find_quantity(set, "contact.line.pair_energy");
  const double fit = well ? well->standard_error.value_or(0) / std::fabs(well->value) : 0;
  return std::hypot(fit, std::max(0.0, registry_deviation(set)) / std::sqrt(contacts_of(tubes)));
}

class InputsOf {
 public:
  InputsOf(const Scene& scene, int tubes) : scene_(scene), tubes_(tubes), numbers_(input_numbers(scene)) {}

  ErrorInputs all() {
    for (std::size_t k = 0; k < scene_.sets.size(); ++k) add_set(k);
    if (scene_.sets.size() > 1 && scene_.contact.law == "line") add_unlike_contact();
    for (const InputNumber& n : numbers_)
      if (n.of != InputNumber::Of::set) add_typed(n);
    return std::move(out_);
  }

 private:
  using Of = InputNumber::Of;

  void add(const std::string& name, const std::string& folder, double sigma, double step,
           const std::string& correlated, Of of, std::size_t index, std::vector<std::string> paths,
           std::string log_path = "") {
    out_.varied.push_back({{name, folder + "-plus", folder + "-minus", sigma, step, correlated},
                           of,
                           index,
                           std::move(paths),
                           std::move(log_path)});
  }
  // Whether tubes may be stretched beyond the window of [bond.anharmonic].
  bool breaks() const {
    return std::any_of(scene_.drives.begin(), scene_.drives.end(),
                       [](const auto& drive) { return drive->table().name == "failure"; });
  }
  static double step_of(double sigma) { return std::min(largest_step, std::max(least_step, sigma)); }

  // The stiffnesses and the contact energy; terms beyond Hooke's law one by one, where they act.
  void add_set(std::size_t k) {
    const ParameterSet& set = scene_.sets[k];
    const std::string of = scene_.sets.size() > 1 ? " of " + set.name : "",
                      folder = k > 0 ? fmt::format("type-{}-", k) : "";
    const auto varied = [&](const std::string& name, double sigma, const std::string& correlated,
                            const std::vector<std::string>& keys) {
      if (!(sigma > 0)) return;
      std::vector<std::string> paths;
      for (const std::string& key : keys)
        if (find_quantity(set, key)) paths.push_back(key + ".value");
      add(name + of, folder + name, sigma, step_of(sigma), correlated, Of::set, k, paths);
    };
    std::string none;
    for (const InputNumber& n : numbers_) {
      if (n.of != Of::set || n.index != k) continue;
      const auto in = [&](const char* section) { return n.key.rfind(section, 0) == 0; };
      const bool of_section = in("tube.") || in("filament.");
      const double sigma = relative_error(n);
      const std::string name = n.key.substr(n.key.rfind('.') + 1);
      if (in("bond.anharmonic.")) {
        if (scene_.bond.anharmonic) varied(name, sigma, "", {n.key});
      } else if (in("bond.pull.")) {
        if (breaks()) varied("pull_" + name, sigma, "", {n.key});
      } else if (in("bond.")) {
        if (!n.standard_error)
          none += (none.empty() ? "" : ", ") + name;
        else if (name == "GJ")
          varied(name, sigma, set.filament ? "" : n.key, {n.key, "bond.kGA"});
        else if (name != "kGA")
          varied(name, sigma, set.filament ? "" : n.key, {n.key});
      } else if (of_section && sigma >= exact) {
        varied(name, sigma, "", {n.key});
      } else if (of_section && sigma > 0) {
        out_.not_varied.push_back(fmt::format("{}{} (known to {:.1g})", name, of, sigma));
      } else if (of_section && n.standard_error.value_or(0) > 0) {
        out_.not_varied.push_back(fmt::format("{}{} (is zero)", name, of));
      }
    }
    if (scene_.contact.law == "line") {
      std::vector<std::string> keys = {"contact.line.K", "contact.line.pair_energy", "contact.line.cross90_energy"};
      // That of atoms, which all sets of a scene share.
      if (scene_.sets.size() == 1) keys.push_back("contact.line.epsilon");
      varied("contact", contact_error(set, tubes_), "", keys);
    } else if (scene_.contact.law == "paper") {
      const Quantity* epsilon = find_quantity(set, "contact.paper.epsilon");
      if (epsilon && !epsilon->standard_error)
        none += (none.empty() ? "" : ", ") + std::string("contact");
      else
        out_.not_varied.push_back("contact.paper" + of + " (errors of single coefficients, none of the law)");
    }
    if (!none.empty()) out_.without_error.push_back(fmt::format("{} of {}", none, set.name));
  }

  // The contact of pairs of unlike tubes, which have no registry.
  void add_unlike_contact() {
    const Quantity* fit = find_quantity(scene_.sets.front(), "contact.line.universal.error");
    if (!fit || !(fit->value > 0)) return;
    for (std::size_t k = 0; k < scene_.sets.size(); ++k)
      if (!scene_.sets[k].law<LineParameters>() || !scene_.sets[k].law<LineParameters>()->has_universal) return;
    add("contact of unlike tubes", "contact-unlike", fit->value, step_of(fit->value), "", Of::set, all_sets, {},
        "contact.line.universal.log_K.values.0");
  }

  void add_typed(const InputNumber& n) {
    const std::vector<std::string> files = input_files(scene_);
    const bool file = n.of == Of::file;
    const std::string of = file && files.size() > 1 ? fmt::format(" of file {}", n.index) : "";
    if (!n.standard_error) {
      out_.without_error.push_back(fmt::format("{}{} = {:.4g}{}", n.key, of, n.value, n.typed ? "" : " (default)"));
      return;
    }
    if (!(*n.standard_error > 0)) {
      if (n.value != 0 || !file) out_.not_varied.push_back(fmt::format("{}{} (said to be exact)", n.key, of));
      return;
    }
    std::string folder = (file && files.size() > 1 ? fmt::format("file-{}-", n.index) : "") + n.key;
    std::replace(folder.begin(), folder.end(), '.', '-');
    const std::string path = file ? n.key + ".value" : n.key;
    const double sigma = n.value != 0 ? relative_error(n) : *n.standard_error;
    add(n.key + of, folder, sigma, n.value != 0 ? step_of(sigma) : sigma, "", n.of, n.index, {path});
    if (n.value == 0) out_.varied.back().error.minus.clear();  // a strength is not negative
  }

  const Scene& scene_;
  int tubes_;
  std::vector<InputNumber> numbers_;
  ErrorInputs out_;
};

// The text of a file with its values changed. They are read as they stand there, so that no digit is lost.
std::string changed_text(std::string text, const VariedNumber& source, bool plus) {
  if (source.of == InputNumber::Of::set) text = with_start_of_pull(text, source.error.name);
  const double step = (plus ? 1 : -1) * source.error.step;
  const auto change = [&](const std::string& path, const auto& changed) {
    text = with_value(text, path, fmt::format("{:.17g}", changed(number_at(text, path, source.error.name))),
                      source.error.name);
  };
  for (const std::string& path : source.paths)
    change(path, [&](double value) { return value != 0 ? value * (1 + step) : step; });
  if (!source.log_path.empty()) change(source.log_path, [&](double value) { return value + std::log1p(step); });
  return fmt::format("# {} changed by {:+.3g}{}, by `ropewalk errors`.\n", source.error.name,
                     source.error.minus.empty() ? step : 100 * step, source.error.minus.empty() ? "" : " %") +
         text;
}

}  // namespace

ErrorInputs inputs_with_errors(const Scene& scene, int tubes) { return InputsOf(scene, tubes).all(); }

ErrorInputs error_inputs(const Scene& scene, int tubes) {
  ErrorInputs out = inputs_with_errors(scene, tubes);
  if (out.varied.empty())
    throw InputError(place_in(scene, "parameters"), "has no number with a standard error",
                     "take a calibrated set, since the published one gives none, or write numbers of the scene as "
                     "{ value = 0.16, standard_error = 0.02 }");
  return out;
}

std::vector<std::vector<double>> correlation_of(const std::vector<VariedNumber>& sources, const Scene& scene) {
  std::vector<std::vector<double>> out(sources.size(), std::vector<double>(sources.size(), 0));
  for (std::size_t i = 0; i < sources.size(); ++i)
    for (std::size_t j = 0; j < sources.size(); ++j) {
      out[i][j] = i == j ? 1 : 0;
      const VariedNumber &a = sources[i], &b = sources[j];
      if (i == j || a.index != b.index || a.error.key.empty() || b.error.key.empty()) continue;
      const auto c = covariance(scene.sets[a.index], {a.error.key, b.error.key});
      out[i][j] = c[0][1] / std::sqrt(c[0][0] * c[1][1]);
    }
  return out;
}

int ErrorRuns::run(const VariedNumber& source, bool plus) const {
  refuse_strange_files(base_);
  const std::string changed = changed_text(read_file(original(source)), source, plus),
                    name = plus ? source.error.plus : source.error.minus;
  RunInputs inputs = inputs_of(base_, scene_, prepared_);
  for (std::size_t k = 0; k < inputs.sets.size(); ++k)
    if (source.of == InputNumber::Of::set && (source.index == k || source.index == all_sets))
      inputs.sets[k] = changed_text(inputs.sets[k], source, plus);
  if (source.of == InputNumber::Of::file) inputs.files.at(source.index) = changed;
  inputs.scene = repeatable_scene(source.of == InputNumber::Of::scene ? changed : inputs.scene, scene_, prepared_);
  const int code = repeat_run(base_, scene_, name, inputs, again_);
  const std::string note = base_.path + "/errors/" + name + "/changed.toml";
  if (code == 0 && !(fs::exists(note) && read_file(note) == changed)) write_file_atomically(note, changed);
  return code;
}

std::string ErrorRuns::original(const VariedNumber& source) const {
  switch (source.of) {
    case InputNumber::Of::set:
      return base_.parameters(source.index == all_sets ? 0 : source.index);
    case InputNumber::Of::file:
      return input_files(scene_).at(source.index);
    case InputNumber::Of::scene:
      break;
  }
  return base_.scene();
}

}  // namespace ropewalk
