// `ropewalk calibrate fit DATA.csv SETTINGS.toml`: a user's own energies, with a mask of free parameters.
//
//   format = "ropewalk-fit-1"
//   model  = "stiffness"            # or "line", "paper"
//   base   = "cnt-10-10-tersoff"    # a set: starts, and what stays fixed
//   free   = ["EA", "GJ"]           # the others keep their start
//   [start]   EA = 1500             # instead of the base's
//   [bounds]  EA = [1000, 2000]     # instead of a fifth to five times the start
//   [search]  starts = 8, max_evaluations = 20000, max_seconds (none), seed = 1
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "verbs/tables.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr const char* fit_format = "ropewalk-fit-1";

// A parameter that the user may fit, with its name and unit of the parameter file.
struct Named {
  std::string name, key, unit;  // "EA", "bond.EA", "nN"
  double narrowest = 0;         // half width of the box of a parameter that starts near zero
};

// A model: its parameters, nuisance parameters that are always free, and the residuals over a scale.
struct FitModel {
  std::vector<Named> named;
  std::vector<FitParameter> nuisance;
  std::size_t residuals = 0;
  std::function<void(const std::vector<double>&, std::vector<double>&)> function;
  std::string weighting;   // meaning of a residual of 1
  std::vector<int> lines;  // line of the table for each residual
  std::string column;      // column of the energies
  double largest = 0.1;    // residual that a set may have
};

// --- Stiffness ------------------------------------------------------------------------------------------

// E/L = e0 + EA/2 e^2 + C e t + GJ/2 t^2 + third-order terms + e^4 and t^4; bent: E = (EI/2 k^2 + k4 k^4) L + the
// same two powers for the ends, which are equal at both lengths.
FitModel stiffness_model(const std::string& path) {
  auto rows = std::make_shared<std::vector<AtomisticRow>>(read_atomistic_csv(path));
  double largest = 0, strain = 0, twist = 0, curvature = 0, bend = 0;
  for (const AtomisticRow& r : *rows) {
    const double e = std::fabs(r.energy / r.length);
    if (r.kind == "stretch-twist") {
      largest = std::max(largest, e);
      strain = std::max(strain, std::fabs(r.strain));
      twist = std::max(twist, std::fabs(r.twist));
    } else if (r.kind == "bend-short" || r.kind == "bend-long") {
      bend = std::max(bend, e);
      curvature = std::max(curvature, std::fabs(r.curvature));
    }
  }
  if (!(largest > 0) && !(bend > 0))
    throw InputError({path, 0, "kind"}, "holds no stretch-twist, bend-short or bend-long energies",
                     "name the kind of each row");
  FitModel m;
  const bool straight = largest > 0, bent = bend > 0;
  // Free terms are in units of the largest energy of the window, so that all bounds are of the same size.
  const auto free_term = [&](const char* name, bool used) { m.nuisance.push_back({name, 0, -5, 5, used}); };
  if (straight) {
    m.named.insert(m.named.end(), {{"EA", "bond.EA", "nN", 0},
                                   {"GJ", "bond.GJ", "nN nm^2", 0},
                                   {"coupling", "atomistic.coupling", "nN nm", 200},
                                   {"natural_twist", "atomistic.natural_twist", "rad/nm", 0.02}});
    for (const char* name : {"offset", "e3", "e2t", "et2", "t3", "e4", "t4"}) free_term(name, true);
  }
  if (bent) {
    m.named.push_back({"EI", "bond.EI", "nN nm^2", 0});
    for (const char* name : {"k4", "end2", "end4"}) free_term(name, true);
  }
  if (straight) strain = std::max(strain, 1e-6), twist = std::max(twist, 1e-6);
  m.function = [=](const std::vector<double>& p, std::vector<double>& r) {
    const std::size_t at = (straight ? 4u : 0u) + (bent ? 1u : 0u);
    const double* extra = p.data() + at;
    const double* ends = extra + (straight ? 7 : 0);
    std::size_t n = 0;
    for (const AtomisticRow& row : *rows) {
      if (row.kind == "stretch-twist") {
        const double e = row.strain, t = row.twist - p[3], u = e / strain, v = t / twist;
        const double harmonic = (0.5 * p[0] * e * e + p[2] * e * t + 0.5 * p[1] * t * t) * units::nN_nm;
        const double others = extra[0] + extra[1] * u * u * u + extra[2] * u * u * v + extra[3] * u * v * v +
                              extra[4] * v * v * v + extra[5] * u * u * u * u + extra[6] * v * v * v * v;
        r[n++] = (harmonic - row.energy / row.length) / largest + others;
      } else if (row.kind == "bend-short" || row.kind == "bend-long") {
        const double k2 = row.curvature * row.curvature, w = k2 / (curvature * curvature);
        const double harmonic = 0.5 * p[straight ? 4 : 0] * units::nN_nm * k2;
        r[n++] = (harmonic - row.energy / row.length) / bend + ends[0] * w * w +
                 (ends[1] * w + ends[2] * w * w) / row.length;
      }
    }
  };
  for (const AtomisticRow& r : *rows)
    if (r.kind == "stretch-twist" || r.kind == "bend-short" || r.kind == "bend-long") m.lines.push_back(r.line);
  m.residuals = m.lines.size();
  m.column = "energy_eV";
  m.weighting = "the largest energy per length of the window";
  return m;
}

