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

}  // namespace ropewalk
