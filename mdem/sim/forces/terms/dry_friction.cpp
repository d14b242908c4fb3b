#include "sim/forces/terms/dry_friction.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/contract.hpp"
#include "model/units.hpp"
#include "sim/neighbours/cell_grid.hpp"
#include "sim/threads/for_each.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {
namespace {

constexpr double begins_within = 0.42, ends_beyond = 0.47;  // nm between the walls
constexpr double begins_above = 0.5, ends_below = 0.4;      // cosine of the angle of the axes
constexpr double passes_on_beyond = 0.6;                    // fraction of an element, from its centre

double square(double x) { return x * x; }

// (cos, -sin) of the turn alpha of a tube against the line from a to b, which has this direction in the tube's
// frame.
struct Direction {
  double x = 1, y = 0;
};
// How much alpha has grown from one direction to another, within half a turn. The arc sine's series is exact to
// 1e-12.
double turned(const Direction& from, const Direction& to) {
  const double sine = from.y * to.x - from.x * to.y, cosine = from.x * to.x + from.y * to.y, q = sine * sine;
  if (cosine > 0 && q < 0.01)
    return sine * (1 + q * (1.0 / 6 + q * (3.0 / 40 + q * (15.0 / 336 + q * (105.0 / 3456)))));
  return std::atan2(sine, cosine);
}

// What a contact remembers. Its elastic slips were (z, y) where the pair was at `s`, `of_a`, `of_b`.
struct Contact {
  int a = 0, b = 0;  // places in this process
  double z = 0, y = 0, s = 0;
  Direction of_a, of_b;
  bool placed = false;  // s and the directions are known
  bool over = false;
};

// Two elements that may come into contact.
struct Candidate {
  int a = 0, b = 0;
  bool together = false, begins = false;  // they have a contact; they come into it
};

// Where a pair is. With the forces A on s and B on g, and w from a to b,
//   v_a = A along_a + B turning_a, v_b likewise:  force on a  v_a + v_b,  torque on a  w x v_a,  on b  w x v_b.
struct Pair {
  double s = 0, cosine = 1,
         across = 0;  // cosine of the axes' angle; nm from a's centre to b's, square of its part across the axes
  Direction of_a, of_b;
  Vector3 w, along_a, along_b, turning_a, turning_b;
  // Rate of a slip whose parts are v_a and v_b.
  double rate(const State& state, std::size_t a, std::size_t b, const Vector3& v_a, const Vector3& v_b) const {
    return (v_a + v_b).dot(state.velocity[a] - state.velocity[b]) + w.cross(v_a).dot(state.angular_velocity[a]) +
           w.cross(v_b).dot(state.angular_velocity[b]);
  }
};

// What a contact does: the force on a, the opposite one on b, and torques.
struct Action {
  Vector3 force = Vector3::Zero(), torque_a = Vector3::Zero(), torque_b = Vector3::Zero();
  double energy = 0, power = 0;
};

// A contact in the state of the evaluation.
struct Now {
  double z = 0, y = 0, s = 0;
  Direction of_a, of_b;
  bool apart = false;
  Action action;
};

class DryFrictionTerm : public ForceTerm {
 public:
  DryFrictionTerm(const DryFriction& law, const Topology& scene)
      : law_(law),
        tube_begin_(scene.tube_begin),
        stiffness_(12 * (std::max(law.axial, law.spin) * scene.longest_element() + 2 * law.end) / law.elastic_slip),
        damping_(law.drag * scene.longest_element() * most_rows(scene)) {}
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<DryFrictionTerm>(*this); }
  std::string name() const override { return "friction"; }
  std::string not_foreseen() const override { return "what tubes pull on one another by friction"; }

  void prepare(const ListedScene& scene) override {
    know(scene.topology, scene.state);
    take_up(scene.state);
    find_candidates(scene);
    if (!scene.again) drop_those_that_are_over();
    index();
    if (!scene.again) begin_contacts(scene.state);
  }

