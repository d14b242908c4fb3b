// Elastic constants of a tube from the energy of relaxed atomistic cells.
//
//   stretch and twist   E/L0 = EA/2 e^2 + C e s + GJ/2 s^2 + third and fourth order in (e, s)
//   bend                (E_long - E_short)/(L_long - L_short) = EI/2 k^2 + k4 k^4
//
// These windows are narrow, for the constants of Hooke's law. The terms beyond it (mdem/model/anharmonic.hpp) come
// from the same kinds of cells over a window that reaches to the limits of the tube, with these constants held.
//
// with the strain e and the twist s = t - natural twist, both per length L0 of the relaxed tube (t is the angle
// between the ends of a cell over its relaxed length, whatever the strain), and the curvature k of the axis.
//
// Stretch and twist: exactly periodic, uniformly twisted supercells (lattice.hpp), atoms minimised at fixed cell.
// Bend: the tube's atoms are bent affinely to curvature k, bands at both ends are frozen, the rest is minimised,
// and two lengths are differenced, which takes the ends out. Energies are fitted with fit_least_squares. Units eV,
// nm, rad.
//
// The square of a standard error is the sum of two squares: the error of the fit, and half of the spread between
// fits over smaller windows and of lower order. For potentials with an angular spline (AIREBO, REBO) the spread
// dominates, since the spline has a knot at 120 degrees, the angle of the unstrained sheet.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atoms/lammps.hpp"
#include "atoms/potential.hpp"
#include "io/outputs.hpp"
#include "model/anharmonic.hpp"
#include "model/tube.hpp"

namespace ropewalk::calibrate {

struct Measured {
  double value = 0;
  double standard_error = 0;
};

// The calibration refuses chiralities beyond these limits before LAMMPS starts.
inline constexpr double smallest_diameter = 0.3;  // nm: below it atoms across the tube are within reach of bonds
inline constexpr int max_atoms = 20000;           // atoms of a cell; larger cells take over a minute each

// One relaxed configuration, a row of the table NAME-stiffness.csv.
struct AtomisticRow {
  std::string kind;      // "stretch-twist", "bend-short", "bend-long", or an envelope run
  double length = 0;     // nm: of the cell at zero strain of the relaxed tube, or of the bent free part
  double strain = 0;     // against the relaxed tube
  double twist = 0;      // rad/nm, against the rolled sheet
  double curvature = 0;  // 1/nm
  int atoms = 0;
  double energy = 0;    // energy of the whole cell above the relaxed straight tube, eV
  double residual = 0;  // residual of the fit, eV
  double radius = 0;    // nm, mean distance from the axis (straight cells)
  int line = 0;         // line in the file that it was read from
};

// Limits beyond which the model no longer describes the tube.
struct Envelope {
  Measured kink_curvature;    // 1/nm
  Measured twist_collapse;    // radius times twist, of 12 nm between held ends
  Measured endless_collapse;  // the same of an endless tube; 0: not measured
  Measured compression;       // strain
  Measured linear_curvature;  // 1/nm: bending moment 1 % off EI k
  Measured linear_shear;      // radius times twist: torque 1 % off GJ s
  Measured linear_strain;     // tension or compression: force 1 % off EA e
  bool measured = false;      // false: from scaling rules
};

// An envelope that was measured before, with the rows of its runs (envelope-*, collapse-twist).
struct KnownEnvelope {
  Envelope limits;
  std::vector<AtomisticRow> rows;
};

struct StiffnessOptions {
  double cell_length = 0;                       // nm, least length of the periodic cells; 0: chosen
  double largest_strain = 0.01;                 // fit windows, both signs
  double largest_shear = 0.01;                  // radius times twist
  double largest_bend_strain = 0;               // radius times curvature; 0: chosen
  double short_length = 6, long_length = 10;    // nm, bend
  bool anharmonic = true;                       // also the wide windows of the terms beyond Hooke's law
  bool envelope = false;                        // incremental runs to the kink, the collapse and 1 % nonlinearity
  std::optional<KnownEnvelope> known_envelope;  // taken instead of these runs
  LammpsOptions lammps;
  std::function<void(const std::string&)> progress;  // one line per stage
};

// Terms beyond Hooke's law, in the order of anharmonic_terms(), with the window of their fit.
struct AnharmonicFit {
  std::vector<Measured> terms;  // eV/nm; empty: not measured
  double min_strain = 0, max_strain = 0, max_shear = 0, max_bend = 0;
  double stretch_twist_error = 0, bend_error = 0;  // largest relative error of the energies in the window
  double collapse_shear = 0, collapse_error = 0;   // largest shear beyond the collapse, and error there; 0: unknown

