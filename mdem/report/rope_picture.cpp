// Side views of ropes: tubes as strokes, painted from the back to the front.
//
// A tube is cut into pieces of one depth layer and one colour each. Layers are so thin that tubes in contact which
// overlap on the page lie in different layers. So the order within a layer does not matter, and all its pieces of
// one colour form one path. The picture of a rope of 91 tubes stays below 60 kB, because a coarse depth buffer
// removes hidden pieces, coordinates are integers, and SVG moves are relative.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "report/svg.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t max_bytes_in_page = 60000, max_bytes_of_file = 250000;
constexpr int rope_colours = 12;
constexpr double reach = 1.28;           // half the stroke behind a tube, radii: closes the gap to its neighbour
constexpr double layer_thickness = 1.2;  // radii
constexpr double overlap = 0.25;         // overlap of two pieces of a tube, radii
constexpr double per_nm = 100;           // coordinates are whole hundredths of a nanometre

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return !(low <= high); }
  double size() const { return empty() ? 0 : high - low; }
};

struct Seen {
  double x, y, depth;  // nm: right, up, towards the reader
};

// Pieces of tubes as the camera sees them.
struct Segment {
  Seen a, b;
  std::size_t element;  // where a is
  double value;         // that it is coloured by
  bool visible;
  int size = 0;  // size of the tube, an index of sizes_of()
};
using SeenTube = std::vector<Segment>;

// The radii of the tubes, each once, rising.
std::vector<double> sizes_of(const RopeView& view, double radius) {
  if (view.radii.empty()) return {radius};
  std::vector<double> sizes = view.radii;
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  return sizes;
}

Seen see(const RopeCamera& c, const Vector3& p) { return {p.dot(c.right), p.dot(c.up), p.dot(c.towards)}; }

double mean_value(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = begin; i <= end && i < values.size(); ++i)
    if (std::isfinite(values[i])) sum += values[i], ++n;
  return n > 0 ? sum / static_cast<double>(n) : 0;
}

// How coarsely a picture is drawn to keep it small.
struct Detail {
  std::size_t stride;  // points from one drawn point to the next
  std::size_t block;   // segments that share one colour
};
constexpr Detail details[] = {{1, 1}, {1, 2}, {1, 3}, {1, 4},  {1, 6},  {2, 4}, {3, 4},
                              {4, 4}, {6, 4}, {9, 4}, {14, 4}, {30, 4}, {80, 4}};

std::vector<SeenTube> seen_tubes(const RopeView& view, const std::vector<double>& sizes, const RopeCamera& camera,
                                 std::size_t stride) {
  std::vector<SeenTube> tubes;
  for (const std::vector<Vector3>& points : view.tubes) {
    SeenTube tube;
    int size = 0;
    if (tubes.size() < view.radii.size())
      size =
          static_cast<int>(std::lower_bound(sizes.begin(), sizes.end(), view.radii[tubes.size()]) - sizes.begin());
    for (std::size_t i = 0; i + 1 < points.size(); i += stride) {
      const std::size_t j = std::min(i + stride, points.size() - 1);
      if (!points[i].allFinite() || !points[j].allFinite()) continue;
      tube.push_back({see(camera, points[i]), see(camera, points[j]), i, 0, false, size});
    }
    tubes.push_back(std::move(tube));
  }
  return tubes;
}

// Every segment gets the mean of its block of elements.
void set_values(std::vector<SeenTube>& tubes, const RopeView& view, std::size_t block) {
  for (std::size_t t = 0; t < std::min(tubes.size(), view.colour.size()); ++t)
    for (Segment& s : tubes[t]) {
      const std::size_t begin = s.element / block * block;
      s.value = mean_value(view.colour[t], begin, begin + block);
    }
}

// --- What is hidden ---------------------------------------------------------------------------------------

