// `ropewalk calibrate friction SET [SET]`: friction of two tubes from their atoms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "atomistic/finite_tube.hpp"
#include "atoms/tube_reference.hpp"
#include "friction/sliding.hpp"
#include "friction/strength.hpp"
#include "io/clocks.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/friction_toml.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/contact/line_parameters.hpp"
#include "verbs/verbs.hpp"
#include "version.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double pN = 1e-3 * units::nN_nm;                     // eV/nm
constexpr double rigid_part = 0.5;                             // of --budget, for rigid tubes
constexpr int most_checks = 16;                                // registers that LAMMPS relaxes within --budget
constexpr double longest = 10, past_ends = 5, led_length = 4;  // nm

struct Tube {
  ParameterSet set;
  TubeShape shape;

  // About as long (nm), its middle at z = 0.
  std::vector<Vector3> atoms(double length) const {
    const long hexagons = hexagons_in(set.chirality, shape, length);
    return tube_atoms(set.chirality, shape, hexagons, 0,
                      -0.5 * static_cast<double>(hexagons) * shape.length_per_hexagon);
  }
};

Tube tube_of(const std::string& name) {
  Tube tube;
  tube.set = read_parameters(find_parameters(name, "", {"", 0, "set"}));
  refuse_filament(tube.set, "no friction follows from it", "give strength_pN_per_nm in [[friction]]");
  refuse_other_than_carbon(tube.set, "friction is measured between atoms of carbon alone");
  if (!tube.set.law<LineParameters>())
    throw InputError({tube.set.path, 0, "contact.line"},
                     "is missing: the set does not say how atoms of two tubes attract",
                     "take a set that ropewalk calibrate made");
  if (!(tube.set.law<LineParameters>()->universal.lj_cutoff > 0))
    throw InputError({tube.set.path, 0, "contact.line.lj_cutoff"}, "is 0, and friction needs a cutoff",
                     "take a set with one");
  tube.shape = reference_of(tube.set).shape;
  return tube;
}

AtomLaw atom_law(const Tube& a, const Tube& b) {
  const UniversalLine &of_a = a.set.law<LineParameters>()->universal,
                      &of_b = b.set.law<LineParameters>()->universal;
  if (of_a.epsilon != of_b.epsilon || of_a.sigma != of_b.sigma || of_a.lj_cutoff != of_b.lj_cutoff)
    throw InputError({b.set.path, 0, "contact.line"}, "has another Lennard-Jones law than " + a.set.path,
                     "take two sets with the same one");
  return {of_a.epsilon, of_a.sigma, of_a.lj_cutoff};
}

// What the relaxation of the atoms multiplies the strengths of rigid tubes by. From the second register on it ends
// where the time is up (steady_seconds()); infinite: never.
Measured relaxation(const SlidingTubes& tubes, const std::vector<Register>& at, Slip slip, double until,
                    const std::string& folder, const FrictionArguments& a) {
  double relaxed = 0, rigid = 0;
  std::vector<RelaxedStrength> all;
  for (const Register& r : at) {
    if (all.size() >= 2 && steady_seconds() > until) break;
    all.push_back(relaxed_strength(tubes, r, slip, folder,
                                   fmt::format("{}-{}", slip == Slip::along ? "along" : "spin", all.size()),
                                   a.lammps));
    relaxed += all.back().relaxed;
    rigid += all.back().rigid;
    if (!a.quiet)
      fmt::print(stderr, "{}: {:.1f} pN relaxed, {:.1f} pN rigid\n",
                 slip == Slip::along ? "along the axis" : "against spin", all.back().relaxed / pN,
                 all.back().rigid / pN);
  }
  const double ratio = relaxed / rigid;
  double squares = 0;
  for (const RelaxedStrength& r : all) squares += std::pow(r.relaxed - ratio * r.rigid, 2);
  const auto n = static_cast<double>(all.size());
  return {ratio, n > 1 ? std::sqrt(squares * n / (n - 1)) / rigid : 0.5 * ratio};
}

Measured product(const Measured& x, const Measured& factor) {
  return {x.value * factor.value, std::hypot(x.standard_error * factor.value, x.value * factor.standard_error)};
}

