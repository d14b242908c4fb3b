#include "verbs/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "atomistic/runs.hpp"
#include "contact/integral.hpp"
#include "atoms/lattice.hpp"
#include "io/clocks.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/laws/line.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/contact/line_parameters.hpp"
#include "verbs/tables.hpp"
#include "version.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double right_angle = 0.5 * units::pi;

// Walls are relaxed beside one another with the law up to here (nm): what lies beyond moves them by some 1e-4 of their
// distance, and would cost ten times the pairs.
constexpr double relaxing_cutoff = 1.2;

// Stiffness of the tube with the walls that carry. The rows of the other holding and of each wall follow its own rows.
Stiffness as_carried(const WalledStiffness& walled, bool outer) {
  Stiffness out = outer ? walled.outer : walled.all;
  const Stiffness& other = outer ? walled.all : walled.outer;
  for (AtomisticRow row : other.rows) {
    row.kind = (outer ? "held-all-" : "held-outer-") + row.kind;
    out.rows.push_back(row);
  }
  out.rows.insert(out.rows.end(), walled.wall_rows.begin(), walled.wall_rows.end());
  return out;
}

// --- Quantities of the file -----------------------------------------------------------------------------

class Quantities {
 public:
  explicit Quantities(ParameterSet& set) : set_(set) {}

  void section(const std::string& name) { section_ = name; }
  void calibrated(const std::string& key, const Measured& m, const std::string& unit,
                  const std::string& note = "") {
    add(key, m.value, unit, m.standard_error, "calibrated", note);
  }
  void chosen(const std::string& key, double value, const std::string& unit, const std::string& note = "") {
    add(key, value, unit, 0, "chosen", note);
  }
  void published(const std::string& key, double value, const std::string& unit, const std::string& doi,
                 const std::string& note) {
    set_.quantities.push_back(
        {section_ + "." + key, value, unit, std::nullopt, doi.empty() ? "chosen" : "published", doi, note});
  }
  void derived(const std::string& key, const Measured& m, const std::string& unit, const std::string& note = "") {
    add(key, m.value, unit, m.standard_error, "derived", note);
  }

 private:
  void add(const std::string& key, double value, const std::string& unit, double error, const char* origin,
           const std::string& note) {
    // A parameter that the data do not determine has no standard error.
    const std::optional<double> known = std::isfinite(error) ? std::optional<double>(error) : std::nullopt;
    set_.quantities.push_back({section_ + "." + key, value, unit, known, origin, "", note});
  }

  ParameterSet& set_;
  std::string section_;
};

Measured scaled(const Measured& m, double factor) {
  return {m.value * factor, std::fabs(factor) * m.standard_error};
}

void add_tube(const Calibration& c, Quantities& q) {
  const Stiffness& s = c.stiffness;
  q.section("tube");
  if (c.walled)
    q.calibrated("contact_radius", s.radius, "nm", "of the outer wall: mean over the atoms of the relaxed tube");
  else
    q.calibrated("radius", s.radius, "nm", "mean over the atoms of the relaxed tube");
  q.calibrated("atoms_per_length", s.atoms_per_length, "1/nm",
               c.walled ? "of all walls of the relaxed tube" : "of the relaxed tube");
  q.chosen("element_length", 2 * s.radius.value, "nm", "2 r; any length will do with the line law");
}

void add_lattice(const Calibration& c, Quantities& q) {
  const Honeycomb& h = c.request.honeycomb();
  if (h.carbon()) return;
  q.section("lattice");
  q.chosen("bond_length", h.bond_length(), "nm", "of the flat sheet, with which the relaxation began");
  q.chosen("weight_1", h.atomic_weight[0], "u", h.species[0]);
  q.chosen("weight_2", h.atomic_weight[1], "u", h.species[1]);
  constexpr const char* of[] = {"11", "12", "22"};
  const Potential& p = c.request.potential;
  for (std::size_t k = 0; k < 3; ++k) {
    const PairLaw &law = h.pairs[k], mixed = mixed_law(h.pairs[0], h.pairs[2]);
    const bool by_rule = k == 1 && law.epsilon == mixed.epsilon && law.sigma == mixed.sigma;
    const std::string note =
        fmt::format("{} with {}: {}", h.species[k / 2], h.species[(k + 1) / 2],
                    by_rule ? "by Lorentz and Berthelot" : p.pairs_reference + "; no partial charges");
    const std::string doi = by_rule ? "" : p.pairs_doi;
    q.published(fmt::format("epsilon_{}", of[k]), law.epsilon, "eV", doi, note);
    q.published(fmt::format("sigma_{}", of[k]), law.sigma, "nm", doi, note);
  }
}