class DepthBuffer {
 public:
  DepthBuffer(const std::vector<SeenTube>& tubes, const std::vector<double>& sizes)
      : sizes_(sizes), radius_(reach * sizes.back()) {
    for (double& size : sizes_) size *= reach;
    Extent x, y;
    for (const SeenTube& tube : tubes)
      for (const Segment& s : tube)
        for (const Seen& p : {s.a, s.b}) x.take(p.x), y.take(p.y);
    if (x.empty()) return;
    x0_ = x.low - radius_;
    y0_ = y.low - radius_;
    cell_ = std::max({sizes_.front() / 4, x.size() / 3000, y.size() / 3000});
    columns_ = 1 + static_cast<int>((x.size() + 2 * radius_) / cell_);
    rows_ = 1 + static_cast<int>((y.size() + 2 * radius_) / cell_);
    depth_.assign(static_cast<std::size_t>(columns_) * rows_, -std::numeric_limits<float>::infinity());
  }

  void add(const Segment& s) {
    each_cell(s, [&](float& cell, double depth) { cell = std::max(cell, static_cast<float>(depth)); });
  }
  bool shows(const Segment& s) {
    int cells = 0;
    each_cell(s, [&](float& cell, double depth) { cells += depth > cell - 0.2 * size_of(s); });
    return cells > 1;
  }

  // Whether no other tube is before the line between the axes of two tubes, at some place of it.
  bool shows_line(const Segment& s) const {
    constexpr int samples = 8;
    for (int k = 0; k <= samples; ++k) {
      const double at = static_cast<double>(k) / samples;
      const int c = static_cast<int>((s.a.x + at * (s.b.x - s.a.x) - x0_) / cell_),
                r = static_cast<int>((s.a.y + at * (s.b.y - s.a.y) - y0_) / cell_);
      if (c < 0 || c >= columns_ || r < 0 || r >= rows_) continue;
      const double own = s.a.depth + at * (s.b.depth - s.a.depth) + 1.1 * radius_;  // nearer than both of its tubes
      if (depth_[static_cast<std::size_t>(r) * columns_ + c] < own) return true;
    }
    return false;
  }

 private:
  // Enters the surface of the segment, a round cylinder, into every cell that it covers.
  template <class F>
  void each_cell(const Segment& s, const F& f) {
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, length2 = std::max(1e-12, dx * dx + dy * dy);
    const auto index = [&](double v, double origin) { return static_cast<int>((v - origin) / cell_); };
    const double radius = size_of(s);
    const int c0 = index(std::min(s.a.x, s.b.x) - radius, x0_), c1 = index(std::max(s.a.x, s.b.x) + radius, x0_);
    const int r0 = index(std::min(s.a.y, s.b.y) - radius, y0_), r1 = index(std::max(s.a.y, s.b.y) + radius, y0_);
    for (int r = std::max(0, r0); r <= std::min(rows_ - 1, r1); ++r)
      for (int c = std::max(0, c0); c <= std::min(columns_ - 1, c1); ++c) {
        const double px = x0_ + (c + 0.5) * cell_ - s.a.x, py = y0_ + (r + 0.5) * cell_ - s.a.y;
        const double along = std::min(1.0, std::max(0.0, (px * dx + py * dy) / length2));
        const double ox = px - along * dx, oy = py - along * dy;
        const double inside = radius * radius - ox * ox - oy * oy;
        if (inside > 0)
          f(depth_[static_cast<std::size_t>(r) * columns_ + c],
            s.a.depth + along * (s.b.depth - s.a.depth) + std::sqrt(inside));
      }
  }

  double size_of(const Segment& s) const { return sizes_[static_cast<std::size_t>(s.size)]; }

  std::vector<double> sizes_;  // half widths of the strokes that are drawn behind tubes, nm
  double radius_;              // the largest
  double x0_ = 0, y0_ = 0, cell_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<float> depth_;
};

DepthBuffer mark_visible(std::vector<SeenTube>& tubes, const std::vector<double>& sizes) {
  DepthBuffer buffer(tubes, sizes);
  for (const SeenTube& tube : tubes)
    for (const Segment& s : tube) buffer.add(s);
  for (SeenTube& tube : tubes)
    for (Segment& s : tube) s.visible = buffer.shows(s);
  return buffer;
}

