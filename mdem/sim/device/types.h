// Structures and numbers that the kernels of a device share with the program. C, for OpenCL and C++ alike.
#define GROUP 128  // work items of a group
#define LANES 8    // work items that share an element in the contact
// The table of the line law (sim/contact/line/radial_table.hpp).
#define SEGMENTS 16
#define TERMS 7
#define MANTISSA_LEFT 21
#define MAX_NODES 12
#define MAX_TYPES 6

// What is known of an element: its type, whether it is bonded to the next one, whether the host moves it.
#define KIND_TYPE 0xff
#define KIND_BONDED 0x100
#define KIND_HOSTED 0x200

// Columns of `told`, and of its summary.
enum { TOLD_SPEED2, TOLD_SPIN2, TOLD_MOVED, TOLD_TURN, TOLD_TURN_Z, TOLD_POWER, TOLD_SLIPS, TOLD };
enum { SUM_SPEEDS = TOLD, SUM_MOVED, SUMMARY };
#define NO_ELEMENT 2147483647

// One type of tube, for its bonds and its motion: the names of BondStiffness and Anharmonic.
typedef struct {
  double mass, inertia, length;
  double stretch, bend, twist, shear_share;
  double radius, coupling, e3, e2s, es2, s3, e4, e3s, e2s2, es3, s4, b4;
  double min_strain, max_strain, max_shear, max_bend;
  int anharmonic;  // 0 or 1
} ElementType;

// The nodes of one type of tube, from the centre of an element, in units.
typedef struct {
  float s[MAX_NODES];
  float rim;  // the last one's
  int count;
} NodeRow;

// RadialTable<float, SEGMENTS, TERMS> of two types of tubes; weight: of a pair of nodes.
typedef struct {
  float d[TERMS * SEGMENTS];
  float scale, shift, core2, cutoff2, unit, rest, v1, v2, weight;
} PairTable;

typedef struct {
  PairTable pair[MAX_TYPES * MAX_TYPES];
  NodeRow row[MAX_TYPES];
  double cutoff[MAX_TYPES * MAX_TYPES];  // nm, of nodes
  double unit;                           // nm
} LineTables;

// How far the list of neighbours reaches (nm): centres of elements, those within the viscosity, and its margin.
typedef struct {
  double centres, viscosity, skin;
} ListReach;

#define NEAR 0.05  // nm beyond the cutoff, of neighbours that stand first in the list

#define BUCKET(x, y, z, buckets) \
  ((int)(((unsigned)(x) * 73856093u ^ (unsigned)(y) * 19349663u ^ (unsigned)(z) * 83492791u) & (unsigned)((buckets) - 1)))

// ContactViscosity; unit: of coordinates, nm.
typedef struct {
  float eta, inner, outer, per_width, unit;
} Viscosity;

// TwistOfAll, and how far points are from the centre of their element.
typedef struct {
  double x, y, middle, sine, slope, most, lever;
} TwistSince;
