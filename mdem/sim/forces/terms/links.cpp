#include "sim/forces/terms/links.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/contract.hpp"
#include "model/counter_random.hpp"
#include "sim/neighbours/cell_grid.hpp"
#include "sim/state/part_of_scene.hpp"
#include "sim/threads/for_each.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {
namespace {

constexpr double forming_interval = 1;               // ps
constexpr double rounding = 1e-9;                    // rounding error of sums of steps, ps
constexpr std::uint32_t room_question = 0xFFFFFFFF;  // a number k of drawn() that no link takes

// --- where tubes face each other -----------------------------------------------------------------------

struct Axis {
  Vector3 centre, along;
  double half = 0, radius = 0;
};
Axis axis_at(const Topology& topology, const State& state, int element) {
  const auto i = static_cast<std::size_t>(element);
  const TubeType& type = topology.type_of_element(element);
  return {state.position[i], axis_of(state.orientation[i]), 0.5 * type.element_length, type.radius};
}

// A point of the axis a, at s (nm) from its centre, and the point of the axis b opposite to it. False: the wall of
// b is not within reach there.
struct Facing {
  double on_b = 0;  // nm
  Vector3 to_b;     // vector from axis to axis
};
bool faces(const Axis& a, const Axis& b, double s, double reach, Facing& out) {
  const Vector3 from_b = a.centre + s * a.along - b.centre;
  out.on_b = from_b.dot(b.along);
  if (!(out.on_b >= -b.half && out.on_b < b.half)) return false;
  out.to_b = out.on_b * b.along - from_b;
  return out.to_b.norm() < a.radius + b.radius + reach;
}

// In the frames of both elements. The points stand at half of the rest length from the walls, or in the middle.
LinkPlace link_at(const LinkLaw& law, const State& state, int i, int j, const Axis& a, const Axis& b, double s,
                   const Facing& facing) {
  LinkPlace link;
  link.a = i;
  link.b = j;
  const double apart = facing.to_b.norm();
  const Vector3 to_b = facing.to_b / apart;
  const auto across = [&](const Vector3& v, const Axis& of) -> Vector3 {
    return (v - v.dot(of.along) * of.along).normalized();
  };
  const Vector3 n_a = across(to_b, a), n_b = across(-to_b, b);
  const Quaternion to_a = state.orientation[static_cast<std::size_t>(i)].conjugate(),
                   into_b = state.orientation[static_cast<std::size_t>(j)].conjugate();
  if (law.rest >= 0) {
    link.p_a = to_a * Vector3(s * a.along + (a.radius + 0.5 * law.rest) * n_a);
    link.p_b = into_b * Vector3(facing.on_b * b.along + (b.radius + 0.5 * law.rest) * n_b);
  } else {
    const Vector3 middle = a.centre + s * a.along + 0.5 * (apart + a.radius - b.radius) * to_b;
    link.p_a = to_a * Vector3(middle - a.centre);
    link.p_b = into_b * Vector3(middle - b.centre);
  }
  link.n_a = to_a * n_a;
  link.n_b = into_b * n_b;
  return link;
}

// Random number k, in (0, 1), of the elements i and j at this step; 0: of the structure.
double drawn(const LinkLaw& law, int i, int j, std::uint32_t step, std::uint32_t k) {
  return unit_interval(philox({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), step, k},
                              step == 0 ? law.seed : lineage_key(law.seed, law.lineage))[0]);
}

// A number of events with this mean, by inversion. Means are small: an element is short.
int poisson(double mean, double u) {
  double term = std::exp(-mean), sum = term;
  int n = 0;
  while (u > sum && n < 1000) {
    term *= mean / ++n;
    sum += term;
  }
  return n;
}

// The tubes of the scene, and what this process has of it. Elements are meant by their places here.
struct LinkedScene {
  const Topology &scene, &here;

  int number(int i) const { return number_in_scene(here, i); }
  int tube(int i) const { return scene.tube_of(number(i)); }
  bool ends_tube(int i) const {
    const auto t = static_cast<std::size_t>(tube(i));
    return number(i) == scene.tube_begin[t] || number(i) + 1 == scene.tube_begin[t + 1];
  }
};

