#include <gtest/gtest.h>

#include <array>

#include "model/contact/line.hpp"
#include "sim/contact/line/radial_table.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::derivative;
using test::Random;

struct Pose {
  Vector3 separation, ni, nj;
};

Pose random_pose(Random& random, double near, double far) {
  return {random.uniform(near, far) * random.direction(), random.direction(), random.direction()};
}

double scale_of(const PairForce& f) {
  return std::max({f.force_j.norm(), f.torque_i.norm(), f.torque_j.norm(), std::fabs(f.energy), 1e-6});
}

// A law under test; every law passes through the same body.
struct Law {
  std::string name;
  std::function<PairForce(const Pose&)> force;
  std::function<double(const Pose&)> energy_of;
  std::function<PairForce(const Pose&)> swapped;  // the law between j and i
  std::function<bool(const Pose&)> near_a_seam;   // where it is only C1 differences are less accurate
  double core = 0, wall = 0, far = 0;             // centres: deep overlap, where differences are good, beyond reach

  double energy(const Vector3& separation, const Vector3& ni, const Vector3& nj) const {
    return energy_of({separation, ni, nj});
  }
  PairForce energy_and_gradient(const Vector3& separation, const Vector3& ni, const Vector3& nj) const {
    return force({separation, ni, nj});
  }
};

// Force and both torques of a pose by differences of the energy.
struct Differences {
  Vector3 force_j, torque_i, torque_j;
};

Differences differences(const Law& law, const Pose& p) {
  Differences d;
  const double h = 2e-4;
  for (int a = 0; a < 3; ++a) {
    const Vector3 e = Vector3::Unit(a);
    d.force_j[a] = -derivative([&](double s) { return law.energy(p.separation + s * e, p.ni, p.nj); }, h);
    d.torque_i[a] =
        -derivative([&](double s) { return law.energy(p.separation, test::turn(e, s) * p.ni, p.nj); }, h);
    d.torque_j[a] =
        -derivative([&](double s) { return law.energy(p.separation, p.ni, test::turn(e, s) * p.nj); }, h);
  }
  return d;
}

// Distance (in c, R/r and D) to a place where the law is only C1: differences across it are less accurate.
bool near_a_seam(const PaperContact& law, const Pose& p) {
  const double rho = p.separation.norm() / law.radius;
  const double c = std::fabs(p.ni.dot(p.nj));
  const auto close = [](double a, double b, double width) { return std::fabs(a - b) < width; };
  return close(c, law.bisector_blend, 2e-3) || close(rho, law.freeze - law.freeze_blend, 3e-3) ||
         close(rho, law.freeze + law.freeze_blend, 3e-3) || close(rho, law.switch_start, 3e-3) ||
         close(rho, law.cutoff_ratio, 3e-3);
}

template <class Contact>
Law law_of(std::string name, const Contact& k, std::function<bool(const Pose&)> seam, double core, double wall,
           double far) {
  const auto force = [k](const Pose& p) { return k.energy_and_gradient(p.separation, p.ni, p.nj); };
  const auto energy = [k](const Pose& p) { return k.energy(p.separation, p.ni, p.nj); };
  return {std::move(name), force, energy, force, std::move(seam), core, wall, far};
}

Law paper_law(bool general_powers, double cutoff = 0) {
  PaperContact k = test::published_contact();
  if (cutoff > 0) k = with_cutoff(k, cutoff);
  if (general_powers) {
    k.alpha = 9.2;
    k.beta = 3.9;
    k.delta = -7.1;
  }
  return law_of(
      general_powers ? "PaperGeneral"
      : cutoff > 0   ? "PaperCut"
                     : "Paper",
      k, [k](const Pose& p) { return near_a_seam(k, p); }, 0.3, 1.3, 5.6);
}

// Whether a pair of nodes is near a gap where the third derivative of the line density jumps.
bool near_a_seam(const LineContact& k, const Pose& p) {
  const LineDensity& d = k.density;
  for (int a = 0; a < k.nodes_i; ++a)
    for (int b = 0; b < k.nodes_j; ++b) {
      const Vector3 r =
          p.separation + line_node(b, k.nodes_j, k.length_j) * p.nj - line_node(a, k.nodes_i, k.length_i) * p.ni;
      for (double gap : {d.core_gap, d.switch_gap, d.cutoff_gap})
        if (std::fabs(r.norm() - d.contact - gap) < 1e-3) return true;
    }
  return false;
}

