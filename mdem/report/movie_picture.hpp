// The pictures of a movie: all of one size, seen with one camera.
#pragma once

#include <string>
#include <vector>

#include "report/svg.hpp"

namespace ropewalk {

struct MovieStage {
  RopeCamera camera;
  double tube_radius = 0;     // nm
  double low = 0, high = 0;   // lowest and highest place of all pictures along camera.up, nm
  int width = 0, height = 0;  // pixels, even
};
// The stage that holds all views. The camera is theirs, for a picture of this width.
MovieStage movie_stage(const std::vector<RopeView>& views, const RopeCamera& camera, double tube_radius, int width);

// A complete SVG file. `when` stands above the rope.
std::string movie_picture(const RopeView& view, const MovieStage& stage, const std::string& when);

}  // namespace ropewalk
