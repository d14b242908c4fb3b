#include "sim/forces/terms/damping_terms.hpp"

namespace ropewalk {
namespace {

class LocalDampingTerm : public ForceTerm {
 public:
  explicit LocalDampingTerm(double alpha) : alpha_(alpha) {}

  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<LocalDampingTerm>(*this); }
  std::string name() const override { return "pfc_local"; }

  bool acts_in_kick() const override { return true; }
  void add_in_kick(const State& state, const ForceRows& total, const Segment& part,
                   const ForceRows& out) const override {
    const auto brake = [&](const Column& force, const Column& velocity, Column& sum) {
      for (std::ptrdiff_t i = part.begin; i < part.end; ++i)
        sum[static_cast<std::size_t>(i - out.origin)] += pfc_local(
            alpha_, force[static_cast<std::size_t>(i - total.origin)], velocity[static_cast<std::size_t>(i)]);
    };
    const auto brake_all = [&](const Vec3Array& force, const Vec3Array& velocity, Vec3Array& sum) {
      brake(force.x, velocity.x, sum.x);
      brake(force.y, velocity.y, sum.y);
      brake(force.z, velocity.z, sum.z);
    };
    brake_all(total.force, state.velocity, out.force);
    brake_all(total.torque, state.angular_velocity, out.torque);
  }

 private:
  double alpha_;
};

}  // namespace

std::unique_ptr<ForceTerm> local_damping_term(double alpha) { return std::make_unique<LocalDampingTerm>(alpha); }

}  // namespace ropewalk
