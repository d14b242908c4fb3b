// Two parallel tubes at the distance of their energy minimum: one slides along the other, or is pulled off it.
//
// Sliding, atoms: frozen tubes in a periodic cell, energy against the axial shift for several turns. Their energy
// has the lattice's period; the model's rows should be smooth. Pull-out, atoms: finite tubes, energy against the
// length of their overlap, whose slope is the cohesion per length and the force of pulling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cases/common/tube_curve.hpp"
#include "cases/common/tube_pair.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk::validate::pair_sliding {
namespace {

// Fixed beforehand.
constexpr double energy_tolerance = 0.03;       // registry
constexpr double smoothness_tolerance = 0.001;  // relative to the well; far below the corrugation of atoms
constexpr int turns = 4, shifts = 24;
constexpr double cell = 1.2;           // nm, least length
constexpr double longest_slide = 0.5;  // nm: the period of chiral tubes is longer
constexpr int registry_count = 12;
constexpr double free_length = 8;        // free length of the tubes that are pulled, nm
constexpr double registry_shift = 0.25;  // nm: the period of armchair tubes
constexpr double first_overlap = 0.5, overlap_step = 0.5, max_overlap = 7.5;
constexpr double fit_from = 2, fit_to = 6;  // nm: without the influence of the ends

double rest_distance(const MdSession& session, const TubeShape& shape) {
  const Shell shell{shape.radius, 2 / (2 * units::pi * shape.radius * shape.length_per_hexagon)};
  return calibrate::parallel_well(session.atom_law(), shell, shell).distance;
}

ReferenceTable make_sliding(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.relaxed().shape;
  const double period = period_of(c, shape), range = std::min(period, longest_slide),
               distance = rest_distance(session, shape);
  const long periods = static_cast<long>(std::ceil(cell / period)), hexagons = periods * period_hexagons(c);
  const auto rows = slid_pairs(session, "sliding", c, shape, {hexagons, distance, range, turns, shifts});
  ReferenceTable t =
      session.table(fmt::format("Energy of two frozen parallel {} tubes against axial shift", tube_name(set)),
                    "pair-sliding", true, {"turn_i", "turn_j", "distance_nm", "shift_nm", "energy_eV_per_nm"});
  for (const std::vector<double>& row : rows) t.rows.push_back({row[0], row[1], distance, row[2], row[3]});
  return t;
}

// The last one is the whole length: ends flush.
std::vector<double> overlaps(double length) {
  std::vector<double> list;
  for (double x = first_overlap; x < max_overlap + 0.1 * overlap_step; x += overlap_step) list.push_back(x);
  list.push_back(length);
  return list;
}

ReferenceTable make_pull_out(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.rest_shape();
  const long hexagons = hexagons_in(c, shape, free_length);
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon,
               turn = 2 * units::pi / static_cast<double>(row_hexagons(c));
  const double distance = rest_distance(session, shape);
  std::string input = "# frozen finite tubes at several overlaps, for several registries\n";
  const std::vector<double> list = overlaps(length);
  int number = 0;
  for (const Registry& r : registries(registry_count)) {
    const std::string data = fmt::format("pull-out-{}.data", number++);
    session.write(data, data_file({tube_atoms(c, shape, hexagons, turn * r.turn_i),
                                   tube_atoms(c, shape, hexagons, turn * r.turn_j)},
                                  4, -1, length + 1, session.potential().honeycomb));
    input += pair_commands(session, "s s s", data) + move_two({distance, 0, 0});
    double last = length;
    for (const double overlap : list) {
      // Whole steps of overlap meet only a few shifts of the lattice, so that each registry adds a shift of its
      // own.
      const double now = overlap + (overlap < length ? (r.shift_j - 0.5) * registry_shift : 0);
      input += move_two({0, 0, last - now}) + print_values("pull-out", "$(pe:%.15g)");
      last = now;
    }
  }
  const std::size_t count = list.size();
  const auto results = session.run("pull-out", input, count * registry_count, 1);
  ReferenceTable t = session.table(
      fmt::format("Energy of two frozen finite parallel {} tubes against their overlap", tube_name(set)),
      "pair-sliding", true, {"overlap_nm", "energy_eV", "registry_deviation_eV", "distance_nm", "length_nm"});
  t.add("registries", fmt::format("{}, averaged at each overlap", registry_count));
  for (std::size_t k = 0; k < count; ++k) {
    const Spread energy = spread_over(registry_count, [&](std::size_t r) { return results[r * count + k][0]; });
    t.rows.push_back({list[k], energy.mean, energy.deviation, distance, length});
  }
  return t;
}

// Energy of the shifts of one pair of turns.
using Slide = std::vector<double>;

double width(const Slide& energy) {
  const auto [least, most] = std::minmax_element(energy.begin(), energy.end());
  return *most - *least;
}

// Largest slope between neighbouring shifts.
double largest_force(const Slide& energy, double step) {
  double most = 0;
  for (std::size_t k = 1; k < energy.size(); ++k) most = std::max(most, std::abs(energy[k] - energy[k - 1]) / step);
  return most;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

void add_sliding(const ReferenceTable& data, const LineContact& contact, CaseResult& result) {
  std::map<std::pair<double, double>, Slide> slides;
  for (const std::vector<double>& row : data.rows) slides[{row[0], row[1]}].push_back(row[4]);
  const double distance = data.rows.front()[2], step = data.rows[1][3] - data.rows[0][3];
  const double atoms_mean = mean(data.column("energy_eV_per_nm"));
  Slide rough = slides.begin()->second, smooth = rough;
  double force = 0, widths = 0;
  for (const auto& [turn, slide] : slides) {
    if (width(slide) > width(rough)) rough = slide;
    if (width(slide) < width(smooth)) smooth = slide;
    force = std::max(force, largest_force(slide, step));
    widths += width(slide) / static_cast<double>(slides.size());
  }
  Slide rows;  // along one element, the only period that the model can have
  constexpr int points = 64;
  for (int k = 0; k <= points; ++k) rows.push_back(parallel_rows(contact, distance, contact.length_j * k / points));
  result.check_relative("energy per length at rest", mean(rows), atoms_mean, energy_tolerance, "eV/nm",
                        "mean over turns and shifts");
  result.check_absolute("corrugation of the rows over the well", width(rows) / std::abs(mean(rows)), 0,
                        smoothness_tolerance, "1", "highest minus lowest energy of the model along one element");
  result.show_absolute("corrugation of the atoms over the well: mean over turns", 0, widths / std::abs(atoms_mean),
                       0, "1", "the model has none");
  result.show_absolute("corrugation of the atoms over the well: worst turn", 0, width(rough) / std::abs(atoms_mean),
                       0, "1", "the model has none");
  result.show_absolute("largest sliding force of the atoms per length", 0, 1000 * force * units::eV_in_nN_nm, 0,
                       "pN/nm", "at zero temperature, for rigid tubes in registry over the whole length");
  const auto line_of = [&](const std::string& name, const Slide& slide, int colour) {
    ChartLine line{name, {}, {}, colour};
    for (std::size_t k = 0; k < slide.size(); ++k) {
      line.x.push_back(step * static_cast<double>(k));
      line.y.push_back(1000 * (slide[k] - mean(slide)));
    }
    return line;
  };
  ChartLine flat{"model", {}, {}, 2};
  for (int k = 0; k < shifts; ++k) {
    flat.x.push_back(step * k);
    flat.y.push_back(1000 * (parallel_rows(contact, distance, step * k) - mean(rows)));
  }
  result.figure("Energy of two parallel tubes against axial shift", {"axial shift", "nm"},
                {"energy minus its mean", "meV/nm"},
                "One period of the lattice, or half a nanometre of a longer one. Atoms resist sliding "
                "weakly, and how much depends on how "
                "the tubes are turned; rows of elements slide freely.",
                {line_of("atoms, roughest turn", rough, 0), line_of("atoms, smoothest turn", smooth, 1), flat});
}

struct Straight {
  double slope = 0, at_zero = 0;
};
Straight fit_straight(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (x[k] < fit_from - 1e-9 || x[k] > fit_to + 1e-9) continue;
    n += 1;
    sx += x[k];
    sy += y[k];
    sxx += x[k] * x[k];
    sxy += x[k] * y[k];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {slope, (sy - slope * sx) / n};
}

// What the law of endless tubes costs where two ends lie side by side, by theory: the energies w(z) per square of
// length of two rings of parallel shells, z apart along the axes, and of two points of their axes have the same
// integral over z, but the second is wider. Two tubes that end at the same height, one of them drawn back by s,
// have
//   energy of the model - energy of shells = int_s^inf (t - s) (w_shells(t) - w_model(t)) dt.
struct FlushEnds {
  double energy = 0;  // energy at s = 0, eV
  double force = 0;   // eV/nm, the largest one by s
};
FlushEnds flush_ends(const ParameterSet& set, double distance) {
  const LineDensity& density = set.law<LineParameters>()->density;
  const UniversalLine& atoms = set.law<LineParameters>()->universal;
  const double cutoff = atoms.lj_cutoff > 0 ? atoms.lj_cutoff : density.cutoff();
  const AtomLaw law{atoms.epsilon, atoms.sigma, cutoff};
  constexpr int angles = 240;
  constexpr double step = 0.01;  // nm
  const auto rings = [&](double z) {
    double sum = 0;
    for (int k = 0; k < angles; ++k) {
      const double a = 2 * units::pi * (k + 0.5) / angles, x = distance - set.radius * std::cos(a);
      if (x - set.radius > cutoff) continue;
      for (int l = 0; l < angles; ++l) {
        const double b = 2 * units::pi * (l + 0.5) / angles;
        const double rho = std::hypot(x + set.radius * std::cos(b), set.radius * (std::sin(b) - std::sin(a)), z);
        if (rho < cutoff) sum += law.energy(rho);
      }
    }
    const double per_point = 2 * units::pi * set.radius / angles * set.law<LineParameters>()->surface_density;
    return sum * per_point * per_point;
  };
  FlushEnds out;
  double slope = 0;
  for (double z = std::max(cutoff, density.cutoff()) - 0.5 * step; z > 0; z -= step) {
    slope += step * (rings(z) - density.energy(std::hypot(distance, z)));
    out.energy += step * slope;
    out.force = std::max(out.force, std::fabs(slope));
  }
  return out;
}

void add_pull_out(const ReferenceTable& data, const CaseTube& tube, CaseResult& result) {
  const ParameterSet& set = tube.model;
  const double length = data.column("length_nm").front(), distance = data.column("distance_nm").front();
  ElementRow i, j;
  i.elements = j.elements = static_cast<int>(std::lround(length / set.element_length));
  const LineContact contact = contact_of(set, set, length / i.elements);
  const std::vector<double> overlap = data.column("overlap_nm"), atoms = data.column("energy_eV");
  std::vector<double> model, residual;
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    j.centre = {distance, 0, length - overlap[k]};
    model.push_back(row_contact(contact, i, j).energy);
    residual.push_back(100 * (model[k] / atoms[k] - 1));
  }
  const double flush = model.back() - atoms.back();
  const Straight of_atoms = fit_straight(overlap, atoms), of_model = fit_straight(overlap, model);
  result.check_relative("pull-out: energy per overlap", of_model.slope, of_atoms.slope, energy_tolerance, "eV/nm",
                        "slope from 2 to 6 nm of overlap: the pulling force");
  result.show_relative("pull-out: force", -1000 * of_model.slope * units::eV_in_nN_nm,
                       -1000 * of_atoms.slope * units::eV_in_nN_nm, energy_tolerance, "pN",
                       "the same, in piconewton");
  result.show_absolute("pull-out: energy of both ends", of_model.at_zero, of_atoms.at_zero, 0.01, "eV",
                       "the straight line at zero overlap; the theory of shells has no ends");
  result.show_absolute("ends flush: energy of the model above that of the atoms", flush, 0, 0.01, "eV",
                       "two pairs of ends side by side, whatever the length of the tubes");
  const FlushEnds theory = flush_ends(tube.set, distance);
  result.check_absolute("ends flush: the same, by surface integrals of shells", flush, 2 * theory.energy, 0.03,
                        "eV", "registry");
  result.show_absolute("ends flush: largest force that the model lacks", 0,
                       1000 * theory.force * units::eV_in_nN_nm, 0, "pN",
                       "of two ends, by the same integrals, within half a nanometre");
  LineChart chart;
  chart.title = "Energy of two finite tubes against overlap";
  chart.x = {"overlap", "nm"};
  chart.y = {"energy", "eV"};
  ChartLine points{"atoms (LAMMPS)", overlap, atoms, 0};
  points.points = true;
  chart.lines = {{"model", overlap, model, 1}, points};
  chart.bands = {{fit_from, fit_to, "slope", false}};
  result.figures.push_back(
      {chart, "The line is straight: the force that pulls one tube out does not depend on the overlap."});
  LineChart rest = chart;
  rest.title = "Residual of the pull-out energy";
  rest.y = {"model against atoms", "%"};
  rest.height = 200;
  rest.lines = {{"model / atoms - 1", overlap, residual, 0}};
  result.figures.push_back({rest, "At short overlap the ends count; a row ends half a node beyond the last atom."});
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const CaseTube tube = context.tube();
  const ReferenceTable sliding = reference(
      context, tube.set, "pair-sliding", 0.001, [&] { return make_sliding(context, tube.set); }, result);
  const ReferenceTable pull_out = reference(
      context, tube.set, "pair-pull-out", 0.001, [&] { return make_pull_out(context, tube.set); }, result);
  add_sliding(sliding, contact_of(tube.model, tube.model, tube.set.element_length), result);
  add_pull_out(pull_out, tube, result);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "pair-sliding";
  c.order = 50;
  c.tables = {"pair-sliding", "pair-pull-out"};
  c.lammps_seconds = [](const ParameterSet& set) { return 0.02 * set.atoms_per_length; };
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  c.stays_green = {wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::pair_sliding
