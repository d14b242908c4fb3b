#include "run/results.hpp"

#include <filesystem>

#include "run/events_file.hpp"
#include "scene/watch.hpp"

namespace ropewalk {

std::vector<LimitRecord> limits_of(const RunDirectory& dir) {
  return std::filesystem::exists(dir.limits()) ? read_limits(dir.limits()).limits : std::vector<LimitRecord>();
}

RunResults results_of(const RunDirectory& dir) {
  return run_results(read_log(dir.log()), limits_of(dir), tube_breaks(dir.events()));
}

RunResults results_of(const RunDirectory& dir, const Prepared& p) {
  RunResults r = results_of(dir);
  TubeBreak& first = r.first_break;
  if (r.tubes_broken > 0 && first.tube < p.topology.tubes() && first.element < p.topology.length_of(first.tube))
    first.held_by = holder_in_words(p.topology, held_by(p.loads, p.topology),
                                    p.topology.tube_begin[static_cast<std::size_t>(first.tube)] + first.element);
  return r;
}

}  // namespace ropewalk
