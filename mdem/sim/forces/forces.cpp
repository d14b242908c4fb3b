#include "sim/forces/forces.hpp"

#include <omp.h>

#include <algorithm>

#include "model/contract.hpp"
#include "sim/forces/bonds.hpp"
#include "sim/threads/for_each.hpp"
#include "sim/threads/vector_unit.hpp"

#define ROPEWALK_LOOPS "sim/forces/axes_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {
namespace {

void clear(const Segment& of, const ForceRows& out) {
  for (Vec3Array* v : {&out.force, &out.torque})
    for (Column* c : {&v->x, &v->y, &v->z})
      std::fill(c->begin() + (of.begin - out.origin), c->begin() + (of.end - out.origin), 0.0);
}

}  // namespace

ContactEngine* ForceEngine::engine_of(const std::shared_ptr<const ContactLaw>& law) {
  if (law && law != law_) contact_ = make_contact_engine(*law), law_ = law;
  return law ? contact_.get() : nullptr;
}

std::size_t ForceEngine::bytes() const {
  return 3 * axis_.size() * sizeof(double) + (contact_ ? contact_->bytes() : 0) + terms_.bytes();
}

void ForceEngine::set_memory(const Interaction& interaction, const std::vector<double>& memory, int elements,
                             bool goes_on) {
  use_terms(interaction);
  terms_.set_memory(memory, elements, goes_on);
}

// A contact engine has listed the pairs of the terms that were there before.
void ForceEngine::use_terms(const Interaction& interaction) {
  if (!terms_.use(interaction)) return;
  contact_ = nullptr;
  law_ = nullptr;
}

void ForceEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                          const State& state, Forces& out, const ForceOptions& options) {
  ROPEWALK_EXPECTS(static_cast<int>(state.size()) == topology.elements() && out.force.size() == state.size());
  ROPEWALK_EXPECTS(options.parts == Parts::bonds || !interaction.law || list.builds() > 0);
  const double began = omp_get_wtime();
  const bool bonds = options.parts != Parts::contact, all_parts = options.parts == Parts::all;
  use_terms(interaction);
  ContactEngine* const contact = options.parts == Parts::bonds ? nullptr : engine_of(interaction.law);
  const double finished_before = contact ? contact->finish_seconds() : 0;
  parts_.cut(topology);
  joints_.resize(static_cast<std::size_t>(parts_.count()));
  sums_.assign(static_cast<std::size_t>(parts_.count()), {});
  if (contact) axis_.resize(state.size());
  const ForceRows on = rows_of(out);
  if (options.parts != Parts::bonds) {
    terms_.prepare(topology, list, state);
    terms_.begin(state, parts_.count());
  }
  out.lost = options.passed ? terms_.advance(*options.passed, state) : 0;
  const BondInput bonded{topology, interaction.damping.bond, state, terms_.broken_bonds()};

  // Before any element moves: the axes of a tube, and the bonds between its parts.
  const auto place = [&](int tube) {
    if (contact)
      ROPEWALK_IN_USE(axes_of)(state.orientation, topology.tube_begin[tube], topology.tube_begin[tube + 1], axis_);
    for (int k = parts_.begin(tube); bonds && k + 1 < parts_.begin(tube + 1); ++k)
      if (topology.owns(parts_[k].begin))
        joints_[static_cast<std::size_t>(k)] = joint_behind(bonded, tube, parts_[k].end - 1);
  };
  // Behind part k, if the tube goes on there and the bond is one of this process.
  const auto joint = [&](int k, bool goes_on) -> const Joint* {
    return goes_on && topology.owns(parts_[k].begin) ? &joints_[static_cast<std::size_t>(k)] : nullptr;
  };
  // The forces on a part of a tube: first its bonds, then the contact, then the terms.
  const auto finish = [&](int k) {
    const Segment& part = parts_[k];
    const Joint* before = bonds ? joint(k - 1, part.begin > topology.tube_begin[part.tube]) : nullptr;
    if (bonds && topology.owns(part.begin)) {
      const Joint* behind = joint(k, part.end < topology.tube_begin[part.tube + 1]);
      sums_[static_cast<std::size_t>(k)] = compute_bonds(bonded, part, before, behind, on);
    } else {
      clear(part, on);
      if (before) add_behind(*before, part.begin, on);
    }
    if (contact) contact->add_to(k, on);
    if (all_parts && !terms_.empty() && topology.owns(part.begin)) terms_.add(k, part, on);
  };
  const auto finish_block = [&](int block) {
    for (int k = parts_.block_begin(block); k < parts_.block_begin(block + 1); ++k) finish(k);
  };

  if (contact) {
    contact->compute(topology, interaction, list, state, axis_, options.energies,
                     {parts_, place, finish_block, terms_.pairs()});
  } else {
    in_team(state.size() > parallel_from, [&] {
#pragma omp for schedule(static)
      for (int t = 0; t < topology.tubes(); ++t) place(t);
#pragma omp for schedule(static)
      for (int block = 0; block < parts_.blocks(); ++block) finish_block(block);
    });
  }
  BondSum all;
  for (const BondSum& sum : sums_) add(sum, all);
  out.energy = {
      all.energy.stretch, all.energy.shear, all.energy.bend, all.energy.twist, contact ? contact->energy() : 0, 0};
  out.damping_power = all.power;
  if (options.parts != Parts::bonds) terms_.sum_up(out, options.passed.value_or(0));
  out.slipping_bond = all.slipping;
  const double spent = omp_get_wtime() - began,
               finished = contact ? contact->finish_seconds() - finished_before : spent;
  times_.contact += spent - finished;
  times_.bonds += finished;
}

double kinetic_energy(const Topology& topology, const State& state) {
  ROPEWALK_EXPECTS(static_cast<int>(state.size()) == topology.elements());
  double sum = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    double translation = 0, rotation = 0;
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) {
      if (!topology.owns(i)) continue;
      translation += state.velocity[static_cast<std::size_t>(i)].squaredNorm();
      rotation += state.angular_velocity[static_cast<std::size_t>(i)].squaredNorm();
    }
    sum += topology.type_of(t).mass * translation + topology.type_of(t).inertia * rotation;
  }
  return 0.5 * sum;
}

NetForce net_force(const State& state, const Forces& forces) {
  ROPEWALK_EXPECTS(forces.force.size() == state.size() && forces.torque.size() == state.size());
  NetForce net;
  for (std::size_t i = 0; i < state.size(); ++i) {
    net.force += forces.force[i];
    net.torque += forces.torque[i] + state.position[i].cross(forces.force[i]);
  }
  return net;
}

}  // namespace ropewalk
