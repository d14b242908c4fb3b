// How the contact of all elements is summed: once per evaluation, by all threads. The law's plain form
// (sim/contact/contact_law.hpp) is the oracle of every engine.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "sim/contact/contact_law.hpp"
#include "sim/contact/pair_work.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/force_rows.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/state/tiles.hpp"

namespace ropewalk {

// The work of an evaluation besides the contact: `place` prepares a tube, before any element moves, and `finish`
// ends a block of elements once nothing acts on it any more. Each is called once, by any thread. `pairs` acts on
// the pairs of each chunk; null: nothing does.
struct TubeWork {
  const TubeParts& parts;
  std::function<void(int)> place, finish;
  PairWork* pairs = nullptr;
};

using PairEnergy = std::function<double(TypePair, const Vector3&, const Vector3&, const Vector3&)>;

class ContactEngine {
 public:
  virtual ~ContactEngine() = default;
  virtual std::unique_ptr<ContactEngine> copy() const = 0;

  // The contact of all pairs of the list. `axis` is made by tubes.place; tubes.finish then calls add_to. Energies
  // are summed only if wanted; forces are the same bits either way, and on any number of threads.
  virtual void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                       const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) = 0;
  // Adds what acts on a part of a tube, in a fixed order.
  virtual void add_to(int part, const ForceRows& sums) const = 0;
  virtual double energy() const = 0;  // eV

  // The skin (nm) that would have cost least, given that a list of skin `listed` lasted `steps` steps.
  virtual double best_skin(const Topology&, double listed, long /*steps*/) const { return listed; }
  // U of one pair as law.energy() has it, by tables where these are at hand. The law must outlive it.
  virtual PairEnergy pair_energy(const ContactLaw& law) const;

  virtual std::size_t bytes() const = 0;
  // Bytes of its lists and buffers that every step goes through; pairs are in numbers of `number` bytes.
  virtual double step_bytes(const NeighbourList& list, std::size_t number) const = 0;
  double list_seconds() const { return list_seconds_; }      // spent on its own lists so far
  double finish_seconds() const { return finish_seconds_; }  // spent by the first thread in tubes.finish

 protected:
  double list_seconds_ = 0, finish_seconds_ = 0;
};

// The register: the engine that was written for this law, or the plain one for all others.
std::unique_ptr<ContactEngine> make_contact_engine(const ContactLaw& law);

// Bytes of the buffers that a chunk writes and that are read where forces are collected: force and torque.
inline double buffer_bytes(double elements, std::size_t number) {
  return 2 * 6 * static_cast<double>(number) * elements;
}

}  // namespace ropewalk
