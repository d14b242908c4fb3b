#include "python/own_force.hpp"

#include <stdexcept>

#include "python/arrays.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk::python {
namespace {

class OwnTerm : public ForceTerm {
 public:
  explicit OwnTerm(std::shared_ptr<OwnForce> force) : force_(std::move(force)) {}

  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<OwnTerm>(*this); }
  std::string name() const override { return "own_forces"; }
  std::string not_foreseen() const override { return "what a force of your own does"; }
  void gather(const State& state) override {
    if (auto found = force_->at(state)) now_ = std::move(*found);
  }
  TermSum add(const State&, const Segment& part, const ForceRows& out) const override {
    for (int i = part.begin; i < part.end; ++i) {
      out.force.add(static_cast<std::size_t>(i - out.origin), now_.force[static_cast<std::size_t>(i)]);
      out.torque.add(static_cast<std::size_t>(i - out.origin), now_.torque[static_cast<std::size_t>(i)]);
    }
    return {part.begin == 0 ? now_.energy : 0, 0};
  }

 private:
  std::shared_ptr<OwnForce> force_;
  OwnForce::Found now_;
};

class OwnLoad : public Load {
 public:
  explicit OwnLoad(std::shared_ptr<OwnForce> force) : force_(std::move(force)) {}

  std::shared_ptr<Load> copy() const override { return std::make_shared<OwnLoad>(*this); }
  void add_forces(const State& state, double, std::vector<PointLoad>& out) const override {
    const auto found = force_->at(state);
    for (std::size_t i = 0; found && i < state.size(); ++i)
      out.push_back({static_cast<int>(i), found->force[i], found->torque[i]});
  }

 private:
  std::shared_ptr<OwnForce> force_;
};

class OwnDrive : public Drive {
 public:
  explicit OwnDrive(std::shared_ptr<OwnForce> force) : force_(std::move(force)) {}

  SceneTable table() const override { return {"own force", "", {}, false}; }
  std::string words() const override { return "a force of one's own, in Python"; }
  void add_loads(const Scene&, const Topology&, const Interaction&, LoadsAndConstraints& loads) const override {
    OwnForce::add_load(force_, loads);
  }
  void add_terms(const Scene&, const Topology&, const State&, Interaction& interaction) const override {
    OwnForce::add_term_of(force_, interaction);
  }
  std::string why_not_split() const override {
    return "it has forces of one's own, which know these elements alone";
  }
  NotForLammps not_for_lammps() const override { return {"forces of one's own", "its ranks have no Python"}; }

 private:
  std::shared_ptr<OwnForce> force_;
};

}  // namespace

std::shared_ptr<OwnForce> OwnForce::make(py::function function) {
  return {new OwnForce(std::move(function)), [](OwnForce* force) {
            const py::gil_scoped_acquire acquire;
            delete force;
          }};
}

void OwnForce::add(const std::shared_ptr<OwnForce>& force, const State& start, Interaction& interaction,
                   LoadsAndConstraints& loads) {
  force->at(start);
  add_term_of(force, interaction);
  add_load(force, loads);
}

void OwnForce::add_term_of(const std::shared_ptr<OwnForce>& force, Interaction& interaction) {
  if (*force->has_energy_) add_term(std::make_shared<OwnTerm>(force), interaction);
}

std::vector<OwnForceOfRun> OwnForce::named(const std::vector<std::shared_ptr<OwnForce>>& forces) {
  std::vector<OwnForceOfRun> out;
  for (const auto& force : forces)
    out.push_back({force->function_.attr("__name__").cast<std::string>(), *force->has_energy_, nullptr});
  return out;
}

std::vector<OwnForceOfRun> OwnForce::of_run(const std::vector<py::function>& functions, const State& start) {
  std::vector<std::shared_ptr<OwnForce>> forces;
  for (const py::function& function : functions) {
    forces.push_back(make(function));
    forces.back()->at(start);
  }
  std::vector<OwnForceOfRun> out = named(forces);
  for (std::size_t k = 0; k < out.size(); ++k) out[k].drive = std::make_shared<OwnDrive>(forces[k]);
  return out;
}

void OwnForce::add_load(const std::shared_ptr<OwnForce>& force, LoadsAndConstraints& loads) {
  if (!*force->has_energy_) loads.add(OwnLoad(force));
}

std::optional<OwnForce::Found> OwnForce::at(const State& state) {
  if (rests_) return std::nullopt;
  const py::gil_scoped_acquire acquire;
  const auto [force, torque, energy] =
      function_(state.step, state.time, copy_of(state.position), copy_of(state.orientation),
                copy_of(state.velocity), copy_of(state.angular_velocity))
          .cast<std::tuple<py::array_t<double>, py::array_t<double>, std::optional<double>>>();
  if (!has_energy_) has_energy_ = energy.has_value();
  if (*has_energy_ != energy.has_value())
    throw std::invalid_argument("a force of one's own gives an energy at some times and none at others");
  return Found{vectors_from(force), vectors_from(torque), energy.value_or(0)};
}

}  // namespace ropewalk::python
