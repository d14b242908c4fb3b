// Trajectories of atoms as runs of elements.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atoms/atom_files.hpp"
#include "atoms/find_tubes.hpp"
#include "run/run_directory.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

struct CoarsenSettings {
  std::vector<std::string> files;       // of one simulation, or names of what is read elsewhere
  std::vector<std::string> parameters;  // sets; empty: shipped ones of the carbon tubes that are found
  double element_length = 0;            // nm; 0: that of the first set
  double time_step_fs = 1;              // length of MD steps in dumps that state no time
};

// What was found in the first frame, for a message and a table.
struct CoarseTube {
  Chirality chirality;
  int elements = 0;
  long atoms = 0, without_site = 0;  // atoms in elements, and those of its wall that are in none
  long pentagons = 0, heptagons = 0, open_atoms = 0, crowded = 0;
  bool cap_below = false, cap_above = false, endless = false;
  double radius = 0, misfit = 0;  // nm: mean, and root mean square of the distance of atoms from their places
};
// "(10,10), 12 elements, 480 atoms; 1 pentagon"
std::string words_of(const CoarseTube& tube);

// The elements of a trajectory, frame by frame.
class Coarsening {
 public:
  // Reads the first frame and finds its tubes. Throws InputError where there is none, a tube is too short, or more
  // than a fifth of its atoms has no place on its lattice.
  explicit Coarsening(const CoarsenSettings& settings);
  Coarsening(const CoarsenSettings& settings, std::unique_ptr<AtomSource> atoms);

  const std::vector<ParameterSet>& sets() const { return sets_; }
  const Topology& topology() const { return topology_; }  // types with their length and radius alone
  const std::vector<CoarseTube>& tubes() const { return tubes_; }
  long loose() const { return found_.loose; }  // atoms of its species in no tube
  long foreign() const { return foreign_; }    // atoms of other species
  bool states_time() const { return atoms_->states_time(); }
  bool cut_off() const { return atoms_->cut_off(); }

  // The present frame. Velocities are zero where the file has none.
  const State& state() const { return state_; }
  bool has_velocities() const { return !frame_.velocities.empty(); }
  const std::vector<SectionShape>& shapes() const { return shapes_; }
  // Each element's cross-section: its atoms over its sites.
  std::vector<double> filled() const;
  // Goes to the next frame; false at the end. Throws InputError where it is no later than the present one, or where
  // its atoms are no tubes any more.
  bool next();

 private:
  void find();
  void choose_sets();
  void fit_first();
  void fit();
  double mean_radius(std::size_t tube) const;
  double misfit(std::size_t tube) const;

  CoarsenSettings settings_;
  Honeycomb honeycomb_;
  std::unique_ptr<AtomSource> atoms_;
  AtomFrame frame_;
  FoundTubes found_;
  long foreign_ = 0;
  std::vector<ParameterSet> sets_;
  Topology topology_;
  std::vector<ElementFit> fits_;
  std::vector<CoarseTube> tubes_;
  std::vector<Vector3> positions_;  // atoms of elements in the present frame: the images that hang together
  State state_;
  std::vector<SectionShape> shapes_;
};

struct CoarseRun {
  long frames = 0;
  double time = 0;     // time of the last frame, ps
  std::string passed;  // limits, in words; empty: none
};
// Makes the directory of a run with log, frames, limits, found-tubes.csv, sections.csv and its last state. No
// checkpoint: a scene goes on from final.csv.
CoarseRun write_coarse_run(Coarsening& coarse, const CoarsenSettings& settings, const RunDirectory& to, bool force,
                           RunListener& listener);
std::vector<OutputColumn> section_columns();
std::vector<OutputColumn> found_tube_columns();

}  // namespace ropewalk
