#include "lammps/rank_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "comm.h"
#include "sim/contact/contact_law.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/dynamics/spins.hpp"
#include "sim/forces/kick.hpp"
#include "sim/state/part_of_scene.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk::lammps {
namespace {

constexpr int numbers_joined = 5, largest_joined = 2;  // numbers, the first of which are no sums

void join_numbers(void* from, void* to, int* count, MPI_Datatype*) {
  for (int k = 0; k < *count; ++k) {
    const double* a = static_cast<const double*>(from) + numbers_joined * k;
    double* b = static_cast<double*>(to) + numbers_joined * k;
    for (int m = 0; m < largest_joined; ++m) b[m] = std::max(a[m], b[m]);
    for (int m = largest_joined; m < numbers_joined; ++m) b[m] += a[m];
  }
}

// Vectors of LAMMPS have their components side by side.
void take_vectors(const double* from, Vec3Array& to, std::ptrdiff_t at, int count) {
  double *x = to.x.data() + at, *y = to.y.data() + at, *z = to.z.data() + at;
  for (int k = 0; k < count; ++k) x[k] = from[3 * k], y[k] = from[3 * k + 1], z[k] = from[3 * k + 2];
}
void give_vectors(const Vec3Array& from, std::ptrdiff_t at, int count, double* to) {
  const double *x = from.x.data() + at, *y = from.y.data() + at, *z = from.z.data() + at;
  for (int k = 0; k < count; ++k) to[3 * k] = x[k], to[3 * k + 1] = y[k], to[3 * k + 2] = z[k];
}
void add_vectors(const Vec3Array& from, std::ptrdiff_t at, int count, double* to) {
  const double *x = from.x.data() + at, *y = from.y.data() + at, *z = from.z.data() + at;
  for (int k = 0; k < count; ++k) to[3 * k] += x[k], to[3 * k + 1] += y[k], to[3 * k + 2] += z[k];
}

}  // namespace

AllRanks::AllRanks(MPI_Comm world) : world_(world) {
  MPI_Type_contiguous(numbers_joined, MPI_DOUBLE, &numbers_);
  MPI_Type_commit(&numbers_);
  MPI_Op_create(join_numbers, 1, &join_);
}

AllRanks::~AllRanks() {
  MPI_Op_free(&join_);
  MPI_Type_free(&numbers_);
}

void AllRanks::join(double& largest, double (&sums)[3]) const {
  const double own[numbers_joined] = {largest, signal_, sums[0], sums[1], sums[2]};
  double all[numbers_joined];
  MPI_Allreduce(own, all, 1, numbers_, join_, world_);
  largest = all[0];
  signal_ = all[1];
  std::copy(all + largest_joined, all + numbers_joined, sums);
}

RankEngine::RankEngine(LMP::LAMMPS* lmp, std::shared_ptr<const LammpsModel> model)
    : lmp_(lmp),
      model_(std::move(model)),
      messages_(lmp->world),
      list_(model_->interaction, default_skin(model_->interaction)) {
  if (lmp->comm->nprocs > 1) {
    ranks_ = std::make_unique<AllRanks>(lmp->world);
    engine_.share_with(&messages_);
  }
  list_.others = ranks_.get();
}

std::string RankEngine::instructions() { return instructions_in_use(); }

void RankEngine::take(const Stretch& of) {
  const LMP::Atom& atom = *lmp_->atom;
  const auto at = static_cast<std::ptrdiff_t>(of.element);
  take_vectors(atom.x[of.atom], state_.position, at, of.count);
  take_vectors(atom.v[of.atom], state_.velocity, at, of.count);
  take_vectors(atom.omega[of.atom], state_.angular_velocity, at, of.count);
  const double* q = quaternions_[of.atom];
  QuaternionArray& to = state_.orientation;
  double *w = to.w.data() + at, *x = to.x.data() + at, *y = to.y.data() + at, *z = to.z.data() + at;
  for (int k = 0; k < of.count; ++k) w[k] = q[4 * k], x[k] = q[4 * k + 1], y[k] = q[4 * k + 2], z[k] = q[4 * k + 3];
}

