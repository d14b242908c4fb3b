#include "atomistic/finite_tube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atomistic/runs.hpp"

namespace ropewalk::calibrate {
long hexagons_in(Chirality c, const TubeShape& shape, double length) {
  const long step = std::gcd(c.n, c.m);
  return step * std::max(1L, std::lround(length / (shape.length_per_hexagon * static_cast<double>(step))));
}

double held_band(const Potential& potential) { return std::max(0.6, 2.1 * std::min(potential.cutoff, 0.6)); }

FiniteTube::FiniteTube(Chirality c, const TubeShape& shape, long free_hexagons, double band) {
  const long band_hexagons = hexagons_in(c, shape, band);
  free_length_ = static_cast<double>(free_hexagons) * shape.length_per_hexagon;
  total_length_ = static_cast<double>(free_hexagons + 2 * band_hexagons) * shape.length_per_hexagon;

  std::vector<Site> sites = strip_sites(c, free_hexagons + 2 * band_hexagons);
  const auto part = [&](const Site& site) {
    const long height = height_in_thirds(c, site);
    return height < 3 * band_hexagons ? 0 : height < 3 * (band_hexagons + free_hexagons) ? 1 : 2;
  };
  std::stable_sort(sites.begin(), sites.end(), [&](const Site& a, const Site& b) { return part(a) < part(b); });
  for (const Site& site : sites) {
    if (part(site) == 0) ++below_;
    if (part(site) == 1) ++free_;
    second_.push_back(site.second ? 1 : 0);
    atoms_.push_back(place(c, site, shape) - Vector3(0, 0, 0.5 * total_length_));
  }
}

std::string FiniteTube::data(const Honeycomb& honeycomb) const {
  double radius = 0;
  for (const Vector3& atom : atoms_) radius = std::max(radius, std::hypot(atom.x(), atom.y()));
  const double half = 0.5 * total_length_ + 1;
  return data_file_of_tube(atoms_, second_, radius + half, -half, half, honeycomb);
}

std::string FiniteTube::commands(const Potential& potential, const std::string& data, double turn) const {
  // A bend rarely moves an atom farther than this against its neighbours.
  std::string text = header_commands("s s s", 0.05) + fmt::format("read_data {}\n", data);
  for (const std::string& command : potential.commands) text += command + "\n";
  text += fmt::format(
      "group below id 1:{}\ngroup above id {}:{}\ngroup held union below above\ngroup free subtract all held\n",
      below_, below_ + free_ + 1, atoms_.size());
  if (turn != 0)
    text += fmt::format("displace_atoms all rotate 0 0 0 0 0 1 {:.12g} units box\n", turn * units::rad_in_degree);
  text +=
      "fix ref all store/state 0 x y z\n"
      "fix hold held setforce 0.0 0.0 0.0\n"
      "min_style cg\n"
      "min_modify dmax 0.05 line quadratic\n"
      "thermo_style custom step pe fnorm fmax\n"
      "thermo 100\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  return text;
}

std::string affine_bend_variables() {
  return "variable k equal 0.0\n"
         "variable k0 equal 0.0\n"
         "variable bent_x atom (1-cos(v_k*f_ref[3]))/v_k+f_ref[1]*cos(v_k*f_ref[3])\n"
         "variable bent_z atom sin(v_k*f_ref[3])/v_k-f_ref[1]*sin(v_k*f_ref[3])\n"
         "variable last_x atom (1-cos(v_k0*f_ref[3]))/v_k0+f_ref[1]*cos(v_k0*f_ref[3])\n"
         "variable last_z atom sin(v_k0*f_ref[3])/v_k0-f_ref[1]*sin(v_k0*f_ref[3])\n"
         "variable next_x atom v_bent_x+(x-v_last_x)*v_k/v_k0\n"
         "variable next_y atom f_ref[2]+(y-f_ref[2])*v_k/v_k0\n"
         "variable next_z atom v_bent_z+(z-v_last_z)*v_k/v_k0\n";
}

}  // namespace ropewalk::calibrate
