#include "scene/kinds/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scene/bounds.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

// Thicker films are no films, and laying them takes a time that grows with the square of the tubes.
constexpr double max_coverage = 50;  // areas of the box, by what the tubes cover one by one

void check_film(const TomlTable& t, const Scene& scene, FilmSource& film) {
  const double elements = std::round(film.length / scene.element_length);
  const double length = elements * scene.element_length;
  if (elements < 2)
    throw t.error("length_nm", fmt::format("is {} nm, {} elements", film.length, elements),
                  fmt::format("at least 2 elements, {:.4g} nm, are needed", 2 * scene.element_length));
  check_size(t, "tubes", film.tubes, elements);
  const char* shorter = film.width < film.depth ? "width_nm" : "depth_nm";
  const double side = std::min(film.width, film.depth);
  if (side < length)
    throw t.error(shorter, fmt::format("is {} nm, and the tubes are {:.6g} nm long", side, length),
                  "take a box that holds a tube at any angle, or shorter tubes");
  const double diameter = 2 * largest_radius(scene);
  const double covered = film.tubes * length * diameter / (film.width * film.depth);
  if (covered > max_coverage)
    throw t.error("tubes", fmt::format("covers the box {:.3g} times", covered),
                  fmt::format("at most {} times makes a film; take a larger box or fewer tubes", max_coverage));
}

// Squares of the box with the tubes that pass through them. A tube is known by points along it, at most `step`
// apart: tubes closer than the spacing have points within spacing + step, hence in squares of that width that
// touch.
class Floor {
 public:
  Floor(const FilmSource& film, double length, double spacing, double step)
      : length_(length),
        points_(static_cast<int>(std::ceil(length / step)) + 1),
        width_(spacing + step),
        left_(-0.5 * film.width),
        front_(-0.5 * film.depth),
        columns_(static_cast<int>(film.width / width_) + 3),
        rows_(static_cast<int>(film.depth / width_) + 3),
        tubes_in_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

  void add(int tube, const FilmTube& t) {
    each_point(t, [&](int column, int row) {
      std::vector<int>& here = tubes_in_[flat(column, row)];
      if (here.empty() || here.back() != tube) here.push_back(tube);
    });
    seen_.push_back(-1);
  }
  // The tubes that may be closer than the spacing in projection, each once. `number` tells this call from others.
  void near(const FilmTube& t, int number, std::vector<int>& out) {
    out.clear();
    int last_column = -1, last_row = -1;
    each_point(t, [&](int column, int row) {
      if (column == last_column && row == last_row) return;
      last_column = column, last_row = row;
      for (int c = column - 1; c <= column + 1; ++c)
        for (int r = row - 1; r <= row + 1; ++r)
          for (const int tube : tubes_in_[flat(c, r)]) {
            int& seen = seen_[static_cast<std::size_t>(tube)];
            if (seen != number) out.push_back(tube);
            seen = number;
          }
    });
  }

 private:
  // One square more than needed on each side, so that every square has neighbours.
  template <class F>
  void each_point(const FilmTube& t, F f) const {
    const double x = length_ * std::cos(t.angle), y = length_ * std::sin(t.angle);
    for (int k = 0; k < points_; ++k) {
      const double part = static_cast<double>(k) / (points_ - 1) - 0.5;
      f(square(t.x + part * x - left_, columns_), square(t.y + part * y - front_, rows_));
    }
  }
  int square(double along, int count) const {
    return std::min(std::max(static_cast<int>(std::floor(along / width_)) + 1, 1), count - 2);
  }
  std::size_t flat(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  double length_;
  int points_;
  double width_, left_, front_;
  int columns_, rows_;
  std::vector<std::vector<int>> tubes_in_;
  std::vector<int> seen_;  // the call that met each tube last
};

// Heights that another tube bars.
struct Barred {
  double from = 0, to = 0;
};

double lowest_free(const FilmTube& tube, const std::vector<FilmTube>& others, double length, double spacing) {
  std::vector<Barred> barred;
  for (const FilmTube& other : others) {
    const double room = spacing * spacing - projected_distance2(tube, other, length);
    if (room > 0) barred.push_back({other.z - std::sqrt(room), other.z + std::sqrt(room)});
  }
  std::sort(barred.begin(), barred.end(), [](const Barred& a, const Barred& b) { return a.from < b.from; });
  double height = 0;
  for (const Barred& b : barred) {
    if (b.from >= height) break;
    height = std::max(height, b.to);
  }
  return height;
}

// Any angle is as likely as another, and so is any place at which both ends are in the box.
FilmTube random_tube(const FilmSource& film, double length, Random& random) {
  FilmTube t;
  t.angle = random.uniform(0, units::pi);
  const double x = 0.5 * (film.width - length * std::fabs(std::cos(t.angle)));
  const double y = 0.5 * (film.depth - length * std::sin(t.angle));
  t.x = random.uniform(-x, x);
  t.y = random.uniform(-y, y);
  return t;
}

// Number of a tube's square along the Z-order curve (G. M. Morton, 1966): squares with near numbers are near each
// other, so that the neighbours of a tube are near it in memory, however large the film is.
std::uint64_t along_curve(const FilmTube& t, const FilmSource& film, double square) {
  const auto column = static_cast<std::uint64_t>((t.x + 0.5 * film.width) / square);
  const auto row = static_cast<std::uint64_t>((t.y + 0.5 * film.depth) / square);
  std::uint64_t number = 0;
  for (int bit = 0; bit < 32; ++bit) number |= (column >> bit & 1) << (2 * bit) | (row >> bit & 1) << (2 * bit + 1);
  return number;
}

}  // namespace

