// Forces and torques of one chunk of the neighbour list. Every chunk has a buffer of its own, so that threads do
// not write to the same memory.
#pragma once

#include <cstring>
#include <vector>

#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/threads/scratch.hpp"

namespace ropewalk {

// As v.assign(n, 0), but at the speed of the memory: compilers turn assign() into a loop of two numbers at a time.
template <class T>
void set_zero(std::vector<T>& v, std::size_t n) {
  set_size(v, n);
  std::memset(v.data(), 0, n * sizeof(T));
}

// Force (eV/nm) and torque (eV) on the elements that a chunk writes to. T is float where the law sums in single
// precision; the total over the few buffers that share an element is in double.
template <class T>
struct ContactBuffer {
  std::vector<T> fx, fy, fz, tx, ty, tz;
  double energy = 0;

  static constexpr std::size_t room =
      64 / sizeof(T);  // entries behind the elements, so that whole vectors can be stored

  void clear(std::size_t elements) {
    for (auto* v : {&fx, &fy, &fz, &tx, &ty, &tz}) set_zero(*v, elements + room);
    energy = 0;
  }
  std::size_t bytes() const { return 6 * fx.capacity() * sizeof(T); }
};

// Force, torque and energy of one element, summed over its neighbours.
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
