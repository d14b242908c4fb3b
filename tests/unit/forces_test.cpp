// The fast path is held to the reference by one body, for every variant of the interaction.
#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>

#include "scene/lattice.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/contact/shared/neighbour_spans.hpp"
#include "sim/dynamics/simulation.hpp"
#include "sim/state/part_of_scene.hpp"
#include "sim/threads/vector_unit.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

enum class Kind { paper, line, mixed, shaped };

struct Variant {
  std::string name;
  Kind kind;
  bool general_powers;
  bool legacy;
  double eta, rate;
  double disorder;
  Interaction::Precision precision = Interaction::Precision::full;
  double cutoff = 0;  // nm; 0: the law's
  int nodes = 5;      // of an element, by the line law
};

// Between a thick tube type and a thin one.
std::vector<LineContact> contacts_with_thin_ones() {
  return {test::line_contact(0.6785, 5, 0.6785, 5), test::line_contact(0.6785, 5, 0.34, 8),
          test::line_contact(0.34, 8, 0.6785, 5), test::line_contact(0.34, 8, 0.34, 8)};
}

class ForcesTest : public ::testing::TestWithParam<Variant> {
 protected:
  void SetUp() override {
    const Variant& v = GetParam();
    topology = test::published_topology();
    state = test::disordered_bundle(topology, 7, 80, 1.75, v.disorder, 21);
    if (v.kind == Kind::paper) {
      PaperContact contact = test::published_contact();
      if (v.general_powers) contact.alpha = 9.3;
      if (v.cutoff > 0) contact = with_cutoff(contact, v.cutoff);
      in.law = paper_law(contact, v.legacy);
    } else {
      std::vector<LineContact> pairs = {test::line_contact(0.6785, v.nodes, 0.6785, v.nodes)};
      if (v.kind == Kind::mixed || v.kind == Kind::shaped) pairs = mix_tube_types();
      if (v.kind == Kind::shaped) topology.types[0].bond = test::shaped_bond();
      if (v.cutoff > 0)
        for (LineContact& pair : pairs) pair.density = with_cutoff(pair.density, v.cutoff);
      in.law = line_law(pairs);
    }
    in.precision = v.precision;
    in.exclude_along_tube = 3 * test::element_length;
    in.damping.contact = {v.eta, 1.713, 2.57};
    in.damping.bond.rate = v.rate;
  }

  // Every second tube is a thin one, with other masses and with anharmonic bonds.
  std::vector<LineContact> mix_tube_types() {
    TubeType thin = topology.types[0];
    thin.radius = 0.34;
    thin.mass *= 0.5;
    thin.inertia *= 0.125;
    thin.bond = test::anharmonic_bond();
    topology.types.push_back(thin);
    for (int t = 1; t < topology.tubes(); t += 2) topology.tube_type[t] = 1;
    return contacts_with_thin_ones();
  }

  Forces fast(double skin, int threads, Parts parts = Parts::all) const {
    omp_set_num_threads(threads);
    NeighbourList list(in, skin);
    list.build(topology, state);
    ForceEngine engine;
    Forces f(state.size());
    engine.compute(topology, in, list, state, f, {parts});
    return f;
  }

  // Double precision: rounding, and for the line law the tables (1e-11 of the steepest force). Mixed: places to
  // 1e-7 nm or better, tables to 1e-5 of the force, and powers up to 10.5 of rounded gaps in the paper law. Where
  // tubes lie inside each other, the couple of the share is a difference of energies of 1e5 eV with seven digits.
  double tolerance() const {
    if (in.precision == Interaction::Precision::mixed) return GetParam().disorder > 0.4 ? 5e-5 : 2e-5;
    return GetParam().kind == Kind::paper ? 1e-12 : 1e-10;
  }

  Topology topology;
  State state;
  Interaction in;
};

void expect_equal(const Forces& a, const Forces& b, double relative) {
  double scale_f = 0, scale_t = 0;
  for (std::size_t i = 0; i < a.force.size(); ++i) {
    scale_f = std::max(scale_f, b.force[i].norm());
    scale_t = std::max(scale_t, b.torque[i].norm());
  }
  for (std::size_t i = 0; i < a.force.size(); ++i) {
    ASSERT_LT((a.force[i] - b.force[i]).norm(), relative * scale_f) << "element " << i;
    ASSERT_LT((a.torque[i] - b.torque[i]).norm(), relative * scale_t) << "element " << i;
  }
  EXPECT_NEAR(a.energy.vdw, b.energy.vdw, relative * std::fabs(b.energy.vdw));
  EXPECT_NEAR(a.energy.bonds(), b.energy.bonds(), relative * b.energy.bonds());
  EXPECT_NEAR(a.damping_power, b.damping_power, relative * std::fabs(b.damping_power));
}

TEST_P(ForcesTest, FastEqualsReference) {
  Forces reference(state.size());
  compute_reference(topology, in, state, reference);
  EXPECT_GT(std::fabs(reference.energy.vdw), 50);  // the scene does have contacts
  expect_equal(fast(0.0, 1), reference, tolerance());
  expect_equal(fast(0.4, 2), reference, tolerance());
}

