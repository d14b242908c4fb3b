// The kernels of a step of velocity Verlet (sim/dynamics/verlet.hpp), for a device and for C++. Before this text:
// model/dialect.h, dialect.h, model/forms.h, types.h and the numbers NODES, TYPES, LOCAL_TYPES.
//
// The state is held in columns. A column has one number for every element; two columns begin `stride` numbers apart. The
// number before a quantity is its first column:
//   motion     0 position, 3 orientation (w, x, y, z), 7 velocity, 10 angular velocity
//   force      0 force, 3 torque
//   bond       of the bond from an element to the next: 0 force on the next, 3 torque on the element, 6 torque on the
//              next, 9 power of its damping
//   reference  0 position, 3 axis, where the neighbour list was built
//   told       speeds, displacements, power of the damping, slipping bonds (types.h has the order); the kernel `summary`
//              adds them up for the host
// Each element adds the forces of its neighbours in the order of its list. The bits of a run follow from its lists. Units
// nm, ps, eV. Coordinates of the contact are whole numbers of LineTables::unit modulo 2^32
// (sim/contact/shared/wrapped.hpp).

FUNCTION Vec vec_at(GLOBAL const double* a, int column, int stride, int i) {
  return vec(a[column * stride + i], a[(column + 1) * stride + i], a[(column + 2) * stride + i]);
}
FUNCTION void vec_store(Vec v, GLOBAL double* a, int column, int stride, int i) {
  a[column * stride + i] = v.x;
  a[(column + 1) * stride + i] = v.y;
  a[(column + 2) * stride + i] = v.z;
}

// --- motion -------------------------------------------------------------------------------------------

// v += F dt/m,  w += M dt/I
KERNEL kick(OF_GROUP GLOBAL const double* force, GLOBAL const int* kind, GLOBAL const ElementType* types, double dt,
       int elements, int stride, GLOBAL double* motion) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements && !(kind[i] & KIND_HOSTED)) {
      const double by_mass = dt / types[kind[i] & KIND_TYPE].mass, by_inertia = dt / types[kind[i] & KIND_TYPE].inertia;
      for (int c = 0; c < 3; ++c) {
        motion[(7 + c) * stride + i] += by_mass * force[c * stride + i];
        motion[(10 + c) * stride + i] += by_inertia * force[(3 + c) * stride + i];
      }
    }
  }
}

// Copies the state of the elements `which` into the columns of motion. `rows` has the 13 numbers of one element after
// those of the other.
KERNEL put_motion(OF_GROUP GLOBAL const int* which, GLOBAL const double* rows, int count, int stride,
       GLOBAL double* motion) {
  FOR_ITEMS(t) {
    const int k = GROUP_NUMBER * GROUP + t;
    if (k < count)
      for (int c = 0; c < 13; ++c) motion[c * stride + which[k]] = rows[13 * k + c];
  }
}

