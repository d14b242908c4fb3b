#include "run/pages/run_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "report/page.hpp"

namespace ropewalk {

std::vector<double> frame_times(const RunDirectory& dir, const Topology& topology) {
  std::vector<double> times;
  StoredFrame frame;
  for (const auto reader = open_frames(dir.frames()); reader->next(topology, frame);)
    times.push_back(frame.state.time);
  if (times.empty())
    throw InputError({dir.frames(), 0, ""}, "holds no frame", "run the scene further with `ropewalk resume`");
  return times;
}

std::vector<StoredFrame> frames_of(const RunDirectory& dir, const Topology& topology,
                                   const std::vector<std::size_t>& wanted) {
  std::vector<StoredFrame> out(wanted.size());
  const auto reader = open_frames(dir.frames());
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    reader->seek(wanted[w]);
    reader->next(topology, out[w]);
  }
  return out;
}

std::vector<StoredFrame> frames_at(const RunDirectory& dir, const Topology& topology, std::vector<double> times,
                                   std::size_t usual) {
  const std::vector<double> stored = frame_times(dir, topology);
  if (times.empty())
    for (const std::size_t k : evenly(stored.size(), usual)) times.push_back(stored[k]);
  std::vector<std::size_t> wanted;
  const double apart =
      stored.size() > 1 ? (stored.back() - stored.front()) / static_cast<double>(stored.size() - 1) : 0;
  for (const double time : times) {
    const auto at = std::min_element(stored.begin(), stored.end(),
                                     [&](double a, double b) { return std::fabs(a - time) < std::fabs(b - time); });
    if (std::fabs(*at - time) > 1.01 * apart + 1e-6)
      throw InputError({"", 0, "--at"},
                       fmt::format("no frame is near {} ps: they are from {:.4g} to {:.4g} ps", time,
                                   stored.front(), stored.back()),
                       "choose times of the run");
    wanted.push_back(static_cast<std::size_t>(at - stored.begin()));
  }
  return frames_of(dir, topology, wanted);
}

RopeCamera camera_from(const std::string& from, const std::vector<RopeView>& views, double radius, double width,
                       double height) {
  if (from == "side") return rope_camera(views, radius, width, height);
  if (from == "x") return rope_camera(views, radius, Vector3::UnitX(), width, height);
  if (from == "y") return rope_camera(views, radius, Vector3::UnitY(), width, height);
  if (from == "z" || from == "end") return rope_camera(views, radius, Vector3::UnitZ(), width, height);
  const std::size_t comma = std::min(from.find(','), from.size());
  std::size_t read = 0, read_behind = 0;
  const std::string_view behind = std::string_view(from).substr(std::min(comma + 1, from.size()));
  const auto azimuth = leading_number(from, &read), elevation = leading_number(behind, &read_behind);
  if (!azimuth || !elevation || read != comma || read_behind != behind.size())
    throw InputError({"", 0, "--from"}, fmt::format("there is no side \"{}\"", from),
                     "take side, x, y, z, or two angles in degrees: 30,20");
  const double a = *azimuth * units::degree, e = *elevation * units::degree;
  return rope_camera(views, radius, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, width,
                     height);
}

}  // namespace ropewalk