// Each wall as it is within the tube.
void add_walls(const Calibration& c, Quantities& q) {
  const double unit = units::eV_in_nN_nm;
  int k = 0;
  for (const WallStiffness& wall : c.walled->walls) {
    const Chirality of = wall.rest.c;
    q.section(fmt::format("wall.{}", ++k));
    q.calibrated("radius", wall.radius, "nm", fmt::format("({},{}), relaxed with the other walls", of.n, of.m));
    q.calibrated("atoms_per_length", wall.atoms_per_length, "1/nm");
    q.calibrated("EA", scaled(wall.EA, unit), "nN", "energy of its atoms, all walls held");
    q.calibrated("EI", scaled(wall.EI, unit), "nN nm^2");
    q.calibrated("GJ", scaled(wall.GJ, unit), "nN nm^2");
  }
}

// The shear stiffness of walls that all bend along.
Measured shear_of_walls(const Calibration& c) {
  Measured sum;
  for (const WallStiffness& wall : c.walled->walls) {
    const double k = thin_tube_shear({wall.EA.value, wall.EI.value, wall.GJ.value}, wall.radius.value);
    sum.value += k;
    sum.standard_error += k * wall.GJ.standard_error / wall.GJ.value;
  }
  return scaled(sum, units::eV_in_nN_nm);
}

void add_walled_bond(const Calibration& c, Quantities& q) {
  const double unit = units::eV_in_nN_nm;
  const bool outer = c.request.outer_carries;
  q.section("bond");
  const char* of = outer ? "of [held.outer]: finite specimens of two lengths, differenced"
                         : "of [held.all]: finite specimens of two lengths, differenced";
  q.calibrated("EA", scaled(c.stiffness.EA, unit), "nN", of);
  q.calibrated("EI", scaled(c.stiffness.EI, unit), "nN nm^2", of);
  q.calibrated("GJ", scaled(c.stiffness.GJ, unit), "nN nm^2", of);
  q.derived("kGA", shear_of_walls(c), "nN", "sum over the walls, as thin tubes: Cowper, J. Appl. Mech. 33, 335 (1966)");
  for (const auto& [way, s] : {std::pair{"held.all", &c.walled->all}, std::pair{"held.outer", &c.walled->outer}}) {
    q.section(way);
    q.calibrated("EA", scaled(s->EA, unit), "nN", s == &c.walled->all ? "all walls held" : "walls inside are free");
    q.calibrated("EI", scaled(s->EI, unit), "nN nm^2");
    q.calibrated("GJ", scaled(s->GJ, unit), "nN nm^2");
  }
}

void add_bond(const Calibration& c, Quantities& q) {
  if (c.walled) {
    add_walls(c, q);
    add_walled_bond(c, q);
    return;
  }
  const double unit = units::eV_in_nN_nm;
  q.section("bond");
  q.calibrated("EA", scaled(c.stiffness.EA, unit), "nN", "periodic twisted cells");
  q.calibrated("EI", scaled(c.stiffness.EI, unit), "nN nm^2", "affine bend, two lengths differenced");
  q.calibrated("GJ", scaled(c.stiffness.GJ, unit), "nN nm^2", "periodic twisted cells");
  const Measured &torsion = c.stiffness.GJ, &radius = c.stiffness.radius;
  const double shear =
      unit * thin_tube_shear({c.stiffness.EA.value, c.stiffness.EI.value, torsion.value}, radius.value);
  const double relative =
      std::hypot(torsion.standard_error / torsion.value, 2 * radius.standard_error / radius.value);
  q.derived("kGA", {shear, shear * relative}, "nN",
            "thin tube: GA = GJ/r^2, k by Cowper, J. Appl. Mech. 33, 335 (1966)");
}