// --- Pieces -----------------------------------------------------------------------------------------------

struct Spot {
  int x, y;
};

double distance_from_chord(const Spot& p, const Spot& a, const Spot& b) {
  const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const auto px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double length = std::hypot(dx, dy);
  return length > 0 ? std::abs(px * dy - py * dx) / length : std::hypot(px, py);
}

// The algorithm of Douglas and Peucker: removes points within the tolerance of the line through the others.
void simplify(const std::vector<Spot>& in, std::size_t first, std::size_t last, double tolerance,
              std::vector<Spot>& out) {
  double farthest = tolerance;
  std::size_t at = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double d = distance_from_chord(in[i], in[first], in[last]);
    if (d > farthest) farthest = d, at = i;
  }
  if (at == 0) {
    out.push_back(in[last]);
    return;
  }
  simplify(in, first, at, tolerance, out);
  simplify(in, at, last, tolerance, out);
}

void append_number(std::string& d, int v, bool separate) {
  if (separate && v >= 0) d += ' ';
  fmt::format_to(std::back_inserter(d), "{}", v);
}

std::string moves(const std::vector<Spot>& spots, double tolerance) {
  std::vector<Spot> s{spots.front()};
  simplify(spots, 0, spots.size() - 1, tolerance, s);
  std::string d = "M";
  append_number(d, s[0].x, false);
  append_number(d, s[0].y, true);
  d += 'l';
  for (std::size_t i = 1; i < s.size(); ++i) {
    append_number(d, s[i].x - s[i - 1].x, i > 1);
    append_number(d, s[i].y - s[i - 1].y, true);
  }
  return d;
}

struct Key {
  int layer, size, colour;
  bool operator<(const Key& o) const { return std::tie(layer, size, colour) < std::tie(o.layer, o.size, o.colour); }
};
using Paths = std::map<Key, std::string>;

struct Painter {
  const RopeCamera& camera;
  const std::vector<double>& sizes;  // nm
  double radius;                     // radius of the thickest tube of all views, nm
  double top;                        // nm: upper edge
  double tolerance;                  // hundredths of a nanometre

  int layer_of(double depth) const { return static_cast<int>(std::floor(depth / (layer_thickness * radius))); }
  Key key(const Segment& s) const {
    const int layer = layer_of(0.5 * (s.a.depth + s.b.depth));
    const double at = camera.coloured() ? (s.value - camera.least) / (camera.most - camera.least) : 0;
    return {layer, s.size, std::min(rope_colours - 1, static_cast<int>(std::clamp(at, 0.0, 1.0) * rope_colours))};
  }
  Spot spot(double x, double y) const {
    return {static_cast<int>(std::lround((x - camera.left) * per_nm)),
            static_cast<int>(std::lround((top - y) * per_nm))};
  }

  // Extends a piece a little beyond its ends and draws it from its far end to its near end; see paint_layer.
  void append(const SeenTube& tube, std::size_t begin, std::size_t end, Paths& paths) const {
    const auto beyond = [&](const Seen& p, const Seen& from) {
      const double length = std::hypot(p.x - from.x, p.y - from.y);
      const double k = length > 0 ? overlap * sizes[static_cast<std::size_t>(tube[begin].size)] / length : 0;
      return spot(p.x + k * (p.x - from.x), p.y + k * (p.y - from.y));
    };
    std::vector<Spot> spots{beyond(tube[begin].a, tube[begin].b)};
    for (std::size_t i = begin; i + 1 < end; ++i) spots.push_back(spot(tube[i].b.x, tube[i].b.y));
    spots.push_back(beyond(tube[end - 1].b, tube[end - 1].a));
    if (tube[begin].a.depth > tube[end - 1].b.depth) std::reverse(spots.begin(), spots.end());
    paths[key(tube[begin])] += moves(spots, tolerance);
  }

