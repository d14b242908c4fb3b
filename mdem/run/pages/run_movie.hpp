// A movie of a run: our own pictures of the frames, joined by ffmpeg.
#pragma once

#include <string>

#include "run/run_directory.hpp"

namespace ropewalk {

struct MovieOptions {
  std::string file;           // .webm or .mp4
  std::string from = "side";  // see camera_from()
  std::string colour;         // a word of colour_words(); empty: bending moment where frames have it
  int frames = 100;           // at most
  double fps = 15;
  int width = 1280;    // pixels
  bool force = false;  // replace the file
};
struct MovieSize {
  std::size_t frames = 0, stored = 0;
};
// Throws InputError, also where rsvg-convert or ffmpeg is missing.
MovieSize make_movie(const RunDirectory& dir, const MovieOptions& options);

}  // namespace ropewalk
