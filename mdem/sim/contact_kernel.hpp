// The hot loops over pairs of elements: one chunk of the neighbour list at a time, into a buffer of its own.
#pragma once

#include <cstring>
#include <vector>

#include "sim/interaction.hpp"
#include "sim/neighbours.hpp"
#include "sim/state.hpp"
#include "sim/vector_clones.hpp"

namespace ropewalk {

// As v.assign(n, 0), at the speed of the memory: for the library's loop any compiler settles for two at a time.
template <class T>
void set_zero(std::vector<T>& v, std::size_t n) {
  v.resize(n);
  std::memset(v.data(), 0, n * sizeof(T));
}

// Force (eV/nm) and torque (eV) on the elements touched_begin .. touched_end of a chunk.
struct ContactBuffer {
  std::vector<double> fx, fy, fz, tx, ty, tz;
  double energy = 0, power = 0;

  static constexpr std::size_t room = 8;  // behind the elements, for vectors that are not full

  void resize(std::size_t elements) {
    for (auto* v : {&fx, &fy, &fz, &tx, &ty, &tz}) v->resize(elements + room);
  }
  void clear(std::size_t elements) {
    for (auto* v : {&fx, &fy, &fz, &tx, &ty, &tz}) set_zero(*v, elements + room);
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