  void append(const SeenTube& tube, Paths& paths) const {
    // One more segment on either side of the visible ones.
    const auto drawn = [&](std::size_t i) {
      return tube[i].visible || (i > 0 && tube[i - 1].visible) || (i + 1 < tube.size() && tube[i + 1].visible);
    };
    for (std::size_t i = 0; i < tube.size();) {
      std::size_t end = i + 1;
      if (!drawn(i)) {
        i = end;
        continue;
      }
      const Key k = key(tube[i]);
      const auto same = [&](const Key& o) { return o.layer == k.layer && o.colour == k.colour; };
      while (end < tube.size() && drawn(end) && same(key(tube[end]))) ++end;
      append(tube, i, end, paths);
      i = end;
    }
  }
};

// The links that can be seen, by layer. Each is drawn from wall to wall and a little beyond. Two kinds of links are
// left out: those along the line of sight, and those that join, in a slice, an element to an image one period away.
std::map<int, std::string> link_paths(const RopeView& view, const Painter& painter, const DepthBuffer& buffer) {
  constexpr double inside = 0.2;  // of the way from axis to axis, at either end, that is not drawn
  const double r = painter.radius, longest = 4 * r + 1;
  std::map<int, std::string> paths;
  for (const auto& [a, b] : view.links) {
    if (!a.allFinite() || !b.allFinite() || (b - a).norm() > longest) continue;
    const Segment s{see(painter.camera, a + inside * (b - a)), see(painter.camera, b - inside * (b - a)), 0, 0,
                    true};
    if (std::hypot(s.b.x - s.a.x, s.b.y - s.a.y) < 0.4 * r || !buffer.shows_line(s)) continue;
    const Spot from = painter.spot(s.a.x, s.a.y), to = painter.spot(s.b.x, s.b.y);
    std::string& d = paths[painter.layer_of(std::max(s.a.depth, s.b.depth))];
    fmt::format_to(std::back_inserter(d), "M{} {}l{} {}", from.x, from.y, to.x - from.x, to.y - from.y);
  }
  return paths;
}

Extent vertical_extent(const RopeView& view, const RopeCamera& camera, double radius) {
  Extent y;
  for (const auto& tube : view.tubes)
    for (const Vector3& p : tube)
      if (p.allFinite()) y.take(p.dot(camera.up));
  if (y.empty()) return {0, 1};
  return {y.low - 1.5 * radius, y.high + 1.5 * radius};
}

// --- Paint ------------------------------------------------------------------------------------------------

struct Rgb {
  double r, g, b;
};

Rgb mix(const Rgb& a, const Rgb& b, double at) {
  return {a.r + at * (b.r - a.r), a.g + at * (b.g - a.g), a.b + at * (b.b - a.b)};
}

std::string hex(const Rgb& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(std::lround(c.r)), static_cast<int>(std::lround(c.g)),
                     static_cast<int>(std::lround(c.b)));
}

// Blue below zero, red above.
std::string rope_colour(const RopeColours& by, int colour) {
  const double at = (colour + 0.5) / rope_colours;
  if (!by.is_signed) return viridis(at);
  return hex(at < 0.5 ? mix({33, 102, 172}, {238, 240, 242}, 2 * at)
                      : mix({238, 240, 242}, {178, 24, 43}, 2 * at - 1));
}

std::string body_colour(const RopeCamera& camera, int colour, double depth) {  // depth 0: back, 1: front
  return camera.coloured() ? rope_colour(camera.coloured_by, colour)
                           : hex(mix({84, 106, 130}, {168, 194, 218}, depth));
}

using PathRange = std::pair<Paths::const_iterator, Paths::const_iterator>;

// The pieces of one layer and size: one path for each colour, all in one group.
std::string define_layer(const PathRange& paths, const std::string& id) {
  std::string text = fmt::format("<g id=\"{}\">", id);
  for (auto p = paths.first; p != paths.second; ++p)
    text += fmt::format("<path id=\"{}_{}\" d=\"{}\"/>", id, p->first.colour, p->second);
  return text + "</g>";
}

