#include "friction/sliding.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "atomistic/runs.hpp"
#include "io/files.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double place_step = 0.025, way = 0.5;  // nm
constexpr double temperature = 300;              // K
constexpr double sampled_every = 0.1;            // ps

std::vector<Vector3> turned(std::vector<Vector3> atoms, double angle, const Vector3& by) {
  const Eigen::AngleAxisd turn(angle, Vector3::UnitZ());
  for (Vector3& atom : atoms) atom = turn * atom + by;
  return atoms;
}

// Reads both tubes, `distance` apart, and holds the strips.
std::string start(const SlidingTubes& tubes, const Register& at, double distance, const std::string& folder,
                  const std::string& name) {
  double top = 0;
  for (const Vector3& atom : tubes.a) top = std::max(top, std::fabs(atom.z()));
  const double half = distance + tubes.radius_a + tubes.radius_b + 2;
  write_file_atomically(folder + "/" + name + ".data",
                        data_file({turned(tubes.a, at.turn_a, Vector3::Zero()),
                                   turned(tubes.b, at.turn_b, Vector3(distance, 0, at.shift))},
                                  half, -top - 2, top + 2));
  return header_commands("s s s", 0.1) + fmt::format("read_data {}.data\n", name) +
         pair_commands(tubes.potential, tubes.law) +
         fmt::format(
             "group a type 1\ngroup b type 2\n"
             "region far_a block INF {:.6f} INF INF INF INF\nregion far_b block {:.6f} INF INF INF INF INF\n"
             "group side_a region far_a\ngroup side_b region far_b\n"
             "group still intersect side_a a\ngroup led intersect side_b b\n"
             "fix still still setforce 0.0 0.0 0.0\nfix rigid led aveforce 0.0 NULL NULL\nfix led led setforce "
             "NULL 0.0 0.0\n"
             "compute push b group/group a\n"
             "thermo_style custom step pe c_push\nthermo 500\nthermo_modify flush yes lost error norm no\n",
             -0.6 * tubes.radius_a / angstrom, (distance + 0.6 * tubes.radius_b) / angstrom);
}

}  // namespace

Measured mean_without_period(const std::vector<double>& force, const std::vector<double>& s, double period) {
  const auto n = static_cast<Eigen::Index>(force.size());
  Eigen::MatrixXd form(n, 5);
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double phase = 2 * units::pi * s[static_cast<std::size_t>(k)] / period;
    form.row(k) << 1, std::cos(phase), std::sin(phase), std::cos(2 * phase), std::sin(2 * phase);
    y[k] = force[static_cast<std::size_t>(k)];
  }
  const Eigen::MatrixXd inverse = (form.transpose() * form).inverse();
  const Eigen::VectorXd fit = inverse * (form.transpose() * y), rest = y - form * fit;
  const auto block = static_cast<Eigen::Index>(std::lround(1 / sampled_every));
  double blocks = 0;
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k + block <= n; k += block, ++count)
    blocks += std::pow(rest.segment(k, block).mean(), 2);
  const double variance = std::max(static_cast<double>(block) * blocks / static_cast<double>(count),
                                   rest.squaredNorm() / static_cast<double>(n - 5));
  return {fit[0], std::sqrt(variance * inverse(0, 0))};
}

std::string pair_commands(const Potential& potential, const AtomLaw& law) {
  const PairStyle own = pair_style_of(potential, "which two tubes cannot both have");
  return fmt::format(
      "pair_style hybrid {} {} lj/cut {:.8g}\npair_coeff * * {} 1 {} {} NULL\npair_coeff * * {} 2 {} NULL {}\n"
      "pair_coeff 1 2 lj/cut {:.10g} {:.10g}\n",
      own.with_arguments, own.with_arguments, law.cutoff / angstrom, own.name, own.file, own.species, own.name, own.file,
      own.species, law.epsilon, law.sigma / angstrom);
}

