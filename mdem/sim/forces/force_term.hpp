// A force term adds forces besides bonds and contact law, and may have a memory. One class describes it;
// the sums of forces and energies, the log, the account of energy, checkpoints, relaxations, splitting and the
// ranks of LAMMPS follow from the list of terms (Interaction::terms) by themselves.
//
// The engine of forces has copies of the terms of its interaction and calls for each of them
//
//   prepare     after each build of the neighbour list, before anything is computed with it
//   gather      before each evaluation of forces
//   advance     once in each step, at its new positions, before its forces
//   add         in each evaluation: forces on elements, tube part by tube part
//   add_pairs   in each evaluation: forces on pairs that are near each other, in the loop of the contact engine
//   add_in_kick instead of both, in each kick: forces that follow from all others and the loads
//
// Functions that are not const are called by one thread, in the order of the terms, except for list_chunk and
// add_pairs: one thread for each chunk. The bits of a run must not depend on the number of threads. They do not if
// a function uses nothing but its arguments, the memory, and the results of prepare and gather.
//
// The memory holds whatever the future depends on besides the state: broken tethers, the strain of contacts. Only
// prepare and advance change it. What is over, as a link that broke, is an event, and no part of it. It is handed out as records of numbers that belong to elements of the scene, so
// that a checkpoint can hold it and elements can take it along to another process.
//
// Friction of tubes side by side (terms/dry_friction.cpp) and links that form and break (terms/links.cpp) are such
// terms.
//
// Units nm, ps, eV.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/contact/pair_work.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/force_rows.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/processes.hpp"
#include "sim/state/state.hpp"
#include "sim/state/tiles.hpp"

namespace ropewalk {

struct Forces;

struct TermSum {
  double energy = 0;  // eV
  double power = 0;   // work per time of the term's dissipative forces, eV/ps
};

// Result of one update of the internal state: dissipated energy (eV), number of events (slips begun, tethers
// broken), number of bonds formed.
// `news`: other processes cannot see what has changed in the memory of elements of which they have copies, and must
// get it before the next step.
struct StateUpdate {
  double lost = 0;
  long events = 0, begun = 0;
  bool news = false;
};

// What a term has done since the start.
struct TermAccount {
  double lost = 0;    // energy lost by its memory, eV
  double drag = 0;    // energy lost by its dissipative forces, eV
  double events = 0;  // a whole number
  double begun = 0;   // likewise

  void add(const TermAccount& other) {
    lost += other.lost;
    drag += other.drag;
    events += other.events;
    begun += other.begun;
  }
};

// A new list, and the state that it was built for.
struct ListedScene {
  const Topology& topology;
  const NeighbourList& list;
  const State& state;
  bool again = false;                 // the list of a checkpoint: its events have happened
  const Processes* others = nullptr;  // that own the other elements of the scene; null: there are none
};

// Numbers that a term remembers, and the element of the scene that they belong to.
struct TermRecord {
  int element = 0;
  std::vector<double> numbers;
};
using TermState = std::vector<TermRecord>;
// That of a term of this name.
struct NamedMemory {
  std::string term;
  TermState records;
};

// Something that happened in the course of a run: when (ps), what, between which elements of the scene, where (nm).
struct TermEvent {
  double time = 0;
  std::string what;  // small letters and spaces
  int a = 0, b = 0;
  Vector3 place;
};

class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  virtual std::unique_ptr<ForceTerm> copy() const = 0;
  // Its energy counts in the column NAME_eV of the log, with that of other terms of the same name.
  virtual std::string name() const = 0;

  // Events happen here: links form, contacts begin and end. In a part of a scene (Topology::part) the term acts on
  // own elements and finds its own memory among all that it was given.
  virtual void prepare(const ListedScene&) {}
  // Collects here whatever depends on elements of other processes.
  virtual void gather(const State&) {}
  // Updates the internal state (history variables) to the current positions. `dt`: time since the last call (ps),
  // zero in a relaxation. The energy that is lost counts as dissipated.
  virtual StateUpdate advance(double /*dt*/, const State&) { return {}; }

  // Adds the forces on elements of a part, which are own ones. A force between two elements is computed for each of
  // them; one of them has its energy.
  virtual TermSum add(const State&, const Segment& /*part*/, const ForceRows&) const { return {}; }

  // Distance of element centres, nm: pairs that come nearer before the next list are in list_chunk; 0: there are none.
  // At most the cutoff of the list. Without a contact law there are no chunks.
  virtual double pair_reach() const { return 0; }
  // nm: how far from an own element a process needs copies for this term, besides pair_reach().
  virtual double copy_reach() const { return 0; }
  virtual void start_chunks(std::size_t /*count*/) {}
  virtual void list_chunk(std::size_t /*chunk*/, const ChunkPairs&) {}
  virtual TermSum add_pairs(const State&, std::size_t /*chunk*/, const PairBuffer&) { return {}; }

