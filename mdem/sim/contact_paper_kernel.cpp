// The paper law over runs of neighbours, for every instruction set that the compiler knows and in two precisions;
// the machine's best is picked at run time. The runs of an element are copied one after another, so that the law
// (contact_paper.hpp, vectorised by the compiler) meets full vectors however short they are.
#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

#include "sim/paper_engine.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact_paper_kernel.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include "sim/contact_damping-inl.hpp"

#ifndef ROPEWALK_PAPER_SCRATCH
#define ROPEWALK_PAPER_SCRATCH
namespace ropewalk {

// Rows of T, aligned for vectors.
template <class T, int rows>
class AlignedRows {
 public:
  static constexpr std::size_t lanes = 16;  // the length of a row is a multiple of it

  explicit AlignedRows(std::size_t length)
      : stride_((length + lanes - 1) / lanes * lanes), data_(new (alignment) T[rows * stride_]()) {}
  T* operator[](int row) const { return data_.get() + static_cast<std::size_t>(row) * stride_; }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(T* p) const { ::operator delete[](p, alignment); }
  };
  std::size_t stride_;
  std::unique_ptr<T[], Free> data_;
};

}  // namespace ropewalk
#endif

HWY_BEFORE_NAMESPACE();
namespace ropewalk::HWY_NAMESPACE {
namespace paper {
namespace hn = hwy::HWY_NAMESPACE;

// What a chunk works in. The pairs of one element, one after another: places and axes of the neighbours, forces
// (eV/nm) and torques (eV) on them; and these on all elements that the chunk touches.
template <class T>
struct Scratch {
  using C = typename PaperElements<T>::Coordinate;
  static constexpr std::size_t lanes = AlignedRows<T, 1>::lanes;
  AlignedRows<C, 3> x;
  AlignedRows<T, 3> n;
  AlignedRows<T, 6> on_pairs, on_elements;

