#include "lammps/fix_relax.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lammps/fix_grip.hpp"
#include "timer.h"

namespace ropewalk::lammps {

using namespace LMP::FixConst;

FixRelax::FixRelax(LMP::LAMMPS* lmp, int count, char** words)
    : FixMotion(lmp, count, words), fire_(model_->start.time_step) {
  const std::vector<TubeType>& types = model_->topology.types;
  const TubeType& lightest =
      *std::min_element(types.begin(), types.end(), [](const auto& a, const auto& b) { return a.mass < b.mass; });
  radius_ = lightest.radius;
  scale2_ = lightest.inertia / lightest.mass;
  scalar_flag = 1;
  extscalar = 0;
  nevery = 1;
}

int FixRelax::setmask() { return FixMotion::setmask() | INITIAL_INTEGRATE | END_OF_STEP; }

void FixRelax::setup(int) {
  fire_ = Fire(model_->start.time_step);
  steps_ = 0;
  last_ = 0;
  stop();
}

void FixRelax::stop() {
  for (int i = 0; i < atom->nlocal; ++i) {
    store(atom->v[i], Vector3::Zero());
    store(atom->omega[i], Vector3::Zero());
  }
}

FixRelax::Sums FixRelax::sums() const {
  std::array<double, 3> own{};
  for (int i = 0; i < atom->nlocal; ++i) {
    const Vector3 v = vector(atom->v[i]), w = vector(atom->omega[i]);
    const Vector3 f = vector(atom->f[i]), m = vector(atom->torque[i]);
    own[0] += f.dot(v) + m.dot(w);
    own[1] += v.squaredNorm() + scale2_ * w.squaredNorm();
    own[2] += f.squaredNorm() + m.squaredNorm() / scale2_;
  }
  std::array<double, 3> all{};
  MPI_Allreduce(own.data(), all.data(), 3, MPI_DOUBLE, MPI_SUM, world);
  return {all[0], all[1], all[2]};
}

void FixRelax::kick() {
  for (int i = 0; i < atom->nlocal; ++i) {
    const TubeType& type = type_of(*model_, *atom, i);
    add(atom->v[i], fire_.dt / type.mass * vector(atom->f[i]));
    add(atom->omega[i], fire_.dt / type.inertia * vector(atom->torque[i]));
  }
}

void FixRelax::turn_to_force(double mix, const Sums& s) {
  const double turn = s.force2 > 0 ? mix * std::sqrt(s.velocity2 / s.force2) : 0.0;
  for (int i = 0; i < atom->nlocal; ++i) {
    store(atom->v[i], (1 - mix) * vector(atom->v[i]) + turn * vector(atom->f[i]));
    store(atom->omega[i], (1 - mix) * vector(atom->omega[i]) + turn / scale2_ * vector(atom->torque[i]));
  }
}

double FixRelax::fastest() const {
  double own = 0, all = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    own = std::max(own, vector(atom->v[i]).squaredNorm() + scale2_ * vector(atom->omega[i]).squaredNorm());
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return std::sqrt(all);
}

void FixRelax::initial_integrate(int) {
  const double time = model_->time_at(update->ntimestep - 1);
  if (sums().power > 0) {
    fire_.went_down();
  } else {
    if (grip_) grip_->constrain(time, -0.25 * last_, 0.0);
    move(-0.5 * last_);
    stop();
    fire_.went_up();
  }
  kick();
  if (grip_) grip_->constrain(time, 0.0, 0.0);
  turn_to_force(fire_.mix, sums());
  if (grip_) grip_->constrain(time, 0.0, 0.0);
  const double speed = fastest();
  if (!std::isfinite(speed))
    refuse(lmp, "step " + std::to_string(update->ntimestep) + ": relaxation met a force that is not finite",
           "start from a state without overlaps");
  last_ = speed > 0 ? std::min(fire_.dt, Fire::farthest(radius_) / speed) : fire_.dt;
  if (grip_) grip_->constrain(time, 0.5 * last_, 0.0);
  move(last_);
  ++steps_;
}

double FixRelax::largest_force() {
  const auto n = static_cast<std::size_t>(atom->nlocal);
  std::vector<double> values(6 * n);
  std::vector<double*> linear(n + 1), angular(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    linear[i] = &values[6 * i];
    angular[i] = &values[6 * i + 3];
    const TubeType& type = type_of(*model_, *atom, static_cast<int>(i));
    store(linear[i], vector(atom->f[i]) / type.mass);
    store(angular[i], vector(atom->torque[i]) / type.inertia);
  }
  if (grip_) grip_->free_parts(now(), linear.data(), angular.data());
  double own = 0, all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const TubeType& type = type_of(*model_, *atom, static_cast<int>(i));
    own = std::max(
        {own, type.mass * vector(linear[i]).norm(), type.inertia * vector(angular[i]).norm() / type.radius});
  }
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

void FixRelax::end_of_step() {
  stop_in_time();
  if (steps_ % Fire::check_every == 0 && largest_force() < model_->force_tolerance) timer->force_timeout();
}

}  // namespace ropewalk::lammps
