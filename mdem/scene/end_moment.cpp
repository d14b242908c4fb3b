#include "scene/end_moment.hpp"

#include <fmt/format.h>

#include "model/error.hpp"
#include "observe/bending.hpp"
#include "scene/scene_place.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

void refuse_end_moment(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads,
                       const char* key) {
  const std::optional<EndMoment> load = end_moment(end_drives(loads, topology));
  if (!load || load->by == LoadEffect::By::tangential || load->by == LoadEffect::By::body) return;
  const double moment = load->of_each(topology.strands());
  const TubeType& t = topology.type_of(0);
  const double slip = t.bond.twist / t.element_length, most = largest_torque(t.bond, t.element_length);
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw InputError(place_in(scene, key),
                     fmt::format("{:.4g} nN nm{} are more than {}", load->largest() / units::nN_nm,
                                 load->per_tube ? "" : " in total", what),
                     remedy);
  };
  if (moment > slip)
    refuse(fmt::format("{}a bond of {:.4g} nm bears before it slips, GJ/a = {:.4g}",
                       load->per_tube ? "" : fmt::format("the {} tubes bear: of each, ", topology.strands()),
                       t.element_length, slip / units::nN_nm),
           "lower the moment or take shorter elements");
  if (topology.tubes() == 1 && moment > most)
    refuse(fmt::format("the tube bears, {:.4g}: its wall collapses", most / units::nN_nm), "lower the moment");
}

}  // namespace ropewalk
