// Topology and state of a scene: structure of arrays, elements of a tube consecutive along it.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "model/bond.hpp"
#include "model/contact/contact.hpp"
#include "model/contract.hpp"
#include "sim/state/columns.hpp"

namespace ropewalk {

using Quaternion = Eigen::Quaterniond;

// Number of elements whose state stays in the first-level cache.
inline constexpr int cached_elements = 128;

// Smallest number of elements for which a team of threads saves time.
inline constexpr std::size_t parallel_from = 512;

// An array of vectors, by components.
struct Vec3Array : ColumnBlock<3> {
  Column x, y, z;

  explicit Vec3Array(std::size_t n = 0) { resize(n); }
  Vec3Array(const Vec3Array& other) : ColumnBlock() { *this = other; }
  Vec3Array(Vec3Array&& other) noexcept { *this = std::move(other); }
  Vec3Array& operator=(const Vec3Array& other) {
    if (this != &other) copy(columns(), {&other.x, &other.y, &other.z});
    return *this;
  }
  Vec3Array& operator=(Vec3Array&& other) noexcept {
    swap(columns(), other, other.columns());
    return *this;
  }
  std::size_t size() const { return x.size(); }
  void resize(std::size_t n) { ColumnBlock::resize(columns(), n); }
  void set_to_zero() {
    for (Column* c : columns()) std::fill(c->begin(), c->end(), 0.0);
  }
  Vector3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vector3& v) {
    x[i] = v.x();
    y[i] = v.y();
    z[i] = v.z();
  }
  void add(std::size_t i, const Vector3& v) {
    x[i] += v.x();
    y[i] += v.y();
    z[i] += v.z();
  }

 private:
  Columns columns() { return {&x, &y, &z}; }
};

struct QuaternionArray : ColumnBlock<4> {
  Column w, x, y, z;

  explicit QuaternionArray(std::size_t n = 0) {
    resize(columns(), n);
    std::fill(w.begin(), w.end(), 1.0);
  }
  QuaternionArray(const QuaternionArray& other) : ColumnBlock() { *this = other; }
  QuaternionArray(QuaternionArray&& other) noexcept { *this = std::move(other); }
  QuaternionArray& operator=(const QuaternionArray& other) {
    if (this != &other) copy(columns(), {&other.w, &other.x, &other.y, &other.z});
    return *this;
  }
  QuaternionArray& operator=(QuaternionArray&& other) noexcept {
    swap(columns(), other, other.columns());
    return *this;
  }
  std::size_t size() const { return w.size(); }
  Quaternion operator[](std::size_t i) const { return {w[i], x[i], y[i], z[i]}; }
  void set(std::size_t i, const Quaternion& q) {
    w[i] = q.w();
    x[i] = q.x();
    y[i] = q.y();
    z[i] = q.z();
  }

 private:
  Columns columns() { return {&w, &x, &y, &z}; }
};

// Properties of all tubes of one type.
struct TubeType {
  double element_length = 0;  // equilibrium length of a bond, nm
  double radius = 0;          // nm
  double mass = 0;            // mass of one element, eV ps^2/nm^2
  double inertia = 0;         // isotropic, eV ps^2
  BondStiffness bond;

  // The number of elements along a length `arc` (nm) of a tube, rounded up.
  int elements_within(double arc) const {
    ROPEWALK_EXPECTS(arc >= 0 && element_length > 0);
    return static_cast<int>(std::ceil(arc / element_length - 1e-9));
  }
};

// Elements of a scene that one process owns, with copies of those near them, which other processes own. It computes
// the pairs (i, j > i) and the bonds (i, i + 1) of its own elements i; copies only receive forces. So every pair
// and bond of the scene belongs to one process. Tubes of such a topology are pieces: consecutive elements of one
// tube.
struct PartOfScene {
  std::vector<char> own;     // whether each element belongs to this part
  std::vector<int> number;   // number of each element in the scene
  std::vector<int> row_end;  // number behind the last element of each piece's tube in the scene, or of its strand
                             // where ends meet (TubeGroups::ends_meet)
};

// What the tubes of a scene form together. The mass, length and section of a rope follow from it
// (observe/rope_size.hpp).
struct TubeGroups {
  // A strand is a row of tubes that follow one another in line, as in a rope of finite tubes: the first tube of
  // each strand, and the number of tubes. Empty: each tube is a strand.
  std::vector<int> strand_begin;
  double strand_holes = 0;  // nm, sum of the holes between a strand's tubes at the start, in the strand with most
  // Ends of tubes that follow one another in a strand have a contact of their own (forces/terms/tube_ends.hpp).
  // Elements near such ends do not touch one another otherwise, just as neighbours in one tube do not.
  bool ends_meet = false;
  // A slice of an endless rope: so many elements at each end of a strand are images of the elements one period away
  // (scene/ends/periodic.hpp). All strands have as many elements. 0: no slice.
  int images = 0;
  double period = 0;          // period at the start, nm
  double period_inertia = 0;  // inertia of its changes, eV ps^2/nm^2
  // Ropes that are plied: the first strand of each, and the number of strands. Empty: all are one rope.
  std::vector<int> rope_begin;
};

