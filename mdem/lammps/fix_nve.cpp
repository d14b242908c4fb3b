#include "lammps/fix_nve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_map>

#include "lammps/bond_vbond.hpp"
#include "lammps/fix_damp.hpp"
#include "lammps/fix_grip.hpp"
#include "neighbor.h"
#include "output.h"
#include "sim/dynamics/blow_up.hpp"
#include "sim/dynamics/spins.hpp"
#include "sim/dynamics/verlet.hpp"
#include "utils.h"

namespace ropewalk::lammps {
namespace {

using namespace LMP::FixConst;

std::string digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

const char* words_of(int failure) {
  switch (static_cast<FixNve::Failure>(failure)) {
    case FixNve::Failure::slip:
      return "a bond was twisted by 90 degrees";
    case FixNve::Failure::blow_up:
      return "the motion blew up";
    default:
      return "the energy balance did not close";
  }
}

// The account of energy in the numbers of a row.
struct Reading {
  EnergyMark mark;
  double kinetic = 0, bonds = 0, contact = 0;
};
Reading reading_of(const std::vector<double>& row) {
  Reading r;
  r.bonds = row[0] + row[1] + row[2] + row[3];
  r.contact = row[4];
  r.kinetic = row[5];
  r.mark = {r.bonds + r.contact + r.kinetic, {row[6], row[7], row[8]}};
  for (std::size_t k = lammps_row_numbers - 1; k < row.size(); k += lammps_numbers_of_term) r.mark.energy += row[k];
  return r;
}

}  // namespace

FixNve::FixNve(LMP::LAMMPS* lmp, int count, char** words) : FixMotion(lmp, count, words) {
  if (model_->loads.spin_relaxation_interval() > 0) comm_forward = std::max(comm_forward, 6);
}

int FixNve::setmask() { return FixMotion::setmask() | INITIAL_INTEGRATE | FINAL_INTEGRATE; }

void FixNve::init() {
  FixMotion::init();
  mark_ = {};
  failure_ = 0;
  divide(engine_ && engine_->leads() ? divided_ : 1);
  if (model_->loads.spin_relaxation_interval() > 0 && !engine_)
    refuse(lmp, "twist.geometric_only acts through the engine, and forces are computed pair by pair",
           "leave -var forces plain out");
}

// Damping acts on half-step velocities, so that the forces at the end of a step do not follow from the state alone.
// If the forces of the last step are known, from memory or from the data or restart file, they are used. A run in
// parts then equals an uninterrupted run.
void FixNve::setup(int) {
  if (carried_ == update->ntimestep) {
    double** last = carried(lmp);
    for (int i = 0; i < atom->nlocal; ++i) {
      store(atom->f[i], vector(last[i]));
      store(atom->torque[i], vector(last[i] + 3));
    }
    if (engine_) engine_->use_lammps_forces();
  }
  mark();
}

// --- the parts of a step --------------------------------------------------------------------------------

// The kick of translation or rotation. Returns the energy that the local damping has dissipated.
double FixNve::push(double alpha, double TubeType::*inertia, double dt, double** velocity,
                    double** force_on) const {
  double removed = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double per_force = dt / type_of(*model_, *atom, i).*inertia;
    for (int axis = 0; axis < 3; ++axis) {
      const double force = force_on[i][axis], before = velocity[i][axis];
      const double brake = alpha > 0 ? pfc_local(alpha, force, before) : 0.0;
      velocity[i][axis] = before + per_force * (force + brake);
      removed -= 0.5 * dt * brake * (before + velocity[i][axis]);
    }
  }
  return removed;
}

void FixNve::kick(double dt) {
  if (engine_ && engine_->leads()) {
    account_.dissipated += engine_->kick(dt);
  } else {
    const double alpha = damp_ ? damp_->local() : 0.0;
    account_.dissipated += push(alpha, &TubeType::mass, dt, atom->v, atom->f);
    account_.dissipated += push(alpha, &TubeType::inertia, dt, atom->omega, atom->torque);
  }
  if (grip_) account_.work += grip_->constrain(time_, 0.5 * part_step(), dt);
}

void FixNve::add_work_of_loads(double dt) {
  if (grip_) account_.work += dt * grip_->own_power();
}

void FixNve::drift(double dt) {
  move(dt);
  time_ += dt;
  check();
}