Law line_law(int nodes_i, int nodes_j, double length_j, double cutoff = 0) {
  const LineDensity density = cutoff > 0 ? with_cutoff(test::line_density(), cutoff) : test::line_density();
  const LineContact k{density, test::element_length, length_j, nodes_i, nodes_j};
  const LineContact swapped{k.density, length_j, test::element_length, nodes_j, nodes_i};
  Law law = law_of(
      "Line" + std::to_string(nodes_i) + "x" + std::to_string(nodes_j) + (cutoff > 0 ? "Cut" : ""), k,
      [k](const Pose& p) { return near_a_seam(k, p); }, 0.3, 1.3, 4.0);
  law.swapped = [swapped](const Pose& p) { return swapped.energy_and_gradient(p.separation, p.ni, p.nj); };
  return law;
}

class ContactLawTest : public ::testing::TestWithParam<Law> {
 protected:
  const Law& law() const { return GetParam(); }
};

TEST_P(ContactLawTest, ForceAndTorquesAreTheGradient) {
  const Law& k = law();
  Random random(7);
  int tested = 0;
  double worst = 0;
  for (int n = 0; n < 20000 && tested < 4000; ++n) {
    const Pose p = random_pose(random, k.wall, k.far);
    if (k.near_a_seam(p)) continue;
    const PairForce f = k.energy_and_gradient(p.separation, p.ni, p.nj);
    // The core and the steep wall have derivatives so high that differences carry no seven digits.
    if (std::fabs(f.energy) > 1.0) continue;
    ++tested;
    const Differences d = differences(k, p);
    const double error = std::max(
        {(f.force_j - d.force_j).norm(), (f.torque_i - d.torque_i).norm(), (f.torque_j - d.torque_j).norm()});
    worst = std::max(worst, error / scale_of(f));
    ASSERT_LT(error, 1e-7 * scale_of(f)) << "R " << p.separation.norm() << " U " << f.energy;
  }
  EXPECT_GE(tested, 4000);
  RecordProperty("worst_relative_error", std::to_string(worst));
}

TEST_P(ContactLawTest, CoreIsTheGradientToo) {
  const Law& k = law();
  Random random(8);
  for (int n = 0; n < 500; ++n) {
    const Pose p = random_pose(random, k.core, k.wall);
    const PairForce f = k.energy_and_gradient(p.separation, p.ni, p.nj);
    const Differences d = differences(k, p);
    ASSERT_LT((f.force_j - d.force_j).norm(), 1e-5 * scale_of(f));
    ASSERT_LT((f.torque_i - d.torque_i).norm(), 1e-5 * scale_of(f));
    ASSERT_LT((f.torque_j - d.torque_j).norm(), 1e-5 * scale_of(f));
  }
}

TEST_P(ContactLawTest, AngularMomentumIsConserved) {
  const Law& k = law();
  Random random(9);
  for (int n = 0; n < 4000; ++n) {
    const Pose p = random_pose(random, 0.2, k.far);
    const PairForce f = k.energy_and_gradient(p.separation, p.ni, p.nj);
    const Vector3 net = f.torque_i + f.torque_j + p.separation.cross(f.force_j);
    ASSERT_LT(net.norm(), 1e-12 * (scale_of(f) + p.separation.norm() * f.force_j.norm()));
  }
}

