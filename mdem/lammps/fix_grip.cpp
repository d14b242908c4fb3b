#include "lammps/fix_grip.hpp"

#include <algorithm>
#include <numeric>

#include "lammps/fix_motion.hpp"
#include "lammps/pair_mdem.hpp"

namespace ropewalk::lammps {

FixGrip::FixGrip(LMP::LAMMPS* lmp, int count, char** words) : Fix(lmp, count, words), ranks_(world) {
  if (count != 3 || igroup != 0)
    refuse(lmp, "fix mdem/grip takes no words: the scene says what it drives", "write: fix grips all mdem/grip");
  model_ = loaded(lmp, "fix mdem/grip");
  int n = 0;
  for (const auto& load : model_->loads) {
    for (std::size_t k = 0; k < load->elements.size(); ++k) places_.push_back({load->elements[k], n, k});
    ++n;
  }
  std::stable_sort(places_.begin(), places_.end());
}

void FixGrip::post_neighbor() {
  std::vector<std::pair<int, int>> own;  // element, atom
  for (int i = 0; i < atom->nlocal; ++i) {
    const int e = element_of(*atom, i);
    if (std::binary_search(places_.begin(), places_.end(), Place{e, 0, 0})) own.emplace_back(e, i);
  }
  std::sort(own.begin(), own.end());
  const auto loads = static_cast<std::size_t>(std::distance(model_->loads.begin(), model_->loads.end()));
  std::vector<std::vector<std::pair<std::size_t, int>>> acts(loads);  // place in the load, index in this state
  atom_.clear();
  topology_ = Topology();
  topology_.types = model_->topology.types;
  for (const auto& [e, i] : own) {
    const auto [from, to] = std::equal_range(places_.begin(), places_.end(), Place{e, 0, 0});
    for (auto p = from; p != to; ++p)
      acts[static_cast<std::size_t>(p->load)].emplace_back(p->place, static_cast<int>(atom_.size()));
    topology_.add_tube(1, atom->type[i] - 1);
    atom_.push_back(i);
  }
  acting_ = LoadsAndConstraints();
  std::size_t n = 0;
  for (const auto& load : model_->loads) {
    auto& of = acts[n++];
    std::sort(of.begin(), of.end());
    std::vector<std::size_t> places;
    std::vector<int> numbers;
    for (const auto& [place, number] : of) {
      places.push_back(place);
      numbers.push_back(number);
    }
    const std::shared_ptr<Load> here = load->copy();
    here->keep(places, ranks_);
    here->elements = numbers;
    acting_.add(std::shared_ptr<const Load>(here));
  }
  own_.resize(atom_.size());
  std::iota(own_.begin(), own_.end(), 0);
  state_ = State(atom_.size());
  forces_ = Forces(atom_.size());
}

// The engine that leads; LAMMPS's arrays are then behind. Null: none leads.
RankEngine* FixGrip::leading_engine() const {
  RankEngine* engine = engine_of(lmp);
  return engine && engine->leads() ? engine : nullptr;
}

void FixGrip::gather() {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  double** q = orientations(lmp);
  for (std::size_t k = 0; k < atom_.size(); ++k) {
    const int i = atom_[k];
    state_.position.set(k, vector(atom->x[i]));
    state_.velocity.set(k, vector(atom->v[i]));
    state_.angular_velocity.set(k, vector(atom->omega[i]));
    state_.orientation.set(k, quaternion(q[i]));
    forces_.force.set(k, vector(atom->f[i]));
    forces_.torque.set(k, vector(atom->torque[i]));
  }
}

void FixGrip::find_loads() {
  gather();
  const auto* motion = find_fix<FixMotion>(lmp);
  point_loads(acting_, state_, motion ? motion->time_of_forces() : model_->time_at(update->ntimestep), loads_);
}

void FixGrip::post_force(int) {
  find_loads();
  for (const PointLoad& load : loads_) {
    const int i = atom_[static_cast<std::size_t>(load.element)];
    add(atom->f[i], load.force);
    add(atom->torque[i], load.torque);
  }
}

double FixGrip::own_power() {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  for (std::size_t k = 0; k < atom_.size(); ++k) {
    state_.velocity.set(k, vector(atom->v[atom_[k]]));
    state_.angular_velocity.set(k, vector(atom->omega[atom_[k]]));
  }
  return load_power(loads_, state_);
}

double FixGrip::constrain(double time, double ahead, double kick) {
  gather();
  ropewalk::constrain(topology_, acting_, own_, time, ahead, forces_, kick, state_, impulses_);
  double work = 0;
  for (const ConstraintImpulse& c : impulses_) work += c.work;
  for (std::size_t k = 0; k < atom_.size(); ++k) {
    store(atom->v[atom_[k]], state_.velocity[k]);
    store(atom->omega[atom_[k]], state_.angular_velocity[k]);
  }
  if (RankEngine* engine = leading_engine()) engine->take_velocities(atom_);
  return work;
}

void FixGrip::free_parts(double time, double** linear, double** angular) {
  double **v = atom->v, **omega = atom->omega;
  atom->v = linear;
  atom->omega = angular;
  constrain(time, 0.0, 0.0);
  atom->v = v;
  atom->omega = omega;
}

}  // namespace ropewalk::lammps
