// The input of the page in space, from a run.
#pragma once

#include "report/view/view_page.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

// Takes at most `frames` frames, evenly over the run. Throws InputError where there are none.
ViewInput view_input(const RunDirectory& dir, const Scene& scene, const Prepared& prepared,
                     std::size_t most_frames);

}  // namespace ropewalk