// Outline, body and highlight. The outline leaves out the beginning of every piece, where it would show as a seam
// on the piece behind. The opacity belongs to the group of highlights, so that overlaps of pieces do not show.
std::string paint_layer(const PathRange& paths, const std::string& id, double radius, const RopeCamera& camera,
                        double depth) {
  const auto width = [&](double radii) { return static_cast<int>(std::lround(radii * radius * per_nm)); };
  std::string text = fmt::format(
      "<use href=\"#{}\" stroke=\"#1d232b\" stroke-width=\"{}\" "
      "stroke-dasharray=\"999999\" stroke-dashoffset=\"-{}\"/><g stroke-width=\"{}\">",
      id, width(2 * reach), width(0.8 * overlap), width(1.85));
  for (auto p = paths.first; p != paths.second; ++p)
    text += fmt::format("<use href=\"#{}_{}\" stroke=\"{}\"/>", id, p->first.colour,
                        body_colour(camera, p->first.colour, depth));
  return text + fmt::format("</g><use href=\"#{}\" stroke=\"#fff\" stroke-width=\"{}\" opacity=\"{:.2f}\"/>\n", id,
                            width(0.65), camera.coloured() ? 0.22 : 0.15 + 0.25 * depth);
}

std::string paint_link(const std::string& path, double radius) {
  return fmt::format("<path d=\"{}\" stroke=\"#e0281e\" stroke-width=\"{}\" stroke-linecap=\"round\"/>\n", path,
                     static_cast<int>(std::lround(0.5 * radius * per_nm)));
}

// Links come after the layer of the nearer one of their tubes.
std::string paint(const Paths& paths, const std::map<int, std::string>& links, const std::string& name,
                  const std::vector<double>& sizes, double radius, const RopeCamera& camera) {
  if (paths.empty()) return "";
  auto link = links.begin();
  const int first = paths.begin()->first.layer, last = paths.rbegin()->first.layer;
  std::string definitions = "<defs>", layers;
  for (auto p = paths.begin(); p != paths.end();) {
    const auto [layer, size, colour] = p->first;
    const PathRange range = {p, paths.upper_bound({layer, size, rope_colours})};
    const std::string id = fmt::format("{}{}{}", name, layer - first, size > 0 ? fmt::format("s{}", size) : "");
    const double depth = last > first ? static_cast<double>(layer - first) / (last - first) : 1;
    definitions += define_layer(range, id);
    layers += paint_layer(range, id, sizes[static_cast<std::size_t>(size)], camera, depth);
    p = range.second;
    if (p != paths.end() && p->first.layer == layer) continue;
    for (; link != links.end() && link->first <= layer; ++link) layers += paint_link(link->second, radius);
  }
  for (; link != links.end(); ++link) layers += paint_link(link->second, radius);
  return definitions + "</defs>\n" + layers;
}

bool has_colours(const RopeView& view) {
  return std::any_of(view.colour.begin(), view.colour.end(), [](const auto& tube) { return !tube.empty(); });
}

std::string rope_body(const RopeView& view, const RopeCamera& camera, double radius, double top,
                      const std::string& name, std::size_t max_bytes) {
  std::string text;
  std::vector<SeenTube> tubes;
  std::optional<DepthBuffer> buffer;
  std::size_t stride = 0;
  RopeCamera used = camera;
  if (!has_colours(view)) used.least = used.most = 0;
  const std::vector<double> sizes = sizes_of(view, radius);
  // Draws ever more coarsely until the text is small enough. The text shrinks at most in proportion to the segments of
  // one colour, so details that are too fine by this measure are passed over. The first guess, half a byte for each
  // segment, allows for hidden ones.
  std::size_t points = 0;
  for (const auto& tube : view.tubes) points += tube.size();
  double least_bytes = 0.5 * static_cast<double>(points);
  for (const Detail& detail : details) {
    const auto segments = static_cast<double>(detail.stride * detail.block);
    const bool coarsest = &detail == std::end(details) - 1;
    if (least_bytes / segments > static_cast<double>(max_bytes) && !coarsest) continue;
    if (detail.stride != stride) {
      stride = detail.stride;
      tubes = seen_tubes(view, sizes, camera, stride);
      buffer = mark_visible(tubes, sizes);
    }
    if (used.coloured()) set_values(tubes, view, detail.stride * detail.block);
    const Painter painter{used, sizes, radius, top, 3.0 + static_cast<double>(stride)};
    Paths paths;
    for (const SeenTube& tube : tubes) painter.append(tube, paths);
    text = paint(paths, link_paths(view, painter, *buffer), name, sizes, radius, used);
    if (text.size() < max_bytes - 1000) break;
    least_bytes = std::max(least_bytes, static_cast<double>(text.size()) * segments);
  }
  return text;
}