  // Whether it acts in the kick: on the sum of all other forces, the loads and constraints of which no other term
  // knows. It then adds, to rows of zeros, the forces on the elements of a part; `total` has all elements. What
  // they do in the kick counts as dissipated.
  virtual bool acts_in_kick() const { return false; }
  virtual void add_in_kick(const State&, const ForceRows& /*total*/, const Segment& /*part*/,
                           const ForceRows& /*out*/) const {}

  // Whether its forces follow from the places of the elements, its memory and nothing else: forecasts then ask it
  // for a state that no step has led to.
  virtual bool forces_follow_from_places() const { return false; }
  // What it does to tubes that a forecast of their limits leaves out, as "what links pull"; empty: nothing that counts.
  virtual std::string not_foreseen() const { return ""; }

  // Adds the derivatives of the term's forces by the places and turns of the elements: `add` takes the block of
  // minus the derivative of the force and torque on i by those of j, for each pair with one, both ways. Turns are
  // those of sim/dynamics/tangent.hpp. False: the term has no tangent, and statics refuses it by its name.
  using AddBlock = std::function<void(int i, int j, const Eigen::Matrix<double, 6, 6>& block)>;
  virtual bool add_tangent(const State&, const AddBlock& /*add*/) const { return false; }

  // eV/nm^2: the largest eigenvalue of the second derivatives of its energy by the positions of all elements; an
  // upper bound. The time step follows from it.
  virtual double stiffness() const { return 0; }
  // eV ps/nm^2: the same of minus the derivatives of its forces by all velocities, where turns count as the radius
  // of the tube times the angular velocity.
  virtual double damping() const { return 0; }

  // Whether there are any.
  virtual bool remembers() const { return false; }
  // The records of own elements, and back: those of all processes.
  virtual TermState memory() const { return {}; }
  // Throws std::runtime_error where the term cannot have had this memory.
  virtual void set_memory(const TermState&) {}
  // The memory of another scene, from whose end state this one begins at time zero: what has happened there is no
  // event here. Throws likewise.
  virtual void begin_with(const TermState& memory) { set_memory(memory); }
  // The memory where elements are half as long: what belongs to the element e goes to heirs[e], its first half or
  // the one in its place (sim/dynamics/refine.hpp).
  virtual TermState halved(const TermState& coarse, const std::vector<int>& heirs) const;

  // Bonds that hold nothing any more, as flags of the elements before them; null: all hold. One term of a scene can
  // have some. Only advance() and set_memory() change them.
  virtual const std::vector<char>* broken_bonds() const { return nullptr; }

  // Where the bonds of tubes of this type break that hold now: the strains of the weakest and of the strongest one,
  // and the bending moment (eV). Infinite: they do not.
  struct Strength {
    double weakest = std::numeric_limits<double>::infinity(), strongest = weakest, moment = weakest;
  };
  virtual Strength strength(int /*type*/) const { return {}; }

  // What acts from the start on, for the account.
  virtual long begun_at_start() const { return 0; }
  // What has happened since the start, or since forget_events(), for the run's file events.csv. set_memory() drops
  // them: who keeps a memory writes the events first. Each process has those of its own elements.
  virtual std::vector<TermEvent> events() const { return {}; }
  virtual void forget_events() {}

  // For the oracle (compute_reference): a plain form, over all pairs and in one thread, which adds to forces,
  // energies and power. Without one, false: add and add_pairs are called with a list of all pairs, whole tubes and
  // one buffer.
  virtual bool add_reference(const Topology&, const Interaction&, const State&, Forces&) const { return false; }

  // The size of its lists, which an evaluation reads.
  virtual std::size_t bytes() const { return 0; }
};

// A column of the log with a part of a term's account.
struct TermColumn {
  std::string name, unit, meaning;
  double TermAccount::*value;
};

// A kind of term that scenes can have: the log has its energy as the column NAME_eV, with this meaning, and these
// parts of its account.
struct TermKind {
  std::string name, energy;  // no words: it has none, and no column of it
  std::vector<TermColumn> account = {};
};
const std::vector<TermKind>& term_kinds();
// To be called before main() begins, for a static variable.
bool add_term_kind(TermKind kind);

// Adds a term, and sees that the neighbour list and the copies in other processes reach as far as it does.
void add_term(std::shared_ptr<const ForceTerm> term, Interaction& interaction);

// Energy (eV) and account of all terms of one name.
struct TermReading {
  double energy = 0;
  TermAccount account;
};
std::map<std::string, TermReading> term_readings(const Interaction& interaction,
                                                 const std::vector<double>& energies,
                                                 const std::vector<TermAccount>& accounts);

// Calls work(i, j) for all pairs i < j that are not excluded as near along one tube, in rising order.
void for_all_pairs(const Topology& topology, const Interaction& interaction,
                   const std::function<void(int, int)>& work);

}  // namespace ropewalk
