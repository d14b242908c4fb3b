#include "atomistic/walls.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "atomistic/finite_tube.hpp"
#include "atomistic/options.hpp"
#include "atomistic/runs.hpp"
#include "io/clocks.hpp"

namespace ropewalk::calibrate {
namespace {

using units::pi;

// A state of a specimen, relaxed, as LAMMPS left it.
struct State {
  double strain = 0, twist = 0, curvature = 0;  // 1, rad/nm, 1/nm
};
struct Result {
  std::vector<double> energy;  // energy of each wall, eV
  double force = 0;            // eV/nm
  double radius = 0;           // outer wall in the middle, nm
};

class Walls {
 public:
  Walls(const std::vector<Chirality>& walls, const Potential& potential, const LennardJones& law,
        const std::string& folder, const StiffnessOptions& options)
      : options_(options), law_(law), run_{walls.back(), potential, folder, options_, 0, {}} {
    for (const Chirality c : walls) {
      // A wall alone is where its tube starts from.
      const std::string own = fmt::format("{}/wall-{}-{}", folder, c.n, c.m);
      RunContext alone{c, potential, own, options_, 0, {}};
      shapes_.push_back({c, relax_tube(alone).shape});
      run_.lammps_seconds += alone.lammps_seconds;
      chiral_ = chiral_ || c.chiral();
    }
  }

  // The walls beside one another, free at all ends: radius, length and twist of each from its middle.
  void relax_together() {
    const WalledTube tube = specimen(true);
    write_data(run_, "together.data", tube.data());
    std::string input = "# all walls together, free\n" +
                        tube.commands(run_.potential, law_, "together.data", Holding::all) +
                        "unfix hold\nminimize 0.0 1e-3 3000 30000\n" + tube.report("together") +
                        "write_dump all custom together.atoms id x y z modify sort id format float %.12f\n";
    run_stage(run_, "together", input);
    const std::vector<Vector3> atoms = read_atoms(run_, "together.atoms", tube.atoms());
    std::size_t first = 0;
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      relax_shape(k, tube, &atoms[first]);
      first += tube.sites(k).size();
    }
  }

  // Energies of the walls in all states, for both specimens. Each state is relaxed from the one before.
  std::array<std::vector<Result>, 2> strained(const std::string& name, const std::vector<State>& states,
                                              Holding holding) {
    std::array<std::vector<Result>, 2> out;
    for (const bool longer : {false, true}) {
      const WalledTube tube = specimen(longer);
      const std::string stage = name + (longer ? "-long" : "-short");
      write_data(run_, stage + ".data", tube.data());
      const bool bent = std::any_of(states.begin(), states.end(), [](const State& s) { return s.curvature != 0; });
      std::string input = "# a specimen in one state after the other\n";
      for (int plane = 0; plane < (bent ? planes() : 1); ++plane)
        input += tube.commands(run_.potential, law_, stage + ".data", holding, 0.5 * pi * plane) +
                 relaxing(holding) +
                 (bent ? bend_commands(states, tube.report(stage)) : strain_commands(states, tube.report(stage)));
      run_stage(run_, stage, input);
      out[longer ? 1 : 0] = results(stage, states.size(), bent ? planes() : 1);
    }
    return out;
  }

  // Kink, collapse and compression of the tube with all walls held.
  Envelope limits(const Stiffness& stiffness, std::vector<AtomisticRow>& rows) {
    std::vector<long> free;
    for (const auto& [c, shape] : shapes_) free.push_back(hexagons_in(c, shape, envelope_length));
    const WalledTube tube(shapes_, free, held_band(run_.potential));
    write_data(run_, "envelope.data", tube.data());
    return measured_envelope(run_,
                             {tube.commands(run_.potential, law_, "envelope.data", Holding::all),
                              tube.free_length(), shapes_.back().shape.radius, 0, tube.atoms()},
                             stiffness, rows);
  }

  std::size_t size() const { return shapes_.size(); }
  const WallShape& shape(std::size_t k) const { return shapes_[k]; }
  bool chiral() const { return chiral_; }
  // The difference of both specimens of a wall, and the nominal one (nm).
  double difference(std::size_t wall) const { return specimen_length(wall, true) - specimen_length(wall, false); }
  double nominal() const { return difference(size() - 1); }
  int atoms() const { return static_cast<int>(specimen(true).atoms()); }
  RunContext& run() { return run_; }

