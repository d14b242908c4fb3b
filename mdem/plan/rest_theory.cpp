#include "plan/rest_theory.hpp"

#include <cmath>

#include "model/error.hpp"
#include "scene/scene_place.hpp"
#include "sim/dynamics/end_drives.hpp"

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
  throw InputError(place_in(scene, key), why,
                   "take a [rope] of 7 tubes or more with a couple on each tube at both ends, which are free "
                   "otherwise, as [twist] "
                   "of `ropewalk new --kind spindle` has it");
}

}  // namespace

RestTheory rest_theory(const Scene& scene, const Prepared& p) {
  const EndDrives drives = end_drives(p.loads, p.topology);
  const std::optional<EndMoment> load = end_moment(drives);
  const EndFreedom ends = end_freedom(drives);
  const int tubes = p.topology.tubes();
  if (!scene.source->is_parallel() || tubes < 7) refuse(scene, scene.kind.c_str(), "is no rope of straight tubes");
  if (scene.sets.size() > 1) refuse(scene, "parameters", "are of more than one type of tubes");
  if (!load) refuse(scene, "twist", "is missing");
  if (!p.interaction.law) refuse(scene, "contact.law", "is \"none\"");
  if (load->by == LoadEffect::By::tangential)
    refuse(scene, "twist.application", "is \"tangential\": no couple winds the tubes");
  if (load->by == LoadEffect::By::body)
    refuse(scene, "grip", "turns the tubes of an end as one body: no couple winds them");
  if (!load->balanced || !load->on_all) refuse(scene, "", "its ends have no opposite couples on all tubes");
  if (ends.otherwise_driven || !ends.tilts || ends.sideways == EndFreedom::Sideways::held || !ends.one_element)
    refuse(scene, "", "its ends are held or driven by more than couples");
  if (load->relaxes_spins) refuse(scene, "twist.geometric_only", "takes the twist of the tubes away, which this theory does not know");
  if (!load->course.stays()) refuse(scene, "", "its ends lose the moment under which it rests");
  const TubeType& tube = p.topology.type_of(0);
  double moment_of_area = 0;  // S
  for (int t = 0; t < tubes; ++t) {
    const auto first = static_cast<std::size_t>(p.topology.tube_begin[t]);
    moment_of_area += std::pow(p.state.position.x[first], 2) + std::pow(p.state.position.y[first], 2);
  }
  const double modulus = 2 / std::sqrt(3.0) * pair_stiffness(*p.interaction.law, tube.element_length);
  const double disc2 = tubes * std::sqrt(3.0) / 2 * p.spacing * p.spacing / units::pi;
  const double crowding = 9 * units::pi * modulus * std::pow(disc2, 3) / 384;
  const double moment = load->hand() * load->of_each(tubes);
  return {moment / (tube.bond.bend + 2 * crowding / moment_of_area), moment / tube.bond.bend};
}

}  // namespace ropewalk