// Moves the elements of the device:  x += v dt,  q <- exp(w dt) q  (move_elements in sim/state/motion.hpp). Then writes,
// for all elements, the copies in floats that the contact reads, and the displacements since the list was built
// (largest_change in sim/state/motion.hpp).
KERNEL drift(OF_GROUP GLOBAL double* motion, GLOBAL const int* kind, GLOBAL const double* reference, TwistSince twist,
       double dt, double per_unit, int elements, int stride, GLOBAL int4* centre, GLOBAL float4* axis,
       GLOBAL float4* velocity, GLOBAL float4* spin, GLOBAL double* told) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      Vec x = vec_at(motion, 0, stride, i);
      const Vec v = vec_at(motion, 7, stride, i), w = vec_at(motion, 10, stride, i);
      Turn q = turn(motion[3 * stride + i], motion[4 * stride + i], motion[5 * stride + i], motion[6 * stride + i]);
      if (!(kind[i] & KIND_HOSTED)) {
        x = vec_sum(x, vec_scaled(dt, v));
        q = turned(w, dt, q);
        vec_store(x, motion, 0, stride, i);
        motion[3 * stride + i] = q.w;
        vec_store(vec(q.x, q.y, q.z), motion, 4, stride, i);
      }
      const Vec n = turn_axis(q);
      int4 at;
      at.x = WHOLE(x.x * per_unit), at.y = WHOLE(x.y * per_unit), at.z = WHOLE(x.z * per_unit);
      at.w = kind[i] & KIND_TYPE;
      centre[i] = at;
      float4 f;
      f.x = (float)n.x, f.y = (float)n.y, f.z = (float)n.z, f.w = 0;
      axis[i] = f;
      f.x = (float)v.x, f.y = (float)v.y, f.z = (float)v.z;
      velocity[i] = f;
      f.x = (float)w.x, f.y = (float)w.y, f.z = (float)w.z;
      spin[i] = f;

      const Vec was = vec_at(reference, 0, stride, i), axis_was = vec_at(reference, 3, stride, i);
      const double px = was.x - twist.x, py = was.y - twist.y, pz = was.z - twist.middle;
      const double s = within(twist.sine + twist.slope * pz, -twist.most, twist.most), c = sqrt(1 - s * s);
      const double ux = x.x - twist.x, uy = x.y - twist.y;
      const Vec moved = vec(ux - (c * px - s * py), uy - (s * px + c * py), x.z - was.z);
      const Vec tilted = vec(n.x - (c * axis_was.x - s * axis_was.y), n.y - (s * axis_was.x + c * axis_was.y),
                             n.z - axis_was.z);
      const double product = px * uy - py * ux;
      told[TOLD_SPEED2 * stride + i] = vec_norm2(v);
      told[TOLD_SPIN2 * stride + i] = vec_norm2(w);
      told[TOLD_MOVED * stride + i] = sqrt(vec_norm2(moved)) + twist.lever * sqrt(vec_norm2(tilted));
      told[TOLD_TURN * stride + i] = product;
      told[TOLD_TURN_Z * stride + i] = pz * product;
    }
  }
}

// --- neighbours ---------------------------------------------------------------------------------------

// Sorts the elements into cubes as wide as the reach of the list. A hash of a cube's place gives one of `buckets` buckets
// (a power of two), so that memory does not depend on the width of the scene. cell: the cube in x, y, z, its bucket in w.
KERNEL count_cells(OF_GROUP GLOBAL const double* reference, ListReach reach, int elements, int stride, int buckets,
       GLOBAL int4* cell, GLOBAL int* count) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      const Vec x = vec_at(reference, 0, stride, i);
      int4 at;
      at.x = (int)FLOOR(x.x / reach.centres), at.y = (int)FLOOR(x.y / reach.centres);
      at.z = (int)FLOOR(x.z / reach.centres);
      at.w = BUCKET(at.x, at.y, at.z, buckets);
      cell[i] = at;
      ATOMIC_INCREMENT(&count[at.w]);
    }
  }
}

// Lists the members of each bucket. `next` has the place of the next member of each bucket. Members of one bucket stand in
// no particular order.
KERNEL fill_cells(OF_GROUP GLOBAL const int4* cell, int elements, GLOBAL int* next, GLOBAL int* member) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) member[ATOMIC_INCREMENT(&next[cell[i].w])] = i;
  }
}

// Whether elements i and j > i may act on each other before the list is built again: through their nodes, or through the
// viscosity of their centres. 0: no; 1: yes; 2: yes, and a node of j is within NEAR of the cutoff already.
FUNCTION int may_touch(GLOBAL const double* reference, GLOBAL const int* kind, GLOBAL const ElementType* types,
                       GLOBAL const LineTables* tables, ListReach reach, int stride, int i, int j) {
  const Vec apart = vec_difference(vec_at(reference, 0, stride, j), vec_at(reference, 0, stride, i));
  const double square = vec_norm2(apart);
  if (!(square < reach.centres * reach.centres)) return 0;
  const int type_i = kind[i] & KIND_TYPE, type_j = kind[j] & KIND_TYPE;
  const int nodes_i = tables->row[type_i].count, nodes_j = tables->row[type_j].count;
  const Vec n_i = vec_at(reference, 3, stride, i), n_j = vec_at(reference, 3, stride, j);
  const double rim = line_node(nodes_i - 1, nodes_i, types[type_i].length);
  double least = 1e300;
  for (int l = 0; l < nodes_j; ++l) {
    const Vec d = vec_sum(apart, vec_scaled(line_node(l, nodes_j, types[type_j].length), n_j));
    const double along = within(vec_dot(d, n_i), -rim, rim);
    least = smaller(least, vec_norm2(vec_difference(d, vec_scaled(along, n_i))));
  }
  const double cutoff = tables->cutoff[type_i * TYPES + type_j];
  const double listed = cutoff + reach.skin, near = cutoff + smaller(reach.skin, NEAR);
  if (least < near * near) return 2;
  return least < listed * listed || square < reach.viscosity * reach.viscosity;
}

