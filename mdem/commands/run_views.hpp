// Pictures of the frames of a run.
#pragma once

#include <optional>
#include <vector>

#include "io/frames.hpp"
#include "report/svg.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

RopeView view_of(const Topology& topology, const DumpFrame& frame, double beta_deg);
// Of the last frame; none where there is no frame.
std::optional<RopeView> last_view(const RunDirectory& dir, const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
