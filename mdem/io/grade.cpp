#include "io/grade.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/parameters_toml.hpp"
#include "io/plain_text.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk {
namespace {

constexpr double known_well = 0.01;          // relative error of a good stiffness, and of a good contact
constexpr double unknown_stiffness = 0.5;    // relative error of a stiffness that is not known
constexpr double collapsing_diameter = 4.2;  // nm

constexpr double thin_shell = 0.1;  // EI from EA r^2/2, relative: calibrated tubes agree to 0.04

using Level = Grade::Level;

void add(Grade& grade, Level level, std::string reason) {
  grade.level = std::max(grade.level, level);
  grade.reasons.push_back(std::move(reason));
}

void grade_stiffness(const ParameterSet& set, Grade& grade) {
  for (const char* key : {"EA", "EI", "EI_1", "EI_2", "GJ"}) {
    const Quantity* q = find_quantity(set, std::string("bond.") + key);
    if (!q || (q->standard_error && *q->standard_error <= known_well * q->value)) continue;
    if (!q->standard_error) {
      if (q->origin == "calibrated") add(grade, Level::limited, fmt::format("{} has no standard error", key));
      continue;
    }
    const double error = *q->standard_error / q->value;
    add(grade, error > unknown_stiffness ? Level::unfit : Level::limited,
        fmt::format("{} is known to {:.2g} %", key, 100 * error));
  }
}

// 23, the ratio of two units of energy, lies far outside of the ranges.
void grade_wall(const ParameterSet& set, Grade& grade) {
  const double wall = wall_stiffness(set);
  const WallRange range = wall_range(set.honeycomb);
  if (wall >= range.softest && wall <= range.stiffest) return;
  add(grade, Level::unfit,
      fmt::format("EA/(2 pi r) is {:.4g} N/m, and {} has {:.0f} to {:.0f}: is a unit of the potential or of the set wrong?",
                  wall, range.of, range.softest, range.stiffest));
}

// Where values lie for all tubes of carbon, in whatever potential, or for their ratios to what they must agree
// with. Wide enough for any tube, and so narrow that ten times the value, a tenth of it, another sign and another
// unit lie outside.
struct Range {
  const char* what;
  double value, least, most;
};

void within(const std::vector<Range>& ranges, Grade& grade) {
  for (const Range& r : ranges)
    if (!(r.value >= r.least && r.value <= r.most))
      add(grade, Level::limited,
          fmt::format("{} is {:.4g}, and {:.4g} to {:.4g} is to be expected: is a number or a unit wrong?", r.what,
                      r.value, r.least, r.most));
}

double number_of(const ParameterSet& set, const std::string& key) {
  const Quantity* q = find_quantity(set, key);
  return q ? q->value : 0;
}

// Sum of a quantity over the walls, times a power of the radius.
double sum_over_walls(const ParameterSet& set, const char* key, int power) {
  double sum = 0;
  for (std::size_t k = 0; k < set.walls.size(); ++k)
    sum += number_of(set, fmt::format("wall.{}.{}", k + 1, key)) * std::pow(set.walls[k].radius, power);
  return sum;
}

// Walls that slide along one another have the bending stiffness of N sheets, and a tube of given width collapses or
// facets by the ratio of that stiffness to its adhesion: both diameters go as sqrt(N).
void grade_walls(const ParameterSet& set, Grade& grade) {
  const double diameter = 2 * set.radius, wider = std::sqrt(static_cast<double>(set.walls.size()));
  if (2 * set.walls.front().radius < slender_diameter)
    add(grade, Level::limited,
        fmt::format("its inner wall is {:.2f} nm wide: below {} nm a wall is no thin shell",
                    2 * set.walls.front().radius, slender_diameter));
  if (diameter > collapsing_diameter * wider)
    add(grade, Level::unfit,
        fmt::format("{:.2f} nm wide: tubes of {} walls wider than {:.2g} nm may collapse by themselves", diameter,
                    set.walls.size(), collapsing_diameter * wider));
  else if (diameter > faceting_diameter * wider)
    add(grade, Level::limited,
        fmt::format("{:.2f} nm wide: tubes of {} walls wider than {:.2g} nm facet one another in ropes, and rigid circular "
                    "ones bind too weakly",
                    diameter, set.walls.size(), faceting_diameter * wider));
  const double poisson = sum_over_walls(set, "EA", 2) / (2 * sum_over_walls(set, "GJ", 0)) - 1;
  within({{"Poisson's ratio of the walls, EA r^2/(2 GJ) - 1,", poisson, -0.1, 0.6},
          {"EI over that of thin shells, EA r^2/2 over all walls,", set.bond.bend * units::eV_in_nN_nm /
                                                                        (0.5 * sum_over_walls(set, "EA", 2)),
           0.9, 1.1},
          {"EA of [held.all] over the sum of the walls", number_of(set, "held.all.EA") / sum_over_walls(set, "EA", 0),
           0.99, 1.01},
          {"GJ of [held.all] over the sum of the walls", number_of(set, "held.all.GJ") / sum_over_walls(set, "GJ", 0),
           0.99, 1.01},
          {"EA of [held.outer] over that of the outer wall",
           number_of(set, "held.outer.EA") / number_of(set, fmt::format("wall.{}.EA", set.walls.size())), 0.97, 1.1}},
         grade);
}

void grade_width(const ParameterSet& set, Grade& grade) {
  const double diameter = 2 * set.radius;
  const double shell = 2 * set.bond.bend / (set.bond.stretch * set.radius * set.radius);
  if (diameter >= slender_diameter && std::fabs(shell - 1) > thin_shell)
    add(grade, Level::limited,
        fmt::format("EI is {:+.2g} % off that of a thin shell, EA r^2/2: is a stiffness or a unit wrong?",
                    100 * (shell - 1)));
  if (diameter < slender_diameter)
    add(grade, Level::limited,
        fmt::format("{:.2f} nm wide: below {} nm the wall is no thin shell (EI is {:+.2g} % off EA r^2/2), and "
                    "potentials differ widely",
                    diameter, slender_diameter, 100 * (shell - 1)));
  if (diameter > collapsing_diameter)
    add(grade, Level::unfit,
        fmt::format("{:.2f} nm wide: tubes wider than {} nm may collapse by themselves, and are not circular",
                    diameter, collapsing_diameter));
  else if (diameter > faceting_diameter)
    add(grade, Level::limited,
        fmt::format(
            "{:.2f} nm wide: tubes wider than {:.0f} nm facet one another in ropes, and rigid circular ones "
            "bind too weakly, by up to 17 % at 2.7 nm",
            diameter, faceting_diameter));
}

// Two numbers of the set that say the same.
void agree(double one, double other, const char* what, const char* and_is, Grade& grade) {
  const double off = std::fabs(one / other - 1);
  if (off <= known_well) return;
  add(grade, off > unusable_contact ? Level::unfit : Level::limited,
      fmt::format("{} {:.4g} {} {:.4g}: one of them is wrong", what, one, and_is, other));
}

void grade_contact(const ParameterSet& set, Grade& grade) {
  if (!set.law<LineParameters>()) {
    add(grade, Level::limited, "its contact was not compared with the surface integral between two tubes");
    return;
  }
  const LineParameters& line = *set.law<LineParameters>();
  agree(line_parallel_well(line.density).energy, line.pair_energy, "K, s, c, p and q give two parallel tubes",
        "eV/nm, and pair_energy is", grade);
  agree(line_crossed_well(line.density, 0.5 * units::pi).energy, line.cross90_energy,
        "K, s, c, p and q give two crossed tubes", "eV, and cross90_energy is", grade);
  const double density = set.walls.empty() ? set.atoms_per_length : set.walls.back().atoms_per_length;
  agree(density / (2 * units::pi * set.radius), line.surface_density,
        "atoms_per_length and radius give", "atoms per nm^2, and surface_density is", grade);
  const double own = line_fit_error(set), mixed = universal_error(set);
  if (own > known_well)
    add(grade, own > unusable_contact ? Level::unfit : Level::limited,
        fmt::format("the contact is off by up to {:.2g} % of the well", 100 * own));
  if (mixed > unusable_contact)
    add(grade, Level::limited,
        fmt::format("not to be mixed with other tubes: the universal contact law is off by {:.2g} % of the well",
                    100 * mixed));
  else if (mixed > known_well)
    add(grade, Level::limited,
        fmt::format("the contact with other tubes is off by up to {:.2g} % of the well", 100 * mixed));
  else if (!set.law<LineParameters>()->has_universal)
    add(grade, Level::limited, "not to be mixed with other tubes: it has no universal contact law");
}

double value_or_none(const Quantity* q) { return q ? q->value : -1; }

// The shell that EA and EI belong to has GJ too, and with it kGA (G. R. Cowper, J. Appl. Mech. 33, 335 (1966)).
void grade_shell(const ParameterSet& set, Grade& grade) {
  const BondStiffness& b = set.bond;
  const double r2 = set.radius * set.radius, poisson = b.stretch * r2 / (2 * b.twist) - 1;
  std::vector<Range> ranges;
  if (set.walls.empty()) ranges.push_back({"Poisson's ratio, EA r^2/(2 GJ) - 1,", poisson, -0.1, 0.6});
  if (set.walls.empty() && b.shear > 0) {
    const double expected = 2 * (1 + poisson) / (4 + 3 * poisson) * b.twist / r2;
    ranges.push_back({"kGA over that of a thin tube", b.shear / expected, 0.8, 1.25});
  }
  if (const Quantity* q = find_quantity(set, "atomistic.poisson"))
    ranges.push_back({"poisson", q->value, 0.04, 0.5});
  if (const Quantity* q = find_quantity(set, "atomistic.energy_per_atom"))
    ranges.push_back({"energy_per_atom (eV)", q->value, -9, set.honeycomb.carbon() ? -6.0 : -2.0});
  within(ranges, grade);
}

// Limits of the model, by the width of the tube: a kink at 0.155 nm/d^2 (S. Iijima et al., J. Chem. Phys. 104, 2089
// (1996), DOI 10.1063/1.470966), and the rest by those that have been calibrated.
void grade_limits(const ParameterSet& set, Grade& grade) {
  const Validity& v = set.validity;
  if (const Quantity* kink = find_quantity(set, "validity.kink_curvature");
      !set.honeycomb.carbon() && kink && kink->origin == "derived")
    add(grade, Level::limited,
        fmt::format("kink, collapse and compression follow the rules for carbon, and {} may give way earlier by a third: "
                    "calibrate with --envelope",
                    set.honeycomb.name));
  const double d = 2 * set.radius;
  std::vector<Range> ranges = {{"kink_curvature over 0.155 nm/(2 r)^2", v.kink_curvature * d * d / 0.155, 0.5, 2},
                               {"twist_collapse", v.twist_collapse, 0.012, 0.2},
                               {"stretch", v.stretch, 0.02, 0.2}};
  if (v.endless_collapse > 0) {
    Validity of_12_nm = v;
    of_12_nm.endless_collapse = 0;
    ranges.push_back({"endless_collapse over that which fits twist_collapse",
                      v.endless_collapse / of_12_nm.collapse_at(set.radius, 0), 0.6, 1.4});
  }
  const auto linear = [&](const char* key, const char* what, double limit, double least, double most) {
    if (const Quantity* q = find_quantity(set, std::string("validity.") + key))
      ranges.push_back({what, q->value / limit, least, most});
  };
  linear("linear_curvature", "linear_curvature over kink_curvature", v.kink_curvature, 0.05, 0.5);
  linear("linear_twist", "linear_twist over twist_collapse", v.twist_collapse, 0.1, 1);
  linear("linear_stretch", "linear_stretch over stretch", v.stretch, 0.015, set.honeycomb.carbon() ? 0.15 : 0.2);
  within(ranges, grade);
}

// The law beyond Hooke's: its window is that of the limits, and its terms say where the stiffnesses are 1 % off.
void grade_anharmonic(const ParameterSet& set, Grade& grade) {
  if (!set.anharmonic) return;
  const Anharmonic& h = *set.anharmonic;
  const Validity& v = set.validity;
  const double r = set.radius, EA = set.bond.stretch;
  std::vector<Range> ranges = {{"max_strain over stretch", h.max_strain / v.stretch, 0.9, 1.1},
                               {"min_strain over -stretch", -h.min_strain / v.stretch, 0.5, 2},
                               {"max_bend over r kink_curvature", h.max_bend / (r * v.kink_curvature), 0.9, 1.1},
                               {"max_shear over twist_collapse", h.max_shear / v.twist_collapse, 0.7, 1.4},
                               {"e3 over EA", h.e3 / EA, -1.5, -0.3},
                               {"es2 over EA", h.es2 / EA, -1.2, -0.1},
                               {"s4 over EA", h.s4 / EA, -2, -0.1},
                               {"e4 over EA", h.e4 / EA, -3, 3},
                               {"e2s2 over EA", h.e2s2 / EA, -5, 5}};
  if (const Quantity* q = find_quantity(set, "validity.linear_curvature"))
    ranges.push_back({"the loss of EI at linear_curvature, by b4,",
                      -4 * h.b4 * std::pow(r, 4) * q->value * q->value / set.bond.bend, 0.005, 0.02});
  if (set.pull) {
    const double then = set.pull->edge_force;
    ranges.push_back({"the first force of the pull over edge_force", set.pull->force.front() / then, 0.97, 1.03});
    ranges.push_back({"the force at max_strain over edge_force", edge_of_window(h, EA).force / then, 0.9, 1.1});
  }
  within(ranges, grade);
}

void grade_line(const ParameterSet& set, Grade& grade) {
  if (!set.law<LineParameters>()) return;
  const LineParameters& line = *set.law<LineParameters>();
  const LineDensity& d = line.density;
  const double cutoff = line.universal.lj_cutoff;
  within({{"epsilon (eV)", line.universal.epsilon, 0.001, 0.01},
          {"sigma (nm)", line.universal.sigma, 0.25, 0.45},
          {"lj_cutoff (nm; 0 for none)", cutoff, cutoff == 0 ? 0 : 0.7, 5},
          {"core_gap (nm)", d.core_gap, 0.1, 0.3},
          {"switch_gap (nm)", d.switch_gap, 0.3, 2},
          {"cutoff_gap (nm)", d.cutoff_gap, 0.8, 5},
          {"the gap of two tubes by pair_spacing (nm)", line.pair_spacing - 2 * set.radius, 0.25, 0.4}},
         grade);
  if (const double deviation = registry_deviation(set); deviation >= 0)
    within({{"registry", deviation, 0, 0.05}}, grade);
  agree(line_parallel_well(d).distance, line.pair_spacing, "K, s, c, p and q give two parallel tubes",
        "nm, and pair_spacing is", grade);
  if (!line.has_universal) return;
  // The universal law is as good for this tube as its error says.
  const LineDensity mixed =
      line.universal.density(set.radius, line.surface_density, set.radius, line.surface_density);
  within(
      {{"the well of the universal law over that of this tube", line_parallel_well(mixed).energy / line.pair_energy,
        1 - std::max(0.02, 3 * universal_error(set)), 1 + std::max(0.02, 3 * universal_error(set))}},
      grade);
}

// What any slender body must have. Values of another unit, or of ten times the size, lie outside for most.
void grade_filament(const ParameterSet& set, Grade& grade) {
  add(grade, Level::limited,
      "a filament without a lattice: nothing here was held to atoms, its numbers are as good as its sources");
  if (const double off = line_fit_error(set); off > known_well)
    add(grade, off > unusable_contact ? Level::unfit : Level::limited,
        fmt::format("the contact is off by up to {:.2g} % of the well of its table", 100 * off));
  const double u_per_nm3_in_g_per_cm3 = units::atomic_mass_kg * 1e24;
  const double density = set.mass_per_length / units::atomic_mass / (units::pi * set.radius * set.radius);
  within({{"mass_per_length over pi contact_radius^2 (g/cm^3)", density * u_per_nm3_in_g_per_cm3, 0.1, 25},
          {"sqrt(EI/EA) over contact_radius", std::sqrt(set.bond.bend / set.bond.stretch) / set.radius, 0.05, 1},
          {"contact_radius times kink_curvature", set.radius * set.validity.kink_curvature, 0, 1}},
         grade);
}

}  // namespace