// Counts the neighbours of each element (fill = 0), or lists them from begin[i] to begin[i + 1] (fill = 1). Neighbours for
// which may_touch() is 2 stand first; both parts are in rising order. The work items of a group go through the lists of
// several elements side by side, and so skip the second parts at the same time. Elements i to last[i] are parts of one tube
// and no neighbours. `first` has the place of the first member of each bucket.
KERNEL find_neighbours(OF_GROUP GLOBAL const double* reference, GLOBAL const int* kind, GLOBAL const ElementType* types,
       GLOBAL const LineTables* tables, GLOBAL const int* last, GLOBAL const int4* cell, GLOBAL const int* first,
       GLOBAL const int* member, ListReach reach, int elements, int stride, int buckets, int fill,
       GLOBAL const int* begin, GLOBAL int* out) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      const int4 own = cell[i];
      const int from = fill ? begin[i] : 0, end = fill ? begin[i + 1] : 0;
      int near = 0, far_away = 0;
      for (int cube = 0; cube < 27; ++cube) {
        const int x = own.x + cube % 3 - 1, y = own.y + cube / 3 % 3 - 1, z = own.z + cube / 9 - 1;
        const int bucket = BUCKET(x, y, z, buckets);
        for (int k = first[bucket]; k < first[bucket + 1]; ++k) {
          const int j = member[k];
          const int4 other = cell[j];
          if (other.x != x || other.y != y || other.z != z || j == i) continue;
          const int low = i < j ? i : j, high = i < j ? j : i;
          const int touches =
              high <= last[low] ? 0 : may_touch(reference, kind, types, tables, reach, stride, low, high);
          if (touches == 2) {
            int at = from + near++;
            for (; fill && at > from && out[at - 1] > j; --at) out[at] = out[at - 1];
            if (fill) out[at] = j;
          } else if (touches) {
            int at = end - 1 - far_away++;
            for (; fill && at + 1 < end && out[at + 1] < j; ++at) out[at] = out[at + 1];
            if (fill) out[at] = j;
          }
        }
      }
      if (!fill) out[i] = near + far_away;
    }
  }
}

// --- contact ------------------------------------------------------------------------------------------

// Coordinates count modulo 2^32.
#define APART(to, from) ((int)((unsigned)(to) - (unsigned)(from)))