TEST_P(ContactLawTest, FrameSwapAndFlip) {
  const Law& k = law();
  Random random(10);
  for (int n = 0; n < 2000; ++n) {
    const Pose p = random_pose(random, 1.0, k.far);
    const PairForce f = k.energy_and_gradient(p.separation, p.ni, p.nj);
    const double tight = 1e-10 * scale_of(f);

    const Eigen::Matrix3d r = random.orientation().toRotationMatrix();
    const PairForce turned = k.energy_and_gradient(r * p.separation, r * p.ni, r * p.nj);
    ASSERT_NEAR(turned.energy, f.energy, tight);
    ASSERT_LT((turned.force_j - r * f.force_j).norm(), tight);
    ASSERT_LT((turned.torque_i - r * f.torque_i).norm(), tight);

    const PairForce swapped = k.swapped({-p.separation, p.nj, p.ni});
    ASSERT_NEAR(swapped.energy, f.energy, tight);
    ASSERT_LT((swapped.force_j + f.force_j).norm(), tight);
    ASSERT_LT((swapped.torque_j - f.torque_i).norm(), tight);

    const PairForce flipped = k.energy_and_gradient(p.separation, -p.ni, p.nj);
    ASSERT_NEAR(flipped.energy, f.energy, tight);
    ASSERT_LT((flipped.force_j - f.force_j).norm(), tight);
    ASSERT_LT((flipped.torque_i - f.torque_i).norm(), tight);
    ASSERT_LT((flipped.torque_j - f.torque_j).norm(), tight);
  }
}

TEST_P(ContactLawTest, SpecialPosesAreFinite) {
  const Law& k = law();
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  for (double distance : {0.0, 1e-9, 1e-3, 0.3, 1.356, 1.6272, 1.713, 2.3, 2.712, 4.068, 5.4, 5.424, 6.0})
    for (const Vector3& along : {x, y, z, Vector3((x + y).normalized())})
      for (const Vector3& ni : {z, Vector3(-z)})
        for (const Vector3& nj : {z, Vector3(-z), x, Vector3((x + z).normalized()), y}) {
          const PairForce f = k.energy_and_gradient(distance * along, ni, nj);
          ASSERT_TRUE(std::isfinite(f.energy));
          ASSERT_TRUE(f.force_j.allFinite() && f.torque_i.allFinite() && f.torque_j.allFinite());
        }
}