void FixNve::bathe(double dt) {
  if (!engine_->leads()) engine_->take_own();
  engine_->bathe(*model_->thermostat, dt, update->ntimestep, part_, time_);
  if (!engine_->leads()) engine_->give_own();
  if (grip_) grip_->constrain(time_, 0.0, 0.0);
}

double FixNve::damped(double dt) const {
  if (engine_) return engine_->lost() - dt * engine_->damping_power();
  return damp_ ? -dt * damp_->own_power() : 0.0;
}

void FixNve::check() {
  const MotionBound bound(model_->topology.largest_radius(), part_step());
  if (engine_ && bound.holds(engine_->fastest())) return;
  if (will_go_back(Failure::blow_up)) return;
  if (engine_ && engine_->leads()) engine_->give_own();
  for (int i = 0; i < atom->nlocal; ++i)
    if (!(vector(atom->v[i]).squaredNorm() < bound.speed2) || !(vector(atom->omega[i]).squaredNorm() < bound.spin2))
      refuse_one(lmp,
                 "step " + std::to_string(update->ntimestep) + ", element " + std::to_string(element_of(*atom, i)) +
                     ": the motion blew up (an element moves a quarter of its radius or turns half a radian in one "
                     "step)",
                 "use a smaller time step or a gentler start and load");
}

// --- a step ---------------------------------------------------------------------------------------------

void FixNve::initial_integrate(int) { began_well_ = begin(); }

// Up to the positions at which the last forces of the step are needed.
bool FixNve::begin() {
  time_ = model_->time_at(update->ntimestep - 1);
  for (part_ = 0;; ++part_) {
    begin_step(*this, part_step(), model_->thermostat != nullptr);
    if (in_last_part()) return true;
    if (!compute_within()) return false;
    end_step(*this, part_step());
  }
}

bool FixNve::looks_sound() {
  look_at_list(failure_);
  return failure_ == 0;
}

void FixNve::post_integrate() {
  if (!engine_) return;
  const LMP::bigint step = update->ntimestep;
  bool sound = began_well_ && looks_sound();
  while (!sound) {
    go_back();
    sound = make_steps_up_to(step - 1, step);
    update->ntimestep = step;
    sound = sound && begin() && looks_sound();
  }
  hand_out();
}

void FixNve::end() {
  if (in_last_part()) time_ = now();
  end_step(*this, part_step());
  relax_spins();
}

void FixNve::final_integrate() {
  end();
  if (engine_) judge();
  stop_in_time();
  if (output->next != update->ntimestep) return;
  if (engine_ && engine_->leads()) engine_->give_own();
  if (output->restart_flag && output->next_restart == update->ntimestep) carry();
}

// Forces inside of a step of LAMMPS, by its order of calls.
bool FixNve::compute_within() {
  if (!looks_sound()) return false;
  if (next_reneighbor == update->ntimestep || (in_last_part() && exchanged_now())) {
    keep_memory();
    engine_->give_own();
    pre_exchange();
    exchange_elements();
    next_reneighbor = -1;
  } else {
    engine_->give_shared();
    comm->forward_comm();
    ++neighbor->ago;
  }
  compute_now();
  return true;
}

void FixNve::compute_now() {
  const auto numbers = static_cast<std::size_t>(3 * (atom->nlocal + atom->nghost));
  if (numbers > 0) {
    std::fill_n(atom->f[0], numbers, 0.0);
    std::fill_n(atom->torque[0], numbers, 0.0);
  }
  pre_force(0);
  if (neighbor->ago == 0) engine_->build();
  engine_->compute(false);
  if (const auto* bonds = dynamic_cast<const BondVBond*>(force->bond)) bonds->check_slip(*engine_);
  comm->reverse_comm();
  if (grip_) grip_->post_force(0);
}

// --- back to the last mark -------------------------------------------------------------------------------

bool FixNve::will_go_back(Failure failure) {
  if (!engine_ || !engine_->leads() || mark_.step < 0 || divided_ >= StepControl::most) return false;
  failure_ = std::max(failure_, static_cast<int>(failure));
  return true;
}