// Bonds of a natural shape, by the loops of every vector unit that this processor has.
TEST(ShapedForces, EqualReferenceByEveryVectorUnit) {
  Topology topology = test::published_topology();
  topology.types[0].bond = test::shaped_bond();
  const State state = test::disordered_bundle(topology, 3, 41, 1.75, 0.2, 5);
  const Interaction in;
  Forces reference(state.size());
  compute_reference(topology, in, state, reference);
  EXPECT_GT(reference.energy.bend, 10);
  const VectorUnit own = vector_unit_in_use();
  NeighbourList list(in, 0);
  list.build(topology, state);
  for (const VectorUnit unit : {VectorUnit::base, VectorUnit::v3, VectorUnit::v4}) {
    if (unit > own) continue;
    use_vector_unit(unit);
    Forces f(state.size());
    ForceEngine().compute(topology, in, list, state, f);
    expect_equal(f, reference, 1e-12);
  }
  use_vector_unit(own);
}

// The forces as several processes compute them: `owner` of each element; copies are all elements within reach of
// own ones.
Forces by_parts(const Topology& topology, const Interaction& in, const State& state, const std::vector<int>& owner,
                double skin = 0.2) {
  Forces sum(state.size());
  const double reach = copy_reach(topology, in, skin);
  for (int process = 0; process <= *std::max_element(owner.begin(), owner.end()); ++process) {
    std::vector<int> number;
    std::vector<char> own;
    for (int i = 0; i < topology.elements(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      bool near = owner[at] == process;
      for (std::size_t k = 0; k < owner.size() && !near; ++k)
        near = owner[k] == process && (state.position[k] - state.position[at]).norm() < reach;
      if (!near) continue;
      number.push_back(i);
      own.push_back(owner[at] == process);
    }
    const State part = part_of_state(state, number);
    const Topology pieces = part_of_scene(topology, number, own);
    NeighbourList list(in, skin);
    list.build(pieces, part);
    ForceEngine engine;
    Forces f(part.size());
    engine.compute(pieces, in, list, part, f);
    for (std::size_t k = 0; k < number.size(); ++k) {
      sum.force.add(static_cast<std::size_t>(number[k]), f.force[k]);
      sum.torque.add(static_cast<std::size_t>(number[k]), f.torque[k]);
    }
    sum.energy.stretch += f.energy.stretch;
    sum.energy.shear += f.energy.shear;
    sum.energy.bend += f.energy.bend;
    sum.energy.twist += f.energy.twist;
    sum.energy.vdw += f.energy.vdw;
    sum.damping_power += f.damping_power;
  }
  return sum;
}

// Forces are as accurate at the far end of a rope of millimetres. In double precision the coordinates of nodes are
// rounded to the last digit of their size.
TEST_P(ForcesTest, FastEqualsReferenceFarFromTheOrigin) {
  for (const Vector3& by : {Vector3(130.3, -129.1, 512), Vector3(7500.7, -2.1e5, 5.0e6)}) {
    SCOPED_TRACE(by.z());
    State far = state;
    for (std::size_t i = 0; i < far.size(); ++i) far.position.add(i, by);
    std::swap(far, state);
    Forces reference(state.size());
    compute_reference(topology, in, state, reference);
    expect_equal(fast(0.4, 2), reference, in.precision == Interaction::Precision::mixed ? tolerance() : 1e-6);
    std::swap(far, state);
  }
}

TEST_P(ForcesTest, PartsOfTheSceneAddUpToIt) {
  const Forces whole = fast(0.2, 2);
  const double mixed = in.precision == Interaction::Precision::mixed ? tolerance() : 1e-12;
  test::Random random(8);
  std::vector<int> slices, scattered, one, pairs;
  for (int i = 0; i < topology.elements(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    slices.push_back(std::clamp(static_cast<int>(state.position.z[at] / 30), 0, 3));
    scattered.push_back(random.uniform(0, 1) < 0.5 ? 0 : 2);  // process 1 has none
    one.push_back(i == 100 ? 1 : 0);
    pairs.push_back(i / 2 % 2);
  }
  for (const auto& owner : {slices, scattered, one, pairs})
    expect_equal(by_parts(topology, in, state, owner), whole, mixed);
}

// A hairpin whose arms do not touch by the exclusion, cut so that a process has both arms and not the bend.
TEST(PartOfScene, TheExclusionAlongATubeIsThatOfTheScene) {
  Topology topology = test::published_topology();
  constexpr int arm = 12, head = 4;
  constexpr double a = test::element_length, apart = 1.9;
  topology.add_tube(2 * arm + head);
  State state(static_cast<std::size_t>(topology.elements()));
  for (int i = 0; i < topology.elements(); ++i) {
    const int back = i - arm - head;
    const auto at = static_cast<std::size_t>(i);
    state.position.set(at, i < arm     ? Vector3(0, 0, a * i)
                           : back >= 0 ? Vector3(apart, 0, a * (arm - 1 - back))
                                       : Vector3(0.5 * apart, 0, a * (arm + 2 + i - arm)));
  }
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 5, 0.6785, 5)});
  std::vector<int> owner;
  for (std::size_t i = 0; i < state.size(); ++i) owner.push_back(state.position.z[i] < 3.5 * a ? 0 : 1);
  for (const double excluded : {40.0 * a, 3.0 * a}) {
    in.exclude_along_tube = excluded;
    NeighbourList list(in, 0.2);
    list.build(topology, state);
    ForceEngine engine;
    Forces whole(state.size());
    engine.compute(topology, in, list, state, whole);
    EXPECT_EQ(whole.energy.vdw == 0, excluded > 20 * a);
    const Forces parts = by_parts(topology, in, state, owner);
    EXPECT_NEAR(parts.energy.vdw, whole.energy.vdw, 1e-12 * std::fabs(whole.energy.vdw));
    for (std::size_t i = 0; i < state.size(); ++i)
      EXPECT_LT((parts.force[i] - whole.force[i]).norm(), 1e-12 * (1 + whole.force[i].norm())) << i;
  }
}

