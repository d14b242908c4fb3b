#include "atomistic/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "atomistic/finite_tube.hpp"
#include "atomistic/options.hpp"
#include "atomistic/runs.hpp"
#include "io/clocks.hpp"
#include "io/grade.hpp"

namespace ropewalk::calibrate {
namespace {

// The bend window: half of the curvature at which the moment is 1 % off, large enough for the quartic term to be
// fitted.
double default_bend_strain(double radius) { return std::min(0.02, 0.007 / radius); }

InputError bad_option(const char* key, const std::string& what, const std::string& remedy) {
  return InputError({"", 0, key}, what, remedy);
}

}  // namespace

void check_tube(Chirality c, double a) {
  if (!c.valid())
    throw bad_option("chirality", fmt::format("({},{}) is not a tube", c.n, c.m),
                     "give n and m, neither negative, for example 10,10");
  const double diameter = 2 * tube_radius(c, a);
  if (diameter < smallest_diameter)
    throw bad_option("chirality",
                     fmt::format("({},{}) is {:.3f} nm wide; below {} nm atoms across the tube are within reach of "
                                 "each other's bonds and no potential here holds",
                                 c.n, c.m, diameter, smallest_diameter),
                     "choose a wider tube, from (4,0) or (3,2) on");
}

void check_options(const StiffnessOptions& o) {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(o.cell_length, 0, 200)) throw bad_option("cell length", "must be 0 to 200 nm", "0 chooses it");
  if (!within(o.largest_strain, 1e-4, 0.05))
    throw bad_option("largest strain", "must be 0.0001 to 0.05", "the default is 0.01");
  if (!within(o.largest_shear, 1e-3, 0.05))
    throw bad_option("largest shear", "must be 0.001 to 0.05", "the default is 0.01");
  if (o.largest_bend_strain != 0 && !within(o.largest_bend_strain, 1e-4, 0.05))
    throw bad_option("largest bend strain", "must be 0.0001 to 0.05", "0 chooses it");
  if (!within(o.short_length, 2, 100) || !within(o.long_length, 2, 100) || o.long_length < o.short_length + 1)
    throw bad_option("bend lengths", "must be 2 to 100 nm, the long one at least 1 nm longer",
                     "the defaults are 6 and 10 nm");
}

namespace {

// Checks of the options before the first LAMMPS run, since an error after minutes would cost time.
void check_size(Chirality c, const Potential& potential, const StiffnessOptions& options) {
  const double a = potential.honeycomb.lattice_constant;
  double atoms = (options.long_length + 2 * held_band(potential)) * atoms_per_length(c, a);
  // A rough bound first: the lattice vectors of a huge tube are many.
  if (atoms <= max_atoms)
    for (const LatticeVector& period : stretch_twist_periods(c, potential, options, elastic_grid(options)))
      atoms = std::max(atoms, 2.0 * static_cast<double>(cell_hexagons(c, period)));
  if (atoms > max_atoms)
    throw bad_option("chirality",
                     fmt::format("({},{}) is {:.2f} nm wide and needs cells of {:.0f} atoms; the limit is {}", c.n,
                                 c.m, 2 * tube_radius(c, a), atoms, max_atoms),
                     "choose a narrower tube, or shorter bend lengths and a wider shear window");
}

void warn_of_width(Chirality c, double a, std::vector<std::string>& warnings) {
  const double diameter = 2 * tube_radius(c, a);
  if (diameter > faceting_diameter)
    warnings.push_back(
        fmt::format("({},{}) is {:.2f} nm wide: tubes wider than {:.0f} nm facet in ropes (contact "
                    "energies up to 17 % off at 2.7 nm), which a rigid circular tube cannot show",
                    c.n, c.m, diameter, faceting_diameter));
  if (diameter < slender_diameter)
    warnings.push_back(
        fmt::format("({},{}) is {:.2f} nm wide: below {} nm the bonds are so strained that the potentials "
                    "differ widely",
                    c.n, c.m, diameter, slender_diameter));
}

template <class Work>
void timed(double& seconds, const Work& work) {
  const double start = steady_seconds();
  work();
  seconds += seconds_since(start);
}

BendSeries elastic_bends(const StiffnessOptions& options, double curvature) {
  return {"bend",
          options.short_length,
          options.long_length,
          true,
          {0.4 * curvature, 0.6 * curvature, 0.8 * curvature, curvature}};
}

// Held ends keep a wide tube round, so that wide tubes need long specimens.
BendSeries wide_bends(double radius, double kink) {
  return {"wide-bend",
          std::max(6.0, 12 * radius),
          std::max(10.0, 20 * radius),
          false,
          {0.3 * kink, 0.5 * kink, 0.65 * kink, 0.75 * kink, 0.85 * kink}};
}

// Makes the tube that is free of force and torque according to the fit the new reference.
void move_reference(RelaxedTube& tube, const Stiffness& fitted, double energy_per_length) {
  const double hexagon = 2 / fitted.atoms_per_length.value;
  tube.energy_per_hexagon += energy_per_length * tube.shape.length_per_hexagon;
  tube.shape.twist = fitted.natural_twist.value * tube.shape.length_per_hexagon / hexagon;
  tube.shape.length_per_hexagon = hexagon;
  tube.shape.radius = fitted.radius.value;
}

}  // namespace

double Stiffness::surface_density() const { return atoms_per_length.value / (2 * units::pi * radius.value); }

