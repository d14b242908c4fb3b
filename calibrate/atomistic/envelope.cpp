// Limits beyond which the tube is no longer a uniform rod, from scaling rules or from incremental runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atomistic/finite_tube.hpp"
#include "atomistic/runs.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double one_percent = 0.01;

// Scaling rules, from the runs below on 12 nm of (5,5), (6,4), (9,0) and (10,10) with the Tersoff potential:
//   kink         curvature r^2  0.0408, 0.0408, 0.0424, 0.0408 nm
//   collapse     shear r        0.0312, 0.0301, 0.0297, 0.0294 to 0.031 nm
//   compression  strain         0.077, 0.074, 0.080, 0.069
// The 1 % limits are those of the anharmonic terms of the same tubes. Collapse also falls with length, slowly.
constexpr double kink_rule = 0.04;                // nm, times 1/r^2
constexpr double collapse_rule = 0.03;            // nm, times 1/r: shear
constexpr double compression_rule = 0.07;         // strain
constexpr double linear_curvature_rule = 0.0078;  // nm, times 1/r^2
constexpr double linear_shear_rule = 0.04;
constexpr double linear_strain_rule = 0.004;
constexpr double rule_error = 0.2;  // relative, between tubes and potentials

constexpr double seed_error = 0.03;  // relative: scatter of an instability with other noise or steps

constexpr double first_step = 0.4, step_size = 0.04;  // arguments of the rule
// Of the largest work of a step so far: below it moment, torque or force are falling. A tube of two walls loses a tenth
// of its torque where it collapses, and goes on softly.
constexpr double give_way = 0.95;

// The smallest positive x with |a x + b x^2| = limit.
double first_crossing(double a, double b, double limit) {
  double best = 1e300;
  for (const double sign : {1.0, -1.0})
    for (const double side : {1.0, -1.0}) {
      // b x^2 + a x - side limit = 0 along x = sign * distance.
      const double linear = a * sign, constant = -side * limit;
      if (std::abs(b) < 1e-300) {
        if (linear != 0 && -constant / linear > 0) best = std::min(best, -constant / linear);
        continue;
      }
      const double determinant = linear * linear - 4 * b * constant;
      if (determinant < 0) continue;
      for (const double root :
           {(-linear + std::sqrt(determinant)) / (2 * b), (-linear - std::sqrt(determinant)) / (2 * b)})
        if (root > 0) best = std::min(best, root);
    }
  return best;
}

// A kind of loading in increments.
struct Loading {
  std::string name;             // name of the run and of its rows
  double rule;                  // magnitude at the limit of the scaling rule
  double last_step;             // relative to the rule; the search ends there
  std::string variables, move;  // LAMMPS: move goes from v_q0 to v_q
};

const char* clamped_height =
    "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n";

std::vector<Loading> loadings(const Envelope& rules, double radius) {
  // Bands are rotated and moved as rigid bodies, by the angle and shift of their edge.
  const std::string twist = std::string(clamped_height) +
                            "variable turn atom (v_q-v_q0)*v_zc\n"
                            "variable new_x atom f_now[1]*cos(v_turn)-f_now[2]*sin(v_turn)\n"
                            "variable new_y atom f_now[1]*sin(v_turn)+f_now[2]*cos(v_turn)\n";
  const std::string press = std::string(clamped_height) + "variable new_z atom z-(v_q-v_q0)*v_zc\n";
  const std::string bend = affine_bend_variables() +
                           "variable k delete\nvariable k equal v_q\nvariable k0 delete\nvariable k0 equal v_q0\n";
  return {
      {"kink", rules.kink_curvature.value * angstrom, 2, bend, "set group all x v_next_x y v_next_y z v_next_z\n"},
      {"collapse", rules.twist_collapse.value / radius * angstrom, 3, twist,
       "fix now all store/state 0 x y z\nset group all x v_new_x y v_new_y\nunfix now\n"},
      {"compression", rules.compression.value, 2, press, "set group all z v_new_z\n"}};
}

