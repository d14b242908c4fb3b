#include "sim/contact/pair_engine.hpp"

namespace ropewalk {
namespace {

ElementSum sum_of(const Vector3& force, const Vector3& torque, double energy) {
  return {force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z(), energy};
}

}  // namespace

void PairEngine::add_chunk(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) {
  const ContactLaw& law = *in.interaction.law;
  const double cutoff2 = law.cutoff() * law.cutoff();
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const int type = in.topology.tube_type[in.topology.tube_of(i)];
    const Vector3 x_i = in.state.position[static_cast<std::size_t>(i)], n_i = in.axis[static_cast<std::size_t>(i)];
    for (const ElementSpan& span : in.list.spans(i))
      for_tubes_of(in.topology, span, [&](int tube, int begin, int end) {
        const TypePair types{type, in.topology.tube_type[tube]};
        for (int j = begin; j < end; ++j) {
          const Vector3 separation = in.state.position[static_cast<std::size_t>(j)] - x_i;
          if (!(separation.squaredNorm() < cutoff2)) continue;
          const PairForce f = law.force(types, separation, n_i, in.axis[static_cast<std::size_t>(j)]);
          sum_of(-f.force_j, f.torque_i, f.energy).add_to(out, i - chunk.written_begin);
          sum_of(f.force_j, f.torque_j, 0).add_to(out, j - chunk.written_begin);
        }
      });
  }
}

}  // namespace ropewalk
