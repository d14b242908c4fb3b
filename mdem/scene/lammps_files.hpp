// Files that `ropewalk export --lammps` adds to a run directory and `ropewalk import` reads back. Numbers in text
// have the digits that give the same bits again.
//
//   lammps.json   where the run stands: step, time, account of energy, and what the model took from its start
//   tubes.csv     tubes of a kind after one another: how many, elements of each, type
//   rope.state    the state and its forces (scene/lammps_states.hpp)
//   in.rope       LAMMPS input
//   job.sh        a job for SLURM that runs it
//   lammps.states, lammps-rows.csv   what LAMMPS writes: states and energies
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "scene/scene.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct LammpsStart {
  std::uint64_t id = 0;                             // of this export: a hash of its scene, sets, tubes and state
  std::int64_t step = 0;
  double time = 0;                                  // ps
  double time_step = 0;                             // ps
  double work = 0, dissipated = 0, heat = 0;        // eV
  std::uint64_t lineage = 0;                        // Scene::lineage
  std::vector<int> strand_begin;                    // the first tube of each strand; empty: each tube is one
  double strand_holes = 0;                          // TubeGroups::strand_holes
  int images = 0;                                   // TubeGroups::images
  double period = 0;                                // nm, TubeGroups::period
  double viscosity_inner = 0, viscosity_outer = 0;  // nm
  bool tubes_came_broken = false;                   // tubes are broken in the first state, and no others break
  std::vector<std::string> parameters;              // a file for each tube type
  std::map<std::string, std::string> sums;          // sum of each LAMMPS file, by name
};

struct LammpsDirectory {
  std::string path;

  std::string file(const char* name) const { return path + "/" + name; }
  std::string scene() const { return file("scene.toml"); }
  std::string start() const { return file("lammps.json"); }
  std::string tubes() const { return file("tubes.csv"); }
  std::string first_state() const { return file("rope.state"); }
  std::string input() const { return file("in.rope"); }
  std::string readme() const { return file("README.txt"); }
  std::string job() const { return file("job.sh"); }
  std::string states() const { return file("lammps.states"); }
  std::string rows() const { return file("lammps-rows.csv"); }
};

// Keys and columns of the files lammps.json, tubes.csv and lammps-rows.csv.
std::vector<OutputColumn> lammps_start_keys();
std::vector<OutputColumn> lammps_tube_columns();
std::vector<OutputColumn> lammps_row_columns();

// Throws InputError for a scene that the LAMMPS styles cannot carry.
void refuse_what_lammps_lacks(const Scene& scene);

std::string start_json(const LammpsStart& start);
LammpsStart read_start(const LammpsDirectory& dir);

std::string tubes_csv(const Topology& topology);
// Adds the tubes to a topology that has its types. Throws InputError.
void read_tubes(const LammpsDirectory& dir, Topology& topology);
// Sets the strands of these tubes. Throws InputError where they do not fit the tubes.
void set_strands(const LammpsDirectory& dir, const LammpsStart& start, Topology& topology);
// Sets the images of a slice. Throws likewise.
void set_slice(const LammpsDirectory& dir, const LammpsStart& start, Topology& topology);

// At such steps since the export elements are exchanged and lists are built in any case. A job stops there if its time
// is over before the next such step, so that the one that goes on has the same bits.
inline constexpr int lammps_steps_between_stops = 512;

// The facts that the input script needs.
struct LammpsScript {
  std::string name;
  std::string law = "paper";
  bool damped = false, driven = false, relax = false;
  bool long_in_z = true;  // a rope or a chain: cut across it
  int types = 1;          // number of tube types
  Vector3 low, high;      // the box; it grows with the elements, and never shrinks below this
  double skin = 0, reach = 0;
  int excluded_elements = 3;  // neighbours along any tube that contact skips, at least
  double time_step = 0;
  std::int64_t first_step = 0, steps = 0, every = 1;
  int terms = 0;  // force terms, each with its energy and its account in a row
};
std::string lammps_input(const LammpsScript& script);
// A job for SLURM that runs it, and submits itself again where its time was too short.
std::string lammps_job(const LammpsScript& script, int elements);

// The numbers of one row of LAMMPS's energies, in the order of the file.
struct LammpsRow {
  double step = 0, time = 0;
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0, kinetic = 0;
  double work = 0, dissipated = 0, heat = 0;
  std::vector<double> terms;          // energy of each force term, eV
  std::vector<TermAccount> accounts;  // likewise
};
inline constexpr int lammps_row_numbers = 10;     // without the step and the terms
inline constexpr int lammps_numbers_of_term = 5;  // energy, lost, drag, events, begun
// A last line without its end, as after a kill, is left out.
std::vector<LammpsRow> read_lammps_rows(const LammpsDirectory& dir, std::size_t terms = 0);

}  // namespace ropewalk
