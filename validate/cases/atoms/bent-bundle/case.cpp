// A bundle of seven parallel tubes bent by its ends, with atoms (LAMMPS) and with elements.
// Placement. The centre line between the clamps becomes an arc of unchanged contour length; beyond the clamps the
// ends stay straight. The end planes of a beam in pure bending lie there, so that the grips need not be free to
// approach. With the curvature k = theta/L, a point of the straight bundle at x from the axis and z along it, of
// which zc lies between the clamps and zo beyond them, moves to
//   X = (1 - cos p)/k + x cos p + zo sin p,   Z = sin p/k - x sin p + zo cos p,   p = k zc.
// Atoms and elements are placed alike. `glued`: the ends of all tubes are held there, so that end planes stay
// planes. `free`: only the ends of the middle tube are held; the six others follow by van der Waals forces. Each
// increment also moves the free part; a sliding tube at x0 has p = k zc/(1 - k x0), which keeps its length.
//
// Relaxed structures follow the forces of lj/cut, which are those of the energy shifted to zero at the cutoff; the
// energies reported are not shifted, as in the parameter sets.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cases/common/bundle.hpp"
#include "cases/common/lammps_session.hpp"
#include "cases/common/tube_pair.hpp"
#include "cases/common/twisted_rope.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "scene/lattice.hpp"