// The anharmonic terms describe the round tube, which flattens before it collapses: the energy of (10,10) is 1 %
// off at 0.75 of the collapse and 5 % off at 0.95.
void cap_below_collapse(Envelope& envelope) {
  constexpr double still_round = 0.75;
  const double most = still_round * envelope.twist_collapse.value;
  if (envelope.linear_shear.value > most)
    envelope.linear_shear = {most, still_round * envelope.twist_collapse.standard_error};
}

}  // namespace

Envelope scaled_envelope(double radius) {
  const auto rule = [](double value) { return Measured{value, rule_error * value}; };
  Envelope envelope;
  envelope.kink_curvature = rule(kink_rule / (radius * radius));
  envelope.linear_curvature = rule(linear_curvature_rule / (radius * radius));
  envelope.twist_collapse = rule(collapse_rule / radius);
  envelope.compression = rule(compression_rule);
  envelope.linear_shear = rule(linear_shear_rule);
  envelope.linear_strain = rule(linear_strain_rule);
  return envelope;
}

void limits_from_terms(const Stiffness& s, Envelope& envelope) {
  // Derivatives of the energy: EA e + 3 c30 e^2, GJ t + 3 c03 t^2 + 4 c04 t^3, EI k + 4 k4 k^3.
  const auto relative_error = [](const Measured& a) {
    return a.value != 0 ? std::abs(a.standard_error / a.value) : 0.0;
  };
  if (s.EA.value > 0 && s.stretch_cubic.value != 0) {
    const double strain = one_percent * s.EA.value / std::abs(3 * s.stretch_cubic.value);
    envelope.linear_strain = {strain, strain * relative_error(s.stretch_cubic)};
  }
  if (s.GJ.value > 0 && s.twist_quartic.value != 0) {
    const double twist =
        first_crossing(3 * s.twist_cubic.value / s.GJ.value, 4 * s.twist_quartic.value / s.GJ.value, one_percent);
    const double shear = twist * s.radius.value;
    envelope.linear_shear = {shear, shear * std::min(1.0, relative_error(s.twist_quartic))};
  }
  cap_below_collapse(envelope);
  if (s.EI.value > 0 && s.bend_quartic.value != 0) {
    // The held ends keep a wide tube round, so that short specimens have too small a quartic term: (20,20) at 6 and
    // 10 nm has half of it. The term may therefore only lower the limit of the rule.
    const double curvature = std::sqrt(one_percent * s.EI.value / std::abs(4 * s.bend_quartic.value));
    if (curvature < envelope.linear_curvature.value)
      envelope.linear_curvature = {curvature, curvature * 0.5 * relative_error(s.bend_quartic)};
  }
}

Envelope measured_envelope(RunContext& run, const RelaxedTube& tube, const Stiffness& stiffness,
                           std::vector<AtomisticRow>& rows) {
  const FiniteTube finite(run.c, tube.shape, hexagons_in(run.c, tube.shape, envelope_length),
                          held_band(run.potential));
  write_data(run, "envelope.data", finite.data(run.potential.honeycomb));
  return measured_envelope(run,
                           {finite.commands(run.potential, "envelope.data") +
                                fmt::format("variable half equal {:.12g}\n", 0.5 * finite.free_length() / angstrom),
                            finite.free_length(), tube.shape.radius, tube.shape.twist, finite.atoms().size()},
                           stiffness, rows);
}

