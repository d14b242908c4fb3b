#include "sim/line_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace ropewalk {
namespace {

NodeLayout layout_of(const Topology& topology, const Interaction& in) {
  NodeLayout out;
  const std::size_t types = topology.types.size();
  for (std::size_t a = 0; a < types; ++a) {
    out.per_element.push_back(in.line[a * types].nodes_i);
    for (std::size_t b = 0; b < types; ++b)
      if (in.line[a * types + b].nodes_i != out.per_element[a] ||
          in.line[b * types + a].nodes_j != out.per_element[a])
        throw std::invalid_argument("a tube type has one number of nodes towards all others");
  }
  int at = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    out.begin.push_back(at);
    at +=
        topology.length_of(t) * out.per_element[static_cast<std::size_t>(topology.tube_type[t])] + NodeLayout::pad;
  }
  out.begin.push_back(at);
  return out;
}

double unit_of(const Vec3Array& position) {
  double largest = 1;
  for (const auto* v : {&position.x, &position.y, &position.z})
    for (double x : *v)
      if (std::isfinite(x)) largest = std::max(largest, std::fabs(x));
  // Room for the lengths of elements and for what moves before the next build.
  return std::exp2(std::ceil(std::log2(largest + 64)) - 28);
}

// Squared distance of a point from the nodes' part of element i's axis.
double distance2(const Vector3& from_centre, const Vector3& axis, double half) {
  const double along = std::min(std::max(from_centre.dot(axis), -half), half);
  return (from_centre - along * axis).squaredNorm();
}

// Element i of one tube before elements of another one.
struct Side {
  const Topology& topology;
  const Interaction& in;
  const NeighbourList& list;
  const NodeLayout& layout;
  int i, tube_i, tube_j;

  // What element i can reach of first .. last before the list is built again.
  LineRun trimmed(int first, int last) const {
    const int type_i = topology.tube_type[tube_i], type_j = topology.tube_type[tube_j];
    const LineContact& law =
        in.line[static_cast<std::size_t>(type_i) * topology.types.size() + static_cast<std::size_t>(type_j)];
    const Vec3Array &x = list.reference(), &n = list.reference_axis();
    const Vector3 x_i = x[static_cast<std::size_t>(i)], n_i = n[static_cast<std::size_t>(i)];
    const double half = 0.5 * law.length_i * (1 - 1.0 / law.nodes_i), reach = law.density.cutoff() + list.skin;
    const double damped = in.damped_contact() ? in.damping.contact.outer + list.skin : 0;
    double nearest2 = reach * reach;
    LineRun run;
    run.type = static_cast<short>(type_j);
    run.element_begin = first;
    run.row = layout.first(topology, tube_j, first);
    for (int j = first; j <= last; ++j) {
      const Vector3 d = x[static_cast<std::size_t>(j)] - x_i, n_j = n[static_cast<std::size_t>(j)];
      if (d.squaredNorm() < damped * damped) {
        if (run.damped_end == 0) run.damped_begin = j;
        run.damped_end = j + 1;
      }
      const int node = layout.first(topology, tube_j, j);
      for (int l = 0; l < law.nodes_j; ++l) {
        const double d2 = distance2(d + line_node(l, law.nodes_j, law.length_j) * n_j, n_i, half);
        if (!(d2 < reach * reach)) continue;
        nearest2 = std::min(nearest2, d2);
        if (run.node_end == 0) run.node_begin = node + l;
        run.node_end = node + l + 1;
        if (run.element_end == 0) run.element_begin = j;
        run.element_end = j + 1;
      }
    }
    run.row = layout.first(topology, tube_j, run.element_begin);
    run.beyond = static_cast<float>(std::sqrt(nearest2) - law.density.cutoff() - 1e-6);
    run.begins = first == topology.tube_begin[tube_j];
    run.ends = last + 1 == topology.tube_begin[tube_j + 1];
    return run;
  }

  // Consecutive elements; the first and the last one of the tube are runs of their own.
  void add(int first, int last, std::vector<LineRun>& runs) const {
    const int begin = topology.tube_begin[tube_j] + 1, end = topology.tube_begin[tube_j + 1] - 1;
    const int cut[] = {first, std::max(first, begin), std::max(first, std::max(begin, end)), last + 1};
    for (int k = 0; k < 3; ++k) {
      const int from = cut[k], to = std::min(cut[k + 1], last + 1);
      if (from >= to) continue;
      const LineRun run = trimmed(from, to - 1);
      if (run.element_end > 0 || run.damped_end > 0) runs.push_back(run);
    }
  }
};

}  // namespace

void LineList::find_runs(const Topology& topology, const Interaction& in, const NeighbourList& list, int tube,
                         std::vector<LineRun>& runs) {
  const int* index = list.indices();
  for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i) {
    const std::size_t before = runs.size();
    const std::size_t end = list.begin(i + 1);
    int tube_j = tube;
    for (std::size_t k = list.begin(i); k < end;) {
      const int first = index[k];
      if (first >= topology.tube_begin[tube_j + 1]) tube_j = topology.tube_of(first);
      int last = first;
      for (++k; k < end && index[k] < topology.tube_begin[tube_j + 1] && index[k] == last + 1; ++k) last = index[k];
      Side{topology, in, list, layout_, i, tube, tube_j}.add(first, last, runs);
    }
    begin_[static_cast<std::size_t>(i) + 1] = runs.size() - before;
  }
}

void LineList::build(const Topology& topology, const Interaction& in, const NeighbourList& list) {
  layout_ = layout_of(topology, in);
  unit_ = unit_of(list.reference());
  begin_.assign(static_cast<std::size_t>(topology.elements()) + 1, 0);
  run_.clear();
  const int tubes = topology.tubes(), parts = std::min(tubes, 64);
  std::vector<std::vector<LineRun>> found(static_cast<std::size_t>(parts));
#pragma omp parallel for schedule(dynamic, 1) if (topology.elements() > static_cast <int>(parallel_from))
  for (int part = 0; part < parts; ++part)
    for (int t = static_cast<int>(static_cast<std::int64_t>(tubes) * part / parts);
         t < static_cast<int>(static_cast<std::int64_t>(tubes) * (part + 1) / parts); ++t)
      find_runs(topology, in, list, t, found[static_cast<std::size_t>(part)]);
  std::size_t total = 0;
  for (const auto& runs : found) total += runs.size();
  run_.reserve(total);
  for (const auto& runs : found) run_.insert(run_.end(), runs.begin(), runs.end());
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
}

}  // namespace ropewalk