std::string scale_bar_at(const RopeCamera& camera, double x, double y, const char* ink) {
  const double nm = scale_bar_length(camera);
  return fmt::format(
      "<path d=\"M{0:.1f} {1:.1f}h{2:.1f}\" stroke=\"{3}\" stroke-width=\"3\"/>"
      "<text x=\"{4:.1f}\" y=\"{5:.1f}\" fill=\"{3}\">{6:g} nm</text>\n",
      x, y, nm * camera.scale, ink, x + nm * camera.scale + 8, y + 4, nm);
}

// --- Camera -----------------------------------------------------------------------------------------------

std::vector<Vector3> mean_line(const RopeView& view) {
  std::vector<Vector3> line;
  if (view.tubes.empty()) return line;
  for (std::size_t i = 0; i < view.tubes[0].size(); ++i) {
    Vector3 sum = Vector3::Zero();
    for (const auto& tube : view.tubes)
      if (tube.size() == view.tubes[0].size())
        sum += tube[i];
      else
        return {};
    if (sum.allFinite()) line.push_back(sum / static_cast<double>(view.tubes.size()));
  }
  return line;
}

Vector3 chord_of(const RopeView& view) {
  Vector3 chord = Vector3::Zero();
  for (const auto& tube : view.tubes)
    if (tube.size() > 1 && tube.front().allFinite() && tube.back().allFinite()) chord += tube.back() - tube.front();
  return chord.norm() > 1e-9 ? chord.normalized() : Vector3::UnitZ();
}