std::vector<FilmTube> lay_film(const FilmSource& film, int elements, double element_length, double spacing,
                               Random& random) {
  const double length = elements * element_length;
  Floor floor(film, length, spacing, element_length);
  std::vector<FilmTube> tubes, below;
  std::vector<int> near;
  for (int t = 0; t < film.tubes; ++t) {
    FilmTube tube = random_tube(film, length, random);
    floor.near(tube, t, near);
    below.clear();
    for (const int other : near) below.push_back(tubes[static_cast<std::size_t>(other)]);
    if (film.laid == FilmSource::Laid::resting)
      let_down(tube, below, length, spacing);
    else
      tube.z = lowest_free(tube, below, length, spacing);
    floor.add(t, tube);
    tubes.push_back(tube);
  }
  return tubes;
}

void put_tubes(const std::vector<FilmTube>& tubes, int elements, double element_length, Topology& topology,
               State& state) {
  for (std::size_t t = 0; t < tubes.size(); ++t) topology.add_tube(elements);
  state = State(static_cast<std::size_t>(topology.elements()));
  std::size_t i = 0;
  for (const FilmTube& t : tubes) {
    const Vector3 axis = t.axis();
    const double x = std::cos(t.angle), y = std::sin(t.angle);
    const double w = std::sqrt(0.5 * (1 + axis.z())), turned = std::sqrt(0.5 * (1 - axis.z()));
    for (int e = 0; e < elements; ++e, ++i) {
      const double s = (e - 0.5 * (elements - 1)) * element_length;
      state.position.set(i, t.middle() + s * axis);
      state.orientation.set(i,
                            Quaternion(w, -turned * y, turned * x, 0));  // rotation from z to the tube's direction
    }
  }
}

SceneKind film_kind() {
  using Key = KeyOf<FilmSource>;
  return scene_kind<FilmSource>(
      {"film",
       "instead of [rope]: straight tubes at random in a box, flat in x and y, laid one upon another",
       {Key::integer("tubes", 1, max_elements, &FilmSource::tubes, required("100"), "number of tubes"),
        Key::number("length_nm", unit::nm, Bounds::positive(1e6), &FilmSource::length, required("68.9"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("width_nm", unit::nm, Bounds::positive(1e6), &FilmSource::width, required("150"),
                    "side of the box in x, not shorter than the tubes"),
        Key::number("depth_nm", unit::nm, Bounds::positive(1e6), &FilmSource::depth, required("100"),
                    "side of the box in y, not shorter than the tubes"),
        Key::number("spacing_nm", unit::nm, spacing_bounds, &FilmSource::spacing,
                    otherwise("1.7", "where two crossed tubes bind best"),
                    "no two tube axes are closer at the start"),
        Key::word(
            "laid",
            Words<FilmSource::Laid>{{"level", FilmSource::Laid::level}, {"resting", FilmSource::Laid::resting}},
            &FilmSource::laid, standard(),
            "\"level\": flat, at the lowest free height; \"resting\": tilted, on the two tubes below that "
            "hold it up on either side of its middle, or on the plane")},
       check_film});
}

Source::Sizes FilmSource::sizes(double element_length) const {
  return {tubes, whole_elements(length, element_length)};
}

void FilmSource::place(const Scene& scene, double, Random& random, Topology& topology, State& state) const {
  const int elements = sizes(scene.element_length).elements;
  const double a = scene.element_length;
  std::vector<FilmTube> laid = lay_film(*this, elements, a, spacing > 0 ? spacing : crossed_spacing(scene), random);
  const double square = 0.5 * elements * a;
  std::stable_sort(laid.begin(), laid.end(), [&](const FilmTube& one, const FilmTube& other) {
    return along_curve(one, *this, square) < along_curve(other, *this, square);
  });
  put_tubes(laid, elements, a, topology, state);
}

std::string FilmSource::description(const Topology& topology, const State& state, double) const {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (int i = 0; i < topology.elements(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double half =
        0.5 * topology.type_of_element(i).element_length * std::fabs(axis_of(state.orientation[k]).z());
    lowest = std::min(lowest, state.position.z[k] - half);
    highest = std::max(highest, state.position.z[k] + half);
  }
  return fmt::format("a film of {:.4g} nm between its lowest and highest axis", highest - lowest);
}

}  // namespace ropewalk
