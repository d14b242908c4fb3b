#include "scene/scene_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "scene/build.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr double longest_time = 1e7;   // ps
constexpr double largest_force = 1e4;  // nN, nN nm
constexpr double kilobytes_per_element = 1.0;
constexpr long most_nodes = 64;
constexpr long most_inner_steps = 1000;

// --- what the tubes are ----------------------------------------------------------------------------

// parameters = "set", or one set for each tube type: ["set", "other"].
std::vector<std::string> read_set_names(const TomlTable& top) {
  if (top.is_string("parameters") || !top.has("parameters")) return {top.string("parameters")};
  return top.strings("parameters");
}

std::vector<ParameterSet> read_sets(const TomlTable& top, const std::string& path, const std::string& folder,
                                    const std::vector<std::string>& copies) {
  const std::vector<std::string> names = read_set_names(top);
  std::vector<ParameterSet> sets;
  for (std::size_t k = 0; k < names.size(); ++k)
    sets.push_back(read_parameters(
        k < copies.size() ? copies[k]
                          : find_parameters(names[k], folder, {path, top.line("parameters"), "parameters"})));
  return sets;
}

std::vector<int> read_tube_types(const TomlTable& top, std::size_t sets) {
  if (!top.has("tube_types")) {
    if (sets > 1)
      throw top.error("tube_types", "is missing",
                      "say for each tube which of the sets it is: tube_types = [0, 1, ...]");
    return {};
  }
  const std::vector<long> types = top.integers("tube_types", 0, static_cast<long>(sets) - 1);
  return {types.begin(), types.end()};
}

double largest_radius(const Scene& scene) {
  double largest = 0;
  for (const ParameterSet& set : scene.sets) largest = std::max(largest, set.radius);
  return largest;
}

// Contact between tubes of two kinds comes from the universal law, which must be one and the same.
void check_mixture(const TomlTable& top, const Scene& scene) {
  if (scene.contact.law != ContactOptions::Law::line) return;
  const LineParameters& first = *scene.sets[0].line;
  for (const ParameterSet& set : scene.sets) {
    if (scene.sets.size() > 1 && !set.line->has_universal)
      throw top.error("parameters", fmt::format("{} has no [contact.line.universal]", set.name),
                      "tubes of different kinds need it; make the set with `ropewalk calibrate`");
    if (!(set.line->universal == first.universal))
      throw top.error("parameters",
                      fmt::format("{} and {} have different van der Waals laws", scene.sets[0].name, set.name),
                      "calibrate both with the same --lj and --lj-cutoff");
  }
}

// --- where the elements come from -------------------------------------------------------------------

// Refuses more elements than fit, before anything is allocated.
void check_size(const TomlTable& t, const std::string& key, double tubes, double elements) {
  const double total = tubes * elements;
  if (total <= most_elements) return;
  throw t.error(key, fmt::format("asks for {:.0f} x {:.0f} = {:.3g} elements", tubes, elements, total),
                fmt::format("at most {:.0e} are allowed; these would take about {:.3g} GB", double{most_elements},
                            total * kilobytes_per_element * 1e-6));
}

RopeSource read_rope(const TomlTable& t, const Scene& scene) {
  RopeSource rope;
  rope.tubes = static_cast<int>(t.integer("tubes", 1, most_elements));
  const auto [below, above] = nearest_hexagonal(rope.tubes);
  if (below != above)
    throw t.error("tubes", fmt::format("is {}, not a hexagonal number", rope.tubes),
                  fmt::format("the nearest are {} and {}", below, above));
  rope.length = t.number("length_nm", Bounds::positive(1e9));
  const double elements = std::round(rope.length / scene.element_length);
  if (elements < 3)
    throw t.error("length_nm",
                  fmt::format("is {} nm, {} elements of {} nm", rope.length, elements, scene.element_length),
                  fmt::format("at least 3 elements, {:.4g} nm, are needed", 3 * scene.element_length));
  check_size(t, "length_nm", rope.tubes, elements);
  const double diameter = 2 * largest_radius(scene);
  if (t.has("spacing_nm")) rope.spacing = t.number("spacing_nm", {diameter, 10 * diameter, true});
  rope.perturbation = t.number_or("perturbation_nm", 0, Bounds::non_negative(0.1));
  return rope;
}