void RankEngine::give(const Stretch& of) {
  const LMP::Atom& atom = *lmp_->atom;
  const auto at = static_cast<std::ptrdiff_t>(of.element);
  give_vectors(state_.position, at, of.count, atom.x[of.atom]);
  give_vectors(state_.velocity, at, of.count, atom.v[of.atom]);
  give_vectors(state_.angular_velocity, at, of.count, atom.omega[of.atom]);
  double* q = quaternions_[of.atom];
  const QuaternionArray& from = state_.orientation;
  const double *w = from.w.data() + at, *x = from.x.data() + at, *y = from.y.data() + at, *z = from.z.data() + at;
  for (int k = 0; k < of.count; ++k) q[4 * k] = w[k], q[4 * k + 1] = x[k], q[4 * k + 2] = y[k], q[4 * k + 3] = z[k];
}

void RankEngine::take_own() {
  quaternions_ = orientations(lmp_);
  for (const Stretch& s : own_) take(s);
}

void RankEngine::give_own() {
  if (leads_) complete_forces();
  quaternions_ = orientations(lmp_);
  for (const Stretch& s : own_) {
    give(s);
    if (!leads_) continue;
    give_vectors(forces_.force, s.element, s.count, lmp_->atom->f[s.atom]);
    give_vectors(forces_.torque, s.element, s.count, lmp_->atom->torque[s.atom]);
  }
}

void RankEngine::share_none() {
  is_shared_.assign(static_cast<std::size_t>(lmp_->atom->nlocal), 0);
  shared_known_ = false;
}

void RankEngine::share(const int* atoms, int count) {
  for (int k = 0; k < count; ++k)
    if (atoms[k] >= 0 && atoms[k] < static_cast<int>(is_shared_.size()))
      is_shared_[static_cast<std::size_t>(atoms[k])] = 1;
  shared_known_ = false;
}

const std::vector<RankEngine::Stretch>& RankEngine::shared() {
  if (shared_known_) return shared_;
  shared_known_ = true;
  shared_.clear();
  for (const Stretch& s : own_)
    for (int element = s.element, atom = s.atom; atom < s.atom + s.count; ++element, ++atom) {
      if (!is_shared_[static_cast<std::size_t>(atom)]) continue;
      const bool goes_on = !shared_.empty() && shared_.back().element + shared_.back().count == element &&
                           shared_.back().atom + shared_.back().count == atom;
      if (goes_on)
        ++shared_.back().count;
      else
        shared_.push_back({element, atom, 1});
    }
  return shared_;
}

void RankEngine::give_shared() {
  quaternions_ = orientations(lmp_);
  for (const Stretch& s : shared()) give(s);
}

void RankEngine::give(const std::vector<int>& atoms) {
  quaternions_ = orientations(lmp_);
  for (const int i : atoms)
    if (i >= 0) give(Stretch{element_[static_cast<std::size_t>(i)], i, 1});
}

void RankEngine::take_velocities(const std::vector<int>& atoms) {
  for (const int i : atoms) {
    if (i < 0) continue;
    const auto at = static_cast<std::size_t>(element_[static_cast<std::size_t>(i)]);
    state_.velocity.set(at, vector(lmp_->atom->v[i]));
    state_.angular_velocity.set(at, vector(lmp_->atom->omega[i]));
  }
}

void RankEngine::take_forces(const Stretch& of) {
  take_vectors(lmp_->atom->f[of.atom], forces_.force, of.element, of.count);
  take_vectors(lmp_->atom->torque[of.atom], forces_.torque, of.element, of.count);
}

void RankEngine::complete_forces() {
  if (all_forces_there_ || shared_forces_there_)
    for (const Stretch& s : all_forces_there_ ? own_ : shared()) take_forces(s);
  all_forces_there_ = shared_forces_there_ = false;
}

double RankEngine::kick(double dt) {
  complete_forces();
  return kick_all(topology_, engine_.terms(), rows_of(forces_), dt, static_cast<int>(moved_.size()),
                  [this](int k) { return moved_[static_cast<std::size_t>(k)]; }, state_);
}

void RankEngine::move(double dt) {
  changes_.resize(moved_.size());
  fastest_of_.resize(moved_.size());
  for_each(moved_.size(), state_.size() > parallel_from, [&](std::size_t k) {
    const std::ptrdiff_t at = moved_[k].begin, end = moved_[k].end;
    fastest_of_[k] = ropewalk::fastest(state_, at, end);
    move_elements(state_, dt, at, end);
    changes_[k] = list_.change(state_, at, end);
  });
  fastest_ = {};
  for (const Fastest& f : fastest_of_) {
    fastest_.speed2 = std::max(fastest_.speed2, f.speed2);
    fastest_.spin2 = std::max(fastest_.spin2, f.spin2);
    fastest_.sum += f.sum;
  }
}