TEST_P(ForcesTest, BondsAndContactAddUpToAll) {
  const Forces all = fast(0.2, 2), bonds = fast(0.2, 2, Parts::bonds), contact = fast(0.2, 2, Parts::contact);
  EXPECT_EQ(bonds.energy.vdw, 0);
  EXPECT_EQ(contact.energy.bonds(), 0);
  EXPECT_EQ(bonds.energy.bonds(), all.energy.bonds());
  EXPECT_EQ(contact.energy.vdw, all.energy.vdw);
  Forces sum = contact;
  for (std::size_t i = 0; i < sum.force.size(); ++i) {
    sum.force.add(i, bonds.force[i]);
    sum.torque.add(i, bonds.torque[i]);
  }
  sum.energy = all.energy;
  sum.damping_power += bonds.damping_power;
  expect_equal(sum, all, 1e-13);
}

void expect_same_bits(const Forces& a, const Forces& b) {
  for (const auto& [of_a, of_b] : {std::pair(&a.force, &b.force), std::pair(&a.torque, &b.torque)}) {
    EXPECT_EQ(of_a->x, of_b->x);
    EXPECT_EQ(of_a->y, of_b->y);
    EXPECT_EQ(of_a->z, of_b->z);
  }
  EXPECT_EQ(a.damping_power, b.damping_power);
}

TEST_P(ForcesTest, SameBitsOnAnyNumberOfThreads) {
  const Forces one = fast(0.2, 1);
  for (int threads : {2, 3, 5}) {
    const Forces many = fast(0.2, threads);
    expect_same_bits(one, many);
    EXPECT_EQ(one.energy.vdw, many.energy.vdw);
  }
}

TEST_P(ForcesTest, SameBitsWhoeverReadsEnergies) {
  NeighbourList list(in, 0.2);
  list.build(topology, state);
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(use_instructions(name));
    Forces with(state.size()), without(state.size());
    ForceEngine engine;
    engine.compute(topology, in, list, state, with);
    engine.compute(topology, in, list, state, without, {Parts::all, false});
    expect_same_bits(with, without);
  }
  use_instructions("");
}

TEST_P(ForcesTest, NetForceAndTorqueVanish) {
  const Forces f = fast(0.2, 2);
  const NetForce net = net_force(state, f);
  double scale = 0;
  for (std::size_t i = 0; i < f.force.size(); ++i) scale += f.force[i].norm();
  const bool mixed = in.precision == Interaction::Precision::mixed;
  EXPECT_LT(net.force.norm(), (mixed ? 1e-7 : 1e-13) * scale);
  if (GetParam().legacy) {
    EXPECT_GT(net.torque.norm(), 1e-6 * scale) << "what the published code leaves out should show";
  } else if (mixed) {
    EXPECT_LT(net.torque.norm(), 1e-5 * scale);
  } else {
    EXPECT_LT(net.torque.norm(), 1e-11 * scale);
  }
}

TEST_P(ForcesTest, EveryInstructionSetEqualsReference) {
  Forces reference(state.size());
  compute_reference(topology, in, state, reference);
  const std::vector<std::string> sets = instruction_sets();
  EXPECT_FALSE(sets.empty());
  for (const std::string& name : sets) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(use_instructions(name));
    expect_equal(fast(0.3, 2), reference, tolerance());
  }
  EXPECT_FALSE(use_instructions("abacus"));
  use_instructions("");
}

Variant single(const char* name, double disorder, bool general = false, bool legacy = false, double eta = 0) {
  return {name, Kind::paper, general, legacy, eta, eta > 0 ? 1.0 : 0.0, disorder, Interaction::Precision::mixed};
}

Variant with_nodes(const char* name, int nodes, Interaction::Precision precision) {
  return {name, Kind::line, false, false, 0, 0, 0.05, precision, 0, nodes};
}

Variant shortened(const char* name, Kind kind, double cutoff,
                  Interaction::Precision precision = Interaction::Precision::full) {
  return {name, kind, false, false, 0, 0, 0.05, precision, cutoff};
}

