#include "lammps/fix_grip.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "lammps/fix_motion.hpp"
#include "lammps/pair_mdem.hpp"
#include "model/error.hpp"

namespace ropewalk::lammps {

FixGrip::FixGrip(LMP::LAMMPS* lmp, int count, char** words) : Fix(lmp, count, words), ranks_(world) {
  if (count != 3 || igroup != 0)
    refuse(lmp, "fix mdem/grip takes no words: the scene says what it drives", "write: fix grips all mdem/grip");
  model_ = loaded(lmp, "fix mdem/grip");
  int n = 0;
  for (const auto& load : model_->loads) {
    for (std::size_t k = 0; k < load->elements.size(); ++k) places_.push_back({load->elements[k], n, k});
    ++n;
    reads_.push_back(load->reads(model_->topology));
    if (reads_.back().empty()) continue;
    for (const auto* list : {&load->elements, &std::as_const(reads_.back())})
      known_.insert(known_.end(), list->begin(), list->end());
  }
  std::sort(known_.begin(), known_.end());
  known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
  std::stable_sort(places_.begin(), places_.end());
}

void FixGrip::post_neighbor() {
  std::vector<std::pair<int, int>> own;  // element, atom
  for (int i = 0; i < atom->nlocal; ++i) {
    const int e = element_of(*atom, i);
    if (std::binary_search(places_.begin(), places_.end(), Place{e, 0, 0}) ||
        std::binary_search(known_.begin(), known_.end(), e))
      own.emplace_back(e, i);
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
  own_.resize(atom_.size());
  std::iota(own_.begin(), own_.end(), 0);
  known_at_.clear();
  for (const int e : known_) {
    const auto at = std::lower_bound(own.begin(), own.end(), std::pair(e, 0));
    known_at_.push_back(at != own.end() && at->first == e ? static_cast<int>(at - own.begin())
                                                          : static_cast<int>(atom_.size()));
    if (known_at_.back() < static_cast<int>(own.size())) continue;
    topology_.add_tube(1, model_->topology.tube_type[static_cast<std::size_t>(model_->topology.tube_of(e))]);
    atom_.push_back(-1);
  }
  const auto known_place = [&](int e) {
    return known_at_[static_cast<std::size_t>(std::lower_bound(known_.begin(), known_.end(), e) - known_.begin())];
  };
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
    if (const std::vector<int>& reads = reads_[n - 1]; !reads.empty()) {
      numbers.clear();
      for (const auto* list : {&load->elements, &reads})
        for (const int e : *list) numbers.push_back(known_place(e));
    }
    here->elements = numbers;
    acting_.add(std::shared_ptr<const Load>(here));
  }
  state_ = State(atom_.size());
  forces_ = Forces(atom_.size());
}

// The engine that leads; LAMMPS's arrays are then behind. Null: none leads.
RankEngine* FixGrip::leading_engine() const {
  RankEngine* engine = engine_of(lmp);
  return engine && engine->leads() ? engine : nullptr;
}

void FixGrip::gather(bool those_of_others) {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  double** q = orientations(lmp);
  for (std::size_t k = 0; k < atom_.size(); ++k) {
    const int i = atom_[k];
    if (i < 0) continue;
    state_.position.set(k, vector(atom->x[i]));
    state_.velocity.set(k, vector(atom->v[i]));
    state_.angular_velocity.set(k, vector(atom->omega[i]));
    state_.orientation.set(k, quaternion(q[i]));
    forces_.force.set(k, vector(atom->f[i]));
    forces_.torque.set(k, vector(atom->torque[i]));
  }
  if (those_of_others && !known_.empty()) ask_others();
}

// The owner of an element has its numbers, and the others nothing: their sum has the same bits.
void FixGrip::ask_others() {
  constexpr std::size_t of_each = 13;
  numbers_.assign(of_each * known_.size(), 0.0);
  const auto visit = [this](bool own, const auto& f) {
    for (std::size_t n = 0; n < known_at_.size(); ++n) {
      const auto k = static_cast<std::size_t>(known_at_[n]);
      if ((atom_[k] >= 0) == own) f(&numbers_[of_each * n], k);
    }
  };
  visit(true, [this](double* to, std::size_t k) {
    const Quaternion q = state_.orientation[k];
    store(to, state_.position[k]);
    store(to + 3, state_.velocity[k]);
    store(to + 6, state_.angular_velocity[k]);
    to[9] = q.w(), to[10] = q.x(), to[11] = q.y(), to[12] = q.z();
  });
  ranks_.sum(numbers_.data(), numbers_.size());
  visit(false, [this](const double* from, std::size_t k) {
    state_.position.set(k, vector(from));
    state_.velocity.set(k, vector(from + 3));
    state_.angular_velocity.set(k, vector(from + 6));
    state_.orientation.set(k, quaternion(from + 9));
  });
}

void FixGrip::find_loads() {
  gather(false);
  const auto* motion = find_fix<FixMotion>(lmp);
  point_loads(acting_, state_, motion ? motion->time_of_forces() : model_->time_at(update->ntimestep), loads_);
}

void FixGrip::post_force(int) {
  find_loads();
  for (const PointLoad& load : loads_) {
    const int i = atom_[static_cast<std::size_t>(load.element)];
    if (i < 0) continue;
    add(atom->f[i], load.force);
    add(atom->torque[i], load.torque);
  }
}

double FixGrip::own_power() {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  for (const int k : own_) {
    const int i = atom_[static_cast<std::size_t>(k)];
    state_.velocity.set(static_cast<std::size_t>(k), vector(atom->v[i]));
    state_.angular_velocity.set(static_cast<std::size_t>(k), vector(atom->omega[i]));
  }
  return load_power(loads_, state_);
}

double FixGrip::constrain(double time, double ahead, double kick) {
  gather(true);
  state_.step = update->ntimestep;
  try {
    ropewalk::constrain(topology_, acting_, own_, time, ahead, forces_, kick, state_, impulses_);
  } catch (const NumericalError& e) {
    lmp->error->all(FLERR, std::string(e.what()));  // all ranks know the same of a slice
  }
  double work = 0;
  for (const ConstraintImpulse& c : impulses_) work += c.work;
  for (const int k : own_) {
    const int i = atom_[static_cast<std::size_t>(k)];
    store(atom->v[i], state_.velocity[static_cast<std::size_t>(k)]);
    store(atom->omega[i], state_.angular_velocity[static_cast<std::size_t>(k)]);
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