// --- Contact --------------------------------------------------------------------------------------------

// Energies of each kind are relative to the depth of its well. Higher repulsive energies have smaller weights.
std::vector<double> weights_of(const std::vector<ContactRow>& rows) {
  std::vector<double> weights;
  for (const ContactRow& r : rows) {
    double lowest = 0;
    for (const ContactRow& other : rows)
      if (other.kind == r.kind && std::fabs(other.angle - r.angle) < 1e-9) lowest = std::min(lowest, other.energy);
    const double depth = lowest < 0 ? -lowest : 1;
    weights.push_back(1 / (depth + 2 * std::max(r.energy, 0.0)));
  }
  return weights;
}

template <class Law, class Energy>
void add_contact_residuals(FitModel& m, std::vector<ContactRow> rows, Law law, Energy energy) {
  const std::vector<double> weights = weights_of(rows);
  m.residuals = rows.size();
  for (const ContactRow& r : rows) m.lines.push_back(r.line);
  m.column = "energy";
  m.weighting = "the depth of its well";
  m.function = [=](const std::vector<double>& p, std::vector<double>& r) {
    Law trial = law;
    set_form(p, trial);
    for (std::size_t k = 0; k < rows.size(); ++k) r[k] = weights[k] * (energy(trial, rows[k]) - rows[k].energy);
  };
}

FitModel line_model(const std::string& path, const ParameterSet& base) {
  if (!base.law<LineParameters>())
    throw InputError({base.path, 0, "contact.line"}, "is missing",
                     "take a base that has the line law: it gives the gaps");
  FitModel m;
  for (const char* name : {"K", "s", "c", "p", "q"})
    m.named.push_back({name, std::string("contact.line.") + name,
                       name[0] == 'K'                     ? "eV/nm^2"
                       : name[0] == 's' || name[0] == 'c' ? "nm"
                                                          : "1",
                       name[0] == 'c' ? 0.15 : 0});
  const auto energy = [](const LineDensity& d, const ContactRow& r) {
    if (d.core_gap + d.c <= 0) return std::numeric_limits<double>::quiet_NaN();
    if (r.kind == "density") return d.energy(r.distance);
    return r.kind == "parallel" ? line_parallel_energy(d, r.distance) : line_crossed_energy(d, r.distance, r.angle);
  };
  m.largest = unusable_contact;
  add_contact_residuals(m, read_contact_csv(path), base.law<LineParameters>()->density, energy);
  return m;
}