const std::vector<Variant> paper_variants = {Variant{"Ordered", Kind::paper, false, false, 0, 0, 1e-3},
                                             Variant{"Disordered", Kind::paper, false, false, 0, 0, 0.08},
                                             Variant{"Overlapping", Kind::paper, false, false, 0, 0, 0.3},
                                             Variant{"General", Kind::paper, true, false, 0, 0, 0.05},
                                             shortened("Shortened", Kind::paper, 3.6),
                                             Variant{"Legacy", Kind::paper, false, true, 0, 0, 0.05},
                                             Variant{"GeneralLegacy", Kind::paper, true, true, 0, 0, 0.05},
                                             Variant{"Damped", Kind::paper, false, false, 20, 1, 0.05},
                                             single("Single", 0.05),
                                             single("SingleOrdered", 1e-3),
                                             single("SingleOverlapping", 0.3),
                                             single("SingleDamped", 0.08, false, false, 20),
                                             single("SingleGeneral", 0.05, true),
                                             single("SingleLegacy", 0.05, false, true)};

const std::vector<Variant> line_variants = {
    Variant{"Line", Kind::line, false, false, 0, 0, 0.05},
    Variant{"LineOverlapping", Kind::line, false, false, 0, 0, 0.5},
    Variant{"LineDamped", Kind::line, false, false, 20, 1, 0.05},
    Variant{"LineOrdered", Kind::line, false, false, 0, 0, 1e-3}, shortened("LineShortened", Kind::line, 2.3),
    shortened("LineSingleShortened", Kind::line, 2.3, Interaction::Precision::mixed),
    // Numbers that the kernel's compiler knows, and such that it does not.
    with_nodes("LineOneNode", 1, Interaction::Precision::full),
    with_nodes("LineManyNodes", 21, Interaction::Precision::full),
    with_nodes("LineSingleThreeNodes", 3, Interaction::Precision::mixed),
    with_nodes("LineSingleFourNodes", 4, Interaction::Precision::mixed),
    with_nodes("LineSingleSixNodes", 6, Interaction::Precision::mixed),
    with_nodes("LineSingleManyNodes", 21, Interaction::Precision::mixed),
    Variant{"LineTypes", Kind::mixed, false, false, 0, 0, 0.1},
    Variant{"LineShaped", Kind::shaped, false, false, 20, 1, 0.1},
    Variant{"LineSingle", Kind::line, false, false, 0, 0, 0.05, Interaction::Precision::mixed},
    Variant{"LineSingleOrdered", Kind::line, false, false, 0, 0, 1e-3, Interaction::Precision::mixed},
    Variant{"LineSingleOverlapping", Kind::line, false, false, 0, 0, 0.5, Interaction::Precision::mixed},
    Variant{"LineSingleTypes", Kind::mixed, false, false, 20, 1, 0.1, Interaction::Precision::mixed}};

std::string name_of(const ::testing::TestParamInfo<Variant>& info) { return info.param.name; }

// The contact by the line law, every part of a tube finished once, and its elements sent away then.
Forces line_contact_of(const Topology& topology, const Interaction& in, const State& start,
                       std::size_t at_once_from, int threads) {
  omp_set_num_threads(threads);
  NeighbourList list(in, 0.2);
  list.build(topology, start);
  State state = start;
  Vec3Array axis(state.size());
  LineEngine engine;
  engine.finish_at_once_from = at_once_from;
  Forces out(state.size());
  const TubeParts parts(topology);
  ForceTerms terms;
  terms.use(in);
  terms.prepare(topology, list, state);
  terms.begin(state, parts.count());
  std::vector<std::atomic<int>> times(static_cast<std::size_t>(parts.count()));
  const auto place = [&](int t) {
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i)
      axis.set(static_cast<std::size_t>(i), axis_of(state.orientation[static_cast<std::size_t>(i)]));
  };
  const auto send_away = [&](std::size_t i) {
    state.position.set(i, Vector3(1e4, 1e4, 1e4));
    state.orientation.set(i, Quaternion(0, 1, 0, 0));
    state.velocity.set(i, Vector3(1e4, 0, 0));
    state.angular_velocity.set(i, Vector3(0, 1e4, 0));
    axis.set(i, Vector3(1, 0, 0));
  };
  const auto finish = [&](int block) {
    for (int k = parts.block_begin(block); k < parts.block_begin(block + 1); ++k) {
      ++times[static_cast<std::size_t>(k)];
      engine.add_to(k, rows_of(out));
      for (int i = parts[k].begin; i < parts[k].end; ++i) send_away(static_cast<std::size_t>(i));
    }
  };
  engine.compute(topology, in, list, state, axis, true, {parts, place, finish, terms.pairs()});
  for (const auto& n : times) EXPECT_EQ(n, 1);
  terms.sum_up(out, 0);
  out.energy.vdw = engine.energy();
  return out;
}

constexpr std::size_t at_once = 0, in_the_end = 1000000;

// Whichever thread finishes a block, and whether at once or after all chunks.
class LineFinish : public ForcesTest {
 protected:
  Forces collected(std::size_t at_once_from, int threads) const {
    return line_contact_of(topology, in, state, at_once_from, threads);
  }
};

