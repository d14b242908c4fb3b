#include "sim/contact/shared/damping.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "sim/contact/shared/wrapped.hpp"
#include "sim/state/prefetch.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "sim/contact/shared/damping.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"
//
#include "sim/vectors/lanes-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace damping {
namespace ops = vec::VEC_SET;

template <class V>
struct Vec3 {
  V x, y, z;
};

template <class V>
VEC_INLINE Vec3<V> operator+(const Vec3<V>& a, const Vec3<V>& b) {
  return {ops::Add(a.x, b.x), ops::Add(a.y, b.y), ops::Add(a.z, b.z)};
}
template <class V>
VEC_INLINE Vec3<V> operator-(const Vec3<V>& a, const Vec3<V>& b) {
  return {ops::Sub(a.x, b.x), ops::Sub(a.y, b.y), ops::Sub(a.z, b.z)};
}
template <class V>
VEC_INLINE Vec3<V> operator*(V a, const Vec3<V>& b) {
  return {ops::Mul(a, b.x), ops::Mul(a, b.y), ops::Mul(a, b.z)};
}
template <class V>
VEC_INLINE Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
  return {ops::MulSub(a.y, b.z, ops::Mul(a.z, b.y)), ops::MulSub(a.z, b.x, ops::Mul(a.x, b.z)),
          ops::MulSub(a.x, b.y, ops::Mul(a.y, b.x))};
}
template <class V>
VEC_INLINE V dot(const Vec3<V>& a, const Vec3<V>& b) {
  return ops::MulAdd(a.x, b.x, ops::MulAdd(a.y, b.y, ops::Mul(a.z, b.z)));
}

// Position, velocity and angular velocity of the elements in the lanes.
template <class Position, class V>
struct Motion {
  Vec3<Position> position;
  Vec3<V> velocity, spin;
};

// -eta w(R)
template <class D>
VEC_INLINE ops::Vec<D> strength(D d, const ContactViscosity& c, const Vec3<ops::Vec<D>>& separation) {
  using T = ops::TFromD<D>;
  const auto set = [&](double x) VEC_ATTR { return ops::Set(d, static_cast<T>(x)); };
  const auto distance = ops::Sqrt(dot(separation, separation));
  const auto y = ops::Min(
      ops::Max(ops::Mul(ops::Sub(distance, set(c.inner)), set(1 / (c.outer - c.inner))), ops::Zero(d)), set(1));
  const auto weight = ops::NegMulAdd(ops::Mul(y, y), ops::NegMulAdd(set(2), y, set(3)), set(1));
  return ops::Mul(set(-c.eta), weight);
}

// Adds whole vectors: unused lanes are zero, and the buffers have room behind the elements. After a masked store
// the next load from the same memory would have to wait.
template <class V, class T>
VEC_INLINE void add_to(const Vec3<V>& v, std::ptrdiff_t at, std::vector<T>& x, std::vector<T>& y,
                       std::vector<T>& z) {
  const ops::DFromV<V> d;
  const auto add = [&](std::vector<T>& a, V what)
                       VEC_ATTR { ops::Store(ops::Add(ops::Load(d, a.data() + at), what), d, a.data() + at); };
  add(x, v.x), add(y, v.y), add(z, v.z);
}

// Reads the state in double precision. Unused lanes are zero; they may lie outside of the state's arrays.
struct Doubles {
  using D = ops::CappedTag<double, DampedBlock::max_lanes>;
  using V = ops::Vec<D>;
  const State& state;
  ContactBuffer<double>& out;

  static VEC_INLINE Vec3<V> some(const Vec3Array& a, std::ptrdiff_t at, int first, int last) {
    const D d;
    return {load_some(d, a.x.data() + at, first, last), load_some(d, a.y.data() + at, first, last),
            load_some(d, a.z.data() + at, first, last)};
  }
  VEC_INLINE Motion<V, V> load(std::ptrdiff_t at, std::ptrdiff_t, int first, int last) const {
    return {some(state.position, at, first, last), some(state.velocity, at, first, last),
            some(state.angular_velocity, at, first, last)};
  }
  VEC_INLINE Vec3<V> apart(const Vec3<V>& j, const Vec3<V>& i) const { return j - i; }
};

// Reads the copies in single precision. Unused lanes hold other elements or arbitrary numbers.
struct Floats {
  using D = ops::CappedTag<float, DampedBlock::max_lanes>;
  using V = ops::Vec<D>;
  using Position = ops::Vec<ops::RebindToUnsigned<D>>;
  const DampedElements& elements;
  ContactBuffer<float>& out;
  float unit;

