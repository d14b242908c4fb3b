#include "cases/common/strained_specimen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/checks.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk::validate {
namespace {

using Amount = double SpecimenState::*;

struct Kind {
  const char *stiffness, *unit, *words, *axis, *axis_unit;
  Amount amount;
};
constexpr std::array<Kind, 3> kinds = {
    {{"EA", "nN", "stretched and compressed", "strain", "", &SpecimenState::strain},
     {"GJ", "nN nm^2", "twisted", "twist", "rad/nm", &SpecimenState::twist},
     {"EI", "nN nm^2", "bent", "curvature", "1/nm", &SpecimenState::curvature}}};

// Twice the energy over the square of the amount, as the mean over the states that have this amount alone.
double stiffness_of(const Kind& kind, const std::vector<SpecimenState>& states,
                    const std::function<double(std::size_t)>& energy) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double amount = states[i].*kind.amount;
    if (amount == 0) continue;
    sum += 2 * energy(i) / (amount * amount);
    ++count;
  }
  return sum / count;
}

}  // namespace

std::vector<SpecimenState> specimen_states(const Amplitudes& most, double radius) {
  const double e = most.strain, t = most.shear / radius, k = most.bend / radius;
  return {{}, {e, 0, 0}, {-e, 0, 0}, {0, t, 0}, {0, -t, 0}, {0, 0, k}};
}

std::string specimen_commands(const std::vector<SpecimenState>& states, double force, const std::string& report) {
  const std::string relax = fmt::format("minimize 0.0 {:g} 5000 50000\n", force);
  // The bands move as rigid bodies, with the strain and twist of their edge. A variable stands for each place, since
  // `set` takes numbers and variables alone.
  std::string text = "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n" +
                     relax + "fix rest all store/state 0 x y z\nvariable y_rest atom f_rest[2]\n";
  for (const SpecimenState& s : states) {
    const double twist = s.twist * angstrom, k = s.curvature * angstrom;
    if (s.curvature != 0) {
      text += fmt::format(
          "variable to_x atom (1-cos({0:.12g}*f_rest[3]))/{0:.12g}+f_rest[1]*cos({0:.12g}*f_rest[3])\n"
          "variable to_z atom sin({0:.12g}*f_rest[3])/{0:.12g}-f_rest[1]*sin({0:.12g}*f_rest[3])\n"
          "set group all x v_to_x y v_y_rest z v_to_z\n",
          k);
    } else {
      text += fmt::format(
          "variable angle atom {:.12g}*v_zc*v_led\n"
          "variable to_x atom f_rest[1]*cos(v_angle)-f_rest[2]*sin(v_angle)\n"
          "variable to_y atom f_rest[1]*sin(v_angle)+f_rest[2]*cos(v_angle)\n"
          "variable to_z atom f_rest[3]+{:.12g}*v_zc*v_led\n"
          "set group all x v_to_x y v_to_y z v_to_z\nvariable angle delete\nvariable to_y delete\n",
          twist, s.strain);
    }
    text += "variable to_x delete\nvariable to_z delete\n" + relax + report;
  }
  return text;
}

std::vector<double> bending_planes(Chirality c) {
  const int fold = std::gcd(c.n, c.m);
  if (fold > 2) return {0};
  std::vector<double> out;
  for (int k = 0; k < (fold == 2 ? 2 : 4); ++k) out.push_back(0.5 * units::pi * k);
  return out;
}

std::vector<std::string> specimen_columns() {
  return {"way", "strain", "twist_rad_per_nm", "curvature_per_nm", "energy_eV_per_nm"};
}

void add_specimen_rows(ReferenceTable& table, int way, const SpecimenEnergies& e) {
  for (std::size_t i = 0; i < e.states.size(); ++i) {
    const SpecimenState& s = e.states[i];
    table.rows.push_back({static_cast<double>(way), s.strain, s.twist, s.curvature, e.energy[i]});
  }
}

SpecimenEnergies specimen_rows(const ReferenceTable& table, int way) {
  SpecimenEnergies out;
  const std::vector<double> ways = table.column("way"), strain = table.column("strain"),
                            twist = table.column("twist_rad_per_nm"), bend = table.column("curvature_per_nm"),
                            energy = table.column("energy_eV_per_nm");
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (std::lround(ways[i]) != way) continue;
    out.states.push_back({strain[i], twist[i], bend[i]});
    out.energy.push_back(energy[i]);
  }
  return out;
}

void compare_stiffnesses(const std::string& name, const SpecimenEnergies& atoms, const BondStiffness& bond,
                         double element_length, double tolerance, CaseResult& result) {
  const auto model = [&](const SpecimenState& s) {
    return chain_energy(bond, element_length, s.strain, s.twist, s.curvature);
  };
  for (const Kind& kind : kinds) {
    const auto of = [&](const std::function<double(std::size_t)>& energy) {
      return stiffness_of(kind, atoms.states, energy) * units::eV_in_nN_nm;
    };
    result.check_relative(fmt::format("{}: {}", name, kind.stiffness),
                          of([&](std::size_t i) { return model(atoms.states[i]); }),
                          of([&](std::size_t i) { return atoms.energy[i]; }), tolerance, kind.unit,
                          kind.amount == &SpecimenState::curvature ? "" : "mean over both signs");
    std::vector<double> amount, energy;
    double most = 0, least = 0;
    for (std::size_t i = 0; i < atoms.states.size(); ++i) {
      const double at = atoms.states[i].*kind.amount;
      if (at == 0 && i > 0) continue;
      amount.push_back(at), energy.push_back(atoms.energy[i]);
      most = std::max(most, at), least = std::min(least, at);
    }
    ChartLine points{"atoms (LAMMPS)", amount, energy, 0};
    points.points = true;
    const auto curve = [&](double at) {
      SpecimenState s;
      s.*kind.amount = at;
      return model(s);
    };
    result.figure(fmt::format("{} {}", name, kind.words), {kind.axis, kind.axis_unit},
                  {"energy per length", "eV/nm"}, fmt::format("{}: energy above rest.", name),
                  {theory_curve("model", least, most, 1, curve), points});
  }
}

}  // namespace ropewalk::validate