void add_anharmonic(const Calibration& c, Quantities& q) {
  const AnharmonicFit& fit = c.stiffness.anharmonic;
  if (fit.terms.empty()) return;
  q.section("bond.anharmonic");
  for (std::size_t k = 0; k < fit.terms.size(); ++k)
    q.calibrated(anharmonic_terms[k].key, scaled(fit.terms[k], units::eV_in_nN_nm), "nN",
                 anharmonic_terms[k].meaning);
  q.chosen("min_strain", fit.min_strain, "1",
           fmt::format("fit error {:.1e} of an energy", fit.stretch_twist_error));
  q.chosen("max_strain", fit.max_strain, "1");
  q.chosen("max_shear", fit.max_shear, "1", "radius times twist");
  q.chosen("max_bend", fit.max_bend, "1",
           fmt::format("radius times curvature, the kink; fit error {:.1e} of an energy", fit.bend_error));
}

void add_line(const Calibration& c, Quantities& q) {
  const LineDensity& d = c.line.density;
  const std::vector<double>& se = c.line.fit.standard_error;
  const AtomLaw& law = c.request.law;
  q.section("contact.line");
  if (c.request.honeycomb().carbon()) {
    q.chosen("epsilon", law.epsilon, "eV", "Lennard-Jones between atoms");
    q.chosen("sigma", law.sigma, "nm");
  } else {
    q.derived("epsilon", {law.epsilon, 0}, "eV", "Lennard-Jones between shells: the sum over the pairs of [lattice]");
    q.derived("sigma", {law.sigma, 0}, "nm");
  }
  q.chosen("lj_cutoff", std::isfinite(law.cutoff) ? law.cutoff : 0, "nm", "truncated, not shifted; 0: none");
  const Stiffness& s = c.stiffness;
  const double density = c.shell().density;
  const double density_error = density * std::hypot(s.radius.standard_error / s.radius.value,
                                                    s.atoms_per_length.standard_error / s.atoms_per_length.value);
  q.derived("surface_density", {density, density_error}, "1/nm^2", c.walled ? "atoms per area of the outer wall" : "atoms per area of the relaxed shell");
  q.calibrated("K", {d.K, se[0]}, "eV/nm^2", fmt::format("fit error {:.1e} of the well", c.line.error));
  q.calibrated("s", {d.s, se[1]}, "nm");
  q.calibrated("c", {d.c, se[2]}, "nm");
  q.calibrated("p", {d.p, se[3]}, "1");
  q.calibrated("q", {d.q, se[4]}, "1");
  q.chosen("core_gap", d.core_gap, "nm", "below it a parabola continues the law");
  q.chosen("switch_gap", d.switch_gap, "nm");
  q.chosen("cutoff_gap", d.cutoff_gap, "nm");
  const ContactSummary sum = contact_summary(c);
  q.derived("pair_spacing", sum.pair_spacing, "nm",
            fmt::format("of the law; surface integral {:.5f}", c.line.parallel.distance));
  q.derived("pair_energy", sum.pair_energy, "eV/nm",
            fmt::format("of the law; surface integral {:.5f}", c.line.parallel.energy));
  q.derived("cross90_energy", sum.cross90_energy, "eV",
            fmt::format("of the law; surface integral {:.5f}", c.line.crossed.energy));
  if (c.registry)
    q.derived("registry", {c.registry->deviation, 0}, "1",
              "standard deviation of the pair energy over all registries of the atoms, over the well");
  if (c.walled)
    q.derived("cutoff_loss", {c.cutoff_loss, 0}, "1",
              "part of the well of parallel tubes beyond lj_cutoff; it is in the errors of pair_energy and cross90_energy");
  if (!c.universal) return;
  q.section("contact.line.universal");
  q.derived("error", {c.universal_error, 0}, "1",
            "for this tube, of the well; between unlike tubes this law is used");
}

// A group of quantities of one fit, in the fit's order; those without an error are left out.
void add_correlation(const std::vector<std::string>& keys, const std::vector<std::vector<double>>& matrix,
                     ParameterSet& set) {
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < keys.size() && k < matrix.size(); ++k) {
    const Quantity* q = find_quantity(set, keys[k]);
    if (q && q->standard_error.value_or(0) > 0) known.push_back(k);
  }
  if (known.size() < 2) return;
  Correlation c;
  for (const std::size_t i : known) {
    c.of.push_back(keys[i]);
    c.matrix.emplace_back();
    for (const std::size_t j : known) c.matrix.back().push_back(matrix[i][j]);
  }
  set.correlations.push_back(std::move(c));
}