// Forces and torques of the line law (formulas: sim/contact/line/kernel.cpp). LANES work items share an element. Each of
// them takes every LANES-th node of the neighbours, and sums over all nodes of the element.
KERNEL line_contact(OF_GROUP GLOBAL const int4* centre, GLOBAL const float4* axis, GLOBAL const int* begin,
       GLOBAL const int* list, GLOBAL const LineTables* tables, int elements, GLOBAL float4* force,
       GLOBAL float4* torque) {
  LOCAL float d[LOCAL_TYPES * LOCAL_TYPES * TERMS * SEGMENTS];
  LOCAL float sums[6 * GROUP];
  FOR_ITEMS(t) {
    for (int m = t; m < TYPES * TYPES * TERMS * SEGMENTS; m += GROUP)
      d[m] = tables->pair[m / (TERMS * SEGMENTS)].d[m % (TERMS * SEGMENTS)];
  }
  BARRIER;
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * (GROUP / LANES) + t / LANES;
    float fx = 0, fy = 0, fz = 0, mx = 0, my = 0, mz = 0;
    if (i < elements) {
      const int4 x = centre[i];
      const float4 n = axis[i];
      GLOBAL const NodeRow* own = &tables->row[x.w];
      const int from = begin[i], end = (begin[i + 1] - from) * NODES;
      for (int node = t % LANES; node < end; node += LANES) {
        const int j = list[from + node / NODES], l = node % NODES;
        const int4 y = centre[j];
        const float4 m = axis[j];
        const int pair = x.w * TYPES + y.w;
        GLOBAL const PairTable* table = &tables->pair[pair];
        const float s = tables->row[y.w].s[l];
        const float dx = FMA(s, m.x, (float)APART(y.x, x.x)), dy = FMA(s, m.y, (float)APART(y.y, x.y)),
                    dz = FMA(s, m.z, (float)APART(y.z, x.z));
        const float square = FMA(dx, dx, FMA(dy, dy, dz * dz)), along = FMA(n.x, dx, FMA(n.y, dy, n.z * dz));
        const float outside = (along < 0 ? -along : along) - own->rim, ahead = outside > 0 ? outside : 0;
        const int absent = l >= tables->row[y.w].count;
        if (absent || FMA(ahead, ahead, FMA(-along, along, square)) >= table->cutoff2) continue;
        TO_LOCAL const float* terms = d + pair * TERMS * SEGMENTS;
        float a = 0, b = 0;
#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#pragma unroll
#endif
        for (int k = 0; k < NODES; ++k) {
          const float sk = own->s[k], X = FMA(sk, sk - 2 * along, square);
          const float place = FMA(X, table->scale, table->shift);
          const int bits = BITS_OF(place) >> MANTISSA_LEFT, segment = bits & (SEGMENTS - 1);
          const float in = place - FLOAT_OF((int)((unsigned)bits << MANTISSA_LEFT));
          float slope = terms[(TERMS - 1) * SEGMENTS + segment];
          for (int q = TERMS - 2; q >= 0; --q) slope = FMA(slope, in, terms[q * SEGMENTS + segment]);
          if (X < table->core2) {
            const float rho = SQRT_FLOAT(X > 1e-12f ? X : 1e-12f), h = FMA(rho, table->unit, -table->rest);
            slope = FMA(h, table->v2, table->v1) * table->unit / (rho * 2 * table->scale);
          }
          slope = X < table->cutoff2 && k < own->count ? slope : 0;
          a += slope;
          b = FMA(sk, slope, b);
        }
        a *= table->weight;
        b *= table->weight;
        fx -= FMA(a, dx, -b * n.x);
        fy -= FMA(a, dy, -b * n.y);
        fz -= FMA(a, dz, -b * n.z);
        mx = FMA(b, dx, mx);
        my = FMA(b, dy, my);
        mz = FMA(b, dz, mz);
      }
    }
    sums[t] = fx, sums[GROUP + t] = fy, sums[2 * GROUP + t] = fz;
    sums[3 * GROUP + t] = mx, sums[4 * GROUP + t] = my, sums[5 * GROUP + t] = mz;
  }
  for (int step = LANES / 2; step > 0; step /= 2) {
    BARRIER;
    FOR_ITEMS(t) {
      if (t % LANES < step)
        for (int q = 0; q < 6; ++q) sums[q * GROUP + t] += sums[q * GROUP + t + step];
    }
  }
  BARRIER;
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * (GROUP / LANES) + t / LANES;
    if (t % LANES == 0 && i < elements) {
      const float4 n = axis[i];
      const float unit = (float)tables->unit;
      const float mx = sums[3 * GROUP + t] * unit, my = sums[4 * GROUP + t] * unit, mz = sums[5 * GROUP + t] * unit;
      float4 f, q;
      f.x = sums[t], f.y = sums[GROUP + t], f.z = sums[2 * GROUP + t], f.w = 0;
      q.x = -(n.y * mz - n.z * my), q.y = -(n.z * mx - n.x * mz), q.z = -(n.x * my - n.y * mx), q.w = 0;
      force[i] = f;
      torque[i] = q;
    }
  }
}

