// Measures one point: runs a model through the protocol of a scene and records cost and observables.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "chart/chart.hpp"
#include "io/clocks.hpp"
#include "model/error.hpp"
#include "observe/bending.hpp"
#include "observe/means.hpp"
#include "observe/spacing.hpp"
#include "scene/scene_to_model.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk::validate {
namespace {

constexpr double start_tolerance = 5e-3, turned_tolerance = 5e-3;  // eV/nm
constexpr long max_steps = 20000;                                  // steps of one relaxation
constexpr int samples = 40;                                        // samples of the observables
constexpr double sampled_part = 0.5;                               // fraction of the hold, at its end
constexpr double min_seconds = 0.25;                               // short runs are repeated
constexpr int max_spans = 8;

// --- Motion of the grips ---

// Turns the specimen by a part of its whole angle.
void turn(const Specimen& s, double part, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!s.interior_follows && !std::count(s.grips.begin(), s.grips.end(), static_cast<int>(i))) continue;
    const double angle = part * s.angle * s.twist_share[i];
    const Vector3 axis = s.about_itself ? axis_of(state.orientation[i]) : Vector3::UnitZ();
    const Quaternion by(Eigen::AngleAxisd(angle, axis));
    if (!s.about_itself) state.position.set(i, by * state.position[i]);
    state.orientation.set(i, (by * state.orientation[i]).normalized());
  }
}

// Sets the velocities of a uniform turn.
void set_turning(const Specimen& s, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector3 axis = s.about_itself ? axis_of(state.orientation[i]) : Vector3::UnitZ();
    const Vector3 w = s.angle / s.ramp * s.twist_share[i] * axis;
    state.angular_velocity.set(i, w);
    state.velocity.set(i, s.about_itself ? Vector3::Zero() : Vector3(w.cross(state.position[i])));
  }
}

Simulation relaxed(const Specimen& s, State state, double tolerance) {
  Simulation simulation(s.topology, s.interaction, s.held(), std::move(state), s.time_step);
  if (!simulation.relax(tolerance, max_steps, [](long) { return true; }))
    throw NumericalError(simulation.state().step, -1, "the relaxation did not come to rest",
                         "this model has no smooth minimum here");
  return simulation;
}

// --- Observables ---

double moment_on_grips(const Specimen& s, const Simulation& simulation) {
  const State& state = simulation.state();
  const Forces& f = simulation.forces();
  double sum = 0;
  for (const int e : s.grips) {
    const auto i = static_cast<std::size_t>(e);
    if (s.twist_share[i] <= 0) continue;
    sum += f.torque.z[i] + state.position.x[i] * f.force.y[i] - state.position.y[i] * f.force.x[i];
  }
  return std::copysign(1.0, s.angle) * (s.moment_resists ? -sum : sum);
}