// Thicker films are no films, and laying them takes a time that grows with the square of the tubes.
constexpr double most_covered = 50;  // areas of the box, by what the tubes cover one by one

FilmSource read_film(const TomlTable& t, const Scene& scene) {
  FilmSource film;
  film.tubes = static_cast<int>(t.integer("tubes", 1, most_elements));
  film.length = t.number("length_nm", Bounds::positive(1e6));
  const double elements = std::round(film.length / scene.element_length);
  const double length = elements * scene.element_length;
  if (elements < 2)
    throw t.error("length_nm", fmt::format("is {} nm, {} elements", film.length, elements),
                  fmt::format("at least 2 elements, {:.4g} nm, are needed", 2 * scene.element_length));
  check_size(t, "tubes", film.tubes, elements);
  film.width = t.number("width_nm", Bounds::positive(1e6));
  film.depth = t.number("depth_nm", Bounds::positive(1e6));
  const char* shorter = film.width < film.depth ? "width_nm" : "depth_nm";
  const double side = std::min(film.width, film.depth);
  if (side < length)
    throw t.error(shorter, fmt::format("is {} nm, and the tubes are {:.6g} nm long", side, length),
                  "take a box that holds a tube at any angle, or shorter tubes");
  const double diameter = 2 * largest_radius(scene);
  const double covered = film.tubes * length * diameter / (film.width * film.depth);
  if (covered > most_covered)
    throw t.error("tubes", fmt::format("covers the box {:.3g} times", covered),
                  fmt::format("at most {} times makes a film; take a larger box or fewer tubes", most_covered));
  if (t.has("spacing_nm")) film.spacing = t.number("spacing_nm", {diameter, 10 * diameter, true});
  return film;
}

ChainSource read_chain(const TomlTable& t) {
  const long elements = t.integer("elements", 2, 1000000000);
  check_size(t, "elements", 1, static_cast<double>(elements));
  return {static_cast<int>(elements)};
}

StateSource read_state_source(const TomlTable& t, const std::string& folder) {
  return {(fs::path(folder) / t.string("file")).string()};
}

const std::vector<std::string> sources = {"rope", "film", "chain", "state"};

[[noreturn]] void refuse_no_source(const TomlTable& top) {
  for (const std::string& key : top.keys()) {
    const std::string near = nearest_word(key, sources);
    if (!near.empty()) throw top.error(key, "unknown table", fmt::format("did you mean \"{}\"?", near));
  }
  throw top.error("", "there is nothing in the scene", "add one of the tables [rope], [film], [chain] and [state]");
}

void read_source(const TomlTable& top, const std::string& folder, Scene& scene) {
  std::vector<std::string> named;
  for (const std::string& source : sources)
    if (top.has(source)) named.push_back(source);
  if (named.empty()) refuse_no_source(top);
  if (named.size() > 1)
    throw top.error(named[1], fmt::format("stands beside [{}]", named[0]),
                    "a scene has exactly one of [rope], [film], [chain] and [state]");
  if (named[0] == "rope") scene.source = read_rope(top.table("rope"), scene);
  if (named[0] == "film") scene.source = read_film(top.table("film"), scene);
  if (named[0] == "chain") scene.source = read_chain(top.table("chain"));
  if (named[0] == "state") scene.source = read_state_source(top.table("state"), folder);
}

// Tubes and elements per tube, as far as they are known before a state file is read.
struct Sizes {
  int tubes = 0;  // 0: not known
  int elements = 0;
};

Sizes sizes_of(const Scene& scene) {
  if (const auto* rope = std::get_if<RopeSource>(&scene.source))
    return {rope->tubes, whole_elements(rope->length, scene.element_length)};
  if (const auto* film = std::get_if<FilmSource>(&scene.source))
    return {film->tubes, whole_elements(film->length, scene.element_length)};
  if (const auto* chain = std::get_if<ChainSource>(&scene.source)) return {1, chain->elements};
  return {};
}

// --- how they interact ------------------------------------------------------------------------------

void read_start(const TomlTable& t, Scene& scene) {
  scene.temperature = t.number_or("temperature_K", 0, Bounds::range(0, 3000));
  scene.seed = static_cast<std::uint64_t>(t.integer_or("seed", 1, 0, std::numeric_limits<long>::max()));
}