// Adds the forces and torques of the contact viscosity (model/damping.hpp). torque.w becomes half of the power that the
// viscosity has in the pairs of the element, eV/ps; the other half is the partners'.
KERNEL viscosity(OF_GROUP GLOBAL const int4* centre, GLOBAL const float4* velocity, GLOBAL const float4* spin,
       GLOBAL const int* begin, GLOBAL const int* list, Viscosity law, int elements, GLOBAL float4* force,
       GLOBAL float4* torque) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      const int4 x = centre[i];
      const float4 v = velocity[i], w = spin[i];
      float4 f = force[i], q = torque[i];
      float power = 0;
      for (int k = begin[i]; k < begin[i + 1]; ++k) {
        const int j = list[k];
        const int4 y = centre[j];
        const float dx = law.unit * (float)APART(y.x, x.x), dy = law.unit * (float)APART(y.y, x.y),
                    dz = law.unit * (float)APART(y.z, x.z);
        const float distance = SQRT_FLOAT(FMA(dx, dx, FMA(dy, dy, dz * dz)));
        if (distance >= law.outer) continue;
        const float4 vj = velocity[j], wj = spin[j];
        const float far = (distance - law.inner) * law.per_width, z = far > 0 ? far : 0;
        const float strength = law.eta * FMA(-z * z, FMA(-2, z, 3), 1);
        // r is the velocity of j relative to i at the point midway between the centres; a is the arm from i to this point.
        const float ax = 0.5f * dx, ay = 0.5f * dy, az = 0.5f * dz;
        const float sx = w.x + wj.x, sy = w.y + wj.y, sz = w.z + wj.z;
        const float rx = vj.x - v.x - (sy * az - sz * ay), ry = vj.y - v.y - (sz * ax - sx * az),
                    rz = vj.z - v.z - (sx * ay - sy * ax);
        const float gx = strength * rx, gy = strength * ry, gz = strength * rz;
        f.x += gx, f.y += gy, f.z += gz;
        q.x += ay * gz - az * gy, q.y += az * gx - ax * gz, q.z += ax * gy - ay * gx;
        power = FMA(gx, rx, FMA(gy, ry, FMA(gz, rz, power)));
      }
      q.w = -0.5f * power;
      force[i] = f;
      torque[i] = q;
    }
  }
}

// --- bonds --------------------------------------------------------------------------------------------

FUNCTION BodyFrame frame_at(GLOBAL const double* motion, int stride, int i) {
  return turn_frame(
      turn(motion[3 * stride + i], motion[4 * stride + i], motion[5 * stride + i], motion[6 * stride + i]));
}

// The angle of the vector (x, y) for x > 0. The tangent of a quarter of the angle follows from two square roots, and the
// series of the arc tangent gives this quarter. The functions atan2 of different compilers differ in their last bits.
FUNCTION double angle_of(double y, double x) {
  const double tangent = y / (sqrt(x * x + y * y) + x);  // tangent of the half angle
  const double t = tangent / (1 + sqrt(1 + tangent * tangent)), u = t * t;
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = 1.0 / k - u * sum;
  return 4 * t * sum;
}

// Forces and torques of each bond, computed once, with the bond damping of this rate (1/ps; BondDamping).
KERNEL bonds(OF_GROUP GLOBAL const double* motion, GLOBAL const int* kind, GLOBAL const ElementType* types, double rate,
       int elements, int stride, GLOBAL double* bond, GLOBAL double* told) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      BondAction f;
      double power = 0, slips = 0;
      f.force_j = f.torque_i = f.torque_j = vec(0, 0, 0);
      if (kind[i] & KIND_BONDED) {
        const int j = i + 1;
        GLOBAL const ElementType* type = &types[kind[i] & KIND_TYPE];
        BodyFrame fi = frame_at(motion, stride, i), fj = frame_at(motion, stride, j);
        if (type->shape.used) {
          const BodyFrame turn = type->shape.turn;
          fi = frame_turned(fi, turn);
          fj = frame_turned_back(fj, turn);
        }
        const Vec separation = vec_difference(vec_at(motion, 0, stride, j), vec_at(motion, 0, stride, i));
        const double sine = twist_sine(fi, fj), cosine = twist_cosine(fi, fj);
        f = type->bond.anharmonic.used ? anharmonic_bond(&type->bond, type->shear_share, type->length, separation, fi, fj,
                                                         angle_of(sine, cosine))
            : type->shape.used         ? shaped_bond(&type->bond, type->shape.share, type->shape.shear_difference,
                                                     type->length, separation, fi, fj)
                                       : harmonic_bond(&type->bond, type->shear_share, type->length, separation, fi, fj);
        slips = cosine <= 0 ? 1 : 0;
        if (rate > 0) {
          const PairDamping d =
              bond_damping(rate, type->mass, type->inertia, separation, vec_at(motion, 7, stride, i),
                           vec_at(motion, 10, stride, i), vec_at(motion, 7, stride, j), vec_at(motion, 10, stride, j));
          f.force_j = vec_sum(f.force_j, d.force_j);
          f.torque_i = vec_sum(f.torque_i, d.torque_i);
          f.torque_j = vec_sum(f.torque_j, d.torque_j);
          power = d.power;
        }
      }
      vec_store(f.force_j, bond, 0, stride, i);
      vec_store(f.torque_i, bond, 3, stride, i);
      vec_store(f.torque_j, bond, 6, stride, i);
      bond[9 * stride + i] = power;
      told[TOLD_SLIPS * stride + i] = slips;
    }
  }
}

