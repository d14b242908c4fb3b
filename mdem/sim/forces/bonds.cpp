#include "sim/forces/bonds.hpp"

#include <algorithm>

#include "model/contract.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
namespace {

// Consecutive bonds of a tube, counted from its element `begin`, which frame 0 is of.
struct BondRange {
  std::ptrdiff_t begin, from, to;
};

}  // namespace
}  // namespace ropewalk

#define ROPEWALK_LOOPS "sim/forces/bond_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {
namespace {

// The bonds of the range, none of which is broken, with their damping: into `work`, from the frames in it.
BondSum whole_bonds(const BondInput& in, int tube, const BondRange& range, TubeBonds& work) {
  const TubeType& type = in.topology.type_of(tube);
  BondSum sum;
  double slips = 1;
  ROPEWALK_EXPECTS(!type.bond.anharmonic.used || !is_shaped(type.bond));
  const auto forces = type.bond.anharmonic.used ? ROPEWALK_IN_USE(anharmonic_forces)
                      : is_shaped(type.bond)    ? ROPEWALK_IN_USE(shaped_forces)
                                                : ROPEWALK_IN_USE(harmonic_forces);
  sum.energy = forces(type, in.state.position, work.frames, range, work.bonds, slips);
  if (type.bond.anharmonic.used && ROPEWALK_IN_USE(largest_strain)(type, in.state.position, work.frames, range) >
                                       type.bond.anharmonic.max_strain)
    sum.energy.stretch += ROPEWALK_IN_USE(add_beyond)(type, in.state.position, work.frames, range, work.bonds);
  for (std::ptrdiff_t i = range.from; !(slips > 0) && i < range.to && sum.slipping < 0; ++i) {
    const auto [fi, fj] = bond_ends(type.bond, type.element_length, work.frames[static_cast<std::size_t>(i)],
                                    work.frames[static_cast<std::size_t>(i + 1)]);
    if (!(fi.e1.dot(fj.e1) + fi.e2.dot(fj.e2) > 0)) sum.slipping = static_cast<int>(range.begin + i);
  }
  if (in.damping.rate > 0) sum.power = ROPEWALK_IN_USE(bond_damping)(type, in.damping, in.state, range, work.bonds);
  return sum;
}

BondSum bonds_of(const BondInput& in, int tube, const BondRange& range, TubeBonds& work) {
  if (!in.broken) return whole_bonds(in, tube, range, work);
  BondSum sum;
  std::ptrdiff_t from = range.from;
  for (std::ptrdiff_t i = range.from; i <= range.to; ++i) {
    if (i < range.to && !(*in.broken)[static_cast<std::size_t>(range.begin + i)]) continue;
    if (from < i) add(whole_bonds(in, tube, {range.begin, from, i}, work), sum);
    if (i < range.to)
      for (Vec3Array* of : {&work.bonds.force_j, &work.bonds.torque_i, &work.bonds.torque_j})
        of->set(static_cast<std::size_t>(i), Vector3::Zero());
    from = i + 1;
  }
  return sum;
}

void put(const Joint& joint, std::size_t at, BondArray& bonds) {
  bonds.force_j.set(at, joint.force_j);
  bonds.torque_i.set(at, joint.torque_i);
  bonds.torque_j.set(at, joint.torque_j);
}

}  // namespace

void add(const BondSum& of, BondSum& sum) {
  sum.energy.stretch += of.energy.stretch;
  sum.energy.shear += of.energy.shear;
  sum.energy.bend += of.energy.bend;
  sum.energy.twist += of.energy.twist;
  sum.power += of.power;
  if (sum.slipping < 0) sum.slipping = of.slipping;
}

void add_behind(const Joint& bond, int element, const ForceRows& out) {
  const auto at = static_cast<std::size_t>(element - out.origin);
  out.force.add(at, bond.force_j);
  out.torque.add(at, bond.torque_j);
}

Joint joint_behind(const BondInput& in, int tube, int i) {
  ROPEWALK_EXPECTS(i >= in.topology.tube_begin[tube] && i + 1 < in.topology.tube_begin[tube + 1]);
  thread_local TubeBonds work;
  work.resize(2);
  ROPEWALK_IN_USE(frames_of)(in.state.orientation, i, i, i + 2, work.frames);
  Joint out;
  out.sum = bonds_of(in, tube, {i, 0, 1}, work);
  out.force_j = work.bonds.force_j[0];
  out.torque_i = work.bonds.torque_i[0];
  out.torque_j = work.bonds.torque_j[0];
  return out;
}

BondSum compute_bonds(const BondInput& in, const Segment& of, const Joint* before, const Joint* behind,
                      const ForceRows& out) {
  ROPEWALK_EXPECTS(of.begin < of.end && of.begin >= in.topology.tube_begin[of.tube] &&
                   of.end <= in.topology.tube_begin[of.tube + 1]);
  ROPEWALK_EXPECTS(!before || of.begin > in.topology.tube_begin[of.tube]);
  ROPEWALK_EXPECTS(!behind || of.end < in.topology.tube_begin[of.tube + 1]);
  thread_local TubeBonds work;
  const std::ptrdiff_t from = before ? 1 : 0, begin = of.begin - from, to = of.end - begin,
                       bonds = to - 1 + (behind ? 1 : 0);
  BondArray& each = work.bonds;
  work.resize(static_cast<std::size_t>(to));
  ROPEWALK_IN_USE(frames_of)(in.state.orientation, begin, of.begin, of.end, work.frames);
  BondSum sum = bonds_of(in, of.tube, {begin, from, to - 1}, work);
  if (before) put(*before, 0, each);
  if (behind) {
    put(*behind, static_cast<std::size_t>(to - 1), each);
    add(behind->sum, sum);
  }
  const auto collect = [&](const Column& on_i, double sign_i, const Column& on_j, Column& sums) {
    ROPEWALK_IN_USE(collect_bonds)(on_i, sign_i, on_j, bonds, from, to, sums.data() + (of.begin - out.origin));
  };
  collect(each.force_j.x, -1, each.force_j.x, out.force.x);
  collect(each.force_j.y, -1, each.force_j.y, out.force.y);
  collect(each.force_j.z, -1, each.force_j.z, out.force.z);
  collect(each.torque_i.x, 1, each.torque_j.x, out.torque.x);
  collect(each.torque_i.y, 1, each.torque_j.y, out.torque.y);
  collect(each.torque_i.z, 1, each.torque_j.z, out.torque.z);
  return sum;
}

}  // namespace ropewalk
