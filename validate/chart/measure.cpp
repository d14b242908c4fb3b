// One point: a model run through the protocol of a scene, its cost and its observables.
#include <omp.h>
#include <time.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "chart/chart.hpp"
#include "model/error.hpp"
#include "observe/bending.hpp"

namespace ropewalk {
namespace {

constexpr double start_tolerance = 5e-3, turned_tolerance = 5e-3;  // eV/nm
constexpr long most_steps = 20000;                                 // of one relaxation
constexpr int samples = 40;                                        // of the observables
constexpr double sampled_part = 0.5;                               // of the hold, its end
constexpr double least_seconds = 0.25;                             // short runs are repeated
constexpr int most_runs = 8;

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// --- How it is moved ---

// By a part of the whole turn.
void turn(const Specimen& s, double part, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!s.interior_follows && !std::count(s.grips.begin(), s.grips.end(), static_cast<int>(i))) continue;
    const double angle = part * s.angle * s.place[i];
    const Vector3 axis = s.about_itself ? axis_of(state.orientation[i]) : Vector3::UnitZ();
    const Quaternion by(Eigen::AngleAxisd(angle, axis));
    if (!s.about_itself) state.position.set(i, by * state.position[i]);
    state.orientation.set(i, (by * state.orientation[i]).normalized());
  }
}

// The velocities of a uniform turn.
void set_turning(const Specimen& s, State& state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector3 axis = s.about_itself ? axis_of(state.orientation[i]) : Vector3::UnitZ();
    const Vector3 w = s.angle / s.ramp * s.place[i] * axis;
    state.angular_velocity.set(i, w);
    state.velocity.set(i, s.about_itself ? Vector3::Zero() : Vector3(w.cross(state.position[i])));
  }
}

Simulation relaxed(const Specimen& s, State state, double tolerance) {
  Simulation simulation(s.topology, s.interaction, s.held(), std::move(state), s.time_step);
  if (!simulation.relax(tolerance, most_steps, [](long) { return true; }))
    throw NumericalError(simulation.state().step, -1, "the relaxation did not come to rest",
                         "this model has no smooth minimum here");
  return simulation;
}

// --- What is read off ---

double moment_on_grips(const Specimen& s, const Simulation& simulation) {
  const State& state = simulation.state();
  const Forces& f = simulation.forces();
  double sum = 0;
  for (const int e : s.grips) {
    const auto i = static_cast<std::size_t>(e);
    if (s.place[i] <= 0) continue;
    sum += f.torque.z[i] + state.position.x[i] * f.force.y[i] - state.position.y[i] * f.force.x[i];
  }
  return std::copysign(1.0, s.angle) * (s.moment_resists ? -sum : sum);
}

