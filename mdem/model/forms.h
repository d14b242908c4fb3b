// Forms of the model that both the processor and the kernels of a device compute, in the words of dialect.h. The
// equations, their units and their sources stand in bond.hpp, anharmonic.hpp and damping.hpp.

typedef struct {
  double x, y, z;
} Vec;

FUNCTION Vec vec(double x, double y, double z) {
  Vec v = {x, y, z};
  return v;
}
FUNCTION Vec vec_sum(Vec a, Vec b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
FUNCTION Vec vec_difference(Vec a, Vec b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
FUNCTION Vec vec_scaled(double k, Vec a) { return vec(k * a.x, k * a.y, k * a.z); }
FUNCTION Vec vec_negative(Vec a) { return vec(-a.x, -a.y, -a.z); }
FUNCTION Vec vec_divided(Vec a, double k) { return vec(a.x / k, a.y / k, a.z / k); }
FUNCTION double vec_dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FUNCTION Vec vec_cross(Vec a, Vec b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
FUNCTION double vec_norm2(Vec a) { return vec_dot(a, a); }

// These functions return what std::min and std::max do: a where b is NaN or equal.
FUNCTION double smaller(double a, double b) { return b < a ? b : a; }
FUNCTION double larger(double a, double b) { return a < b ? b : a; }
FUNCTION double within(double x, double low, double high) { return smaller(larger(x, low), high); }

// --- orientation and motion ---------------------------------------------------------------------------

typedef struct {
  double w, x, y, z;
} Turn;  // a unit quaternion: body to space

FUNCTION Turn turn(double w, double x, double y, double z) {
  Turn q = {w, x, y, z};
  return q;
}

// The tube axis: the body's z.
FUNCTION Vec turn_axis(Turn q) {
  return vec(2 * (q.x * q.z + q.w * q.y), 2 * (q.y * q.z - q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y));
}

typedef struct {
  Vec e1, e2, t;
} BodyFrame;

FUNCTION BodyFrame turn_frame(Turn q) {
  BodyFrame f;
  f.e1 = vec(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y));
  f.e2 = vec(2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x));
  f.t = turn_axis(q);
  return f;
}

// The frames R P and R P^T: f has the rotation R, and p has the rotation P.
FUNCTION BodyFrame frame_turned(BodyFrame f, BodyFrame p) {
  BodyFrame out;
  out.e1 = vec_sum(vec_sum(vec_scaled(p.e1.x, f.e1), vec_scaled(p.e1.y, f.e2)), vec_scaled(p.e1.z, f.t));
  out.e2 = vec_sum(vec_sum(vec_scaled(p.e2.x, f.e1), vec_scaled(p.e2.y, f.e2)), vec_scaled(p.e2.z, f.t));
  out.t = vec_sum(vec_sum(vec_scaled(p.t.x, f.e1), vec_scaled(p.t.y, f.e2)), vec_scaled(p.t.z, f.t));
  return out;
}
FUNCTION BodyFrame frame_turned_back(BodyFrame f, BodyFrame p) {
  BodyFrame out;
  out.e1 = vec_sum(vec_sum(vec_scaled(p.e1.x, f.e1), vec_scaled(p.e2.x, f.e2)), vec_scaled(p.t.x, f.t));
  out.e2 = vec_sum(vec_sum(vec_scaled(p.e1.y, f.e1), vec_scaled(p.e2.y, f.e2)), vec_scaled(p.t.y, f.t));
  out.t = vec_sum(vec_sum(vec_scaled(p.e1.z, f.e1), vec_scaled(p.e2.z, f.e2)), vec_scaled(p.t.z, f.t));
  return out;
}

// sin(h)/h and cos(h) of the square of h, up to the last bit for h below 0.25 and to 1e-12 below 0.5.
FUNCTION double sine_over(double h2) {
  return 1 + h2 * (-1.0 / 6 + h2 * (1.0 / 120 + h2 * (-1.0 / 5040 + h2 * (1.0 / 362880 - h2 * (1.0 / 39916800)))));
}
FUNCTION double cosine(double h2) {
  return 1 + h2 * (-0.5 + h2 * (1.0 / 24 + h2 * (-1.0 / 720 + h2 * (1.0 / 40320 + h2 * (-1.0 / 3628800 +
                                                                                        h2 * (1.0 / 479001600))))));
}

// exp(w dt) q, with one Newton step to unit norm, for turns w dt of up to half a radian.
FUNCTION Turn turned(Vec w, double dt, Turn q) {
  const double h2 = 0.25 * dt * dt * vec_norm2(w), scale = 0.5 * dt * sine_over(h2), c = cosine(h2);
  const double ax = scale * w.x, ay = scale * w.y, az = scale * w.z;
  const double rw = c * q.w - ax * q.x - ay * q.y - az * q.z;
  const double rx = c * q.x + ax * q.w + ay * q.z - az * q.y;
  const double ry = c * q.y + ay * q.w + az * q.x - ax * q.z;
  const double rz = c * q.z + az * q.w + ax * q.y - ay * q.x;
  const double unit = 1.5 - 0.5 * (rw * rw + rx * rx + ry * ry + rz * rz);
  return turn(unit * rw, unit * rx, unit * ry, unit * rz);
}

// --- anharmonic energies per length (anharmonic.hpp) ---------------------------------------------------

#define PULL_STEPS 8  // steps of the law of stretch beyond the window

struct Anharmonic {
  int used DEFAULT_0;                                                               // 0: the bond is harmonic
  double radius DEFAULT_0;                                                          // nm
  double coupling DEFAULT_0;                                                        // C, eV
  double e3 DEFAULT_0, e2s DEFAULT_0, es2 DEFAULT_0, s3 DEFAULT_0;                  // c_ij, eV/nm
  double e4 DEFAULT_0, e3s DEFAULT_0, e2s2 DEFAULT_0, es3 DEFAULT_0, s4 DEFAULT_0;  // c_ij, eV/nm
  double b4 DEFAULT_0;                                                              // c_b, eV/nm
  double min_strain DEFAULT_0, max_strain DEFAULT_0, max_shear DEFAULT_0,
      max_bend DEFAULT_0;  // window of e, |s|, b
  // What the pull adds to the tangent, at max_strain + k pull_step: force (eV/nm), its slope (eV/nm) and its integral
  // over the strain (eV/nm).
  double pull_step DEFAULT_0;  // 0: no pull is known
  double pull_force[PULL_STEPS + 1] DEFAULT_0, pull_slope[PULL_STEPS + 1] DEFAULT_0,
      pull_energy[PULL_STEPS + 1] DEFAULT_0;
};
typedef struct Anharmonic Anharmonic;

typedef struct {
  double energy, by_twist;
} TwistEnergy;

FUNCTION TwistEnergy twist_energy(GLOBAL const Anharmonic* h, double GJ, double twist) {
  const double g = GJ / (h->radius * h->radius);
  const double shear = h->radius * twist, s = within(shear, -h->max_shear, h->max_shear);
  const double slope = s * (g + s * (3 * h->s3 + 4 * s * h->s4));
  TwistEnergy out;
  out.energy = s * s * (0.5 * g + s * (h->s3 + s * h->s4)) + slope * (shear - s);
  out.by_twist = h->radius * slope;
  return out;
}

typedef struct {
  double energy, by_strain, by_twist;
} StrainEnergy;

FUNCTION StrainEnergy strain_energy(GLOBAL const Anharmonic* h, double strain, double twist) {
  const double shear = h->radius * twist;
  const double e = within(strain, h->min_strain, h->max_strain), s = within(shear, -h->max_shear, h->max_shear);
  // Coefficients of e, e^2 and e^3, and their derivatives by s.
  const double a1 = s * s * (h->es2 + s * h->es3), a1s = s * (2 * h->es2 + 3 * s * h->es3);
  const double a2 = s * (h->e2s + s * h->e2s2), a2s = h->e2s + 2 * s * h->e2s2;
  const double a3 = h->e3 + s * h->e3s;
  const double w = e * (a1 + e * (a2 + e * (a3 + e * h->e4)));
  const double we = a1 + e * (2 * a2 + e * (3 * a3 + e * 4 * h->e4));
  const double ws = e * (a1s + e * (a2s + e * h->e3s)), wes = a1s + e * (2 * a2s + e * 3 * h->e3s);
  const double de = strain - e, ds = shear - s;
  StrainEnergy out;
  out.energy = w + we * de + (ws + wes * de) * ds + h->coupling * strain * twist;
  out.by_strain = we + wes * ds + h->coupling * twist;
  out.by_twist = h->radius * (ws + wes * de) + h->coupling * strain;
  return out;
}

typedef struct {
  double energy, by_strain, by_strain2;
} StretchEnergy;

// The slope that the terms of strain alone add to EA at the upper edge of the window (eV/nm).
FUNCTION double slope_at_edge(GLOBAL const Anharmonic* h) {
  return 6 * h->max_strain * (h->e3 + 2 * h->e4 * h->max_strain);
}

// The law of stretch beyond the window: its part besides EA/2 e^2 and strain_energy().
FUNCTION StretchEnergy stretch_beyond(GLOBAL const Anharmonic* h, double EA, double strain) {
  const double beyond = larger(strain - h->max_strain, 0.0), step = h->pull_step;
  StretchEnergy out;
  if (step == 0 || beyond == 0) {
    out.by_strain2 = beyond > 0 ? slope_at_edge(h) : 0;
    out.by_strain = out.by_strain2 * beyond;
    out.energy = 0.5 * out.by_strain * beyond;
    return out;
  }
  const double past = beyond - PULL_STEPS * step;
  if (past >= 0) {
    out.by_strain2 = -EA;
    out.by_strain = h->pull_force[PULL_STEPS] - EA * past;
    out.energy = h->pull_energy[PULL_STEPS] + past * (h->pull_force[PULL_STEPS] - 0.5 * EA * past);
    return out;
  }
  const int k = (int)smaller(beyond / step, PULL_STEPS - 1.0);
  // The cubic of both forces and slopes, in t = 0 .. 1.
  const double t = beyond / step - k, f = h->pull_force[k], m = h->pull_slope[k] * step;
  const double rise = h->pull_force[k + 1] - f, m1 = h->pull_slope[k + 1] * step;
  const double c2 = 3 * rise - 2 * m - m1, c3 = m + m1 - 2 * rise;
  out.by_strain = f + t * (m + t * (c2 + t * c3));
  out.by_strain2 = (m + t * (2 * c2 + 3 * t * c3)) / step;
  out.energy = h->pull_energy[k] + step * t * (f + t * (m / 2 + t * (c2 / 3 + t * c3 / 4)));
  return out;
}

typedef struct {
  double energy, by_curvature2;
} BendEnergy;

FUNCTION BendEnergy bend_energy(GLOBAL const Anharmonic* h, double EI, double curvature2) {
  const double r2 = h->radius * h->radius, edge = h->max_bend * h->max_bend / r2, quartic = h->b4 * r2 * r2;
  const double inside = smaller(curvature2, edge), outside = larger(curvature2, edge);
  const double slope = 0.5 * EI + 2 * quartic * inside, on_edge = sqrt(edge / outside);
  BendEnergy out;
  out.energy = inside * (0.5 * EI + quartic * inside) + 2 * slope * (outside * on_edge - edge);
  out.by_curvature2 = slope * on_edge;
  return out;
}

// --- nodes of the contact (contact/line.hpp) -------------------------------------------------------------

// Place of node k of `nodes` on an element, from its centre (nm).
FUNCTION double line_node(int k, int nodes, double length) { return ((k + 0.5) / nodes - 0.5) * length; }

// --- the bond (bond.hpp) ------------------------------------------------------------------------------

struct BondStiffness {
  double stretch DEFAULT_0;  // EA, eV/nm
  double bend DEFAULT_0;     // EI, eV nm
  double twist DEFAULT_0;    // GJ, eV nm
  double shear DEFAULT_0;    // kGA, eV/nm; 0: rigid in shear, as in the published model
  Anharmonic anharmonic DEFAULT_0;
  double bend_difference DEFAULT_0;  // (EI_1 - EI_2)/2, eV nm; `bend` is the mean of both
  Vec natural DEFAULT_0;             // at rest: curvature about e1 and e2 (1/nm), and twist per length (rad/nm)
};
typedef struct BondStiffness BondStiffness;

// Numbers of a bond of one length that has a natural shape or two stiffnesses of bending.
typedef struct {
  int used;                 // 0: the bond has neither
  double share;             // (s_1 EI_1 + s_2 EI_2)/(2 EI)
  double shear_difference;  // (s_1 EI_1 - s_2 EI_2)/2, eV nm
  BodyFrame turn;           // P, half of the natural rotation
} BondShape;

typedef struct {
  double stretch, shear, bend, twist;  // eV
} BondEnergy;

typedef struct {
  BondEnergy energy;
  Vec force_j;             // force on element j; element i feels the opposite
  Vec torque_i, torque_j;  // about the element centres
} BondAction;

// The angle of twist of a bond has this sine and cosine, times 1 + t_i.t_j.
FUNCTION double twist_sine(BodyFrame i, BodyFrame j) { return vec_dot(i.e2, j.e1) - vec_dot(i.e1, j.e2); }
FUNCTION double twist_cosine(BodyFrame i, BodyFrame j) { return vec_dot(i.e1, j.e1) + vec_dot(i.e2, j.e2); }

// share: shear_share() of a bond of length a.
FUNCTION BondEnergy harmonic_energy(GLOBAL const BondStiffness* k, double share, double a, Vec separation,
                                    BodyFrame i, BodyFrame j) {
  const double length = sqrt(vec_norm2(separation));
  const Vec d = vec_divided(separation, length);
  const double stretch = length - a;
  // 1 - u.v is written as |u - v|^2/2 so that small bends do not drown in rounding.
  const double one_minus_c = vec_norm2(vec_difference(i.t, j.t)) * 0.5;
  const double one_minus_td = (vec_norm2(vec_difference(i.t, d)) + vec_norm2(vec_difference(j.t, d))) * 0.25;
  const double frame_misfit =
      (vec_norm2(vec_difference(i.e1, j.e1)) + vec_norm2(vec_difference(i.e2, j.e2))) * 0.5;  // 2 - w
  BondEnergy e;
  e.stretch = 0.5 * k->stretch / a * stretch * stretch;
  e.bend = k->bend / a * one_minus_c;
  e.shear = share * k->bend / a * (12.0 * one_minus_td - 3.0 * one_minus_c);
  e.twist = 0.5 * k->twist / a * (frame_misfit - one_minus_c);
  return e;
}

FUNCTION BondAction harmonic_bond(GLOBAL const BondStiffness* k, double share, double a, Vec separation,
                                  BodyFrame i, BodyFrame j) {
  const double length = sqrt(vec_norm2(separation));
  const Vec d = vec_divided(separation, length);
  const double b2 = 12.0 * share * k->bend / a, b3 = (1.0 - 3.0 * share) * k->bend / a - 0.5 * k->twist / a;
  const double b4 = k->twist / a;
  BondAction out;
  out.energy = harmonic_energy(k, share, a, separation, i, j);
  const Vec s = vec_sum(i.t, j.t);
  out.force_j = vec_sum(vec_scaled(-(k->stretch / a) * (length - a), d),
                        vec_scaled(0.5 * b2 / length, vec_difference(s, vec_scaled(vec_dot(s, d), d))));
  // For a body vector u with g = dU/du the torque is g x u.
  const Vec frames = vec_sum(vec_scaled(0.5 * b4, vec_sum(vec_cross(i.e1, j.e1), vec_cross(i.e2, j.e2))),
                             vec_scaled(b3, vec_cross(i.t, j.t)));
  out.torque_i = vec_sum(vec_scaled(-(0.5 * b2), vec_cross(d, i.t)), frames);
  out.torque_j = vec_difference(vec_scaled(-(0.5 * b2), vec_cross(d, j.t)), frames);
  return out;
}

// The harmonic bond of the frames i = R_i P and j = R_j P^T, with its two stiffnesses of bending.
FUNCTION BondAction shaped_bond(GLOBAL const BondStiffness* k, double share, double shear_difference, double a,
                                Vec separation, BodyFrame i, BodyFrame j) {
  BondAction out = harmonic_bond(k, share, a, separation, i, j);
  const double length = sqrt(vec_norm2(separation)), bend = k->bend_difference / a, shear = 12 * shear_difference / a;
  const Vec d = vec_divided(separation, length), m1 = vec_sum(i.e1, j.e1), m2 = vec_sum(i.e2, j.e2);
  const double w1 = 0.5 * (vec_dot(i.t, j.e2) - vec_dot(i.e2, j.t)), w2 = 0.5 * (vec_dot(i.e1, j.t) - vec_dot(i.t, j.e1));
  const double n1 = 0.5 * vec_dot(d, m1), n2 = 0.5 * vec_dot(d, m2);
  out.energy.bend += 0.5 * bend * (w1 * w1 - w2 * w2);
  out.energy.shear += 0.5 * shear * (n2 * n2 - n1 * n1);
  const Vec about_1 = vec_difference(vec_cross(i.t, j.e2), vec_cross(i.e2, j.t)),
            about_2 = vec_difference(vec_cross(i.e1, j.t), vec_cross(i.t, j.e1));
  const Vec bending = vec_difference(vec_scaled(0.5 * bend * w1, about_1), vec_scaled(0.5 * bend * w2, about_2));
  const Vec by_d = vec_scaled(0.5 * shear, vec_difference(vec_scaled(n2, m2), vec_scaled(n1, m1)));
  out.force_j = vec_difference(out.force_j, vec_divided(vec_difference(by_d, vec_scaled(vec_dot(by_d, d), d)), length));
  const Vec lean_i = vec_scaled(0.5 * shear, vec_difference(vec_scaled(n2, i.e2), vec_scaled(n1, i.e1))),
            lean_j = vec_scaled(0.5 * shear, vec_difference(vec_scaled(n2, j.e2), vec_scaled(n1, j.e1)));
  out.torque_i = vec_sum(vec_difference(out.torque_i, bending), vec_cross(d, lean_i));
  out.torque_j = vec_sum(vec_sum(out.torque_j, bending), vec_cross(d, lean_j));
  return out;
}

// delta^2 of cos delta = 1 - u, and its derivative: the series of arccos(1 - u)^2, within 3e-3 at 90 degrees and
// 1e-6 at 40.
FUNCTION double squared_angle(double u) {
  return 2.0 * u * (1.0 + u * (1.0 / 6 + u * (2.0 / 45 + u * (1.0 / 70 + u * (8.0 / 1575)))));
}
FUNCTION double squared_angle_slope(double u) {
  return 2.0 * (1.0 + u * (2.0 / 6 + u * (6.0 / 45 + u * (4.0 / 70 + u * (40.0 / 1575)))));
}

// The strain of the arc of an anharmonic bond; length: of the separation.
FUNCTION double arc_strain(double a, double length, BodyFrame i, BodyFrame j) {
  const double u = vec_norm2(vec_difference(i.t, j.t)) * 0.5, arc = 1.0 + u * (1.0 / 12);
  return length * arc / a - 1.0;
}

// The anharmonic bond without what its law of stretch adds beyond the window. angle: of twist, rad. Each reader has
// an arc tangent of its own.
FUNCTION BondAction window_bond(GLOBAL const BondStiffness* k, double share, double a, Vec separation,
                                    BodyFrame i, BodyFrame j, double angle) {
  const double length = sqrt(vec_norm2(separation));
  const Vec d = vec_divided(separation, length);
  const double u = vec_norm2(vec_difference(i.t, j.t)) * 0.5, arc = 1.0 + u * (1.0 / 12);
  const double strain = length * arc / a - 1.0, twist = angle / a, curvature2 = squared_angle(u) / (a * a);
  const TwistEnergy of_twist = twist_energy(&k->anharmonic, k->twist, twist);
  const StrainEnergy of_strain = strain_energy(&k->anharmonic, strain, twist);
  const BendEnergy of_bend = bend_energy(&k->anharmonic, k->bend, curvature2);
  const Vec sum = vec_sum(i.t, j.t);
  const double sum_norm = sqrt(vec_norm2(sum)), shear = 12.0 * share * k->bend / a;
  const Vec along = vec_divided(sum, sum_norm);
  const double cos_psi = vec_dot(along, d);

  // Derivatives of the energy: by the strain over the length, by the angle of twist, and by u.
  const double pull = k->stretch * strain + of_strain.by_strain, moment = of_twist.by_twist + of_strain.by_twist;
  const double by_u = of_bend.by_curvature2 * squared_angle_slope(u) / a + pull * length * (1.0 / 12);

  BondAction out;
  out.energy.stretch = a * (0.5 * k->stretch * strain * strain + of_strain.energy);
  out.energy.twist = a * of_twist.energy;
  out.energy.bend = a * of_bend.energy;
  out.energy.shear = 0.5 * shear * vec_norm2(vec_difference(along, d));
  out.force_j = vec_difference(vec_scaled(shear / length, vec_difference(along, vec_scaled(cos_psi, d))),
                               vec_scaled(pull * arc, d));
  const Vec bending = vec_sum(vec_scaled(by_u, vec_cross(i.t, j.t)), vec_scaled(moment / (2.0 - u), sum));
  const Vec lean = vec_scaled(shear / sum_norm, vec_difference(d, vec_scaled(cos_psi, along)));
  out.torque_i = vec_difference(bending, vec_cross(lean, i.t));
  out.torque_j = vec_difference(vec_negative(bending), vec_cross(lean, j.t));
  return out;
}

// Force and energy that the pull adds to the bond beyond the window; zero within it.
FUNCTION BondAction bond_beyond(GLOBAL const BondStiffness* k, double a, Vec separation, BodyFrame i, BodyFrame j) {
  const double length = sqrt(vec_norm2(separation)), arc = 1.0 + vec_norm2(vec_difference(i.t, j.t)) * (0.5 / 12);
  const StretchEnergy more = stretch_beyond(&k->anharmonic, k->stretch, arc_strain(a, length, i, j));
  const Vec bending = vec_scaled(more.by_strain * length * (1.0 / 12), vec_cross(i.t, j.t));
  BondAction out;
  out.energy.stretch = a * more.energy;
  out.energy.shear = out.energy.bend = out.energy.twist = 0;
  out.force_j = vec_scaled(-(more.by_strain * arc / length), separation);
  out.torque_i = bending;
  out.torque_j = vec_negative(bending);
  return out;
}

FUNCTION BondAction anharmonic_bond(GLOBAL const BondStiffness* k, double share, double a, Vec separation,
                                    BodyFrame i, BodyFrame j, double angle) {
  BondAction out = window_bond(k, share, a, separation, i, j, angle);
  if (arc_strain(a, sqrt(vec_norm2(separation)), i, j) > k->anharmonic.max_strain) {
    const BondAction more = bond_beyond(k, a, separation, i, j);
    out.energy.stretch += more.energy.stretch;
    out.force_j = vec_sum(out.force_j, more.force_j);
    out.torque_i = vec_sum(out.torque_i, more.torque_i);
    out.torque_j = vec_sum(out.torque_j, more.torque_j);
  }
  return out;
}

// --- damping of a bond (damping.hpp) ------------------------------------------------------------------

// Opposite forces at one point, as seen at the two centres.
typedef struct {
  Vec force_j;
  Vec torque_i, torque_j;
  double power;  // work per time done on the pair, never positive (eV/ps)
} PairDamping;

FUNCTION PairDamping bond_damping(double rate, double mass, double inertia, Vec separation, Vec v_i, Vec w_i,
                                  Vec v_j, Vec w_j) {
  const Vec arm = vec_scaled(0.5, separation), spin = vec_difference(w_j, w_i);
  const Vec relative = vec_difference(vec_difference(v_j, v_i), vec_cross(vec_sum(w_i, w_j), arm));
  const Vec couple = vec_scaled(-0.5 * rate * inertia, spin);
  PairDamping f;
  f.force_j = vec_scaled(-0.5 * rate * mass, relative);
  const Vec lever = vec_negative(vec_cross(arm, f.force_j));
  f.torque_i = vec_difference(lever, couple);
  f.torque_j = vec_sum(lever, couple);
  f.power = vec_dot(f.force_j, relative) + vec_dot(couple, spin);
  return f;
}