 private:
  long hexagons(std::size_t wall, bool longer) const {
    const auto& [c, shape] = shapes_[wall];
    const long few = hexagons_in(c, shape, options_.short_length);
    return longer ? few + hexagons_in(c, shape, options_.long_length - options_.short_length) : few;
  }
  double specimen_length(std::size_t wall, bool longer) const {
    return static_cast<double>(hexagons(wall, longer)) * shapes_[wall].shape.length_per_hexagon;
  }
  WalledTube specimen(bool longer) const {
    std::vector<long> free;
    for (std::size_t k = 0; k < size(); ++k) free.push_back(hexagons(k, longer));
    return {shapes_, free, held_band(run_.potential)};
  }
  // As in bend_rows: the energy of an end depends on its azimuth, and the mean over planes does not.
  int planes() const {
    int most = 1;
    for (const WallShape& wall : shapes_)
      most = std::max(most, std::gcd(wall.c.n, wall.c.m) > 2 ? 1 : std::gcd(wall.c.n, wall.c.m) == 2 ? 2 : 4);
    return most;
  }

  // Walls that are free to slide have soft modes, which cost hundreds of steps and hold no energy: the
  // minimiser may leave forces of 5e-3 eV/Angstrom, worth some 1e-5 eV.
  static std::string relaxing(Holding holding) {
    return fmt::format("variable ftol equal {}\n", holding == Holding::all ? "1e-3" : "5e-3");
  }

  static std::string strain_commands(const std::vector<State>& states, const std::string& report) {
    std::string text =
        "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n"
        "variable de equal 0.0\nvariable dt equal 0.0\n"
        "variable turn atom v_dt*v_zc*v_led\n"
        "variable new_x atom f_now[1]*cos(v_turn)-f_now[2]*sin(v_turn)\n"
        "variable new_y atom f_now[1]*sin(v_turn)+f_now[2]*cos(v_turn)\n"
        "variable new_z atom z+v_de*v_zc*v_led\n"
        "minimize 0.0 ${ftol} 3000 30000\n";
    State last;
    for (const State& s : states) {
      text += fmt::format(
          "variable de delete\nvariable de equal {:.12g}\nvariable dt delete\nvariable dt equal {:.12g}\n"
          "fix now all store/state 0 x y z\nset group all x v_new_x y v_new_y z v_new_z\nunfix now\n"
          "minimize 0.0 ${{ftol}} 2000 20000\n",
          s.strain - last.strain, (s.twist - last.twist) * angstrom);
      text += report;
      last = s;
    }
    return text;
  }

  static std::string bend_commands(const std::vector<State>& states, const std::string& report) {
    std::string text = affine_bend_variables() + "minimize 0.0 ${ftol} 3000 30000\n";
    double last = 0;
    for (const State& s : states) {
      if (s.curvature != 0) {
        text += fmt::format(
            "variable k0 delete\nvariable k0 equal {:.12g}\nvariable k delete\nvariable k equal {:.12g}\n",
            last * angstrom, s.curvature * angstrom);
        text += last == 0 ? "set group all x v_bent_x z v_bent_z\n"
                          : "set group all x v_next_x y v_next_y z v_next_z\n";
        text += "minimize 0.0 ${ftol} 2000 20000\n";
      }
      text += report;
      last = s.curvature;
    }
    return text;
  }

  // Means over the planes.
  std::vector<Result> results(const std::string& stage, std::size_t states, int planes) const {
    const std::size_t all = states * static_cast<std::size_t>(planes);
    const auto table = read_results(run_.folder, stage, all, all, size() + 2);
    std::vector<Result> out(states);
    for (std::size_t i = 0; i < all; ++i) {
      Result& r = out[i % states];
      r.energy.resize(size());
      for (std::size_t k = 0; k < size(); ++k) r.energy[k] += table[i][k] / planes;
      r.force = std::max(r.force, table[i][size()] / angstrom);
      r.radius += table[i][size() + 1] * angstrom / planes;
    }
    return out;
  }