namespace ropewalk::validate::bent_bundle {
namespace {

// Fixed beforehand.
constexpr double energy_tolerance = 0.05, part_tolerance = 0.10, vdw_share_tolerance = 0.01;
constexpr double fresh_tolerance = 0.01;  // of the range of each column: what the minimiser leaves
constexpr double pair_fresh_tolerance = 0.001;

constexpr int tubes = 7, contacts = 12;
constexpr int turns = 4, shifts = 24, periods = 5;  // grid of the pair that measures the corrugation

constexpr double force_tolerance = 5e-3;  // eV/nm
constexpr long max_steps = 200000;
constexpr double step_fraction = 0.9;  // of the stability limit: nothing has to be conserved

struct Grips {
  const char* name;
  bool glued = false;
  double step = 0;  // rad
  int increments = 0;
  int held = 0;  // number of these that are compared with the atoms
};
// Glued: the tubes farthest from the neutral plane are strained by x theta/L, up to 2 % in the increments that are
// compared. The stiffness of a tube changes by 4.5 % per percent, with opposite signs on the two sides. Free: up to
// 24 degrees theta/L stays in the range in which the bending stiffness of one tube is constant to 1 %.
constexpr Grips glued{"glued", true, 1.5 * units::degree, 8, 6};
constexpr Grips sliding{"free", false, 4 * units::degree, 6, 6};

TwistedRope bundle() {
  TwistedRope b;
  b.name = "bent-bundle";
  b.free_rows = 64;
  b.band_rows = 8;
  b.bonds = 13;
  return b;
}

double whole_length(const ParameterSet& set) {
  return (bundle().free_rows + 2 * bundle().band_rows) * row_distance(set);
}

struct BentState {
  double angle = 0;                      // rad
  double total = 0, tubes = 0, vdw = 0;  // eV: all, inside of and between tubes
};

BentState change(const std::vector<BentState>& states, std::size_t k) {
  return {states[k].angle, states[k].total - states[0].total, states[k].tubes - states[0].tubes,
          states[k].vdw - states[0].vdw};
}

// --- Atoms ---

constexpr int first_iterations = 2500, iterations = 1000;

// Displacement of each atom from the increment before, along x and z.
std::string placement_text(const Grips& grips, const ParameterSet& set, double length) {
  std::string text = "variable i equal 0\n";
  std::string offset;  // offset of each atom's tube from the axis
  int type = 0;
  for (const auto& [x, y] : hexagonal_lattice(tubes, set.law<LineParameters>()->pair_spacing)) {
    ++type;
    offset += fmt::format("{}{:.12f}*(type=={})", type == 1 ? "" : "+", x / angstrom, type);
  }
  text += fmt::format(
      "variable offset atom {}\n"
      "variable half equal {:.12f}\n"
      "variable over atom (f_ref[3]>v_half)*(f_ref[3]-v_half)+(f_ref[3]<-v_half)*(f_ref[3]+v_half)\n",
      offset, 0.5 * length / angstrom);
  for (const auto& [name, index] : {std::pair{"old", "(v_i-1)"}, std::pair{"new", "v_i"}}) {
    // Never zero, so that the formulas hold for the straight bundle.
    text += fmt::format("variable k{} equal {}*{:.15f}+1.0e-12\n", name, index, grips.step / (length / angstrom));
    text += fmt::format("variable p{0} atom v_k{0}*(f_ref[3]-v_over){1}\n", name,
                        grips.glued ? "" : fmt::format("/(1-v_k{}*v_offset)", name));
    text += fmt::format("variable x{0} atom 2*sin(0.5*v_p{0})^2/v_k{0}+f_ref[1]*cos(v_p{0})+v_over*sin(v_p{0})\n",
                        name);
    text += fmt::format("variable z{0} atom sin(v_p{0})/v_k{0}-f_ref[1]*sin(v_p{0})+v_over*cos(v_p{0})\n", name);
  }
  return text + "variable dx atom v_xnew-v_xold\nvariable dz atom v_znew-v_zold\n";
}

std::string bending_input(const Grips& grips, const ParameterSet& set, const MdSession& session,
                          const std::vector<RopeTube>& atoms) {
  // Free tubes slide into registry over many iterations that hardly change the energy. The number is limited.
  const auto relax = [&](int most) {
    return fmt::format(
        "pair_modify pair lj/cut shift yes\n"
        "minimize 0.0 5.0e-3 {} {}\n"
        "pair_modify pair lj/cut shift no\n"
        "run 0 post no\n"
        "print \"$(v_i) $(pe:%.12g) $(c_lj:%.12g) $(fnorm*10:%.4g)\" append {}.dat screen no\n",
        most, 3 * most, grips.name);
  };
  std::string text = header_commands("s s s", 0.05) + "read_data bundle.data\n";
  text += rope_pairs(session.potential(), set.law<LineParameters>()->universal) + rope_groups(atoms);
  text += grips.glued ? "group core union all\n" : "group core type 1\n";
  text +=
      "group grips intersect held core\n"
      "group loose subtract all grips\n"
      "fix ref all store/state 0 x y z\n"
      "fix hold grips setforce 0.0 0.0 0.0\n"
      "compute lj all pair lj/cut\n"
      "min_style cg\n"
      "min_modify dmax 0.05 line quadratic\n"
      "thermo_style custom step pe fnorm fmax c_lj\n"
      "thermo 100\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  text += placement_text(grips, set, clamped_length(bundle(), set)) + relax(first_iterations);
  return text +
         fmt::format(
             "variable count loop {}\n"
             "label next_increment\n"
             "variable i equal ${{count}}\n"
             "displace_atoms all move v_dx 0.0 v_dz units box\n",
             grips.increments) +
         relax(iterations) + "next count\njump SELF next_increment\n";
}

ReferenceTable bend_atoms(const CaseContext& context, const ParameterSet& set) {
  const std::vector<RopeTube> atoms = rope_atoms(bundle(), set);
  MdSession session(context, set);
  session.write("bundle.data", rope_data(atoms));
  std::vector<std::vector<double>> rows;
  for (const Grips& grips : {glued, sliding}) {
    const auto count = static_cast<std::size_t>(grips.increments) + 1;
    for (const auto& row : session.run(grips.name, bending_input(grips, set, session, atoms), count, 4))
      rows.push_back({grips.glued ? 1.0 : 0.0, row[0] * grips.step, row[1], row[1] - row[2], row[2], row[3]});
  }
  ReferenceTable t = session.table(
      fmt::format("7-tube bundle of (5,5) bent by its ends, clamped length {:.4f} nm",
                  clamped_length(bundle(), set)),
      "bent-bundle", true, {"glued", "angle_rad", "energy_eV", "tersoff_eV", "vdw_eV", "force_left_eV_per_nm"});
  t.rows = std::move(rows);
  return t;
}

// Frozen pairs in a periodic cell, slid over one period, for several turns.
ReferenceTable slide_pairs(const CaseContext& context, const ParameterSet& set) {
  const Chirality c = set.chirality;
  MdSession session(context, set);
  const TubeShape shape{set.radius, row_distance(set) / c.n, 0, 0, 0};
  const auto rows = slid_pairs(
      session, "pair", c, shape,
      {periods * period_hexagons(c), set.law<LineParameters>()->pair_spacing, period_of(c, shape), turns, shifts});
  ReferenceTable t = session.table("Energy of two frozen parallel (5,5) tubes against axial shift", "bent-bundle",
                                   true, {"turn_i", "turn_j", "shift_nm", "energy_eV_per_nm"});
  t.rows = rows;
  return t;
}

// Highest minus lowest energy per length of a pair, mean over its turns.
double corrugation_of(const ReferenceTable& pairs) {
  const std::vector<double> energy = pairs.column("energy_eV_per_nm");
  const auto length = static_cast<std::ptrdiff_t>(shifts);
  double sum = 0;
  for (auto at = energy.begin(); at != energy.end(); at += length) {
    const auto [least, most] = std::minmax_element(at, at + length);
    sum += (*most - *least) / (turns * turns);
  }
  return sum;
}

std::vector<BentState> states_of(const ReferenceTable& table, const Grips& grips) {
  std::vector<BentState> states;
  for (const std::vector<double>& row : table.rows)
    if ((row[0] > 0.5) == grips.glued) states.push_back({row[1], row[2], row[3], row[4]});
  if (states.size() != static_cast<std::size_t>(grips.increments) + 1)
    throw InputError({"bent-bundle.csv", 0, ""}, "does not have the number of increments of the case",
                     "make the reference again with --fresh");
  return states;
}

// --- Elements ---

class BentChains {
 public:
  BentChains(const Grips& grips, const ParameterSet& set);
  void bend(double angle);  // to it, from where the bundle is
  BentState measure() const;