TEST_P(LineFinish, SameBitsAtOnceOrInTheEnd) {
  const Forces end = collected(in_the_end, 1);
  EXPECT_GT(std::fabs(end.energy.vdw), 50);
  for (int threads : {1, 2, 5}) {
    const Forces soon = collected(at_once, threads);
    expect_same_bits(end, soon);
    EXPECT_EQ(end.energy.vdw, soon.energy.vdw);
  }
}

// Tubes that several threads work on: each part has the bonds to the parts beside it, and their energy is counted
// once.
class LongTubes : public ForcesTest {
 protected:
  void SetUp() override {
    ForcesTest::SetUp();
    topology = test::published_topology();
    state = test::disordered_bundle(topology, 2, 1300, 1.75, 0.05, 22);
    const TubeParts parts(topology);
    ASSERT_EQ(parts.count(), 6);
    cut_ = static_cast<std::size_t>(parts[0].end);
  }
  std::size_t cut_ = 0;
};

TEST_P(LongTubes, EqualReferenceWithTheSameBitsOnAnyNumberOfThreads) {
  Forces reference(state.size());
  compute_reference(topology, in, state, reference);
  const Forces one = fast(0.3, 1);
  expect_equal(one, reference, tolerance());
  for (int threads : {2, 5}) expect_same_bits(one, fast(0.3, threads));
}

TEST_P(LongTubes, ASlippingBondIsFoundWhereTheyAreCut) {
  for (const std::size_t first : {cut_ - 2, cut_ - 1, cut_}) {
    const State straight = state;
    for (std::size_t i = first + 1; i < 1300; ++i) {
      const Vector3 axis = axis_of(state.orientation[first]);
      state.orientation.set(i, Quaternion(Eigen::AngleAxisd(units::degree * 120, axis)) * state.orientation[i]);
    }
    EXPECT_EQ(fast(0.3, 2).slipping_bond, static_cast<int>(first));
    state = straight;
  }
}

INSTANTIATE_TEST_SUITE_P(Paper, LongTubes, ::testing::Values(paper_variants[1]), name_of);
INSTANTIATE_TEST_SUITE_P(Line, LongTubes, ::testing::Values(line_variants[0], line_variants[2]), name_of);
INSTANTIATE_TEST_SUITE_P(Line, LineFinish, ::testing::ValuesIn(line_variants), name_of);
INSTANTIATE_TEST_SUITE_P(Paper, ForcesTest, ::testing::ValuesIn(paper_variants), name_of);
INSTANTIATE_TEST_SUITE_P(Line, ForcesTest, ::testing::ValuesIn(line_variants), name_of);

void PrintTo(const Variant& v, std::ostream* out) { *out << v.name; }

// Tubes at all angles, among them right ones, and one that comes back to itself: long runs, many short ones. The
// last one has no neighbour.
State crossed_and_closed(Topology& topology) {
  for (int t = 0; t < 14; ++t) topology.add_tube(30);
  State state(static_cast<std::size_t>(topology.elements()));
  for (int t = 0; t < 12; ++t) {
    const double angle = t * units::degree * 15;
    const Vector3 along(std::cos(angle), std::sin(angle), 0);
    for (int e = 0; e < 30; ++e) {
      const auto i = static_cast<std::size_t>(30 * t + e);
      state.position.set(i, (e - 14.5) * test::element_length * along + Vector3(0, 0, 1.6 * t));
      state.orientation.set(i, Quaternion::FromTwoVectors(Vector3::UnitZ(), along));
    }
  }
  for (int e = 0; e < 30; ++e) {  // a ring of 20 elements, one and a half times around
    const double angle = 2 * M_PI * e / 20;
    const Vector3 along(-std::sin(angle), std::cos(angle), 0);
    const auto i = static_cast<std::size_t>(360 + e);
    state.position.set(i, Vector3(4.3 * std::cos(angle), 4.3 * std::sin(angle), 30 + 0.09 * e));
    state.orientation.set(i, Quaternion::FromTwoVectors(Vector3::UnitZ(), along));
  }
  for (int e = 0; e < 30; ++e) {
    const auto i = static_cast<std::size_t>(390 + e);
    state.position.set(i, Vector3((e - 14.5) * test::element_length, 0, 24));
    state.orientation.set(i, Quaternion::FromTwoVectors(Vector3::UnitZ(), Vector3::UnitX()));
  }
  return state;
}

TEST(PaperForces, CrossedAndClosedTubesEqualReference) {
  Topology topology = test::published_topology();
  const State state = crossed_and_closed(topology);
  Interaction in;
  in.law = paper_law(test::published_contact());
  in.exclude_along_tube = 7 * test::element_length;
  Forces reference(state.size());
  compute_reference(topology, in, state, reference);
  NeighbourList list(in, 0.3);
  list.build(topology, state);
  for (const auto& [precision, bound] :
       {std::pair(Interaction::Precision::full, 1e-12), std::pair(Interaction::Precision::mixed, 2e-5)}) {
    in.precision = precision;
    ForceEngine engine;
    Forces f(state.size());
    engine.compute(topology, in, list, state, f);
    expect_equal(f, reference, bound);
  }
}