// Period of the corrugation along the axis, nm.
double corrugation(const Tube& t) {
  const double period = translational_period(t.set.chirality);
  return period < 0.5 ? period : graphene_lattice_constant;
}

class Writer {
 public:
  explicit Writer(PairFriction& out) : out_(out) {}
  void operator()(const std::string& key, double value, const std::string& unit, double error,
                  const std::string& note, const char* origin = "calibrated") {
    out_.quantities.push_back({key, value, unit, error, origin, "", note});
  }
  // A strength below zero is none.
  void strength(const std::string& key, const Measured& m, const std::string& unit, const std::string& note) {
    (*this)(key, std::max(0.0, m.value / pN), unit, m.standard_error / pN, note);
  }

 private:
  PairFriction& out_;
};

// As a scene has them.
std::string scene_lines(const PairFriction& f) {
  return fmt::format(
      "[[friction]]\nstrength_pN_per_nm = {:.4g}\nspin_strength_pN_per_nm = {:.4g}\nend_strength_pN = {:.4g}\n"
      "elastic_slip_nm = {:.3g}\ndrag_eV_ps_per_nm3 = {:.3g}\n",
      f.strength / pN, f.spin_strength / pN, f.end_strength / pN, f.elastic_slip, f.drag);
}

void print(const PairFriction& f, const std::string& path, double seconds) {
  fmt::print("({},{}) beside ({},{}), {}\n", f.a.n, f.a.m, f.b.n, f.b.m, f.potential);
  for (const Quantity& q : f.quantities)
    fmt::print("  {:<28} {:>12.5g} +- {:<10.2g} {:<11} {}\n", q.key, q.value, q.standard_error.value_or(0), q.unit,
               q.note);
  fmt::print("grade: {}\n{:.0f} s\nFriction: {}\n\nFor a scene:\n{}", grade_of(f).words(), seconds, path,
             scene_lines(f));
}

void print_json(const PairFriction& f, const std::string& path) {
  nlohmann::ordered_json j;
  j["chirality_a"] = {f.a.n, f.a.m};
  j["chirality_b"] = {f.b.n, f.b.m};
  for (const Quantity& q : f.quantities)
    j[q.key] = {{"value", q.value}, {"unit", q.unit}, {"standard_error", q.standard_error.value_or(0)}};
  j["grade"] = grade_of(f).words();
  j["file"] = path;
  fmt::print("{}\n", j.dump(1));
}

}  // namespace