bool is_linked(const LinkLaw& law, const LinkedScene& in, int i, int j) {
  const int tube_i = in.tube(i), tube_j = in.tube(j);
  return tube_i != tube_j && law.types.have(in.scene.tube_type[static_cast<std::size_t>(tube_i)],
                                            in.scene.tube_type[static_cast<std::size_t>(tube_j)]);
}

// In a slice a link and its images are one: that of two own elements, or of an own one and an image above it.
bool stands_for_images(const Topology& topology, int i, int j) {
  const auto above = [&](int e) { return topology.original_of(e) < e; };
  return topology.groups.images == 0 || (!topology.is_image(i) && (!topology.is_image(j) || above(j))) ||
         (!topology.is_image(j) && above(i));
}

// The same link one period higher where it joins an image below.
void lift(const Topology& topology, LinkPlace& link) {
  if (topology.groups.images == 0 || stands_for_images(topology, link.a, link.b)) return;
  const auto higher = [&](int e) {
    return topology.is_image(e) ? topology.original_of(e) : topology.image_above(e);
  };
  link.a = higher(link.a);
  link.b = higher(link.b);
  ROPEWALK_ENSURES(link.a >= 0 && link.b >= 0);
}

// Chosen for a pair of elements with this mean number per length.
template <class Add>
void choose(const LinkLaw& law, const LinkedScene& in, const State& state, int i, int j, double per_length,
            std::uint32_t step, const Add& add) {
  const Axis a = axis_at(in.here, state, i), b = axis_at(in.here, state, j);
  const int first = in.number(i), second = in.number(j);
  const int count = poisson(2 * a.half * per_length, drawn(law, first, second, step, 0));
  for (int k = 0; k < count; ++k) {
    const double s = a.half * (2 * drawn(law, first, second, step, static_cast<std::uint32_t>(k) + 1) - 1);
    Facing facing;
    if (faces(a, b, s, law.reach, facing)) add(link_at(law, state, i, j, a, b, s, facing));
  }
}

// `count` links of an end element with whatever it faces.
void choose_at_end(const LinkLaw& law, const LinkedScene& in, const State& state, int i,
                   const std::vector<int>& near, std::uint32_t step, std::vector<LinkPlace>& links) {
  const Axis a = axis_at(in.here, state, i);
  const int end = in.number(i);
  for (int n = 0; n < law.at_ends; ++n) {
    const auto k = 2 * static_cast<std::uint32_t>(n);
    const double s = a.half * (2 * drawn(law, end, end, step, k) - 1);
    std::vector<int> faced;
    Facing facing;
    for (const int j : near)
      if (is_linked(law, in, i, j) && faces(a, axis_at(in.here, state, j), s, law.reach, facing))
        faced.push_back(j);
    if (faced.empty()) continue;
    const int j =
        faced[static_cast<std::size_t>(drawn(law, end, end, step, k + 1) * static_cast<double>(faced.size()))];
    const Axis b = axis_at(in.here, state, j);
    faces(a, b, s, law.reach, facing);
    links.push_back(link_at(law, state, i, j, a, b, s, facing));
    lift(in.here, links.back());
  }
}

