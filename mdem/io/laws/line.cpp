// The numbers of the contact law `line`:
//
//   [contact.line]    present: the set has the `line` law; epsilon (eV), sigma (nm), lj_cutoff (nm, 0: none) and
//               surface_density (1/nm^2) that it was integrated from; K (eV/nm^2), s (nm), c (nm), p, q, core_gap,
//               switch_gap, cutoff_gap (nm) of contact/line.hpp; pair_spacing (nm), pair_energy (eV/nm) and
//               cross90_energy (eV) of that law; optional: registry, the standard deviation of pair_energy over the
//               registries of two real tubes, over its mean; cutoff_loss, the part of the well that lj_cutoff leaves out. A filament has no atoms to integrate over: epsilon,
//               sigma, lj_cutoff, surface_density, registry and [contact.line.universal] are not in its file.
//   [contact.line.universal]  the same law for any pair of radii: log_K, s, c, p, q, each
//               { values = [6 numbers], standard_errors = [6 numbers] }, and error
#include "io/laws/line.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/law_numbers.hpp"
#include "io/rows_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/units.hpp"

namespace ropewalk {

void read_universal_rows(const TomlTable& t, UniversalLine& u) {
  UniversalLine::Errors& e = u.standard_errors;
  read_row(t, "log_K", u.log_K, e.log_K);
  read_row(t, "s", u.s, e.s);
  read_row(t, "c", u.c, e.c);
  read_row(t, "p", u.p, e.p);
  read_row(t, "q", u.q, e.q);
}

std::string universal_rows_text(const UniversalLine& u) {
  const UniversalLine::Errors& e = u.standard_errors;
  return row_text("log_K", u.log_K, e.log_K) + row_text("s", u.s, e.s) + row_text("c", u.c, e.c) +
         row_text("p", u.p, e.p) + row_text("q", u.q, e.q);
}

namespace {

void refuse_atoms_of_contact(const TomlTable& t) {
  for (const char* key : {"epsilon", "sigma", "lj_cutoff", "surface_density", "registry", "universal"})
    if (t.has(key))
      throw t.error(key, "is of the atoms of a carbon tube, and the set has [filament]",
                    "take it away: K, s, c, p and q are the contact of two filaments");
}

// A filament's well is held to its law here, since nothing else in the set says how deep it is.
void check_wells(const TomlTable& t, const LineParameters& line) {
  const LineWell well = line_parallel_well(line.density);
  const LineWell crossed = line_crossed_well(line.density, 0.5 * units::pi);
  const auto agree = [&](const char* key, double said, double law, const char* unit) {
    if (std::fabs(said - law) <= 0.01 * std::fabs(law)) return;
    throw t.error(key, fmt::format("is {:.6g} {}", said, unit),
                  fmt::format("K, s, c, p and q give {:.6g}: correct one or the other", law));
  };
  agree("pair_spacing", line.pair_spacing, well.distance, "nm");
  agree("pair_energy", line.pair_energy, well.energy, "eV/nm");
  agree("cross90_energy", line.cross90_energy, crossed.energy, "eV");
}

void check_line(const TomlTable& t, const LineDensity& d) {
  if (d.p <= d.q)
    throw t.error("p", fmt::format("is {}, not above q = {}", d.p, d.q),
                  "repulsion must be the steeper of the two");
  if (d.core_gap + d.c <= 0)
    throw t.error("core_gap", fmt::format("is {} nm, where the law has its pole at {:.4g} nm", d.core_gap, -d.c),
                  "the core must begin outside of it");
  // The minimum of u is at (s/(h + c))^(p - q) = q/p.
  const double lowest = d.s * std::pow(d.p / d.q, 1 / (d.p - d.q)) - d.c;
  if (lowest <= d.core_gap)
    throw t.error("core_gap", fmt::format("is {} nm", d.core_gap),
                  fmt::format("must be below {:.4g}, where the contact is strongest", lowest));
  if (lowest >= d.switch_gap)
    throw t.error("switch_gap", fmt::format("is {} nm", d.switch_gap),
                  fmt::format("must be above {:.4g}, where the contact is strongest", lowest));
  if (d.cutoff_gap <= d.switch_gap)
    throw t.error("cutoff_gap", fmt::format("is {} nm, not above switch_gap = {}", d.cutoff_gap, d.switch_gap),
                  "the switch needs room to fall to zero");
}

void read_universal(const LawTable& law, LineParameters& line) {
  const TomlTable t = law.table.table("universal");
  line.has_universal = true;
  read_universal_rows(t, line.universal);
  law.number_in(t, "error", "1", Bounds::non_negative(1e6));
}

LineParameters read_line(const LawTable& law) {
  const TomlTable& t = law.table;
  LineParameters line;
  LineDensity& d = line.density;
  UniversalLine& u = line.universal;
  if (law.set.filament) {
    refuse_atoms_of_contact(t);
  } else {
    u.epsilon = law.number("epsilon", "eV", Bounds::positive(10));
    u.sigma = law.number("sigma", "nm", Bounds::positive(10));
    u.lj_cutoff = law.number("lj_cutoff", "nm", Bounds::non_negative(100));
    line.surface_density = law.number("surface_density", "1/nm^2", Bounds::positive(1e3));
  }
  d.contact = 2 * law.set.radius;
  d.K = law.number("K", "eV/nm^2", Bounds::positive(1e9));
  d.s = law.number("s", "nm", Bounds::positive(100));
  d.c = law.number("c", "nm", Bounds::range(-100, 100));
  d.p = law.number("p", "1", Bounds::positive(100));
  d.q = law.number("q", "1", Bounds::positive(100));
  u.core_gap = d.core_gap = law.number("core_gap", "nm", Bounds::range(-100, 100));
  u.switch_gap = d.switch_gap = law.number("switch_gap", "nm", Bounds::positive(100));
  u.cutoff_gap = d.cutoff_gap = law.number("cutoff_gap", "nm", Bounds::positive(100));
  line.pair_spacing = law.number("pair_spacing", "nm", Bounds::positive(1e3));
  line.pair_energy = law.number("pair_energy", "eV/nm", Bounds::range(-1e6, 0));
  line.cross90_energy = law.number("cross90_energy", "eV", Bounds::range(-1e6, 0));
  if (t.has("cutoff_loss")) law.number("cutoff_loss", "1", Bounds::range(-1, 1));
  if (t.has("registry")) law.number("registry", "1", Bounds::range(0, 1));
  check_line(t, d);
  if (law.set.filament) check_wells(t, line);
  if (t.has("universal")) read_universal(law, line);
  return line;
}

std::string rows_of(const std::any& numbers, const std::string& section) {
  if (section != "contact.line.universal") return "";
  return universal_rows_text(std::any_cast<const LineParameters&>(numbers).universal);
}

}  // namespace

LawNumbers line_numbers() { return {LineParameters::law, read_line, rows_of}; }

}  // namespace ropewalk
