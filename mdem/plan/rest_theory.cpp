#include "plan/rest_theory.hpp"

#include <cmath>

#include "model/error.hpp"
#include "scene/loads/twist.hpp"

namespace ropewalk {
namespace {

// eV/nm^3, per length of two parallel tubes at the distance at which they bind best.
double pair_stiffness(const ContactLaw& law, double element_length) {
  const double at = law.parallel_distance({}, element_length), step = 0.005;
  const auto energy = [&](double apart) {
    const int reach = static_cast<int>((law.cutoff() + element_length) / element_length);
    double sum = 0;
    for (int k = -reach; k <= reach; ++k)
      sum += law.energy({}, Vector3(apart, 0, k * element_length), Vector3::UnitZ(), Vector3::UnitZ());
    return sum / element_length;
  };
  return (energy(at + step) - 2 * energy(at) + energy(at - step)) / (step * step);
}

[[noreturn]] void refuse(const Scene& scene, const char* key, const char* why) {
  throw InputError(
      {scene.path, 0, key}, why,
      "take a [rope] of 7 tubes or more with a [twist] by couples on free ends, as `ropewalk new --kind "
      "spindle` has it");
}

}  // namespace

RestTheory rest_theory(const Scene& scene, const Prepared& p) {
  const auto twists = scene.drives_of<TwistDrive>();
  const int tubes = p.topology.tubes();
  if (!scene.source->is_parallel() || tubes < 7) refuse(scene, scene.kind.c_str(), "is no rope of straight tubes");
  if (scene.sets.size() > 1) refuse(scene, "parameters", "are of more than one type of tubes");
  if (twists.size() != 1) refuse(scene, "twist", "is missing");
  if (!p.interaction.law) refuse(scene, "contact.law", "is \"none\"");
  const TwistLoad& load = twists.front()->load;
  if (load.application == TwistLoad::Application::tangential)
    refuse(scene, "twist.application", "is \"tangential\": no couple winds the tubes");
  if (load.geometric_only) refuse(scene, "twist.geometric_only", "has states of rest of its own");
  if (load.unload_rate > 0)
    refuse(scene, "twist.unload_rate_nN_nm_per_ps", "takes away the moment under which it rests");
  const TubeType& tube = p.topology.type_of(0);
  double moment_of_area = 0;  // S
  for (int t = 0; t < tubes; ++t) {
    const auto first = static_cast<std::size_t>(p.topology.tube_begin[t]);
    moment_of_area += std::pow(p.state.position.x[first], 2) + std::pow(p.state.position.y[first], 2);
  }
  const double modulus = 2 / std::sqrt(3.0) * pair_stiffness(*p.interaction.law, tube.element_length);
  const double disc2 = tubes * std::sqrt(3.0) / 2 * p.spacing * p.spacing / units::pi;
  const double crowding = 9 * units::pi * modulus * std::pow(disc2, 3) / 384;
  const double moment = load.hand() * load.of_each(tubes);
  return {moment / (tube.bond.bend + 2 * crowding / moment_of_area), moment / tube.bond.bend};
}

}  // namespace ropewalk