FitModel paper_model(const std::string& path, const ParameterSet& base) {
  if (!base.law<PaperContact>())
    throw InputError({base.path, 0, "contact.paper"}, "is missing", "take a base that has the published law");
  FitModel m;
  for (const char* name : paper_parameters)
    m.named.push_back(
        {name, std::string("contact.paper.") + name, "1", name[0] == 'C' && name[1] != '_' ? 0.05 : 0});
  std::vector<ContactRow> rows = read_contact_csv(path);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [](const ContactRow& r) { return r.kind == "density"; }),
             rows.end());
  if (rows.empty())
    throw InputError({path, 0, "kind"}, "has no parallel or crossed energies",
                     "the published law has no line density");
  const double length = base.element_length;
  const auto energy = [length](const PaperContact& k, const ContactRow& r) {
    return r.kind == "parallel" ? paper_parallel_energy(k, length, r.distance)
                                : paper_crossed_energy(k, length, r.distance, r.angle);
  };
  m.largest = 0.5;  // one point of an element has no better law where tubes touch hard
  add_contact_residuals(m, std::move(rows), *base.law<PaperContact>(), energy);
  return m;
}

// --- Settings -------------------------------------------------------------------------------------------

struct Settings {
  std::string model;
  std::optional<ParameterSet> base;
  std::vector<std::string> free;
  FitOptions search;
};

Settings read_settings(const TomlTable& top, const std::string& path) {
  static const Words<const char*> models = {{"stiffness", "stiffness"}, {"line", "line"}, {"paper", "paper"}};
  if (top.string("format") != fit_format)
    throw top.error("format", "is not that of fit settings", fmt::format("this program reads \"{}\"", fit_format));
  Settings s;
  s.model = top.word("model", models);
  if (top.has("base"))
    s.base = read_parameters(find_parameters(top.string("base"), fs::path(path).parent_path().string(),
                                             {path, top.line("base"), "base"}));
  else if (s.model != "stiffness")
    throw top.error("base", "is missing", "the contact models need a set: base = \"cnt-10-10-tersoff\"");
  s.free = top.strings("free");
  const TomlTable search = top.table("search");
  // All starts that were tried with contact laws ended alike, and each takes seconds.
  s.search.starts = static_cast<int>(search.integer_or("starts", s.model == "stiffness" ? 8 : 2, 1, 1000));
  s.search.max_evaluations = static_cast<int>(
      search.integer_or("max_evaluations", s.model == "stiffness" ? 20000 : 100000, 10, 100000000));
  s.search.max_seconds = search.number_or("max_seconds", s.search.max_seconds, Bounds::positive(1e5));
  s.search.seed = static_cast<std::uint64_t>(search.integer_or("seed", 1, 0, std::numeric_limits<long>::max()));
  return s;
}

double start_of(const TomlTable& start, const Settings& s, const Named& n) {
  if (start.has(n.name)) return start.number(n.name, Bounds::any());
  if (s.base)
    if (const Quantity* q = find_quantity(*s.base, n.key)) return q->value;
  if (n.narrowest > 0) return 0;
  throw start.error(n.name, "is missing", fmt::format("give a start in {}, or a base", n.unit));
}

FitParameter parameter_of(const TomlTable& start, const TomlTable& bounds, const Settings& s, const Named& n) {
  FitParameter p;
  p.name = n.name;
  p.start = start_of(start, s, n);
  p.free = std::find(s.free.begin(), s.free.end(), n.name) != s.free.end();
  const double half = std::max(n.narrowest, 0.0);
  const double near = 0.2 * p.start, far = 5 * p.start;
  p.lower = half > 0 ? p.start - half : std::min(near, far);
  p.upper = half > 0 ? p.start + half : std::max(near, far);
  if (bounds.has(n.name)) {
    const std::vector<double> b = bounds.numbers(n.name, Bounds::any(), 2);
    if (!(b[0] < b[1])) throw bounds.error(n.name, "is no interval", "write [lower, upper]");
    p.lower = b[0], p.upper = b[1];
  }
  if (p.free && !(p.start >= p.lower && p.start <= p.upper))
    throw bounds.error(n.name, fmt::format("[{}, {}] leaves out the start {}", p.lower, p.upper, p.start),
                       "move the bounds or the start");
  return p;
}

