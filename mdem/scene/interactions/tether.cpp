// [[tether]] an elastic tether between two places on tubes, or from such a place to a fixed point; it may break:
//
//   U = k/2 (d - d0)^2 until the first step with d > d_max, and 0 from then on;  F = -dU/dx
//
// d is the distance of its ends. An end is the centre of its elements, which share the force. There are no couples.
// Units nm, eV.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/error.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk {
namespace {

constexpr double at_the_start = -1, never = std::numeric_limits<double>::infinity();
constexpr int elsewhere = -1;

// --- the term -----------------------------------------------------------------------------------------

struct TetherEnd {
  std::vector<int> elements;         // elements of the scene; none: a fixed point
  Vector3 centre = Vector3::Zero();  // nm
  std::vector<int> own;              // the elements of this process, by their places in its state
};

class Tether : public ForceTerm {
 public:
  Tether(std::array<TetherEnd, 2> ends, double k, double rest, double breaks_at)
      : ends_(std::move(ends)),
        k_(k),
        rest_(rest),
        breaks_at_(breaks_at),
        rests_as_it_starts_(rest == at_the_start) {}

  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<Tether>(*this); }
  std::string name() const override { return "tether"; }
  bool forces_follow_from_places() const override { return true; }

  // Where one process has all elements, the others have nothing to do with it.
  void prepare(const ListedScene& scene) override {
    for (TetherEnd& end : ends_) end.own = own_places(scene.topology, end.elements);
    const std::vector<int> first = own_places(scene.topology, {ends_[0].elements.front()});
    first_ = first.empty() ? elsewhere : first.front();
    const auto whole = [](const TetherEnd& end) { return end.own.size() == end.elements.size(); };
    // The process that owns the first element says what the tether remembers: others may get a part of it now.
    const bool tells = first_ != elsewhere;
    double all[] = {whole(ends_[0]) && whole(ends_[1]) ? 1.0 : 0.0, tells ? rest_ : 0.0, tells && broken_ ? 1.0 : 0.0};
    if (scene.others) {
      scene.others->sum(all, 3);
      rest_ = all[1];
      broken_ = all[2] > 0;
    }
    const bool in_one_process = all[0] > 0;
    others_ = in_one_process ? nullptr : scene.others;
    away_ = in_one_process && first_ == elsewhere;
    gather(scene.state);
    if (rest_ == at_the_start && !away_) rest_ = distance();
  }

  void gather(const State& state) override {
    if (away_) return;
    double sums[6] = {};
    for (int e = 0; e < 2; ++e)
      for (const int i : ends_[e].own)
        for (int axis = 0; axis < 3; ++axis)
          sums[3 * e + axis] += state.position[static_cast<std::size_t>(i)][axis];
    if (others_) others_->sum(sums, 6);
    for (int e = 0; e < 2; ++e)
      if (!ends_[e].elements.empty())
        ends_[e].centre = Vector3(sums[3 * e], sums[3 * e + 1], sums[3 * e + 2]) / count(ends_[e]);
  }

  StateUpdate advance(double, const State&) override {
    if (broken_ || away_ || !(distance() > breaks_at_)) return {};
    broken_ = true;
    return first_ == elsewhere ? StateUpdate() : StateUpdate{stored(), 1};
  }

  TermSum add(const State&, const Segment& part, const ForceRows& out) const override {
    const double d = distance();
    if (broken_ || away_ || !(d > 0)) return {};
    const Vector3 pull = k_ * (d - rest_) / d * (ends_[1].centre - ends_[0].centre);  // on the first end
    const auto within = [&](int i) { return part.begin <= i && i < part.end; };
    for (int e = 0; e < 2; ++e)
      for (const int i : ends_[e].own)
        if (within(i))
          out.force.add(static_cast<std::size_t>(i - out.origin), (e == 0 ? 1 : -1) / count(ends_[e]) * pull);
    return {within(first_) ? stored() : 0, 0};
  }