TEST(LineForces, CrossedAndClosedTubesEqualReference) {
  Topology topology = test::published_topology();
  for (TubeType& type : topology.types) type.bond = {};
  State state = crossed_and_closed(topology);
  test::set_velocities(topology, 300, state);
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.damping.contact = {20, 1.713, 2.57};
  in.exclude_along_tube = 7 * test::element_length;
  for (const auto& [precision, bound] :
       {std::pair(Interaction::Precision::full, 1e-10),
        std::pair(Interaction::Precision::mixed, 5e-5)}) {  // as far as tubes lie inside each other
    in.precision = precision;
    Forces reference(state.size());
    compute_reference(topology, in, state, reference);
    for (const std::size_t from : {at_once, in_the_end})
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(testing::Message() << "at once from " << from << ", threads " << threads);
        expect_equal(line_contact_of(topology, in, state, from, threads), reference, bound);
      }
  }
}

// Tubes on helices about z, `twist` rad/nm of them: neighbours cross at angles that change along each.
State twisted_rope(Topology& topology, double twist, double spacing) {
  constexpr int elements = 16;
  const auto places = hexagonal_lattice(37, spacing);
  for (std::size_t t = 0; t < places.size(); ++t) topology.add_tube(elements);
  State state(static_cast<std::size_t>(topology.elements()));
  std::size_t i = 0;
  for (const auto& [x, y] : places) {
    const Vector3 along = Vector3(-twist * y, twist * x, 1).normalized();
    for (int e = 0; e < elements; ++e, ++i) {
      const double z = (e - 0.5 * (elements - 1)) * test::element_length * along.z();
      const Quaternion by = test::turn(Vector3::UnitZ(), twist * z);
      state.position.set(i, by * Vector3(x, y, 0) + Vector3(0, 0, z));
      state.orientation.set(i, by * Quaternion::FromTwoVectors(Vector3::UnitZ(), along));
    }
  }
  return state;
}

void shake(double amplitude, State& state) {
  test::Random random(8);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.position.add(i, amplitude * random.direction());
    state.orientation.set(i, test::turn(random.direction(), 0.2 * amplitude) * state.orientation[i]);
  }
}

// More tubes in one chunk than the viscosity adds up in single precision.
TEST(LineForces, ViscosityOfManyTubesEqualsReference) {
  constexpr int elements = 8;
  Topology topology = test::published_topology();
  State state(61 * elements);
  std::size_t i = 0;
  for (const auto& [x, y] : hexagonal_lattice(61, 1.7)) {
    topology.add_tube(elements);
    for (int e = 0; e < elements; ++e, ++i) state.position.set(i, {x, y, e * test::element_length});
  }
  shake(0.02, state);
  test::set_velocities(topology, 300, state);
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.damping.contact = {20, 1.713, 2.57};
  for (const auto& [precision, bound] :
       {std::pair(Interaction::Precision::full, 1e-10), std::pair(Interaction::Precision::mixed, 1e-5)}) {
    in.precision = precision;
    Forces reference(state.size()), fast(state.size());
    compute_reference(topology, in, state, reference);
    NeighbourList list(in, 0.2);
    list.build(topology, state);
    ASSERT_EQ(list.chunks().size(), 1u);
    ForceEngine engine;
    engine.compute(topology, in, list, state, fast);
    expect_equal(fast, reference, bound);
  }
}

TEST(LineForces, TwistedRopesEqualReferenceAlsoWhereTheListIsWorn) {
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  // 12, 29 and 60 degrees on the outside, with more room where tubes lie askew.
  for (const auto& [twist, spacing] : {std::pair(0.04, 1.8), std::pair(0.1, 1.9), std::pair(0.25, 2.3)}) {
    Topology topology = test::published_topology();
    const State state = twisted_rope(topology, twist, spacing);
    for (const auto& [precision, bound] :
         {std::pair(Interaction::Precision::full, 1e-10), std::pair(Interaction::Precision::mixed, 2e-5)}) {
      in.precision = precision;
      NeighbourList list(in, 0.25);
      list.build(topology, state);
      State later = state;
      shake(0.03, later);
      ASSERT_FALSE(list.update(topology, later));
      Forces reference(state.size());
      compute_reference(topology, in, later, reference);
      for (const std::string& name : instruction_sets()) {
        SCOPED_TRACE(testing::Message() << name << ", " << twist << " rad/nm");
        ASSERT_TRUE(use_instructions(name));
        ForceEngine engine;
        Forces fast(state.size());
        engine.compute(topology, in, list, later, fast);
        expect_equal(fast, reference, bound);
      }
      use_instructions("");
    }
  }
}

// Two tubes of elements far shorter than the reach, side by side.
State many_short_elements(Topology& topology) {
  State state(400);
  test::Random random(3);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state.position.set(i, Vector3(i < 200 ? 0.0 : 1.7, 0, 0.03 * static_cast<double>(i % 200)));
    state.orientation.set(i, test::turn(random.direction(), 0.1));
    state.velocity.set(i, 0.3 * random.direction());
  }
  topology.types[0].bond = {};
  topology.add_tube(200);
  topology.add_tube(200);
  return state;
}