int friction_command(const FrictionArguments& arguments) {
  FrictionArguments a = arguments;
  if (a.drag_ps > 0 && a.drag_ps < 10)
    throw InputError({"", 0, "--drag-ps"}, fmt::format("is {}", a.drag_ps), "write 10 or more, or 0 for no drag");
  const double began = steady_seconds();
  Tube first = tube_of(a.first), second = a.second.empty() ? first : tube_of(a.second);
  const AtomLaw law = atom_law(first, second);
  const std::string potential_name = provenance_value(first.set, "potential");
  if (potential_name != provenance_value(second.set, "potential"))
    throw InputError({second.set.path, 0, "provenance.potential"}, "is another one than that of " + first.set.path,
                     "take two sets of the same potential");
  PairFriction f;
  f.a = first.set.chirality;
  f.b = second.set.chirality;
  f.potential = potential_name;
  f.name = fmt::format("friction-{}-{}-{}-{}-{}", f.a.n, f.a.m, f.b.n, f.b.m, potential_name);
  f.path = a.out.empty() ? f.name + ".toml" : a.out;
  check_output(f.path, "--out", a.force);
  a.lammps.interrupted = [] { return interrupted_by() != 0; };
  const LammpsVersion lammps = lammps_version(a.lammps);
  SlidingTubes tubes{find_potential(potential_name),
                     law,
                     first.atoms(led_length + 2 * 2.2),
                     second.atoms(led_length),
                     first.set.radius,
                     second.set.radius};
  pair_commands(tubes.potential, law);  // refuses

  const auto say = [&](const std::string& line) {
    if (!a.quiet) fmt::print(stderr, "{}\n", line);
  };
  const RigidPair pair(law, first.atoms(longest + past_ends), first.set.radius, second.atoms(longest),
                       second.set.radius);
  std::vector<double> lengths = {3, 4, 5, 6, 7, 8, 9, pair.length()};
  if (a.budget_min > 0) {
    const double pilot = steady_seconds();
    along_strength(pair, registers(2, corrugation(second)), lengths);
    // Two registers along the axis take as long as one along it and against spin. The pressed and the crossed tubes
    // take as long as some ten such registers.
    const double each = steady_seconds() - pilot;
    a.registers = std::clamp(static_cast<int>(rigid_part * 60 * a.budget_min / each) - 10, 8, 64);
    a.checks = most_checks;
  }
  say(fmt::format("rigid tubes at {} registers", a.registers));
  const std::vector<Register> at = registers(a.registers, corrugation(second)),
                              few(at.begin(), at.begin() + std::min<std::ptrdiff_t>(4, a.registers));
  const Strength along = along_strength(pair, at, lengths), spin = spin_strength(pair, at, lengths);
  const std::vector<Pressed> pressed = pressed_strengths(pair, few, {0.01, 0.02});
  const std::vector<Crossed> crossed =
      crossed_strengths(pair, few, {2 * units::degree, 5 * units::degree, 10 * units::degree});

  WorkFolder folder(a.keep);
  Measured relaxed_along, relaxed_spin;
  Drag drag;
  try {
    say(fmt::format("relaxed atoms at {} registers, LAMMPS {}", a.checks, lammps.text));
    const std::vector<Register> checked = registers(a.checks, corrugation(second));
    const double left = 60 * a.budget_min - seconds_since(began), now = steady_seconds();
    const auto until = [&](double part) {
      return a.budget_min > 0 ? now + part * left : std::numeric_limits<double>::infinity();
    };
    relaxed_along = relaxation(tubes, checked, Slip::along, until(0.5), folder.path(), a);
    relaxed_spin = relaxation(tubes, checked, Slip::spin_b, until(1), folder.path(), a);
    if (a.drag_ps > 0) {
      say(fmt::format("drag at 300 K, {} ps at each of three speeds", a.drag_ps));
      drag = measured_drag(tubes, checked[0], a.drag_ps, corrugation(second), folder.path(), "drag", a.lammps);
    }
  } catch (const LammpsError& e) {
    folder.stay_for(e);
    throw;
  }

  Writer write(f);
  const std::string over = fmt::format(
      "mean over {} registers of rigid tubes, times {{:.3g}} +- {{:.2g}} for relaxed atoms", a.registers);
  write.strength("friction.strength", product(along.per_length, relaxed_along), "pN/nm",
                 fmt::format(fmt::runtime(over), relaxed_along.value, relaxed_along.standard_error));
  write.strength("friction.spin_strength", product(spin.per_length, relaxed_spin), "pN/nm",
                 fmt::format(fmt::runtime(over), relaxed_spin.value, relaxed_spin.standard_error));
  const Measured ends = product(along.of_ends, relaxed_along);
  write.strength("friction.end_strength", {0.5 * ends.value, 0.5 * ends.standard_error}, "pN",
                 "of each end; an open end");
  write("friction.elastic_slip", along.elastic_slip.value, "nm", along.elastic_slip.standard_error,
        fmt::format("strength over steepest stiffness, along the axis; against spin {:.3g} nm",
                    spin.elastic_slip.value));
  if (a.drag_ps > 0) {
    std::string forces;
    for (std::size_t k = 0; k < drag.speeds.size(); ++k)
      forces += fmt::format("{}{:.2g} +- {:.2g} pN/nm at {:.0f} m/s", k ? ", " : "", drag.force[k].value / pN,
                            drag.force[k].standard_error / pN, 1000 * drag.speeds[k]);
    const bool seen = drag.drag.value > 2 * drag.drag.standard_error;
    write("friction.drag", std::max(0.0, drag.drag.value), "eV ps/nm^3", drag.drag.standard_error,
          fmt::format("300 K; {}{}", forces,
                      seen ? ""
                           : fmt::format("; not above its error: at most {:.2g}",
                                         std::max(0.0, drag.drag.value) + 2 * drag.drag.standard_error)));
  } else {
    write("friction.drag", 0, "eV ps/nm^3", 0, "not measured", "chosen");
  }
  const auto of_register = [&](const std::string& kind, const Strength& s, const Measured& factor) {
    write("register." + kind + "_least", s.least * factor.value / pN, "pN/nm", 0, "of one register", "derived");
    write("register." + kind + "_largest", s.largest * factor.value / pN, "pN/nm", 0, "of one register", "derived");
    write("register." + kind + "_spread", s.spread * factor.value / pN, "pN/nm", 0,
          "standard deviation over registers", "derived");
  };
  of_register("strength", along, relaxed_along);
  of_register("spin_strength", spin, relaxed_spin);
  for (const Pressed& p : pressed)
    write(fmt::format("pressure.ratio_at_{:.0f}_pm", 1000 * p.nearer), p.ratio.value, "1", p.ratio.standard_error,
          fmt::format("strength of tubes {:.2g} nm nearer, pressed by {:.0f} pN/nm, over that of free ones",
                      p.nearer, p.force / pN),
          "derived");
  for (const Crossed& c : crossed)
    write(fmt::format("crossing.force_at_{:.0f}_deg", c.angle / units::degree), c.force.value / pN, "pN",
          c.force.standard_error / pN, fmt::format("of {:.3g} nm, crossed", pair.length()), "derived");
  f.provenance = {{"command", a.command},
                  {"program", fmt::format("ropewalk {} ({})", version, git_id)},
                  {"lammps", lammps.text},
                  {"potential_hash", tubes.potential.file_hash},
                  {"set_a", first.set.name},
                  {"set_a_hash", first.set.hash},
                  {"set_b", second.set.name},
                  {"set_b_hash", second.set.hash},
                  {"seconds", fmt::format("{:.0f}", seconds_since(began))}};
  const std::string text =
      friction_text(f, fmt::format("# Friction of ({},{}) beside ({},{}), {} potential. Made by\n#   {}\n", f.a.n,
                                   f.a.m, f.b.n, f.b.m, potential_name, a.command));
  write_file_atomically(f.path, text);
  if (a.json) {
    print_json(f, f.path);
  } else {
    print(friction_of_text(text, f.path), f.path, seconds_since(began));
  }
  return 0;
}