  void relax_shape(std::size_t k, const WalledTube& tube, const Vector3* atoms) {
    auto& [c, shape] = shapes_[k];
    const std::vector<Site>& sites = tube.sites(k);
    const double part = 0.3 * tube.free_length(k);
    TubeShape flat = shape;
    flat.twist = 0;
    double n = 0, h1 = 0, h2 = 0, z1 = 0, hz = 0, p1 = 0, hp = 0, radius = 0;
    bool begun = false;
    double before = 0;
    // Straight lines through the heights, and through the azimuths, of the atoms in the middle.
    for (std::size_t i = 0; i < sites.size(); ++i) {
      if (std::fabs(atoms[i].z()) > part) continue;
      const Polar at = polar(c, sites[i], flat);
      const double h = (at.z - (sites[i].second ? flat.height_shift : 0)) / flat.length_per_hexagon;
      const double z = atoms[i].z() - (sites[i].second ? flat.height_shift : 0);
      double phi = std::remainder(std::atan2(atoms[i].y(), atoms[i].x()) - at.phi - shape.twist * at.z, 2 * pi);
      if (begun) phi = before + std::remainder(phi - before, 2 * pi);
      begun = true, before = phi;
      n += 1, h1 += h, h2 += h * h, z1 += z, hz += h * z, p1 += phi, hp += h * phi;
      radius += std::hypot(atoms[i].x(), atoms[i].y());
    }
    const double spread = n * h2 - h1 * h1;
    const double length = (n * hz - h1 * z1) / spread, turn = (n * hp - h1 * p1) / spread;
    if (!(n > 3) || std::fabs(length / shape.length_per_hexagon - 1) > 0.05 ||
        std::fabs(radius / n / shape.radius - 1) > 0.1)
      throw LammpsError(
          fmt::format("the walls of the tube do not hold together: wall {} has {:.3g} times its length "
                      "and {:.3g} times its radius ({}/together.log)",
                      k + 1, length / shape.length_per_hexagon, radius / n / shape.radius, run_.folder));
    shape.twist = c.chiral() ? (shape.twist * shape.length_per_hexagon + turn) / length : 0;
    shape.length_per_hexagon = length;
    shape.radius = radius / n;
  }

  StiffnessOptions options_;
  LennardJones law_;
  RunContext run_;
  std::vector<WallShape> shapes_;
  bool chiral_ = false;
};

// States of strain and twist, each near the one before. The energy of tubes without a sense of twist is even in it.
std::vector<State> straight_states(const StiffnessOptions& options, double radius, bool chiral) {
  const double e = options.largest_strain, t = options.largest_shear / radius;
  std::vector<State> out = {{0, 0, 0}, {-0.5 * e, 0, 0}, {-e, 0, 0}, {0.5 * e, 0, 0}, {e, 0, 0},
                            {e, t, 0}, {-e, t, 0},       {0, t, 0},  {0, 0.5 * t, 0}};
  if (chiral) out.insert(out.end(), {{0, -0.5 * t, 0}, {0, -t, 0}, {-e, -t, 0}, {e, -t, 0}});
  return out;
}

// States of strain up to the limits, at zero twist, a half of the largest shear, and the largest.
std::vector<State> wide_states(const Envelope& limits, double radius, bool chiral) {
  std::vector<double> strains, twists = {0, 0.5, 1};
  for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0}) strains.push_back(part * limits.compression.value);
  if (chiral) twists.insert(twists.begin(), {-1, -0.5});
  std::vector<State> out;
  for (const double part : twists) {
    for (const double strain : strains) out.push_back({strain, part * limits.twist_collapse.value / radius, 0});
    std::reverse(strains.begin(), strains.end());
  }
  return out;
}

std::vector<State> bent_states(double curvature, const std::vector<double>& parts) {
  std::vector<State> out;
  for (const double part : parts) out.push_back({0, 0, part * curvature});
  return out;
}

// Rows of the difference of both specimens, the mirrored ones too; of one wall, or of all (-1).
std::vector<AtomisticRow> straight_rows(const Walls& walls, const std::vector<State>& states,
                                        const std::array<std::vector<Result>, 2>& found, int wall, bool mirrored,
                                        const std::string& kind = "stretch-twist") {
  std::vector<AtomisticRow> rows;
  const auto energy = [&](std::size_t i) {
    double sum = 0;
    for (std::size_t k = 0; k < walls.size(); ++k)
      if (wall < 0 || static_cast<std::size_t>(wall) == k)
        sum += (found[1][i].energy[k] - found[0][i].energy[k]) * walls.nominal() / walls.difference(k);
    return sum;
  };
  double at_rest = 0;
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].strain == 0 && states[i].twist == 0) at_rest = energy(i);
  for (std::size_t i = 0; i < states.size(); ++i) {
    AtomisticRow row;
    row.kind = kind;
    row.length = walls.nominal();
    row.strain = states[i].strain;
    row.twist = states[i].twist;
    row.atoms = walls.atoms();
    row.energy = energy(i) - at_rest;
    row.radius = found[1][i].radius;
    rows.push_back(row);
    if (!mirrored || row.twist == 0) continue;
    row.twist = -row.twist;
    rows.push_back(row);
  }
  return rows;
}