Envelope measured_envelope(RunContext& run, const EnvelopeSpecimen& specimen, const Stiffness& stiffness,
                           std::vector<AtomisticRow>& rows) {
  const double radius = specimen.radius;
  Envelope envelope = stiffness.envelope;
  Measured* const results[] = {&envelope.kink_curvature, &envelope.twist_collapse, &envelope.compression};
  const std::vector<Loading> list = loadings(scaled_envelope(radius), radius);

  for (std::size_t k = 0; k < list.size(); ++k) {
    const Loading& loading = list[k];
    if (run.options.progress) run.options.progress("envelope: " + loading.name);
    const std::string name = "envelope-" + loading.name;
    const int steps = static_cast<int>(std::lround((loading.last_step - first_step) / step_size));
    const std::string report = fmt::format("print \"$(v_q:%.12g) $(pe:%.15g)\" append {}.dat screen no\n", name);
    std::string input = "# step by step from the relaxed state before, with a little noise, until it gives way\n" +
                        specimen.commands +
                        "variable q equal 0.0\nvariable q0 equal 0.0\n" + loading.variables +
                        "minimize 0.0 1e-3 1000 20000\n" + report +
                        "variable e equal $(pe:%.15g)\nvariable most equal 0.0\n";
    double last = 0;
    for (int i = 0; i <= steps; ++i) {
      const double now = loading.rule * (first_step + step_size * i);
      input += fmt::format(
          "variable q0 delete\nvariable q0 equal {:.12g}\nvariable q delete\nvariable q equal {:.12g}\n", last,
          now);
      // The first step is long and starts from the straight tube, without earlier displacements to scale.
      input += i == 0 && loading.name == "kink" ? "set group all x v_bent_x z v_bent_z\n" : loading.move;
      input += fmt::format("displace_atoms free random 0.002 0.002 0.002 {} units box\n", 1001 + i);
      input += "minimize 0.0 3e-3 1500 20000\n" + report;
      // The work of the first step is not compared, since this step is longer.
      input += "variable work equal $(pe-v_e:%.15g)\n";
      if (i >= 1)
        input += fmt::format(
            "if \"${{work}} < $({}*v_most:%.15g)\" then \"jump SELF gave_way\"\n"
            "if \"${{work}} > ${{most}}\" then \"variable most delete\" \"variable most equal ${{work}}\"\n",
            give_way);
      input += "variable work delete\nvariable e delete\nvariable e equal $(pe:%.15g)\n";
      last = now;
    }
    input += "label gave_way\n";
    run_stage(run, name, input);
    const std::size_t most = static_cast<std::size_t>(steps) + 2;
    const auto table = read_results(run.folder, name, 4, most, 2);
    const double unit = loading.name == "compression" ? 1.0 : 1.0 / angstrom;
    for (const auto& line : table) {
      AtomisticRow row;
      row.kind = name;
      row.length = specimen.free_length;
      row.atoms = static_cast<int>(specimen.atoms);
      if (loading.name == "kink") row.curvature = line[0] * unit;
      if (loading.name == "compression") row.strain = -line[0];
      row.twist = specimen.twist + (loading.name == "collapse" ? line[0] * unit : 0);
      row.energy = line[1] - table.front()[1];
      rows.push_back(row);
    }
    const double scale = unit * (loading.name == "collapse" ? radius : 1);
    // The limit is after the step with the largest work.
    std::size_t peak = 2;
    for (std::size_t i = 2; i < table.size(); ++i)
      if (table[i][1] - table[i - 1][1] > table[peak][1] - table[peak - 1][1]) peak = i;
    if (peak + 1 == table.size()) {
      run.warnings.push_back(fmt::format(
          "the tube held in the {} run up to {:.3g}, {:.0f} times the scaling rule; the envelope says so much",
          loading.name, table.back()[0] * scale, loading.last_step));
      *results[k] = {table.back()[0] * scale, 0.5 * table.back()[0] * scale};
      continue;
    }
    const double before = table[peak][0], after = table[peak + 1][0];
    const double middle = 0.5 * (before + after) * scale;
    *results[k] = {middle, std::hypot(0.5 * (after - before) * scale, seed_error * middle)};
  }
  envelope.measured = true;
  limits_from_terms(stiffness, envelope);  // again, with the measured collapse
  return envelope;
}

}  // namespace ropewalk::calibrate
