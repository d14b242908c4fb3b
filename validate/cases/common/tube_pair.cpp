#include "cases/common/tube_pair.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "scene/laws/line.hpp"
#include "scene/scene_to_model.hpp"

namespace ropewalk::validate {

std::vector<Registry> registries(int count) {
  // Powers of the root of x^5 = x + 1: the most even additive sequence in four dimensions.
  double root = 1.2;
  for (int k = 0; k < 60; ++k) root = std::pow(1 + root, 0.2);
  const auto part = [&](int k, int power) {
    const double x = 0.5 + k * std::pow(root, -power);
    return x - std::floor(x);
  };
  std::vector<Registry> list;
  for (int k = 0; k < count; ++k) list.push_back({part(k, 1), part(k, 2), part(k, 3), part(k, 4)});
  return list;
}

namespace {

std::string species_commands(const std::array<PairLaw, 3>& pairs) {
  std::string text = fmt::format("pair_coeff * * 0.0 {:.6f}\n", pairs[1].sigma / angstrom);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const PairLaw& law = pairs[static_cast<std::size_t>(i + j)];
      text += fmt::format("pair_coeff {} {} {:.8f} {:.6f}\n", i + 1, j + 3, law.epsilon, law.sigma / angstrom);
    }
  return text +
         "neigh_modify exclude type 1 1 exclude type 1 2 exclude type 2 2 "
         "exclude type 3 3 exclude type 3 4 exclude type 4 4\n"
         "group one type 1 2\ngroup two type 3 4\n";
}

}  // namespace

std::string pair_commands(const MdSession& session, const std::string& boundary, const std::string& data) {
  const AtomLaw& law = session.atom_law();
  const std::string begin = header_commands(boundary, 0.05) + fmt::format("read_data {}\n", data) +
                            fmt::format("pair_style lj/cut {:.6f}\n", law.cutoff / angstrom);
  const Honeycomb& honeycomb = session.potential().honeycomb;
  if (!honeycomb.one_species())
    return begin + species_commands(honeycomb.pairs) + "thermo_modify norm no lost error\n";
  return begin +
         fmt::format("pair_coeff * * 0.0 {0:.6f}\npair_coeff 1 2 {1:.8f} {0:.6f}\n", law.sigma / angstrom,
                     law.epsilon) +
         "neigh_modify exclude type 1 1 exclude type 2 2\n"
         "group one type 1\ngroup two type 2\n"
         "thermo_modify norm no lost error\n";
}

std::vector<Vector3> centred_tube(Chirality c, const TubeShape& shape, long hexagons, double turn, double shift) {
  return tube_atoms(c, shape, hexagons, 2 * units::pi * turn / static_cast<double>(row_hexagons(c)),
                    shift * row_height(c, shape) - 0.5 * static_cast<double>(hexagons) * shape.length_per_hexagon);
}

std::string move_two(const Vector3& by) {
  return fmt::format("displace_atoms two move {:.12f} {:.12f} {:.12f} units box\n", by.x() / angstrom,
                     by.y() / angstrom, by.z() / angstrom);
}

std::string print_values(const std::string& name, const std::string& values) {
  return fmt::format("run 0 post no\nprint \"{}\" append {}.dat screen no\n", values, name);
}