  bool add_tangent(const State&, const AddBlock& add) const override {
    const double d = distance();
    if (broken_ || away_ || !(d > 0)) return true;
    const Vector3 along = (ends_[1].centre - ends_[0].centre) / d;
    const Eigen::Matrix3d pull =
        k_ * ((1 - rest_ / d) * Eigen::Matrix3d::Identity() + rest_ / d * along * along.transpose());
    for (int e = 0; e < 2; ++e)
      for (int f = 0; f < 2; ++f)
        for (const int i : ends_[e].own)
          for (const int j : ends_[f].own) {
            Eigen::Matrix<double, 6, 6> block = Eigen::Matrix<double, 6, 6>::Zero();
            block.topLeftCorner<3, 3>() = (e == f ? 1 : -1) / (count(ends_[e]) * count(ends_[f])) * pull;
            add(i, j, block);
          }
    return true;
  }

  double stiffness() const override {
    double sum = 0;
    for (const TetherEnd& end : ends_)
      if (!end.elements.empty()) sum += k_ / count(end);
    return sum;
  }

  bool remembers() const override { return true; }
  TermState memory() const override {
    if (first_ == elsewhere) return {};
    return {{ends_[0].elements.front(), {rest_, broken_ ? 1.0 : 0.0}}};
  }

  void set_memory(const TermState& memory) override {
    if (memory.empty()) return;  // nothing has happened yet
    const std::vector<double>& numbers = memory.front().numbers;
    if (memory.size() > 1 || numbers.size() != 2 || !(numbers[0] >= 0) || (numbers[1] != 0 && numbers[1] != 1))
      throw std::runtime_error("the memory of a tether is damaged");
    if (rests_as_it_starts_) rest_ = numbers[0];
    broken_ = numbers[1] == 1;
  }

 private:
  static double count(const TetherEnd& end) { return static_cast<double>(end.elements.size()); }
  double distance() const { return (ends_[1].centre - ends_[0].centre).norm(); }
  double stored() const { return 0.5 * k_ * (distance() - rest_) * (distance() - rest_); }

  std::array<TetherEnd, 2> ends_;  // the first one has elements
  double k_, rest_, breaks_at_;    // eV/nm^2, nm, nm
  bool rests_as_it_starts_ = false;
  bool broken_ = false;
  int first_ = 0;                      // place of its first element, to which energy and memory belong
  bool away_ = false;                  // another process has all of it
  const Processes* others_ = nullptr;  // that have some of its elements
};

// --- its table ----------------------------------------------------------------------------------------

// As typed: a tube with elements, or a point.
struct TypedEnd {
  int tube = 0;
  std::vector<int> elements;
  Vector3 point = Vector3::Zero();  // nm, without elements
};

class TetherDrive : public Drive {
 public:
  TypedEnd from, to;
  double k = 0, rest = at_the_start, breaks_at = never;
  InputError::Place place;

  SceneTable table() const override;
  std::string words() const override {
    const auto end = [](const TypedEnd& e) {
      if (e.elements.empty())
        return fmt::format("the point {:.4g}, {:.4g}, {:.4g} nm", e.point.x(), e.point.y(), e.point.z());
      return fmt::format("tube {}, element{} {}", e.tube, e.elements.size() > 1 ? "s" : "",
                         fmt::join(e.elements, ", "));
    };
    return fmt::format("tether: {} to {}, {:.4g} nN/nm, at rest {}{}", end(from), end(to), k / units::nN_nm,
                       rest == at_the_start ? "as it starts" : fmt::format("at {:.4g} nm", rest),
                       breaks_at == never ? "" : fmt::format(", breaks at {:.4g} nm", breaks_at));
  }

  void refuse(const TomlTable& top, const Scene& scene) const override {
    if (scene.has_ends(Ends::endless))
      throw top.error("tether", "does not go with [periodic]: the images of the slice have no tethers",
                      "take one of the two away");
  }
  void add_terms(const Scene&, const Topology& topology, const State& /*start*/,
                 Interaction& interaction) const override {
    add_term(std::make_shared<Tether>(std::array<TetherEnd, 2>{on(topology, from), on(topology, to)}, k, rest,
                                      breaks_at),
             interaction);
  }
  std::string why_not_lengthened() const override { return "a tether names elements by number"; }

 private:
  TetherEnd on(const Topology& topology, const TypedEnd& typed) const {
    TetherEnd end;
    end.centre = typed.point;
    for (const int e : typed.elements) {
      const int element = element_of_tube(topology, typed.tube, e, place);
      if (std::find(end.elements.begin(), end.elements.end(), element) != end.elements.end())
        throw InputError(place, fmt::format("{} is an element of tube {} that is named already", e, typed.tube),
                         "name each once");
      end.elements.push_back(element);
    }
    return end;
  }
};