// The links that the law chooses, by the places of their elements, in the order of the elements. Those of two copies
// may lack some that other processes choose.
std::vector<LinkPlace> chosen_links(const LinkLaw& law, const LinkedScene& in, const State& state, std::uint32_t step) {
  std::vector<LinkPlace> links;
  if (!(law.density > 0 || law.at_ends > 0)) return links;
  const Topology& here = in.here;
  const CellGrid grid(state.position, 2 * here.largest_radius() + law.reach + here.longest_element());
  std::vector<int> found, near;
  for (int i = 0; i < here.elements(); ++i) {
    const bool end = in.ends_tube(i);
    if (!(law.density > 0) && !end) continue;
    const std::size_t count = grid.find(i, end && law.at_ends > 0 ? -1 : i, found);
    near.assign(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(near.begin(), near.end());
    for (const int j : near)
      if (law.density > 0 && j > i && is_linked(law, in, i, j) && stands_for_images(here, i, j))
        choose(law, in, state, i, j, law.density, step, [&](LinkPlace place) { links.push_back(std::move(place)); });
    if (end && law.at_ends > 0 && !here.is_image(i)) choose_at_end(law, in, state, i, near, step, links);
  }
  return links;
}

// --- the term ------------------------------------------------------------------------------------------

// When (ps) and where (nm) it formed.
struct Link {
  LinkPlace at;
  double formed = 0;
  Vector3 formed_at;
};

// A link that acts between these elements: as it was placed, or as its image.
struct ActingLink {
  std::size_t link = 0;
  int a = 0, b = 0;  // places here
  bool is_image = false;
};

struct LinkAction {
  Vector3 force, torque_a, torque_b;  // the force on a; b has the opposite one
  Vector3 place;                      // between its points
  double energy = 0;
  double pull = 0;  // the size of the force, without what pushes the walls apart
};

constexpr double told = 1;  // value in a memory: the forming of its links has been told
constexpr std::size_t numbers_of_head = 5, numbers_of_link = 17;
// Version 0.3.0 remembered links that had broken too. The last number is the time, or -1.
constexpr std::size_t numbers_of_head_0_3 = 4, numbers_of_link_0_3 = 21;

class LinkTerm : public ForceTerm {
 public:
  LinkTerm(LinkLaw law, std::vector<LinkPlace> at_start, const Topology& scene)
      : law_(std::move(law)),
        scene_(scene),
        here_(scene),
        waits_(law_.placed_at > 0),
        stiffness_(stiffness_of(at_start)) {
    for (LinkPlace& place : at_start) links_.push_back({std::move(place), 0, Vector3::Zero()});
    sort();
  }
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<LinkTerm>(*this); }
  std::string name() const override { return "links"; }
  std::string not_foreseen() const override { return "what links pull"; }

  void prepare(const ListedScene& scene) override {
    if (scene.topology.part) {
      here_ = scene.topology;
      if (scene.others) hear_of_head(*scene.others);
      check_stretch(scene.state);
    } else if (!has_head_) {
      throw std::runtime_error("the memory of links is damaged");
    }
    if (!placed_) {
      for (Link& link : links_) {
        link.formed_at = action_of(link.at, link.at.a, link.at.b, scene.state).place;
        tell_formed(link);
      }
      placed_ = true;
    }
    index();
  }
  // A process must see all that its elements may be linked with, and where links form also what those are linked with.
  double copy_reach() const override {
    const double half = 0.5 * scene_.longest_element(),
                 forms = half + std::hypot(2 * scene_.largest_radius() + law_.reach, half);
    return law_.forming > 0 || law_.placed_at > 0 ? forms + std::max(forms, longest_link()) : longest_link();
  }

  void gather(const State& state) override {
    actions_.resize(acting_.size());
    for_each(acting_.size(), acting_.size() > parallel_from, [&](std::size_t k) {
      actions_[k] = action_of(links_[acting_[k].link].at, acting_[k].a, acting_[k].b, state);
    });
  }

  // Processes that have both ends of a link judge it alike; that of its first element counts it.
  StateUpdate advance(double, const State& state) override {
    StateUpdate all;
    if (waits_ && state.time >= law_.placed_at - rounding) all.news = place_all(state);
    if (law_.forming > 0 && state.time - last_formed_ >= forming_interval - rounding)
      all.news = form(state) || all.news;
    all.lost = -given_;
    all.begun = begun_;
    given_ = 0;
    begun_ = 0;
    bool some_broke = false;
    // Whether a link breaks follows from itself and not from its image, which stands behind it.
    std::vector<char> broke(links_.size(), 0);
    for (std::size_t k = 0; k < acting_.size(); ++k) {
      const Link& link = links_[acting_[k].link];
      const LinkAction& now = actions_[k];
      const bool is_image = acting_[k].is_image;
      const bool breaks =
          (law_.strength > 0 && now.pull > law_.strength) || (law_.toughness > 0 && now.energy > law_.toughness);
      if (is_image ? broke[acting_[k].link] == 0 : !breaks) continue;
      broke[acting_[k].link] = 1;
      some_broke = true;
      if (!here_.owns(acting_[k].a)) continue;
      all.lost += now.energy;
      if (is_image) continue;
      events_.push_back({state.time, "link broke", link.at.a, link.at.b, now.place});
      ++all.events;
    }
    if (some_broke) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < links_.size(); ++k)
        if (broke[k] == 0) links_[kept++] = links_[k];
      links_.resize(kept);
      index();
      gather(state);
    }
    return all;
  }

  TermSum add(const State&, const Segment& part, const ForceRows& out) const override {
    TermSum sum;
    for (int i = part.begin; i < part.end; ++i) {
      Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
      for (const int k : of_first_.of(i)) {
        const LinkAction& action = actions_[static_cast<std::size_t>(k)];
        force += action.force;
        torque += action.torque_a;
        sum.energy += action.energy;
      }
      for (const int k : of_second_.of(i)) {
        const LinkAction& action = actions_[static_cast<std::size_t>(k)];
        force -= action.force;
        torque += action.torque_b;
      }
      out.force.add(static_cast<std::size_t>(i - out.origin), force);
      out.torque.add(static_cast<std::size_t>(i - out.origin), torque);
    }
    return sum;
  }

  double stiffness() const override { return stiffness_; }
  long begun_at_start() const override { return static_cast<long>(links_.size()); }

  bool remembers() const override { return true; }
  TermState memory() const override {
    TermState out;
    if (owns_number(here_, 0))
      out.push_back({0, {last_formed_, static_cast<double>(begun_), given_, waits_ ? 1.0 : 0.0, told}});
    for (const Link& link : links_) {
      if (!owns_number(here_, link.at.a)) continue;
      TermRecord record{link.at.a, {static_cast<double>(link.at.b)}};
      const auto add = [&](const Vector3& v) {
        record.numbers.insert(record.numbers.end(), {v.x(), v.y(), v.z()});
      };
      for (const Vector3* v : {&link.at.p_a, &link.at.p_b, &link.at.n_a, &link.at.n_b, &link.formed_at}) add(*v);
      record.numbers.push_back(link.formed);
      out.push_back(std::move(record));
    }
    return out;
  }

  void set_memory(const TermState& memory) override {
    if (memory.empty() && !here_.part) return;  // nothing has happened yet
    const auto fail = [] { throw std::runtime_error("the memory of links is damaged"); };
    links_.clear();
    events_.clear();
    bool tells = false;
    has_head_ = false;
    for (const TermRecord& r : memory) {
      const std::vector<double>& x = r.numbers;
      if (!std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); })) fail();
      if ((x.size() == numbers_of_head || x.size() == numbers_of_head_0_3) && !has_head_) {
        last_formed_ = x[0];
        begun_ = static_cast<int>(std::lround(x[1]));
        given_ = x[2];
        waits_ = x[3] != 0;
        tells = x.size() == numbers_of_head && x[4] != told;
        has_head_ = true;
        continue;
      }
      const bool of_0_3 = x.size() == numbers_of_link_0_3;
      if ((x.size() != numbers_of_link && !of_0_3) || !(x[0] >= 0 && x[0] < scene_.tube_begin.back()) ||
          x[0] != std::floor(x[0]))
        fail();
      if (of_0_3 && x.back() >= 0) continue;
      const auto vector = [&](std::size_t at) { return Vector3(x[at], x[at + 1], x[at + 2]); };
      Link link;
      link.at = {r.element, static_cast<int>(x[0]), vector(1), vector(4), vector(7), vector(10)};
      link.formed_at = vector(13);
      link.formed = x[of_0_3 ? 19 : 16];
      links_.push_back(link);
      if (tells) tell_formed(link);
    }
    placed_ = true;
  }

  // All are there at the start.
  void begin_with(const TermState& memory) override {
    set_memory(memory);
    events_.clear();
    std::vector<LinkPlace> places;
    for (Link& link : links_) {
      link.formed = 0;
      places.push_back(link.at);
    }
    stiffness_ = stiffness_of(places);
    placed_ = false;
    last_formed_ = given_ = 0;
    begun_ = 0;
  }

  // Where all elements are cut in two, each point goes to the half that it stands beside. Where the shorter
  // elements stand in the old places, with new ones between them, it stays with the old one. The file events.csv of
  // the finer run begins with the links that hold.
  TermState halved(const TermState& coarse, const std::vector<int>& heirs) const override {
    const bool cut = scene_.tube_begin.size() > 2 &&
                     heirs[static_cast<std::size_t>(scene_.tube_begin[1])] == 2 * scene_.tube_begin[1];
    const auto move = [&](int element, double* p) {
      const int heir = heirs[static_cast<std::size_t>(element)];
      if (!cut) return heir;
      const bool second = p[2] >= 0;
      p[2] += (second ? -0.25 : 0.25) * element_length_;
      return heir + second;
    };
    TermState fine;
    for (const TermRecord& r : coarse) {
      TermRecord heir = r;
      if (r.numbers.size() == numbers_of_link) {
        heir.element = move(r.element, &heir.numbers[1]);
        heir.numbers[0] = move(static_cast<int>(r.numbers[0]), &heir.numbers[4]);
      } else {
        heir.numbers.back() = 0;
      }
      fine.push_back(std::move(heir));
    }
    return fine;
  }

  std::vector<TermEvent> events() const override { return events_; }
  void forget_events() override { events_.clear(); }

  std::size_t bytes() const override { return links_.size() * (sizeof(Link) + sizeof(LinkAction)); }

 private:
  // nm: how far the elements of a link can be apart before it breaks, or may be where none breaks.
  double longest_link() const {
    // Nothing bounds the stretch of a link that cannot break, and what processes copy of each other must have a bound:
    // three times the distance between walls that touch, 0.34 nm. check_stretch() ends a run that goes beyond.
    constexpr double unbreakable = 1;  // nm
    const double arm = std::hypot(scene_.largest_radius() + 0.5 * std::max(law_.reach, law_.rest),
                                  0.5 * scene_.longest_element()),
                 softest = std::min(law_.stretch, law_.shear);
    double stretch = unbreakable;
    if (softest > 0 && law_.strength > 0) stretch = law_.strength / softest;
    if (softest > 0 && law_.toughness > 0) {
      const double tough = std::sqrt(2 * law_.toughness / softest);
      stretch = law_.strength > 0 ? std::min(stretch, tough) : tough;
    }
    return 2 * arm + std::min(stretch, unbreakable);
  }
  void check_stretch(const State& state) const {
    constexpr double of_a_step = 0.1;  // nm: a link may stretch by this much in the step in which it breaks
    for (const Link& link : links_) {
      const int a = place_of(here_, link.at.a), b = place_of(here_, link.at.b);
      if (a < 0 || !here_.owns(a)) continue;
      const double apart = b < 0 ? copy_reach() : (state.position[static_cast<std::size_t>(b)] -
                                                   state.position[static_cast<std::size_t>(a)]).norm();
      if (b < 0 || apart > longest_link() + of_a_step)
        throw std::runtime_error("the link between elements " + std::to_string(link.at.a) + " and " +
                                 std::to_string(link.at.b) + " is stretched over more than " +
                                 std::to_string(std::min(apart, longest_link())) +
                                 " nm, farther than processes see: give breaks_at_nN, or run them on one process");
    }
  }
  // The process that owns the first element of the scene says what belongs to no link.
  void hear_of_head(const Processes& others) {
    const bool tells = owns_number(here_, 0);
    double head[] = {tells ? last_formed_ : 0.0, tells && waits_ ? 1.0 : 0.0};
    others.sum(head, 2);
    last_formed_ = head[0];
    waits_ = head[1] > 0;
  }

  LinkAction action_of(const LinkPlace& link, int on_a, int on_b, const State& state) const {
    const auto a = static_cast<std::size_t>(on_a), b = static_cast<std::size_t>(on_b);
    const Quaternion q_a = state.orientation[a], q_b = state.orientation[b];
    const Vector3 arm_a = q_a * link.p_a, arm_b = q_b * link.p_b, n_a = q_a * link.n_a, n_b = q_b * link.n_b;
    const Vector3 d = (state.position[b] + arm_b) - (state.position[a] + arm_a);
    const double half = 0.5 * (law_.stretch - law_.shear), d_a = d.dot(n_a), d_b = d.dot(n_b);
    LinkAction out;
    out.force = law_.shear * d + half * (d_a * n_a + d_b * n_b);
    out.torque_a = arm_a.cross(out.force) - half * d_a * n_a.cross(d);
    out.torque_b = -arm_b.cross(out.force) - half * d_b * n_b.cross(d);
    out.energy = 0.5 * (law_.shear * d.squaredNorm() + half * (d_a * d_a + d_b * d_b));
    out.place = state.position[a] + arm_a + 0.5 * d;
    const Vector3 outwards = (n_a - n_b).normalized();
    const double push = std::min(out.force.dot(outwards), 0.0);
    out.pull = (out.force - push * outwards).norm();
    return out;
  }

  // Two elements with n links on each have the eigenvalue 2 n K by their positions; turning adds the share of the
  // levers.
  double stiffness_of(const std::vector<LinkPlace>& at_start) {
    std::vector<int> count(static_cast<std::size_t>(scene_.elements()), 0);
    double lever = 0;
    for (const LinkPlace& link : at_start) {
      ++count[static_cast<std::size_t>(scene_.original_of(link.a))];
      ++count[static_cast<std::size_t>(scene_.original_of(link.b))];
    }
    for (const TubeType& type : scene_.types) {
      const double arm = type.radius + 0.5 * law_.reach, half = 0.5 * type.element_length;
      lever = std::max(lever, type.mass * (arm * arm + half * half) / type.inertia);
      element_length_ = type.element_length;
    }
    // Links to come: the mean number with six neighbours, and five standard deviations more.
    const double mean = waits_ ? 6 * law_.density * element_length_ + 2 * law_.at_ends : 0;
    const int later = waits_ ? static_cast<int>(std::ceil(mean + 5 * std::sqrt(mean))) : 0,
              formed =
                  std::max(later, law_.forming > 0 ? static_cast<int>(std::ceil(law_.most * element_length_)) : 0),
              most = std::max(formed, count.empty() ? 0 : *std::max_element(count.begin(), count.end()));
    return 2 * most * std::max(law_.stretch, law_.shear) * (1 + lever);
  }

  // Both return whether there are new links.
  bool place_all(const State& state) {
    const std::size_t before = links_.size();
    for (LinkPlace& place : chosen_links(law_, {scene_, here_}, state, 0)) take_in(std::move(place), state);
    waits_ = false;
    set_in_order(state);
    return links_.size() > before;
  }
  // `place` counts elements here. Other processes know more of a link between two copies.
  void take_in(LinkPlace place, const State& state) {
    if (!here_.owns(place.a) && !here_.owns(place.b)) return;
    Link link{std::move(place), state.time, Vector3::Zero()};
    const LinkAction action = action_of(link.at, link.at.a, link.at.b, state);
    link.formed_at = action.place;
    const bool counts = here_.owns(link.at.a);
    const int images = has_image(link.at) ? 2 : 1;
    link.at.a = number_in_scene(here_, link.at.a);
    link.at.b = number_in_scene(here_, link.at.b);
    links_.push_back(link);
    if (!counts) return;
    given_ += images * action.energy;
    ++begun_;
    tell_formed(link);
  }
  void tell_formed(const Link& link) {
    events_.push_back({link.formed, "link formed", link.at.a, link.at.b, link.formed_at});
  }

  // New links, for the time since the last ones.
  bool form(const State& state) {
    LinkLaw now = law_;
    now.density = law_.forming * (state.time - last_formed_);
    now.at_ends = 0;
    last_formed_ = state.time;
    std::vector<int> count(state.size(), 0);
    for (const Link& link : links_)
      for (const int number : {link.at.a, link.at.b})
        if (const int e = place_of(here_, number); e >= 0) ++count[static_cast<std::size_t>(here_.original_of(e))];
    // An element has room for a whole number of links. Its share, `most` times its length, is rounded up or down at
    // random, so that the mean over all elements is that share. It takes the first ones that are offered; a link
    // forms where both elements take it. So it depends on what is near, and on no order of the whole scene.
    const auto takes = [&](int element) {
      const int e = here_.original_of(element), number = number_in_scene(here_, e);
      const double room = law_.most * element_length_ + drawn(law_, number, number, 0, room_question);
      return ++count[static_cast<std::size_t>(e)] <= room;
    };
    const auto step = static_cast<std::uint32_t>(state.step) + 1;
    const std::size_t before = links_.size();
    for (LinkPlace& place : chosen_links(now, {scene_, here_}, state, step)) {
      const bool first = takes(place.a), second = takes(place.b);
      if (first && second) take_in(std::move(place), state);
    }
    set_in_order(state);
    return links_.size() > before;
  }
  void set_in_order(const State& state) {
    sort();
    index();
    gather(state);
  }
  // The order in which a memory returns: a resumed run adds up the forces in the same order.
  void sort() {
    std::stable_sort(links_.begin(), links_.end(), [](const Link& x, const Link& y) { return x.at.a < y.at.a; });
  }

  // Whether a slice has this link twice: a link to an image above acts on the original through its own image, one
  // period lower.
  bool has_image(const LinkPlace& link) const { return scene_.is_image(link.a) || scene_.is_image(link.b); }

  void index() {
    acting_.clear();
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const LinkPlace& at = links_[k].at;
      const int a = place_of(here_, at.a), b = place_of(here_, at.b);
      if (a < 0 || b < 0) continue;
      acting_.push_back({k, a, b, false});
      if (!has_image(at)) continue;
      const auto lower = [&](int e) { return scene_.is_image(e) ? scene_.original_of(e) : scene_.image_below(e); };
      acting_.push_back({k, lower(at.a), lower(at.b), true});
      ROPEWALK_EXPECTS(acting_.back().a >= 0 && acting_.back().b >= 0);
    }
    const auto elements = static_cast<std::size_t>(here_.elements());
    of_first_.sort_in(elements, acting_.size(), [&](std::size_t k) { return acting_[k].a; });
    of_second_.sort_in(elements, acting_.size(), [&](std::size_t k) { return acting_[k].b; });
  }

  LinkLaw law_;
  Topology scene_, here_;      // here: what this process has of the scene
  bool has_head_ = true;       // the last memory has one
  bool waits_ = false;         // for the time at which its links are placed
  double element_length_ = 0;  // nm; all types of a scene have the same
  double stiffness_ = 0;
  std::vector<Link> links_;        // that hold, by numbers of the scene, in the order of their first elements
  std::vector<TermEvent> events_;  // that nobody has written yet
  bool placed_ = false;
  double last_formed_ = 0;           // ps
  long begun_ = 0;                   // links that advance() has yet to count
  double given_ = 0;                 // eV, that links formed with; likewise
  std::vector<ActingLink> acting_;   // acting ones, in the order of the links
  std::vector<LinkAction> actions_;  // action of each of them
  Rows of_first_, of_second_;        // acting links by a and by b
};

}  // namespace

