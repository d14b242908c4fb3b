// Nodes from elements, and forces on elements from those on nodes, for any number of nodes and every instruction
// set.
#include "sim/contact/line/nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "sim/contact/line/engine.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// Three ranges of two tubes.
struct Rope {
  static constexpr int length = 100;
  Topology topology = test::published_topology();
  Vec3Array position{2 * length}, axis{2 * length};
  LineChunk chunk;
  std::vector<NodeOffsets> offsets;

  explicit Rope(int nodes) {
    test::Random random(3);
    for (int t = 0; t < 2; ++t) topology.add_tube(length);
    for (std::size_t i = 0; i < position.size(); ++i) {
      position.set(i, 30 * random.direction());
      axis.set(i, random.direction());
    }
    chunk.elements = LineList::room_before;
    for (const auto& [tube, begin, end] : {std::array{0, 3, 8}, std::array{0, 11, 57}, std::array{1, 100, 101}}) {
      chunk.ranges.push_back({tube, begin, end, chunk.elements - begin, chunk.nodes - begin * nodes, nodes});
      chunk.elements += end - begin;
      chunk.nodes += (end - begin) * nodes;
    }
    offsets.push_back(node_offsets(nodes, test::element_length));
  }
  NodeInput input() const { return {chunk, topology.tube_type, offsets, position, axis}; }

  // Calls f with every node: its range, its element, its number in the chunk, its place along the element (nm).
  template <class F>
  void each_node(const F& f) const {
    for (const WrittenRange& range : chunk.ranges)
      for (int e = range.begin; e < range.end; ++e)
        for (int l = 0; l < range.nodes_per_element; ++l)
          f(range, e, static_cast<std::size_t>(range.first_node(e) + l),
            line_node(l, range.nodes_per_element, test::element_length));
  }
};

template <class C>
void expect_positioned(const Rope& rope, double unit) {
  NodePositions<C> nodes;
  nodes.reserve(rope.chunk.nodes);
  position_nodes(rope.input(), unit, nodes);
  // A whole number is off by half a unit, and by two roundings to quarters before (wrapped.hpp).
  const double off = std::is_same_v<C, double> ? 1e-12 : 0.76;
  const auto expect_at = [&](C found, double there, int e) {
    ASSERT_NEAR(std::remainder(static_cast<double>(found) - there, 0x1p32), 0, off) << e;
  };
  rope.each_node([&](const WrittenRange&, int e, std::size_t at, double s) {
    const auto i = static_cast<std::size_t>(e);
    const Vector3 there = (rope.position[i] + s * rope.axis[i]) / unit;
    expect_at(nodes.x[at], there.x(), e);
    expect_at(nodes.y[at], there.y(), e);
    expect_at(nodes.z[at], there.z(), e);
  });
}

template <class T>
void expect_added(const Rope& rope, double tolerance) {
  NodeForces<T> forces;
  test::Random random(8);
  forces.clear(rope.chunk.nodes);
  ContactBuffer<T> out;
  ContactBuffer<double> wanted;
  out.clear(static_cast<std::size_t>(rope.chunk.elements));
  wanted.clear(static_cast<std::size_t>(rope.chunk.elements));
  rope.each_node([&](const WrittenRange& range, int e, std::size_t at, double s) {
    const Vector3 force = random.direction();
    forces.x[at] = static_cast<T>(force.x());
    forces.y[at] = static_cast<T>(force.y());
    forces.z[at] = static_cast<T>(force.z());
    const Vector3 torque = s * rope.axis[static_cast<std::size_t>(e)].cross(force);
    ElementSum{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z()}.add_to(wanted,
                                                                                           e + range.element_shift);
  });
  // The entries behind the last node belong to nobody.
  for (auto* v : {&forces.x, &forces.y, &forces.z})
    std::fill(v->begin() + rope.chunk.nodes, v->end(), static_cast<T>(1e30));
  add_node_forces(rope.input(), forces, out);
  const auto expect_same = [&](const std::vector<T>& sums, const std::vector<double>& of) {
    for (std::size_t k = 0; k < of.size() - wanted.room; ++k)
      ASSERT_NEAR(static_cast<double>(sums[k]), of[k], tolerance) << k;
  };
  expect_same(out.fx, wanted.fx), expect_same(out.fy, wanted.fy), expect_same(out.fz, wanted.fz);
  expect_same(out.tx, wanted.tx), expect_same(out.ty, wanted.ty), expect_same(out.tz, wanted.tz);
}

TEST(LineNodes, PositionsAndForcesOfAnyNumberForEveryInstructionSet) {
  for (const std::string& name : instruction_sets())
    for (int nodes = 1; nodes <= 20; ++nodes) {
      SCOPED_TRACE(name + ", " + std::to_string(nodes) + " nodes");
      ASSERT_TRUE(use_instructions(name));
      const Rope rope(nodes);
      expect_positioned<std::int32_t>(rope, std::exp2(-24));
      expect_positioned<double>(rope, 1);
      expect_added<float>(rope, 1e-5);
      expect_added<double>(rope, 1e-13);
    }
  use_instructions("");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
