#include <algorithm>

#include "sim/contact/shared/damping.hpp"
#include "sim/forces/forces.hpp"
#include "sim/forces/terms/damping_terms.hpp"

namespace ropewalk {
namespace {

class ContactViscosityTerm : public ForceTerm {
 public:
  explicit ContactViscosityTerm(const ContactViscosity& viscosity) : viscosity_(viscosity) {}

  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<ContactViscosityTerm>(*this); }
  std::string name() const override { return "contact_viscosity"; }

  void prepare(const ListedScene& scene) override { unit_ = scene.list.coordinate_unit(); }
  double pair_reach() const override { return viscosity_.outer; }
  void start_chunks(std::size_t count) override { chunks_.assign(count, {}); }

  void list_chunk(std::size_t chunk, const ChunkPairs& pairs) override {
    DampedBlocks blocks;
    std::vector<BufferRange> at(
        static_cast<std::size_t>(pairs.entries()));  // indexed by the first entry of a range
    const auto mark = [&](const BufferRange& range) {
      at[static_cast<std::size_t>(range.begin + range.shift)] = range;
    };
    pairs.each([&](const NearElements& near) {
      BufferRange own = near.own;
      own.end = std::min(own.end, near.own_end);
      blocks.add(near.i, own, near.from, near.to, near.partners);
      mark(near.own);
      mark(near.partners);
    });
    Chunk& out = chunks_[chunk];
    out.blocks = blocks.take();
    out.entries = pairs.entries();
    for (const BufferRange& range : at)
      if (range.begin < range.end) out.ranges.push_back(range);
  }

  TermSum add_pairs(const State& state, std::size_t chunk, const PairBuffer& buffer) override {
    const Chunk& of = chunks_[chunk];
    if (of.blocks.empty()) return {};
    if (buffer.doubles) return {0, contact_damping(viscosity_, state, of.blocks, *buffer.doubles)};
    thread_local DampedElements elements;
    elements.resize(of.entries);
    return {0, contact_damping(viscosity_, state, {of.blocks, of.ranges, unit_}, elements, *buffer.floats)};
  }

  bool add_reference(const Topology& topology, const Interaction& in, const State& s, Forces& out) const override {
    if (!in.has_contact()) return true;
    const double reach = std::min(viscosity_.outer, in.cutoff());
    for_all_pairs(topology, in, [&](int a, int b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      const Vector3 separation = s.position[j] - s.position[i];
      if (!(separation.norm() < reach)) return;
      add_pair(
          viscosity_.force(separation, s.velocity[i], s.angular_velocity[i], s.velocity[j], s.angular_velocity[j]),
          i, j, out);
    });
    return true;
  }

  std::size_t bytes() const override {
    std::size_t total = 0;
    for (const Chunk& chunk : chunks_)
      total += chunk.blocks.size() * sizeof(DampedBlock) + chunk.ranges.size() * sizeof(BufferRange);
    return total;
  }

 private:
  struct Chunk {
    std::vector<DampedBlock> blocks;
    std::vector<BufferRange> ranges;  // ranges of the elements in the blocks
    int entries = 0;
  };

  ContactViscosity viscosity_;
  double unit_ = 1;  // unit of positions in single precision, nm
  std::vector<Chunk> chunks_;
};

}  // namespace

std::unique_ptr<ForceTerm> contact_viscosity_term(const ContactViscosity& viscosity) {
  return std::make_unique<ContactViscosityTerm>(viscosity);
}

}  // namespace ropewalk
