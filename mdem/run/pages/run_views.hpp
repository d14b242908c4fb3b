// Frames of a run and pictures of them.
#pragma once

#include <optional>
#include <vector>

#include "io/frames/frames.hpp"
#include "report/svg.hpp"
#include "run/events_file.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

// Tubes that have broken are cut; with the links that hold at the time of the frame.
RopeView view_of(const StoredEvents& events, const StoredFrame& frame, double beta_deg);
// The view of the last frame; none where there is no frame.
std::optional<RopeView> last_view(const RunDirectory& dir, const Scene& scene, const Prepared& prepared);

// Several tubes of one length that are parallel at the start.
bool is_rope(const Prepared& prepared, const Observer& observer);

// The stored frames' times, ps. Throws InputError where there are none.
std::vector<double> frame_times(const RunDirectory& dir, const Topology& topology);
// The frames with these numbers, from 0.
std::vector<StoredFrame> frames_of(const RunDirectory& dir, const Topology& topology,
                                   const std::vector<std::size_t>& wanted);

// The frames nearest to these times, ps; without times, `usual` frames, evenly over the run. Throws InputError
// where no frame is near.
std::vector<StoredFrame> frames_at(const RunDirectory& dir, const Topology& topology, std::vector<double> times,
                                   std::size_t usual);

// The camera that --from names. side: as reports have it; x, y, z: along that axis; AZIMUTH,ELEVATION about z, in
// degrees.
RopeCamera camera_from(const std::string& from, const std::vector<RopeView>& views, double radius, double width,
                       double height);

}  // namespace ropewalk
