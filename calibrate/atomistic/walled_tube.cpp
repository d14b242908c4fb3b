#include "atomistic/walled_tube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atomistic/finite_tube.hpp"
#include "atomistic/runs.hpp"

namespace ropewalk::calibrate {
namespace {

// A minimiser that writes nothing for long is taken for dead (LammpsOptions::quiet_seconds). Steps of many atoms are slow.
std::size_t steps_between_lines(std::size_t atoms) {
  return std::clamp(std::size_t{200'000} / atoms, std::size_t{10}, std::size_t{500});
}

}  // namespace

std::string walled_pair_commands(const Potential& potential, const LennardJones& law, std::size_t walls) {
  const PairStyle own = pair_style_of(potential, "which several walls cannot have each");
  std::string styles = "pair_style hybrid/overlay", coefficients;
  for (std::size_t k = 1; k <= walls; ++k) {
    styles += " " + own.with_arguments;
    coefficients +=
        fmt::format("pair_coeff * * {}{} {}", own.name, walls > 1 ? fmt::format(" {}", k) : "", own.file);
    for (std::size_t l = 1; l <= walls; ++l) coefficients += l == k ? " " + own.species : " NULL";
    coefficients += "\n";
  }
  if (walls == 1) return styles + "\n" + coefficients;
  const double cutoff = law.cutoff > 0 ? law.cutoff : 4 * law.sigma;
  styles += fmt::format(" lj/cut {:.8g}\n", cutoff / angstrom);
  for (std::size_t k = 1; k <= walls; ++k)
    for (std::size_t l = k + 1; l <= walls; ++l)
      coefficients +=
          fmt::format("pair_coeff {} {} lj/cut {:.10g} {:.10g}\n", k, l, law.epsilon, law.sigma / angstrom);
  // Shifted, since a minimiser is stopped by the jumps of energy where atoms pass a cutoff.
  return styles + coefficients + "pair_modify pair lj/cut shift yes\n";
}

WalledTube::WalledTube(const std::vector<WallShape>& walls, const std::vector<long>& free_hexagons, double band) {
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const auto& [c, shape] = walls[k];
    const long held = hexagons_in(c, shape, band), free = free_hexagons[k], all = free + 2 * held;
    Part part;
    part.free_length = static_cast<double>(free) * shape.length_per_hexagon;
    const double length = static_cast<double>(all) * shape.length_per_hexagon;
    total_length_ = std::max(total_length_, length);
    part.sites = strip_sites(c, all);
    const auto place_of = [&](const Site& site) {
      const long height = height_in_thirds(c, site);
      return height < 3 * held ? 0 : height < 3 * (held + free) ? 1 : 2;
    };
    std::stable_sort(part.sites.begin(), part.sites.end(),
                     [&](const Site& a, const Site& b) { return place_of(a) < place_of(b); });
    for (const Site& site : part.sites) {
      if (place_of(site) == 0) ++part.below;
      if (place_of(site) == 1) ++part.free;
      part.atoms.push_back(place(c, site, shape) - Vector3(0, 0, 0.5 * length));
    }
    atoms_ += part.atoms.size();
    parts_.push_back(std::move(part));
  }
}

std::string WalledTube::data() const {
  double radius = 0;
  std::vector<std::vector<Vector3>> walls;
  for (const Part& part : parts_) {
    walls.push_back(part.atoms);
    for (const Vector3& atom : part.atoms) radius = std::max(radius, std::hypot(atom.x(), atom.y()));
  }
  const double half = 0.5 * total_length_ + 1;
  return data_file(walls, radius + half, -half, half);
}

std::string WalledTube::commands(const Potential& potential, const LennardJones& law, const std::string& data,
                                 Holding holding, double turn) const {
  std::string text = header_commands("s s s", 0.05) + fmt::format("read_data {}\n", data) +
                     walled_pair_commands(potential, law, parts_.size());
  std::string below = "group below id", above = "group above id", half = "variable half atom", totals, columns;
  std::size_t first = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const bool led = holding == Holding::all || k + 1 == parts_.size();
    if (led) {
      below += fmt::format(" {}:{}", first + 1, first + part.below);
      above += fmt::format(" {}:{}", first + part.below + part.free + 1, first + part.atoms.size());
    }
    half += fmt::format("{}{:.12g}*(type=={})", k == 0 ? " " : "+", 0.5 * part.free_length / angstrom, k + 1);
    totals +=
        fmt::format("group wall{} type {}\ncompute w{} wall{} reduce sum c_each\n", k + 1, k + 1, k + 1, k + 1);
    columns += fmt::format(" c_w{}", k + 1);
    first += part.atoms.size();
  }
  text += below + "\n" + above + "\ngroup held union below above\ngroup free subtract all held\n" + half + "\n";
  text += holding == Holding::all ? std::string("variable led atom 1\n")
                                  : fmt::format("variable led atom type=={}\n", parts_.size());
  if (turn != 0)
    text += fmt::format("displace_atoms all rotate 0 0 0 0 0 1 {:.12g} units box\n", turn * units::rad_in_degree);
  text += "fix ref all store/state 0 x y z\n";
  text += "fix hold held setforce 0.0 0.0 0.0\n";
  text += fmt::format(
      "variable is_middle atom (type=={})&&(abs(z)<{:.8g})\ngroup middle variable is_middle\n"
      "variable rho atom sqrt(x*x+y*y)\n"
      "compute rho middle reduce ave v_rho\n"
      "compute each all pe/atom pair\n{}"
      "min_style cg\n"
      "min_modify dmax 0.05 line quadratic\n"
      "thermo_style custom step pe fnorm fmax c_rho{}\n"
      "thermo {}\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n",
      parts_.size(), 0.2 * free_length() / angstrom, totals, columns, steps_between_lines(atoms_));
  return text;
}

std::string WalledTube::report(const std::string& name) const {
  std::string values;
  for (std::size_t k = 1; k <= parts_.size(); ++k) values += fmt::format("$(c_w{}:%.15g) ", k);
  return fmt::format("print \"{}$(fnorm:%.6g) $(c_rho:%.15g)\" append {}.dat screen no\n", values, name);
}

}  // namespace ropewalk::calibrate
