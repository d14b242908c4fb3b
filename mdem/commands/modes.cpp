// `modes`: which motions of a state at rest grow, how fast, and what they move.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "commands/verb.hpp"
#include "io/files.hpp"
#include "io/mode_table.hpp"
#include "model/error.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_directory.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "sim/statics/reduction.hpp"
#include "sim/statics/stiffness.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

struct ModesArguments {
  std::string path;  // a scene, or the directory of a run
  int count = 8;
  double shift = 50;        // 1/ns
  bool anyway = false;      // also where it does not rest
  std::string csv, frame;   // files to write; empty: none
  double amplitude = 0.02;  // amplitude of the frame, nm
  int threads = 0;
  bool force = false;
};

namespace fs = std::filesystem;

constexpr double per_ns = 1000;       // 1/ps in 1/ns
constexpr double least_force = 1e-3;  // eV/nm
constexpr double of_the_load = 0.01;
constexpr double fastest_rest = 1e-2;  // nm/ps
constexpr double largest_tangent_error = 1e-4;

InputError refuse(const std::string& file, const char* key, const std::string& what, const std::string& remedy) {
  return InputError({file, 0, key}, what, remedy);
}

void refuse_scene(const std::string& file, const Scene& scene, const Simulation& s) {
  if (scene.bath())
    throw refuse(file, "thermostat", "keeps the state warm, and modes are those of a state at rest",
                 "run the scene without [thermostat] until it rests");
  if (s.loads().spin_relaxation_interval() > 0)
    throw refuse(file, "twist.geometric_only",
                 "takes the twist of the tubes away from time to time, so that there is no state at rest",
                 "take it away");
  if (scene.damping.local != 0) throw refuse(file, "damping.pfc_local", "has no derivative at rest", "set it to 0");
}

void refuse_moving_loads(const std::string& file, const Simulation& s) {
  std::vector<PointLoad> now, then;
  point_loads(s.loads(), s.state(), s.state().time, now);
  point_loads(s.loads(), s.state(), s.state().time + 1, then);
  double change = 0;
  for (std::size_t k = 0; k < now.size() && k < then.size(); ++k)
    change = std::max({change, (now[k].force - then[k].force).norm(), (now[k].torque - then[k].torque).norm()});
  if (now.size() != then.size() || change > 1e-9)
    throw refuse(file, "", fmt::format("the loads still change at {:.4g} ps", s.state().time),
                 "take a state under the whole load: resume the run, or give a scene whose load acts at once");
}

Reduction reduction_or_refuse(const std::string& file, const Simulation& s) {
  std::string why;
  if (auto reduction = reduction_of(s, why)) return *reduction;
  throw refuse(file, "", why + ", which modes does not do",
               "hold elements by [[load]] of kind \"fix\", or by one grip");
}

void refuse_size(const std::string& file, const Simulation& s) {
  const double need = cost_of_decomposition(s).numbers * sizeof(double);
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (need > 0.7 * there)
    throw refuse(file, "",
                 fmt::format("{} elements need some {:.2g} GB for the decomposition of the stiffness, and this "
                             "machine has {:.2g} GB",
                             s.topology().elements(), need / 1e9, there / 1e9),
                 "take a shorter or thinner rope, or longer elements");
}

// The state of a run is that of its newest checkpoint.
struct Given {
  Scene scene;
  Prepared prepared;
  Simulation simulation;
};
Given given(const std::string& path) {
  if (!fs::is_directory(path)) {
    Scene scene = read_scene(path);
    Prepared prepared = prepare(scene);
    Simulation simulation = start(scene, prepared);
    return {std::move(scene), std::move(prepared), std::move(simulation)};
  }
  const RunDirectory dir{path};
  refuse_strange_files(dir);
  Scene scene = read_run_scene(dir);
  Prepared prepared = prepare(scene);
  Simulation simulation = simulation_at(dir, scene, prepared, read_checkpoint(dir));
  return {std::move(scene), std::move(prepared), std::move(simulation)};
}

double largest_speed(const Simulation& s) {
  double most = 0;
  for (std::size_t i = 0; i < s.state().size(); ++i)
    most = std::max(
        {most, s.state().velocity[i].norm(), s.topology().largest_radius() * s.state().angular_velocity[i].norm()});
  return most;
}

// eV/nm, couples over the radius.
double largest_load(const Simulation& s) {
  std::vector<PointLoad> loads;
  point_loads(s.loads(), s.state(), s.state().time, loads);
  double most = 0;
  for (const PointLoad& load : loads)
    most = std::max({most, load.force.norm(), load.torque.norm() / s.topology().largest_radius()});
  return most;
}

void refuse_existing(const std::string& file, const char* option, bool force) {
  if (!file.empty() && !force && fs::exists(file))
    throw InputError({"", 0, option}, file + " exists", "name another file, or give --force");
}

std::string words_of(const ModeRow& row) {
  std::string text = row.shape.name();
  const ModeShape& shape = row.shape;
  if (!std::isnan(shape.half_waves) && shape.shares.sideways > 0.25)
    text += fmt::format(", {:.0f} half wave{}, {:+.2f} windings", shape.half_waves,
                        shape.half_waves == 1 ? "" : "s", shape.windings);
  return row.neutral ? text + " (neutral)" : text;
}

