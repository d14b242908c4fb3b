// Structures and numbers that the kernels of a device share with the program. C, for OpenCL and C++ alike. Before this
// text: model/forms.h.
#define GROUP 128  // work items of a group
#define LANES 8    // work items that share an element in the contact
// The table of the line law (sim/contact/line/radial_table.hpp).
#define SEGMENTS 16
#define TERMS 7
#define MANTISSA_LEFT 21
#define MAX_NODES 12
#define MAX_TYPES 6

// Bits of `kind`: the type of the element's tube; the element is bonded to the next one; the host moves the element.
#define KIND_TYPE 0xff
#define KIND_BONDED 0x100
#define KIND_HOSTED 0x200

// Columns of `told`, and of its summary.
enum { TOLD_SPEED2, TOLD_SPIN2, TOLD_MOVED, TOLD_TURN, TOLD_TURN_Z, TOLD_POWER, TOLD_SLIPS, TOLD };
enum { SUM_SPEEDS = TOLD, SUM_MOVED, SUMMARY };
#define NO_ELEMENT 2147483647

// The members have the names and units of TubeType; shear_share and shape: of bonds of this length.
typedef struct {
  double mass, inertia, length, shear_share;
  BondStiffness bond;
  BondShape shape;
} ElementType;

// Places of the nodes on an element of one type of tube, from its centre, in units of LineTables::unit.
typedef struct {
  float s[MAX_NODES];
  float rim;  // place of the last node
  int count;
} NodeRow;

// RadialTable<float, SEGMENTS, TERMS> for two types of tubes. A pair of nodes has the weight `weight`.
typedef struct {
  float d[TERMS * SEGMENTS];
  float scale, shift, core2, cutoff2, unit, rest, v1, v2, weight;
} PairTable;

typedef struct {
  PairTable pair[MAX_TYPES * MAX_TYPES];
  NodeRow row[MAX_TYPES];
  double cutoff[MAX_TYPES * MAX_TYPES];  // nm, distance of two nodes
  double unit;                           // nm
} LineTables;

// nm: the largest distance of the centres of listed elements, the same for the viscosity alone, and the list's margin.
typedef struct {
  double centres, viscosity, skin;
} ListReach;

#define NEAR 0.05  // nm; neighbours with a node no farther beyond the cutoff stand first in the list

#define BUCKET(x, y, z, buckets) \
  ((int)(((unsigned)(x) * 73856093u ^ (unsigned)(y) * 19349663u ^ (unsigned)(z) * 83492791u) & (unsigned)((buckets) - 1)))

// The parameters of ContactViscosity. per_width = 1/(outer - inner); unit: nm, of the coordinates.
typedef struct {
  float eta, inner, outer, per_width, unit;
} Viscosity;

// The parameters of TwistOfAll. lever: nm, the largest distance of a node from the centre of its element.
typedef struct {
  double x, y, middle, sine, slope, most, lever;
} TwistSince;
