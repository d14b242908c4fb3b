// Nodes from elements, and forces on elements from those on nodes, for any number of nodes and every instruction
// set.
#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "sim/contact/line/engine.hpp"
#include "sim/contact/line/nodes.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {

// Three parts of two tubes, the last one without rows of all nodes.
struct Rope {
  static constexpr int length = 100;
  Topology topology = test::published_topology();
  Vec3Array position{2 * length}, axis{2 * length};
  LineChunk chunk;
  std::vector<NodePlaces> places[row_kinds];

  Rope(int nodes, int sparse) {
    test::Random random(3);
    for (int t = 0; t < 2; ++t) topology.add_tube(length);
    for (std::size_t i = 0; i < position.size(); ++i) {
      position.set(i, 30 * random.direction());
      axis.set(i, random.direction());
    }
    chunk.elements = DampedBlock::most;
    for (const auto& [tube, begin, end] : {std::array{0, 3, 8}, std::array{0, 11, 57}, std::array{1, 100, 101}}) {
      TouchedPart part{tube, begin, end, chunk.elements - begin, {}};
      chunk.elements += end - begin;
      for (int kind = 0; kind < row_kinds; ++kind) {
        const int each = kind == 1 ? sparse : tube == 0 ? nodes : 0;
        part.row[kind] = {chunk.nodes[kind] - begin * each, each};
        chunk.nodes[kind] += (end - begin) * each;
      }
      chunk.parts.push_back(part);
    }
    places[0].push_back(node_places(nodes, test::element_length));
    places[1].push_back(node_places(sparse, test::element_length));
  }
  RowsOf rows() const { return {chunk, topology.tube_type, places, position, axis}; }

  // Calls f with every node: kind, part, element, its number on the element and in the rows, its place along it.
  template <class F>
  void each_node(const F& f) const {
    for (int kind = 0; kind < row_kinds; ++kind)
      for (std::size_t p = 0; p < chunk.parts.size(); ++p) {
        const TouchedPart& part = chunk.parts[p];
        const int each = part.row[kind].per_element;
        for (int e = part.begin; e < part.end; ++e)
          for (int l = 0; l < each; ++l)
            f(kind, p, e, static_cast<std::size_t>(part.row[kind].first(e) + l),
              line_node(l, each, test::element_length));
      }
  }
};

template <class C>
void expect_placed(const Rope& rope, double per_unit) {
  LineNodes<C> nodes[row_kinds];
  for (int kind = 0; kind < row_kinds; ++kind) {
    nodes[kind].per_unit = per_unit;
    nodes[kind].make_room(rope.chunk.nodes[kind]);
  }
  place_nodes(rope.rows(), nodes);
  const double off = std::is_same_v<C, double> ? 1e-12 : 0.51;
  rope.each_node([&](int kind, std::size_t, int e, std::size_t at, double s) {
    const auto i = static_cast<std::size_t>(e);
    const Vector3 there = (rope.position[i] + s * rope.axis[i]) * per_unit;
    ASSERT_NEAR(static_cast<double>(nodes[kind].x[at]), there.x(), off) << kind << ' ' << e;
    ASSERT_NEAR(static_cast<double>(nodes[kind].y[at]), there.y(), off) << kind << ' ' << e;
    ASSERT_NEAR(static_cast<double>(nodes[kind].z[at]), there.z(), off) << kind << ' ' << e;
  });
}

template <class T>
void expect_added(const Rope& rope, double tolerance) {
  NodeForces<T> forces[row_kinds];
  test::Random random(8);
  for (int kind = 0; kind < row_kinds; ++kind) {
    forces[kind].make_room(rope.chunk.nodes[kind]);
    forces[kind].start(rope.chunk.parts.size());
    // What is behind the rows, or in parts not used, is nothing to anybody.
    for (auto* v : {&forces[kind].x, &forces[kind].y, &forces[kind].z}) std::fill(v->begin(), v->end(), T(1e30));
    for (int p = 0; p < 3; ++p)
      if (p != 1 || kind == 0) forces[kind].use(rope.chunk, static_cast<Rows>(kind), p);
  }
  ContactBuffer<T> out;
  ContactBuffer<double> wanted;
  out.clear(static_cast<std::size_t>(rope.chunk.elements));
  wanted.clear(static_cast<std::size_t>(rope.chunk.elements));
  rope.each_node([&](int kind, std::size_t p, int e, std::size_t at, double s) {
    NodeForces<T>& f = forces[kind];
    if (!f.used[p]) return;
    const Vector3 force = random.direction();
    f.x[at] = static_cast<T>(force.x()), f.y[at] = static_cast<T>(force.y()), f.z[at] = static_cast<T>(force.z());
    const Vector3 torque = s * rope.axis[static_cast<std::size_t>(e)].cross(force);
    ElementSum{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z()}.add_to(
        wanted, e + rope.chunk.parts[p].element_shift);
  });
  add_node_forces(rope.rows(), forces, out);
  const auto expect_same = [&](const std::vector<T>& sums, const std::vector<double>& of) {
    for (std::size_t k = 0; k < of.size() - wanted.room; ++k)
      ASSERT_NEAR(static_cast<double>(sums[k]), of[k], tolerance) << k;
  };
  expect_same(out.fx, wanted.fx), expect_same(out.fy, wanted.fy), expect_same(out.fz, wanted.fz);
  expect_same(out.tx, wanted.tx), expect_same(out.ty, wanted.ty), expect_same(out.tz, wanted.tz);
}

TEST(LineRows, NodesAndForcesOfAnyNumberForEveryInstructionSet) {
  for (const std::string& name : instruction_sets())
    for (int nodes = 1; nodes <= 20; ++nodes) {
      SCOPED_TRACE(name + ", " + std::to_string(nodes) + " nodes");
      ASSERT_TRUE(use_instructions(name));
      const Rope rope(nodes, 1 + nodes / 2);
      expect_placed<std::int32_t>(rope, std::exp2(22));
      expect_placed<double>(rope, 1);
      expect_added<float>(rope, 1e-5);
      expect_added<double>(rope, 1e-13);
    }
  use_instructions("");
}

}  // namespace
}  // namespace ropewalk
