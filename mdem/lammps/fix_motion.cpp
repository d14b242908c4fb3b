#include "lammps/fix_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "domain.h"
#include "lammps/bond_vbond.hpp"
#include "lammps/fix_damp.hpp"
#include "lammps/fix_grip.hpp"
#include "lammps/fix_states.hpp"
#include "lammps/pair_mdem.hpp"
#include "neighbor.h"
#include "output.h"
#include "scene/lammps_files.hpp"
#include "sim/state/motion.hpp"
#include "sim/state/part_of_scene.hpp"
#include "timer.h"

namespace ropewalk::lammps {
namespace {

using namespace LMP::FixConst;

constexpr int numbers_a_round = 31;  // numbers of one element

// Versions of LAMMPS have different names for the call that sends the values of a fix to ghosts.
template <class Comm>
auto send_to_ghosts(Comm& comm, LMP::Fix* fix, int) -> decltype(comm.forward_comm_fix(fix)) {
  return comm.forward_comm_fix(fix);
}
template <class Comm>
auto send_to_ghosts(Comm& comm, LMP::Fix* fix, long) -> decltype(comm.forward_comm(fix)) {
  return comm.forward_comm(fix);
}

}  // namespace

FixMotion::FixMotion(LMP::LAMMPS* lmp, int count, char** words) : Fix(lmp, count, words) {
  if (count != 3 || igroup != 0)
    refuse(lmp, std::string("fix ") + words[2] + " takes no words and moves all elements",
           std::string("write: fix motion all ") + words[2]);
  model_ = loaded(lmp, words[2]);
  time_integrate = 1;
  force_reneighbor = 1;  // where the engine asks for it
  next_reneighbor = -1;
  restart_global = 1;
  const auto& terms = model_->interaction.terms;
  remembers_ = std::any_of(terms.begin(), terms.end(), [](const auto& term) { return term->remembers(); });
  comm_forward = remembers_ ? std::max(4, 1 + numbers_a_round) : 4;
  if (remembers_) {
    restart_peratom = 1;
    maxexchange_dynamic = 1;
    grow_arrays(atom->nmax);
    atom->add_callback(LMP::Atom::GROW);
    atom->add_callback(LMP::Atom::RESTART);
  }
  vector_flag = 1;
  size_vector = lammps_row_numbers + lammps_numbers_of_term * static_cast<int>(model_->interaction.terms.size());
  global_freq = 1;
  extvector = 0;
  const auto* states = find_fix<FixStates>(lmp);
  if (!states || !states->began()) return;  // read_restart tells where the run stands
  const StateHeader& began = *states->began();
  carried_ = began.step;
  divided_ = static_cast<int>(began.divided);
  control_ = began.control();
  first_skin_ = began.skin;
  for_records(states->memory(), [&](int element, const double* of, std::size_t count) {
    if (element == the_account) accounts_.insert(accounts_.end(), of, of + count);
  });
  give_memory(states->memory());
  if (comm->me == 0) {
    account_ = {began.work, began.dissipated, began.heat};
  }
}

FixMotion::~FixMotion() {
  if (!remembers_) return;
  atom->delete_callback(id, LMP::Atom::GROW);
  atom->delete_callback(id, LMP::Atom::RESTART);
}

int FixMotion::setmask() { return POST_INTEGRATE | PRE_EXCHANGE | PRE_NEIGHBOR | POST_NEIGHBOR | PRE_FORCE; }

void FixMotion::init() {
  slowest_ = 0;
  check_atoms(lmp, style);
  check_styles(lmp, *model_);
  orientations(lmp);
  carried(lmp);
  if (update->dt != model_->start.time_step)
    refuse(lmp, "the time step is not that of the export", "take it from in.rope, or export a scene with another");
  grip_ = find_fix<FixGrip>(lmp);
  damp_ = find_fix<FixDamp>(lmp);
  states_ = find_fix<FixStates>(lmp);
  engine_ = engine_of(lmp);
  if (model_->thermostat && !engine_)
    refuse(lmp, "[thermostat] acts through the engine, and forces are computed pair by pair",
           "leave -var forces plain out");
  if (engine_) {
    if (first_skin_ > 0) engine_->use_skin(std::exchange(first_skin_, 0.0));
    lead_exchanges();
    engine_->lead(engine_may_lead());
  }
  find_longest();
}

// Fixes that read or move elements in their own ways find them in LAMMPS's arrays.
bool FixMotion::only_known_fixes() const {
  for (int k = 0; k < modify->nfix; ++k) {
    const LMP::Fix* fix = modify->fix[k];
    const std::string name = fix->style;
    const bool ours = fix == this || fix == grip_ || fix == damp_ || dynamic_cast<const FixStates*>(fix);
    if (!ours && name != "property/atom" && name != "print" && name != "balance") return false;
  }
  return true;
}

// Whether LAMMPS exchanges elements in this step, for whatever reason.
bool FixMotion::exchanged_now() const {
  const auto now = update->ntimestep;
  if (may_stop_now()) return true;
  if (output->restart_flag && output->next_restart == now) return true;
  for (int k = 0; k < modify->nfix; ++k)
    if (modify->fix[k]->force_reneighbor && modify->fix[k]->next_reneighbor == now) return true;
  return false;
}

// LAMMPS exchanges elements when this fix says so, and at no other time; ghosts reach as far as the engine's list.
void FixMotion::lead_exchanges() {
  neighbor->every = 1;
  neighbor->delay = MAXSMALLINT;
  neighbor->dist_check = 0;
  neighbor->skin = 0;
  atom->sortfreq = 0;  // elements of a tube stay side by side
  reach_for(engine_->skin());
}

void FixMotion::reach_for(double skin) {
  comm->cutghostuser = copy_reach(model_->topology, model_->interaction, skin);
}

void FixMotion::post_integrate() {
  if (!engine_) return;
  int none = 0;
  look_at_list(none);
  hand_out();
}

void FixMotion::look_at_list(int& signal) {
  if (engine_->stale(signal)) next_reneighbor = update->ntimestep;
}

LMP::bigint FixMotion::steps_to_stop(LMP::bigint ahead) const {
  const auto from = [&](LMP::bigint first, LMP::bigint every) {
    const LMP::bigint behind = (update->ntimestep + ahead - first) % every;
    return ahead + (behind == 0 ? 0 : every - behind);
  };
  const LMP::bigint next = from(model_->start.step, lammps_steps_between_stops);
  return states_ ? std::min(next, from(0, states_->nevery)) : next;
}

void FixMotion::stop_in_time() {
  if (!may_stop_now()) return;
  const double now = MPI_Wtime();
  const auto step = update->ntimestep;
  slowest_ = std::max(slowest_, (now - looked_) / static_cast<double>(step - looked_step_));
  looked_ = now;
  looked_step_ = step;
  const double left = timer->get_timeout_remain();  // s; 0: there is no such time
  int ends = left != 0 && left < 1.5 * slowest_ * static_cast<double>(steps_to_stop(1)) ? 1 : 0;
  MPI_Bcast(&ends, 1, MPI_INT, 0, world);
  if (ends) timer->force_timeout();
}

void FixMotion::hand_out() {
  if (may_stop_now()) next_reneighbor = update->ntimestep;
  if (exchanged_now()) keep_memory();
  if (!engine_->leads()) return;
  if (exchanged_now())
    engine_->give_own();
  else
    engine_->give_shared();
}

void FixMotion::pre_exchange() {
  if (engine_) reach_for(engine_->choose_skin());
}

// These are the calls of LAMMPS's own loop, in their order.
void FixMotion::exchange_elements() {
  domain->pbc();
  if (domain->box_change) {
    domain->reset_box();
    comm->setup();
    if (neighbor->style) neighbor->setup_bins();
  }
  comm->exchange();
  comm->borders();
  neighbor->build(1);
  modify->post_neighbor();
}

// Stops the run if an element has been lost. LAMMPS itself counts atoms only when it prints, and a script may tell
// LAMMPS to ignore lost ones.
void FixMotion::check_elements() {
  LMP::bigint own = atom->nlocal, all = 0;
  MPI_Allreduce(&own, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all == model_->topology.elements()) return;
  refuse(lmp,
         "step " + std::to_string(update->ntimestep) + ": " + std::to_string(all) + " of " +
             std::to_string(model_->topology.elements()) + " elements are left",
         "go on from the last restart file, with boundary m m m and a gentler load");
}

void FixMotion::check_masses() {
  for (int i = 0; i < atom->nlocal; ++i) {
    const double mass = type_of(*model_, *atom, i).mass;
    if (!(std::fabs(atom->rmass[i] - mass) < 1e-9 * mass))
      refuse_one(lmp, "the mass of element " + std::to_string(element_of(*atom, i)) + " is not that of the scene",
                 "leave masses, diameters and types as the data file has them");
  }
}

// Checks the ghost cutoff before LAMMPS searches the ghosts for the other ends of bonds.
void FixMotion::setup_pre_neighbor() {
  const double reach =
      copy_reach(model_->topology, model_->interaction, engine_ ? engine_->skin() : neighbor->skin);
  const double has = *std::min_element(comm->cutghost, comm->cutghost + 3);
  if (has < reach * (1 - 1e-12))
    refuse(lmp,
           "ghosts reach " + std::to_string(has) + " nm and must reach " + std::to_string(reach) +
               " nm for contacts and bonds across ranks",
           "write: comm_modify mode single vel yes cutoff " + std::to_string(reach + 1e-3));
}

void FixMotion::setup_pre_force(int vflag) {
  check_masses();
  pre_force(vflag);
  looked_step_ = update->ntimestep;
  looked_ = MPI_Wtime();
}

// Sends the orientations to ghosts. LAMMPS itself does so only when it builds lists.
void FixMotion::pre_force(int) {
  if (engine_) engine_->use_moment({time_of_forces(), update->setupflag ? std::nullopt : passes()});
  if (engine_ && neighbor->ago == 0) {
    engine_->share_none();
    if (grip_) engine_->share(grip_->atoms().data(), static_cast<int>(grip_->atoms().size()));
    bring_memory();
  }
  send_orientations();
}

void FixMotion::send_orientations() { send_to_ghosts(*comm, this, 0); }

int FixMotion::pack_forward_comm(int count, int* list, double* buffer, int, int*) {
  if (round_ >= 0) {
    const double* const begin = buffer;
    for (int k = 0; k < count; ++k) {
      const std::vector<double>& of = memory_of(list[k]);
      const std::size_t from = std::min(of.size(), static_cast<std::size_t>(round_ * numbers_a_round)),
                        to = std::min(of.size(), from + numbers_a_round);
      *buffer++ = static_cast<double>(to - from);
      buffer = std::copy(of.begin() + static_cast<std::ptrdiff_t>(from), of.begin() + static_cast<std::ptrdiff_t>(to),
                         buffer);
    }
    return static_cast<int>(buffer - begin);
  }
  if (engine_ && neighbor->ago == 0) engine_->share(list, count);
  double** q = orientations(lmp);
  for (int k = 0; k < count; ++k) std::copy_n(q[list[k]], 4, buffer + 4 * k);
  return 4 * count;
}

void FixMotion::unpack_forward_comm(int count, int first, double* buffer) {
  if (round_ >= 0) {
    for (int k = 0; k < count; ++k) {
      const auto numbers = static_cast<std::ptrdiff_t>(*buffer++);
      memory_of(first + k).insert(memory_of(first + k).end(), buffer, buffer + numbers);
      buffer += numbers;
    }
    return;
  }
  double** q = orientations(lmp);
  for (int k = 0; k < count; ++k) std::copy_n(buffer + 4 * k, 4, q[first + k]);
}

// --- memories of force terms ---------------------------------------------------------------------------

// To the own elements to which they belong.
void FixMotion::give_memory(const std::vector<double>& numbers) {
  if (!remembers_) return;
  std::unordered_map<int, int> atom_of;
  for (int i = 0; i < atom->nlocal; ++i) {
    memory_of(i).clear();
    atom_of[element_of(*atom, i)] = i;
  }
  for_records(numbers, [&](int element, const double* of, std::size_t count) {
    if (element < 0) return;
    std::vector<double>& memory = memory_of(atom_of.at(element));
    memory.insert(memory.end(), of, of + count);
  });
  find_longest();
}

// LAMMPS has room for the largest element that may come by, of whichever rank.
void FixMotion::find_longest() {
  if (!remembers_) return;
  int own = 0;
  for (int i = 0; i < atom->nlocal; ++i) own = std::max(own, static_cast<int>(memory_of(i).size()));
  MPI_Allreduce(&own, &longest_, 1, MPI_INT, MPI_MAX, world);
  maxexchange = longest_ + 1;
}

// Before elements go to other ranks.
void FixMotion::keep_memory() {
  if (engine_) give_memory(engine_->memory());
}

// To copies, and to the engine's next list. An element may have more numbers than LAMMPS has room for in one message.
void FixMotion::bring_memory() {
  std::vector<double> all = std::exchange(accounts_, {});
  if (remembers_) {
    const int elements = atom->nlocal + atom->nghost;
    for (int i = atom->nlocal; i < elements; ++i) memory_of(i).clear();
    find_longest();
    for (round_ = 0; round_ * numbers_a_round < longest_; ++round_) send_to_ghosts(*comm, this, 0);
    round_ = -1;
    for (int i = 0; i < elements; ++i) all.insert(all.end(), memory_of(i).begin(), memory_of(i).end());
  }
  engine_->set_memory(std::move(all));
}

void FixMotion::copy_arrays(int from, int to, int) {
  if (from != to) memory_of(to) = memory_of(from);
}

int FixMotion::pack_exchange(int i, double* buffer) {
  const std::vector<double>& of = memory_of(i);
  *buffer = static_cast<double>(of.size());
  std::copy(of.begin(), of.end(), buffer + 1);
  return static_cast<int>(of.size()) + 1;
}

int FixMotion::unpack_exchange(int i, double* buffer) {
  memory_of(i).assign(buffer + 1, buffer + 1 + static_cast<std::ptrdiff_t>(*buffer));
  return static_cast<int>(*buffer) + 1;
}

int FixMotion::pack_restart(int i, double* buffer) {
  const int count = pack_exchange(i, buffer);
  *buffer = count;  // LAMMPS skips as many
  return count;
}

void FixMotion::unpack_restart(int i, int part) {
  const double* from = atom->extra[i];
  for (int k = 0; k < part; ++k) from += static_cast<std::ptrdiff_t>(*from);
  memory_of(i).assign(from + 1, from + static_cast<std::ptrdiff_t>(*from));
}

std::vector<double> FixMotion::take_events() {
  std::vector<double> numbers = std::exchange(untold_, {});
  if (!engine_) return numbers;
  const std::vector<double> now = numbers_of(engine_->take_events());
  numbers.insert(numbers.end(), now.begin(), now.end());
  return numbers;
}

// Elements may go elsewhere before the next run.
void FixMotion::post_run() { keep_memory(); }

// --- motion --------------------------------------------------------------------------------------------

void FixMotion::move(double dt) {
  if (engine_) {
    if (!engine_->leads()) engine_->take_own();
    engine_->move(dt);
    if (!engine_->leads()) engine_->give_own();
    return;
  }
  double** q = orientations(lmp);
  const auto n = static_cast<std::size_t>(atom->nlocal);
  if (moved_.size() != n) moved_ = State(n);
  for (std::size_t i = 0; i < n; ++i) {
    moved_.position.set(i, vector(atom->x[i]));
    moved_.velocity.set(i, vector(atom->v[i]));
    moved_.angular_velocity.set(i, vector(atom->omega[i]));
    moved_.orientation.set(i, quaternion(q[i]));
  }
  move_elements(moved_, dt, 0, static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = 0; i < n; ++i) {
    store(atom->x[i], moved_.position[i]);
    const Quaternion turned = moved_.orientation[i];
    q[i][0] = turned.w();
    q[i][1] = turned.x();
    q[i][2] = turned.y();
    q[i][3] = turned.z();
  }
}

double FixMotion::own_kinetic_energy() const {
  if (engine_ && engine_->leads()) return engine_->kinetic_energy();
  double sum = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const TubeType& type = type_of(*model_, *atom, i);
    sum += type.mass * vector(atom->v[i]).squaredNorm() + type.inertia * vector(atom->omega[i]).squaredNorm();
  }
  return 0.5 * sum;
}