std::vector<AtomisticRow> bent_rows(const Walls& walls, const std::vector<State>& states,
                                    const std::array<std::vector<Result>, 2>& found, int wall,
                                    const std::string& kind = "bend") {
  std::vector<AtomisticRow> rows;
  for (const bool longer : {false, true})
    for (std::size_t i = 0; i < states.size(); ++i) {
      AtomisticRow row;
      row.kind = kind + (longer ? "-long" : "-short");
      row.length = walls.nominal() * (longer ? 2 : 1);
      row.curvature = states[i].curvature;
      row.atoms = walls.atoms();
      for (std::size_t k = 0; k < walls.size(); ++k) {
        if (wall >= 0 && static_cast<std::size_t>(wall) != k) continue;
        const double lower = found[0][i].energy[k] - found[0][0].energy[k],
                     upper = found[1][i].energy[k] - found[1][0].energy[k];
        row.energy += lower + (longer ? (upper - lower) * walls.nominal() / walls.difference(k) : 0);
      }
      rows.push_back(row);
    }
  return rows;
}

// A wall with a sense of twist, if there is one.
Chirality chiral_wall(const std::vector<Chirality>& walls) {
  const auto at = std::find_if(walls.begin(), walls.end(), [](Chirality c) { return c.chiral(); });
  return at == walls.end() ? walls.back() : *at;
}

void append(std::vector<AtomisticRow>& to, const std::vector<AtomisticRow>& rows, const std::string& prefix) {
  for (AtomisticRow row : rows) {
    row.kind = prefix + row.kind;
    to.push_back(row);
  }
}

}  // namespace

std::pair<double, double> specimen_lengths(const std::vector<Chirality>& walls) {
  const double shorter = std::clamp(3 * 2 * tube_radius(walls.back()), 3.0, 6.0);
  return {shorter, 2 * shorter};
}

