#include "plan/spot_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "observe/bending.hpp"
#include "observe/means.hpp"
#include "observe/spacing.hpp"
#include "scene/dissipation.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/loads/rotate.hpp"
#include "sim/dynamics/refine.hpp"
#include "sim/statics/newton.hpp"

namespace ropewalk {
namespace {

constexpr double step_part = 0.5;  // part of the default step
constexpr int samples = 20;

// One model of the scene, at its start and at its end.
struct Model {
  Scene scene;
  Topology topology;
  Interaction interaction;
  LoadsAndConstraints loads;
  State start, end;
  double spacing = 0, time_step = 0;
  Stepping stepping;

  Simulation at(const State& state) const {
    return Simulation(topology, interaction, loads, state, time_step, scene.contact.skin, stepping);
  }
};

void scale(double by, Vec3Array& v) {
  for (auto* c : {&v.x, &v.y, &v.z})
    for (double& x : *c) x *= by;
}

// Why elements cannot be shorter in this scene; empty: they can.
std::string fixed_length(const Scene& scene) {
  if (scene.from_file()) return "the elements come from a file";
  if (tube_size_key(scene).tube_size == SceneKey::TubeSize::no) return "the tubes have no common length";
  const ContactLawKind* law = contact_law_kind(scene.contact.law);
  if (law && !law->any_element_length) return fmt::format("law \"{}\" holds for its set's length alone", law->name);
  for (const auto& drive : scene.drives)
    if (const std::string why = drive->why_not_lengthened(); !why.empty()) return why;
  return "";
}

Model own_model(const Scene& scene, const Prepared& p, const State& end) {
  return {scene, p.topology, p.interaction, p.loads, p.state, end, p.spacing, p.time_step, p.stepping};
}

Model finer_model(const Model& own, bool half) {
  Model m = own;
  m.scene.contact.nodes = 0;
  m.scene.contact.cutoff = 0;
  m.scene.contact.precision = Interaction::Precision::full;
  m.scene.run.stepping = m.stepping = Stepping{};
  m.scene.run.mass_scale = 1;
  // Slow masses move slowly: the kinetic energy stays.
  scale(std::sqrt(own.scene.run.mass_scale), m.end.velocity);
  scale(std::sqrt(own.scene.run.mass_scale), m.end.angular_velocity);
  if (half) {
    m.scene.element_length *= 0.5;
    m.scene.damping = same_dissipation(m.scene.damping, own.scene.element_length, m.scene.element_length);
    m.start = halved(own.topology, m.start, Splitting::between);
    m.end = halved(own.topology, m.end, Splitting::between);
  }
  m.topology = empty_topology(m.scene);
  for (int t = 0; t < own.topology.tubes(); ++t)
    m.topology.add_tube(half ? 2 * own.topology.length_of(t) - 1 : own.topology.length_of(t),
                        own.topology.tube_type[t]);
  m.topology.groups.rope_begin = own.topology.groups.rope_begin;
  set_collapse(m.scene, m.topology);
  m.interaction = interaction_of(m.scene);
  add_terms(m.scene, m.topology, m.start, m.interaction);
  m.loads = loads_of(m.scene, m.topology, m.interaction);
  m.time_step = step_part * default_step_fraction * time_step_limit(m.topology, m.interaction, m.spacing).limit;
  return m;
}

// Mean over the bonds, nN nm.
double mean_bending_moment(const Topology& topology, const State& s) {
  double sum = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      sum +=
          bending_moment(type.bond, type.element_length, frame_of(s.orientation[i]), frame_of(s.orientation[i + 1]));
    }
  }
  return topology.bonds() > 0 ? sum / topology.bonds() * units::eV_in_nN_nm : 0.0;
}