// Copies change as well; their owners send them before they are read.
void RankEngine::bathe(const Thermostat& bath, double dt, std::int64_t step, int part, double time) {
  state_.step = step;
  state_.part = part;
  state_.time = time;
  std::vector<double> none;
  bath.apply(topology_, dt, state_, none);
}

bool RankEngine::stale(int& signal) {
  ++steps_;
  Change all;  // summed in the order of the elements, whatever the threads
  for (const Change& c : changes_) all = both(all, c);
  if (engine_.terms().have_news()) all.moved = std::numeric_limits<double>::infinity();
  if (ranks_) ranks_->send_along(signal);
  const bool stale = list_.stale(all);
  if (ranks_) signal = ranks_->signal();
  return stale;
}

// The mean of the best skins of all ranks, weighted by their elements.
double RankEngine::choose_skin() {
  // News of a force term make a list old before its time.
  if (!engine_.contact() || steps_ == 0 || !std::isfinite(list_.displacement())) return list_.skin;
  double best = engine_.contact()->best_skin(topology_, list_.skin, steps_);
  if (ranks_) {
    const double own = lmp_->atom->nlocal;
    double none = 0, sums[3] = {own * best, own, 0};
    ranks_->join(none, sums);
    best = sums[0] / sums[1];
  }
  return list_.skin = best;
}

// A force term that cannot go on says why.
template <class F>
void RankEngine::or_refuse(const F& f) {
  try {
    f();
  } catch (const std::runtime_error& e) {
    refuse_one(lmp_, "step " + std::to_string(lmp_->update->ntimestep) + ": " + e.what(),
               "go on from the last state with `ropewalk import` and `ropewalk resume`");
  }
}

std::vector<TermEvent> RankEngine::take_events() {
  std::vector<TermEvent> events = engine_.terms().events();
  engine_.forget_events();
  return events;
}

void RankEngine::build(bool begins) {
  const bool goes_on = !begins && list_.builds() > 0;
  const LMP::Atom& atom = *lmp_->atom;
  const int all = atom.nlocal + atom.nghost;
  std::vector<std::pair<int, int>> order;  // element of the scene, atom
  order.reserve(static_cast<std::size_t>(all));
  for (int i = 0; i < all; ++i) order.emplace_back(element_of(atom, i), i);
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  std::vector<int> number;
  std::vector<char> own;
  number.reserve(order.size());
  own.reserve(order.size());
  own_.clear();
  ghosts_.clear();
  for (const auto& [element, i] : order) {
    const bool owned = i < atom.nlocal;
    if (!number.empty() && number.back() == element)
      refuse_one(lmp_, "element " + std::to_string(element) + " is on this rank twice",
                 "leave boundary m m m as in.rope has it");
    const int at = static_cast<int>(number.size());
    std::vector<Stretch>& stretches = owned ? own_ : ghosts_;
    const bool goes_on = !stretches.empty() && stretches.back().element + stretches.back().count == at &&
                         stretches.back().atom + stretches.back().count == i &&
                         atom.type[stretches.back().atom] == atom.type[i] &&
                         (!owned || stretches.back().count < cached_elements);
    if (goes_on)
      ++stretches.back().count;
    else
      stretches.push_back({at, i, 1});
    number.push_back(element);
    own.push_back(owned);
  }
  topology_ = part_of_scene(model_->topology, std::move(number), std::move(own));
  if (!ranks_) {  // it is the scene
    topology_.part.reset();
    topology_.groups = model_->topology.groups;
  }
  find_moved();
  if (state_.size() != order.size()) {
    state_ = State(order.size());
    forces_ = Forces(order.size());
  }
  quaternions_ = orientations(lmp_);
  for (const auto* stretches : {&own_, &ghosts_})
    for (const Stretch& s : *stretches) take(s);
  element_.resize(static_cast<std::size_t>(atom.nlocal));
  for (const Stretch& s : own_)
    for (int k = 0; k < s.count; ++k) element_[static_cast<std::size_t>(s.atom + k)] = s.element + k;
  list_.build(topology_, state_);
  or_refuse([&] {
    engine_.set_memory(model_->interaction, std::exchange(next_memory_, {}), model_->topology.elements(), goes_on);
  });
  steps_ = 0;
}

void RankEngine::find_moved() {
  moved_.clear();
  for (int t = 0; t < topology_.tubes(); ++t)
    for (int i = topology_.tube_begin[t], to; i < topology_.tube_begin[t + 1]; i = to) {
      to = std::min(topology_.tube_begin[t + 1], i + cached_elements);
      if (topology_.part) to = topology_.change_of_owner(i, to);
      if (topology_.owns(i)) moved_.push_back({t, i, to});
    }
}