// The line law where all sets have it.
ContactOptions::Law default_law(const Scene& scene) {
  for (const ParameterSet& set : scene.sets)
    if (!set.line) return ContactOptions::Law::paper;
  return ContactOptions::Law::line;
}

// Where the taper of the shortened law left less than half of what two parallel tubes bind with, it would be
// another law; and beyond its cutoff the law was never fitted.
double read_cutoff(const TomlTable& t, const ContactOptions& contact, const Scene& scene) {
  if (contact.law == ContactOptions::Law::none)
    throw t.error("cutoff_nm", "is of no use without contact", "take it away");
  Scene changed = scene;
  changed.contact = contact;
  const std::vector<ContactRange> own = contact_ranges(changed);
  changed.contact.cutoff = t.number("cutoff_nm", Bounds::positive(1e3));
  const std::vector<ContactRange> now = contact_ranges(changed);
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (changed.contact.cutoff > own[k].cutoff + 1e-9)
      throw t.error("cutoff_nm", fmt::format("is {} nm", changed.contact.cutoff),
                    fmt::format("the law ends at {:.4g} nm; leave the key out", own[k].cutoff));
    const double left = now[k].binding / own[k].binding;
    if (!(left >= 0.5))
      throw t.error("cutoff_nm",
                    fmt::format("is {} nm, which leaves {:.0f} % of the binding energy of two parallel tubes",
                                changed.contact.cutoff, 100 * std::max(0.0, left)),
                    fmt::format("take a longer one; the law's own is {:.4g} nm", own[k].cutoff));
  }
  return changed.contact.cutoff;
}

ContactOptions read_contact(const TomlTable& t, const Scene& scene) {
  using Law = ContactOptions::Law;
  static const Words<Law> laws = {{"line", Law::line}, {"paper", Law::paper}, {"none", Law::none}};
  ContactOptions c;
  c.law = t.word_or("law", default_law(scene), laws);
  if (c.law != Law::none) {
    const char* name = c.law == Law::paper ? "paper" : "line";
    for (const ParameterSet& set : scene.sets)
      if (c.law == Law::paper ? !set.paper.has_value() : !set.line.has_value())
        throw t.error("law", fmt::format("is \"{}\", and the set {} has no [contact.{}]", name, set.name, name),
                      "take another set, or law = \"none\"");
  }
  if (c.law == Law::paper && scene.sets.size() > 1)
    throw t.error("law", "is \"paper\", which holds between tubes of one kind alone", "take law = \"line\"");
  const auto check_line_law = [&](const char* key) {
    if (c.law != Law::line) throw t.error(key, "belongs to law = \"line\"", "take it away");
  };
  if (t.has("nodes_per_element")) {
    check_line_law("nodes_per_element");
    c.nodes = static_cast<int>(t.integer("nodes_per_element", 1, most_nodes));
  }
  c.all_nodes = t.boolean_or("all_nodes", c.all_nodes);
  if (c.all_nodes) check_line_law("all_nodes");
  static const Words<Interaction::Precision> precisions = {{"mixed", Interaction::Precision::mixed},
                                                           {"double", Interaction::Precision::full}};
  if (t.has("precision")) c.precision = t.word_or("precision", Interaction::Precision::mixed, precisions);
  c.legacy_torque = t.boolean_or("legacy_torque", c.legacy_torque);
  c.exclude_along_tube =
      static_cast<int>(t.integer_or("exclude_along_tube_elements", c.exclude_along_tube, 1, most_elements));
  if (t.has("cutoff_nm")) c.cutoff = read_cutoff(t, c, scene);
  if (t.has("skin_nm")) c.skin = t.number("skin_nm", Bounds::positive(5));
  return c;
}

double read_element_length(const TomlTable& top, const ParameterSet& set) {
  return top.number_or("element_length_nm", set.element_length, Bounds::range(0.05, 50));
}

// The law's energy is that of a pair of elements, not of a length.
void check_element_length(const TomlTable& top, const Scene& scene) {
  const double set = scene.parameters().element_length;
  if (scene.contact.law != ContactOptions::Law::paper || std::fabs(scene.element_length - set) <= 1e-6) return;
  throw top.error("element_length_nm", fmt::format("is {} nm", scene.element_length),
                  fmt::format("law \"paper\" holds for the {} nm of the set alone; leave the key out", set));
}

