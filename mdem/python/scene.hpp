// A scene for Python. Its model (elements, forces, reference data of the observables) is built at the first use.
#pragma once

#include <memory>
#include <vector>

#include "python/module.hpp"
#include "run/run_directory.hpp"

namespace ropewalk::python {

struct Model {
  Scene scene;
  Prepared prepared;
  Observer observer;

  explicit Model(Scene of)
      : scene(std::move(of)), prepared(prepare(scene)), observer(make_observer(scene, prepared)) {}

  // All observables of a state, in the order of observables().
  std::vector<double> measure(const State& state, const EnergyAccount& account) const {
    return log_row(observer, scene, prepared.topology, state, account).values();
  }
};

class SceneHandle {
 public:
  explicit SceneHandle(Scene scene) : scene_(std::move(scene)) {}

  const Scene& scene() const { return scene_; }
  std::shared_ptr<const Model> model() const {
    if (!model_) model_ = std::make_shared<const Model>(scene_);
    return model_;
  }

 private:
  Scene scene_;
  mutable std::shared_ptr<const Model> model_;
};

}  // namespace ropewalk::python