std::string Grade::words() const {
  if (level == Level::good) return "good";
  return fmt::format("{}: {}", level == Level::limited ? "limited" : "unfit", fmt::join(reasons, "; "));
}

Grade grade_of(const ParameterSet& set) {
  Grade grade;
  grade_stiffness(set, grade);
  if (set.filament) {
    grade_filament(set, grade);
    return grade;
  }
  grade_wall(set, grade);
  set.walls.empty() ? grade_width(set, grade) : grade_walls(set, grade);
  grade_shell(set, grade);
  grade_limits(set, grade);
  grade_anharmonic(set, grade);
  grade_contact(set, grade);
  grade_line(set, grade);
  return grade;
}

double wall_stiffness(const ParameterSet& set) {
  double radius = set.radius;
  if (!set.walls.empty() && !set.outer_carries) {
    radius = 0;
    for (const Wall& wall : set.walls) radius += wall.radius;
  }
  return set.bond.stretch * units::eV_in_nN_nm / (2 * units::pi * radius);
}

// The file format keeps it in the note of K: "fit error 1.4e-03 of the well".
double line_fit_error(const ParameterSet& set) {
  const Quantity* q = find_quantity(set, "contact.line.K");
  const std::string words = "fit error ";
  const std::size_t at = q ? q->note.find(words) : std::string::npos;
  return at == std::string::npos ? -1
                                 : leading_number(std::string_view(q->note).substr(at + words.size())).value_or(0);
}

double universal_error(const ParameterSet& set) {
  return value_or_none(find_quantity(set, "contact.line.universal.error"));
}

double registry_deviation(const ParameterSet& set) {
  return value_or_none(find_quantity(set, "contact.line.registry"));
}

}  // namespace ropewalk