// Mean over the bonds that deform; bonds within a grip do not.
double mean_bending_moment(const Specimen& s, const State& state) {
  const std::set<int> grips(s.grips.begin(), s.grips.end());
  double sum = 0;
  int count = 0;
  for (int t = 0; t < s.topology.tubes(); ++t) {
    const TubeType& type = s.topology.type_of(t);
    for (int i = s.topology.tube_begin[t]; i + 1 < s.topology.tube_begin[t + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (grips.count(i) && grips.count(i + 1) && s.twist_share[at] == s.twist_share[at + 1]) continue;
      sum += bending_moment(type.bond, type.element_length, frame_of(state.orientation[at]),
                            frame_of(state.orientation[at + 1]));
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

class Reader {
 public:
  Reader(const Specimen& s, const State& untwisted, double zero) : s_(s), zero_(s.above_start ? zero : 0) {
    if (is_rope()) shells_ = rope_shells(s.topology, untwisted, 0);
  }

  void add(const Simulation& simulation) {
    const Topology& topology = s_.topology;
    const State& state = simulation.state();
    std::map<std::string, double> now;
    now["energy"] = simulation.forces().energy.potential() - zero_;
    now["end_moment"] = moment_on_grips(s_, simulation) * units::eV_in_nN_nm;
    now["bending_moment"] = mean_bending_moment(s_, state) * units::eV_in_nN_nm;
    if (s_.is_rope && topology.tubes() > 1) now["spacing"] = tube_spacing(topology, state, shells_);
    if (is_rope()) {
      const RopeObservation o = observe(topology, state, shells_, validities(s_.scene, topology), 0, s_.spacing);
      now["beta"] = o.beta * units::rad_in_degree;
      now["end_angle"] = o.geometric_twist * units::rad_in_degree;
      now["Q"] = o.middle.charge;
    }
    means_.add(now);
  }

  std::map<std::string, double> means() const { return means_.values(); }

 private:
  bool is_rope() const { return s_.is_rope && s_.topology.tubes() > 2; }

  const Specimen& s_;
  double zero_ = 0;
  RopeShells shells_;
  Means means_;
};

// --- The two modes ---

// Returns the CPU time of the steps; samples observables if there is a reader.
double run_dynamics(const Specimen& s, Reader* reader, Simulation& simulation) {
  const long steps = std::lround(s.duration() / s.time_step);
  const auto sampled = static_cast<long>(static_cast<double>(steps) * (1 - sampled_part * s.hold / s.duration()));
  const long every = std::max(1L, (steps - sampled) / samples);
  double seconds = 0, began = processor_seconds();
  for (long k = 1; k <= steps; ++k) {
    const bool read = k > sampled && (steps - k) % every == 0;
    simulation.step(read);
    if (!read || !reader) continue;
    seconds += processor_seconds() - began;
    reader->add(simulation);
    began = processor_seconds();
  }
  return seconds + processor_seconds() - began;
}

Simulation driven(const Specimen& s, State untwisted) {
  set_turning(s, untwisted);
  untwisted.step = 0;
  return Simulation(s.topology, s.interaction, s.loads(), std::move(untwisted), s.time_step, 0,
                    s.scene.run.stepping);
}

struct RelaxedSpecimen {
  Simulation simulation;
  double seconds = 0;
};

RelaxedSpecimen run_relaxation(const Specimen& s, int increments, State state) {
  const double began = processor_seconds();
  state.step = 0;
  for (int k = 0; k < increments; ++k) {
    turn(s, 1.0 / increments, state);
    Simulation simulation = relaxed(s, std::move(state), turned_tolerance);
    if (k + 1 == increments) return {std::move(simulation), processor_seconds() - began};
    state = simulation.state();
  }
  throw std::logic_error("a relaxation without increments");
}

}  // namespace

ChartPoint describe(const ChartScene& scene, const ChartModel& model, const Specimen& s) {
  ChartPoint p;
  p.scene = scene.name;
  p.model = model.name;
  p.kind = model.kind;
  p.law = model.law;
  p.integrator = model.stepping.runge_kutta ? "rk4" : "verlet";
  p.mass_scale = model.mass_scale;
  p.mode = model.mode == RunOptions::Mode::relax ? "relax" : "dynamics";
  p.precision = s.interaction.precision == Interaction::Precision::mixed ? "mixed" : "double";
  p.nodes = s.interaction.law ? s.interaction.law->nodes() : 0;
  p.cutoff = s.interaction.law ? s.interaction.law->range({}) : 0;
  p.elements = s.topology.elements();
  p.element_length = s.scene.element_length;
  p.time_step = s.time_step;
  p.contact_viscosity = s.scene.damping.contact.eta;
  p.bond_damping = s.scene.damping.bond.rate;
  p.simulated = s.duration();
  p.steps = std::round(s.duration() / s.time_step);
  return p;
}

void measure(const Specimen& s, const ChartModel& model, ChartPoint& point) {
  use_threads(1);
  const Simulation start = s.starts_at_rest ? relaxed(s, s.state, start_tolerance)
                                            : Simulation(s.topology, s.interaction, s.held(), s.state, s.time_step);
  const State& untwisted = start.state();
  Reader reader(s, untwisted, start.forces().energy.potential());
  double total = 0;
  point.cpu = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_spans && total < min_seconds; ++k) {
    double seconds = 0;
    if (model.mode == RunOptions::Mode::relax) {
      const RelaxedSpecimen r = run_relaxation(s, model.at_once ? 1 : s.increments, untwisted);
      seconds = r.seconds;
      point.steps = static_cast<double>(r.simulation.state().step);
      if (k == 0) reader.add(r.simulation);
    } else {
      Simulation simulation = driven(s, untwisted);
      seconds = run_dynamics(s, k == 0 ? &reader : nullptr, simulation);
      point.steps = static_cast<double>(simulation.state().step);
    }
    point.cpu = std::min(point.cpu, seconds);
    total += seconds;
  }
  point.values = reader.means();
}

void step_for_counting(const std::string& scene_name, const std::string& model_name, long steps) {
  use_threads(1);
  const ChartScene& scene = find_chart_scene(scene_name);
  const std::vector<ChartModel> models = chart_models(scene, false);
  const ChartModel& model = find_chart_model(models, model_name);
  const Specimen s = scene.build(model);
  if (model.mode == RunOptions::Mode::relax) {
    State state = s.state;
    turn(s, 1.0 / s.increments, state);
    Simulation simulation(s.topology, s.interaction, s.held(), std::move(state), s.time_step);
    count_from_here();
    simulation.relax(0, steps, [](long) { return true; });
    count_to_here();
    return;
  }
  Simulation simulation = driven(s, s.state);
  simulation.step(false);  // allocates and caches, before the cost is measured
  count_from_here();
  for (long k = 0; k < steps; ++k) simulation.step(false);
  count_to_here();
}

}  // namespace ropewalk::validate