// In both precisions; `exact` bounds the difference in double.
void expect_many_pairs_equal_reference(const Topology& topology, const State& state, Interaction in, double exact) {
  in.exclude_along_tube = 200 * test::element_length;
  Forces reference(state.size()), f(state.size());
  compute_reference(topology, in, state, reference);
  NeighbourList list(in, 0.3);
  list.build(topology, state);
  ASSERT_GT(list.pairs(100), 2u * NeighbourSpan::longest);
  for (const auto& [precision, bound] :
       {std::pair(Interaction::Precision::full, exact), std::pair(Interaction::Precision::mixed, 2e-5)}) {
    in.precision = precision;
    ForceEngine engine;
    engine.compute(topology, in, list, state, f);
    expect_equal(f, reference, bound);
  }
}

// Spans of neighbours longer than one NeighbourSpan.
TEST(LineForces, ManyPairsEqualReference) {
  Topology topology = test::published_topology();
  topology.types[0].element_length = 0.03;
  const State state = many_short_elements(topology);
  Interaction in;
  in.law = line_law({LineContact{test::line_density(), 0.03, 0.03, 1, 1}});
  in.damping.contact = {20, 1.713, 2.57};
  expect_many_pairs_equal_reference(topology, state, in, 1e-10);
}

// More pairs than a block of the kernel holds.
TEST(PaperForces, ManyPairsEqualReference) {
  Topology topology = test::published_topology();
  const State state = many_short_elements(topology);
  Interaction in;
  in.law = paper_law(test::published_contact());
  expect_many_pairs_equal_reference(topology, state, in, 1e-12);
}

// A tube beside others in a line, whose elements are numbered on from one to the next.
TEST(Forces, OfRunsThatGoOnIntoTheNextTubeEqualReference) {
  Topology topology = test::published_topology();
  TubeType thin = topology.types[0];
  thin.radius = 0.34;
  topology.types.push_back(thin);
  topology.add_tube(14);
  topology.add_tube(3);
  topology.add_tube(4, 1);
  topology.add_tube(4);
  State state(static_cast<std::size_t>(topology.elements()));
  test::Random random(8);
  const double length = topology.types[0].element_length;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto along = static_cast<double>(i < 14 ? i : i - 14);
    state.position.set(i, Vector3(i < 14 ? 0.0 : 1.6, 0, length * along) + 0.02 * random.direction());
    state.orientation.set(i, test::turn(random.direction(), 0.05));
    state.velocity.set(i, 0.3 * random.direction());
    state.angular_velocity.set(i, 0.3 * random.direction());
  }
  Interaction paper, line;
  paper.law = paper_law(test::published_contact());
  line.law = line_law(contacts_with_thin_ones());
  for (Interaction in : {paper, line}) {
    in.exclude_along_tube = 3 * test::element_length;
    in.damping.contact = {20, 1.713, 2.57};
    in.precision = Interaction::Precision::full;
    NeighbourList list(in, 0.2);
    list.build(topology, state);
    bool goes_on = false;
    for (const ElementSpan& span : list.spans(3))
      goes_on |= topology.tube_of(span.begin) != topology.tube_of(span.end - 1);
    ASSERT_TRUE(goes_on);
    Forces reference(state.size()), f(state.size());
    compute_reference(topology, in, state, reference);
    ForceEngine engine;
    engine.compute(topology, in, list, state, f);
    expect_equal(f, reference, 1e-10);
  }
}

// Buffers are used again for more and for less.
TEST(Forces, OfOneEngineForScenesOfOtherSizesAreTheSameBits) {
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.damping.contact = {20, 1.713, 2.57};
  in.precision = Interaction::Precision::mixed;
  ForceEngine used;
  for (const int elements : {200, 20, 150, 210}) {
    Topology topology = test::published_topology();
    const State state = test::disordered_bundle(topology, 7, elements, 1.75, 0.1, 21);
    NeighbourList list(in, 0.25);
    list.build(topology, state);
    Forces wanted(state.size()), found(state.size());
    ForceEngine fresh;
    fresh.compute(topology, in, list, state, wanted);
    used.compute(topology, in, list, state, found);
    expect_same_bits(wanted, found);
  }
}

std::vector<int> neighbours(const NeighbourList& list, int i) {
  std::vector<int> all;
  list.for_neighbours(i, [&](int j) { all.push_back(j); });
  return all;
}

NeighbourList bundle_list(const Topology& topology, const State& s) {
  NeighbourList list;
  list.cutoff = 3.1;
  list.skin = 0.2;
  list.excluded_arc = 2 * test::element_length;
  list.build(topology, s);
  return list;
}

TEST(ElementSpans, HoldThePairsOfTheListWithinReach) {
  Topology topology = test::published_topology();
  const State s = test::disordered_bundle(topology, 7, 40, 1.8, 0.2, 5);
  const NeighbourList list = bundle_list(topology, s);
  ElementSpans all, near;
  all.build(list, list.cutoff);
  near.build(list, 2.0);
  for (int i = 0; i < topology.elements(); ++i) {
    std::vector<int> of_all, of_near, truth;
    for (const ElementSpan& r : all.spans(i))
      for (int j = r.begin; j < r.end; ++j) of_all.push_back(j);
    for (const ElementSpan& r : near.spans(i))
      for (int j = r.begin; j < r.end; ++j) of_near.push_back(j);
    ASSERT_EQ(of_all, neighbours(list, i));
    for (int j : of_all)
      if ((s.position[j] - s.position[i]).norm() < 2.2) truth.push_back(j);
    ASSERT_EQ(of_near, truth) << "element " << i;
  }
}