// The moment (nN nm) by which the group of elements that turns farthest resists. None where nothing turns.
std::optional<double> end_moment(const LoadsAndConstraints& loads, const Simulation& s) {
  const std::vector<const PrescribedRotation*> rotations = loads.of<PrescribedRotation>();
  if (rotations.empty()) return std::nullopt;
  const PrescribedRotation* last =
      *std::max_element(rotations.begin(), rotations.end(),
                        [](const auto* a, const auto* b) { return std::fabs(a->angle) < std::fabs(b->angle); });
  double sum = 0;
  for (const int e : last->elements) {
    const auto i = static_cast<std::size_t>(e);
    const Vector3 arm = s.state().position[i] - last->centre, force = s.forces().force[i];
    sum += s.forces().torque.z[i] + arm.x() * force.y() - arm.y() * force.x();
  }
  return -std::copysign(1.0, last->angle) * sum * units::eV_in_nN_nm;
}

class Observed {
 public:
  explicit Observed(const Model& m)
      : m_(m), zero_(m.at(m.start).forces().energy.potential()), shells_(rope_shells(m.topology, m.start, 0)) {}

  void add(const Simulation& s) {
    const State& state = s.state();
    std::map<std::string, double> now;
    now["energy"] = s.forces().energy.potential() - zero_;
    now["twist_eV"] = s.forces().energy.twist;
    now["bend_eV"] = s.forces().energy.bend;
    now["bending_moment"] = mean_bending_moment(m_.topology, state);
    if (const auto moment = end_moment(m_.loads, s)) now["torque_upper_nN_nm"] = *moment;
    if (m_.interaction.has_contact() && m_.topology.tubes() > 1)
      now["spacing"] = tube_spacing(m_.topology, state, shells_);
    if (m_.topology.tubes() > 2) {
      const RopeObservation o =
          observe(m_.topology, state, shells_, validities(m_.scene, m_.topology), 0, m_.spacing);
      now["beta_deg"] = o.beta / units::degree;
      now["geometric_twist_deg"] = o.geometric_twist / units::degree;
      now["Q"] = o.middle.charge;
    }
    means_.add(now);
  }
  std::map<std::string, double> means() const { return means_.values(); }

 private:
  const Model& m_;
  double zero_ = 0;
  RopeShells shells_;
  Means means_;
};

std::map<std::string, double> seen(const Model& m, double stretch) {
  Observed observed(m);
  Simulation s = m.at(m.end);
  if (m.scene.run.mode == RunOptions::Mode::relax) {
    const auto go_on = [](long) { return true; };
    if (m.scene.run.solver == RunOptions::Solver::fire)
      s.relax(m.scene.run.goal, m.scene.run.max_steps, go_on);
    else
      NewtonStatics(s).relax(m.scene.run.goal, m.scene.run.max_steps, go_on);
    observed.add(s);
    return observed.means();
  }
  const auto steps = std::max<std::int64_t>(2, std::llround(stretch / m.time_step)),
             every = std::max<std::int64_t>(1, steps / (2 * samples));
  for (std::int64_t k = 1; k <= steps; ++k) {
    const bool read = 2 * k > steps && (steps - k) % every == 0;
    s.step(read);
    if (read) observed.add(s);
  }
  return observed.means();
}

}  // namespace

double SpotCheck::Comparison::error() const { return finer != 0 ? std::fabs(here / finer - 1) : std::fabs(here); }

SpotCheck spot_check(const Scene& scene, const Prepared& prepared, const State& end, double stretch) {
  const std::string kept = fixed_length(scene);
  const Model own = own_model(scene, prepared, end), finer = finer_model(own, kept.empty());
  SpotCheck out;
  out.how = scene.run.mode == RunOptions::Mode::relax ? "relaxed again" : fmt::format("{:.3g} ps more", stretch);
  out.how +=
      fmt::format("; finer: elements of {:.4g} nm{}, double precision, {:.3g} fs", finer.scene.element_length,
                  kept.empty() ? "" : " (" + kept + ")", finer.time_step / units::fs);
  const std::map<std::string, double> a = seen(own, stretch), b = seen(finer, stretch);
  for (const auto& [name, value] : a) out.observables[name] = {value, b.at(name)};
  return out;
}

}  // namespace ropewalk
