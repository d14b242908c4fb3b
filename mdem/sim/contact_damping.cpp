#include "sim/contact_damping.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "sim/ask_for.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact_damping.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>
//
#include "sim/some_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace damping {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, DampedBlock::most>;
using V = hn::Vec<D>;

struct Vec3 {
  V x, y, z;
};

HWY_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 operator*(V a, const Vec3& b) { return {hn::Mul(a, b.x), hn::Mul(a, b.y), hn::Mul(a, b.z)}; }
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// Of the lanes' elements, zero in the others.
struct Motion {
  Vec3 place, velocity, spin;
};

HWY_INLINE Vec3 load(const Vec3Array& a, std::ptrdiff_t at, int first, int last) {
  const D d;
  return {load_some(d, a.x.data() + at, first, last), load_some(d, a.y.data() + at, first, last),
          load_some(d, a.z.data() + at, first, last)};
}

HWY_INLINE Motion load(const State& s, std::ptrdiff_t at, int first, int last) {
  return {load(s.position, at, first, last), load(s.velocity, at, first, last),
          load(s.angular_velocity, at, first, last)};
}

// The first and the last elements of a block.
HWY_INLINE void ask_for_motion(const State& s, const DampedBlock& b) {
  const int begin = std::max(b.j, b.partners.begin), last = std::min(b.j + b.lanes + b.offsets, b.partners.end) - 1;
  for (const Vec3Array* v : {&s.position, &s.velocity, &s.angular_velocity}) {
    ask_for(*v, b.i);
    ask_for(*v, begin);
    ask_for(*v, last);
  }
}

// -eta w(R)
HWY_INLINE V strength(const ContactViscosity& c, const Vec3& separation) {
  const D d;
  const V distance = hn::Sqrt(dot(separation, separation));
  const V y = hn::Min(
      hn::Max(hn::Mul(hn::Sub(distance, hn::Set(d, c.inner)), hn::Set(d, 1 / (c.outer - c.inner))), hn::Zero(d)),
      hn::Set(d, 1.0));
  const V weight =
      hn::NegMulAdd(hn::Mul(y, y), hn::NegMulAdd(hn::Set(d, 2.0), y, hn::Set(d, 3.0)), hn::Set(d, 1.0));
  return hn::Mul(hn::Set(d, -c.eta), weight);
}

// Whole vectors: the lanes left over are zero, and the buffers have room. A masked store would make the next load
// wait until it is through.
HWY_INLINE void add_to(const Vec3& v, std::ptrdiff_t at, std::vector<double>& x, std::vector<double>& y,
                       std::vector<double>& z) {
  const D d;
  const auto add = [&](std::vector<double>& a, V what)
                       HWY_ATTR { hn::StoreU(hn::Add(hn::LoadU(d, a.data() + at), what), d, a.data() + at); };
  add(x, v.x), add(y, v.y), add(z, v.z);
}

// The blocks first .. last - 1, which are of the same elements i. Offset by offset over all of them: at the next
// offset of one block the forces are added one place further on, and a load would wait for the last stores if no
// other block came between.
HWY_INLINE V group_damping(const ContactViscosity& viscosity, const State& s, const DampedBlock* first,
                           const DampedBlock* last, int lane, ContactBuffer& out) {
  const D d;
  const V half = hn::Set(d, 0.5), zero = hn::Zero(d);
  const int own = first->i + lane, own_entry = first->at_i + lane,
            lanes = std::min(static_cast<int>(hn::Lanes(d)), first->lanes - lane);
  const Motion i = load(s, own, 0, lanes);
  Vec3 force{zero, zero, zero}, torque{zero, zero, zero};
  V power = zero;
  int offsets = 0;
  for (const DampedBlock* b = first; b != last; ++b) offsets = std::max<int>(offsets, b->offsets);
  for (int c = 0; c < offsets; ++c)
    for (const DampedBlock* b = first; b != last; ++b) {
      if (c >= b->offsets) continue;
      const int at = b->j + lane + c;
      const int begin = std::max(0, b->partners.begin - at), end = std::min(lanes, b->partners.end - at);
      if (begin >= end) continue;
      const Motion j = load(s, at, begin, end);
      const Vec3 apart = j.place - i.place;
      const Vec3 arm = half * apart;
      const Vec3 relative = j.velocity - i.velocity - cross(i.spin + j.spin, arm);
      const V k = hn::IfThenElseZero(some_lanes(d, begin, end), strength(viscosity, apart));
      const Vec3 f = k * relative, t = cross(f, arm);
      power = hn::Add(power, dot(f, relative));
      force = force - f;
      torque = torque + t;
      const std::ptrdiff_t entry = at + b->partners.shift;
      add_to(f, entry, out.fx, out.fy, out.fz);
      add_to(t, entry, out.tx, out.ty, out.tz);
    }
  add_to(force, own_entry, out.fx, out.fy, out.fz);
  add_to(torque, own_entry, out.tx, out.ty, out.tz);
  return power;
}

}  // namespace damping

void Blocks(const ContactViscosity& viscosity, const State& state, const std::vector<DampedBlock>& blocks,
            ContactBuffer& out) {
  const damping::D d;
  auto power = hn::Zero(d);
  constexpr int ahead = 4;  // blocks
  const DampedBlock* const all = blocks.data() + blocks.size();
  for (const DampedBlock *first = blocks.data(), *last = first; first != all; first = last) {
    for (; last != all && last->i == first->i; ++last)
      if (all - last > ahead) damping::ask_for_motion(state, last[ahead]);
    for (int lane = 0; lane < first->lanes; lane += static_cast<int>(hn::Lanes(d)))
      power = hn::Add(power, damping::group_damping(viscosity, state, first, last, lane, out));
  }
  out.power += hn::GetLane(hn::SumOfLanes(d, power));
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(Blocks);

void contact_damping(const ContactViscosity& viscosity, const State& state, const std::vector<DampedBlock>& blocks,
                     ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(Blocks)(viscosity, state, blocks, out);
}

void DampedBlocks::add(int i, const TouchedRange& own, int from, int to, const TouchedRange& partners) {
  if (i >= first_ + lanes_) {
    finish_group();
    first_ = i;
    lanes_ = std::min(DampedBlock::most, own.end - i);
    at_ = i + own.shift;
  }
  if (from < to) ranges_.push_back({from - i, to - i, partners});
}

void DampedBlocks::finish_group() {
  constexpr int worth_a_block = 3;  // so many offsets without a pair cost what another block does
  std::sort(ranges_.begin(), ranges_.end(), [](const Range& a, const Range& b) {
    return std::tie(a.partners.begin, a.from) < std::tie(b.partners.begin, b.from);
  });
  const auto add = [&](const Range& r) {
    blocks_.push_back(
        {first_, first_ + r.from, at_, static_cast<short>(lanes_), static_cast<short>(r.to - r.from), r.partners});
  };
  for (std::size_t k = 0; k < ranges_.size();) {
    Range all = ranges_[k];
    for (++k; k < ranges_.size() && ranges_[k].partners.begin == all.partners.begin &&
              ranges_[k].from <= all.to + worth_a_block;
         ++k)
      all.to = std::max(all.to, ranges_[k].to);
    add(all);
  }
  ranges_.clear();
}

std::vector<DampedBlock> DampedBlocks::take() {
  finish_group();
  lanes_ = 0;
  return std::exchange(blocks_, {});
}

}  // namespace ropewalk
#endif  // HWY_ONCE