void print_rows(const std::vector<ModeRow>& rows) {
  fmt::print("{:>10} {:>10} {:>9} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7}  {}\n", "rate, 1/ns", "freq., GHz",
             "residual", "sideways", "stretch", "turn", "slip", "section", "spin", "what");
  for (const ModeRow& row : rows) {
    const ModeShares& s = row.shape.shares;
    fmt::print("{:>+10.4g} {:>10.4g} {:>9.1e} {:>8.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f}  {}\n",
               row.rate.real(), row.frequency(), row.residual, s.sideways, s.stretch, s.turn, s.slip, s.section,
               s.spin, words_of(row));
  }
}

// The farthest element moves by `amplitude`; velocities are those of the growing motion.
State along(const State& rest, const Mode& mode, double amplitude) {
  const Eigen::VectorXd shape = mode.shape.real(), speed = (mode.rate * mode.shape).real();
  double most = 0;
  for (Eigen::Index row = 0; row < shape.size(); row += 6) most = std::max(most, shape.segment<3>(row).norm());
  if (!(most > 0)) most = shape.cwiseAbs().maxCoeff();
  const Eigen::VectorXd velocity = amplitude / most * speed;
  return moved(rest, amplitude / most * shape, &velocity);
}

int modes_command(const ModesArguments& a) {
  use_threads(a.threads);
  refuse_existing(a.csv, "--csv", a.force);
  refuse_existing(a.frame, "--frame", a.force);
  const Given at = given(a.path);
  const Simulation& s = at.simulation;
  refuse_scene(a.path, at.scene, s);
  refuse_moving_loads(a.path, s);
  const Reduction reduction = reduction_or_refuse(a.path, s);
  refuse_size(a.path, s);
  if (!s.interaction().terms.empty())
    fmt::print(stderr,
               "ropewalk: note: Links, friction and other terms with a memory stay as they are: modes are those of "
               "a rope in which none slips or breaks.\n");
  const Tangent tangent = term_without_tangent(s).empty() ? tangent_by_blocks(s) : tangent_of(s);
  const double force = largest_free_force(s, tangent.force), speed = largest_speed(s);
  const double most_left = std::max(least_force, of_the_load * largest_load(s));
  if (!a.anyway && (force > most_left || speed > fastest_rest))
    throw refuse(a.path, "",
                 fmt::format("the state is not at rest: {:.2g} eV/nm are left on an element, of at most {:.2g}, "
                             "and one moves by {:.2g} nm/ps, of at most {:g}",
                             force, most_left, speed, fastest_rest),
                 "hold the run longer, or with more viscosity; --anyway takes it as if it stood still");
  if (tangent.error > largest_tangent_error)
    throw refuse(a.path, "",
                 fmt::format("the tangent misses {:.1e} of the change of the forces: a force term reaches farther "
                             "than the neighbour list",
                             tangent.error),
                 "take that term away");
  Modes found;
  try {
    found = modes_of(tangent, reduction, {a.count, a.shift / per_ns});
  } catch (const std::runtime_error& e) {
    throw refuse(a.path, "", e.what(), "take another --shift, or a smaller --count");
  }
  std::vector<ModeRow> rows;
  for (const Mode& mode : found.modes)
    rows.push_back({mode.rate * per_ns, mode.residual * per_ns, std::abs(mode.rate) < neutral_below(found),
                    shape_of(s.topology(), s.state(), tangent.mass, mode)});
  fmt::print(
      "{} at {:.4g} ps: {} tubes, {} elements; up to {:.2g} eV/nm are left on an element, which moves by up to "
      "{:.2g} nm/ps.\n",
      a.path, s.state().time, s.topology().tubes(), s.topology().elements(), force, speed);
  print_rows(rows);
  fmt::print(
      "No other eigenvalue is nearer than {:.4g} to the shift of {:.4g} per ns. Below {:.2g} per ns a motion is "
      "neutral.\n",
      found.reach * per_ns, a.shift, neutral_below(found) * per_ns);
  if (!a.csv.empty()) write_file_atomically(a.csv, modes_csv(rows));
  if (!a.frame.empty())
    write_file_atomically(a.frame, state_csv(s.topology(), along(s.state(), found.modes.front(), a.amplitude)));
  return 0;
}

}  // namespace

void add_modes(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ModesArguments>();
  CLI::App* c =
      app.add_subcommand("modes", "Small motions that grow out of a state at rest: their rates and what they move");
  c->add_option("path", a->path,
                "Directory of a run, whose newest checkpoint counts, or a scene (TOML) at its start")
      ->required()
      ->check(CLI::ExistingPath);
  c->add_option("--count", a->count, "Eigenvalues to find")->capture_default_str()->check(whole_number(1, 200));
  c->add_option("--shift", a->shift,
                "Find the motions with growth rates nearest to this one (1/ns); choose it above the largest rate")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1e5));
  c->add_flag("--anyway", a->anyway, "Also for a state that is not at rest, as if it stood still");
  c->add_option("--csv", a->csv, "Write the table to this file");
  c->add_option("--frame", a->frame,
                "Write the state moved along the leading mode to this file (CSV), from which a scene can start");
  c->add_option("--amplitude", a->amplitude, "Largest displacement of an element in that state, nm")
      ->capture_default_str()
      ->check(CLI::Range(1e-9, 1.0));
  c->add_option("--threads", a->threads, "Threads [default: all cores]")->check(thread_range());
  c->add_flag("--force", a->force, "Replace existing files");
  c->callback([a, &program] {
    wait_briefly(program.argv, a->threads);
    program.code = modes_command(*a);
  });
}

}  // namespace ropewalk