WalledStiffness measure_walls(const std::vector<Chirality>& chiralities, const Potential& potential,
                              const LennardJones& law, Holding carried, const std::string& folder,
                              const StiffnessOptions& options) {
  const auto tell = [&](const std::string& line) {
    if (options.progress) options.progress(line);
  };
  for (const Chirality c : chiralities) check_tube(c, potential.honeycomb.lattice_constant);
  check_options(options);
  WalledStiffness out;
  const LammpsVersion lammps = lammps_version(options.lammps);
  tell("relaxing the walls, each alone and then together");
  Walls walls(chiralities, potential, law, folder, options);
  walls.relax_together();
  const double radius = walls.shape(walls.size() - 1).shape.radius;

  const std::vector<State> states = straight_states(options, radius, walls.chiral());
  const double bend_strain =
      options.largest_bend_strain > 0 ? options.largest_bend_strain : std::min(0.02, 0.007 / radius);
  const std::vector<State> bends = bent_states(bend_strain / radius, {0, 0.4, 0.6, 0.8, 1});

  out.walls.resize(walls.size());
  double density = 0;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    WallStiffness& wall = out.walls[k];
    wall.rest = walls.shape(k);
    wall.radius.value = wall.rest.shape.radius;
    wall.atoms_per_length.value = 2 / wall.rest.shape.length_per_hexagon;
    density += wall.atoms_per_length.value;
  }
  for (const Holding holding : {Holding::all, Holding::outer}) {
    const bool all = holding == Holding::all;
    Stiffness& whole = all ? out.all : out.outer;
    const std::string name = all ? "all-held" : "outer-held";
    tell(all ? "stretching and twisting, all walls held" : "stretching and twisting, the outer wall held");
    const auto straight = walls.strained(name, states, holding);
    tell(all ? "bending, all walls held" : "bending, the outer wall held");
    const auto bent = walls.strained(name + "-bend", bends, holding);
    const auto fit = [&](int wall, Stiffness& s) {
      const double begin = steady_seconds();
      s.rows = straight_rows(walls, states, straight, wall, !walls.chiral());
      append(s.rows, bent_rows(walls, bends, bent, wall), "");
      fit_stretch_twist(s.rows, s);
      fit_bend(s.rows, s);
      s.fit_seconds = seconds_since(begin);
    };
    fit(-1, whole);
    double at_rest = 0;
    for (std::size_t i = 0; i < states.size(); ++i)
      if (states[i].strain == 0 && states[i].twist == 0)
        for (std::size_t k = 0; k < walls.size(); ++k)
          at_rest += (straight[1][i].energy[k] - straight[0][i].energy[k]) / walls.difference(k);
    whole.energy_per_atom = at_rest / density;
    // What the fit calls the strain of the tube at rest, by which the lengths of the free specimen are off.
    const double off = whole.atoms_per_length.value * whole.rows.front().length / whole.rows.front().atoms - 1;
    whole.atoms_per_length = {density, density * std::fabs(off)};
    whole.radius = {radius, std::fabs(whole.radius.value - radius)};
    whole.lammps = lammps;
    for (const auto& specimen : {straight[0], straight[1]})
      for (std::size_t i = 0; i < states.size(); ++i)
        check_convergence(walls.run(), "a specimen of several walls", specimen[i].force,
                          0.1 * whole.EA.value * options.largest_strain * options.largest_strain * walls.nominal());
    if (!all) continue;
    for (std::size_t k = 0; k < walls.size(); ++k) {
      Stiffness one;
      fit(static_cast<int>(k), one);
      WallStiffness& wall = out.walls[k];
      wall.EA = one.EA, wall.EI = one.EI, wall.GJ = one.GJ;
      append(out.wall_rows, one.rows, fmt::format("wall-{}-", k + 1));
    }
  }
  for (WallStiffness& wall : out.walls) {
    wall.radius.standard_error = out.all.radius.standard_error;
    wall.atoms_per_length.standard_error =
        out.all.atoms_per_length.standard_error * wall.atoms_per_length.value / density;
  }
  // In a long tube free walls carry nothing and bend along. What specimens of these lengths have besides, from corrugation
  // and from the ends of the free walls, is an error.
  const auto widen = [](Measured& held, const Measured& of_long_tube) {
    held.standard_error = std::max(held.standard_error, std::fabs(held.value - of_long_tube.value));
  };
  widen(out.outer.EA, out.walls.back().EA);
  widen(out.outer.GJ, out.walls.back().GJ);
  widen(out.outer.EI, out.all.EI);
  for (Stiffness* s : {&out.all, &out.outer}) {
    s->envelope = scaled_envelope(radius);
    limits_from_terms(*s, s->envelope);
  }
  if (options.envelope) {
    tell("looking for kink, collapse and buckling of all walls (minutes)");
    out.outer.envelope = out.all.envelope = walls.limits(out.all, out.wall_rows);
  }
  if (options.anharmonic && options.envelope) {
    const auto beyond = [&](Stiffness& s, Holding holding, const std::string& name) {
      tell("stretching, twisting and bending up to the limits, " +
           std::string(holding == Holding::all ? "all walls held" : "the outer wall held"));
      const std::vector<State> wide = wide_states(s.envelope, radius, walls.chiral()),
                               far = bent_states(s.envelope.kink_curvature.value, {0, 0.3, 0.5, 0.65, 0.75, 0.85});
      append(s.rows,
             straight_rows(walls, wide, walls.strained(name, wide, holding), -1, false, "wide-stretch-twist"), "");
      append(s.rows, bent_rows(walls, far, walls.strained(name + "-bend", far, holding), -1, "wide-bend"), "");
      fit_anharmonic(s.rows, chiral_wall(chiralities), s);
    };
    // The bond of one way of carrying is enough.
    carried == Holding::all ? beyond(out.all, Holding::all, "wide-all")
                            : beyond(out.outer, Holding::outer, "wide-outer");
  }
  for (Stiffness* s : {&out.all, &out.outer}) {
    s->lammps_seconds = walls.run().lammps_seconds;
    s->warnings.insert(s->warnings.end(), walls.run().warnings.begin(), walls.run().warnings.end());
  }
  return out;
}

}  // namespace ropewalk::calibrate