// The direction normal to `right` in which the rope deviates most from its chord.
Vector3 deflection(const RopeView& view, const Vector3& right, double radius) {
  const std::vector<Vector3> line = mean_line(view);
  Vector3 mean = Vector3::Zero();
  for (const Vector3& p : line) mean += p / static_cast<double>(line.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3& p : line) {
    const Vector3 off = (p - mean) - (p - mean).dot(right) * right;
    spread += off * off.transpose() / static_cast<double>(line.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const bool bent = !line.empty() && solver.eigenvalues()[2] > radius * radius;
  Vector3 up = bent ? Vector3(solver.eigenvectors().col(2)) : Vector3(Vector3::UnitX());
  up -= up.dot(right) * right;
  if (up.norm() < 0.1) up = Vector3::UnitY() - right.y() * right;
  up.normalize();
  return up.x() + 1e-3 * up.y() < 0 ? Vector3(-up) : up;  // the sign of an eigenvector is arbitrary
}

// Rounds to a number that is easy to read.
double rounded_up(double v) {
  if (!(v > 0)) return 0;
  const double base = std::pow(10.0, std::floor(std::log10(v)));
  for (const double m : {1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (v <= m * base * (1 + 1e-9)) return m * base;
  return 10 * base;
}

// The scale leaves out the outermost values, or one kinked bond would make all others look alike.
void set_colours(const std::vector<RopeView>& views, RopeCamera& camera) {
  std::vector<double> all;
  for (const RopeView& view : views)
    for (const auto& tube : view.colour) {
      if (!tube.empty()) camera.coloured_by = view.coloured_by;
      for (const double v : tube)
        if (std::isfinite(v)) all.push_back(camera.coloured_by.is_signed ? std::abs(v) : v);
    }
  if (all.empty()) return;
  std::sort(all.begin(), all.end());
  const auto part = [&](double p) {
    return all[static_cast<std::size_t>(p * static_cast<double>(all.size() - 1))];
  };
  camera.most = rounded_up(part(0.995));
  camera.least = camera.coloured_by.is_signed ? -camera.most : 0;
  if (all.front() >= 0) return;
  const double low = part(0.005), high = part(0.995), range = high - low;
  if (!(range > 0)) return;
  const double step = std::pow(10.0, std::floor(std::log10(range))) / 5;
  camera.least = step * std::floor(low / step);
  camera.most = step * std::ceil(high / step);
}

}  // namespace

namespace {

// With its directions: left end, width, scale and colours.
RopeCamera framed(RopeCamera c, const std::vector<RopeView>& views, double radius, double widest, double highest) {
  Extent x;
  double height = 1e-3;
  for (const RopeView& view : views) {
    for (const auto& tube : view.tubes)
      for (const Vector3& p : tube)
        if (p.allFinite()) x.take(p.dot(c.right));
    height = std::max(height, vertical_extent(view, c, radius).size());
  }
  if (x.empty()) return c;
  c.left = x.low - 1.5 * radius;
  c.width = x.size() + 3 * radius;
  c.scale = std::min({widest / c.width, highest / height, 24.0});
  set_colours(views, c);
  return c;
}

}  // namespace

RopeCamera rope_camera(const std::vector<RopeView>& views, double radius, double widest, double highest) {
  RopeCamera c;
  if (views.empty()) return c;
  c.right = chord_of(views.front());
  c.up = deflection(views.back(), c.right, radius);
  c.towards = c.right.cross(c.up);
  return framed(c, views, radius, widest, highest);
}

RopeCamera rope_camera(const std::vector<RopeView>& views, double radius, const Vector3& towards, double widest,
                       double highest) {
  RopeCamera c;
  if (views.empty()) return c;
  c.towards = towards.normalized();
  const Vector3 chord = chord_of(views.front());
  const Vector3 across = chord - chord.dot(c.towards) * c.towards;
  c.right = across.norm() > 0.1 ? Vector3(across.normalized()) : c.towards.unitOrthogonal();
  c.up = c.towards.cross(c.right);
  return framed(c, views, radius, widest, highest);
}

double scale_bar_length(const RopeCamera& camera) {
  const double longest = std::max(1e-3, 0.2 * camera.width);
  const double base = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double m : {5.0, 2.0})
    if (m * base <= longest) return m * base;
  return base;
}

std::string rope_picture(const RopeView& view, const RopeCamera& camera, double radius, const std::string& name,
                         bool scale_bar) {
  const Extent y = vertical_extent(view, camera, radius);
  const double width = camera.width * camera.scale, height = y.size() * camera.scale;
  const double bar = scale_bar ? 24 : 0;
  std::string text = fmt::format(
      "<svg class=\"bar\" viewBox=\"0 0 {0:.1f} {1:.1f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "aria-label=\"Side view at {2} ps\">\n<g fill=\"none\" stroke-linejoin=\"round\" "
      "transform=\"scale({3:.5f})\">",
      width, height + bar, number_text(view.time_ps), camera.scale / per_nm);
  text += rope_body(view, camera, radius, y.high, name, max_bytes_in_page) + "</g>\n";
  if (scale_bar) text += scale_bar_at(camera, 1.5 * radius * camera.scale, height + 14, "var(--ink)");
  return text + "</svg>\n";
}

namespace {

// Colours, and the scale below them.
std::string bar_at(const RopeCamera& camera, double x, double y, const char* ink) {
  const double step = 18;
  std::string text;
  for (int k = 0; k < rope_colours; ++k)
    text += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"10\" fill=\"{}\"/>",
                        x + k * step, y, step + 0.3, rope_colour(camera.coloured_by, k));
  for (const int k : {0, 1, 2})
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"{}\">{}{}</text>",
                        x + 0.5 * k * rope_colours * step, y + 24, ink,
                        k == 2                       ? "≥ "
                        : k == 0 && camera.least < 0 ? "≤ "
                                                     : "",
                        number_text(camera.least + 0.5 * k * (camera.most - camera.least), 3));
  const RopeColours& by = camera.coloured_by;
  return text + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", x + rope_colours * step + 34,
                            y + 10, ink,
                            escape_markup(by.quantity + (by.unit.empty() ? "" : " (" + by.unit + ")")));
}

}  // namespace