std::vector<std::vector<double>> slid_pairs(MdSession& session, const std::string& name, Chirality c,
                                            const TubeShape& shape, const SlidPairs& p) {
  const double length = static_cast<double>(p.hexagons) * shape.length_per_hexagon,
               turn = 2 * units::pi / static_cast<double>(row_hexagons(c));
  std::string input = "# frozen tubes slid along each other, for several turns\n";
  for (int i = 0; i < p.turns; ++i)
    for (int j = 0; j < p.turns; ++j) {
      const std::string data = fmt::format("{}-{}-{}.data", name, i, j);
      session.write(data, data_file({tube_atoms(c, shape, p.hexagons, turn * i / p.turns),
                                     tube_atoms(c, shape, p.hexagons, turn * j / p.turns)},
                                    4, 0, length, session.potential().honeycomb));
      input += pair_commands(session, "s s p", data) + move_two({p.distance, 0, 0});
      for (int s = 0; s < p.shifts; ++s)
        input += print_values(name, "$(pe:%.15g)") + move_two({0, 0, p.range / p.shifts});
    }
  const auto results = session.run(name, input, static_cast<std::size_t>(p.turns * p.turns * p.shifts), 1);
  std::vector<std::vector<double>> rows;
  std::size_t k = 0;
  for (int i = 0; i < p.turns; ++i)
    for (int j = 0; j < p.turns; ++j)
      for (int s = 0; s < p.shifts; ++s)
        rows.push_back({turn * i / p.turns, turn * j / p.turns, p.range * s / p.shifts, results[k++][0] / length});
  return rows;
}

Spread spread_over(int registries, const std::function<double(std::size_t)>& value) {
  double sum = 0, squares = 0;
  for (int r = 0; r < registries; ++r) {
    const double v = value(static_cast<std::size_t>(r));
    sum += v / registries;
    squares += v * v / registries;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}

LineContact contact_of(const ParameterSet& i, const ParameterSet& j, double element_length) {
  const bool alike = i.name == j.name;
  Scene scene;
  scene.element_length = element_length;
  scene.sets = {i};
  if (!alike) scene.sets.push_back(j);
  return line_contacts(scene)[alike ? 0 : 1];
}

PairForce row_contact(const LineContact& contact, const ElementRow& i, const ElementRow& j) {
  PairForce sum;
  for (int k = 0; k < i.elements; ++k) {
    const Vector3 at_i = contact.length_i * (k - 0.5 * (i.elements - 1)) * i.axis;
    for (int l = 0; l < j.elements; ++l) {
      const Vector3 at_j = contact.length_j * (l - 0.5 * (j.elements - 1)) * j.axis;
      const Vector3 separation = j.centre + at_j - i.centre - at_i;
      if (separation.norm() > contact.cutoff()) continue;
      const PairForce f = contact.energy_and_gradient(separation, i.axis, j.axis);
      sum.energy += f.energy;
      sum.force_j += f.force_j;
      sum.torque_i += f.torque_i - at_i.cross(f.force_j);
      sum.torque_j += f.torque_j + at_j.cross(f.force_j);
    }
  }
  return sum;
}

double parallel_rows(const LineContact& contact, double distance, double shift) {
  const int reach = static_cast<int>(contact.cutoff() / contact.length_j) + 2;
  ElementRow i, j;
  j.elements = 2 * reach + 1;
  j.centre = {distance, 0, shift};
  return row_contact(contact, i, j).energy / contact.length_i;
}

LineWell lowest_of(const std::vector<double>& distance, const std::vector<double>& energy, double reach) {
  const auto lowest = static_cast<std::size_t>(std::min_element(energy.begin(), energy.end()) - energy.begin());
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < distance.size(); ++k)
    if (std::abs(distance[k] - distance[lowest]) <= 1.001 * reach) near.push_back(k);
  constexpr int terms = 5;
  const auto rows = static_cast<Eigen::Index>(near.size());
  Eigen::MatrixXd a(rows, terms);
  Eigen::VectorXd b(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const std::size_t at = near[static_cast<std::size_t>(k)];
    const double x = (distance[at] - distance[lowest]) / reach;
    for (int n = 0; n < terms; ++n) a(k, n) = std::pow(x, n);
    b(k) = energy[at];
  }
  const Eigen::VectorXd fit = a.colPivHouseholderQr().solve(b);
  const auto at = [&](double x) { return fit(0) + x * (fit(1) + x * (fit(2) + x * (fit(3) + x * fit(4)))); };
  const LineWell well = detail::lowest_point(at, -1, 1);
  return {distance[lowest] + reach * well.distance, well.energy};
}

}  // namespace ropewalk::validate