  // Runs are copied in whole vectors, hence the room behind.
  Scratch(std::size_t pairs, std::size_t elements)
      : x(pairs + lanes), n(pairs + lanes), on_pairs(pairs + lanes), on_elements(elements + lanes) {}
};

// The place and the axis of the element that the loop stands at.
template <class T>
struct Centre {
  typename Scratch<T>::C x[3];
  T n[3];
};

template <class T>
HWY_INLINE void copy_run(const PaperElements<T>& from, const PairRun& run, std::size_t at, const Scratch<T>& to) {
  const hn::CappedTag<typename Scratch<T>::C, 8> dc;
  const hn::CappedTag<T, 8> dt;
  const std::size_t lanes = hn::Lanes(dt), end = static_cast<std::size_t>(run.end);
  const auto *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
  const auto *nx = from.nx.data(), *ny = from.ny.data(), *nz = from.nz.data();
  for (auto j = static_cast<std::size_t>(run.begin); j < end; j += lanes, at += lanes) {
    hn::StoreU(hn::LoadU(dc, x + j), dc, to.x[0] + at);
    hn::StoreU(hn::LoadU(dc, y + j), dc, to.x[1] + at);
    hn::StoreU(hn::LoadU(dc, z + j), dc, to.x[2] + at);
    hn::StoreU(hn::LoadU(dt, nx + j), dt, to.n[0] + at);
    hn::StoreU(hn::LoadU(dt, ny + j), dt, to.n[1] + at);
    hn::StoreU(hn::LoadU(dt, nz + j), dt, to.n[2] + at);
  }
}

// The forces on the elements of a run, the first of them at `first` in the chunk.
template <class T>
HWY_INLINE void add_run(const Scratch<T>& s, std::size_t at, std::size_t count, std::size_t first) {
  const hn::CappedTag<T, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t m = 0; m < count; m += lanes) {
    const auto wanted = hn::FirstN(d, count - m);
    for (int k = 0; k < 6; ++k) {
      T* to = s.on_elements[k] + first + m;
      const auto f = hn::IfThenElseZero(wanted, hn::LoadU(d, s.on_pairs[k] + at + m));
      hn::StoreU(hn::Add(hn::LoadU(d, to), f), d, to);
    }
  }
}

// Copies of the last pair but far away, where the law is zero, up to whole vectors.
template <class T>
HWY_INLINE std::size_t fill_up(const Scratch<T>& s, std::size_t count, const Centre<T>& centre, double far) {
  for (; count % Scratch<T>::lanes != 0; ++count) {
    s.x[0][count] = static_cast<typename Scratch<T>::C>(centre.x[0] + far);
    for (int a = 1; a < 3; ++a) s.x[a][count] = centre.x[a];
    for (int a = 0; a < 3; ++a) s.n[a][count] = centre.n[a];
  }
  return count;
}

// Whether an axis is so far from a right angle to n_i that one bisector will do.
template <class T>
HWY_INLINE bool oblique(const Scratch<T>& s, std::size_t count, const Centre<T>& centre, T blend) {
  const T *nx = s.n[0], *ny = s.n[1], *nz = s.n[2];
  const T nix = centre.n[0], niy = centre.n[1], niz = centre.n[2];
  T least = 1;
#pragma omp simd reduction(min : least)
  for (std::size_t m = 0; m < count; ++m) {
    const T c = nix * nx[m] + niy * ny[m] + niz * nz[m];
    least = std::min(least, std::fabs(c));
  }
  return least < blend;
}

template <class Powers, bool blended, bool legacy, bool energies, class T>
HWY_INLINE ElementSum evaluate(const PaperTerms<T>& law, const Scratch<T>& s, std::size_t count,
                               const Centre<T>& centre, T unit) {
  const auto *x = s.x[0], *y = s.x[1], *z = s.x[2];
  const auto xi = centre.x[0], yi = centre.x[1], zi = centre.x[2];
  const T *nx = s.n[0], *ny = s.n[1], *nz = s.n[2];
  const T nix = centre.n[0], niy = centre.n[1], niz = centre.n[2];
  T *ofx = s.on_pairs[0], *ofy = s.on_pairs[1], *ofz = s.on_pairs[2];
  T *otx = s.on_pairs[3], *oty = s.on_pairs[4], *otz = s.on_pairs[5];
  T fx = 0, fy = 0, fz = 0, ax = 0, ay = 0, az = 0, energy = 0;
#pragma omp simd reduction(+ : fx, fy, fz, ax, ay, az, energy)
  for (std::size_t m = 0; m < count; ++m) {
    const T dx = static_cast<T>(x[m] - xi) * unit, dy = static_cast<T>(y[m] - yi) * unit,
            dz = static_cast<T>(z[m] - zi) * unit;
    const T r2 = std::max(dx * dx + dy * dy + dz * dz, T(1e-12));
    const T inv = 1 / std::sqrt(r2), r = r2 * inv;
    const T ux = dx * inv, uy = dy * inv, uz = dz * inv;
    const T njx = nx[m], njy = ny[m], njz = nz[m];
    const T p = nix * ux + niy * uy + niz * uz;
    const T q = njx * ux + njy * uy + njz * uz;
    const T c = nix * njx + niy * njy + niz * njz;
    const PairTerms<T> t = law.template of<Powers, blended>(r, p, q, c);
    const T ap = t.d_p * inv, aq = t.d_q * inv;
    const T radial = t.d_r - (ap * p + aq * q);
    const T gx = radial * ux + ap * nix + aq * njx;
    const T gy = radial * uy + ap * niy + aq * njy;
    const T gz = radial * uz + ap * niz + aq * njz;
    ofx[m] = -gx;
    ofy[m] = -gy;
    ofz[m] = -gz;
    fx += gx;
    fy += gy;
    fz += gz;
    const T tp = legacy ? T(0) : t.d_p, tq = legacy ? T(0) : t.d_q, tc = legacy ? t.d_c_crossing : t.d_c;
    ax += tp * ux + tc * njx;  // times n_i is the torque
    ay += tp * uy + tc * njy;
    az += tp * uz + tc * njz;
    const T bx = tq * ux + tc * nix, by = tq * uy + tc * niy, bz = tq * uz + tc * niz;
    otx[m] = by * njz - bz * njy;
    oty[m] = bz * njx - bx * njz;
    otz[m] = bx * njy - by * njx;
    if (energies) energy += t.energy;
  }
  return {fx, fy, fz, ay * niz - az * niy, az * nix - ax * niz, ax * niy - ay * nix, energy};
}

template <class T>
HWY_INLINE void add_up(const T* from, std::vector<double>& to) {
  double* out = to.data();
  const std::size_t n = to.size();
#pragma omp simd
  for (std::size_t m = 0; m < n; ++m) out[m] += static_cast<double>(from[m]);
}

template <class Powers, bool legacy, bool energies, class T>
HWY_NOINLINE void all_elements(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk,
                               ContactBuffer& out) {
  const PaperElements<T>& all = *in.elements;
  const PaperTerms<T> law(*in.law);
  const Scratch<T> s(in.runs->most_pairs(), out.fx.size());
  const T unit = static_cast<T>(all.unit);
  const double far = 2 * in.law->cutoff() / all.unit;
  const int first = chunk.touched_begin;
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const PairRun *begin = in.runs->begin(i), *end = in.runs->end(i);
    if (begin == end) continue;
    const Centre<T> centre{{all.x[i], all.y[i], all.z[i]}, {all.nx[i], all.ny[i], all.nz[i]}};
    std::size_t count = 0;
    for (const PairRun* run = begin; run != end; ++run) {
      copy_run(all, *run, count, s);
      count += static_cast<std::size_t>(run->end - run->begin);
    }
    count = fill_up(s, count, centre, far);
    const ElementSum sum = oblique(s, count, centre, law.blend)
                               ? evaluate<Powers, true, legacy, energies>(law, s, count, centre, unit)
                               : evaluate<Powers, false, legacy, energies>(law, s, count, centre, unit);
    std::size_t at = 0;
    for (const PairRun* run = begin; run != end; ++run) {
      const auto length = static_cast<std::size_t>(run->end - run->begin);
      add_run(s, at, length, static_cast<std::size_t>(run->begin - first));
      at += length;
    }
    sum.add_to(out, i - first);
  }
  std::vector<double>* to[6] = {&out.fx, &out.fy, &out.fz, &out.tx, &out.ty, &out.tz};
  for (int k = 0; k < 6; ++k) add_up(s.on_elements[k], *to[k]);
}