std::vector<double> FixMotion::energies() const {
  std::vector<double> all = own_energies();
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, world);
  return all;
}

std::vector<double> FixMotion::own_energies() const {
  BondEnergy bonds;
  if (engine_)
    bonds = engine_->bond_energy();
  else if (const auto* style = dynamic_cast<const BondVBond*>(force->bond)) bonds = style->own_energy();
  const auto* pair = dynamic_cast<const PairMdem*>(force->pair);
  std::vector<double> own = {
      bonds.stretch,        bonds.shear,   bonds.bend,          bonds.twist,  pair ? pair->own_energy() : 0.0,
      own_kinetic_energy(), account_.work, account_.dissipated, account_.heat};
  if (engine_) {
    const std::vector<TermAccount> accounts = engine_->term_accounts();
    for (std::size_t k = 0; k < accounts.size(); ++k) {
      const TermAccount& a = accounts[k];
      own.insert(own.end(), {engine_->term_energy()[k], a.lost, a.drag, a.events, a.begun});
    }
  }
  return own;
}

// Outputs request one number after another, on all ranks.
double FixMotion::compute_vector(int n) {
  if (n == 0 || row_step_ != update->ntimestep) row_ = energies();
  row_step_ = update->ntimestep;
  return n == 0 ? now() : row_[static_cast<std::size_t>(n - 1)];
}