void FixNve::mark() {
  mark_ = {};
  if (!engine_) return;
  mark_.step = update->ntimestep;
  mark_.energy.energy = std::numeric_limits<double>::quiet_NaN();
  if (model_->judges_account) mark_.energy = reading_of(energies()).mark;
  if (!engine_->leads()) return;
  engine_->give_own();
  double** q = orientations(lmp);
  mark_.elements.reserve(22 * static_cast<std::size_t>(atom->nlocal));
  for (int i = 0; i < atom->nlocal; ++i) {
    std::vector<double>& to = mark_.elements;
    to.insert(to.end(), {0, static_cast<double>(element_of(*atom, i)), 19});
    for (const auto& [from, count] : {std::pair{atom->x[i], 3},
                                      {q[i], 4},
                                      {atom->v[i], 3},
                                      {atom->omega[i], 3},
                                      {atom->f[i], 3},
                                      {atom->torque[i], 3}})
      to.insert(to.end(), from, from + count);
  }
  mark_.memory = engine_->memory();
  mark_.events = untold_ = take_events();
  mark_.account = account_;
  mark_.skin = engine_->skin();
  if (const auto* states = find_fix<FixStates>(lmp)) mark_.states = states->place();
}

// Also looks for failures of any rank in the last forces.
bool FixNve::is_sound(bool of_account) {
  MPI_Allreduce(MPI_IN_PLACE, &failure_, 1, MPI_INT, MPI_MAX, world);
  if (failure_ != 0) return false;
  if (!of_account || !model_->judges_account || divided_ >= StepControl::most) return true;
  const Reading now = reading_of(energies());
  const bool mixed = model_->interaction.precision == Interaction::Precision::mixed;
  if (account_closes(mark_.energy, now.mark, now.kinetic, now.bonds, mixed ? now.contact : 0,
                     static_cast<std::size_t>(model_->topology.elements())))
    return true;
  failure_ = static_cast<int>(Failure::account);
  return false;
}

void FixNve::judge() {
  const LMP::bigint step = update->ntimestep;
  const bool marks = step % StepControl::window == 0;
  if (!marks && step != update->laststep) return;
  while (!is_sound(marks)) {
    if (!engine_->leads())
      refuse(lmp,
             "step " + std::to_string(step) + ": the energy balance has not closed since step " +
                 std::to_string(mark_.step) +
                 ", and beside fixes of others no rank can go back and divide its steps of " +
                 digits(update->dt / units::fs) + " fs",
             "leave fixes that act on elements out, or set run.time_step_fs to half of that and export again");
    do go_back();
    while (!make_steps_up_to(step, step));
  }
  if (!marks) return;
  divide(control_.lengthen(divided_, step));
  mark();
}

void FixNve::go_back() {
  const double failed = now();
  const char* const why = words_of(failure_);
  restore();
  failure_ = 0;
  divide(control_.shorten(divided_, mark_.step));
  if (comm->me > 0) return;
  LMP::utils::logmesg(lmp, digits(failed) + " ps: " + why + "; back to " + digits(now()) +
                               " ps, on with steps of " + digits(part_step() / units::fs) + " fs\n");
}

// Each rank has the elements that were its own at the mark. Their owners of now get them, and LAMMPS exchanges
// those that are beyond the borders of these.
void FixNve::restore() {
  const Slices slices(lmp, model_->topology.elements());
  std::vector<int> own;
  std::unordered_map<int, int> atom_of;
  for (int i = 0; i < atom->nlocal; ++i) {
    own.push_back(element_of(*atom, i));
    atom_of[own.back()] = i;
  }
  double **q = orientations(lmp), **last = carried(lmp);
  for_records(slices.bring_to_owners(mark_.elements, own), [&](int element, const double* from, std::size_t) {
    const int i = atom_of.at(element);
    from += 3;
    for (const auto& [to, count] :
         {std::pair{atom->x[i], 3}, {q[i], 4}, {atom->v[i], 3}, {atom->omega[i], 3}, {last[i], 6}})
      from = (std::copy_n(from, count, to), from + count);
  });
  std::vector<double> memory;
  for_records(mark_.memory, [&](int element, const double* from, std::size_t count) {
    std::vector<double>& to = element == the_account ? accounts_ : memory;
    to.insert(to.end(), from, from + count);
  });
  give_memory(slices.bring_to_owners(memory, own));
  account_ = mark_.account;
  untold_ = mark_.events;
  update->ntimestep = mark_.step;
  time_ = now();
  part_ = divided_ - 1;
  engine_->use_skin(mark_.skin);
  reach_for(mark_.skin);
  exchange_elements();
  pre_force(0);
  engine_->build(true);
  last = carried(lmp);
  for (int i = 0; i < atom->nlocal; ++i) {
    store(atom->f[i], vector(last[i]));
    store(atom->torque[i], vector(last[i] + 3));
  }
  engine_->use_lammps_forces();
  if (grip_) grip_->find_loads();
  next_reneighbor = -1;
  if (auto* states = find_fix<FixStates>(lmp)) states->go_back_to(mark_.states);
  // LAMMPS's fix print looks for its next step at the begin of a run alone.
  ++update->ntimestep;
  for (int k = 0; k < modify->nfix; ++k)
    if (std::string(modify->fix[k]->style) == "print") modify->fix[k]->init();
  --update->ntimestep;
  forget_row();
}

