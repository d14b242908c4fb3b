// The paper law over spans of neighbours, for every instruction set that the compiler knows and in two precisions;
// the machine's best is picked at run time. The spans of an element are copied one after another, so that the law
// (model/contact/paper.hpp, vectorised by the compiler) meets full vectors however short they are. It is evaluated
// in four loops: one alone is a chain of dependent operations so long that the processor cannot look ahead to the
// next vector.
#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/contact/paper/engine.hpp"
#include "sim/contact/shared/wrapped.hpp"

#undef VEC_SOURCE
#define VEC_SOURCE "sim/contact/paper/kernel.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace paper {
namespace ops = vec::VEC_SET;

// Values of a pair that the loops hand on: the invariants (model/contact/paper.hpp), D and its derivatives, the
// derivatives of U by D, r and c, and the force (eV/nm) and torque (eV) on the neighbour.
enum Row { ux, uy, uz, inv, r, p, q, c, d, d_r, d_p, d_q, d_c, u_d, u_r, u_c, fx, fy, fz, tx, ty, tz, rows };

// Pairs of one element, one after another. The rows have a constant length, so that all of them are addressed from
// one register.
template <class T>
struct alignas(64) Block {
  using C = typename PaperElements<T>::Coordinate;
  static constexpr std::size_t lanes = 16;  // pairs are filled up to a multiple of it
  static constexpr std::size_t capacity = 192;
  static constexpr std::size_t length =
      capacity + lanes;  // spans are copied in whole vectors, hence the room behind
  static_assert(ElementSpans::longest <= capacity);

  C x[3][length];  // places and axes of the neighbours
  T n[3][length];
  T pair[rows][length];
};

// Forces and torques on all elements that a chunk writes to.
template <class T>
struct OnElements {
  std::vector<T> all;
  std::size_t stride;

  explicit OnElements(std::size_t elements)
      : all(6 * (elements + Block<T>::lanes)), stride(elements + Block<T>::lanes) {}
};

// Position and axis of the element whose neighbours are evaluated.
template <class T>
struct Centre {
  typename Block<T>::C x[3];
  T n[3];
};

VEC_INLINE std::size_t length_of(const ElementSpan& span) {
  return static_cast<std::size_t>(span.end - span.begin);
}

template <class T>
VEC_INLINE void copy_span(const PaperElements<T>& from, const ElementSpan& span, std::size_t at, Block<T>& to) {
  const ops::CappedTag<typename Block<T>::C, 8> dc;
  const ops::CappedTag<T, 8> dt;
  const std::size_t lanes = ops::Lanes(dt), end = static_cast<std::size_t>(span.end);
  const auto *x = from.x.data(), *y = from.y.data(), *z = from.z.data();
  const auto *nx = from.nx.data(), *ny = from.ny.data(), *nz = from.nz.data();
  for (auto j = static_cast<std::size_t>(span.begin); j < end; j += lanes, at += lanes) {
    ops::Store(ops::Load(dc, x + j), dc, to.x[0] + at);
    ops::Store(ops::Load(dc, y + j), dc, to.x[1] + at);
    ops::Store(ops::Load(dc, z + j), dc, to.x[2] + at);
    ops::Store(ops::Load(dt, nx + j), dt, to.n[0] + at);
    ops::Store(ops::Load(dt, ny + j), dt, to.n[1] + at);
    ops::Store(ops::Load(dt, nz + j), dt, to.n[2] + at);
  }
}

// The forces on the elements of a run, the first of them at `first` in the chunk.
template <class T>
VEC_INLINE void add_span(const Block<T>& s, std::size_t at, std::size_t count, std::size_t first, T* to,
                         std::size_t stride) {
  const ops::CappedTag<T, 8> d;
  const std::size_t lanes = ops::Lanes(d);
  for (std::size_t m = 0; m < count; m += lanes) {
    const auto wanted = ops::FirstN(d, static_cast<int>(count - m));
    T* out = to + first + m;
    for (int k = 0; k < 6; ++k, out += stride) {
      const auto f = ops::IfThenElseZero(wanted, ops::Load(d, s.pair[fx + k] + at + m));
      ops::Store(ops::Add(ops::Load(d, out), f), d, out);
    }
  }
}