// A number that its data do not determine: its error exceeds it, or the search ended at a bound.
std::string undetermined_note(const FitResult& fit, std::size_t k) {
  const std::string name = paper_parameters[k];
  if (std::find(fit.at_bound.begin(), fit.at_bound.end(), name) != fit.at_bound.end())
    return "at a bound of the fit: not determined by its data";
  return fit.standard_error[k] < std::fabs(fit.value[k]) ? "" : "not determined by its data";
}

void add_paper(const Calibration& c, Quantities& q) {
  const PaperContact& k = c.paper.law;
  const std::vector<double>& se = c.paper.fit.standard_error;
  q.section("contact.paper");
  q.chosen("epsilon", k.epsilon, "eV", fmt::format("unit of A and B; fit error {:.1e} of the well", c.paper.error));
  const double values[] = {k.repulsion,  k.attraction, k.alpha,      k.beta,     k.angular[0], k.angular[1],
                           k.angular[2], k.angular[3], k.angular[4], k.crossing, k.delta};
  for (std::size_t i = 0; i < std::size(paper_parameters); ++i)
    q.calibrated(paper_parameters[i], {values[i], se[i]}, "1", undetermined_note(c.paper.fit, i));
  q.chosen("freeze", k.freeze, "r");
  q.chosen("switch_start", k.switch_start, "r");
  q.chosen("cutoff", k.cutoff_ratio, "r");
  q.chosen("core_gap", k.core_gap, "1");
}

void add_atomistic(const Calibration& c, Quantities& q) {
  const Stiffness& s = c.stiffness;
  q.section("atomistic");
  q.calibrated("natural_twist", s.natural_twist, "rad/nm",
               c.walled ? "of the tube against its walls at rest together" : "of the relaxed tube against the rolled sheet");
  q.calibrated("coupling", scaled(s.coupling, units::eV_in_nN_nm), "nN nm", "of stretch and twist");
  q.calibrated("poisson", s.poisson, "1", c.walled ? "-d ln r / d strain, of the outer wall" : "-d ln r / d strain");
  q.calibrated("energy_per_atom", {s.energy_per_atom, 0}, "eV", "of the relaxed tube");
  if (c.walled) return;
  q.calibrated("sublattice_turn", {s.sublattice_turn, 0}, "rad", "of the second sublattice against the first");
  q.calibrated("sublattice_rise", {s.sublattice_rise, 0}, "nm", "likewise");
  if (const Honeycomb& h = c.request.honeycomb(); !h.one_species())
    q.calibrated("sublattice_lift", {s.sublattice_lift, 0}, "nm",
                 fmt::format("radius of {} minus that of {}", h.species[1], h.species[0]));
}

void add_validity(const Calibration& c, Quantities& q) {
  const Envelope& e = c.stiffness.envelope;
  const std::string note = e.measured  ? "incremental LAMMPS runs"
                           : c.walled ? "scaling rule of the outer wall alone: walls inside of it move the limit out"
                                      : "scaling rule; --envelope measures it";
  const auto add = [&](const char* key, const Measured& m, const char* unit) {
    if (!(m.value > 0)) return;
    e.measured ? q.calibrated(key, m, unit, note) : q.derived(key, m, unit, note);
  };
  q.section("validity");
  add("kink_curvature", e.kink_curvature, "1/nm");
  add("twist_collapse", e.twist_collapse, "1");
  add("stretch", e.compression, "1");
  const AnharmonicFit& fit = c.stiffness.anharmonic;
  if (fit.collapse_shear > 0)
    q.calibrated(
        "endless_collapse", e.endless_collapse, "1",
        fmt::format("of an endless tube, whose torque is constant beyond it, within {:.1f} % of the energy up to "
                    "{:.3g}",
                    100 * fit.collapse_error, fit.collapse_shear));
  const std::string terms = "from the anharmonic terms of the fit";
  const auto limit = [&](const char* key, const Measured& m, const char* unit) {
    if (m.value > 0) q.derived(key, m, unit, e.measured ? note : terms);
  };
  limit("linear_curvature", e.linear_curvature, "1/nm");
  limit("linear_twist", e.linear_shear, "1");
  limit("linear_stretch", e.linear_strain, "1");
}

