// Forces, torques and energies of a state: the fast path (Verlet list, OpenMP, vector kernels) and the plain
// reference (every pair, one after another), which stays as the oracle. Both call the forms of mdem/model.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/contact/contact_engine.hpp"
#include "sim/forces/force_terms.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/force_rows.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"
#include "sim/state/tiles.hpp"

namespace ropewalk {

struct Forces {
  Vec3Array force;   // eV/nm
  Vec3Array torque;  // eV, about the element centres, space frame
  Energies energy;
  std::vector<double> term_energy;  // energy of each of Interaction::terms, eV
  double lost = 0;                  // energy lost by terms whose memory has moved on, eV
  double damping_power = 0;         // work per time of the damping forces, never positive, eV/ps
  int slipping_bond = -1;           // first element of a bond twisted by 90 degrees or more, -1: none

  explicit Forces(std::size_t n = 0) : force(n), torque(n) {}
  void resize(std::size_t n) { force.resize(n), torque.resize(n); }
};
inline ForceRows rows_of(Forces& forces) { return {forces.force, forces.torque, 0}; }

// Body frames.
struct FrameArray {
  Vec3Array e1, e2, t;

  void resize(std::size_t n) {
    e1.resize(n);
    e2.resize(n);
    t.resize(n);
  }
  Frame operator[](std::size_t i) const { return {e1[i], e2[i], t[i]}; }
};

// At i stands the bond from element i to i + 1.
struct BondArray {
  Vec3Array force_j, torque_i, torque_j;

  void resize(std::size_t n) {
    force_j.resize(n);
    torque_i.resize(n);
    torque_j.resize(n);
  }
};

// The frames and bonds of a part of a tube, its first element at 0: they stay in the first cache from where they
// are made to where they are used.
struct TubeBonds {
  FrameArray frames;
  BondArray bonds;

  void resize(std::size_t elements) {
    frames.resize(elements);
    bonds.resize(elements);
  }
};

// Energy and power of some bonds.
struct BondSum {
  BondEnergy energy;
  double power = 0;   // power of their damping
  int slipping = -1;  // first element of a bond twisted by 90 degrees or more
};

// The bond from the last element of a part of a tube to the next part, where there is one.
struct Joint {
  Vector3 force_j, torque_i, torque_j;
  BondSum sum;
};

// All forces; bonds and their damping; or contact and the terms that act on its pairs.
enum class Parts { all, bonds, contact };

struct ForceOptions {
  Parts parts = Parts::all;
  bool energies = true;  // without them that of the line law's contact may be left out; forces are the same bits
  // ps that have passed since the last evaluation: the terms' memories move on. None: they stay as they are.
  std::optional<double> passed = {};
};

// The list must be up to date, but for the bonds alone.
class ForceEngine {
 public:
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, Forces& out, const ForceOptions& options = {});

  // Wall time spent so far in each part, s. The axes belong to the contact. Bonds may be computed within the
  // contact: the first thread tells the times of both apart.
  struct Times {
    double contact = 0, bonds = 0;
  };
  const Times& times() const { return times_; }
  // Null before the first contact.
  const ContactEngine* contact() const { return contact_.get(); }
  // The terms of the last interaction, with their memories.
  const ForceTerms& terms() const { return terms_; }
  void forget_events() { terms_.forget_events(); }
  // Goes on with the memories of another engine, for the same list.
  void take_terms_of(const ForceEngine& other) { terms_ = other.terms_; }
  // Goes on with these memories, ForceTerms::set_memory(). Throws std::runtime_error.
  void set_memory(const Interaction& interaction, const std::vector<double>& memory, int elements,
                  bool goes_on = false);
  // Makes the terms ready for a list that a state with this memory has had before.
  void prepare_again(const Topology& topology, const NeighbourList& list, const State& state) {
    terms_.prepare(topology, list, state, true);
  }
  void share_with(const Processes* others) { terms_.share_with(others); }
  std::size_t bytes() const;

 private:
  ContactEngine* engine_of(const std::shared_ptr<const ContactLaw>& law);
  void use_terms(const Interaction& interaction);

  TubeParts parts_;
  std::vector<Joint> joints_;  // behind each part
  std::vector<BondSum> sums_;  // sums of each part
  Vec3Array axis_;             // axes of all elements
  std::shared_ptr<const ContactLaw> law_;
  Cloned<ContactEngine> contact_;  // engine of this law
  ForceTerms terms_;
  Times times_;
};

// The oracle: O(N^2), no list, no threads, no vectors.
void compute_reference(const Topology& topology, const Interaction& interaction, const State& state, Forces& out);

// Adds a damping force and its power.
void add_pair(const DampingForce& damping, std::size_t i, std::size_t j, Forces& out);

// Kinetic energy of own elements, eV.
double kinetic_energy(const Topology& topology, const State& state);

// Force and torque sums about the origin: both zero where nothing external acts.
struct NetForce {
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
};
NetForce net_force(const State& state, const Forces& forces);

}  // namespace ropewalk