Damping read_damping(const TomlTable& t) {
  Damping d;
  d.contact.eta = t.number_or("contact_viscosity_eV_ps_per_nm2", 20, Bounds::non_negative(1e6));
  d.bond.rate = t.number_or("bond_damping_per_ps", 1, Bounds::non_negative(1e4));
  d.local = t.number_or("pfc_local", 0, Bounds::range(0, 1));
  return d;
}

// --- loads ------------------------------------------------------------------------------------------

void check_index(const TomlTable& t, const char* key, const char* what, long index, int count) {
  if (count == 0 || (index < count && index >= -count)) return;
  const std::string from_end =
      std::string(key) == "elements" ? fmt::format(", or -1 to -{} from the end", count) : "";
  throw t.error(key, fmt::format("there is no {} {}", what, index),
                fmt::format("they are 0 to {}{}", count - 1, from_end));
}

// Twice the same one would be loaded twice.
void check_unique(const TomlTable& t, const char* key, std::vector<long> indices, int count) {
  for (long& i : indices)
    if (i < 0 && count > 0) i += count;
  std::sort(indices.begin(), indices.end());
  const auto twice = std::adjacent_find(indices.begin(), indices.end());
  if (twice != indices.end()) throw t.error(key, fmt::format("names {} twice", *twice), "name each once");
}

std::vector<int> read_indices(const TomlTable& t, const char* key, const char* what, long least, int count) {
  const std::vector<long> indices = t.integers(key, least, most_elements);
  for (const long i : indices) check_index(t, key, what, i, count);
  check_unique(t, key, indices, count);
  return {indices.begin(), indices.end()};
}

Selection read_selection(const TomlTable& t, const Sizes& sizes) {
  Selection on;
  on.all_tubes = !t.has("tubes") || (t.is_string("tubes") && t.word("tubes", Words<bool>{{"all", true}}));
  if (!on.all_tubes) on.tubes = read_indices(t, "tubes", "tube", 0, sizes.tubes);
  if (!t.is_string("elements")) {
    on.elements = read_indices(t, "elements", "element", -long{most_elements}, sizes.elements);
    return on;
  }
  on.all_elements = t.word("elements", Words<bool>{{"all", true}, {"ends", false}});
  if (!on.all_elements) on.elements = {0, -1};
  return on;
}

FixLoad read_fix(const TomlTable& t) {
  FixLoad fix;
  if (t.has("axes")) {
    // Empty is a text here: nothing but the orientation.
    const std::string axes = t.text("axes");
    fix.x = axes.find('x') != std::string::npos;
    fix.y = axes.find('y') != std::string::npos;
    fix.z = axes.find('z') != std::string::npos;
    if (axes.size() != static_cast<std::size_t>(fix.x + fix.y + fix.z))
      throw t.error("axes", fmt::format("is \"{}\"", printable(axes, 40)),
                    "write x, y and z, each at most once: \"xy\"");
  }
  fix.rotation = t.boolean_or("rotation", true);
  if (!fix.x && !fix.y && !fix.z && !fix.rotation)
    throw t.error("axes", "is empty and rotation is false: nothing is fixed", "take the load away");
  return fix;
}

Vector3 read_vector(const TomlTable& t, const char* key) {
  const std::vector<double> v = t.numbers(key, Bounds::range(-largest_force, largest_force), 3);
  const Vector3 out(v[0], v[1], v[2]);
  if (out == Vector3::Zero()) throw t.error(key, "is zero", "take the load away");
  return out * units::nN_nm;
}

RotateLoad read_rotate(const TomlTable& t) {
  RotateLoad load;
  load.rate = t.number("rate_deg_per_ps", Bounds::range(-360, 360)) * units::degree;
  if (load.rate == 0)
    throw t.error("rate_deg_per_ps", "is 0", "to hold elements where they are take kind = \"fix\"");
  load.angle = std::copysign(t.number("angle_deg", Bounds::positive(1e6)) * units::degree, load.rate);
  if (t.has("centre_nm")) {
    const std::vector<double> c = t.numbers("centre_nm", Bounds::range(-1e6, 1e6), 2);
    load.centre = {c[0], c[1], 0};
  }
  load.axial_free = t.boolean_or("axial_free", load.axial_free);
  load.spin_free = t.boolean_or("spin_free", load.spin_free);
  return load;
}