void check_free(const TomlTable& top, const Settings& s, const FitModel& m) {
  std::vector<std::string> names;
  for (const Named& n : m.named) names.push_back(n.name);
  for (const std::string& f : s.free)
    if (std::find(names.begin(), names.end(), f) == names.end())
      throw top.error(
          "free",
          fmt::format("names \"{}\", which the data do not hold or the model does not have", printable(f, 40)),
          fmt::format("choose of: {}", fmt::join(names, ", ")));
}

// --- Result ---------------------------------------------------------------------------------------------

// Quantities that follow from the line law, computed again after the law has changed.
void renew_wells(const Settings& s, const FitResult& fit, ParameterSet& set) {
  LineDensity d = s.base->law<LineParameters>()->density;
  set_form(fit.value, d);
  const LineWell parallel = line_parallel_well(d), crossed = line_crossed_well(d, 0.5 * units::pi);
  const std::pair<const char*, double> values[] = {{"contact.line.pair_spacing", parallel.distance},
                                                   {"contact.line.pair_energy", parallel.energy},
                                                   {"contact.line.cross90_energy", crossed.energy}};
  for (const auto& [key, value] : values)
    for (Quantity& q : set.quantities)
      if (q.key == key)
        q = {key, value, q.unit, fit.rms * std::fabs(value), "derived", "", "of the law; error by rms"};
}

// The shear stiffness of a thin tube follows from EA and GJ (add_bond in calibration.cpp).
void renew_shear(const Settings& s, ParameterSet& set) {
  const auto is_free = [&](const char* name) {
    return std::find(s.free.begin(), s.free.end(), name) != s.free.end();
  };
  if (set.filament || !set.walls.empty() || (!is_free("EA") && !is_free("GJ"))) return;
  const auto value = [&](const char* key) { return find_quantity(set, key)->value * units::nN_nm; };
  BondStiffness bond;
  bond.stretch = value("bond.EA");
  bond.twist = value("bond.GJ");
  const double relative_error = find_quantity(set, "bond.GJ")->standard_error.value_or(0) / value("bond.GJ");
  for (Quantity& q : set.quantities)
    if (q.key == "bond.kGA" && q.origin == "derived") {
      q.value = thin_tube_shear(bond, set.radius) * units::eV_in_nN_nm;
      q.standard_error = relative_error * units::nN_nm * q.value;
    }
}

// The groups of the base that name a fitted number are replaced by one of this fit.
void renew_correlations(const Settings& s, const FitModel& m, const FitResult& fit, ParameterSet& set) {
  Correlation fitted;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < m.named.size(); ++k) {
    const bool is_free = std::find(s.free.begin(), s.free.end(), m.named[k].name) != s.free.end();
    if (!is_free || !std::isfinite(fit.standard_error[k]) || !find_quantity(set, m.named[k].key)) continue;
    fitted.of.push_back(m.named[k].key);
    places.push_back(k);
  }
  const auto names_fitted = [&](const Correlation& c) {
    return std::any_of(c.of.begin(), c.of.end(), [&](const std::string& key) {
      return std::find(fitted.of.begin(), fitted.of.end(), key) != fitted.of.end();
    });
  };
  auto& all = set.correlations;
  all.erase(std::remove_if(all.begin(), all.end(), names_fitted), all.end());
  if (places.size() < 2) return;
  for (const std::size_t i : places) {
    fitted.matrix.emplace_back();
    for (const std::size_t j : places) fitted.matrix.back().push_back(fit.correlation[i][j]);
  }
  all.push_back(std::move(fitted));
}

