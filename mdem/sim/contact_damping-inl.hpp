// ContactViscosity::force over runs of consecutive elements, for the instruction set that the includer compiles.
// To be included after hwy/highway.h, within its loop over targets.
#include "sim/contact_kernel.hpp"

#if defined(ROPEWALK_CONTACT_DAMPING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ROPEWALK_CONTACT_DAMPING_INL
#undef ROPEWALK_CONTACT_DAMPING_INL
#else
#define ROPEWALK_CONTACT_DAMPING_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {

// The first n entries at p, the others zero; p need not be aligned and nothing behind them is read.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> load_first(D d, const double* p, std::size_t n) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET <= HWY_AVX2
  return hn::MaskedLoad(hn::FirstN(d, n), d, p);
#else
  if (n >= hn::Lanes(d)) return hn::LoadU(d, p);
  alignas(64) double some[hn::MaxLanes(d)] = {};
  for (std::size_t k = 0; k < n; ++k) some[k] = p[k];
  return hn::Load(d, some);
#endif
}

namespace damping {
namespace hn = hwy::HWY_NAMESPACE;

// Two vectors of a few lanes beat one that is half empty.
using D = hn::CappedTag<double, 4>;
using V = hn::Vec<D>;

struct Vec3 {
  V x, y, z;
};

HWY_INLINE Vec3 difference(const Vec3Array& a, int j, int i, std::size_t left) {
  const D d;
  return {hn::Sub(load_first(D(), a.x.data() + j, left), hn::Set(d, a.x[static_cast<std::size_t>(i)])),
          hn::Sub(load_first(D(), a.y.data() + j, left), hn::Set(d, a.y[static_cast<std::size_t>(i)])),
          hn::Sub(load_first(D(), a.z.data() + j, left), hn::Set(d, a.z[static_cast<std::size_t>(i)]))};
}

HWY_INLINE Vec3 sum(const Vec3Array& a, int j, int i, std::size_t left) {
  const D d;
  return {hn::Add(load_first(D(), a.x.data() + j, left), hn::Set(d, a.x[static_cast<std::size_t>(i)])),
          hn::Add(load_first(D(), a.y.data() + j, left), hn::Set(d, a.y[static_cast<std::size_t>(i)])),
          hn::Add(load_first(D(), a.z.data() + j, left), hn::Set(d, a.z[static_cast<std::size_t>(i)]))};
}

// a x b
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// -eta w(R), zero behind the run.
HWY_INLINE V strength(const ContactViscosity& c, const Vec3& separation, std::size_t left) {
  const D d;
  const V distance = hn::Sqrt(dot(separation, separation));
  const V y = hn::Min(
      hn::Max(hn::Mul(hn::Sub(distance, hn::Set(d, c.inner)), hn::Set(d, 1 / (c.outer - c.inner))), hn::Zero(d)),
      hn::Set(d, 1.0));
  const V weight =
      hn::NegMulAdd(hn::Mul(y, y), hn::NegMulAdd(hn::Set(d, 2.0), y, hn::Set(d, 3.0)), hn::Set(d, 1.0));
  return hn::IfThenElseZero(hn::FirstN(d, left), hn::Mul(hn::Set(d, -c.eta), weight));
}

// What element i and the power take from the runs.
struct Sums {
  Vec3 force, torque;
  V power;
};

// Elements j .. of a run, of which `left` are left; element j is entry j + shift of the buffer.
HWY_INLINE void few(const ContactViscosity& c, const State& s, int i, int j, int shift, std::size_t left,
                    Sums& sums, ContactBuffer& out) {
  const V half = hn::Set(D(), 0.5);
  const Vec3 apart = difference(s.position, j, i, left);
  const Vec3 arm{hn::Mul(half, apart.x), hn::Mul(half, apart.y), hn::Mul(half, apart.z)};
  const Vec3 turning = cross(sum(s.angular_velocity, j, i, left), arm);
  const Vec3 moving = difference(s.velocity, j, i, left);
  const Vec3 relative{hn::Sub(moving.x, turning.x), hn::Sub(moving.y, turning.y), hn::Sub(moving.z, turning.z)};
  const V k = strength(c, apart, left);
  const Vec3 f{hn::Mul(k, relative.x), hn::Mul(k, relative.y), hn::Mul(k, relative.z)};
  const Vec3 t = cross(f, arm);
  sums.power = hn::Add(sums.power, dot(f, relative));
  sums.force = {hn::Sub(sums.force.x, f.x), hn::Sub(sums.force.y, f.y), hn::Sub(sums.force.z, f.z)};
  sums.torque = {hn::Add(sums.torque.x, t.x), hn::Add(sums.torque.y, t.y), hn::Add(sums.torque.z, t.z)};
  const auto add = [&](std::vector<double>& a, V what) HWY_ATTR {
    // Whole vectors: the lanes left over are zero, and the buffers have room. A masked store would make the next
    // element's load wait until it is through.
    double* to = a.data() + (j + shift);
    hn::StoreU(hn::Add(hn::LoadU(D(), to), what), D(), to);
  };
  add(out.fx, f.x), add(out.fy, f.y), add(out.fz, f.z);
  add(out.tx, t.x), add(out.ty, t.y), add(out.tz, t.z);
}

// The elements first .. last - 1 of a chunk; runs(i, f) calls f(begin, end, shift) for every run of element i.
template <class Runs>
HWY_INLINE void chunk_damping(const ContactViscosity& viscosity, const State& state, int first, int last,
                              int own_shift, const Runs& runs, ContactBuffer& out) {
  const D d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const V zero = hn::Zero(d);
  Sums sums{{zero, zero, zero}, {zero, zero, zero}, zero};
  for (int i = first; i < last; ++i) {
    sums.force = sums.torque = {zero, zero, zero};
    bool any = false;
    runs(i, [&](int begin, int end, int shift) HWY_ATTR {
      any = true;
      for (int j = begin; j < end; j += lanes)
        few(viscosity, state, i, j, shift, static_cast<std::size_t>(end - j), sums, out);
    });
    if (!any) continue;
    const auto total = [&](V a) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, a)); };
    ElementSum{total(sums.force.x),
               total(sums.force.y),
               total(sums.force.z),
               total(sums.torque.x),
               total(sums.torque.y),
               total(sums.torque.z),
               0.0}
        .add_to(out, i + own_shift);
  }
  out.power += hn::GetLane(hn::SumOfLanes(d, sums.power));
}

}  // namespace damping
}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