// Pads the pairs to whole vectors with pairs so far apart that the law is zero.
template <class T>
VEC_INLINE std::size_t fill_up(Block<T>& s, std::size_t count, const Centre<T>& centre, double far) {
  using C = typename Block<T>::C;
  const ops::CappedTag<C, 16> dc;
  const ops::CappedTag<T, 16> dt;
  const std::size_t end = (count + Block<T>::lanes - 1) / Block<T>::lanes * Block<T>::lanes;
  for (std::size_t m = count; m < end; m += ops::Lanes(dt))
    for (int a = 0; a < 3; ++a) {
      ops::Store(ops::Set(dc, wrapped_difference(centre.x[a], static_cast<C>(a == 0 ? far : 0))), dc, s.x[a] + m);
      ops::Store(ops::Set(dt, centre.n[a]), dt, s.n[a] + m);
    }
  return end;
}

// Computes the invariants. Returns the smallest |c|.
template <class T>
VEC_INLINE T invariants(Block<T>& s, std::size_t count, const Centre<T>& centre, T unit) {
  const auto *x = s.x[0], *y = s.x[1], *z = s.x[2];
  const auto xi = centre.x[0], yi = centre.x[1], zi = centre.x[2];
  const T *nx = s.n[0], *ny = s.n[1], *nz = s.n[2];
  const T nix = centre.n[0], niy = centre.n[1], niz = centre.n[2];
  T *oux = s.pair[ux], *ouy = s.pair[uy], *ouz = s.pair[uz], *oinv = s.pair[inv], *orr = s.pair[r], *op = s.pair[p],
    *oq = s.pair[q], *oc = s.pair[c];
  T least = 1;
#pragma omp simd reduction(min : least)
  for (std::size_t m = 0; m < count; ++m) {
    const T dx = static_cast<T>(wrapped_difference(x[m], xi)) * unit,
            dy = static_cast<T>(wrapped_difference(y[m], yi)) * unit,
            dz = static_cast<T>(wrapped_difference(z[m], zi)) * unit;
    const T distance = std::sqrt(std::max(dx * dx + dy * dy + dz * dz, T(1e-12))), inverse = 1 / distance;
    const T vx = dx * inverse, vy = dy * inverse, vz = dz * inverse;
    const T cosine = nix * nx[m] + niy * ny[m] + niz * nz[m];
    oux[m] = vx;
    ouy[m] = vy;
    ouz[m] = vz;
    oinv[m] = inverse;
    orr[m] = distance;
    op[m] = nix * vx + niy * vy + niz * vz;
    oq[m] = nx[m] * vx + ny[m] * vy + nz[m] * vz;
    oc[m] = cosine;
    least = std::min(least, std::fabs(cosine));
  }
  return least;
}

// Computes D and its derivatives. Returns the smallest D.
template <bool blended, class T>
VEC_INLINE T gaps(const PaperTerms<T>& law, Block<T>& s, std::size_t count) {
  const T *ir = s.pair[r], *ip = s.pair[p], *iq = s.pair[q], *ic = s.pair[c];
  T *od = s.pair[d], *od_r = s.pair[d_r], *od_p = s.pair[d_p], *od_q = s.pair[d_q], *od_c = s.pair[d_c];
  T least = ir[0];
#pragma omp simd reduction(min : least)
  for (std::size_t m = 0; m < count; ++m) {
    const GapTerms<T> t = law.template gap<blended>(ir[m], ip[m], iq[m], ic[m]);
    od[m] = t.d;
    od_r[m] = t.d_r;
    od_p[m] = t.d_p;
    od_q[m] = t.d_q;
    od_c[m] = t.d_c;
    least = std::min(least, t.d);
  }
  return least;
}

