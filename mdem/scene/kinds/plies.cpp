#include "scene/kinds/plies.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/bounds.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

constexpr int most_ropes = 6;  // around a hole that is not wider than a rope

// The place of a tube in the cross-section of its rope.
struct Fibre {
  double x = 0, y = 0;
};

std::vector<Fibre> fibres_of(const PliesSource& plies, double spacing) {
  std::vector<Fibre> out;
  for (const auto& [x, y] : plies.rope.places(spacing)) out.push_back({x, y});
  return out;
}

// Tubes at the rim of a rope, the only ones that another rope can touch.
std::vector<Fibre> rim_of(const std::vector<Fibre>& fibres, double spacing) {
  double farthest = 0;
  for (const Fibre& f : fibres) farthest = std::max(farthest, std::hypot(f.x, f.y));
  std::vector<Fibre> rim;
  for (const Fibre& f : fibres)
    if (std::hypot(f.x, f.y) > farthest - 1.5 * spacing) rim.push_back(f);
  return rim;
}

// The tubes as curves; s (nm) is the arc of the centre line of their rope, 0 in the middle.
struct Helices {
  int ropes = 2;
  double winding = 0;               // rad/nm of z
  std::optional<double> own_twist;  // rad/nm
  double radius = 0;                // nm
  double facing = 0;                // angle of the section to the direction from the axis, at s = 0, rad

  double cosine() const { return 1 / std::hypot(1, radius * winding); }
  // Turn of the section against the direction from the axis, rad/nm.
  double rolling() const { return own_twist ? *own_twist - winding * cosine() * cosine() : 0; }
  bool are_straight() const { return winding == 0 && rolling() == 0; }
  double azimuth(int rope, double s) const { return 2 * units::pi * rope / ropes + winding * cosine() * s; }
  Quaternion section(int rope, double s) const {
    const Quaternion about(Eigen::AngleAxisd(azimuth(rope, s), Vector3::UnitZ())),
        lean(Eigen::AngleAxisd(-std::atan(radius * winding), Vector3::UnitX())),
        turn(Eigen::AngleAxisd(facing + rolling() * s, Vector3::UnitZ()));
    return about * lean * turn;
  }
  Vector3 point(int rope, const Fibre& f, double s) const {
    const double phi = azimuth(rope, s);
    return Vector3(radius * std::cos(phi), radius * std::sin(phi), s * cosine()) +
           section(rope, s) * Vector3(f.x, f.y, 0);
  }
  Vector3 velocity(int rope, const Fibre& f, double s) const {
    constexpr double step = 1e-4;
    return (point(rope, f, s + step) - point(rope, f, s - step)) / (2 * step);
  }
  // Tubes turn about their own axes with the section, from the same direction on.
  Quaternion orientation(int rope, const Fibre& f, double s) const {
    const Quaternion q =
        section(rope, s) * Quaternion(Eigen::AngleAxisd(-facing - azimuth(rope, 0), Vector3::UnitZ()));
    return (Quaternion::FromTwoVectors(axis_of(q), velocity(rope, f, s)) * q).normalized();
  }
  // Distance of a tube at s from the nearest point of another tube.
  double distance(int rope, const Fibre& f, double s, int other, const Fibre& g) const {
    const Vector3 here = point(rope, f, s);
    double at = s;
    for (int k = 0; k < 6; ++k) {
      const Vector3 along = velocity(other, g, at);
      at += (here - point(other, g, at)).dot(along) / along.squaredNorm();
    }
    return (here - point(other, g, at)).norm();
  }
  // The arc at which the tube is a chord away from where it is at s; a negative chord leads backwards.
  double after(int rope, const Fibre& f, double s, double chord) const {
    const Vector3 from = point(rope, f, s);
    double arc = chord;
    for (int k = 0; k < 30; ++k) {
      const double missing = std::fabs(chord) - (point(rope, f, s + arc) - from).norm();
      arc += (chord > 0 ? missing : -missing) / velocity(rope, f, s + arc).norm();
    }
    return s + arc;
  }
};