// Elements and their tubes. Tube t owns the elements tube_begin[t] .. tube_begin[t+1] - 1; consecutive
// ones are bonded.
struct Topology {
  std::vector<int> tube_begin{0};
  std::vector<int> tube_type;  // type of each tube, an index of `types`
  std::vector<TubeType> types = std::vector<TubeType>(1);
  TubeGroups groups;
  std::optional<PartOfScene> part;  // none: these elements are the scene

  int tubes() const { return static_cast<int>(tube_begin.size()) - 1; }
  int elements() const { return tube_begin.back(); }
  int bonds() const { return elements() - tubes(); }
  int strands() const {
    return groups.strand_begin.empty() ? tubes() : static_cast<int>(groups.strand_begin.size()) - 1;
  }
  int ropes() const { return groups.rope_begin.empty() ? 1 : static_cast<int>(groups.rope_begin.size()) - 1; }
  // The strands of a rope: the first, and the one behind the last.
  std::pair<int, int> strands_of_rope(int rope) const;
  // Whether the first end of a tube, or its last one, is that of its strand.
  bool begins_strand(int tube) const;
  bool ends_strand(int tube) const;
  // The first and the last tube of the strand of a tube.
  std::pair<int, int> strand_of(int tube) const;
  int length_of(int tube) const {
    ROPEWALK_EXPECTS(tube >= 0 && tube < tubes());
    return tube_begin[tube + 1] - tube_begin[tube];
  }
  void add_tube(int elements, int type = 0) {
    ROPEWALK_EXPECTS(elements > 0 && type >= 0);
    tube_begin.push_back(tube_begin.back() + elements);
    tube_type.push_back(type);
  }
  const TubeType& type_of(int tube) const {
    ROPEWALK_EXPECTS(tube >= 0 && tube < tubes() && static_cast<std::size_t>(tube_type[tube]) < types.size());
    return types[static_cast<std::size_t>(tube_type[tube])];
  }
  const TubeType& type_of_element(int element) const { return type_of(tube_of(element)); }
  double largest_radius() const;
  double longest_element() const;
  int tube_of(int element) const;
  // The element of which this one is the image, or itself; and its image one period higher or lower, or -1.
  int original_of(int element) const;
  int image_above(int element) const;
  int image_below(int element) const;
  bool is_image(int element) const { return original_of(element) != element; }
  // The number of those in a tube that are no images.
  int own_elements(int tube) const;
  bool owns(int element) const {
    ROPEWALK_EXPECTS(element >= 0 && element < elements());
    return !part || part->own[static_cast<std::size_t>(element)] != 0;
  }
  // From `begin` on, the first element that is owned where that one is not, or the other way round; `end` at most.
  int change_of_owner(int begin, int end) const;
  // The last element that is at most `elements` elements behind this one of `tube` and belongs to the same tube,
  // or, where ends meet, to the same strand.
  int last_within(int elements, int element, int tube) const;
  // The least elements_within() of all types.
  int fewest_within(double arc) const;
};

// The tubes cut behind the elements with a flag; the pieces of a tube belong to its strand.
Topology cut_behind(const Topology& topology, const std::vector<char>& flags);

// The strands of a scene as its tubes, each of the type of its first tube. The elements keep their numbers.
Topology strands_of(const Topology& topology);

struct State {
  Vec3Array position;           // nm
  QuaternionArray orientation;  // body to space; the tube axis is the body's z
  Vec3Array velocity;           // nm/ps
  Vec3Array angular_velocity;   // rad/ps, space frame
  double time = 0;              // ps
  std::int64_t step = 0;
  int part = 0;  // number of the part of a step that is divided, from 0

  explicit State(std::size_t n = 0) : position(n), orientation(n), velocity(n), angular_velocity(n) {}
  std::size_t size() const { return position.size(); }
};

inline forms::Turn plain(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

inline Frame frame_of(const Quaternion& q) {
  const forms::BodyFrame f = forms::turn_frame(plain(q));
  return {vector(f.e1), vector(f.e2), vector(f.t)};
}

// The rotation of a natural shape over this arc (nm), in the body frame.
inline Quaternion natural_turn(const BondStiffness& k, double arc) {
  const Vector3 turn = arc * vector(k.natural);
  const double angle = turn.norm();
  return angle > 0 ? Quaternion(Eigen::AngleAxisd(angle, turn / angle)) : Quaternion::Identity();
}

// The tube axis alone.
inline Vector3 axis_of(const Quaternion& q) { return vector(forms::turn_axis(plain(q))); }

}  // namespace ropewalk