  template <class X>
  static VEC_INLINE auto whole(const X& x, const X& y, const X& z, std::ptrdiff_t at) {
    const ops::Rebind<typename X::value_type, D> d;
    return Vec3<ops::Vec<decltype(d)>>{ops::Load(d, x.data() + at), ops::Load(d, y.data() + at),
                                       ops::Load(d, z.data() + at)};
  }
  VEC_INLINE Motion<Position, V> load(std::ptrdiff_t, std::ptrdiff_t entry, int, int) const {
    const DampedElements& e = elements;
    return {whole(e.x, e.y, e.z, entry), whole(e.vx, e.vy, e.vz, entry), whole(e.wx, e.wy, e.wz, entry)};
  }
  VEC_INLINE Vec3<V> apart(const Vec3<Position>& j, const Vec3<Position>& i) const {
    const D d;
    const ops::RebindToSigned<D> whole;
    const Vec3<Position> in_units = j - i;
    const auto number = [&](const Position& modulo)
                            VEC_ATTR { return ops::ConvertTo(d, ops::BitCast(whole, modulo)); };
    return ops::Set(d, unit) * Vec3<V>{number(in_units.x), number(in_units.y), number(in_units.z)};
  }
};

// Evaluates the blocks first .. last - 1, which have the same elements i. The outer loop is over offsets:
// consecutive offsets of one block write to overlapping memory, and a load would wait for the preceding store if no
// other block came between. Returns the power in each lane.
template <class Of>
VEC_INLINE typename Of::V group_damping(const ContactViscosity& viscosity, const Of& of, const DampedBlock* first,
                                        const DampedBlock* last, int lane) {
  using V = typename Of::V;
  using T = ops::TFromD<typename Of::D>;
  const typename Of::D d;
  const V half = ops::Set(d, static_cast<T>(0.5)), zero = ops::Zero(d);
  const int own = first->i + lane, own_entry = first->at_i + lane,
            lanes = std::min(static_cast<int>(ops::Lanes(d)), first->lanes - lane);
  const auto i = of.load(own, own_entry, 0, lanes);
  Vec3<V> force{zero, zero, zero}, torque{zero, zero, zero};
  V power = zero;
  int offsets = 0;
  for (const DampedBlock* b = first; b != last; ++b) offsets = std::max<int>(offsets, b->offsets);
  for (int c = 0; c < offsets; ++c)
    for (const DampedBlock* b = first; b != last; ++b) {
      if (c >= b->offsets) continue;
      const int at = b->j + lane + c, entry = at + b->partners.shift;
      const int begin = std::max(0, b->partners.begin - at), end = std::min(lanes, b->partners.end - at);
      if (begin >= end) continue;
      const auto j = of.load(at, entry, begin, end);
      const Vec3<V> apart = of.apart(j.position, i.position);
      const Vec3<V> arm = half * apart;
      const Vec3<V> relative = j.velocity - i.velocity - cross(i.spin + j.spin, arm);
      const V k = ops::IfThenElseZero(some_lanes(d, begin, end), strength(d, viscosity, apart));
      const Vec3<V> f = k * relative, t = cross(f, arm);
      power = ops::Add(power, dot(f, relative));
      force = force - f;
      torque = torque + t;
      add_to(f, entry, of.out.fx, of.out.fy, of.out.fz);
      add_to(t, entry, of.out.tx, of.out.ty, of.out.tz);
    }
  add_to(force, own_entry, of.out.fx, of.out.fy, of.out.fz);
  add_to(torque, own_entry, of.out.tx, of.out.ty, of.out.tz);
  return power;
}

// Returns the power of all blocks. Every 32 groups the sums in the lanes are added to a total in double precision.
template <class Of>
VEC_INLINE double all_groups(const ContactViscosity& viscosity, const Of& of,
                             const std::vector<DampedBlock>& blocks) {
  const typename Of::D d;
  constexpr int few = 32;
  double sum = 0;
  auto power = ops::Zero(d);
  int groups = 0;
  const auto add_up = [&]() VEC_ATTR {
    sum += static_cast<double>(ops::SumOfLanes(power));
    power = ops::Zero(d);
  };
  const DampedBlock* const all = blocks.data() + blocks.size();
  for (const DampedBlock *first = blocks.data(), *last = first; first != all; first = last) {
    while (last != all && last->i == first->i) ++last;
    for (int lane = 0; lane < first->lanes; lane += static_cast<int>(ops::Lanes(d)))
      power = ops::Add(power, group_damping(viscosity, of, first, last, lane));
    if (++groups % few == 0) add_up();
  }
  add_up();
  return sum;
}