// --- The universal law ----------------------------------------------------------------------------------

// Standard error of the universal law, relative to the wells: the error of the direct fit plus that of the
// universal form.
double error_against(const LineFit& direct, const LineDensity& density) {
  double worst = 0;
  const auto curve = [&](const std::vector<ContactPoint>& points, double well, double nearest, bool crossed) {
    for (const ContactPoint& p : points) {
      if (p.distance < nearest - 0.05) continue;
      const double e = crossed ? line_crossed_energy(density, p.distance, right_angle)
                               : line_parallel_energy(density, p.distance);
      worst = std::max(worst, std::fabs((e - p.integral) / well));
    }
  };
  curve(direct.parallel_curve, direct.parallel.energy, direct.parallel.distance, false);
  curve(direct.crossed_curve, direct.crossed.energy, direct.crossed.distance, true);
  return worst;
}

// The atoms of the rolled sheet at the relaxed radius. They show how much the energy of a real pair varies with the
// registry.
std::optional<RegistrySpread> registry_of(const Calibration& c) {
  if (!std::isfinite(c.request.law.cutoff)) return std::nullopt;
  // The corrugation of several walls is that of the outer ones within reach of the usual cutoff.
  const Chirality tube = c.request.chirality;
  const Honeycomb& h = c.request.honeycomb();
  const double a = h.lattice_constant * c.stiffness.radius.value / tube_radius(tube, h.lattice_constant);
  const TubeCell cell = tube_cell(tube, translation_vector(tube), a);
  AtomColumn column{cell.atoms, cell.length, {}};
  for (std::size_t k = 0; k < cell.atoms.size(); ++k)
    column.second.push_back(!h.one_species() && k >= cell.atoms.size() / 2 ? 1 : 0);
  const Shell shell{cell.radius, graphene_density(a)};
  AtomLaw law = c.request.law;
  if (c.walled) law.cutoff = std::min(law.cutoff, relaxing_cutoff);
  const Well well = parallel_well(law, shell, shell);
  SpeciesLaws laws = c.request.laws();
  for (AtomLaw& one : laws) one.cutoff = law.cutoff;
  RegistrySpread s = registry_spread(laws, column, column, well.distance, cell.atoms.size() > 300 ? 300 : 2000);
  for (double* value : {&s.mean, &s.deviation, &s.least, &s.largest})
    *value /= c.walled && value == &s.deviation ? c.line.parallel.energy : well.energy;
  s.deviation = std::fabs(s.deviation);
  return s;
}

void warn(Calibration& c) {
  c.warnings = c.stiffness.warnings;
  if (!c.line.fit.usable()) c.warnings.push_back("line law: " + c.line.fit.message);
  if (!c.walled && !c.paper.fit.usable()) c.warnings.push_back("paper law: " + c.paper.fit.message);
  if (c.universal_error > unusable_contact)
    c.warnings.push_back(
        fmt::format("the universal law is off by {:.2g} % of the well for this tube and left out: the set serves "
                    "scenes of one kind of tube",
                    100 * c.universal_error));
  else if (!c.universal)
    c.warnings.push_back(
        c.walled ? std::string("no universal law of several walls: the set serves scenes of one kind of tube")
                 : "no universal law for this sigma and cutoff: the set serves scenes of one kind of tube; "
        "`ropewalk calibrate universal` makes one");
}

}  // namespace

SpeciesLaws CalibrationRequest::laws() const {
  SpeciesLaws all = {law, law, law};
  if (honeycomb().carbon()) return all;
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = {honeycomb().pairs[k].epsilon, honeycomb().pairs[k].sigma, law.cutoff};
  return all;
}

std::vector<Shell> Calibration::shells() const {
  if (!walled) return {{stiffness.radius.value, stiffness.surface_density()}};
  std::vector<Shell> out;
  for (const WallStiffness& wall : walled->walls)
    out.push_back({wall.radius.value, wall.atoms_per_length.value / (2 * units::pi * wall.radius.value)});
  return out;
}