struct LoadKind {
  const char* name;
  std::vector<std::string> keys;  // of this kind alone
};

const std::vector<LoadKind>& load_kinds() {
  static const std::vector<LoadKind> kinds = {
      {"fix", {"axes", "rotation"}},
      {"force", {"force_nN"}},
      {"torque", {"torque_nN_nm"}},
      {"rotate", {"rate_deg_per_ps", "angle_deg", "centre_nm", "axial_free", "spin_free"}}};
  return kinds;
}

std::size_t read_load_kind(const TomlTable& t) {
  Words<std::size_t> words;
  for (const LoadKind& k : load_kinds()) words.emplace_back(k.name, words.size());
  const std::size_t kind = t.word("kind", words);
  for (const std::string& key : t.keys())
    for (const LoadKind& other : load_kinds())
      if (other.name != load_kinds()[kind].name && std::count(other.keys.begin(), other.keys.end(), key))
        throw t.error(
            key,
            fmt::format("belongs to kind = \"{}\", and this load is \"{}\"", other.name, load_kinds()[kind].name),
            "take the key away, or write a [[load]] of its own");
  return kind;
}

Load read_load(const TomlTable& t, const Sizes& sizes) {
  Load load;
  const std::size_t kind = read_load_kind(t);
  load.on = read_selection(t, sizes);
  if (kind == 0) load.kind = read_fix(t);
  if (kind == 1) load.kind = ForceLoad{read_vector(t, "force_nN")};
  if (kind == 2) load.kind = TorqueLoad{read_vector(t, "torque_nN_nm")};
  if (kind == 3) load.kind = read_rotate(t);
  return load;
}

TwistProtocol read_twist(const TomlTable& t) {
  using Reading = TwistProtocol::Reading;
  using Application = TwistProtocol::Application;
  static const Words<Reading> readings = {{"per-tube", Reading::per_tube}, {"total", Reading::total}};
  static const Words<Application> applications = {{"couple", Application::couple},
                                                  {"tangential", Application::tangential}};
  static const Words<bool> grips = {{"free", true}, {"held", false}};
  TwistProtocol w;
  w.moment = t.number("moment_nN_nm", Bounds::positive(1e6)) * units::nN_nm;
  w.rate = t.number("rate_nN_nm_per_ps", Bounds::non_negative(1e6)) * units::nN_nm;
  w.hold = t.number_or("hold_ps", 0, Bounds::non_negative(longest_time));
  w.reading = t.word_or("reading", w.reading, readings);
  w.application = t.word_or("application", w.application, applications);
  w.lateral_free = t.word_or("lateral", w.lateral_free, grips);
  w.axial_free = t.word_or("axial", w.axial_free, grips);
  w.geometric_only = t.boolean_or("geometric_only", w.geometric_only);
  w.increment = t.number_or("increment_ps", w.increment, Bounds::positive(longest_time));
  if (w.ramp_time() > longest_time)
    throw t.error("rate_nN_nm_per_ps", fmt::format("makes a ramp of {:.3g} ps", w.ramp_time()), "ramp faster");
  return w;
}

// --- the run ----------------------------------------------------------------------------------------

double read_time_step(const TomlTable& t) {
  if (t.is_string("time_step_fs")) return t.word("time_step_fs", Words<double>{{"auto", 0.0}});
  return t.number_or("time_step_fs", 0, Bounds::positive(1000)) * units::fs;
}

// A key that would be without effect is refused, since it was meant to have one.
void refuse_other_mode(const TomlTable& t, RunOptions::Mode mode) {
  const bool relax = mode == RunOptions::Mode::relax;
  const std::vector<const char*> others =
      relax ? std::vector<const char*>{"duration_ps"} : std::vector<const char*>{"force_tolerance_nN", "max_steps"};
  for (const char* key : others)
    if (t.has(key))
      throw t.error(key, fmt::format("belongs to mode = \"{}\"", relax ? "dynamics" : "relax"),
                    fmt::format("take it away, or change the mode, now \"{}\"", relax ? "relax" : "dynamics"));
}