template <class Powers, class T>
HWY_INLINE void variant(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  if (in.legacy_torque) {
    all_elements<Powers, true, true>(in, chunk, out);
  } else if (in.energies) {
    all_elements<Powers, false, true>(in, chunk, out);
  } else {
    all_elements<Powers, false, false>(in, chunk, out);
  }
}

template <class T>
HWY_INLINE void any(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  if (in.law->has_published_powers()) {
    variant<PublishedPowers>(in, chunk, out);
  } else {
    variant<GeneralPowers>(in, chunk, out);
  }
}

}  // namespace paper

void PaperMixed(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  paper::any(in, chunk, out);
}

void PaperFull(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  paper::any(in, chunk, out);
}

void PaperDamping(const ContactViscosity& viscosity, const State& state, const PairRuns& runs,
                  const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  damping::chunk_damping(
      viscosity, state, chunk,
      [&](int i, const auto& f) HWY_ATTR {
        for (const PairRun* run = runs.begin(i); run != runs.end(i); ++run) f(run->begin, run->end);
      },
      out);
}

}  // namespace ropewalk::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ropewalk {

HWY_EXPORT(PaperMixed);
HWY_EXPORT(PaperFull);
HWY_EXPORT(PaperDamping);

void paper_contact(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(PaperMixed)(in, chunk, out);
}

void paper_contact(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(PaperFull)(in, chunk, out);
}

void paper_damping(const ContactViscosity& viscosity, const State& state, const PairRuns& runs,
                   const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  HWY_DYNAMIC_DISPATCH(PaperDamping)(viscosity, state, runs, chunk, out);
}

}  // namespace ropewalk
#endif  // HWY_ONCE