// Computes the derivatives of U = factor * V. Returns the energy.
template <class Powers, bool core, bool energies, class T>
VEC_INLINE T wells(const PaperTerms<T>& law, Block<T>& s, std::size_t count) {
  const T *id = s.pair[d], *ir = s.pair[r], *ic = s.pair[c];
  T *ou_d = s.pair[u_d], *ou_r = s.pair[u_r], *ou_c = s.pair[u_c];
  T energy = 0;
#pragma omp simd reduction(+ : energy)
  for (std::size_t m = 0; m < count; ++m) {
    const WellTerms<T> v = law.template well<Powers, core>(id[m]);
    const FactorTerms<T> f = law.template factor<Powers>(ir[m], ic[m]);
    ou_d[m] = f.f * v.v_d;
    ou_r[m] = f.f_r * v.v;
    ou_c[m] = f.f_c * v.v;
    if (energies) energy += f.f * v.v;
  }
  return energy;
}

// Computes force and torque on every neighbour. Returns the sums on the element.
template <bool legacy, class T>
VEC_INLINE ElementSum forces(Block<T>& s, std::size_t count, const Centre<T>& centre) {
  const T *nx = s.n[0], *ny = s.n[1], *nz = s.n[2];
  const T nix = centre.n[0], niy = centre.n[1], niz = centre.n[2];
  const T *iux = s.pair[ux], *iuy = s.pair[uy], *iuz = s.pair[uz], *iinv = s.pair[inv], *ip = s.pair[p],
          *iq = s.pair[q], *id_r = s.pair[d_r], *id_p = s.pair[d_p], *id_q = s.pair[d_q], *id_c = s.pair[d_c],
          *iu_d = s.pair[u_d], *iu_r = s.pair[u_r], *iu_c = s.pair[u_c];
  T *ofx = s.pair[fx], *ofy = s.pair[fy], *ofz = s.pair[fz], *otx = s.pair[tx], *oty = s.pair[ty],
    *otz = s.pair[tz];
  T sfx = 0, sfy = 0, sfz = 0, ax = 0, ay = 0, az = 0;
#pragma omp simd reduction(+ : sfx, sfy, sfz, ax, ay, az)
  for (std::size_t m = 0; m < count; ++m) {
    const T vx = iux[m], vy = iuy[m], vz = iuz[m], njx = nx[m], njy = ny[m], njz = nz[m];
    const T by_p = iu_d[m] * id_p[m], by_q = iu_d[m] * id_q[m];
    const T ap = by_p * iinv[m], aq = by_q * iinv[m];
    const T radial = iu_d[m] * id_r[m] + iu_r[m] - (ap * ip[m] + aq * iq[m]);
    const T gx = radial * vx + ap * nix + aq * njx;
    const T gy = radial * vy + ap * niy + aq * njy;
    const T gz = radial * vz + ap * niz + aq * njz;
    ofx[m] = -gx;
    ofy[m] = -gy;
    ofz[m] = -gz;
    sfx += gx;
    sfy += gy;
    sfz += gz;
    const T tp = legacy ? T(0) : by_p, tq = legacy ? T(0) : by_q,
            tc = (legacy ? T(0) : iu_d[m] * id_c[m]) + iu_c[m];
    ax += tp * vx + tc * njx;  // times n_i is the torque
    ay += tp * vy + tc * njy;
    az += tp * vz + tc * njz;
    const T bx = tq * vx + tc * nix, by = tq * vy + tc * niy, bz = tq * vz + tc * niz;
    otx[m] = by * njz - bz * njy;
    oty[m] = bz * njx - bx * njz;
    otz[m] = bx * njy - by * njx;
  }
  return {sfx, sfy, sfz, ay * niz - az * niy, az * nix - ax * niz, ax * niy - ay * nix, 0.0};
}

