#include "python/given_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "model/error.hpp"
#include "python/arrays.hpp"

namespace ropewalk::python {
namespace {

constexpr double norm_slack = 1e-3;  // largest error of a quaternion's norm, as in state files

}  // namespace

GivenState::GivenState(const std::vector<int>& tube_begin, const py::array_t<double>& position,
                       const py::array_t<double>& orientation)
    : tube_begin_(tube_begin) {
  state_.position = vectors_from(position);
  state_.orientation = quaternions_from(orientation);
  state_.velocity.resize(state_.size());
  state_.angular_velocity.resize(state_.size());
  if (tube_begin.size() < 2 || tube_begin.front() != 0 ||
      std::adjacent_find(tube_begin.begin(), tube_begin.end(), std::greater_equal<int>()) != tube_begin.end())
    throw std::invalid_argument("tubes begin at element 0, and each has one element or more");
  if (tube_begin.back() != static_cast<int>(state_.size()) || state_.orientation.size() != state_.size())
    throw std::invalid_argument("positions, orientations and tubes do not have the same number of elements");
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const auto wrong = [&](const std::string& what, const char* remedy) {
      throw InputError({"", 0, "state"}, fmt::format("element {} {}", i, what), remedy);
    };
    if (!Vector3(state_.position[i]).allFinite()) wrong("has no finite position", "give numbers in nm");
    const Quaternion q = state_.orientation[i];
    if (!(std::fabs(q.norm() - 1) <= norm_slack))
      wrong(fmt::format("has a quaternion of length {:.6g}", q.norm()), "it must be 1 within 0.001");
  }
}

void GivenState::place(const Scene&, double, Random&, Topology& topology, State& state) const {
  for (std::size_t t = 0; t + 1 < tube_begin_.size(); ++t) topology.add_tube(tube_begin_[t + 1] - tube_begin_[t]);
  state = state_;
}

}  // namespace ropewalk::python