std::string CalibrationRequest::tube() const {
  std::string text;
  for (const Chirality c : walls.empty() ? std::vector{chirality} : walls)
    text += fmt::format("{}({},{})", text.empty() ? "" : "@", c.n, c.m);
  return honeycomb().carbon() ? text : text + " " + honeycomb().name;
}

std::string CalibrationRequest::name() const {
  std::string text;
  for (const Chirality c : walls.empty() ? std::vector{chirality} : walls)
    text += fmt::format("{}{}-{}", text.empty() ? "" : "@", c.n, c.m);
  return fmt::format("{}-{}-{}", honeycomb().stem(), text, potential.name);
}

Calibration calibrate(const CalibrationRequest& request) {
  const double begin = steady_seconds();
  Calibration c;
  c.request = request;
  const AtomLaw& law = request.law;
  if (request.walls.empty()) {
    c.stiffness = measure_stiffness(request.chirality, request.potential, request.folder, request.stiffness);
  } else {
    c.walled = measure_walls(request.walls, request.potential,
                             {law.epsilon, law.sigma, std::min(law.cutoff, relaxing_cutoff)},
                             request.outer_carries ? Holding::outer : Holding::all, request.folder,
                             request.stiffness);
    c.stiffness = as_carried(*c.walled, request.outer_carries);
  }
  c.lammps = c.stiffness.lammps;
  const std::vector<Shell> shells = c.shells();
  const Shell shell = c.shell();
  const auto say = [&](const char* text) {
    if (request.stiffness.lammps.interrupted && request.stiffness.lammps.interrupted())
      throw LammpsError("interrupted");
    if (request.stiffness.progress) request.stiffness.progress(text);
  };
  say("van der Waals contact: surface integral and line law");
  c.line = fit_line(law, shells, shells);
  if (c.walled) {
    AtomLaw whole = law;
    whole.cutoff = infinite;
    c.cutoff_loss = 1 - c.line.parallel.energy / WallsIntegral(whole, shells, shells).parallel_well().energy;
  } else {
    say("van der Waals contact: the published form");
    const double paper_begin = steady_seconds();
    c.paper = fit_paper(request.law, shell, 2 * shell.radius);
    c.paper_seconds = seconds_since(paper_begin);
    c.universal = universal_law(request.law);
  }
  if (c.universal)
    c.universal_error =
        error_against(c.line, c.universal->density(shell.radius, shell.density, shell.radius, shell.density));
  if (c.universal_error > unusable_contact) c.universal.reset();
  c.registry = registry_of(c);
  warn(c);
  c.seconds = seconds_since(begin);
  return c;
}

ContactSummary contact_summary(const Calibration& c) {
  const LineFit& f = c.line;
  const Stiffness& s = c.stiffness;
  // Errors of the closed form and of the relaxed geometry: the spacing is proportional to 2 r, energies to the
  // square of the atoms per area.
  const double misfit = std::fabs(f.line_parallel.distance - f.parallel.distance);
  const double area = 2 * std::hypot(s.radius.standard_error / s.radius.value,
                                     s.atoms_per_length.standard_error / s.atoms_per_length.value);
  const auto energy = [&](const Well& line, const Well& integral) {
    return Measured{line.energy, std::hypot(std::hypot(line.energy - integral.energy, area * line.energy),
                                            c.cutoff_loss * line.energy)};
  };
  return {{f.line_parallel.distance, std::hypot(misfit, 2 * s.radius.standard_error)},
          energy(f.line_parallel, f.parallel),
          energy(f.line_crossed, f.crossed)};
}

std::string stiffness_csv(const Calibration& c) {
  AtomisticOrigin origin;
  origin.chirality = c.request.chirality;
  if (const Honeycomb& h = c.request.honeycomb(); !h.carbon())
    origin.species = fmt::format("{} and {}", h.species[0], h.species[1]);
  origin.potential = c.request.potential.name;
  origin.potential_hash = c.request.potential.file_hash;
  origin.lammps = c.lammps.text;
  if (c.walled)
    origin.notes = {fmt::format("walls {}: the chirality above is that of the outer one; {} carried", c.request.tube(),
                                c.request.outer_carries ? "the outer wall" : "all walls")};
  return atomistic_csv(c.stiffness.rows, origin);
}