void add_friction(CLI::App& app, Program& program) {
  const auto a = std::make_shared<FrictionArguments>();
  a->command = program.command;
  CLI::App* c = app.add_subcommand("friction", "Friction of two tubes side by side, from their atoms (minutes)");
  c->add_option("set", a->first, "Parameter set of a tube: a file, or the name of a shipped one")->required();
  c->add_option("other", a->second, "That of the other tube [default: the same]");
  c->add_option("--out", a->out, "File [default: friction-N-M-N-M-POTENTIAL.toml]");
  c->add_option("--keep", a->keep, "Keep LAMMPS's inputs and logs in this new directory");
  c->add_option("--registers", a->registers, "Turns of both tubes that the strengths are means of")
      ->capture_default_str()
      ->check(CLI::Range(4, 10000));
  c->add_option("--checks", a->checks, "Of these, how many LAMMPS relaxes")
      ->capture_default_str()
      ->check(CLI::Range(2, 100));
  c->add_option("--budget", a->budget_min, "Minutes, by which registers and checks are chosen; drag comes on top")
      ->check(CLI::Range(0.5, 1e4))
      ->excludes("--registers")
      ->excludes("--checks");
  c->add_option("--drag-ps", a->drag_ps, "Time at 300 K at each of three speeds, at least 10; 0: no drag")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0, 1e5)));
  c->add_flag("--json", a->json, "JSON");
  c->add_flag("--force", a->force, "Replace an existing file");
  c->add_flag("--quiet", a->quiet, "No progress lines");
  c->callback([a, &program] { program.code = friction_command(*a); });
}

}  // namespace ropewalk::calibrate
