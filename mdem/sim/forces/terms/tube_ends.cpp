#include "sim/forces/terms/tube_ends.hpp"

#include <algorithm>

#include "model/contract.hpp"
#include "sim/forces/pair_stiffness.hpp"

namespace ropewalk {
namespace {

// Two ends that meet: their elements and their contact.
struct EndJoint {
  int below = 0, above = 0;
  double half_below = 0, half_above = 0;  // half lengths of the elements, nm
  std::size_t contact = 0;
};

struct EndJointForce {
  double energy = 0;
  Vector3 force_above = Vector3::Zero();  // minus that below
  Vector3 torque_below = Vector3::Zero(), torque_above = Vector3::Zero();
};

class TubeEnds : public ForceTerm {
 public:
  TubeEnds(std::vector<EndContact> contacts, const Topology& scene) : contacts_(std::move(contacts)) {
    ROPEWALK_EXPECTS(contacts_.size() == scene.types.size() * scene.types.size() && !scene.part);
    for (int t = 0; t + 1 < scene.tubes(); ++t) {
      if (scene.ends_strand(t)) continue;
      const auto type_below = static_cast<std::size_t>(scene.tube_type[static_cast<std::size_t>(t)]),
                 type_above = static_cast<std::size_t>(scene.tube_type[static_cast<std::size_t>(t) + 1]);
      const int behind = scene.tube_begin[static_cast<std::size_t>(t) + 1];
      joints_.push_back({behind - 1, behind, 0.5 * scene.types[type_below].element_length,
                         0.5 * scene.types[type_above].element_length,
                         type_below * scene.types.size() + type_above});
    }
    here_ = joints_;
  }
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<TubeEnds>(*this); }
  std::string name() const override { return "ends"; }

  // Each of several processes has the joints whose two elements are here; copies reach as far as a contact.
  void prepare(const ListedScene& scene) override {
    if (!scene.topology.part) return;
    const std::vector<int>& number = scene.topology.part->number;
    here_.clear();
    for (std::size_t i = 0; i + 1 < number.size(); ++i) {
      if (number[i] + 1 != number[i + 1]) continue;
      const auto joint = std::lower_bound(joints_.begin(), joints_.end(), number[i],
                                          [](const EndJoint& j, int below) { return j.below < below; });
      if (joint == joints_.end() || joint->below != number[i]) continue;
      here_.push_back(*joint);
      here_.back().below = static_cast<int>(i);
      here_.back().above = static_cast<int>(i) + 1;
    }
  }

  // Its energy belongs to the element below.
  TermSum add(const State& state, const Segment& part, const ForceRows& out) const override {
    TermSum sum;
    const auto within = [&](int i) { return part.begin <= i && i < part.end; };
    const auto row = [&](int i) { return static_cast<std::size_t>(i - out.origin); };
    // Joints rise with their elements; that of the element before the part has its first one above.
    auto joint = std::lower_bound(here_.begin(), here_.end(), static_cast<int>(part.begin),
                                  [](const EndJoint& j, int i) { return j.above < i; });
    for (; joint != here_.end() && joint->below < part.end; ++joint) {
      const EndJointForce f = force_of(*joint, state);
      if (within(joint->below)) {
        out.force.add(row(joint->below), -f.force_above);
        out.torque.add(row(joint->below), f.torque_below);
        sum.energy += f.energy;
      }
      if (within(joint->above)) {
        out.force.add(row(joint->above), f.force_above);
        out.torque.add(row(joint->above), f.torque_above);
      }
    }
    return sum;
  }

  bool add_tangent(const State& state, const AddBlock& add) const override {
    for (const EndJoint& joint : here_) {
      const auto forces = [&](const Pose& below, const Pose& above) {
        const EndJointForce f = force_of(joint, below, above);
        return PairVector(
            (PairVector() << -f.force_above, f.torque_below, f.force_above, f.torque_above).finished());
      };
      const PairMatrix k = pair_stiffness(forces, pose_of(state, joint.below), pose_of(state, joint.above));
      add(joint.below, joint.below, k.topLeftCorner<6, 6>());
      add(joint.below, joint.above, k.topRightCorner<6, 6>());
      add(joint.above, joint.below, k.bottomLeftCorner<6, 6>());
      add(joint.above, joint.above, k.bottomRightCorner<6, 6>());
    }
    return true;
  }

  // Two elements that swing against each other along their line.
  double stiffness() const override {
    double most = 0;
    for (const EndContact& c : contacts_) most = std::max(most, c.stiffness());
    return joints_.empty() ? 0 : 2 * most;
  }

  std::size_t bytes() const override { return (joints_.size() + here_.size()) * sizeof(EndJoint); }

 private:
  EndJointForce force_of(const EndJoint& joint, const State& state) const {
    return force_of(joint, pose_of(state, joint.below), pose_of(state, joint.above));
  }
  EndJointForce force_of(const EndJoint& joint, const Pose& below, const Pose& above) const {
    const EndContact& contact = contacts_[joint.contact];
    const Vector3 t_i = axis_of(below.orientation), t_j = axis_of(above.orientation);
    const Vector3 arm_i = joint.half_below * t_i, arm_j = -joint.half_above * t_j;
    const Vector3 d = above.position + arm_j - below.position - arm_i, both = t_i + t_j;
    const double length = both.norm();
    EndJointForce out;
    if (!(length > 0.1)) return out;  // they point against each other
    const Vector3 n = both / length;
    const double s = d.dot(n), width2 = contact.width() * contact.width();
    const Vector3 across = d - s * n;
    const double q = across.squaredNorm() / width2;
    if (q >= 1 || s >= contact.reach()) return out;
    const RadialTerms v = contact.terms(s);
    const double w = (1 - q) * (1 - q) * (1 - q), dw = -3 * (1 - q) * (1 - q);
    out.energy = v.energy * w;
    const Vector3 by_d = v.derivative * w * n + 2 * v.energy * dw / width2 * across;
    const Vector3 by_axis = (v.derivative * w - 2 * s * v.energy * dw / width2) / length * across;
    out.force_above = -by_d;
    out.torque_below = arm_i.cross(by_d) - t_i.cross(by_axis);
    out.torque_above = -arm_j.cross(by_d) - t_j.cross(by_axis);
    return out;
  }

  std::vector<EndContact> contacts_;
  std::vector<EndJoint> joints_;  // joints of the scene
  std::vector<EndJoint> here_;    // joints of this process, by its own numbers of elements
};

}  // namespace

std::shared_ptr<const ForceTerm> tube_ends_term(std::vector<EndContact> contacts, const Topology& scene) {
  return std::make_shared<const TubeEnds>(std::move(contacts), scene);
}

}  // namespace ropewalk