std::string contact_csv(const Calibration& c) {
  std::string text = fmt::format(
      "# Surface integral of two {} tubes, r = {} nm, {} atoms per nm^2, and the line law fitted to it.\n"
      "# Lennard-Jones {} eV, {} nm, cutoff {} nm. Units: density eV/nm^2, parallel eV/nm, crossed eV.\n"
      "{}\n",
      c.request.tube(), c.shell().radius, c.shell().density, c.request.law.epsilon,
      c.request.law.sigma, c.request.law.cutoff, column_names(contact_columns()));
  const auto curve = [&](const char* kind, const std::vector<ContactPoint>& points) {
    for (const ContactPoint& p : points)
      text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g}\n", kind, p.distance, p.angle / units::degree, p.integral,
                          p.fit);
  };
  curve("density", c.line.u);
  curve("parallel", c.line.parallel_curve);
  curve("crossed", c.line.crossed_curve);
  return text;
}

ParameterSet parameter_set(const Calibration& c, const std::string& stiffness_file,
                           const std::string& contact_file) {
  ParameterSet set;
  set.name = c.request.name();
  set.honeycomb = c.request.honeycomb();
  set.chirality = c.request.chirality;
  if (c.walled) {
    set.outer_carries = c.request.outer_carries;
    for (const WallStiffness& wall : c.walled->walls)
      set.walls.push_back({wall.rest.c, wall.radius.value, wall.atoms_per_length.value});
  }
  set.reference = c.request.potential.reference;
  set.doi = c.request.potential.doi;
  Quantities q(set);
  add_lattice(c, q);
  add_tube(c, q);
  add_bond(c, q);
  add_anharmonic(c, q);
  if (const PullFit& pull = c.stiffness.pull; pull.end > 0) put_pull(set, pull);
  add_line(c, q);
  if (c.paper.fit.usable()) add_paper(c, q);
  add_atomistic(c, q);
  add_correlation({"bond.EA", "bond.GJ", "atomistic.coupling", "atomistic.natural_twist"}, c.stiffness.correlation,
                  set);
  add_correlation({"contact.line.K", "contact.line.s", "contact.line.c", "contact.line.p", "contact.line.q"},
                  c.line.fit.correlation, set);
  std::vector<std::string> paper;
  for (const char* name : paper_parameters) paper.push_back(std::string("contact.paper.") + name);
  if (c.paper.fit.usable()) add_correlation(paper, c.paper.fit.correlation, set);
  add_validity(c, q);
  LineParameters line;
  line.surface_density = c.shell().density;
  line.density = c.line.density;
  if (c.universal) {
    line.universal = *c.universal;
    line.has_universal = true;
  }
  set.laws[LineParameters::law] = line;
  set.provenance = {
      {"command", c.request.command},
      {"program", fmt::format("ropewalk {} ({})", version, git_id)},
      {"atoms", c.request.potential.atoms},
      {"potential", c.request.potential.name},
      {"potential_file", std::filesystem::path(c.request.potential.file).filename().string()},
      {"potential_hash", c.request.potential.file_hash},
      {"lammps", c.lammps.text},
      {"stiffness_table", stiffness_file},
      {"stiffness_hash", hash_hex(stiffness_csv(c))},
      {"contact_table", contact_file},
      {"contact_hash", hash_hex(contact_csv(c))},
  };
  auto& p = set.provenance;
  p.erase(std::remove_if(p.begin(), p.end(), [](const auto& entry) { return entry.second.empty(); }), p.end());
  return set;
}