// The arcs at which distances are looked at. Where ropes do not roll on one another, all sections are alike.
std::vector<double> sections_of(const Helices& h, double length) {
  constexpr double step = 3 * units::degree;
  const double rate = std::fabs(h.rolling()), rolled = std::min(rate * length, 2 * units::pi);
  const int steps = static_cast<int>(std::ceil(rolled / step));
  std::vector<double> out;
  for (int k = 0; k <= steps; ++k) out.push_back(steps == 0 ? 0 : (k - 0.5 * steps) / steps * rolled / rate);
  return out;
}

// At which straight ropes touch whose sections are turned by `facing`.
double straight_radius(int ropes, const std::vector<Fibre>& rim, double spacing, double facing) {
  const double apart = 2 * units::pi / ropes;
  const Eigen::Rotation2Dd here(facing), there(apart + facing);
  const Eigen::Vector2d way = Eigen::Rotation2Dd(apart) * Eigen::Vector2d::UnitX() - Eigen::Vector2d::UnitX();
  double radius = 0;
  for (const Fibre& f : rim)
    for (const Fibre& g : rim) {
      const Eigen::Vector2d from = there * Eigen::Vector2d(g.x, g.y) - here * Eigen::Vector2d(f.x, f.y);
      const double along = from.dot(way.normalized()), across2 = from.squaredNorm() - along * along;
      if (across2 < spacing * spacing)
        radius = std::max(radius, (std::sqrt(spacing * spacing - across2) - along) / way.norm());
    }
  return radius;
}

// The turn of the sections that lets straight ropes come nearest: tubes of one lie in the grooves of the other.
double nearest_facing(int ropes, const std::vector<Fibre>& rim, double spacing) {
  constexpr int tries = 240;
  constexpr double step = 60 * units::degree / tries;
  const auto radius = [&](double facing) { return straight_radius(ropes, rim, spacing, facing); };
  double best = 0;
  for (int k = 1; k < tries; ++k)
    if (radius(k * step) < radius(best) - 1e-9) best = k * step;
  double from = best - step, to = best + step;
  for (int k = 0; k < 60; ++k) {
    const double a = from + (to - from) / 3, b = to - (to - from) / 3;
    if (radius(a) < radius(b))
      to = b;
    else
      from = a;
  }
  return 0.5 * (from + to);
}

// The least distance of a tube of one rope from a tube of the next.
double between_ropes(const Helices& h, const std::vector<Fibre>& rim, double spacing, double length) {
  double least = std::numeric_limits<double>::infinity();
  for (const double s : sections_of(h, length)) {
    std::vector<Vector3> others;
    for (const Fibre& g : rim) others.push_back(h.point(1, g, s));
    for (const Fibre& f : rim) {
      const Vector3 here = h.point(0, f, s);
      for (std::size_t k = 0; k < rim.size(); ++k)
        if ((others[k] - here).norm() < 2 * spacing) least = std::min(least, h.distance(0, f, s, 1, rim[k]));
    }
  }
  return least;
}

Helices touching(const PliesSource& plies, double spacing, double length) {
  const std::vector<Fibre> rim = rim_of(fibres_of(plies, spacing), spacing);
  Helices h{plies.ropes, plies.winding, plies.own_twist, 0, 0};
  if (!plies.own_twist || h.are_straight()) h.facing = nearest_facing(plies.ropes, rim, spacing);
  if (h.are_straight()) {
    h.radius = straight_radius(plies.ropes, rim, spacing, h.facing);
    return h;
  }
  // The search goes from where the ropes are apart to the first touch.
  double farthest = 0;
  for (const Fibre& f : rim) farthest = std::max(farthest, std::hypot(f.x, f.y));
  const double step = 0.05 * spacing;
  double apart = 1.05 * (farthest + 0.5 * spacing) / std::sin(units::pi / plies.ropes), near = apart;
  const auto touch = [&](double radius) {
    h.radius = radius;
    return between_ropes(h, rim, spacing, length) < spacing;
  };
  while (near > step && !touch(near)) apart = near, near -= step;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (near + apart);
    (touch(middle) ? near : apart) = middle;
  }
  h.radius = apart;
  return h;
}

