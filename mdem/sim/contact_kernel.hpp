// The hot loops over pairs of elements: one chunk of the neighbour list at a time, into a buffer of its own.
#pragma once

#include <vector>

#include "sim/interaction.hpp"
#include "sim/neighbours.hpp"
#include "sim/state.hpp"
#include "sim/vector_clones.hpp"

namespace ropewalk {

// Force (eV/nm) and torque (eV) on the elements touched_begin .. touched_end of a chunk.
struct ContactBuffer {
  std::vector<double> fx, fy, fz, tx, ty, tz;
  double energy = 0, power = 0;

  static constexpr std::size_t room = 8;  // behind the elements, for vectors that are not full

  void clear(std::size_t elements) {
    for (auto* v : {&fx, &fy, &fz, &tx, &ty, &tz}) v->assign(elements + room, 0.0);
    energy = power = 0;
  }
};

struct ContactInput {
  const Topology* topology;
  const Interaction* interaction;
  const State* state;
  const Vec3Array* axis;
  const NeighbourList* list;
  const std::vector<int>* tube;  // of each element
};

void paper_contact(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer& out);

// What an element has collected over its neighbours.
struct ElementSum {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0, energy = 0;

  void add_to(ContactBuffer& out, int at) const {
    out.fx[at] += fx;
    out.fy[at] += fy;
    out.fz[at] += fz;
    out.tx[at] += tx;
    out.ty[at] += ty;
    out.tz[at] += tz;
    out.energy += energy;
  }
};

// Viscous contact damping of one pair, separation = x_j - x_i.
inline void damp_pair(const ContactInput& in, int i, int j, const Vector3& separation, int touched_begin,
                      ElementSum& sum, ContactBuffer& out) {
  const ContactViscosity& viscosity = in.interaction->damping.contact;
  const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
  const DampingForce d = viscosity.force(separation, in.state->velocity[si], in.state->angular_velocity[si],
                                         in.state->velocity[sj], in.state->angular_velocity[sj]);
  const int at = j - touched_begin;
  out.fx[at] += d.force_j.x();
  out.fy[at] += d.force_j.y();
  out.fz[at] += d.force_j.z();
  out.tx[at] += d.torque_j.x();
  out.ty[at] += d.torque_j.y();
  out.tz[at] += d.torque_j.z();
  sum.fx -= d.force_j.x();
  sum.fy -= d.force_j.y();
  sum.fz -= d.force_j.z();
  sum.tx += d.torque_i.x();
  sum.ty += d.torque_i.y();
  sum.tz += d.torque_i.z();
  out.power += d.power;
}

}  // namespace ropewalk