// Only in dynamics, where they have an effect.
void read_stepping(const TomlTable& t, const Scene& scene, RunOptions& r) {
  static const Words<bool> integrators = {{"verlet", false}, {"rk4", true}};
  r.stepping.contact_every = static_cast<int>(t.integer_or("contact_every", 1, 1, most_inner_steps));
  r.stepping.runge_kutta = t.word_or("integrator", r.stepping.runge_kutta, integrators);
  r.mass_scale = t.number_or("mass_scale", r.mass_scale, Bounds::range(1e-3, 1e6));
  const char* used = r.stepping.contact_every > 1 ? "contact_every"
                     : r.stepping.runge_kutta     ? "integrator"
                     : r.mass_scale != 1          ? "mass_scale"
                                                  : nullptr;
  if (r.mode == RunOptions::Mode::relax && used)
    throw t.error(used, "belongs to mode = \"dynamics\"", "take it away: relaxation does not depend on it");
  if (r.stepping.contact_every == 1) return;
  if (scene.contact.law == ContactOptions::Law::none)
    throw t.error("contact_every", "is of no use without contact", "take it away");
  if (scene.damping.local > 0)
    throw t.error("contact_every", "does not go with pfc_local, which damps the total force",
                  "take one of them away");
}

ThermostatOptions read_thermostat(const TomlTable& t, const Scene& scene) {
  Words<std::string> methods;
  for (const ThermostatKind& kind : thermostat_kinds()) methods.emplace_back(kind.name, kind.name);
  ThermostatOptions o;
  o.method = t.word_or("method", o.method, methods);
  o.temperature = t.number("temperature_K", Bounds::range(0, 3000));
  o.coupling = t.number("coupling_per_ps", Bounds::positive(1e4));
  o.seed = static_cast<std::uint64_t>(
      t.integer_or("seed", static_cast<long>(scene.seed), 0, std::numeric_limits<long>::max()));
  return o;
}

// What does not go with a thermostat.
void check_thermostat(const TomlTable& top, const Scene& scene) {
  if (!scene.thermostat) return;
  const auto refuse = [&](const char* table, const char* key, const char* why) {
    throw top.table(table).error(key, fmt::format("does not go with [thermostat]: {}", why),
                                 "take one of the two away");
  };
  if (scene.run.mode == RunOptions::Mode::relax) refuse("run", "mode", "a relaxation has no temperature");
  if (scene.run.stepping.contact_every > 1) refuse("run", "contact_every", "the bath acts on one level alone");
  if (scene.damping.local > 0) refuse("damping", "pfc_local", "it brakes every velocity that the bath gives");
  if (scene.twist && scene.twist->geometric_only)
    refuse("twist", "geometric_only", "the bath turns the spins that it relaxes");
}

RunOptions read_run(const TomlTable& t, const Scene& scene) {
  static const Words<RunOptions::Mode> modes = {{"dynamics", RunOptions::Mode::dynamics},
                                                {"relax", RunOptions::Mode::relax}};
  RunOptions r;
  r.mode = t.word_or("mode", r.mode, modes);
  refuse_other_mode(t, r.mode);
  r.time_step = read_time_step(t);
  read_stepping(t, scene, r);
  if (t.has("duration_ps")) r.duration = t.number("duration_ps", Bounds::positive(longest_time));
  if (t.has("frames_every_ps")) r.frames_every = t.number("frames_every_ps", Bounds::positive(longest_time));
  if (t.has("log_every_ps")) r.log_every = t.number("log_every_ps", Bounds::positive(longest_time));
  r.checkpoint_every = t.number_or("checkpoint_every_s", r.checkpoint_every, Bounds::range(1, 1e6));
  if (t.has("force_tolerance_nN"))
    r.force_tolerance = t.number("force_tolerance_nN", Bounds::range(1e-15, 1)) * units::nN_nm;
  r.max_steps = t.integer_or("max_steps", r.max_steps, 1, 1000000000);
  r.paraview = t.boolean_or("paraview", r.paraview);
  return r;
}