std::string colour_bar(const RopeCamera& camera) {
  return fmt::format(
             "<svg class=\"bar\" viewBox=\"0 0 420 30\" width=\"420\" height=\"30\" role=\"img\" "
             "aria-label=\"Colours: {}\">",
             escape_markup(camera.coloured_by.quantity)) +
         bar_at(camera, 14, 2, "var(--ink)") + "</svg>\n";
}

std::string rope_svg(const RopeView& view, double radius, double width) {
  RopeCamera camera = rope_camera({view}, radius, width - 20, width);
  const Extent y = vertical_extent(view, camera, radius);
  const double rope = y.size() * camera.scale, height = rope + (camera.coloured() ? 62 : 44);
  const double left = 0.5 * (width - camera.width * camera.scale);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" "
      "font-family=\"Helvetica,Arial,sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#fff\"/>\n<g fill=\"none\" stroke-linejoin=\"round\" transform=\"translate({2:.1f} 10) "
      "scale({3:.5f})\">",
      width, height, left, camera.scale / per_nm);
  text += rope_body(view, camera, radius, y.high, "t", max_bytes_of_file) + "</g>\n";
  text += scale_bar_at(camera, left + 1.5 * radius * camera.scale, rope + 27, "#1c1e22");
  if (camera.coloured()) text += bar_at(camera, width - 400, rope + 22, "#1c1e22");
  return text + "</svg>\n";
}

// --- Cross-sections ---------------------------------------------------------------------------------------

namespace {

const char* section_class(const CrossSection& section, const RopeShells& shells, std::size_t tube) {
  if (tube >= shells.internal.size() || !shells.internal[tube] || tube >= section.neighbours.size())
    return "outermost";
  switch (section.neighbours[tube]) {
    case 5:
      return "n5";
    case 6:
      return "n6";
    case 7:
      return "n7";
    default:
      return "nx";
  }
}

}  // namespace

double section_half_width(const CrossSection& section, double radius) {
  double half = radius;
  for (const Eigen::Vector2d& p : section.points)
    if (p.allFinite()) half = std::max(half, p.cwiseAbs().maxCoeff() + radius);
  return half;
}

std::string section_picture(const CrossSection& section, const RopeShells& shells, double radius, double half_width,
                            double pixels) {
  const double scale = pixels / (2.04 * std::max(half_width, radius));
  std::string text = fmt::format(
      "<svg class=\"section\" viewBox=\"0 0 {0:.0f} {0:.0f}\" width=\"{0:.0f}\" "
      "height=\"{0:.0f}\" role=\"img\" aria-label=\"Cross-section, Q = {1}\">\n",
      pixels, section.charge);
  for (std::size_t t = 0; t < section.points.size(); ++t) {
    const Eigen::Vector2d& p = section.points[t];
    if (!p.allFinite()) continue;
    const std::string name = section_class(section, shells, t);
    const std::string circle = fmt::format("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\"", name,
                                           0.5 * pixels + scale * p.x(), 0.5 * pixels - scale * p.y(),
                                           scale * (t < section.radii.size() ? section.radii[t] : radius));
    // The number of neighbours is printed if it is not six.
    text += name == "n6" || name == "outermost" ? circle + "/>"
                                                : fmt::format("{}><title>tube {}: {} neighbours</title></circle>",
                                                              circle, t, section.neighbours[t]);
  }
  return text + "\n</svg>\n";
}

}  // namespace ropewalk
