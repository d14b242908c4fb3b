#include "io/grade.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/parameters_toml.hpp"
#include "io/plain_text.hpp"

namespace ropewalk {
namespace {

constexpr double known_well = 0.01;          // relative error of a good stiffness, and of a good contact
constexpr double unknown = 0.5;              // relative error of a stiffness that is not known
constexpr double collapsing_diameter = 4.2;  // nm

constexpr double thin_shell = 0.1;  // EI from EA r^2/2, relative: calibrated tubes agree to 0.04

using Level = Grade::Level;

void add(Grade& grade, Level level, std::string reason) {
  grade.level = std::max(grade.level, level);
  grade.reasons.push_back(std::move(reason));
}

void grade_stiffness(const ParameterSet& set, Grade& grade) {
  for (const char* key : {"EA", "EI", "GJ"}) {
    const Quantity* q = find_quantity(set, std::string("bond.") + key);
    if (!q || (q->standard_error && *q->standard_error <= known_well * q->value)) continue;
    if (!q->standard_error) {
      if (q->origin == "calibrated") add(grade, Level::limited, fmt::format("{} has no standard error", key));
      continue;
    }
    const double error = *q->standard_error / q->value;
    add(grade, error > unknown ? Level::unfit : Level::limited,
        fmt::format("{} is known to {:.2g} %", key, 100 * error));
  }
}

// Carbon in any potential has 250 to 355 N/m; 23, the ratio of two units of energy, lies far outside.
void grade_wall(const ParameterSet& set, Grade& grade) {
  const double wall = wall_stiffness(set);
  if (wall >= softest_wall && wall <= stiffest_wall) return;
  add(grade, Level::unfit,
      fmt::format(
          "EA/(2 pi r) is {:.4g} N/m, and a wall of carbon has {:.0f} to {:.0f}: is a unit of the potential "
          "or of the set wrong?",
          wall, softest_wall, stiffest_wall));
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
  if (!set.line) {
    add(grade, Level::limited, "its contact was not compared with the surface integral between two tubes");
    return;
  }
  const LineParameters& line = *set.line;
  agree(line_parallel_well(line.density).energy, line.pair_energy, "K, s, c, p and q give two parallel tubes",
        "eV/nm, and pair_energy is", grade);
  agree(line_crossed_well(line.density, 0.5 * units::pi).energy, line.cross90_energy,
        "K, s, c, p and q give two crossed tubes", "eV, and cross90_energy is", grade);
  agree(set.atoms_per_length / (2 * units::pi * set.radius), line.surface_density,
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
  else if (!set.line->has_universal)
    add(grade, Level::limited, "not to be mixed with other tubes: it has no universal contact law");
}

double value_or_none(const Quantity* q) { return q ? q->value : -1; }

}  // namespace

std::string Grade::words() const {
  if (level == Level::good) return "good";
  return fmt::format("{}: {}", level == Level::limited ? "limited" : "unfit", fmt::join(reasons, "; "));
}

Grade grade_of(const ParameterSet& set) {
  Grade grade;
  grade_stiffness(set, grade);
  grade_wall(set, grade);
  grade_width(set, grade);
  grade_contact(set, grade);
  return grade;
}

double wall_stiffness(const ParameterSet& set) {
  return set.bond.stretch * units::eV_in_nN_nm / (2 * units::pi * set.radius);
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