// The least distance of two tubes of one rope: they press each other where they lean.
double inside_of_rope(const Helices& h, const std::vector<Fibre>& fibres, double spacing) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < fibres.size(); ++a)
    for (std::size_t b = a + 1; b < fibres.size(); ++b)
      if (std::hypot(fibres[a].x - fibres[b].x, fibres[a].y - fibres[b].y) < 1.5 * spacing)
        least = std::min(least, h.distance(0, fibres[a], 0, 0, fibres[b]));
  return least;
}

double largest_curvature(const Topology& topology, const State& state) {
  double most = 0;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const Vector3 a = axis_of(state.orientation[static_cast<std::size_t>(e)]),
                    b = axis_of(state.orientation[static_cast<std::size_t>(e) + 1]);
      most = std::max(most, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  return most / topology.longest_element();
}

// What the limits of the model would find in the first step.
void refuse_strong_winding(const PliesSource& plies, const Scene& scene, const Helices& h, double spacing,
                           const Topology& topology, const State& state) {
  const char* remedy = "lower the number, or that of rope_twist_deg_per_nm";
  const std::shared_ptr<const ContactLaw> law = contact_law(scene);
  double core = 2 * largest_radius(scene), kink = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(scene.sets.size()); ++i) {
    const double here = scene.sets[static_cast<std::size_t>(i)].validity.kink_curvature;
    if (here > 0) kink = std::min(kink, here);
    if (law) core = std::max(core, law->core_distance({i, i}));
  }
  if (const double least = inside_of_rope(h, fibres_of(plies, spacing), spacing); least < core)
    throw InputError(plies.typed,
                     fmt::format("presses tubes of a rope into one another: their axes come as near as {:.3g} nm, "
                                 "and less than {:.3g} nm is an overlap",
                                 least, core),
                     remedy);
  if (const double most = largest_curvature(topology, state); most > kink)
    throw InputError(plies.typed,
                     fmt::format("curves tubes by {:.3g} per nm, and they kink from {:.3g} on", most, kink),
                     remedy);
}

void check_plies(const TomlTable& t, const Scene& scene, PliesSource& plies) {
  if (plies.ropes == 1)
    throw t.error("ropes", "is 1, and a rope alone has no other to lie beside",
                  fmt::format("take 2 to {} ropes, or a [rope]", most_ropes));
  check_rope_size(t, scene, plies.rope, plies.ropes);
  plies.typed = t.error("ply_twist_deg_per_nm", "", "").place();
}

KeyOf<PliesSource> own_twist_key() {
  const char* key = "rope_twist_deg_per_nm";
  return KeyOf<PliesSource>::custom(
      key, "deg/nm", otherwise("0", "that of ropes wound as one body"),
      "each rope's own twist, along its centre line; 0: its tubes run parallel to that line",
      [key](const TomlTable& t, const Scene&, PliesSource& plies) {
        if (t.has(key)) plies.own_twist = t.number(key, Bounds::range(-30, 30)) * units::degree;
      });
}

}  // namespace

