#include "lammps/fix_grip.hpp"

#include <algorithm>
#include <numeric>

#include "lammps/pair_mdem.hpp"

namespace ropewalk::lammps {
namespace {

bool need_all_elements(const LoadsAndConstraints& loads) {
  return std::any_of(loads.begin(), loads.end(), [](const auto& load) { return load->needs_all_elements(); });
}

// The loads and constraints on `elements` (sorted), with element numbers replaced by indices into `elements`.
LoadsAndConstraints part_of(const LoadsAndConstraints& loads, const std::vector<int>& elements) {
  LoadsAndConstraints out;
  for (const auto& all : loads) {
    const std::shared_ptr<Load> part = all->copy();
    part->elements.clear();
    for (const int e : all->elements) {
      const auto at = std::lower_bound(elements.begin(), elements.end(), e);
      if (at != elements.end() && *at == e) part->elements.push_back(static_cast<int>(at - elements.begin()));
    }
    out.add(std::shared_ptr<const Load>(part));
  }
  return out;
}

}  // namespace

FixGrip::FixGrip(LMP::LAMMPS* lmp, int count, char** words) : Fix(lmp, count, words) {
  if (count != 3 || igroup != 0)
    refuse(lmp, "fix mdem/grip takes no words: the scene says what it drives", "write: fix grips all mdem/grip");
  model_ = loaded(lmp, "fix mdem/grip");
  driven_ = loaded_elements(model_->loads);
  whole_ = need_all_elements(model_->loads);
  if (whole_) use(driven_);
}

void FixGrip::use(const std::vector<int>& elements) {
  acting_ = part_of(model_->loads, elements);
  topology_ = Topology();
  topology_.types = model_->topology.types;
  for (const int e : elements) topology_.add_tube(1, model_->topology.tube_type[model_->topology.tube_of(e)]);
  own_.resize(elements.size());
  std::iota(own_.begin(), own_.end(), 0);
  state_ = State(elements.size());
  forces_ = Forces(elements.size());
}

void FixGrip::post_neighbor() {
  std::vector<std::pair<int, int>> own;  // element, atom
  for (int i = 0; i < atom->nlocal; ++i) {
    const int e = element_of(*atom, i);
    if (std::binary_search(driven_.begin(), driven_.end(), e)) own.emplace_back(e, i);
  }
  std::sort(own.begin(), own.end());
  if (whole_) {
    atom_.assign(driven_.size(), -1);
    for (const auto& [e, i] : own)
      atom_[static_cast<std::size_t>(std::lower_bound(driven_.begin(), driven_.end(), e) - driven_.begin())] = i;
    return;
  }
  std::vector<int> elements;
  atom_.clear();
  for (const auto& [e, i] : own) {
    elements.push_back(e);
    atom_.push_back(i);
  }
  use(elements);
}

// In one message. Every value is nonzero on its owner only, so that the sum over the ranks is exact.
void FixGrip::share(const std::vector<std::vector<double>*>& all) {
  shared_.clear();
  for (const std::vector<double>* v : all) shared_.insert(shared_.end(), v->begin(), v->end());
  MPI_Allreduce(MPI_IN_PLACE, shared_.data(), static_cast<int>(shared_.size()), MPI_DOUBLE, MPI_SUM, world);
  auto from = shared_.begin();
  for (std::vector<double>* v : all) {
    const auto to = from + static_cast<std::ptrdiff_t>(v->size());
    std::copy(from, to, v->begin());
    from = to;
  }
}

// Where the engine leads, LAMMPS's arrays are behind.
RankEngine* FixGrip::leading_engine() const {
  RankEngine* engine = engine_of(lmp);
  return engine && engine->leads() ? engine : nullptr;
}

void FixGrip::gather() {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  double** q = orientations(lmp);
  for (std::size_t k = 0; k < atom_.size(); ++k) {
    const bool own = owned(k);
    const auto get = [&](double** of) { return own ? vector(of[atom_[k]]) : Vector3::Zero().eval(); };
    state_.position.set(k, get(atom->x));
    state_.velocity.set(k, get(atom->v));
    state_.angular_velocity.set(k, get(atom->omega));
    forces_.force.set(k, get(atom->f));
    forces_.torque.set(k, get(atom->torque));
    state_.orientation.set(k, own ? quaternion(q[atom_[k]]) : Quaternion(0, 0, 0, 0));
  }
  if (!whole_) return;
  std::vector<std::vector<double>*> all;
  for (Vec3Array* v :
       {&state_.position, &state_.velocity, &state_.angular_velocity, &forces_.force, &forces_.torque})
    all.insert(all.end(), {&v->x, &v->y, &v->z});
  QuaternionArray& turned = state_.orientation;
  all.insert(all.end(), {&turned.w, &turned.x, &turned.y, &turned.z});
  share(all);
}

void FixGrip::post_force(int) {
  gather();
  point_loads(acting_, state_, model_->time_at(update->ntimestep), loads_);
  loads_.erase(std::remove_if(loads_.begin(), loads_.end(),
                              [&](const PointLoad& l) { return !owned(static_cast<std::size_t>(l.element)); }),
               loads_.end());
  for (const PointLoad& load : loads_) {
    const int i = atom_[static_cast<std::size_t>(load.element)];
    add(atom->f[i], load.force);
    add(atom->torque[i], load.torque);
  }
}

double FixGrip::own_power() {
  if (RankEngine* engine = leading_engine()) engine->give(atom_);
  for (std::size_t k = 0; k < atom_.size(); ++k)
    if (owned(k)) {
      state_.velocity.set(k, vector(atom->v[atom_[k]]));
      state_.angular_velocity.set(k, vector(atom->omega[atom_[k]]));
    }
  return load_power(loads_, state_);
}

double FixGrip::constrain(double time, double kick) {
  gather();
  ropewalk::constrain(topology_, acting_, own_, time, kick, forces_, kick, state_, impulses_);
  double work = 0;
  for (const ConstraintImpulse& c : impulses_) work += c.work;
  for (std::size_t k = 0; k < atom_.size(); ++k)
    if (owned(k)) {
      store(atom->v[atom_[k]], state_.velocity[k]);
      store(atom->omega[atom_[k]], state_.angular_velocity[k]);
    }
  if (RankEngine* engine = leading_engine()) engine->take_velocities(atom_);
  return whole_ && comm->me > 0 ? 0.0 : work;  // if whole_, every rank has computed the total
}

void FixGrip::free_parts(double time, double** linear, double** angular) {
  double **v = atom->v, **omega = atom->omega;
  atom->v = linear;
  atom->omega = angular;
  constrain(time, 0.0);
  atom->v = v;
  atom->omega = omega;
}

}  // namespace ropewalk::lammps
