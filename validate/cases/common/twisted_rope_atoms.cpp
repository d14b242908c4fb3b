// The twisted rope of atoms: places of the atoms, LAMMPS input and results.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "atomistic/runs.hpp"
#include "atoms/relax_atoms.hpp"
#include "atoms/tube_reference.hpp"
#include "cases/common/lammps_session.hpp"
#include "cases/common/twisted_rope.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "scene/lattice.hpp"

namespace ropewalk::validate {
namespace {

constexpr int tubes = 7;
constexpr double golden = 0.6180339887498949;  // step of the additive sequence that spreads the registries

double part(double x) { return x - std::floor(x); }

// Fractions of the symmetries of a tube: turns and rows.
double turn_of(int tube, Chirality c) {
  return part(tube * golden) * 2 * units::pi / static_cast<double>(row_hexagons(c));
}
double shift_of(int tube, double row) { return (part(tube * golden * golden * golden) - 0.5) * row; }

// The grip's atoms move along the axis together: each feels the mean force.
std::string hold_text(bool axial_free) {
  if (!axial_free) return "fix hold held setforce 0.0 0.0 0.0\n";
  return "fix hold below setforce 0.0 0.0 0.0\n"
         "fix ride above setforce 0.0 0.0 NULL\n"
         "fix together above aveforce NULL NULL 0.0\n";
}

std::string release_text(bool axial_free) {
  return axial_free ? "unfix hold\nunfix ride\nunfix together\n" : "unfix hold\n";
}

// The interior is turned evenly with the grips before it is relaxed. The moment needs the forces on held atoms, so
// that the fixes which hold them are removed while it is read.
std::string increments_text(const std::vector<double>& angles, double length, const std::string& results,
                            bool axial_free) {
  const std::string minimise = hold_text(axial_free) + "minimize 0.0 5.0e-3 3000 6000\n";
  const std::string report =
      release_text(axial_free) +
      "run 0 post no\nprint \"$(pe) $(c_lj) $(v_moment/10) $(v_pull) $(v_rise/10)\" append " + results +
      ".dat screen no\n";
  std::string text = fmt::format("variable part atom f_ref[3]/{:.12f}\n", length / angstrom) + minimise + report;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double step = angles[k] - angles[k - 1], half = 0.5 * step * units::rad_in_degree;
    text += fmt::format(
        "variable turned atom v_part*{:.15f}\n"
        "variable dx atom x*(cos(v_turned)-1)-y*sin(v_turned)\n"
        "variable dy atom x*sin(v_turned)+y*(cos(v_turned)-1)\n"
        "displace_atoms free move v_dx v_dy 0.0 units box\n"
        "displace_atoms above rotate 0 0 0 0 0 1 {:.12f} units box\n"
        "displace_atoms below rotate 0 0 0 0 0 1 {:.12f} units box\n",
        step, half, -half);
    text += minimise + report;
  }
  return text;
}

std::string input_text(const TwistedRope& rope, const ParameterSet& set, const MdSession& session,
                       const std::vector<RopeTube>& atoms, const std::vector<double>& angles,
                       const std::string& results, bool axial_free) {
  std::string text = header_commands("s s s", 0.05) + "read_data rope.data\n";
  text += rope_pairs(session.potential(), set.law<LineParameters>()->universal) + rope_groups(atoms);
  text +=
      "fix ref all store/state 0 x y z\n"
      "compute lj all pair lj/cut\n"
      "variable torque atom x*fy-y*fx\n"
      "compute twisting above reduce sum v_torque\n"
      "variable moment equal -10*c_twisting\n"
      "variable lift atom z-f_ref[3]\n"
      "compute lifts above reduce ave v_lift\n"
      "variable rise equal c_lifts\n"
      "compute pulls above reduce sum fz\n"
      "variable pull equal -10*c_pulls\n"
      "min_style cg\n"
      "min_modify dmax 0.05 line quadratic\n"
      "thermo_style custom step pe fnorm fmax c_lj c_twisting c_lifts c_pulls\n"
      "thermo 100\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  return text + increments_text(angles, clamped_length(rope, set), results, axial_free);
}

// Mean height (rows of hexagons) of the held atoms whose bonds cross the height `cut`, below it or above it.
double held_height(Chirality c, long rows, long cut, bool below) {
  const long row = row_hexagons(c), thirds = 3 * row * cut;
  double sum = 0;
  long count = 0;
  for (const Site& site : strip_sites(c, rows * row)) {
    if (site.second) continue;
    for (const Site& other :
         {Site{site.i, site.j, true}, Site{site.i - 1, site.j, true}, Site{site.i, site.j - 1, true}}) {
      const long one = height_in_thirds(c, site), two = height_in_thirds(c, other);
      if ((one < thirds) == (two < thirds)) continue;
      sum += static_cast<double>(below ? std::min(one, two) : std::max(one, two));
      ++count;
    }
  }
  return sum / static_cast<double>(3 * row * count);
}

}  // namespace

std::string rope_data(const std::vector<RopeTube>& rope) {
  double half = 0;
  std::vector<std::vector<Vector3>> tubes_of_atoms;
  for (const RopeTube& tube : rope) {
    std::vector<Vector3>& atoms = tubes_of_atoms.emplace_back(tube.below);
    for (const auto* group : {&tube.free, &tube.above}) atoms.insert(atoms.end(), group->begin(), group->end());
    for (const Vector3& atom : atoms) half = std::max(half, atom.cwiseAbs().maxCoeff() + 1);
  }
  return data_file(tubes_of_atoms, half, -half, half);
}