  void gather(const State& state) override {
    const auto elements = static_cast<std::ptrdiff_t>(state.size()),
               n = static_cast<std::ptrdiff_t>(contacts_.size());
    frames_.resize(state.size());
    now_.resize(contacts_.size());
    in_team(state.size() > parallel_from, [&] {
#pragma omp for schedule(static)
      for (std::ptrdiff_t i = 0; i < elements; ++i)
        frames_[static_cast<std::size_t>(i)] = frame_of(state.orientation[static_cast<std::size_t>(i)]);
#pragma omp for schedule(static)
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!contacts_[k].over) now_[k] = now_of(contacts_[k], state);
      }
    });
  }

  // Takes the contacts in blocks, whose sums are added up in their order whatever the threads.
  StateUpdate advance(double, const State& state) override {
    std::vector<Advanced> advanced((contacts_.size() + block - 1) / block);
    for_each(advanced.size(), contacts_.size() > parallel_from, [&](std::size_t b) {
      const std::size_t begin = b * block, end = std::min(begin + block, contacts_.size());
      for (std::size_t k = begin; k < end; ++k)
        if (!contacts_[k].over) advance(k, state, advanced[b]);
    });
    Advanced all;
    for (const Advanced& of : advanced) {
      all.update.lost += of.update.lost;
      all.update.events += of.update.events;
      all.others = all.others || of.others;
    }
    if (all.others) index();
    if (begin_contacts(state)) gather(state);
    return all.update;
  }

  TermSum add(const State&, const Segment& part, const ForceRows& out) const override {
    TermSum sum;
    for (int i = part.begin; i < part.end; ++i) {
      Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
      for (const int k : of_first_.of(i)) {
        const Action& action = now_[static_cast<std::size_t>(k)].action;
        force += action.force;
        torque += action.torque_a;
        sum.energy += action.energy;
        sum.power += action.power;
      }
      for (const int k : of_second_.of(i)) {
        const Action& action = now_[static_cast<std::size_t>(k)].action;
        force -= action.force;
        torque += action.torque_b;
      }
      out.force.add(static_cast<std::size_t>(i - out.origin), force);
      out.torque.add(static_cast<std::size_t>(i - out.origin), torque);
    }
    return sum;
  }

  // Six tubes around one, 2 K of two elements.
  double stiffness() const override { return stiffness_; }
  double damping() const override { return damping_; }

  bool remembers() const override { return true; }
  TermState memory() const override {
    TermState out;
    for (const Contact& c : contacts_)
      if (!c.over && element(c.a).own)
        out.push_back({element(c.a).number,
                       {static_cast<double>(element(c.b).number), c.z, c.y, c.s, c.of_a.x, c.of_a.y, c.of_b.x,
                        c.of_b.y, 1.0}});
    return out;
  }

  void set_memory(const TermState& memory) override {
    for (const TermRecord& r : memory) {
      const std::vector<double>& x = r.numbers;
      if (x.size() != 9 || !std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); }) ||
          !(x[0] >= 0 && x[0] < tube_begin_.back()) || x[0] != std::floor(x[0]) || (x[8] != 0 && x[8] != 1) ||
          (!law_.corrugated && std::hypot(x[1], x[2]) > 1.001 * law_.elastic_slip))
        throw std::runtime_error("the memory of friction is damaged");
    }
    remembered_ = memory;
    contacts_.clear();
  }

  // Both elements in the place of one have its slips, and find out anew which elements they face.
  TermState halved(const TermState& coarse, const std::vector<int>& heirs) const override {
    const bool last_has_two = heirs.back() == 2 * (static_cast<int>(heirs.size()) - 1) && tube_begin_.size() > 2;
    TermState fine;
    for (const TermRecord& r : coarse) {
      const auto e = static_cast<std::size_t>(r.element);
      TermRecord heir{heirs[e], r.numbers};
      heir.numbers[0] = heirs[static_cast<std::size_t>(r.numbers[0])];
      heir.numbers[8] = 0;
      fine.push_back(heir);
      ++heir.element;
      if (e + 1 < heirs.size() ? heirs[e + 1] != heir.element : last_has_two) fine.push_back(heir);
    }
    return fine;
  }

  std::size_t bytes() const override {
    return contacts_.size() * (sizeof(Contact) + sizeof(Now)) + candidates_.size() * sizeof(Candidate) +
           elements_.size() * sizeof(Frame);
  }

 private:
  static constexpr std::size_t block = 512;
  struct Advanced {
    StateUpdate update;
    bool others = false;  // elements of contacts have changed
  };
  // What a contact has to know of an element, since a scene may move in memory.
  struct Element {
    int number = 0;        // number in the scene
    std::size_t tube = 0;  // likewise
    int type = 0;
    bool own = true, ends_tube = false;
    double length = 0, radius = 0;  // nm
    int image = 0;                  // image in a slice: 1 above it, -1 below it, 0 in it
  };

  // The largest sum over a row of the drag's matrix over eta l, with six tubes at the distance d around one. The
  // two slips are orthogonal, and with the turns r w as lengths their rates are
  //   along the axis:  v_a - v_b + x (r w_a + r w_b),  x = d/(2 r);  six tubes turn half of it about each axis,
  //   against spin:    r w_a + r w_b + (v_a - v_b) 2 r/d,            2 r/d < 1.
  static double most_rows(const Topology& scene) {
    double x = 0;
    for (const TubeType& type : scene.types) x = std::max(x, 1 + 0.5 * begins_within / type.radius);
    return std::max(24.0, 6 * x * (1 + x));
  }

  // --- elements ---
  void know(const Topology& topology, const State& state) {
    elements_.resize(static_cast<std::size_t>(topology.elements()));
    frames_.resize(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) frames_[i] = frame_of(state.orientation[i]);
    for (int tube = 0; tube < topology.tubes(); ++tube) {
      const TubeType& type = topology.type_of(tube);
      for (int i = topology.tube_begin[static_cast<std::size_t>(tube)];
           i < topology.tube_begin[static_cast<std::size_t>(tube) + 1]; ++i) {
        const int number = topology.part ? topology.part->number[static_cast<std::size_t>(i)] : i;
        const std::size_t of_scene = tube_of(number);
        elements_[static_cast<std::size_t>(i)] = {
            number,
            of_scene,
            topology.tube_type[static_cast<std::size_t>(tube)],
            topology.owns(i),
            number == tube_begin_[of_scene] || number + 1 == tube_begin_[of_scene + 1],
            type.element_length,
            type.radius,
            image_of(topology, i)};
      }
    }
  }
  static int image_of(const Topology& topology, int i) {
    if (topology.groups.images == 0) return 0;
    const int original = topology.original_of(i);
    return original == i ? 0 : original < i ? 1 : -1;
  }
  // Once for a contact and its images in a slice: that of two of its elements, or of one and an image above it.
  bool is_counted(const Contact& c) const {
    const int of_a = element(c.a).image, of_b = element(c.b).image;
    return (of_a == 0 && of_b >= 0) || (of_b == 0 && of_a > 0);
  }
  const Element& element(int place) const { return elements_[static_cast<std::size_t>(place)]; }
  // -1: this process does not have it. Elements rise with their numbers.
  int place_of(int number) const {
    const auto at = std::lower_bound(elements_.begin(), elements_.end(), number,
                                     [](const Element& e, int n) { return e.number < n; });
    return at != elements_.end() && at->number == number ? static_cast<int>(at - elements_.begin()) : -1;
  }
  // Tube of the scene that has this element.
  std::size_t tube_of(int number) const {
    return static_cast<std::size_t>(std::upper_bound(tube_begin_.begin(), tube_begin_.end(), number) -
                                    tube_begin_.begin()) -
           1;
  }
  bool acts_between(int a, int b) const { return law_.types.have(element(a).type, element(b).type); }

  // --- a contact ---
  double stiff_along(const Contact& c) const {
    return (law_.axial * element(c.a).length + law_.end * (element(c.a).ends_tube + element(c.b).ends_tube)) /
           law_.elastic_slip;
  }
  double stiff_turning(const Contact& c) const { return law_.spin * element(c.a).length / law_.elastic_slip; }

  Pair pair_of(int first, int second, const State& state) const {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    const Frame &at_a = frames_[a], &at_b = frames_[b];
    Pair p;
    p.w = state.position[b] - state.position[a];
    p.cosine = at_a.t.dot(at_b.t);
    p.along_a = (p.cosine > 0 ? 0.5 : -0.5) * at_a.t;
    p.along_b = 0.5 * at_b.t;
    p.s = -(p.along_a + p.along_b).dot(p.w);
    p.across = p.w.squaredNorm() - p.s * p.s;
    const double r_b = elements_[b].radius;
    p.turning_a = turning_part(at_a, p.w, elements_[a].radius, p.of_a);
    p.turning_b = turning_part(at_b, p.w, p.cosine > 0 ? r_b : -r_b, p.of_b);
    return p;
  }
  // Turning part of arm alpha; `direction`: of w in the frame.
  static Vector3 turning_part(const Frame& frame, const Vector3& w, double arm, Direction& direction) {
    const double x = frame.e1.dot(w), y = frame.e2.dot(w), inverse = 1 / std::sqrt(std::max(x * x + y * y, 1e-12));
    direction = {x * inverse, y * inverse};
    const double by = arm * inverse;
    return by * direction.x * frame.e2 - by * direction.y * frame.e1;
  }
  static void place(Contact& c, const Pair& p) {
    c.s = p.s;
    c.of_a = p.of_a;
    c.of_b = p.of_b;
    c.placed = true;
  }

  // Potential of a slip, over the stiffness: nm^2, nm.
  struct Potential {
    double value = 0, slope = 0;
  };
  Potential potential(double z) const {
    if (!law_.corrugated) return {0.5 * z * z, z};
    const double delta = law_.elastic_slip;
    return {delta * delta * (1 - std::cos(z / delta)), delta * std::sin(z / delta)};
  }
  double periods(double z) const { return std::floor(z / (2 * units::pi * law_.elastic_slip) + 0.5); }

  // A slip that costs nothing is none.
  Now now_of(const Contact& c, const State& state) const {
    const Pair p = pair_of(c.a, c.b, state);
    const double stiff_s = stiff_along(c), stiff_g = stiff_turning(c), r_a = element(c.a).radius,
                 r_b = element(c.b).radius;
    Now now;
    now.s = p.s;
    now.apart = p.across > square(r_a + r_b + ends_beyond) || std::fabs(p.cosine) < ends_below;
    now.of_a = p.of_a;
    now.of_b = p.of_b;
    if (stiff_s > 0) now.z = c.z + p.s - c.s;
    if (stiff_g > 0)
      now.y = c.y + r_a * turned(c.of_a, p.of_a) + (p.cosine > 0 ? r_b : -r_b) * turned(c.of_b, p.of_b);
    const Potential of_z = potential(now.z), of_y = potential(now.y);
    double along = -stiff_s * of_z.slope, turning = -stiff_g * of_y.slope, power = 0;
    if (law_.drag > 0) {
      const auto a = static_cast<std::size_t>(c.a), b = static_cast<std::size_t>(c.b);
      const double eta = law_.drag * element(c.a).length, v = p.rate(state, a, b, p.along_a, p.along_b),
                   w = p.rate(state, a, b, p.turning_a, p.turning_b);
      along -= eta * v;
      turning -= eta * w;
      power = -eta * (v * v + w * w);
    }
    const Vector3 v_a = along * p.along_a + turning * p.turning_a, v_b = along * p.along_b + turning * p.turning_b;
    now.action = {v_a + v_b, p.w.cross(v_a), p.w.cross(v_b), stiff_s * of_z.value + stiff_g * of_y.value, power};
    return now;
  }

  void advance(std::size_t k, const State& state, Advanced& all) {
    Contact& c = contacts_[k];
    Now& now = now_[k];
    const double squared = now.z * now.z + now.y * now.y;
    const double limit = law_.elastic_slip * law_.elastic_slip;
    double lost = 0;
    bool acts_otherwise = false, begins_to_slide = false;
    if (law_.corrugated) {
      begins_to_slide = periods(now.z) != periods(c.z) || periods(now.y) != periods(c.y);
    } else if (squared > limit) {
      begins_to_slide = c.z * c.z + c.y * c.y < (1 - 1e-9) * limit;
      const double part = law_.elastic_slip / std::sqrt(squared), stiff_s = stiff_along(c),
                   stiff_g = stiff_turning(c);
      // The work of sliding under the strength.
      lost = (stiff_s * now.z * now.z + stiff_g * now.y * now.y) * part * (1 - part);
      now.z *= part;
      now.y *= part;
      acts_otherwise = true;
    }
    c.z = now.z;
    c.y = now.y;
    c.s = now.s;
    c.of_a = now.of_a;
    c.of_b = now.of_b;
    if (std::fabs(c.s) > passes_on_beyond * element(c.b).length) {
      all.others = acts_otherwise = true;
      c.over = !pass_on(c, state);
    }
    if (now.apart) all.others = c.over = true;
    if (c.over) {
      lost += stiff_along(c) * potential(c.z).value + stiff_turning(c) * potential(c.y).value;
      c.z = c.y = 0;
    } else if (acts_otherwise) {
      now = now_of(c, state);
    }
    if (!element(c.a).own) return;
    all.update.lost += lost;
    all.update.events += begins_to_slide && is_counted(c);
  }

  // To the element of b's tube that a faces now. The slips stay. False: there is none.
  bool pass_on(Contact& c, const State& state) const {
    for (;;) {
      const int step = c.s > 0 ? 1 : -1, number = element(c.b).number + step;
      if (number < 0 || number >= tube_begin_.back() || tube_of(number) != tube_of(element(c.b).number))
        return false;
      const int next = place_of(number);
      if (next < 0) return false;
      const Pair p = pair_of(c.a, next, state);
      if (std::fabs(p.s) >= std::fabs(c.s)) return std::fabs(c.s) <= passes_on_beyond * element(c.b).length;
      c.b = next;
      place(c, p);
      if (std::fabs(c.s) <= 0.5 * element(next).length) return true;
    }
  }

  // --- all contacts ---
  // The records of a memory become contacts, where this process has both elements. Those of other processes count
  // as well: a contact may pass on to an own element, and the tube of an own element may have a contact already.
  void take_up(const State& state) {
    for (const TermRecord& r : remembered_) {
      Contact c{place_of(r.element),
                place_of(static_cast<int>(r.numbers[0])),
                r.numbers[1],
                r.numbers[2],
                r.numbers[3],
                {r.numbers[4], r.numbers[5]},
                {r.numbers[6], r.numbers[7]},
                r.numbers[8] == 1,
                false};
      if (c.a < 0 || c.b < 0) continue;
      if (!c.placed) {
        place(c, pair_of(c.a, c.b, state));
        if (std::fabs(c.s) > 0.5 * element(c.b).length && !pass_on(c, state)) continue;
      }
      contacts_.push_back(c);
    }
    remembered_.clear();
  }

  void drop_those_that_are_over() {
    contacts_.erase(std::remove_if(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.over; }),
                    contacts_.end());
  }

  // Pairs that may come into contact before the next list, those of two copies among them. The places are those that
  // the list was built for: a resumed run finds the same pairs. The list has the pairs of own elements alone.
  void find_candidates(const ListedScene& scene) {
    candidates_.clear();
    const Topology& topology = scene.topology;
    const Vec3Array& listed = scene.list.reference();
    const double half = 0.5 * topology.longest_element(), skin = scene.list.skin;
    const auto take = [&](int i, int j) {
      if (!acts_between(i, j)) return;
      const double reach = std::hypot(element(i).radius + element(j).radius + begins_within, half) + skin;
      const Vector3 w = listed[static_cast<std::size_t>(j)] - listed[static_cast<std::size_t>(i)];
      if (w.squaredNorm() < square(reach)) candidates_.push_back({i, j});
    };
    for (int i = 0; i < topology.elements(); ++i)
      if (element(i).own) scene.list.for_neighbours(i, [&](int j) { take(i, j); });
    if (topology.part) {
      const CellGrid grid(listed, std::hypot(2 * topology.largest_radius() + begins_within, half) + skin);
      std::vector<int> found;
      for (int tube = 0; tube < topology.tubes(); ++tube) {
        const int excluded = topology.type_of(tube).elements_within(scene.list.excluded_arc);
        for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i) {
          if (element(i).own) continue;
          const std::size_t count = grid.find(i, topology.last_within(excluded, i, tube), found);
          for (std::size_t k = 0; k < count; ++k) take(i, found[k]);
        }
      }
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& x, const Candidate& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  }

  // Those candidates whose tubes have come together. Whether there are any.
  bool begin_contacts(const State& state) {
    for_each((candidates_.size() + block - 1) / block, candidates_.size() > parallel_from, [&](std::size_t b) {
      for (std::size_t k = b * block, end = std::min(k + block, candidates_.size()); k < end; ++k) {
        Candidate& c = candidates_[k];
        if (c.together) continue;
        const Pair p = pair_of(c.a, c.b, state);
        c.begins = p.across < square(element(c.a).radius + element(c.b).radius + begins_within) &&
                   std::fabs(p.cosine) > begins_above && std::fabs(p.s) <= 0.5 * element(c.b).length;
      }
    });
    const std::size_t before = contacts_.size();
    for (const Candidate& c : candidates_) {
      if (c.together || !c.begins) continue;
      // If two elements of a tube are equally near, the contact is with the first.
      const bool second = contacts_.size() > before && contacts_.back().a == c.a && are_one(contacts_.back(), c);
      if (second) continue;
      Contact contact;
      contact.a = c.a;
      contact.b = c.b;
      place(contact, pair_of(c.a, c.b, state));
      contacts_.push_back(contact);
    }
    if (contacts_.size() == before) return false;
    drop_those_that_are_over();
    std::stable_sort(contacts_.begin(), contacts_.end(),
                     [](const Contact& x, const Contact& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
    index();
    return true;
  }
  // One element has one contact with a tube in one place.
  bool are_one(const Contact& contact, const Candidate& c) const {
    return element(contact.b).tube == element(c.b).tube &&
           std::abs(element(contact.b).number - element(c.b).number) <= 2;
  }

  void index() {
    const auto whole = [&](std::size_t k, int end) { return contacts_[k].over ? -1 : end; };
    of_first_.sort_in(elements_.size(), contacts_.size(), [&](std::size_t k) { return whole(k, contacts_[k].a); });
    of_second_.sort_in(elements_.size(), contacts_.size(), [&](std::size_t k) { return whole(k, contacts_[k].b); });
    for (Candidate& c : candidates_) {
      const auto contacts = of_first_.of(c.a);
      c.together = std::any_of(contacts.begin(), contacts.end(),
                               [&](int k) { return are_one(contacts_[static_cast<std::size_t>(k)], c); });
    }
  }

  DryFriction law_;
  std::vector<int> tube_begin_;  // first elements of the scene's tubes
  double stiffness_ = 0, damping_ = 0;
  std::vector<Element> elements_;
  TermState remembered_;  // until the next list
  std::vector<Contact> contacts_;
  std::vector<Candidate> candidates_;  // sorted by a, then b
  std::vector<Frame> frames_;          // frames of the elements in the state of the evaluation
  std::vector<Now> now_;               // state of the contacts, likewise
  Rows of_first_, of_second_;          // contacts by a and by b
};

}  // namespace

std::shared_ptr<const ForceTerm> dry_friction_term(const DryFriction& law, const Topology& scene) {
  return std::make_shared<const DryFrictionTerm>(law, scene);
}

}  // namespace ropewalk
