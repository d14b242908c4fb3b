#include <algorithm>
#include <cmath>

#include "sim/contact_kernel.hpp"

namespace ropewalk {
namespace {

constexpr int block = 256;  // nodes of neighbouring elements

// Nodes of the neighbours of one element, all of one tube type, relative to its centre.
struct NodeBlock {
  alignas(64) double x[block], y[block], z[block];
  alignas(64) double fx[block], fy[block], fz[block];  // on them
  int element[block];                                  // one entry per element, `nodes` nodes each
  int elements = 0;
};

// Forces between one node, at (px, py, pz) from the centre, and the block; what the node feels and the energy.
struct NodeSum {
  double fx, fy, fz, energy;
};

inline __attribute__((always_inline)) NodeSum evaluate(const LineDensity& density, NodeBlock& b, int count,
                                                       double px, double py, double pz) {
  const LineDensity law = density;  // a local copy: the compiler need not fear that the stores below change it
  double fx = 0, fy = 0, fz = 0, energy = 0;
#pragma omp simd reduction(+ : fx, fy, fz, energy)
  for (int m = 0; m < count; ++m) {
    const double dx = b.x[m] - px, dy = b.y[m] - py, dz = b.z[m] - pz;
    const double rho = std::sqrt(std::max(dx * dx + dy * dy + dz * dz, 1e-12));
    const RadialTerms t = law.terms(rho);
    const double f = -t.derivative / rho;
    energy += t.energy;
    b.fx[m] += f * dx;
    b.fy[m] += f * dy;
    b.fz[m] += f * dz;
    fx -= f * dx;
    fy -= f * dy;
    fz -= f * dz;
  }
  return {fx, fy, fz, energy};
}

// All nodes of element i with those of the block; then forces and torques of the block's elements.
inline __attribute__((always_inline)) void flush(const ContactInput& in, const LineContact& law, int i,
                                                 const NeighbourList::Chunk& chunk, NodeBlock& b, ElementSum& sum,
                                                 ContactBuffer& out) {
  const int nodes = law.nodes_j, count = b.elements * nodes;
  const double nx = in.axis->x[i], ny = in.axis->y[i], nz = in.axis->z[i];
  const double weight = law.length_i / law.nodes_i * law.length_j / nodes;
  std::fill_n(b.fx, count, 0.0);
  std::fill_n(b.fy, count, 0.0);
  std::fill_n(b.fz, count, 0.0);
  for (int k = 0; k < law.nodes_i; ++k) {
    const double s = line_node(k, law.nodes_i, law.length_i);
    const double px = s * nx, py = s * ny, pz = s * nz;
    const NodeSum f = evaluate(law.density, b, count, px, py, pz);
    sum.energy += weight * f.energy;
    sum.fx += weight * f.fx;
    sum.fy += weight * f.fy;
    sum.fz += weight * f.fz;
    sum.tx += weight * (py * f.fz - pz * f.fy);
    sum.ty += weight * (pz * f.fx - px * f.fz);
    sum.tz += weight * (px * f.fy - py * f.fx);
  }
  for (int e = 0; e < b.elements; ++e) {
    const int j = b.element[e], at = j - chunk.touched_begin;
    double fx = 0, fy = 0, fz = 0, mx = 0, my = 0, mz = 0;
    for (int l = 0; l < nodes; ++l) {
      const int m = e * nodes + l;
      const double s = line_node(l, nodes, law.length_j);
      fx += b.fx[m];
      fy += b.fy[m];
      fz += b.fz[m];
      mx += s * b.fx[m];
      my += s * b.fy[m];
      mz += s * b.fz[m];
    }
    const double jx = in.axis->x[j], jy = in.axis->y[j], jz = in.axis->z[j];
    out.fx[at] += weight * fx;
    out.fy[at] += weight * fy;
    out.fz[at] += weight * fz;
    out.tx[at] += weight * (jy * mz - jz * my);
    out.ty[at] += weight * (jz * mx - jx * mz);
    out.tz[at] += weight * (jx * my - jy * mx);
  }
  b.elements = 0;
}

// Whether any node of j can be within reach of the axis of i: the distance of j's centre from the line through i,
// less what its inclination can take off.
bool within_reach(const LineContact& law, const Vector3& d, const Vector3& n_i, const Vector3& n_j) {
  const double along = d.dot(n_i), c = n_i.dot(n_j);
  const double half_j = 0.5 * law.length_j * (1 - 1.0 / law.nodes_j);
  const double across =
      std::sqrt(std::max(d.squaredNorm() - along * along, 0.0)) - half_j * std::sqrt(std::max(1 - c * c, 0.0));
  if (across >= law.density.cutoff()) return false;
  const double half_i = 0.5 * law.length_i * (1 - 1.0 / law.nodes_i);
  return std::fabs(along) - half_i - half_j * std::fabs(c) < law.density.cutoff();
}

}  // namespace

ROPEWALK_VECTOR_CLONES
void line_contact(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  const Topology& topology = *in.topology;
  const Interaction& interaction = *in.interaction;
  const int types = static_cast<int>(topology.types.size());
  const bool damped = interaction.damped_contact();
  const int* index = in.list->indices();
  NodeBlock b;
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const Vector3 x_i = in.state->position[i], n_i = (*in.axis)[i];
    const int type_i = topology.tube_type[(*in.tube)[i]];
    ElementSum sum;
    int type_j = -1;  // of the block
    const LineContact* law = nullptr;
    for (std::size_t k = in.list->begin(i); k < in.list->begin(i + 1); ++k) {
      const int j = index[k];
      const int type = topology.tube_type[(*in.tube)[j]];
      if (type != type_j) {
        if (law) flush(in, *law, i, chunk, b, sum, out);
        type_j = type;
        law = &interaction.line[static_cast<std::size_t>(type_i * types + type)];
      }
      const Vector3 d = in.state->position[j] - x_i, n_j = (*in.axis)[j];
      if (damped && d.norm() < interaction.damping.contact.outer)
        damp_pair(in, i, j, d, chunk.touched_begin, sum, out);
      if (!within_reach(*law, d, n_i, n_j)) continue;
      if ((b.elements + 1) * law->nodes_j > block) flush(in, *law, i, chunk, b, sum, out);
      b.element[b.elements] = j;
      for (int l = 0; l < law->nodes_j; ++l) {
        const double s = line_node(l, law->nodes_j, law->length_j);
        const int m = b.elements * law->nodes_j + l;
        b.x[m] = d.x() + s * n_j.x();
        b.y[m] = d.y() + s * n_j.y();
        b.z[m] = d.z() + s * n_j.z();
      }
      ++b.elements;
    }
    if (b.elements > 0) flush(in, *law, i, chunk, b, sum, out);
    sum.add_to(out, i - chunk.touched_begin);
  }
}

}  // namespace ropewalk