namespace {
struct Account {
  EnergySupply all;
  LMP::bigint carried;
  int divided;
  StepControl control;
};
}  // namespace

void FixMotion::write_restart(FILE* file) {
  const Account all = {account_of_all(), carried_, divided_, control_};
  // LAMMPS writes memories with the elements. Between runs elements may have gone elsewhere already.
  if (update->whichflag == 1) keep_memory();
  // Events stay here until the next state is written.
  std::vector<double> own = untold_ = take_events();
  if (engine_)
    for_records(engine_->memory(), [&](int element, const double* of, std::size_t count) {
      if (element == the_account) own.insert(own.end(), of, of + count);
    });
  const std::vector<double> numbers = on_first_rank(lmp, own);
  if (comm->me > 0) return;
  const int bytes = static_cast<int>(sizeof all + (1 + numbers.size()) * sizeof(double));
  const auto count = static_cast<double>(numbers.size());
  std::fwrite(&bytes, sizeof bytes, 1, file);
  std::fwrite(&all, sizeof all, 1, file);
  std::fwrite(&count, sizeof count, 1, file);
  std::fwrite(numbers.data(), sizeof(double), numbers.size(), file);
}

void FixMotion::restart(char* bytes) {
  Account account{};
  std::memcpy(&account, bytes, sizeof account);
  account_ = comm->me == 0 ? account.all : EnergySupply();
  carried_ = account.carried;
  divided_ = account.divided;
  control_ = account.control;
  double count = 0;
  std::memcpy(&count, bytes + sizeof account, sizeof count);
  std::vector<double> numbers(static_cast<std::size_t>(comm->me == 0 ? count : 0));
  if (!numbers.empty())
    std::memcpy(numbers.data(), bytes + sizeof account + sizeof count, numbers.size() * sizeof(double));
  for_records(numbers, [&](int element, const double* of, std::size_t length) {
    if (element == the_account) accounts_.insert(accounts_.end(), of, of + length);
    if (element == an_event) untold_.insert(untold_.end(), of, of + length);
  });
}

}  // namespace ropewalk::lammps