void put_pull(ParameterSet& set, const PullFit& pull) {
  const std::string note = fmt::format("beyond it {}; {:.4g} nN, law within {:.1e} of the energy", pull.ended_by,
                                       pull.force.back().value * units::eV_in_nN_nm, pull.error);
  auto& all = set.quantities;
  const auto begins = [](const Quantity& q, const char* with) { return q.key.rfind(with, 0) == 0; };
  all.erase(std::remove_if(all.begin(), all.end(), [&](const Quantity& q) { return begins(q, "bond.pull."); }),
            all.end());
  auto at = all.end();
  while (at != all.begin() && !begins(*(at - 1), "bond.anharmonic.")) --at;
  const Quantity added[] = {{"bond.pull.end", pull.end, "1", 0.5 * pull_step, "calibrated", "", note},
                            start_quantity("bond.pull.start", pull.start, "1"),
                            start_quantity("bond.pull.edge_force", pull.edge_force * units::eV_in_nN_nm, "nN")};
  all.insert(at, std::begin(added), std::end(added));
  set.pull = pull.law();
  for (std::size_t k = 0; k < pull.force.size(); ++k) set.pull_errors[k] = pull.force[k].standard_error;
}

std::string parameter_file_comment(const Calibration& c) {
  std::string text = fmt::format(
      "# Calibrated parameters of the {} nanotube, {} potential. Made by\n#   {}\n"
      "# Stiffnesses from relaxed atomistic {} (LAMMPS), contact from the surface integral of the "
      "Lennard-Jones\n"
      "# law; the tables named under [provenance] hold every energy that was fitted.\n",
      c.request.tube() + (c.request.honeycomb().carbon() ? " carbon" : ""), c.request.potential.name, c.request.command, c.walled ? "specimens" : "cells");
  for (const std::string& w : c.warnings) text += "# Warning: " + w + "\n";
  return text;
}

std::string universal_path() { return data_directory() + "/contact/universal-line.toml"; }

std::optional<UniversalLine> universal_law(const AtomLaw& law) {
  const std::string path = universal_path();
  if (!std::filesystem::exists(path)) return std::nullopt;
  const TomlTable top = TomlTable::parse(read_file(path), path);
  if (top.string("format") != universal_format)
    throw top.error("format", "is not that of a universal law",
                    fmt::format("this program reads \"{}\"", universal_format));
  UniversalLine u;
  const double sigma = top.number("sigma_nm", Bounds::positive(10));
  u.lj_cutoff = top.number("lj_cutoff_nm", Bounds::non_negative(100));
  const double cutoff = std::isfinite(law.cutoff) ? law.cutoff : 0;
  if (std::fabs(sigma - law.sigma) > 1e-9 || std::fabs(u.lj_cutoff - cutoff) > 1e-9) return std::nullopt;
  u.epsilon = law.epsilon;
  u.sigma = sigma;
  u.core_gap = top.number("core_gap_nm", Bounds::positive(10));
  u.switch_gap = top.number("switch_gap_nm", Bounds::positive(10));
  u.cutoff_gap = top.number("cutoff_gap_nm", Bounds::positive(10));
  read_universal_rows(top.table("rows"), u);
  return u;
}

std::string universal_file(const UniversalFit& fit, const std::string& command) {
  UniversalLine u = fit.law;
  u.standard_errors = {fit.se_log_K, fit.se_s, fit.se_c, fit.se_p, fit.se_q};
  std::string text = fmt::format(
      "# The line law of any two tubes of radius 0.3 .. 1.4 nm, for one Lennard-Jones law: see UniversalLine in\n"
      "# mdem/model/contact/line.hpp. Largest error {:.2e} of the well. Made by\n#   {}\n"
      "format = \"{}\"\nsigma_nm = {}\nlj_cutoff_nm = {}\ncore_gap_nm = {}\nswitch_gap_nm = {}\ncutoff_gap_nm = "
      "{}\n"
      "error = {:.4e}\n\n[rows]\n{}\n# Errors over the well: of a fit of its own, and of this law; then its errors "
      "of spacing and depth.\n",
      fit.error, command, universal_format, u.sigma, u.lj_cutoff, u.core_gap, u.switch_gap, u.cutoff_gap, fit.error,
      universal_rows_text(u));
  for (const UniversalFit::PairCheck& p : fit.pairs)
    text +=
        fmt::format("# r {:.3f} {:.3f} nm   direct {:.1e}   universal {:.1e}   spacing {:+.1e}   depth {:+.1e}\n",
                    p.r_i, p.r_j, p.direct_error, p.error, p.spacing_error, p.depth_error);
  return text;
}

}  // namespace ropewalk::calibrate
