#include <algorithm>
#include <cmath>

#include "sim/contact_kernel.hpp"

namespace ropewalk {
namespace {

constexpr int block = 128;
constexpr int lanes = 8;  // blocks are filled up to a multiple of this with pairs beyond the cutoff

// Pairs of one element within the cutoff, gathered so that the arithmetic runs over plain arrays.
struct PairBlock {
  alignas(64) double dx[block], dy[block], dz[block], r[block];
  alignas(64) double nx[block], ny[block], nz[block];
  alignas(64) double fx[block], fy[block], fz[block];  // on j
  alignas(64) double tx[block], ty[block], tz[block];  // on j
  int j[block];
  int count = 0;
};

template <class Powers, bool legacy>
inline __attribute__((always_inline)) void evaluate(const PaperContact& law, PairBlock& b, double nix, double niy,
                                                    double niz, ElementSum& sum) {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0, energy = 0;
  const PaperContact k = law;  // a local copy: the compiler need not fear that the stores below change it
  const int count = (b.count + lanes - 1) / lanes * lanes;
#pragma omp simd reduction(+ : fx, fy, fz, tx, ty, tz, energy)
  for (int m = 0; m < count; ++m) {
    const double r = b.r[m], inv = 1.0 / r;
    const double ux = b.dx[m] * inv, uy = b.dy[m] * inv, uz = b.dz[m] * inv;
    const double njx = b.nx[m], njy = b.ny[m], njz = b.nz[m];
    const double p = nix * ux + niy * uy + niz * uz;
    const double q = njx * ux + njy * uy + njz * uz;
    const double c = nix * njx + niy * njy + niz * njz;
    const PairTerms<double> t = k.terms<Powers, double>(r, p, q, c);
    const double radial = t.d_r - (t.d_p * p + t.d_q * q) * inv;
    const double ap = t.d_p * inv, aq = t.d_q * inv;
    const double gx = -(radial * ux + ap * nix + aq * njx);
    const double gy = -(radial * uy + ap * niy + aq * njy);
    const double gz = -(radial * uz + ap * niz + aq * njz);
    b.fx[m] = gx;
    b.fy[m] = gy;
    b.fz[m] = gz;
    fx -= gx;
    fy -= gy;
    fz -= gz;
    const double tp = legacy ? 0.0 : t.d_p, tq = legacy ? 0.0 : t.d_q, tc = legacy ? t.d_c_crossing : t.d_c;
    const double aix = tp * ux + tc * njx, aiy = tp * uy + tc * njy, aiz = tp * uz + tc * njz;
    const double ajx = tq * ux + tc * nix, ajy = tq * uy + tc * niy, ajz = tq * uz + tc * niz;
    tx += aiy * niz - aiz * niy;
    ty += aiz * nix - aix * niz;
    tz += aix * niy - aiy * nix;
    b.tx[m] = ajy * njz - ajz * njy;
    b.ty[m] = ajz * njx - ajx * njz;
    b.tz[m] = ajx * njy - ajy * njx;
    energy += t.energy;
  }
  sum.fx += fx;
  sum.fy += fy;
  sum.fz += fz;
  sum.tx += tx;
  sum.ty += ty;
  sum.tz += tz;
  sum.energy += energy;
}

template <class Powers, bool legacy>
inline __attribute__((always_inline)) void run(const ContactInput& in, const NeighbourList::Chunk& chunk,
                                               ContactBuffer& out) {
  const PaperContact& law = *in.interaction->paper;
  const double cutoff2 = law.cutoff() * law.cutoff(), nowhere = 2.0 * law.cutoff();  // the law is zero there
  const bool damped = in.interaction->damped_contact();
  const double reach = in.interaction->damping.contact.outer;
  const int* index = in.list->indices();
  const Vec3Array& x = in.state->position;
  const Vec3Array& n = *in.axis;
  const double *px = x.x.data(), *py = x.y.data(), *pz = x.z.data();
  const double *ax = n.x.data(), *ay = n.y.data(), *az = n.z.data();
  PairBlock b;
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const double xi = px[i], yi = py[i], zi = pz[i];
    ElementSum sum;
    const std::size_t end = in.list->begin(i + 1);
    std::size_t k = in.list->begin(i);
    while (k < end) {
      b.count = 0;
      for (; k < end && b.count < block; ++k) {
        const int j = index[k];
        const double dx = px[j] - xi, dy = py[j] - yi, dz = pz[j] - zi;
        const double r2 = dx * dx + dy * dy + dz * dz;
        const int m = b.count;
        b.dx[m] = dx;
        b.dy[m] = dy;
        b.dz[m] = dz;
        b.r[m] = r2;
        b.j[m] = j;
        b.count += r2 < cutoff2;
      }
      for (int m = 0; m < b.count; ++m) {
        const int j = b.j[m];
        b.r[m] = std::sqrt(std::max(b.r[m], 1e-12));
        b.nx[m] = ax[j];
        b.ny[m] = ay[j];
        b.nz[m] = az[j];
      }
      for (int m = b.count; m % lanes != 0; ++m) {
        b.dx[m] = b.r[m] = nowhere;
        b.dy[m] = b.dz[m] = b.nx[m] = b.ny[m] = 0;
        b.nz[m] = 1;
      }
      evaluate<Powers, legacy>(law, b, ax[i], ay[i], az[i], sum);
      for (int m = 0; m < b.count; ++m) {
        const int at = b.j[m] - chunk.touched_begin;
        out.fx[at] += b.fx[m];
        out.fy[at] += b.fy[m];
        out.fz[at] += b.fz[m];
        out.tx[at] += b.tx[m];
        out.ty[at] += b.ty[m];
        out.tz[at] += b.tz[m];
      }
      for (int m = 0; m < b.count && damped; ++m)
        if (b.r[m] < reach) damp_pair(in, i, b.j[m], {b.dx[m], b.dy[m], b.dz[m]}, chunk.touched_begin, sum, out);
    }
    sum.add_to(out, i - chunk.touched_begin);
  }
}

ROPEWALK_VECTOR_CLONES
void published(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  run<PublishedPowers, false>(in, chunk, out);
}

ROPEWALK_VECTOR_CLONES
void published_legacy(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  run<PublishedPowers, true>(in, chunk, out);
}

}  // namespace

void paper_contact(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer& out) {
  const bool legacy = in.interaction->legacy_torque;
  if (in.interaction->paper->has_published_powers()) {
    legacy ? published_legacy(in, chunk, out) : published(in, chunk, out);
  } else {
    legacy ? run<GeneralPowers, true>(in, chunk, out) : run<GeneralPowers, false>(in, chunk, out);
  }
}

}  // namespace ropewalk