// The base set with the fitted numbers; `command` is recorded as their origin.
std::string new_set(const Settings& s, const FitModel& m, const FitResult& fit, const FitArguments& a) {
  ParameterSet set = *s.base;
  for (std::size_t k = 0; k < m.named.size(); ++k)
    for (Quantity& q : set.quantities) {
      if (q.key != m.named[k].key || std::find(s.free.begin(), s.free.end(), m.named[k].name) == s.free.end())
        continue;
      q.value = fit.value[k];
      q.standard_error =
          std::isfinite(fit.standard_error[k]) ? std::optional<double>(fit.standard_error[k]) : std::nullopt;
      q.origin = "calibrated";
      q.doi = "";
      q.note = "fitted to " + fs::path(a.data).filename().string();
    }
  if (s.model == "line") {
    renew_wells(s, fit, set);
    for (Quantity& q : set.quantities)
      if (q.key == "contact.line.K")
        q.note = fmt::format("fitted to {}; fit error {:.1e} of the well", fs::path(a.data).filename().string(),
                             fit.largest);
  }
  if (s.model == "stiffness") renew_shear(s, set);
  renew_correlations(s, m, fit, set);
  set.name = fs::path(a.out).stem().string();
  set.provenance.emplace_back("fit_command", a.command);
  set.provenance.emplace_back("fit_data_hash", hash_hex(read_file(a.data)));
  set.provenance.emplace_back("fit_base_hash", s.base->hash);
  return parameters_text(set, fmt::format("# {} with {} fitted anew. Made by\n#   {}\n", s.base->name,
                                          fmt::join(s.free, ", "), a.command));
}

// Numbers that are zero in some tubes have the half width of their box as a measure.
bool is_determined(const Named& n, double value, double error) {
  return error <= std::max(std::fabs(value), n.narrowest);
}

// Why no set is made of a fit that ended well by itself.
std::optional<InputError> fault_of(const FitModel& m, const std::vector<FitParameter>& parameters,
                                   const FitResult& fit, const FitArguments& a, const TomlTable& top) {
  std::vector<double> left(m.residuals);
  m.function(fit.value, left);
  const auto worst =
      std::max_element(left.begin(), left.end(), [](double x, double y) { return std::fabs(x) < std::fabs(y); });
  if (std::fabs(*worst) > m.largest)
    return InputError(
        {a.data, m.lines[static_cast<std::size_t>(worst - left.begin())], m.column},
        fmt::format("the fit misses this energy by {:.2g} of {}, and a set may miss {:.2g}", std::fabs(*worst),
                    m.weighting, m.largest),
        "check its unit and, of a tube, that energies count from the relaxed straight one, for all rows; or take "
        "this row out");
  const InputError::Place settings{a.settings, top.line("free"), "free"};
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const FitParameter& p = parameters[k];
    const bool named = k < m.named.size();
    if (std::find(fit.at_bound.begin(), fit.at_bound.end(), p.name) != fit.at_bound.end())
      return InputError(
          settings,
          named ? fmt::format("{} ended at a bound of its box, {:.6g} to {:.6g} {}", p.name, p.lower, p.upper,
                              m.named[k].unit)
                : fmt::format("the term {} of the energies ended at its bound", p.name),
          fmt::format("check the energies of {} and their units{}", a.data,
                      named ? "; if such values are meant, widen [bounds], else take it out of free" : ""));
    if (named && p.free && !is_determined(m.named[k], fit.value[k], fit.standard_error[k]))
      return InputError(settings,
                        fmt::format("these data do not determine {}: {:.6g} +- {:.2g} {}", p.name, fit.value[k],
                                    fit.standard_error[k], m.named[k].unit),
                        "take it out of free, or bring more and better energies");
  }
  return std::nullopt;
}

