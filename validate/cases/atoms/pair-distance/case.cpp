// Energy of two parallel tubes against their distance.
//
// Atoms: frozen relaxed tubes in a periodic cell, Lennard-Jones between them, averaged over registries. Model: two
// rows of elements with the `line` law; the `paper` law is shown for comparison.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "cases/common/tube_curve.hpp"
#include "cases/common/tube_pair.hpp"
#include "model/contact/paper.hpp"

namespace ropewalk::validate::pair_distance {
namespace {

// Fixed beforehand: registry changes the well by 1 to 3 %, and a shell without atoms has none.
constexpr double spacing_tolerance = 0.005, depth_tolerance = 0.03;
constexpr int registry_count = 16;
constexpr double piece = 1.2;       // nm, least length of the piece of one tube beside the other
constexpr double fit_reach = 0.03;  // nm about the minimum

std::vector<double> gaps() {
  std::vector<double> list;
  for (int k = 0; k <= 22; ++k) list.push_back(0.25 + 0.01 * k);
  for (int k = 1; k <= 10; ++k) list.push_back(0.47 + 0.05 * k);
  list.push_back(1.1);
  return list;
}

// A piece of i, of whole periods, beside a j that reaches beyond it by more than the cutoff: tubes of different
// periods need no common one.
ReferenceTable make_reference(const CaseContext& context, const ParameterSet& i, const ParameterSet& j,
                              const std::string& command) {
  MdSession session(context, i), session_j(context, j);
  const Chirality ci = i.chirality, cj = j.chirality;
  const TubeShape one = session.rest_shape(), two = session_j.rest_shape();
  const long hexagons = period_hexagons(ci) * static_cast<long>(std::ceil(piece / period_of(ci, one)));
  const double length = static_cast<double>(hexagons) * one.length_per_hexagon;
  const double reach = length + 2 * (session.atom_law().cutoff + 0.5);
  const std::vector<double> list = gaps();
  std::string input = "# frozen tubes at many distances, for several registries\n";
  int number = 0;
  for (const Registry& r : registries(registry_count)) {
    const std::string data = fmt::format("distance-{}.data", number++);
    session.write(data, data_file({centred_tube(ci, one, hexagons, r.turn_i, r.shift_i),
                                   centred_tube(cj, two, hexagons_in(cj, two, reach), r.turn_j, r.shift_j)},
                                  4, -reach, reach, session.potential().honeycomb));
    input += pair_commands(session, "s s s", data);
    double last = 0;
    for (const double gap : list) {
      const double distance = one.radius + two.radius + gap;
      input += move_two({distance - last, 0, 0}) + print_values("distance", "$(pe:%.15g)");
      last = distance;
    }
  }
  const auto results = session.run("distance", input, list.size() * registry_count, 1);
  ReferenceTable t = session.table(
      fmt::format("Energy of two frozen parallel tubes {} and {} against distance", tube_name(i), tube_name(j)),
      command, true, {"distance_nm", "energy_eV_per_nm", "registry_deviation_eV_per_nm"});
  t.add("registries", fmt::format("{}, averaged at each distance", registry_count));
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Spread energy =
        spread_over(registry_count, [&](std::size_t r) { return results[r * list.size() + k][0] / length; });
    t.rows.push_back({one.radius + two.radius + list[k], energy.mean, energy.deviation});
  }
  return t;
}

struct PairCurve {
  std::string name;
  std::vector<double> distance, atoms, deviation;
  std::function<double(double)> model;
};

PairCurve curve_of(const CaseTube& i, const CaseTube& j, const CaseContext& context, CaseResult& result) {
  const std::string name = "pair-distance" + (i.set.name == j.set.name ? "" : "-with-" + leaf_of_name(j.set));
  const ReferenceTable data = reference(
      context, i.set, name, 0.001, [&] { return make_reference(context, i.set, j.set, "pair-distance"); }, result);
  PairCurve c;
  c.name = i.name + "-" + j.name;
  c.distance = data.column("distance_nm");
  c.atoms = data.column("energy_eV_per_nm");
  c.deviation = data.column("registry_deviation_eV_per_nm");
  c.model = [contact = contact_of(i.model, j.model, i.set.element_length)](double distance) {
    return parallel_rows(contact, distance);
  };
  return c;
}

void add_checks(const PairCurve& c, const LineWell& atoms, CaseResult& result) {
  const LineWell model = detail::lowest_point(c.model, c.distance.front(), c.distance.back());
  result.check_relative(c.name + ": spacing", model.distance, atoms.distance, spacing_tolerance, "nm",
                        "the distance of lowest energy");
  result.check_relative(c.name + ": cohesion at rest", model.energy, atoms.energy, depth_tolerance, "eV/nm",
                        "registry changes it by 1 to 3 %");
  double registry = 0;
  for (std::size_t k = 0; k < c.distance.size(); ++k)
    if (std::abs(c.distance[k] - atoms.distance) < 0.006) registry = c.deviation[k] / std::abs(atoms.energy);
  result.show_absolute(c.name + ": standard deviation over registries at the minimum, over the well", 0, registry,
                       0, "1", "how far one placement of the atoms is from the mean; the model has no registry");
}

CaseFigure energy_figure(const std::vector<PairCurve>& curves) {
  CaseFigure figure =
      case_figure("Energy of two parallel tubes against distance", {"distance of the axes", "nm"},
                  {"energy per length", "eV/nm"},
                  "Points: atoms, mean over registries. Lines: rows of elements with the line law.");
  int colour = 0;
  for (const PairCurve& c : curves) {
    ChartLine model{c.name + " model", {}, {}, colour};
    ChartLine atoms{c.name + " atoms", c.distance, c.atoms, colour++};
    atoms.points = true;
    for (double x = c.distance.front(); x < c.distance.back(); x += 0.004) {
      model.x.push_back(x);
      model.y.push_back(c.model(x));
    }
    for (ChartLine* line : {&model, &atoms})  // energies above zero would flatten the wells
      for (double& y : line->y)
        if (y > 0.6) y = std::nan("");
    figure.chart.lines.push_back(model);
    figure.chart.lines.push_back(atoms);
  }
  return figure;
}

// The published law beside the atoms of its tube: binds about twice as strongly.
void add_published(const ParameterSet& published, const LineWell& atoms, LineChart& chart, CaseResult& result) {
  const auto paper = [&](double distance) {
    return paper_parallel_energy(*published.law<PaperContact>(), published.element_length, distance);
  };
  const LineWell well = detail::lowest_point(paper, 1.6, 2.6);
  result.show_relative("(10,10) paper law: cohesion over that of the atoms", well.energy / atoms.energy, 1,
                       depth_tolerance, "1", "the published law binds about twice as strongly");
  ChartLine line{"(10,10)-(10,10) paper law", {}, {}, static_cast<int>(chart.lines.size() / 2)};
  line.dashed = true;
  for (double x = 1.6; x < 2.6; x += 0.004) {
    const double y = paper(x);
    line.x.push_back(x);
    line.y.push_back(y > 0.6 ? std::nan("") : y);
  }
  chart.lines.push_back(line);
}

CaseFigure residual_figure(const std::vector<PairCurve>& curves, const std::vector<LineWell>& wells) {
  CaseFigure figure =
      case_figure("Residual of the energy of two parallel tubes", {"distance minus the atoms' spacing", "nm"},
                  {"model minus atoms, over the well", "%"},
                  "In percent of the well. On the repulsive wall a small difference of the spacing gives a large "
                  "difference of the energy.");
  figure.chart.height = 220;
  for (std::size_t p = 0; p < curves.size(); ++p) {
    ChartLine line{curves[p].name, {}, {}, static_cast<int>(p)};
    for (std::size_t k = 0; k < curves[p].distance.size(); ++k) {
      const double off = curves[p].distance[k] - wells[p].distance;
      if (off < -0.03) continue;
      line.x.push_back(off);
      line.y.push_back(100 * (curves[p].model(curves[p].distance[k]) - curves[p].atoms[k]) /
                       std::abs(wells[p].energy));
    }
    figure.chart.lines.push_back(line);
  }
  return figure;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  std::vector<CaseTube> tubes = context.tubes();
  if (!context.given) tubes.pop_back();  // the published set
  std::vector<PairCurve> curves;
  std::vector<LineWell> wells;
  for (std::size_t i = 0; i < tubes.size(); ++i)
    for (std::size_t j = i; j < tubes.size(); ++j) {
      curves.push_back(curve_of(tubes[i], tubes[j], context, result));
      wells.push_back(lowest_of(curves.back().distance, curves.back().atoms, fit_reach));
      add_checks(curves.back(), wells.back(), result);
    }
  result.figures.push_back(energy_figure(curves));
  if (!context.given)
    add_published(context.model(context.sets.size() - 1), wells[0], result.figures.back().chart, result);
  result.figures.push_back(residual_figure(curves, wells));
  if (tubes.size() > 1) result.remarks.push_back("Tubes of two kinds use the law for all pairs of radii.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "pair-distance";
  c.order = 40;
  c.sets = {"cnt-10-10-tersoff", "cnt-5-5-tersoff", "cnt-10-10-paper"};
  c.takes_two = true;
  c.tables = {"pair-distance"};
  c.lammps_seconds = [](const ParameterSet& set) { return 0.02 * set.atoms_per_length; };
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  c.stays_green = {wrong_EA(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::pair_distance