template <class Powers, bool legacy, bool energies, class T>
VEC_INLINE ElementSum evaluate(const PaperTerms<T>& law, Block<T>& s, std::size_t count, const Centre<T>& centre,
                               T unit) {
  const bool blended = invariants(s, count, centre, unit) < law.blend;
  const T least = blended ? gaps<true>(law, s, count) : gaps<false>(law, s, count);
  const T energy = least < law.core_gap ? wells<Powers, true, energies>(law, s, count)
                                        : wells<Powers, false, energies>(law, s, count);
  ElementSum sum = forces<legacy>(s, count, centre);
  sum.energy = energy;
  return sum;
}

template <class T>
VEC_INLINE void add_up(const T* from, std::vector<double>& to) {
  double* out = to.data();
  const std::size_t n = to.size();
#pragma omp simd
  for (std::size_t m = 0; m < n; ++m) out[m] += static_cast<double>(from[m]);
}

template <class Powers, bool legacy, bool energies, class T>
VEC_NOINLINE void all_elements(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk,
                               ContactBuffer<double>& out) {
  const PaperElements<T>& all = *in.elements;
  const PaperTerms<T> law(*in.law);
  OnElements<T> on(out.fx.size());
  Block<T> s;
  const T unit = static_cast<T>(all.unit);
  const double far = 2 * in.law->cutoff() / all.unit;
  const int first = chunk.written_begin;
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const Span<ElementSpan> spans = in.spans->spans(i);
    const ElementSpan* const end = spans.end();
    const Centre<T> centre{{all.x[i], all.y[i], all.z[i]}, {all.nx[i], all.ny[i], all.nz[i]}};
    for (const ElementSpan *begin = spans.begin(), *span = begin; begin != end; begin = span) {
      std::size_t count = 0;
      for (; span != end && count + length_of(*span) <= Block<T>::capacity; ++span) {
        copy_span(all, *span, count, s);
        count += length_of(*span);
      }
      count = fill_up(s, count, centre, far);
      evaluate<Powers, legacy, energies>(law, s, count, centre, unit).add_to(out, i - first);
      std::size_t at = 0;
      for (const ElementSpan* r = begin; r != span; ++r) {
        add_span(s, at, length_of(*r), static_cast<std::size_t>(r->begin - first), on.all.data(), on.stride);
        at += length_of(*r);
      }
    }
  }
  std::vector<double>* to[6] = {&out.fx, &out.fy, &out.fz, &out.tx, &out.ty, &out.tz};
  for (std::size_t k = 0; k < 6; ++k) add_up(on.all.data() + k * on.stride, *to[k]);
}

template <class Powers, class T>
VEC_INLINE void variant(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk,
                        ContactBuffer<double>& out) {
  if (in.legacy_torque) {
    all_elements<Powers, true, true>(in, chunk, out);
  } else if (in.energies) {
    all_elements<Powers, false, true>(in, chunk, out);
  } else {
    all_elements<Powers, false, false>(in, chunk, out);
  }
}

template <class T>
VEC_INLINE void any(const PaperKernelInput<T>& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) {
  if (in.law->has_published_powers()) {
    variant<PublishedPowers>(in, chunk, out);
  } else {
    variant<GeneralPowers>(in, chunk, out);
  }
}

}  // namespace paper

void PaperMixed(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) {
  paper::any(in, chunk, out);
}

void PaperFull(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) {
  paper::any(in, chunk, out);
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(PaperMixed);
VEC_EXPORT(PaperFull);

void paper_contact(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out) {
  VEC_IN_USE(PaperMixed)(in, chunk, out);
}

void paper_contact(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out) {
  VEC_IN_USE(PaperFull)(in, chunk, out);
}

}  // namespace ropewalk
#endif  // VEC_ONCE