RelaxedStrength relaxed_strength(const SlidingTubes& tubes, const Register& at, Slip slip,
                                 const std::string& folder, const std::string& name, const LammpsOptions& options) {
  const RigidPair rigid(tubes.law, tubes.a, tubes.radius_a, tubes.b, tubes.radius_b);
  const SlipCurve curve = slip_curve(rigid, slip, at, {rigid.length()}, 0, place_step, way);
  const double distance = curve.distance[0];
  std::string input =
      start(tubes, at, distance, folder, name) + "min_style cg\nmin_modify dmax 0.05 line quadratic\n";
  for (std::size_t k = 0; k < curve.forces.size(); ++k) {
    if (k > 0 && slip == Slip::along)
      input += fmt::format("displace_atoms b move 0 0 {:.8g}\n", place_step / angstrom);
    if (k > 0 && slip == Slip::spin_b)
      input += fmt::format(
          "variable x equal xcm(b,x)\nvariable y equal xcm(b,y)\n"
          "displace_atoms b rotate $x $y 0 0 0 1 {:.10g}\n",
          place_step / tubes.radius_b / units::degree);
    input += fmt::format("minimize 0 3e-4 3000 30000\nprint \"$(pe)\" append {}.dat\n", name);
  }
  run_lammps(folder, name, input, options);
  const auto energies = read_results(folder, name, curve.forces.size(), curve.forces.size(), 1);
  RelaxedStrength out;
  for (std::size_t k = 1; k < curve.forces.size(); ++k) {
    out.relaxed = std::max(out.relaxed, std::fabs(energies[k][0] - energies[k - 1][0]) / place_step);
    out.rigid =
        std::max(out.rigid, std::fabs(curve.forces[k][0].energy - curve.forces[k - 1][0].energy) / place_step);
  }
  return out;
}

Drag measured_drag(const SlidingTubes& tubes, const Register& at, double duration, double period,
                   const std::string& folder, const std::string& name, const LammpsOptions& options) {
  const RigidPair rigid(tubes.law, tubes.a, tubes.radius_a, tubes.b, tubes.radius_b);
  Drag out;
  out.speeds = {0.1, 0.05, 0.025};
  double weighted = 0, weights = 0;
  for (const double speed : out.speeds) {
    const std::string run = fmt::format("{}-{:.0f}", name, 1000 * speed);
    const long steps = std::lround(duration / 0.001), sample = std::lround(sampled_every / 0.001);
    std::string input =
        start(tubes, at, rigid.free_distance(at, tubes.radius_a + tubes.radius_b + 0.32), folder, run) +
        "group held union still led\ngroup free subtract all held\ngroup moving subtract all still\n"
        "timestep 0.001\nmin_style cg\nminimize 0 1e-3 1000 10000\n";
    input += fmt::format("velocity free create {} 4711 mom yes dist gaussian\nvelocity led set 0 0 {:.8g}\n",
                         2 * temperature, speed / angstrom);
    input += fmt::format("fix go moving nve\nfix warm free langevin {0} {0} 0.1 4712\nrun 3000\nunfix warm\n",
                         temperature);
    input += fmt::format(
        "reset_timestep 0\nfix mean all ave/time 1 {0} {0} c_push[3]\nrun {1} every {0} \"print '$(f_mean)' append "
        "{2}.dat\"\n",
        sample, steps, run);
    run_lammps(folder, run, input, options);
    std::vector<double> force, way_gone;
    const auto samples = static_cast<std::size_t>(steps / sample);
    for (const auto& row : read_results(folder, run, samples, samples + 1, 1)) {
      force.push_back(-row[0] / angstrom / rigid.length());
      way_gone.push_back(speed * sampled_every * static_cast<double>(force.size()));
    }
    const Measured mean = mean_without_period(force, way_gone, period);
    out.force.push_back(mean);
    const double weight = 1 / (mean.standard_error * mean.standard_error);
    weighted += speed * mean.value * weight;
    weights += speed * speed * weight;
  }
  out.drag = {weighted / weights, 1 / std::sqrt(weights)};
  return out;
}

}  // namespace ropewalk::calibrate
