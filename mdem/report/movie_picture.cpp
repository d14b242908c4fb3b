#include "report/movie_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ropewalk {
namespace {

constexpr double edge = 20, head_height = 40, foot_height = 44;  // pixels

double highest(const RopeView& view, const Vector3& up) {
  double high = -std::numeric_limits<double>::infinity();
  for (const auto& tube : view.tubes)
    for (const Vector3& p : tube)
      if (p.allFinite()) high = std::max(high, p.dot(up));
  return high;
}

int even(double v) { return 2 * static_cast<int>(std::ceil(0.5 * v)); }

}  // namespace

MovieStage movie_stage(const std::vector<RopeView>& views, const RopeCamera& camera, double tube_radius,
                       int width) {
  MovieStage out{camera, tube_radius, 0, 0, even(width), 0};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const RopeView& v : views) {
    high = std::max(high, highest(v, camera.up));
    low = std::min(low, -highest(v, -camera.up));
  }
  if (low <= high) out.low = low - 1.5 * tube_radius, out.high = high + 1.5 * tube_radius;
  out.height = even(head_height + (out.high - out.low) * camera.scale + foot_height);
  return out;
}

std::string movie_picture(const RopeView& view, const MovieStage& stage, const std::string& when) {
  const RopeCamera& c = stage.camera;
  const double left = 0.5 * (stage.width - c.width * c.scale);
  // The picture begins at the highest point of its own rope.
  const double top = head_height + (stage.high - highest(view, c.up) - 1.5 * stage.tube_radius) * c.scale;
  std::string body = fmt::format("<text x=\"{}\" y=\"26\" font-size=\"17\">{}</text>\n", edge, escape_markup(when));
  body += fmt::format("<svg x=\"{:.1f}\" y=\"{:.1f}\"", left, std::isfinite(top) ? top : head_height) +
          rope_picture(view, c, stage.tube_radius, "m", false).substr(4);
  const double bar = scale_bar_length(c), y = stage.height - 0.5 * foot_height;
  body += fmt::format(
      "<path d=\"M{0} {1:.1f}h{2:.1f}\" stroke=\"var(--ink)\" stroke-width=\"3\"/><text x=\"{3:.1f}\" "
      "y=\"{4:.1f}\" "
      "fill=\"var(--ink)\">{5:g} nm</text>\n",
      edge, y, bar * c.scale, edge + bar * c.scale + 8, y + 4, bar);
  if (c.coloured())
    body += fmt::format("<svg x=\"{:.1f}\" y=\"{:.1f}\"", stage.width - 440.0, y - 10) + colour_bar(c).substr(4);
  return svg_file(body, stage.width, stage.height);
}

}  // namespace ropewalk
