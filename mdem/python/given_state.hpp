// Elements at rest that a caller gives.
#pragma once

#include <vector>

#include "python/module.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/single_state.hpp"

namespace ropewalk::python {

class GivenState : public Source {
 public:
  // Throws InputError for numbers that are no state, std::invalid_argument for arrays that do not fit together.
  GivenState(const std::vector<int>& tube_begin, const py::array_t<double>& position,
             const py::array_t<double>& orientation);

  void place(const Scene&, double, Random&, Topology& topology, State& state) const override;
  std::string file() const override { return "the state"; }
  const State& state() const { return state_; }

 private:
  std::vector<int> tube_begin_;
  State state_;
};

}  // namespace ropewalk::python