// A walk through every seam: energy and force must not jump. The bound on a step is that of a slope.
TEST_P(ContactLawTest, EnergyAndForceAreContinuous) {
  const Law& k = law();
  Random random(11);
  for (int walk = 0; walk < 60; ++walk) {
    const Vector3 from = random.uniform(0.2, 2.0) * random.direction(), to = 6.0 * random.direction();
    const Vector3 ni = random.direction();
    const Vector3 turn_axis = random.direction();
    const auto at = [&](double s) {
      return k.energy_and_gradient((1 - s) * from + s * to, ni, test::turn(turn_axis, 3 * s) * ni);
    };
    const auto jump = [&](double s, double h) {
      const PairForce a = at(s), b = at(s + h);
      return std::pair<double, double>(std::fabs(a.energy - b.energy), (a.force_j - b.force_j).norm());
    };
    for (double s = 0.001; s < 0.998; s += 1e-3) {
      // A jump would not shrink with the step; a slope does, tenfold.
      const auto coarse = jump(s, 1e-3);
      double finest_energy = 0, finest_force = 0;
      for (int m = 0; m < 10; ++m) {
        const auto fine = jump(s + m * 1e-4, 1e-4);
        finest_energy = std::max(finest_energy, fine.first);
        finest_force = std::max(finest_force, fine.second);
      }
      // Locate the worst tenth and zoom twice more.
      if (finest_energy > 1e-3 || finest_force > 1e-2) {
        double lo = s, width = 1e-3;
        double e = 0, f = 0;
        for (int zoom = 0; zoom < 6; ++zoom) {
          width /= 10;
          int worst = 0;
          e = f = -1;
          for (int m = 0; m < 10; ++m) {
            const auto fine = jump(lo + m * width, width);
            if (fine.second > f) {
              f = fine.second;
              e = fine.first;
              worst = m;
            }
          }
          lo += worst * width;
        }
        ASSERT_LT(e, 1e-2 + 1e-6 * coarse.first) << "energy jumps at s = " << lo;
        ASSERT_LT(f, 0.1 + 1e-2 * coarse.second) << "force jumps at s = " << lo;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, ContactLawTest,
                         ::testing::Values(paper_law(false), paper_law(true), line_law(3, 3, test::element_length),
                                           line_law(2, 4, 2.0), line_law(1, 1, test::element_length),
                                           line_law(3, 3, test::element_length, 2.3), paper_law(false, 3.6)),
                         [](const auto& info) { return info.param.name; });

void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }

// Shorter laws are those of the set as far as the taper, and nothing beyond their cutoff.
TEST(Cutoff, ChangesTheTailAlone) {
  const LineDensity own = test::line_density(), cut = with_cutoff(own, 2.3);
  EXPECT_NEAR(cut.cutoff(), 2.3, 1e-12);
  EXPECT_GT(cut.contact + cut.switch_gap, line_parallel_well(own).distance);
  for (double rho = 1.4; rho < std::min(own.switch_gap, cut.switch_gap) + own.contact; rho += 0.01)
    EXPECT_EQ(cut.energy(rho), own.energy(rho)) << rho;
  EXPECT_EQ(cut.energy(2.3), 0);
  EXPECT_LT(std::fabs(cut.energy(2.2)), std::fabs(own.energy(2.2)));
  const double whole = line_parallel_well(own).energy, left = line_parallel_well(cut).energy;
  EXPECT_GT(left / whole, 0.5);
  EXPECT_LT(left / whole, 1);
  const LineDensity same = with_cutoff(own, own.cutoff());
  EXPECT_NEAR(same.switch_gap, own.switch_gap, 1e-12);

  const PaperContact paper = test::published_contact(), near = with_cutoff(paper, 3.6);
  const Vector3 z = Vector3::UnitZ();
  EXPECT_NEAR(near.cutoff(), 3.6, 1e-12);
  EXPECT_EQ(near.energy({2.0, 0, 0}, z, z), paper.energy({2.0, 0, 0}, z, z));
  EXPECT_EQ(near.energy({3.61, 0, 0}, z, z), 0);
}

// Energy per length of one element beside a long parallel row, strained by `strain` and shifted along it.
double beside_row(const LineContact& k, double distance, double strain, double shift) {
  const Vector3 z = Vector3::UnitZ();
  LineContact strained = k;
  strained.length_j = k.length_j * (1 + strain);
  double sum = 0;
  // The weights are of the unstrained row: its matter is only drawn apart.
  for (int e = -6; e <= 6; ++e)
    sum += strained.energy({distance, 0, e * strained.length_j + shift}, z, z) / (1 + strain);
  return sum / k.length_i;
}

double corrugation(const LineContact& k, double distance, double strain) {
  double low = 1e300, high = -1e300;
  for (int n = 0; n < 40; ++n) {
    const double energy = beside_row(k, distance, strain, n * k.length_j / 40);
    low = std::min(low, energy), high = std::max(high, energy);
  }
  return (high - low) / std::fabs(line_parallel_well(k.density).energy);
}

LineContact chosen_rows(double radius, bool for_statics = false) {
  const LineDensity u = test::line_density(radius, radius);
  const double length = 2 * radius;
  const int nodes = line_nodes(length, line_parallel_well(u).distance, u.contact, for_statics);
  return {u, length, length, nodes, nodes};
}

// Bounds that the header of line_nodes states, for the elements that calibration makes.
TEST(LineContact, RowsHardlyCorrugateAtAnyStrain) {
  for (const double radius : {0.2, 0.27, 0.34, 0.4, 0.5, 0.6, 0.6785, 0.8, 1.0, 1.2, 1.4}) {
    const LineContact k = chosen_rows(radius);
    const double distance = line_parallel_well(k.density).distance;
    for (const double strain : {-0.02, -0.01, 0.0, 0.001, 0.01, 0.02}) {
      EXPECT_LT(corrugation(k, distance, strain), 2e-4) << radius << " nm, strain " << strain;
      EXPECT_LT(corrugation(k, distance - 0.05, strain), 4e-3) << radius << " nm, strain " << strain;
    }
    const LineContact fine = chosen_rows(radius, true);
    EXPECT_LT(corrugation(fine, distance, 0), 8e-6) << radius << " nm, for statics";
    EXPECT_LT(corrugation(fine, distance - 0.05, 0), 1e-4) << radius << " nm, for statics";
  }
}

// The first wave that both rows share, as the header has it.
TEST(LineContact, CorrugationIsTheFirstSharedWave) {
  LineContact k = chosen_rows(0.6785);
  for (const int nodes : {3, 4, 5}) {
    k.nodes_i = k.nodes_j = nodes;
    const double distance = line_parallel_well(k.density).distance, wave = 2 * units::pi * nodes / k.length_i;
    const double ripple =
        2 *
        detail::simpson([&](double t) { return k.density.energy(std::hypot(distance, t)) * std::cos(wave * t); },
                        -k.density.cutoff(), k.density.cutoff(), 4000);
    const double well = std::fabs(line_parallel_well(k.density).energy);
    EXPECT_NEAR(corrugation(k, distance, 0), 2 * std::fabs(ripple) / well, 0.03 * 2 * std::fabs(ripple) / well)
        << nodes;
  }
}

// A parallel row turns an element by nothing, wherever it stands; and i and j are alike.
TEST(LineContact, TreatsBothElementsAlike) {
  const LineContact k = chosen_rows(0.6785);
  const double distance = line_parallel_well(k.density).distance;
  const Vector3 z = Vector3::UnitZ();
  for (int n = 0; n < 40; ++n) {
    Vector3 turns = Vector3::Zero();
    for (int e = -6; e <= 6; ++e)
      turns += k.energy_and_gradient({distance, 0, (e + n / 40.0) * k.length_j}, z, z).torque_i;
    EXPECT_LT(turns.norm(), 2e-4 * std::fabs(line_parallel_well(k.density).energy) * k.length_i) << n;
  }
  Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const Pose p = random_pose(random, 1.3, 4.0);
    const PairForce f = k.energy_and_gradient(p.separation, p.ni, p.nj),
                    g = k.energy_and_gradient(-p.separation, p.nj, p.ni);
    const double size = 1 + std::fabs(f.energy);
    ASSERT_NEAR(f.energy, g.energy, 1e-12 * size);
    ASSERT_LT((f.force_j + g.force_j).norm(), 1e-11 * (1 + f.force_j.norm()));
    ASSERT_LT((f.torque_i - g.torque_j).norm(), 1e-11 * (1 + f.torque_i.norm()));
  }
}

TEST(PaperContact, LegacyTorqueBreaksAngularMomentum) {
  const PaperContact k = test::published_contact();
  const Vector3 separation(1.6, 0.2, 0.6), ni = Vector3::UnitZ(), nj = Vector3(0.1, 0.1, 1).normalized();
  const PairForce f = k.legacy_torque(separation, ni, nj);
  EXPECT_GT((f.torque_i + f.torque_j + separation.cross(f.force_j)).norm(), 1e-3);
}

TEST(PaperContact, BoundaryOfTheCoreIsSmooth) {
  const PaperContact k = test::published_contact();
  const Vector3 z = Vector3::UnitZ();
  const double at = (k.core_gap + 2) * k.radius;  // parallel: Theta = 1
  const auto slope = [&](double r) { return k.energy_and_gradient({r, 0, 0}, z, z).force_j.x(); };
  EXPECT_NEAR(slope(at - 1e-7), slope(at + 1e-7), 1e-2);
  EXPECT_GT(k.energy({0.01, 0, 0}, z, z), 1000) << "elements must not pass through one another";
}

TEST(LineContact, EnergyByAFunctionIsTheEnergy) {
  const LineDensity u = test::line_density();
  const auto exact = [&](double distance2) {
    const double rho = std::sqrt(distance2);
    return rho < u.cutoff() ? u.energy(rho) : 0.0;
  };
  const FullTable table(u, 1);
  const auto by_table = [&](double distance2) { return table.energy(distance2); };
  const LineContact k{u, test::element_length, test::element_length, 5, 4};
  Random random(7);
  for (int n = 0; n < 2000; ++n) {
    const Pose p = random_pose(random, 1.3, 4.0);
    const Vector3 nj = test::turn(p.ni.cross(random.direction()).normalized(), random.uniform(0, 0.75)) * p.ni;
    const double energy = k.energy(p.separation, p.ni, nj), size = 1 + std::fabs(energy);
    ASSERT_NEAR(k.energy_by(exact, p.separation, p.ni, nj), energy, 1e-12 * size);
    ASSERT_NEAR(k.energy_by(by_table, p.separation, p.ni, nj), energy, 1e-9 * size);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