void print_fit(const FitModel& m, const std::vector<FitParameter>& parameters, const FitResult& fit) {
  for (std::size_t k = 0; k < m.named.size(); ++k)
    fmt::print("  {:<14} {:>16.9g}  {:<24} {}\n", m.named[k].name, fit.value[k],
               parameters[k].free ? fmt::format("+- {:.3g}", fit.standard_error[k]) : "(held)", m.named[k].unit);
  fmt::print("  {} residuals, rms {:.3g}, largest {:.3g} of {}; {} evaluations\n  {}\n", m.residuals, fit.rms,
             fit.largest, m.weighting, fit.evaluations, fit.message);
}

nlohmann::ordered_json fit_json(const FitModel& m, const FitResult& fit, bool usable) {
  nlohmann::ordered_json j;
  for (std::size_t k = 0; k < m.named.size(); ++k) {
    j[m.named[k].name] = fit.value[k];
    j[m.named[k].name + "_standard_error"] = fit.standard_error[k];
  }
  j["rms"] = fit.rms;
  j["largest"] = fit.largest;
  j["evaluations"] = fit.evaluations;
  j["verdict"] = fit.message;
  j["usable"] = usable;
  return j;
}

}  // namespace

int fit_command(const FitArguments& a) {
  const TomlTable top = TomlTable::parse(read_file(a.settings), a.settings);
  const Settings s = read_settings(top, a.settings);
  if (!a.out.empty()) {
    if (!s.base) throw InputError({"", 0, "--out"}, "needs a base in the settings", "add base = \"...\"");
    check_output(a.out, "--out", a.force);
  }
  const FitModel m = s.model == "stiffness" ? stiffness_model(a.data)
                     : s.model == "line"    ? line_model(a.data, *s.base)
                                            : paper_model(a.data, *s.base);
  check_free(top, s, m);
  std::vector<FitParameter> parameters;
  // One object only, since a table records which of its keys were read.
  const TomlTable start = top.table("start"), bounds = top.table("bounds");
  for (const Named& n : m.named) parameters.push_back(parameter_of(start, bounds, s, n));
  parameters.insert(parameters.end(), m.nuisance.begin(), m.nuisance.end());
  top.finish();
  const auto unknown = static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(), [](const FitParameter& p) { return p.free; }));
  if (m.residuals < unknown)
    throw InputError({a.data, 0, ""}, fmt::format("has {} energies for {} unknowns", m.residuals, unknown),
                     "bring more data, or free fewer parameters");
  const FitResult fit = fit_least_squares(parameters, m.residuals, m.function, s.search);
  const auto fault = fit.usable() ? fault_of(m, parameters, fit, a, top) : std::nullopt;
  if (a.json) {
    fmt::print("{}\n", fit_json(m, fit, fit.usable() && !fault).dump(1));
  } else {
    print_fit(m, parameters, fit);
  }
  if (!fit.usable()) return 3;
  if (fault) throw *fault;
  if (!a.out.empty()) {
    const std::string text = new_set(s, m, fit, a);
    parameters_of_text(text, a.out);  // throws where other commands would refuse it
    write_file_atomically(a.out, text);
    if (!a.json) fmt::print("Set: {}\n", a.out);
  }
  return 0;
}

void add_fit(CLI::App& app, Program& program) {
  const auto a = std::make_shared<FitArguments>();
  a->command = program.command;
  CLI::App* c = app.add_subcommand("fit", "Fit a table of energies of your own");
  c->add_option("data", a->data, "CSV: energies of stretch, twist and bend, or of contact")->required();
  c->add_option("settings", a->settings, "TOML: model, free parameters, starts and bounds")->required();
  c->add_option("--out", a->out, "Write the base set with the fitted numbers to this file");
  c->add_flag("--json", a->json, "JSON");
  c->add_flag("--force", a->force, "Replace an existing file");
  c->callback([a, &program] { program.code = fit_command(*a); });
}

}  // namespace ropewalk::calibrate
