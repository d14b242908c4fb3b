// The hot loops over pairs of elements: one chunk of the neighbour list at a time, into a buffer of its own.
#pragma once

#include <cstring>
#include <vector>

#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/threads/scratch.hpp"
#include "sim/threads/vector_clones.hpp"

namespace ropewalk {

// As v.assign(n, 0), at the speed of the memory: for the library's loop any compiler settles for two at a time.
template <class T>
void set_zero(std::vector<T>& v, std::size_t n) {
  set_size(v, n);
  std::memset(v.data(), 0, n * sizeof(T));
}

// Force (eV/nm) and torque (eV) on the elements that a chunk acts on. In floats where they have been added up in
// floats: few of these sums come together on an element.
template <class T>
struct ContactBuffer {
  std::vector<T> fx, fy, fz, tx, ty, tz;
  double energy = 0, power = 0;

  static constexpr std::size_t room = 64 / sizeof(T);  // behind the elements, for vectors that are not full

  void clear(std::size_t elements) {
    for (auto* v : {&fx, &fy, &fz, &tx, &ty, &tz}) set_zero(*v, elements + room);
    energy = power = 0;
  }
  std::size_t bytes() const { return 6 * fx.capacity() * sizeof(T); }
};

// What an element has collected over its neighbours.
struct ElementSum {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0, energy = 0;

  template <class T>
  void add_to(ContactBuffer<T>& out, int at) const {
    out.fx[at] += static_cast<T>(fx);
    out.fy[at] += static_cast<T>(fy);
    out.fz[at] += static_cast<T>(fz);
    out.tx[at] += static_cast<T>(tx);
    out.ty[at] += static_cast<T>(ty);
    out.tz[at] += static_cast<T>(tz);
    out.energy += energy;
  }
};

}  // namespace ropewalk