std::string rope_pairs(const Potential& potential, const UniversalLine& law) {
  return pair_lines({potential, law.epsilon, law.sigma, law.lj_cutoff}, tubes);
}

std::string rope_groups(const std::vector<RopeTube>& rope) {
  std::string below = "group below id", above = "group above id";
  std::size_t first = 1;
  for (const RopeTube& tube : rope) {
    below += fmt::format(" {}:{}", first, first + tube.below.size() - 1);
    first += tube.below.size() + tube.free.size();
    above += fmt::format(" {}:{}", first, first + tube.above.size() - 1);
    first += tube.above.size();
  }
  return below + "\n" + above + "\ngroup held union below above\ngroup free subtract all held\n";
}

double row_distance(const ParameterSet& set) {
  return 2.0 * static_cast<double>(row_hexagons(set.chirality)) / set.atoms_per_length;
}

double clamped_length(const TwistedRope& rope, const ParameterSet& set) {
  const long rows = rope.free_rows + 2 * rope.band_rows;
  return row_distance(set) * (held_height(set.chirality, rows, rope.band_rows + rope.free_rows, false) -
                              held_height(set.chirality, rows, rope.band_rows, true));
}

TwistedRope rope_of_length(const std::string& name, double length, const ParameterSet& set) {
  const double row = row_distance(set);
  const auto rows = [&](double nm) { return static_cast<int>(std::lround(nm / row)); };
  return {name, rows(length), rows(1), static_cast<int>(std::lround(length / 0.615))};
}

std::vector<double> angles_of(const TwistedRope& rope, const ParameterSet& set, const CaseContext& context,
                              double shear, int increments) {
  std::vector<double> angles;
  const std::string stored = find_reference(context, set, rope.name);
  if (!stored.empty()) {
    for (const double angle : read_reference(stored).column("angle_rad")) {
      if (!angles.empty() && angle < angles.back()) break;  // the next series
      angles.push_back(angle);
    }
    return angles;
  }
  for (int k = 0; k <= increments; ++k)
    angles.push_back(shear * clamped_length(rope, set) / set.radius * k / increments);
  return angles;
}

std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set, const TubeShape& shape) {
  if (!set.honeycomb.one_species()) throw NotApplicable("its ropes of atoms are built of one species");
  const Chirality c = set.chirality;
  const double row = row_height(c, shape);
  const long rows = rope.free_rows + 2 * rope.band_rows;
  const std::vector<Site> sites = strip_sites(c, rows * row_hexagons(c));
  std::vector<double> heights;
  double middle = 0;
  for (const Site& site : sites) {
    heights.push_back(place(c, site, shape).z());
    middle += heights.back() / static_cast<double>(sites.size());
  }
  std::vector<RopeTube> out;
  for (const auto& [x, y] : hexagonal_lattice(tubes, set.law<LineParameters>()->pair_spacing)) {
    const int t = static_cast<int>(out.size());
    const Eigen::AngleAxisd turn(turn_of(t, c), Vector3::UnitZ());
    const Vector3 shift(x, y, shift_of(t, row));
    RopeTube tube;
    for (const Site& site : sites) {
      const long at = height_in_thirds(c, site) / (3 * row_hexagons(c));
      auto& group = at < rope.band_rows                    ? tube.below
                    : at < rope.band_rows + rope.free_rows ? tube.free
                                                           : tube.above;
      group.push_back(turn * (place(c, site, shape) - Vector3(0, 0, middle)) + shift);
    }
    out.push_back(tube);
  }
  return out;
}

std::vector<RopeTube> rope_atoms(const TwistedRope& rope, const ParameterSet& set) {
  return rope_atoms(rope, set, reference_of(set).shape);
}

ReferenceTable twist_atoms(const TwistedRope& rope, const ParameterSet& set, const std::vector<double>& angles,
                           const std::vector<bool>& axial_free, const CaseContext& context) {
  MdSession session(context, set);
  const std::vector<RopeTube> atoms = rope_atoms(rope, set, session.rest_shape());
  session.write("rope.data", rope_data(atoms));
  std::vector<std::vector<double>> rows;
  for (const bool free : axial_free) {
    const std::string name = rope.name + (free ? "-free" : "-fixed");
    const auto results =
        session.run(name, input_text(rope, set, session, atoms, angles, name, free), angles.size(), 5);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const std::vector<double>& v = results[k];
      rows.push_back({free ? 1.0 : 0.0, angles[k], v[0], v[0] - v[1], v[1], v[2], v[3], v[4]});
    }
  }
  ReferenceTable t = session.table(
      fmt::format("7-tube rope of {} twisted by rigid grips, clamped length {:.4f} nm", tube_name(set),
                  clamped_length(rope, set)),
      rope.name, true,
      {"axial_free", "angle_rad", "energy_eV", "tersoff_eV", "vdw_eV", "moment_eV", "force_eV_nm", "rise_nm"});
  t.rows = std::move(rows);
  return t;
}

}  // namespace ropewalk::validate