// Copies the elements of a part, whole vectors at a time. The last vector may reach beyond the part; the elements
// of the next part then overwrite its surplus lanes.
VEC_INLINE void take(const State& s, const BufferRange& of, double per_unit, DampedElements& e) {
  const ops::CappedTag<double, 8> d;
  const ops::RebindToUnsigned<decltype(d)> bits;
  const ops::Rebind<std::uint32_t, decltype(d)> whole;
  const ops::Rebind<float, decltype(d)> floats;
  const auto units = ops::Set(d, per_unit);
  const int lanes = static_cast<int>(ops::Lanes(d));
  for (int k = of.begin; k < of.end; k += lanes) {
    const int left = std::min(of.end - k, lanes), entry = k + of.shift;
    const auto some = [&](const Column& v) VEC_ATTR { return load_some(d, v.data() + k, 0, left); };
    const auto position = [&](const Column& from, std::vector<std::uint32_t>& to) VEC_ATTR {
      const auto rounded = ops::MulAdd(some(from), units, ops::Set(d, rounds_to_whole));
      const auto number = ops::ShiftRight<bits_behind_point>(ops::BitCast(bits, rounded));
      ops::Store(ops::ConvertTo(whole, number), whole, to.data() + entry);
    };
    const auto motion = [&](const Column& from, std::vector<float>& to)
                            VEC_ATTR { ops::Store(ops::ConvertTo(floats, some(from)), floats, to.data() + entry); };
    position(s.position.x, e.x), position(s.position.y, e.y), position(s.position.z, e.z);
    motion(s.velocity.x, e.vx), motion(s.velocity.y, e.vy), motion(s.velocity.z, e.vz);
    motion(s.angular_velocity.x, e.wx), motion(s.angular_velocity.y, e.wy), motion(s.angular_velocity.z, e.wz);
  }
}

}  // namespace damping

double BlocksOfState(const ContactViscosity& viscosity, const State& state, const std::vector<DampedBlock>& blocks,
                     ContactBuffer<double>& out) {
  return damping::all_groups(viscosity, damping::Doubles{state, out}, blocks);
}

double BlocksInFloats(const ContactViscosity& viscosity, const State& state, const DampedChunk& of,
                      DampedElements& e, ContactBuffer<float>& out) {
  constexpr std::size_t ahead = 4;  // parts
  for (std::size_t k = 0; k < of.parts.size(); ++k) {
    if (k + ahead < of.parts.size())
      for (const Vec3Array* v : {&state.velocity, &state.angular_velocity})
        prefetch(*v, of.parts[k + ahead].begin, of.parts[k + ahead].end);
    damping::take(state, of.parts[k], 1 / of.unit, e);
  }
  return damping::all_groups(viscosity, damping::Floats{e, out, static_cast<float>(of.unit)}, of.blocks);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(BlocksOfState);
VEC_EXPORT(BlocksInFloats);

double contact_damping(const ContactViscosity& viscosity, const State& state,
                       const std::vector<DampedBlock>& blocks, ContactBuffer<double>& out) {
  return VEC_IN_USE(BlocksOfState)(viscosity, state, blocks, out);
}

double contact_damping(const ContactViscosity& viscosity, const State& state, const DampedChunk& of,
                       DampedElements& elements, ContactBuffer<float>& out) {
  return VEC_IN_USE(BlocksInFloats)(viscosity, state, of, elements, out);
}

void DampedBlocks::add(int i, const BufferRange& own, int from, int to, const BufferRange& partners) {
  if (i >= first_ + lanes_) {
    finish_group();
    first_ = i;
    lanes_ = std::min(DampedBlock::max_lanes, own.end - i);
    at_ = i + own.shift;
  }
  if (from < to) ranges_.push_back({from - i, to - i, partners});
}

void DampedBlocks::finish_group() {
  constexpr int worth_a_block = 3;  // offsets without a pair that cost as much as another block
  std::sort(ranges_.begin(), ranges_.end(), [](const Offsets& a, const Offsets& b) {
    return std::tie(a.partners.begin, a.from) < std::tie(b.partners.begin, b.from);
  });
  const auto add = [&](const Offsets& r) {
    blocks_.push_back(
        {first_, first_ + r.from, at_, static_cast<short>(lanes_), static_cast<short>(r.to - r.from), r.partners});
  };
  for (std::size_t k = 0; k < ranges_.size();) {
    Offsets all = ranges_[k];
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
#endif  // VEC_ONCE