Stiffness measure_stiffness(Chirality c, const Potential& potential, const std::string& folder,
                            const StiffnessOptions& options) {
  check_tube(c, potential.honeycomb.lattice_constant);
  check_options(options);
  check_size(c, potential, options);
  Stiffness out;
  warn_of_width(c, potential.honeycomb.lattice_constant, out.warnings);
  const auto tell = [&](const std::string& line) {
    if (options.progress) options.progress(line);
  };

  out.lammps = lammps_version(options.lammps);
  if (!out.lammps.pair_styles.empty() && !out.lammps.has_pair_style(potential.pair_style))
    throw InputError({"", 0, "potential"},
                     fmt::format("LAMMPS {} has no pair style '{}'", out.lammps.text, potential.pair_style),
                     "install one that has (package MANYBODY for tersoff, airebo, rebo, lcbop), or choose another");

  RunContext run{c, potential, folder, options, 0, {}};
  tell(fmt::format("relaxing ({},{}) with {}", c.n, c.m, potential.name));
  RelaxedTube tube = relax_tube(run);
  tell("stretching and twisting periodic cells");
  const CellGrid grid = elastic_grid(options);
  const std::vector<CellResult> cells = stretch_twist_cells(run, tube, grid);
  timed(out.fit_seconds, [&] {
    // Repeated, since each fit gives the reference tube of the next.
    for (int round = 0; round < 3; ++round) {
      const std::vector<std::string> warnings = out.warnings;
      out.rows = stretch_twist_rows(cells, tube, grid);
      out.fit_report.clear();
      fit_stretch_twist(out.rows, out);
      if (round == 2) break;
      out.warnings = warnings;
      move_reference(tube, out, out.energy_offset);
    }
  });
  for (std::size_t i = 0; i < cells.size(); ++i)
    check_convergence(run, "a periodic cell", cells[i].force,
                      0.1 * out.EA.value * options.largest_strain * options.largest_strain * out.rows[i].length);

  tell("bending finite tubes");
  const double bend_strain =
      options.largest_bend_strain > 0 ? options.largest_bend_strain : default_bend_strain(tube.shape.radius);
  const auto add_rows = [&](const std::vector<AtomisticRow>& rows) {
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
  };
  add_rows(bend_rows(run, tube, elastic_bends(options, bend_strain / tube.shape.radius)));
  timed(out.fit_seconds, [&] { fit_bend(out.rows, out); });

  out.energy_per_atom = 0.5 * tube.energy_per_hexagon;
  TubeShape at_rest = tube.shape;
  move_inner_shift(run, options.largest_shear, at_rest);
  out.sublattice_turn = at_rest.arc_shift;
  out.sublattice_rise = at_rest.height_shift;
  out.sublattice_lift = tube.shape.lift;
  out.envelope = scaled_envelope(tube.shape.radius);
  limits_from_terms(out, out.envelope);
  const double kink = out.envelope.kink_curvature.value;
  if (bend_strain / tube.shape.radius > 0.6 * kink)
    out.warnings.push_back(fmt::format("the bend window reaches {:.3g} /nm, and the tube kinks near {:.3g} /nm",
                                       bend_strain / tube.shape.radius, kink));
  if (options.envelope) {
    tell("looking for kink, collapse and buckling (minutes)");
    out.envelope = measured_envelope(run, tube, out, out.rows);
  }
  if (options.known_envelope) {
    out.envelope = options.known_envelope->limits;
    add_rows(options.known_envelope->rows);
  }
  if (options.anharmonic) {
    tell("stretching, twisting and bending up to the limits");
    const CellGrid wide = wide_grid(c, out.envelope);
    add_rows(stretch_twist_rows(stretch_twist_cells(run, tube, wide), tube, wide));
    add_rows(bend_rows(run, tube, wide_bends(tube.shape.radius, kink)));
    timed(out.fit_seconds, [&] { fit_anharmonic(out.rows, c, out); });
    if (!out.anharmonic.terms.empty()) {
      tell("pulling until the tube gives way");
      const PulledCell pulled = pull_cell(run, tube);
      add_rows(pulled.rows);
      out.pull = fit_pull(out.rows, out.anharmonic.law(tube.shape.radius, out.coupling.value), out.EA.value,
                          out.GJ.value, out.natural_twist.value);
      out.pull.ended_by = pulled.ended_by;
      if (!(out.pull.end > 0))
        out.warnings.push_back("pulled, the tube gives way at the window of its bond: its strength is not known");
      else
        out.fit_report += fmt::format(
            "pull: up to a strain of {:.3g}, where {}; {:.4g} nN, law within {:.1e} of an "
            "energy\n",
            out.pull.end, pulled.ended_by, out.pull.force.back().value * units::eV_in_nN_nm, out.pull.error);
    }
    if (options.envelope && !out.anharmonic.terms.empty()) {
      tell("twisting beyond the collapse (minutes)");
      std::vector<double> shears;
      for (const double part : {0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 1.7, 1.9, 2.1})
        shears.push_back(part * scaled_envelope(tube.shape.radius).twist_collapse.value);
      add_rows(collapse_rows(run, tube, shears));
      timed(out.fit_seconds, [&] { fit_collapse(out.rows, out); });
    }
    if (options.known_envelope && !out.anharmonic.terms.empty())
      timed(out.fit_seconds, [&] { fit_collapse(out.rows, out); });
  }
  out.warnings.insert(out.warnings.end(), run.warnings.begin(), run.warnings.end());
  out.lammps_seconds = run.lammps_seconds;
  return out;
}

}  // namespace ropewalk::calibrate