void check_run(const TomlTable& top, const Scene& scene) {
  if (scene.run.mode == RunOptions::Mode::relax) {
    if (scene.twist)
      throw top.error("twist", "a ramp needs time, and run.mode is \"relax\"",
                      "take mode = \"dynamics\", or a [[load]] of kind \"torque\"");
    for (const Load& load : scene.loads)
      if (std::holds_alternative<RotateLoad>(load.kind))
        throw top.error("load", "a rotation needs time, and run.mode is \"relax\"", "take mode = \"dynamics\"");
    return;
  }
  const double protocol = scene.twist ? scene.twist->ramp_time() + scene.twist->hold : 0.0;
  if (scene.run.duration <= 0 && protocol <= 0)
    throw top.table("run").error("duration_ps", "is missing",
                                 scene.twist ? "ramp and hold of [twist] last no time; give a duration"
                                             : "a run without [twist] needs it: duration_ps = 100");
}

ObserveOptions read_observe(const TomlTable& t, const Scene& scene) {
  const double diameter = 2 * largest_radius(scene);
  ObserveOptions o;
  if (t.has("neighbour_radius_nm"))
    o.neighbour_radius = t.number("neighbour_radius_nm", {diameter, 20 * diameter, true});
  return o;
}

// Largest values of any sense: a bond slips at 90 degrees.
LimitOptions read_limits(const TomlTable& t) {
  LimitOptions limits;
  for (std::size_t k = 0; k < limit_count; ++k) {
    const LimitKind& kind = limit_kinds()[k];
    const double most = kind.unit_size == units::degree ? 90 : 1e3;
    if (t.has(kind.key)) limits[k] = t.number(kind.key, Bounds::non_negative(most)) * kind.unit_size;
  }
  return limits;
}

// --- all of it --------------------------------------------------------------------------------------

void check_format(const TomlTable& top) {
  if (!top.has("format"))
    throw top.error("format", "is missing", fmt::format("a scene starts with format = \"{}\"", scene_format));
  const std::string format = top.string("format");
  if (format != scene_format)
    throw top.error("format", fmt::format("is \"{}\"", printable(format, 40)),
                    fmt::format("this program reads \"{}\"", scene_format));
}

// A key or table that is right elsewhere.
std::string belongs_to(const std::string& key) {
  for (const SceneTable& t : scene_tables()) {
    if (!t.name.empty() && t.name == key) return fmt::format("{} is a table of its own", t.header());
    for (const SceneKey& k : scene_keys())
      if (k.table == t.name && k.key == key)
        return fmt::format("it belongs to {}",
                           t.name.empty() ? "the top of the file, before the first table" : t.header());
  }
  return "";
}

void read_tables(const TomlTable& top, const std::string& folder, Scene& scene) {
  read_source(top, folder, scene);
  read_start(top.table("start"), scene);
  scene.contact = read_contact(top.table("contact"), scene);
  check_element_length(top, scene);
  check_mixture(top, scene);
  scene.damping = read_damping(top.table("damping"));
  const Sizes sizes = sizes_of(scene);
  for (const TomlTable& t : top.tables("load")) scene.loads.push_back(read_load(t, sizes));
  if (top.has("thermostat")) scene.thermostat = read_thermostat(top.table("thermostat"), scene);
  if (top.has("twist")) scene.twist = read_twist(top.table("twist"));
  scene.run = read_run(top.table("run"), scene);
  scene.observe = read_observe(top.table("observe"), scene);
  scene.limits = read_limits(top.table("limits"));
}

}  // namespace

Scene read_scene(const std::string& path, const std::vector<std::string>& parameters) {
  return scene_of_text(read_file(path), path, parameters);
}

Scene scene_of_text(const std::string& text, const std::string& path, const std::vector<std::string>& parameters) {
  Scene scene;
  scene.path = path;
  scene.text = text;
  scene.hash = hash_hex(scene.text);
  const std::string folder = fs::path(path).parent_path().string();
  const TomlTable top = TomlTable::parse(scene.text, path);
  check_format(top);
  scene.name = top.string_or("name", fs::path(path).stem().string());
  scene.sets = read_sets(top, path, folder, parameters);
  scene.tube_types = read_tube_types(top, scene.sets.size());
  scene.element_length = read_element_length(top, scene.parameters());
  read_tables(top, folder, scene);
  top.finish(belongs_to);
  check_run(top, scene);
  check_thermostat(top, scene);
  return scene;
}

}  // namespace ropewalk