using Read = std::function<void(const TomlTable&, const Scene&, TetherDrive&)>;

Read elements_of(const char* key, TypedEnd TetherDrive::*end) {
  return [=](const TomlTable& t, const Scene&, TetherDrive& tether) {
    std::vector<int>& elements = (tether.*end).elements;
    if (end == &TetherDrive::to && !t.has(key)) return;
    for (const long e : t.integers(key, -long{max_elements}, max_elements)) {
      if (std::find(elements.begin(), elements.end(), e) != elements.end())
        throw t.error(key, fmt::format("names {} twice", e), "name each once");
      elements.push_back(static_cast<int>(e));
    }
  };
}

void read_point(const TomlTable& t, const Scene&, TetherDrive& tether) {
  if (!t.has("to_point_nm")) return;
  const std::vector<double> p = t.numbers("to_point_nm", Bounds::range(-1e6, 1e6), 3);
  tether.to.point = {p[0], p[1], p[2]};
}

void check_ends(const TomlTable& t, const Scene& scene, TetherDrive& tether) {
  if (t.has("to_point_nm") == t.has("to_elements"))
    throw t.error("to_point_nm",
                  t.has("to_point_nm") ? "stands beside to_elements: a tether has two ends" : "is missing",
                  "give to_point_nm, or to_tube and to_elements");
  if (t.has("to_tube") && !t.has("to_elements"))
    throw t.error("to_tube", "has no to_elements", "say which elements of that tube the tether holds");
  if (tether.breaks_at <= tether.rest)
    throw t.error("breaks_at_nm", fmt::format("is {:.4g} and not above rest_nm", tether.breaks_at),
                  "a tether breaks when it is stretched; raise it");
  tether.place = {scene.path, t.line(), "tether"};
}

const KeyTable<TetherDrive>& tether_table() {
  using Key = KeyOf<TetherDrive>;
  const auto tube = [](const char* key, auto member, const Presence& p, const char* meaning) {
    return Key::integer(key, 0, max_elements, member, p, meaning);
  };
  static const KeyTable<TetherDrive> table = {
      "tether",
      "any number of these: elastic tethers between elements",
      {tube(
           "tube", [](auto& d) -> auto& { return d.from.tube; }, required("0"), "tube of its first end, from 0"),
       Key::custom("elements", "", required("[-1]"),
                   "elements of that tube whose centre it holds, negative from the end",
                   elements_of("elements", &TetherDrive::from))
           .that_numbers_elements(),
       tube(
           "to_tube", [](auto& d) -> auto& { return d.to.tube; }, otherwise("1", "0"), "tube of its other end"),
       Key::custom("to_elements", "", otherwise("[-1]", "to_point_nm"), "elements of that tube",
                   elements_of("to_elements", &TetherDrive::to))
           .that_numbers_elements(),
       Key::custom("to_point_nm", "nm", otherwise("[0, 0, 20]", "to_elements"), "or a point to which it is tied",
                   read_point),
       Key::number("stiffness_nN_per_nm", {"nN/nm", units::nN_nm}, Bounds::positive(1e4), &TetherDrive::k,
                   required("0.1"), "pull per stretch of the tether"),
       Key::number("rest_nm", unit::nm, Bounds::non_negative(1e6), &TetherDrive::rest,
                   otherwise("5", "as it starts"),
                   "length at which the tether has no force; below it, the tether pushes"),
       Key::number("breaks_at_nm", unit::nm, Bounds::positive(1e6), &TetherDrive::breaks_at,
                   otherwise("8", "never"), "length beyond which it breaks for good")},
      check_ends};
  return table;
}

SceneTable tether_keys() {
  SceneTable table = tether_table().doc();
  table.listed = true;
  return table;
}

SceneTable TetherDrive::table() const { return tether_keys(); }

}  // namespace

DriveKind tether_drive() {
  return {tether_keys,
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            return std::make_shared<const TetherDrive>(tether_table().read(t, scene));
          },
          "energy of the tethers",
          {{"tether_lost_eV", "eV", "energy that broken tethers have lost", &TermAccount::lost},
           {"tethers_broken", "", "tethers that have broken", &TermAccount::events}}};
}

}  // namespace ropewalk