 private:
  struct TiltedElement {
    Vector3 position;
    double tilt;  // about y
  };
  TiltedElement element_at(std::size_t element, double angle) const;
  void relax();

  Bundle bundle_;
  LoadsAndConstraints loads_;
  Vec3Array straight_;
  Energies energy_;
  bool glued_;
  double length_, angle_ = 0;
  int per_tube_ = 0;
};

BentChains::BentChains(const Grips& grips, const ParameterSet& set)
    : glued_(grips.glued), length_(clamped_length(bundle(), set)) {
  // A grip is one and a half elements long, which includes the half row beyond the last row of the band.
  constexpr int beyond = 1;
  const int bonds = bundle().bonds;
  per_tube_ = bonds + 1 + 2 * beyond;
  ParameterSet divided = set;
  divided.element_length = length_ / bonds;
  bundle_ = line_bundle(divided, tubes, per_tube_);
  for (int t = 0; t < (glued_ ? tubes : 1); ++t)
    for (int e = 0; e < per_tube_; ++e)
      if (e <= beyond || e >= bonds + beyond) loads_.add(FixLoad({t * per_tube_ + e}));
  straight_ = bundle_.state.position;
  bundle_.time_step *= step_fraction / default_step_fraction;
  relax();
}

BentChains::TiltedElement BentChains::element_at(std::size_t element, double angle) const {
  const Vector3 at = straight_[element];
  const double within = std::clamp(at.z(), -0.5 * length_, 0.5 * length_), over = at.z() - within;
  const double k = std::max(angle, 1e-9) / length_;
  const double p = k * within / (glued_ ? 1 : 1 - k * at.x());
  const double rise = 2 * std::pow(std::sin(0.5 * p), 2) / k;
  return {{rise + at.x() * std::cos(p) + over * std::sin(p), at.y(),
           std::sin(p) / k - at.x() * std::sin(p) + over * std::cos(p)},
          p};
}

void BentChains::bend(double angle) {
  State& state = bundle_.state;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const TiltedElement from = element_at(i, angle_), to = element_at(i, angle);
    state.position.add(i, to.position - from.position);
    state.orientation.set(i, turn_about(Vector3::UnitY(), to.tilt - from.tilt) * state.orientation[i]);
  }
  angle_ = angle;
  relax();
}

void BentChains::relax() {
  const Simulation simulation =
      at_rest(Simulation(bundle_.topology, bundle_.interaction, loads_, bundle_.state, bundle_.time_step),
              force_tolerance, max_steps);
  bundle_.state = simulation.state();
  energy_ = simulation.forces().energy;
}

BentState BentChains::measure() const { return {angle_, energy_.potential(), energy_.bonds(), energy_.vdw}; }

std::vector<BentState> bend_elements(const Grips& grips, const ParameterSet& set) {
  BentChains chains(grips, set);
  std::vector<BentState> states = {chains.measure()};
  for (int k = 1; k <= grips.increments; ++k) {
    chains.bend(k * grips.step);
    states.push_back(chains.measure());
  }
  return states;
}

// --- Comparison ---

// Energy theta^2 K/2L of tubes that slide freely, and of tubes that are glued together (K in eV nm).
struct Bounds {
  double sliding = 0, glued = 0, length = 0;
  double energy(double stiffness, double angle) const { return 0.5 * stiffness * angle * angle / length; }
  // 0: sliding, 1: glued.
  double gluing(const BentState& state) const {
    return (state.total / energy(1, state.angle) - sliding) / (glued - sliding);
  }
};

Bounds bounds_of(const ParameterSet& set) {
  double squares = 0;
  for (const auto& [x, y] : hexagonal_lattice(tubes, set.law<LineParameters>()->pair_spacing)) squares += x * x;
  const double sliding_stiffness = tubes * set.bond.bend;
  return {sliding_stiffness, sliding_stiffness + set.bond.stretch * squares, clamped_length(bundle(), set)};
}

struct Series {
  Grips grips;
  std::vector<BentState> atoms, elements;
  double registry = 0;  // eV: what leaving its valleys may cost the bundle of atoms
};

// The tolerance is relative to the atoms, plus a part for registry that does not grow with the angle.
void check_energy(const std::string& name, double value, double reference, double tolerance, double registry,
                  CaseResult& result) {
  if (registry == 0) return result.check_relative(name, value, reference, tolerance, "eV");
  result.check_absolute(name, value, reference, tolerance * std::fabs(reference) + registry, "eV",
                        fmt::format("{:.3g} % and {:.2g} eV of registry", 100 * tolerance, registry));
}

void add_checks(const Series& series, const Bounds& bounds, CaseResult& result) {
  const auto last = static_cast<std::size_t>(series.grips.held);
  for (const std::size_t k : std::array{last / 2, 3 * last / 4, last}) {
    const BentState atoms = change(series.atoms, k), elements = change(series.elements, k);
    const std::string at = fmt::format(", {}, {:.4g} deg", series.grips.name, atoms.angle * units::rad_in_degree);
    check_energy("bending energy" + at, elements.total, atoms.total, energy_tolerance, series.registry, result);
    check_energy("energy inside of the tubes" + at, elements.tubes, atoms.tubes, part_tolerance, series.registry,
                 result);
    result.check_relative("vdW energy" + at, series.elements[k].vdw, series.atoms[k].vdw, part_tolerance, "eV",
                          "of the bent bundle, whole");
    result.check_absolute("vdW part of the bending energy" + at, elements.vdw, atoms.vdw,
                          vdw_share_tolerance * atoms.total + series.registry, "eV",
                          "tolerance relative to the bending energy, of which it is a small part");
    result.show_absolute("stiffness between sliding (0) and glued (1)" + at, bounds.gluing(elements),
                         bounds.gluing(atoms), 0.05, "1", "limits of rod theory with the set's stiffnesses");
  }
}

std::vector<double> degrees(const std::vector<BentState>& states) {
  std::vector<double> out;
  for (const BentState& s : states) out.push_back(s.angle * units::rad_in_degree);
  return out;
}

ChartLine line_of(const std::string& name, const std::vector<BentState>& states, double BentState::*value,
                  int colour, bool points) {
  ChartLine line{name, degrees(states), {}, colour};
  for (std::size_t k = 0; k < states.size(); ++k) line.y.push_back(change(states, k).*value);
  line.points = points;
  return line;
}

CaseFigure energy_figure(const Series& series, const Bounds& bounds) {
  CaseFigure figure =
      case_figure(fmt::format("Bending energy against the angle, grips {}", series.grips.name),
                  {"angle between the ends", "deg"}, {"bending energy", "eV"},
                  series.grips.glued
                      ? "With their end planes held, the tubes act as one beam: the limit of glued tubes."
                      : "Tubes that are not held slide; only van der Waals forces bend them. The bundle is softer "
                        "than seven tubes bent alike.");
  const double end = series.atoms.back().angle * units::rad_in_degree;
  const auto curve = [&](const char* name, double stiffness, int colour) {
    return theory_curve(name, 0, end, colour,
                        [&](double degrees) { return bounds.energy(stiffness, degrees * units::degree); });
  };
  figure.chart.lines = {line_of("atoms", series.atoms, &BentState::total, 0, true),
                        line_of("elements", series.elements, &BentState::total, 0, false),
                        curve("seven tubes bent alike, sliding", bounds.sliding, 2)};
  if (series.grips.glued) figure.chart.lines.push_back(curve("glued together", bounds.glued, 1));
  return figure;
}

CaseFigure vdw_figure(const std::vector<Series>& all) {
  CaseFigure figure =
      case_figure("Change of the vdW energy against the angle", {"angle between the ends", "deg"},
                  {"change of the vdW energy", "eV"},
                  "Sliding tubes of atoms leave their registry. Rows of elements have no registry.");
  int colour = 0;
  for (const Series& s : all) {
    const std::string name = s.grips.name;
    figure.chart.lines.push_back(line_of("atoms, " + name, s.atoms, &BentState::vdw, colour, true));
    figure.chart.lines.push_back(line_of("elements, " + name, s.elements, &BentState::vdw, colour++, false));
  }
  return figure;
}

CaseFigure residual_figure(const std::vector<Series>& all) {
  CaseFigure figure = case_figure("Elements against atoms", {"angle between the ends", "deg"},
                                  {"bending energy, elements over atoms less 1", "%"},
                                  "Relative difference of the bending energy.");
  int colour = 0;
  for (const Series& s : all) {
    ChartLine line{s.grips.name, degrees(s.atoms), {std::numeric_limits<double>::quiet_NaN()}, colour++};
    for (std::size_t k = 1; k < s.atoms.size(); ++k)
      line.y.push_back(100 * (change(s.elements, k).total / change(s.atoms, k).total - 1));
    figure.chart.lines.push_back(line);
  }
  return figure;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const ParameterSet set = context.set(), model = context.model();
  const ReferenceTable table = reference(
      context, set, "bent-bundle", fresh_tolerance, [&] { return bend_atoms(context, set); }, result);
  const ReferenceTable pairs = reference(
      context, set, "pair-slide", pair_fresh_tolerance, [&] { return slide_pairs(context, set); }, result);
  const Bounds bounds = bounds_of(set);
  // Energy from a valley of the corrugation to its mean, in every contact over its whole length.
  const double registry = 0.5 * contacts * corrugation_of(pairs) * whole_length(set);
  std::vector<Series> all;
  for (const Grips& grips : {glued, sliding}) {
    if (context.progress) context.progress(fmt::format("elements: ends {}", grips.name));
    // If end planes stay planes, neighbours stay in registry.
    all.push_back({grips, states_of(table, grips), bend_elements(grips, model), grips.glued ? 0 : registry});
    add_checks(all.back(), bounds, result);
    result.figures.push_back(energy_figure(all.back(), bounds));
  }
  result.figures.push_back(residual_figure(all));
  result.figures.push_back(vdw_figure(all));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "bent-bundle";
  c.order = 100;
  c.tier = Case::Tier::full;
  c.sets = {"cnt-5-5-tersoff"};
  c.only_these = "it compares with stored atoms of (5,5), twenty minutes of LAMMPS";
  c.run = run;
  c.turns_red = {
      {wrong_EA(1.1),
       {"bending energy, glued, 4.5 deg", "bending energy, glued, 6 deg", "bending energy, glued, 9 deg"}},
      {wrong_EI(1.3), {"bending energy, free, 24 deg"}},
      {wrong_contact(2), {"vdW energy, glued, 9 deg"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::bent_bundle