// Mean over the bonds that deform: those within a grip do not.
double mean_bending_moment(const Specimen& s, const State& state) {
  const std::set<int> grips(s.grips.begin(), s.grips.end());
  double sum = 0;
  int count = 0;
  for (int t = 0; t < s.topology.tubes(); ++t) {
    const TubeType& type = s.topology.type_of(t);
    for (int i = s.topology.tube_begin[t]; i + 1 < s.topology.tube_begin[t + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (grips.count(i) && grips.count(i + 1) && s.place[at] == s.place[at + 1]) continue;
      sum += bending_moment(type.bond, type.element_length, axis_of(state.orientation[at]),
                            axis_of(state.orientation[at + 1]));
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

Vector3 middle_of(const Topology& topology, const State& state, int tube) {
  const int n = topology.length_of(tube), first = topology.tube_begin[tube];
  return 0.5 * (state.position[first + (n - 1) / 2] + state.position[first + n / 2]);
}

// From a point to the polyline through the elements of a tube.
double distance_to(const Topology& topology, const State& state, int tube, const Vector3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = topology.tube_begin[tube]; i + 1 < topology.tube_begin[tube + 1]; ++i) {
    const Vector3 from = state.position[i], along = Vector3(state.position[i + 1]) - from;
    const double at = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (from + at * along - point).norm());
  }
  return least;
}

// Mean distance of an inner tube from its six nearest, at its middle; of two tubes, where they are closest.
double spacing_of(const Topology& topology, const State& state, const RopeShells& shells) {
  const bool rope = topology.tubes() > 2;
  double sum = 0;
  int count = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (rope && !shells.internal[static_cast<std::size_t>(t)]) continue;
    const Vector3 middle = middle_of(topology, state, t);
    std::vector<double> distances;
    for (int other = 0; other < topology.tubes(); ++other)
      if (other != t) distances.push_back(distance_to(topology, state, other, middle));
    std::sort(distances.begin(), distances.end());
    const std::size_t nearest = std::min<std::size_t>(6, distances.size());
    for (std::size_t k = 0; k < nearest; ++k) sum += distances[k];
    count += static_cast<int>(nearest);
  }
  return sum / count;
}

class Reader {
 public:
  Reader(const Specimen& s, const State& untwisted, double zero) : s_(s), zero_(s.above_start ? zero : 0) {
    if (s.topology.tubes() > 2) shells_ = rope_shells(s.topology, untwisted, 0);
  }

  void add(const Simulation& simulation) {
    const Topology& topology = s_.topology;
    const State& state = simulation.state();
    std::map<std::string, double> now;
    now["energy"] = simulation.forces().energy.potential() - zero_;
    now["end_moment"] = moment_on_grips(s_, simulation) * units::eV_in_nN_nm;
    now["bending_moment"] = mean_bending_moment(s_, state) * units::eV_in_nN_nm;
    if (topology.tubes() > 1) now["spacing"] = spacing_of(topology, state, shells_);
    if (topology.tubes() > 2) {
      const RopeObservation o = observe(topology, state, shells_, {s_.scene.parameters().validity}, 0, s_.spacing);
      now["beta"] = o.beta * units::rad_in_degree;
      now["Q"] = o.middle.charge;
    }
    for (const auto& [name, value] : now) sums_[name] += value;
    ++count_;
  }

  std::map<std::string, double> means() const {
    std::map<std::string, double> out;
    for (const auto& [name, sum] : sums_) out[name] = sum / count_;
    return out;
  }

 private:
  const Specimen& s_;
  double zero_ = 0;
  RopeShells shells_;
  std::map<std::string, double> sums_;
  int count_ = 0;
};

// --- The two modes ---

// Returns the CPU time of the steps; reads where there is a reader.
double run_dynamics(const Specimen& s, Reader* reader, Simulation& simulation) {
  const long steps = std::lround(s.duration() / s.outer_step());
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
  return Simulation(s.topology, s.interaction, s.turned(), std::move(untwisted), s.outer_step(), 0,
                    s.scene.run.stepping);
}

struct Relaxation {
  Simulation simulation;
  double seconds = 0;
};

Relaxation run_relaxation(const Specimen& s, int increments, State state) {
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
  p.law = law_name(model.law);
  p.integrator = model.stepping.runge_kutta ? "rk4" : "verlet";
  p.contact_every = model.stepping.contact_every;
  p.mass_scale = model.mass_scale;
  p.mode = model.mode == RunOptions::Mode::relax ? "relax" : "dynamics";
  p.precision = s.interaction.precision == Interaction::Precision::mixed ? "mixed" : "double";
  if (model.all_nodes) p.precision += "+all_nodes";
  p.nodes = s.interaction.paper ? 1 : s.interaction.line.empty() ? 0 : s.interaction.line.front().nodes_i;
  p.cutoff = s.interaction.paper          ? s.interaction.paper->cutoff()
             : s.interaction.line.empty() ? 0
                                          : s.interaction.line.front().density.cutoff();
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
  omp_set_num_threads(1);
  const Simulation start = relaxed(s, s.state, start_tolerance);
  const State& untwisted = start.state();
  Reader reader(s, untwisted, start.forces().energy.potential());
  double total = 0;
  point.cpu = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_runs && total < least_seconds; ++k) {
    double seconds = 0;
    if (model.mode == RunOptions::Mode::relax) {
      const Relaxation r = run_relaxation(s, model.at_once ? 1 : s.increments, untwisted);
      seconds = r.seconds;
      point.steps = static_cast<double>(r.simulation.state().step);
      if (k == 0) reader.add(r.simulation);
    } else {
      Simulation simulation = driven(s, untwisted);
      seconds = run_dynamics(s, k == 0 ? &reader : nullptr, simulation);
      point.steps = static_cast<double>(simulation.state().step) * s.scene.run.stepping.contact_every;
    }
    point.cpu = std::min(point.cpu, seconds);
    total += seconds;
  }
  point.values = reader.means();
}

void step_for_counting(const std::string& scene_name, const std::string& model_name, long steps) {
  omp_set_num_threads(1);
  const ChartScene& scene = find_chart_scene(scene_name);
  const std::vector<ChartModel> models = chart_models(scene, false);
  const ChartModel& model = find_chart_model(models, model_name);
  const Specimen s = scene.build(model);
  if (model.mode == RunOptions::Mode::relax) {
    State state = s.state;
    turn(s, 1.0 / s.increments, state);
    Simulation simulation(s.topology, s.interaction, s.held(), std::move(state), s.time_step);
    simulation.relax(0, steps, [](long) { return true; });
    return;
  }
  Simulation simulation = driven(s, s.state);
  for (long k = 0; k < steps; k += model.stepping.contact_every) simulation.step(false);
}

}  // namespace ropewalk