SceneKind plies_kind() {
  using Key = KeyOf<PliesSource>;
  using Packing = RopeSource::Packing;
  const auto rope = [](auto member) {
    return [member](auto& plies) -> auto& { return plies.rope.*member; };
  };
  return scene_kind<PliesSource>(
      {"plies",
       "instead of [rope]: equal ropes that touch, side by side or wound round one another about z",
       {Key::integer("ropes", 1, most_ropes, &PliesSource::ropes, required("2"),
                     "number of ropes, 2 to 6, in a ring about the axis"),
        Key::integer("tubes", 1, max_elements, rope(&RopeSource::tubes), required("7"),
                     "of each rope, as in [rope]"),
        Key::word("packing", Words<Packing>{{"hexagonal", Packing::hexagonal}, {"round", Packing::round}},
                  rope(&RopeSource::packing), standard(), "of each rope, as in [rope]"),
        Key::number("length_nm", unit::nm, Bounds::positive(1e9), rope(&RopeSource::length), required("67.8"),
                    "length of the tubes, rounded to whole elements")
            .is_tube_size(SceneKey::TubeSize::length),
        Key::number("spacing_nm", unit::nm, spacing_bounds, rope(&RopeSource::spacing),
                    otherwise("1.713", "where two tubes bind best"),
                    "distance between tube axes, in a rope and where two ropes touch"),
        Key::number("ply_twist_deg_per_nm", {"deg/nm", units::degree}, Bounds::range(-30, 30),
                    &PliesSource::winding, standard(),
                    "winding of the ropes round one another, along z; right-handed: positive"),
        own_twist_key()},
       check_plies});
}

Source::Sizes PliesSource::sizes(double element_length) const {
  return {ropes * rope.tubes, rope.sizes(element_length).elements};
}

void PliesSource::place(const Scene& scene, double spacing_of_tubes, Random&, Topology& topology,
                        State& state) const {
  const double a = scene.element_length;
  const int elements = sizes(a).elements;
  const Helices h = touching(*this, spacing_of_tubes, elements * a);
  topology.groups.rope_begin = {0};
  for (int k = 0; k < ropes; ++k) {
    for (int t = 0; t < rope.tubes; ++t) topology.add_tube(elements);
    topology.groups.rope_begin.push_back(topology.tubes());
  }
  state = State(static_cast<std::size_t>(topology.elements()));
  std::vector<double> at(static_cast<std::size_t>(elements));
  const std::size_t middle = at.size() / 2;
  std::size_t first = 0;
  for (int k = 0; k < ropes; ++k)
    for (const Fibre& f : fibres_of(*this, spacing_of_tubes)) {
      // The elements follow from the middle on to both ends.
      at[middle] = elements % 2 == 1 ? 0 : h.after(k, f, 0, 0.5 * a);
      for (std::size_t e = middle + 1; e < at.size(); ++e) at[e] = h.after(k, f, at[e - 1], a);
      for (std::size_t e = middle; e-- > 0;) at[e] = h.after(k, f, at[e + 1], -a);
      for (std::size_t e = 0; e < at.size(); ++e) {
        state.position.set(first + e, h.point(k, f, at[e]));
        state.orientation.set(first + e, h.orientation(k, f, at[e]));
      }
      first += at.size();
    }
  if (!h.are_straight()) refuse_strong_winding(*this, scene, h, spacing_of_tubes, topology, state);
}

std::string PliesSource::description(const Topology& t, const State& s, double spacing_of_tubes) const {
  const double degree = units::degree;
  Vector3 centre = Vector3::Zero();  // centre of the cross-section in the middle of the first rope
  for (int tube = 0; tube < rope.tubes; ++tube)
    centre += s.position[static_cast<std::size_t>(t.tube_begin[tube] + t.length_of(tube) / 2)] / rope.tubes;
  const double radius = centre.head<2>().norm();
  const std::string wound = winding == 0 ? std::string()
                                         : fmt::format(", wound by {:.4g} deg/nm at {:.3g} degrees to the axis",
                                                       winding / degree, std::atan(radius * winding) / degree);
  return fmt::format(
      "{} ropes of {} tubes of {:.4g} nm, spacing {:.4g} nm, their middles {:.4g} nm from the axis{}", ropes,
      rope.tubes, t.length_of(0) * t.longest_element(), spacing_of_tubes, radius, wound);
}

}  // namespace ropewalk