// LAMMPS itself writes at the end of the present step.
bool FixNve::make_steps_up_to(LMP::bigint last, LMP::bigint present) {
  for (LMP::bigint step = mark_.step + 1; step <= last; ++step) {
    update->ntimestep = step;
    if (!begin() || !compute_within()) return false;
    end();
    if (step < present) modify->end_of_step();
  }
  return true;
}

// --- spins of twist.geometric_only -----------------------------------------------------------------------

// As the simulator's: parts of a tube follow one another, from its middle outwards, a message for each.
void FixNve::relax_spins() {
  if (!in_last_part() || !relaxes_spins_at(now(), update->dt, model_->loads.spin_relaxation_interval())) return;
  const double had = reading_of(own_energies()).mark.energy;
  const int all = atom->nlocal + atom->nghost;
  if (!engine_->leads()) engine_->take_own();
  engine_->begin_spins();
  sends_spins_ = true;
  for (std::vector<int> copies;;) {
    const std::vector<int> own = engine_->follow_spins(copies);
    int any = own.empty() ? 0 : 1;
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
    if (any == 0) break;
    final_.assign(static_cast<std::size_t>(all), 0);
    for (const int i : own) final_[static_cast<std::size_t>(i)] = 1;
    send_orientations();
    copies.clear();
    for (int i = atom->nlocal; i < all; ++i)
      if (final_[static_cast<std::size_t>(i)]) copies.push_back(i);
  }
  sends_spins_ = false;
  engine_->end_spins();
  if (engine_->leads())
    engine_->give_shared();
  else
    engine_->give_own();
  comm->forward_comm();
  neighbor->ago = std::max(neighbor->ago, 1);
  time_stands_ = true;
  compute_now();
  time_stands_ = false;
  account_.dissipated += had - reading_of(own_energies()).mark.energy;
  forget_row();
}

int FixNve::pack_forward_comm(int count, int* list, double* buffer, int pbc, int* shift) {
  if (!sends_spins_) return FixMotion::pack_forward_comm(count, list, buffer, pbc, shift);
  double** q = orientations(lmp);
  double* to = buffer + 1;
  for (int k = 0; k < count; ++k) {
    if (!final_[static_cast<std::size_t>(list[k])]) continue;
    *to++ = k;
    to = std::copy_n(q[list[k]], 4, to);
  }
  *buffer = static_cast<double>((to - buffer - 1) / 5);
  return static_cast<int>(to - buffer);
}

void FixNve::unpack_forward_comm(int count, int first, double* buffer) {
  if (!sends_spins_) return FixMotion::unpack_forward_comm(count, first, buffer);
  if (count == 0) return;  // there was no message
  double** q = orientations(lmp);
  const auto here = static_cast<int>(*buffer++);
  for (int k = 0; k < here; ++k, buffer += 5) {
    const int i = first + static_cast<int>(*buffer);
    std::copy_n(buffer + 1, 4, q[i]);
    final_[static_cast<std::size_t>(i)] = 1;
  }
}

// --- between runs ----------------------------------------------------------------------------------------

void FixNve::post_run() {
  FixMotion::post_run();
  if (engine_ && engine_->leads()) engine_->give_own();
  carry();
}

void FixNve::carry() {
  double** last = carried(lmp);
  for (int i = 0; i < atom->nlocal; ++i) {
    store(last[i], vector(atom->f[i]));
    store(last[i] + 3, vector(atom->torque[i]));
  }
  carried_ = update->ntimestep;
}

}  // namespace ropewalk::lammps