  Anharmonic law(double radius, double coupling) const;
};

// The force of a tube that is pulled, at equal steps of strain from the edge of the window to the end.
struct PullFit {
  double start = 0, end = 0;                     // strains: max_strain of the window, and the last one; 0: not measured
  double edge_force = 0;                         // force of the bond at `start`, eV/nm
  std::array<Measured, PULL_STEPS + 1> force{};  // force of the atoms without twist, eV/nm
  std::string ended_by;                          // "the force falls"
  double error = 0;                              // largest relative error of the law against energies of the pull

  Pull law() const;
};

struct Stiffness {
  Measured EA;             // eV/nm
  Measured EI;             // eV nm
  Measured GJ;             // eV nm
  Measured coupling;       // C, eV
  Measured natural_twist;  // twist of the relaxed tube against the rolled sheet, rad/nm
  // Correlations of the errors of EA, GJ, coupling and natural twist by their fit; empty: not known.
  std::vector<std::vector<double>> correlation;
  Measured poisson;            // -d ln r / d strain
  Measured radius;             // nm, relaxed
  Measured atoms_per_length;   // 1/nm, relaxed
  double energy_per_atom = 0;  // eV, relaxed; 0 where it is not known (a table fitted again)
  // Turn (rad) and rise (nm) of the second sublattice in the relaxed tube; the lift (nm) is its radius minus that of the
  // first one.
  double sublattice_turn = 0, sublattice_rise = 0, sublattice_lift = 0;
  double energy_offset = 0;    // energy at the minimum of the fit, eV/nm; near 0 in a finished table
  // Leading anharmonic terms of the energy per length: they set the 1 % limits.
  Measured stretch_cubic;  // coefficient of e^3, eV/nm
  Measured twist_cubic;    // coefficient of s^3, eV nm^2; zero but for chiral tubes
  Measured twist_quartic;  // coefficient of s^4, eV nm^3
  Measured bend_quartic;   // coefficient of k^4, eV nm^3
  AnharmonicFit anharmonic;
  PullFit pull;
  double surface_density() const;  // atoms per nm^2 of the relaxed shell
  Envelope envelope;
  std::vector<AtomisticRow> rows;
  std::vector<std::string> warnings;  // window too wide for the potential, spread, facets, ...
  std::string fit_report;             // windows, residuals, evaluations, verdicts: a few lines for a person
  LammpsVersion lammps;
  double lammps_seconds = 0, fit_seconds = 0;
};

// The atomistic part of a calibration. Files stay in `folder`. Throws InputError, LammpsError.
Stiffness measure_stiffness(Chirality c, const Potential& potential, const std::string& folder,
                            const StiffnessOptions& options);

// Scaling rules for the envelope, from incremental LAMMPS runs on (10,10) and their checks on other tubes.
Envelope scaled_envelope(double radius);

// The head of a table, one "# key: value" line each.
struct AtomisticOrigin {
  Chirality chirality;
  std::string potential, potential_hash, lammps;
  std::vector<std::string> notes;
  std::string species{};  // "B and N"; empty: carbon
};
std::vector<OutputColumn> atomistic_columns();
std::string atomistic_csv(const std::vector<AtomisticRow>& rows, const AtomisticOrigin& origin);
// Throws InputError with file and line.
std::vector<AtomisticRow> read_atomistic_csv(const std::string& path, AtomisticOrigin* origin = nullptr);

// The two fits alone, so that a table can be fitted again. They fill the residuals of their rows and throw
// InputError if there are too few rows.
void fit_stretch_twist(std::vector<AtomisticRow>& rows, Stiffness& out);
void fit_bend(std::vector<AtomisticRow>& rows, Stiffness& out);

// The terms beyond Hooke's law, from the rows of the wide windows; EA, GJ, EI, the coupling and the natural twist
// in `out` are held. It fills the residuals of its rows.
void fit_anharmonic(std::vector<AtomisticRow>& rows, Chirality c, Stiffness& out);

// The forces of stretch beyond the window of `law`, from rows "pull", whose residuals it fills. EA (eV/nm), GJ (eV
// nm), natural_twist (rad/nm): of the harmonic bond. Empty where the rows do not reach beyond the window.
PullFit fit_pull(std::vector<AtomisticRow>& rows, const Anharmonic& law, double EA, double GJ,
                 double natural_twist);

// The shear at which the torque stops rising, from rows "collapse-twist", as that of an endless tube into the
// envelope.
void fit_collapse(std::vector<AtomisticRow>& rows, Stiffness& out);

// Replaces the 1 % limits of the envelope by limits from the anharmonic terms, if these are known.
void limits_from_terms(const Stiffness& stiffness, Envelope& envelope);

}  // namespace ropewalk::calibrate
