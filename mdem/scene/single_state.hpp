// One state by itself, without a scene: what `ropewalk energy` evaluates.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/error.hpp"
#include "scene/build.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk {

struct SingleState {
  std::shared_ptr<const Source> source;
  std::vector<std::string> parameters;  // one set, or one for each type of tube: files, or names of shipped ones
  std::vector<int> tube_types;          // type of each tube, an index of `parameters`; empty: all tubes have type 0
  double element_length = 0;            // nm; 0: what the file states, else that of the first set
  std::string law;                      // empty: the line law where the set has it
  std::string bond;                     // "harmonic" or "anharmonic"; empty: anharmonic where all sets have it
  bool legacy_torque = false;
  double exclude_along_tube = 0;  // nm; 0: as a scene has it
  double free_length = 0;         // nm, between what holds the tubes: they collapse by it; 0: the whole length
  int nodes = 0;                  // on an element, of the line law; 0: as a run in time has them
  bool reference = false;         // energies by the plain path over all pairs
};

struct EvaluatedState {
  std::vector<ParameterSet> sets;
  BuiltScene built;
  Interaction interaction;
  Forces forces;
  std::vector<int> broken;  // elements behind which tubes have broken
  std::string note;  // what the energy depends on and a state does not say; may be empty
};
// Throws InputError, which names the options of `ropewalk energy`.
EvaluatedState evaluate(const SingleState& state);

// Forces and energies, by the plain path over all pairs or by the fast one. Throws InputError at `place` for a
// state that refuse_state.hpp refuses.
Forces forces_of(const Topology& topology, const Interaction& interaction, const State& state, bool reference,
                 const InputError::Place& place);

}  // namespace ropewalk