// Adds up, for every element, the forces and torques of its two bonds, of the contact and of the viscosity.
KERNEL collect(OF_GROUP GLOBAL const double* bond, GLOBAL const int* kind, GLOBAL const float4* contact_force,
       GLOBAL const float4* contact_torque, int elements, int stride, GLOBAL double* force, GLOBAL double* told) {
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    if (i < elements) {
      Vec f = vec_scaled(-1, vec_at(bond, 0, stride, i)), m = vec_at(bond, 3, stride, i);
      if (i > 0 && (kind[i - 1] & KIND_BONDED)) {
        f = vec_sum(f, vec_at(bond, 0, stride, i - 1));
        m = vec_sum(m, vec_at(bond, 6, stride, i - 1));
      }
      const float4 cf = contact_force[i], ct = contact_torque[i];
      vec_store(vec_sum(f, vec(cf.x, cf.y, cf.z)), force, 0, stride, i);
      vec_store(vec_sum(m, vec(ct.x, ct.y, ct.z)), force, 3, stride, i);
      told[TOLD_POWER * stride + i] = bond[9 * stride + i] + ct.w;
    }
  }
}

// --- what the host is told ----------------------------------------------------------------------------

// For each group of elements: the largest speeds and displacement, the first slipping bond, and the sums of the other
// columns, in a fixed order. A largest value may lose a NaN. The sums of the squared speeds and of the displacements are
// NaN or infinite whenever a velocity or a position is.
KERNEL summary(OF_GROUP GLOBAL const double* told, int elements, int stride, int groups, GLOBAL double* out) {
  LOCAL double sums[SUMMARY * GROUP];
  FOR_ITEMS(t) {
    const int i = GROUP_NUMBER * GROUP + t;
    const int there = i < elements;
    for (int c = 0; c < TOLD; ++c) sums[c * GROUP + t] = there ? told[c * stride + i] : 0;
    sums[TOLD_SLIPS * GROUP + t] = sums[TOLD_SLIPS * GROUP + t] > 0 ? i : NO_ELEMENT;
    sums[SUM_SPEEDS * GROUP + t] = sums[TOLD_SPEED2 * GROUP + t] + sums[TOLD_SPIN2 * GROUP + t];
    sums[SUM_MOVED * GROUP + t] = sums[TOLD_MOVED * GROUP + t];
  }
  for (int step = GROUP / 2; step > 0; step /= 2) {
    BARRIER;
    FOR_ITEMS(t) {
      if (t < step)
        for (int c = 0; c < SUMMARY; ++c) {
          const double a = sums[c * GROUP + t], b = sums[c * GROUP + t + step];
          sums[c * GROUP + t] = c == TOLD_SPEED2 || c == TOLD_SPIN2 || c == TOLD_MOVED ? larger(a, b)
                                : c == TOLD_SLIPS                                     ? smaller(a, b)
                                                                                      : a + b;
        }
    }
  }
  BARRIER;
  FOR_ITEMS(t) {
    if (t < SUMMARY) out[t * groups + GROUP_NUMBER] = sums[t * GROUP];
  }
}

// Copies the force and torque of the elements `which` into `rows`, six numbers for each element, from place `before` on.
KERNEL get_force(OF_GROUP GLOBAL const double* force, GLOBAL const int* which, int count, int stride, int before,
       GLOBAL double* rows) {
  FOR_ITEMS(t) {
    const int k = GROUP_NUMBER * GROUP + t;
    if (k < count)
      for (int c = 0; c < 6; ++c) rows[before + 6 * k + c] = force[c * stride + which[k]];
  }
}