void RankEngine::evaluate(const State& state, const ForceOptions& options, Forces& out) {
  out.resize(state.size());
  or_refuse([&] { engine_.compute(topology_, model_->interaction, list_, state, out, options); });
}

void RankEngine::compute(bool energies) {
  const LMP::Atom& atom = *lmp_->atom;
  quaternions_ = orientations(lmp_);
  for (const Stretch& s : ghosts_) take(s);
  state_.step = lmp_->update->ntimestep;
  state_.time = moment_.time;
  evaluate(state_, {Parts::all, energies, moment_.passed}, forces_);
  contact_energy_known_ = energies;
  // At the start of a run LAMMPS writes forces before the first step.
  const bool all = !leads_ || lmp_->update->setupflag;
  for (const auto* stretches : {all ? &std::as_const(own_) : &shared(), &std::as_const(ghosts_)})
    for (const Stretch& s : *stretches) {
      add_vectors(forces_.force, s.element, s.count, atom.f[s.atom]);
      add_vectors(forces_.torque, s.element, s.count, atom.torque[s.atom]);
    }
  all_forces_there_ = leads_ && all;
  shared_forces_there_ = leads_ && !all;
}

void RankEngine::begin_spins() {
  spins_.known.assign(state_.size(), 0);
  spins_.place.assign(state_.size(), -1);
  spins_.atom.assign(state_.size(), -1);
  for (const auto* stretches : {&own_, &ghosts_})
    for (const Stretch& s : *stretches)
      for (int k = 0; k < s.count; ++k) {
        spins_.place[static_cast<std::size_t>(s.atom + k)] = s.element + k;
        spins_.atom[static_cast<std::size_t>(s.element + k)] = s.atom + k;
      }
  spins_.fresh = middles_of_tubes(model_->topology, topology_);
  for (const int place : spins_.fresh) spins_.known[static_cast<std::size_t>(place)] = 1;
}

std::vector<int> RankEngine::follow_spins(const std::vector<int>& copies) {
  double** q = orientations(lmp_);
  for (const int i : copies) {
    const auto place = static_cast<std::size_t>(spins_.place[static_cast<std::size_t>(i)]);
    state_.orientation.set(place, quaternion(q[i]));
    spins_.known[place] = 1;
  }
  std::vector<int> atoms;
  const std::vector<int> followed = ropewalk::follow_spins(topology_, spins_.known, state_);
  for (const auto* places : {&std::as_const(spins_.fresh), &followed})
    for (const int place : *places) {
      const int i = spins_.atom[static_cast<std::size_t>(place)];
      const Quaternion turned = state_.orientation[static_cast<std::size_t>(place)];
      q[i][0] = turned.w(), q[i][1] = turned.x(), q[i][2] = turned.y(), q[i][3] = turned.z();
      atoms.push_back(i);
    }
  spins_.fresh.clear();
  return atoms;
}

void RankEngine::end_spins() {
  take_spin_velocities_away(topology_, state_);
  spins_ = {};
}

BondEnergy RankEngine::bond_energy() const {
  const Energies& e = forces_.energy;
  return {e.stretch, e.shear, e.bend, e.twist};
}

double RankEngine::contact_energy() {
  if (!contact_energy_known_) {
    evaluate(state_, {Parts::contact, true}, spare_);
    forces_.energy.vdw = spare_.energy.vdw;
    contact_energy_known_ = true;
  }
  return forces_.energy.vdw;
}

int RankEngine::slipping_element() const {
  const int i = forces_.slipping_bond;
  if (i < 0 || !topology_.part) return i;
  return topology_.part->number[static_cast<std::size_t>(i)];
}

// Damping acts on velocities: there are none.
std::array<double, 6> RankEngine::virial(Parts parts) {
  State still = state_;
  still.velocity = still.angular_velocity = Vec3Array(state_.size());
  evaluate(still, {parts, false}, spare_);
  std::array<double, 6> sum{};
  for (std::size_t i = 0; i < still.size(); ++i) {
    const Vector3 x = still.position[i], f = spare_.force[i];
    const double terms[6] = {x.x() * f.x(), x.y() * f.y(), x.z() * f.z(),
                             x.x() * f.y(), x.x() * f.z(), x.y() * f.z()};
    for (std::size_t k = 0; k < 6; ++k) sum[k] += terms[k];
  }
  return sum;
}

}  // namespace ropewalk::lammps