TEST(ElementSpans, AreCutAtTheirLongest) {
  Topology topology = test::published_topology();
  topology.add_tube(1);
  topology.add_tube(200);
  Vec3Array p(201), axis(201);
  for (std::size_t i = 1; i < p.size(); ++i) p.set(i, {1.0, 0, 0.01 * static_cast<double>(i)});
  NeighbourList list;
  list.cutoff = 5;
  list.excluded_arc = 200 * test::element_length;
  list.build(topology, p, axis);
  ElementSpans spans;
  spans.build(list, 5);
  int next = 1;
  for (const ElementSpan& r : spans.spans(0)) {
    EXPECT_EQ(r.begin, next);
    EXPECT_LE(r.end - r.begin, ElementSpans::longest);
    next = r.end;
  }
  EXPECT_EQ(next, 201);
}

TEST(NeighbourList, FindsExactlyThePairsWithinReach) {
  Topology topology = test::published_topology();
  const State s = test::disordered_bundle(topology, 7, 40, 1.8, 0.2, 5);
  const NeighbourList list = bundle_list(topology, s);
  std::size_t expected = 0;
  for (int i = 0; i < topology.elements(); ++i) {
    std::vector<int> truth;
    for (int j = i + 1; j < topology.elements(); ++j) {
      const bool near = (s.position[j] - s.position[i]).norm() < 3.3;
      const bool excluded = topology.tube_of(i) == topology.tube_of(j) && j - i <= 2;
      if (near && !excluded) truth.push_back(j);
    }
    ASSERT_EQ(neighbours(list, i), truth) << "element " << i;
    ASSERT_EQ(list.pairs(i), truth.size()) << "element " << i;
    int end = -1;
    for (const ElementSpan& span : list.spans(i)) {
      ASSERT_GT(span.begin, end) << "two runs that could be one, element " << i;
      end = span.end;
    }
    expected += truth.size();
  }
  EXPECT_EQ(list.pairs(), expected);
}

TEST(NeighbourList, ChunksHaveEqualNumbersOfPairs) {
  Topology topology = test::published_topology();
  const State s = test::disordered_bundle(topology, 7, 200, 1.8, 0.2, 5);
  const NeighbourList list = bundle_list(topology, s);
  ASSERT_GT(list.chunks().size(), 3u);
  std::size_t most = 0;
  for (int i = 0; i < topology.elements(); ++i) most = std::max(most, list.pairs(i));
  for (const NeighbourList::Chunk& chunk : list.chunks()) {
    std::size_t pairs = 0;
    for (int i = chunk.begin; i < chunk.end; ++i) pairs += list.pairs(i);
    EXPECT_LE(pairs, list.pairs() / list.chunks().size() + 1 + most);
  }
}

// A rope that turns and twists as a whole, by several times the skin at its rim.
TEST(NeighbourList, TurningTogetherNeedsNoBuild) {
  Topology topology = test::published_topology();
  const State start = test::disordered_bundle(topology, 7, 40, 1.72, 0.02, 5);
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.precision = Interaction::Precision::full;
  in.damping.contact = {20, 1.713, 2.57};
  NeighbourList list(in, 0.25);
  list.build(topology, start);
  ForceEngine engine;
  double farthest = 0;
  for (int step = 1; step <= 40; ++step) {
    State s = start;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const Quaternion by = test::turn(Vector3::UnitZ(), step * (0.003 + 2e-5 * s.position[i].z()));
      s.position.set(i, by * start.position[i]);
      s.orientation.set(i, by * start.orientation[i]);
      farthest = std::max(farthest, (s.position[i] - start.position[i]).norm());
    }
    ASSERT_FALSE(list.update(topology, s)) << step;
    if (step % 20 != 0) continue;
    Forces fast(s.size()), reference(s.size());
    engine.compute(topology, in, list, s, fast);
    compute_reference(topology, in, s, reference);
    expect_equal(fast, reference, 1e-10);
  }
  EXPECT_GT(farthest, 0.25);
  // A force on one alone still counts.
  State s = start;
  s.position.add(20, {0.14, 0, 0});
  EXPECT_TRUE(list.update(topology, s));
}

TEST(NeighbourList, SparseSceneNeedsNoHugeGrid) {
  Topology topology = test::published_topology();
  topology.add_tube(1);
  topology.add_tube(1);
  Vec3Array p(2);
  p.set(1, {1e7, 1e7, 1e7});
  NeighbourList list;
  list.cutoff = 5;
  list.build(topology, p, Vec3Array(2));
  EXPECT_EQ(list.pairs(), 0u);
  p.set(1, {1e300, std::nan(""), 0});
  list.build(topology, p, Vec3Array(2));  // ends, without memory for a grid of that size
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
