// A simulation that Python steps, and the account of energy that a run keeps beside it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "python/own_force.hpp"
#include "python/scene.hpp"

namespace ropewalk::python {

struct BusyError : std::runtime_error {
  BusyError() : runtime_error("the simulation is at work in another thread, or calls this function itself") {}
};

class SteppedScene {
 public:
  SteppedScene(std::shared_ptr<const Model> model, std::vector<std::shared_ptr<OwnForce>> own);

  // What a force of one's own throws leaves everything as it was before the step or the relaxation that it ends.
  // Where it takes longer than `brief`, other threads of Python run meanwhile, and Ctrl-C is looked for every
  // `patience`.
  void steps(std::int64_t count, bool energies);
  Relaxed relax(const RelaxGoal& goal, long max_steps);

  // Throws std::runtime_error while another thread steps it, as all that follow.
  const Simulation& simulation() const;
  const Model& model() const { return *model_; }
  void divide_steps(int parts);
  // From now on the loads and clamps are those of this scene. Throws InputError where these are on other ends.
  void drive(const SceneHandle& as);
  // The text of that scene; empty: they have never changed.
  std::string driven_as() const { return driven_ ? driven_->text : ""; }

  // Where the last step left them out, they are computed here.
  Energies energies();
  // All observables. Torques and forces at the ends are means since the last moment that was measured.
  const std::vector<double>& measure();

  // With a sum over the bytes behind.
  std::string scene_hash() const;
  std::string checkpoint() const;
  void restore(const std::string& bytes);
  void restore_run(const std::string& dir);

 private:
  static constexpr double brief = 1e-3, patience = 0.1;  // s

  // While it lasts, the simulation belongs to this thread.
  struct StepGuard {
    explicit StepGuard(SteppedScene& of);
    ~StepGuard() { of.stepping_ = false; }
    SteppedScene& of;
  };

  void forget();
  void steps_with_breaks(std::int64_t count, bool energies);
  void steps_with_own_forces(std::int64_t count, bool energies);
  const Scene& scene() const { return driven_ ? *driven_ : model_->scene; }
  void drive(std::shared_ptr<const Scene> as);
  // As the bytes say, with these loads. The forces of one's own rest meanwhile.
  void go_to(const std::string& bytes, const std::shared_ptr<const Scene>& driven);

  std::shared_ptr<const Model> model_;
  std::vector<std::shared_ptr<OwnForce>> own_;
  std::shared_ptr<const Scene> driven_;  // null: as the model's
  Simulation simulation_;
  std::atomic<bool> stepping_ = false;
  double seconds_of_a_step_ = patience;
  // Values of the present state, where they are known.
  std::optional<Energies> energies_;
  std::optional<std::vector<double>> measured_;
  Energies first_;  // potential at the start
  std::optional<Energies> first_of_period_;
  double first_energy_ = 0;  // eV, total at the start
};

}  // namespace ropewalk::python
