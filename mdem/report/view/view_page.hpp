// The page that shows a run in three dimensions: one HTML file with the frames, our scripts and three.js. It
// asks for no other file and no network.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "report/svg.hpp"

namespace ropewalk {

// A quantity to colour by that every element has in every frame.
struct ViewField {
  std::string name, unit, meaning;
  bool is_signed = false;                   // zero is the middle of its colours
  std::vector<std::vector<double>> values;  // values of each frame, of each element
  std::vector<double> log_total;            // for each frame the sum in log.csv; NaN: it has none
};

// A whole number that every tube has.
struct ViewTubeNumber {
  std::string name, meaning;
  std::vector<int> values;
};

// A link between two elements, as long as it holds.
struct ViewLink {
  int a = 0, b = 0;              // joints where the elements begin
  double formed = 0, broke = 0;  // ps; broke: infinity, it holds at the end
};

// A limit of the model that an element passed.
struct ViewMark {
  std::string limit, held_by;  // key of the limit; "the upper clamp" where something holds the place
  double time_ps = 0;          // time from which the limit is passed
  int element = 0;             // element, counted over all tubes
};

struct ViewInput {
  std::string name;
  std::vector<int> tube_begin;  // as of a Topology
  // For each tube: the tube of the scene that it is a piece of, and where in it the piece begins. Both from 0.
  std::vector<std::array<int, 2>> piece_of;
  std::vector<double> tube_radius;  // radius of each tube, nm
  // One entry a frame, in the order of time. Element e of tube t reaches from joint e + t to joint e + t + 1.
  std::vector<double> time_ps;
  std::vector<std::int64_t> step;
  std::vector<std::vector<Vector3>> joints;
  std::vector<ViewField> fields;
  std::vector<ViewTubeNumber> tube_numbers;
  std::vector<ViewLink> links;
  std::vector<ViewMark> marks;
  RopeCamera camera;              // the side from which the page looks first
  std::size_t stored_frames = 0;  // frames of the run, of which some were chosen
};

struct ViewPage {
  std::string html;
  std::size_t frames = 0;    // fewer than those given where these take too much room
  double position_step = 0;  // nm: positions are whole multiples
  int levels = 0;            // numbers are whole multiples of their range over this
};

// False where three.js was not there when this program was built.
bool can_make_view();

// Numbers are rounded more coarsely, down to a thousandth of their range, and then frames left out until the page
// is not longer than this; with less than two frames it stays as it is.
ViewPage view_page(const ViewInput& input, std::size_t max_bytes);

}  // namespace ropewalk
