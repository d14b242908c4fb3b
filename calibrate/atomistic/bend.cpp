// Bending of finite tubes: both end bands are held on the bent shape, the rest is relaxed.
//
// The affine bend of curvature k takes the straight tube along z to a circular arc about the point x = 1/k; every
// cross-section stays plane and normal to the axis, whose length is kept:
//   x' = (1 - cos kz)/k + x cos kz,   y' = y,   z' = sin(kz)/k - x sin kz.
// A grip moved in any other way would store shear that has nothing to do with bending.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atomistic/finite_tube.hpp"
#include "atomistic/runs.hpp"

namespace ropewalk::calibrate {
namespace {

// Relaxed displacements grow in proportion to the curvature, so the next start is the next affine bend with the
// last displacements scaled: half of the steps of the minimiser are saved.
std::string bend_commands(double curvature, double last, const std::string& results) {
  std::string text = fmt::format("variable k0 delete\nvariable k0 equal {:.12g}\n", last * angstrom);
  text += fmt::format("variable k delete\nvariable k equal {:.12g}\n", curvature * angstrom);
  text += last == 0 ? "set group all x v_bent_x z v_bent_z\n" : "set group all x v_next_x y v_next_y z v_next_z\n";
  text += "minimize 0.0 ${ftol} 2000 20000\n";
  return text + results;
}

}  // namespace

long extra_hexagons(Chirality c, const TubeShape& shape, double length) {
  const long step = std::gcd(c.n, c.m), middle = hexagons_in(c, shape, length);
  if (step > 2) return middle;
  long best = middle;
  double least = 1e9;
  for (long extra = step * (middle * 4 / 5 / step); extra <= middle * 6 / 5; extra += step) {
    if (extra <= 0) continue;
    const double turned = 2 * units::pi * period_turns(c, vector_of_height(c, extra)) +
                          shape.twist * static_cast<double>(extra) * shape.length_per_hexagon;
    const double unlike = step == 2 ? std::sin(turned) : 2 * std::sin(0.5 * turned);
    const double cost =
        std::abs(unlike) + 0.1 * std::abs(static_cast<double>(extra - middle)) / static_cast<double>(middle);
    if (cost < least) {
      least = cost;
      best = extra;
    }
  }
  return best;
}

std::vector<AtomisticRow> bend_rows(RunContext& run, const RelaxedTube& tube, const BendSeries& series) {
  const long short_part = hexagons_in(run.c, tube.shape, series.short_length);
  const double additional = series.long_length - series.short_length;
  std::vector<std::pair<const char*, long>> specimens = {{"-short", 0}};
  if (series.middle) specimens.emplace_back("-middle", extra_hexagons(run.c, tube.shape, 0.5 * additional));
  specimens.emplace_back("-long", extra_hexagons(run.c, tube.shape, additional));
  // The energy of an end goes as k cos phi and k^2 cos 2 phi with its azimuth phi to the plane of bending. No
  // choice of lengths takes this out of a tube with a natural twist, whose ends turn along it, but the mean over
  // planes does: two at right angles for a tube with a twofold axis, four for one without an axis of symmetry.
  const long axis = std::gcd(run.c.n, run.c.m);
  const int planes = !series.middle || axis > 2 ? 1 : axis == 2 ? 2 : 4;
  const std::string results =
      fmt::format("print \"$(pe:%.15g) $(fnorm:%.6g)\" append {}.dat screen no\n", series.name);
  std::string input = "# finite tubes of several lengths, bent step by step\n";
  std::vector<AtomisticRow> rows;
  for (int plane = 0; plane < planes; ++plane)
    for (const auto& [ending, extra] : specimens) {
      const std::string kind = series.name + ending;
      const FiniteTube finite(run.c, tube.shape, short_part + extra, held_band(run.potential));
      if (plane == 0) write_data(run, kind + ".data", finite.data(run.potential.honeycomb));
      input += finite.commands(run.potential, kind + ".data", 0.5 * units::pi * plane) +
               "variable ftol equal 1e-3\n" + affine_bend_variables() + "minimize 0.0 ${ftol} 2000 20000\n" +
               results;
      AtomisticRow row;
      row.kind = kind;
      row.twist = tube.shape.twist;
      row.length = finite.free_length();
      row.atoms = static_cast<int>(finite.atoms().size());
      if (plane == 0) rows.push_back(row);
      double last = 0;
      for (const double curvature : series.curvatures) {
        row.curvature = curvature;
        input += bend_commands(row.curvature, last, results);
        last = row.curvature;
        if (plane == 0) rows.push_back(row);
      }
    }
  run_stage(run, series.name, input);
  const std::size_t all = rows.size() * static_cast<std::size_t>(planes);
  const auto found = read_results(run.folder, series.name, all, all, 2);
  for (int plane = 0; plane < planes; ++plane) {
    double straight = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<double>& at = found[static_cast<std::size_t>(plane) * rows.size() + i];
      if (rows[i].curvature == 0) straight = at[0];
      rows[i].energy += (at[0] - straight) / planes;
      if (rows[i].curvature > 0) check_convergence(run, rows[i].kind, at[1] / angstrom, at[0] - straight);
    }
  }
  return rows;
}

}  // namespace ropewalk::calibrate