std::vector<LinkPlace> placed_links(const LinkLaw& law, const Topology& topology, const State& state,
                                    const std::vector<std::pair<int, int>>& pairs) {
  std::vector<LinkPlace> links;
  for (const auto& [i, j] : pairs) {
    const Axis a = axis_at(topology, state, i), b = axis_at(topology, state, j);
    // The foot of the common normal on a, within the element; along parallel axes that of b's centre.
    const Vector3 apart = b.centre - a.centre;
    const double cosine = a.along.dot(b.along), sine2 = 1 - cosine * cosine;
    double s = apart.dot(a.along);
    if (sine2 > 1e-6)
      s = (s - cosine * apart.dot(b.along)) / sine2;
    else
      s *= 0.5;
    s = std::clamp(s, -a.half, a.half);
    Facing facing;
    faces(a, b, s, law.reach, facing);
    facing.on_b = std::clamp(facing.on_b, -b.half, b.half);
    facing.to_b = b.centre + facing.on_b * b.along - a.centre - s * a.along;
    links.push_back(link_at(law, state, i, j, a, b, s, facing));
  }
  for (LinkPlace& link : chosen_links(law, {topology, topology}, state, 0)) links.push_back(std::move(link));
  return links;
}

std::shared_ptr<const ForceTerm> link_term(const LinkLaw& law, std::vector<LinkPlace> at_start,
                                           const Topology& scene) {
  return std::make_shared<const LinkTerm>(law, std::move(at_start), scene);
}

}  // namespace ropewalk
