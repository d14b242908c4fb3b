#include "run/refined_run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "run/stages.hpp"
#include "scene/finer.hpp"

namespace ropewalk {
namespace {

RefinementRecord record_of(const RunParts& coarse, const RunParts& fine) {
  RefinementRecord r;
  r.from = stage_of(coarse.files.directory());
  r.to = stage_of(fine.files.directory());
  r.time_ps = fine.state().time;
  r.step_before = coarse.state().step;
  r.step_after = fine.state().step;
  r.length_before = coarse.moving.scene.element_length;
  r.length_after = fine.moving.scene.element_length;
  r.elements_before = coarse.moving.prepared.topology.elements();
  r.elements_after = fine.moving.prepared.topology.elements();
  r.before = coarse.moving.energies();
  r.after = fine.moving.energies();
  return r;
}

// Shorter elements have cured some of the limits.
LimitsFile limits_left(const LimitGuard& coarse) {
  LimitsFile limits = coarse.file();
  for (std::size_t k = 0; k < limits.limits.size(); ++k)
    if (limit_kinds()[k].cured_by_finer) limits.limits[k] = {};
  return limits;
}

}  // namespace

RefinementRecord go_on_finer(const RunParts& coarse, RunParts& fine) {
  const MovingScene& from = coarse.moving;
  MovingScene& to = fine.moving;
  Prepared at = to.prepared;
  const Splitting how = splitting_of(from.scene);
  at.state = halved(from.prepared.topology, from.state(), how);
  if (!to.relaxes()) {
    at.state.step = std::llround(at.state.time / to.prepared.time_step);
    if (!coarse.schedule.ends_with_the_scene())
      fine.schedule.end_at(-1, static_cast<double>(coarse.schedule.last_step()) * from.prepared.time_step);
  }
  to.simulation = start(to.scene, at);
  to.simulation.set_memory(from.simulation.halved_memory(heirs(from.prepared.topology, how)));
  to.simulation.inherit_from(to.simulation.forces().force, to.simulation.forces().torque,
                             from.simulation.account());
  to.simulation.set_gauges(to.observer.loading.ends, to.prepared.state);
  to.simulation.inherit_from(from.simulation.gauges().sums);
  fine.use_device();
  to.first_energy = from.first_energy + to.simulation.total_energy() - from.simulation.total_energy();
  fine.clock.earlier = coarse.clock.seconds();
  fine.limits.inherit(limits_left(coarse.limits), at.state.step);
  const RefinementRecord record = record_of(coarse, fine);
  fine.limits.add(record);
  return record;
}

std::string refinement_words(const RefinementRecord& r, const RunDirectory& to) {
  const Energies &b = r.before.potential, &a = r.after.potential;
  return fmt::format(
      "refined at {:.4g} ps: {} elements of {:.4g} nm became {} of {:.4g} nm; energy {:.6g} -> {:.6g} eV (bonds "
      "{:+.3g}, contact {:+.3g}, kinetic {:+.3g}); it goes on in {}",
      r.time_ps, r.elements_before, r.length_before, r.elements_after, r.length_after, r.before.total(),
      r.after.total(), a.bonds() - b.bonds(), a.vdw - b.vdw, r.after.kinetic - r.before.kinetic, to.path);
}

}  // namespace ropewalk
