#include "python/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "io/clocks.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "python/arrays.hpp"
#include "run/moving_scene.hpp"
#include "run/run_checkpoint.hpp"
#include "scene/scene_place.hpp"
#include "scene/scene_toml.hpp"
#include "scene/single_state.hpp"
#include "scene/state_files.hpp"

namespace ropewalk::python {
namespace {

constexpr std::size_t digits = 16;  // of the sum behind a checkpoint

// Throws what Ctrl-C or another signal handler raises.
void look_for_signals() {
  const py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

Simulation simulation_with(const Model& model, const std::vector<std::shared_ptr<OwnForce>>& own) {
  if (own.empty()) return start(model.scene, model.prepared);
  Prepared with = model.prepared;
  for (const auto& force : own) OwnForce::add(force, with.state, with.interaction, with.loads);
  Scene scene = model.scene;
  scene.missing_forces.clear();
  return start(scene, with);
}

}  // namespace

SteppedScene::SteppedScene(std::shared_ptr<const Model> model, std::vector<std::shared_ptr<OwnForce>> own)
    : model_(std::move(model)), own_(std::move(own)), simulation_(simulation_with(*model_, own_)) {
  first_ = simulation_.forces().energy;
  first_of_period_ = energies_of_period(simulation_);
  energies_ = first_;
  first_energy_ = simulation_.total_energy();
}

SteppedScene::StepGuard::StepGuard(SteppedScene& of) : of(of) {
  if (of.stepping_.exchange(true)) throw BusyError();
}

const Simulation& SteppedScene::simulation() const {
  if (stepping_) throw BusyError();
  return simulation_;
}

void SteppedScene::forget() {
  energies_.reset();
  measured_.reset();
}

void SteppedScene::divide_steps(int parts) {
  simulation();
  if (parts < 1 || parts > 1024) throw std::invalid_argument("a step is divided into 1 to 1024 parts");
  simulation_.divide_steps(parts);
  measured_.reset();
  seconds_of_a_step_ = patience;
}

void SteppedScene::steps(std::int64_t count, bool energies) {
  if (count < 0) throw std::invalid_argument("the number of steps is negative");
  if (count == 0) return;
  const StepGuard guard(*this);
  forget();
  if (!own_.empty())
    steps_with_own_forces(count, energies);
  else if (static_cast<double>(count) * seconds_of_a_step_ < brief)
    simulation_.steps(count, energies);
  else
    steps_with_breaks(count, energies);
  simulation_.forget_events();  // nobody asks for them
  if (energies) energies_ = simulation_.forces().energy;
}

void SteppedScene::steps_with_breaks(std::int64_t count, bool energies) {
  const py::gil_scoped_release release;
  for (std::int64_t done = 0; done < count;) {
    if (done > 0) look_for_signals();
    const std::int64_t part =
        std::min(count - done, std::max<std::int64_t>(1, static_cast<std::int64_t>(patience / seconds_of_a_step_)));
    const double began = steady_seconds();
    simulation_.steps(part, energies && done + part == count);
    seconds_of_a_step_ = std::max(seconds_since(began) / static_cast<double>(part), 1e-9);
    done += part;
  }
}

void SteppedScene::steps_with_own_forces(std::int64_t count, bool energies) {
  for (std::int64_t done = 0; done < count; ++done) {
    const std::string before = simulation_.serialise();
    try {
      simulation_.steps(1, energies && done + 1 == count);
    } catch (...) {
      go_to(before, driven_);
      throw;
    }
    look_for_signals();
  }
}

Relaxed SteppedScene::relax(const RelaxGoal& goal, long max_steps) {
  const StepGuard guard(*this);
  const py::gil_scoped_release release;
  forget();
  double looked = steady_seconds();
  std::optional<py::error_already_set> raised;
  const std::string before = own_.empty() ? "" : simulation_.serialise();
  Relaxed end;
  try {
    end = simulation_.relax(goal, max_steps, [&](long) {
      if (seconds_since(looked) < patience) return true;
      looked = steady_seconds();
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() == 0) return true;
      raised.emplace();
      return false;
    });
  } catch (...) {
    if (!own_.empty()) go_to(before, driven_);
    throw;
  }
  simulation_.end_relaxation();
  energies_ = simulation_.forces().energy;
  if (raised) throw std::move(*raised);
  return end;
}

Energies SteppedScene::energies() {
  const Simulation& s = simulation();
  if (energies_) return *energies_;
  energies_ = s.forces_at(s.state(), s.interaction().precision).energy;
  return *energies_;
}

const std::vector<double>& SteppedScene::measure() {
  const Simulation& s = simulation();
  if (measured_) return *measured_;
  EnergyAccount account = account_of(s, first_, first_energy_);
  account.potential = energies();  // the last step may have left them out
  account.ends = simulation_.read_gauges();
  if (first_of_period_) account.period = EnergyAccount::Period{*energies_of_period(s), *first_of_period_};
  measured_ = model_->measure(s.state(), account);
  return *measured_;
}

// The scene with its sets, by which a checkpoint knows where it belongs.
std::string SteppedScene::scene_hash() const {
  std::string all = model_->scene.text;
  for (const ParameterSet& set : model_->scene.sets) all += set.hash;
  return hash_hex(all);
}

std::string SteppedScene::checkpoint() const {
  const std::string text = driven_as();
  const std::string bytes =
      scene_hash() + simulation().serialise() + text + fmt::format("{:0{}x}", text.size(), digits);
  return bytes + hash_hex(bytes);
}

void SteppedScene::drive(std::shared_ptr<const Scene> as) {
  const Simulation& s = simulation();
  const Scene& scene = as ? *as : model_->scene;
  LoadsAndConstraints loads = loads_of(scene, s.topology(), s.interaction());
  if (ends_of(loads, s.topology()) != ends_of(model_->prepared.loads, s.topology()))
    throw InputError(place_in(scene, "grip"), "is on other elements than before",
                     "a clamp stays where it is; let go of it by \"free\" for each of its axes");
  for (const auto& force : own_) OwnForce::add_load(force, loads);
  simulation_.use_loads(std::move(loads));
  Stepping stepping = simulation_.stepping();
  stepping.thermostat = nullptr;
  for (const auto& drive : scene.drives) drive->set_stepping(model_->scene.lineage, stepping);
  simulation_.use_thermostat(stepping.thermostat);
  driven_ = std::move(as);
  forget();
}

void SteppedScene::drive(const SceneHandle& as) {
  if (as.scene().has_ends(Drive::Ends::endless))
    throw InputError(place_in(as.scene(), "periodic"), "stays as it is while a simulation runs",
                     "make a simulation of the other scene");
  const Simulation& s = simulation();
  const LoadsAndConstraints loads = loads_of(as.scene(), s.topology(), s.interaction());
  for (const auto& drive : as.scene().drives) drive->refuse_start(as.scene(), s.topology(), s.state(), loads);
  drive(std::make_shared<const Scene>(as.scene()));
}

void SteppedScene::go_to(const std::string& bytes, const std::shared_ptr<const Scene>& driven) {
  for (const auto& force : own_) force->rest(true);
  try {
    if (driven != driven_) drive(driven);
    simulation_.restore(bytes);
  } catch (...) {
    for (const auto& force : own_) force->rest(false);
    throw;
  }
  for (const auto& force : own_) force->rest(false);
}

void SteppedScene::restore(const std::string& bytes) {
  simulation();
  const std::string_view all = bytes;
  const std::size_t size = all.size() < 3 * digits ? 0 : all.size() - 2 * digits;
  std::size_t text = 0;
  if (size > 0) std::from_chars(all.data() + size, all.data() + size + digits, text, 16);
  if (size == 0 || hash_hex(all.substr(0, size + digits)) != all.substr(size + digits) || text > size - digits)
    throw InputError({"", 0, "checkpoint"}, "is damaged, or none", "give what Simulation.checkpoint() returned");
  if (all.substr(0, digits) != scene_hash())
    throw InputError({"", 0, "checkpoint"}, "is of another scene, or of other parameter sets",
                     "restore it into a simulation of the scene that it came from");
  const std::string now = simulation_.serialise(), driven_as_then = bytes.substr(size - text, text);
  const std::shared_ptr<const Scene> driven_now = driven_;
  try {
    const bool same = driven_as_then == driven_as();
    go_to(bytes.substr(digits, size - text - digits),
          same        ? driven_
          : text == 0 ? nullptr
                      : std::make_shared<const Scene>(scene_of_text(driven_as_then, "scene")));
  } catch (const std::runtime_error& e) {
    go_to(now, driven_now);
    throw InputError({"", 0, "checkpoint"}, e.what(),
                     "restore it into a simulation of the scene that it came from");
  }
  forget();
}

void SteppedScene::restore_run(const std::string& dir) {
  simulation();
  const RunCheckpoint c = read_checkpoint({dir});
  refuse_other_forces(c.origin.own_forces, own_forces_in_words(OwnForce::named(own_)), dir);
  try {
    go_to(c.simulation, nullptr);
  } catch (const std::runtime_error& e) {
    throw InputError({RunDirectory{dir}.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  first_energy_ = c.first_energy;
  forget();
}

namespace {

using Class = py::class_<SteppedScene, std::shared_ptr<SteppedScene>>;

py::tuple tuple_of(const Energies& e) {
  return py::make_tuple(e.stretch, e.shear, e.bend, e.twist, e.vdw, e.terms);
}

// `of`: the simulation's array. The view keeps the Python object alive, and with it the memory, which never moves.
template <class Of>
void def_view(Class& c, const char* name, Of of) {
  c.def_property_readonly(name, [of](const py::object& self) {
    return view_of(of(self.cast<const SteppedScene&>().simulation()), self);
  });
}

}  // namespace

void bind_simulation(py::module_& m) {
  Class c(m, "Simulation");
  c.def(py::init([](const SceneHandle& scene, const std::vector<py::function>& functions) {
          std::vector<std::shared_ptr<OwnForce>> own;
          for (const py::function& f : functions) own.push_back(OwnForce::make(f));
          return std::make_shared<SteppedScene>(scene.model(), std::move(own));
        }),
        py::arg("scene"), py::arg("forces"));
  c.def("drive", py::overload_cast<const SceneHandle&>(&SteppedScene::drive));
  c.def_property_readonly("driven_as", &SteppedScene::driven_as);
  c.def("steps", &SteppedScene::steps, py::arg("count"), py::arg("energies"));
  c.def("relax", [](SteppedScene& s, double force, double energy, long max_steps) {
    const Relaxed end = s.relax({force, energy}, max_steps);
    return py::make_tuple(end.at_rest, end.force, end.above, end.error, end.saddles, end.falls);
  });
  def_view(c, "position", [](const Simulation& s) -> const Vec3Array& { return s.state().position; });
  def_view(c, "orientation", [](const Simulation& s) -> const QuaternionArray& { return s.state().orientation; });
  def_view(c, "velocity", [](const Simulation& s) -> const Vec3Array& { return s.state().velocity; });
  def_view(c, "angular_velocity",
           [](const Simulation& s) -> const Vec3Array& { return s.state().angular_velocity; });
  def_view(c, "force", [](const Simulation& s) -> const Vec3Array& { return s.forces().force; });
  def_view(c, "torque", [](const Simulation& s) -> const Vec3Array& { return s.forces().torque; });
  c.def_property_readonly("time", [](const SteppedScene& s) { return s.simulation().state().time; });
  c.def_property_readonly("step", [](const SteppedScene& s) { return s.simulation().state().step; });
  c.def_property_readonly("time_step", [](const SteppedScene& s) { return s.simulation().time_step(); });
  c.def_property(
      "divided", [](const SteppedScene& s) { return s.simulation().divided(); }, &SteppedScene::divide_steps);
  c.def_property_readonly("largest_force", [](const SteppedScene& s) { return s.simulation().largest_force(); });
  c.def_property_readonly("energies", [](SteppedScene& s) { return tuple_of(s.energies()); });
  c.def_property_readonly("kinetic", [](const SteppedScene& s) {
    return kinetic_energy(s.simulation().topology(), s.simulation().state());
  });
  c.def("measure", &SteppedScene::measure);
  c.def("checkpoint", [](const SteppedScene& s) { return py::bytes(s.checkpoint()); });
  c.def("restore", [](SteppedScene& s, const py::bytes& bytes) { s.restore(bytes); });
  c.def("restore_run", &SteppedScene::restore_run);
  c.def("state_files", [](const SteppedScene& s, const std::string& path) {
    StateFiles files = state_files(s.simulation(), path);
    return py::make_tuple(std::move(files.state), std::move(files.memory), memory_path_of(path));
  });
}

}  // namespace ropewalk::python
