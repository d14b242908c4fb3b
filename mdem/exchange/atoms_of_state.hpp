// The atoms of a state, or of the place where a run passed a limit, as a file; and what LAMMPS makes of them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atoms/relax_atoms.hpp"
#include "run/run_directory.hpp"
#include "scene/single_state.hpp"

namespace ropewalk {

// A state with what its atoms follow from.
struct AtomicState {
  std::vector<ParameterSet> sets;
  Topology topology;
  State state;
  Interaction interaction;
  std::vector<char> held;    // whether each element is held or driven in the run
  std::vector<char> broken;  // whether the tube of each element has broken behind it; empty: no tube has
  std::string title;         // "RUN at 243 ps"
};

AtomicState state_in_scene(const Scene& scene, const Prepared& prepared, const State& state);
// The same flags, from the elements behind which tubes have broken.
std::vector<char> broken_flags(std::size_t elements, const std::vector<int>& broken);
// A frame of a run: number `frame` from 0, from the end if negative. Throws InputError where there is none.
AtomicState state_of_frame(const RunDirectory& dir, long frame);
// A state file.
AtomicState state_of_file(const SingleState& state, const std::string& path);

// The last stored frame at which a limit was not yet passed, and the element at which it was.
struct LimitPlace {
  std::string limit;
  std::int64_t step = 0;  // at which it was passed
  long frame = -1;       // -1: there is none
  double before_ps = 0;  // how long before the limit was passed the frame is
  int tube = -1, element = -1;
  std::string words;  // "wall_twist is passed from 243 ps on: tube 3, element 12"
};
LimitPlace place_of_limit(const RunDirectory& dir, const std::string& limit);

// Which elements are wanted.
struct AtomSelection {
  std::vector<int> tubes;                     // empty: all
  std::optional<double> from_nm, to_nm;       // along each tube at rest, from its first end
  int around_tube = -1, around_element = -1;  // those near this element; -1: anywhere
  double around_nm = 12;                      // the diameter of that place
};
// Stretches of tubes; none goes across a break. Throws InputError where nothing is left.
std::vector<TubePart> selected_parts(const AtomicState& s, const AtomSelection& selection);

// Energies of a part (eV): of the model, and of its atoms less those of the same atoms of a straight tube at rest
// that is relaxed alike. Held elements do not count, whose atoms keep the stress of the cut.
struct PartComparison {
  TubePart part;
  long atoms = 0;                 // number of atoms that are free to move
  double bonds = 0, contact = 0;  // model's energies, eV; half of each contact with other parts
  double placed = 0, relaxed = 0;
  // The flattest section of the relaxed atoms: thickness over width, 1 for a round one.
  double flatness = 1;
  int flattest = -1;  // its element; -1: all are held
};
// "The walls hold: ...", "The walls have collapsed: ...", by the flattest section of all parts.
std::string verdict_on_walls(const std::vector<PartComparison>& parts);

struct WrittenAtoms {
  long atoms = 0;
  std::vector<AtomRange> ranges;
  std::vector<std::string> files;
  std::string not_relaxable;  // why there is no input of LAMMPS; empty: there is one
};
// Writes PATH, STEM-elements.csv (which atoms are of which element) and, beside a data file, STEM-relax.in.
WrittenAtoms write_atoms_of(const AtomicState& s, const std::vector<TubePart>& parts, const std::string& path,
                            const std::string& potential);
// Minimises these atoms with their ends held, and writes STEM-relaxed.data.
std::vector<PartComparison> compare_with_atoms(const AtomicState& s, const std::vector<TubePart>& parts,
                                               const WrittenAtoms& written, const std::string& path,
                                               const std::string& potential, const LammpsOptions& options);

}  // namespace ropewalk
