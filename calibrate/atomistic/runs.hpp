// The LAMMPS runs behind measure_stiffness: each is one child process that relaxes many configurations.
#pragma once

#include <string>
#include <vector>

#include "atomistic/stiffness.hpp"
#include "atoms/atom_writer.hpp"
#include "atoms/lattice.hpp"

namespace ropewalk::calibrate {

// The reference tube for strains, twists and energies.
struct RelaxedTube {
  TubeShape shape;                // at its natural twist
  double energy_per_hexagon = 0;  // eV
  double contraction = 0;         // -d ln r / d strain, a first guess for starting points
};

struct RunContext {
  Chirality c;
  const Potential& potential;
  const std::string& folder;
  const StiffnessOptions& options;
  double lammps_seconds = 0;
  std::vector<std::string> warnings;
};

// A relaxed periodic cell, free of any reference.
struct CellResult {
  long hexagons = 0;
  double angle = 0;   // rad, twist of the cell against the rolled sheet
  double length = 0;  // nm
  double energy = 0;  // eV
  double force = 0;   // eV/nm, norm over all atoms, left after minimisation
  double radius = 0;  // nm
};

// Radius, length and inner shift of the untwisted tube at zero axial force.
RelaxedTube relax_tube(RunContext& run);

// A shape at its natural twist, with the inner shift of the untwisted cell, gets the shift that it has at that twist:
// by a cell of `shear` (radius times twist), linear between the two.
void move_inner_shift(RunContext& run, double shear, TubeShape& shape);

// Cells at all pairs of these strains and shears.
struct CellGrid {
  std::string name;                    // name of the LAMMPS run and of its rows
  std::vector<double> strains;         // ascending
  double largest_shear = 0;            // radius times twist
  std::vector<double> parts_of_shear;  // the nearest twists that the lattice has
};
// The window of the harmonic constants: both signs of strain and of twist.
CellGrid elastic_grid(const StiffnessOptions& options);
// Up to the limits of the tube; both signs of twist for chiral tubes alone.
CellGrid wide_grid(Chirality c, const Envelope& limits);

// Periods of the cells of a grid.
std::vector<LatticeVector> stretch_twist_periods(Chirality c, const Potential& potential,
                                                 const StiffnessOptions& options, const CellGrid& grid);
std::vector<CellResult> stretch_twist_cells(RunContext& run, const RelaxedTube& start, const CellGrid& grid);

// The same cells relative to a reference tube.
std::vector<AtomisticRow> stretch_twist_rows(const std::vector<CellResult>& cells, const RelaxedTube& tube,
                                             const CellGrid& grid);

// A cell that is pulled in steps of strain, as far as its force rises and no bond is longer than Potential::inner.
struct PulledCell {
  std::vector<AtomisticRow> rows;  // "pull"
  std::string ended_by;            // "the force falls"
};
inline constexpr double pull_step = 0.005;
PulledCell pull_cell(RunContext& run, const RelaxedTube& tube);

// Longer cells (nm) of one twist each, minimised with a little noise, so that the wall may collapse; rows
// "collapse-twist". `shears`: radius times twist.
std::vector<AtomisticRow> collapse_rows(RunContext& run, const RelaxedTube& tube,
                                        const std::vector<double>& shears);

// Finite tubes of two or three lengths (nm) bent to these curvatures (1/nm); rows NAME-short, NAME-middle,
// NAME-long.
struct BendSeries {
  std::string name;
  double short_length = 0, long_length = 0;
  bool middle = false;  // also a tube of the mean of both lengths; bent in all planes that its symmetry asks for
  std::vector<double> curvatures;
};
std::vector<AtomisticRow> bend_rows(RunContext& run, const RelaxedTube& tube, const BendSeries& series);

// Incremental runs, which take minutes. Appends their rows.
Envelope measured_envelope(RunContext& run, const RelaxedTube& tube, const Stiffness& stiffness,
                           std::vector<AtomisticRow>& rows);
// The specimen of such runs: its straight tube with held ends.
struct EnvelopeSpecimen {
  std::string commands;    // read the data, define the groups `held` and `free`, fix `ref` and variable `half`
  double free_length = 0;  // nm
  double radius = 0;       // outer wall, nm
  double twist = 0;        // rad/nm, natural
  std::size_t atoms = 0;
};
inline constexpr double envelope_length = 12;  // nm
Envelope measured_envelope(RunContext& run, const EnvelopeSpecimen& specimen, const Stiffness& stiffness,
                           std::vector<AtomisticRow>& rows);

// Shared pieces of the inputs.
// The start of an input that minimises one uniform cell; v_wide scales v_new_x and v_new_y.
std::string uniform_cell_commands(const Potential& potential, const std::string& data);
// The period of a cell with no twist, or with very little where the period of the tube is long. `a`: lattice constant, nm.
LatticeVector untwisted_cell(Chirality c, double min_length, double a = graphene_lattice_constant);
// The pair style of a potential and the words of its one pair_coeff line, from which several groups of atoms each get
// a style of their own. Throws InputError, which says `why` in its line, where the potential is not one pair_style and one
// pair_coeff line of one species.
struct PairStyle {
  std::string name, with_arguments, file, species;
};
PairStyle pair_style_of(const Potential& potential, const std::string& why);
std::string header_commands(const std::string& boundary, double skin);
// The atoms of each tube (nm), as tube_atoms() orders them, in a box about the axis. Each tube is a type of its own, or
// two where its sublattices are of two species.
std::string data_file(const std::vector<std::vector<Vector3>>& tubes, double half_width, double z_low, double z_high,
                      const Honeycomb& honeycomb = {});
// The same of one tube in any order. `second`: whether an atom is of the second sublattice.
std::string data_file_of_tube(const std::vector<Vector3>& atoms, const std::vector<char>& second, double half_width,
                              double z_low, double z_high, const Honeycomb& honeycomb);
// The start of an input that minimises one periodic cell, which may buckle or collapse.
std::string cell_commands(const Potential& potential, const std::string& data);
void write_data(const RunContext& run, const std::string& name, const std::string& content);
// Numbers that a run printed to folder/name.dat, `columns` per line. Throws LammpsError for fewer than `least`
// lines or more than `most`.
std::vector<std::vector<double>> read_results(const std::string& folder, const std::string& name, std::size_t least,
                                              std::size_t most, std::size_t columns);
// Atoms (nm) that a run dumped to the file `name`, in the order of their ids.
std::vector<Vector3> read_atoms(const RunContext& run, const std::string& name, std::size_t count);
// Adds a warning if the residual forces of the minimiser (eV/nm) may stand for more than 1e-3 of the energy (eV).
void check_convergence(RunContext& run, const std::string& what, double force, double energy);
void run_stage(RunContext& run, const std::string& name, const std::string& input);

}  // namespace ropewalk::calibrate
