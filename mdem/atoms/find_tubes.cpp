#include "atoms/find_tubes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "atoms/bond_graph.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t smallest_wall = 60;     // atoms
constexpr std::size_t smallest_sheet = 100;   // atoms, to be counted as such
constexpr double whole_part = 0.85;           // of the sites near an end, where a tube begins
constexpr double window = 0.4;                // width of the window in which they are counted, nm
constexpr double shortest_circumference = 5;  // lattice constants, of tubes with a radius of 0.2 nm
constexpr double longest_burgers = 12;  // lattice constants: a longer mismatch is no defect but a second closure
constexpr std::uint32_t nobody = 0xffffffff;

enum class Kind : unsigned char { other, edge, regular };

long floored(long a, long b) { return a / b - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0); }

struct Vector {  // lattice vector
  int p = 0, q = 0;
  bool operator<(const Vector& o) const { return std::tie(p, q) < std::tie(o.p, o.q); }
  bool zero() const { return p == 0 && q == 0; }
  Vector minus() const { return {-p, -q}; }
  // Turned by 60 degrees.
  Vector turned() const { return {-q, p + q}; }
  Vector mirrored() const { return {q, p}; }
  double length() const {
    return std::sqrt(static_cast<double>(p) * p + static_cast<double>(p) * q + static_cast<double>(q) * q);
  }
};

// The same of sites: a turn about the middle of a hexagon, which swaps the sublattices; and a mirror that keeps
// them.
Site turned(const Site& s) {
  const int third = s.second ? 1 : 0;
  const int p = -(3 * s.j + third) - 2, q = 3 * s.i + third + 3 * s.j + third + 1;
  const bool second = ((p % 3) + 3) % 3 == 1;
  return {static_cast<int>(floored(p, 3)), static_cast<int>(floored(q, 3)), second};
}
Site mirrored(const Site& s) { return {s.j, s.i, s.second}; }

// The site behind bond `type`. The bonds of each sublattice follow one another counterclockwise, seen from outside.
Site behind(const Site& s, int type) {
  const int by = s.second ? 1 : -1;
  return {s.i + (type == 1 ? by : 0), s.j + (type == 2 ? by : 0), !s.second};
}

// Sites between 0 and one turn of the circumference, so that equal ones are equal.
Site reduced(Chirality c, Site s) {
  const auto arc = [&](long p, long q) { return p * (2L * c.n + c.m) + q * (2L * c.m + c.n); };
  const long turns = floored(arc(s.i, s.j), arc(c.n, c.m));
  s.i -= static_cast<int>(turns) * c.n;
  s.j -= static_cast<int>(turns) * c.m;
  return s;
}

double reach_of_bonds(const Honeycomb& h) { return h.carbon() ? carbon_bond : 1.27 * h.bond_length(); }

class Search {
 public:
  Search(const std::vector<Vector3>& positions, const std::vector<char>& species, const AtomBox& box,
         const std::string& file, const Honeycomb& honeycomb)
      : raw_(positions),
        species_(species),
        honeycomb_(honeycomb),
        box_(box),
        file_(file),
        nearest_(box),
        graph_(positions, species, box, file, reach_of_bonds(honeycomb)),
        kind_(positions.size(), Kind::other),
        odd_rings_(positions.size(), {0, 0}),
        labelled_(positions.size(), 0),
        site_(positions.size()),
        slot_(positions.size(), {-1, -1, -1}),
        normal_(positions.size()) {
    found_.positions = positions;
  }

  FoundTubes go() {
    for (std::size_t i = 0; i < raw_.size(); ++i)
      if (species_[i]) classify(i);
    std::vector<char> seen(raw_.size(), 0);
    for (std::size_t i = 0; i < raw_.size(); ++i)
      if (species_[i] && !seen[i]) wall(connected(i, seen));
    if (found_.tubes.empty())
      throw InputError({file_, 0, ""}, fmt::format("has no {} nanotube in it", name()),
                       found_.sheets > 0
                           ? fmt::format("{} connected part{} of {} that {} closed around no axis", found_.sheets,
                                         found_.sheets == 1 ? "" : "s", name(), found_.sheets == 1 ? "is" : "are")
                           : fmt::format("lengths must be in Angstrom, and bonds of {} shorter than {:.3g} of them",
                                         name(), 10 * reach_of_bonds(honeycomb_)));
    gather();
    sort();
    return std::move(found_);
  }

 private:
  std::string name() const { return honeycomb_.carbon() ? "carbon" : honeycomb_.name; }

  // Whether more atoms stand on the sublattice of the other species than on their own.
  bool sublattices_swapped(const std::vector<std::uint32_t>& wall) const {
    long balance = 0;
    for (const std::uint32_t i : wall)
      if (labelled_[i]) balance += (species_[i] == 2) == site_[i].second ? 1 : -1;
    return balance < 0;
  }

  // The smallest ring through the bonds of atom a to b and c: 3 to 7; 0: there is none.
  int ring(std::size_t a, std::size_t b, std::size_t c) const {
    int smallest = 0;
    const auto take = [&](int size) { smallest = smallest == 0 ? size : std::min(smallest, size); };
    if (graph_.bonded(b, c)) return 3;
    for (int k = 0; k < graph_.kept(b); ++k) {
      const std::size_t x = graph_.neighbour(b, k);
      if (x == a) continue;
      for (int l = 0; l < graph_.kept(c); ++l) {
        const std::size_t z = graph_.neighbour(c, l);
        if (z == a) continue;
        if (x == z) {
          take(4);
          continue;
        }
        if (graph_.bonded(x, z)) take(5);
        for (int m = 0; m < graph_.kept(x); ++m) {
          const std::size_t y = graph_.neighbour(x, m);
          if (y != b && y != a && y != c && graph_.bonded(y, z)) take(6);
        }
      }
    }
    if (smallest != 0) return smallest;
    for (int k = 0; k < graph_.kept(b); ++k)
      for (int l = 0; l < graph_.kept(c); ++l) {
        const std::size_t x = graph_.neighbour(b, k), z = graph_.neighbour(c, l);
        if (x == a || z == a) continue;
        for (int m = 0; m < graph_.kept(x); ++m)
          for (int n = 0; n < graph_.kept(z); ++n) {
            const std::size_t y = graph_.neighbour(x, m), w = graph_.neighbour(z, n);
            if (y != b && w != c && y != w && graph_.bonded(y, w)) return 7;
          }
      }
    return 0;
  }

  void classify(std::size_t i) {
    const int n = graph_.count(i);
    if (n < 2 || n > 3) return;
    bool all_six = true, only_six = true;
    for (int k = 0; k < n; ++k)
      for (int l = k + 1; l < n; ++l) {
        const int size = ring(i, graph_.neighbour(i, k), graph_.neighbour(i, l));
        all_six = all_six && size == 6;
        only_six = only_six && (size == 6 || size == 0);
        if (size == 5) ++odd_rings_[i][0];
        if (size == 7) ++odd_rings_[i][1];
      }
    kind_[i] = n == 3 && all_six ? Kind::regular : only_six ? Kind::edge : Kind::other;
  }

  std::vector<std::uint32_t> connected(std::size_t start, std::vector<char>& seen) const {
    std::vector<std::uint32_t> all = {static_cast<std::uint32_t>(start)};
    seen[start] = 1;
    for (std::size_t n = 0; n < all.size(); ++n)
      for (int k = 0; k < graph_.kept(all[n]); ++k) {
        const std::uint32_t j = graph_.neighbour(all[n], k);
        if (!seen[j]) {
          seen[j] = 1;
          all.push_back(j);
        }
      }
    return all;
  }

  // An atom of the largest part of a wall whose regular atoms are bonded to one another.
  std::uint32_t seed_of(const std::vector<std::uint32_t>& wall) {
    std::uint32_t best = nobody;
    std::size_t most = 0;
    std::vector<std::uint32_t> part;
    for (const std::uint32_t start : wall) {
      if (kind_[start] != Kind::regular || labelled_[start]) continue;
      part.assign(1, start);
      labelled_[start] = 1;
      for (std::size_t n = 0; n < part.size(); ++n)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t j = graph_.neighbour(part[n], k);
          if (kind_[j] != Kind::regular || labelled_[j]) continue;
          labelled_[j] = 1;
          part.push_back(j);
        }
      if (part.size() > most) {
        most = part.size();
        best = start;
      }
    }
    for (const std::uint32_t i : wall) labelled_[i] = 0;
    return best;
  }

  Vector3 bond(std::size_t from, std::size_t to) const { return nearest_(raw_[to] - raw_[from]); }

  // Atom `to`, which bond `type` leads to: its site, its place, and the order of its bonds.
  void label(std::uint32_t from, std::uint32_t to, int type) {
    labelled_[to] = 1;
    site_[to] = behind(site_[from], type);
    found_.positions[to] = found_.positions[from] + bond(from, to);
    if (graph_.count(to) > 3) return;
    std::array<int, 2> others = {-1, -1};
    int back = -1, n = 0;
    for (int k = 0; k < graph_.kept(to); ++k) {
      if (graph_.neighbour(to, k) == from)
        back = k;
      else if (n < 2)
        others[static_cast<std::size_t>(n++)] = k;
    }
    slot_[to][static_cast<std::size_t>(type)] = static_cast<signed char>(back);
    normal_[to] = normal_[from];
    if (n == 0) return;
    const Vector3 a = bond(to, from), b = bond(to, graph_.neighbour(to, others[0]));
    Vector3 normal = a.cross(b);
    if (n == 2) {
      const Vector3 c = bond(to, graph_.neighbour(to, others[1]));
      normal += b.cross(c) + c.cross(a);
    }
    const bool in_order = normal.dot(normal_[from].cast<double>()) > 0;
    normal_[to] = ((in_order ? 1.0 : -1.0) * normal.normalized()).cast<float>();
    const auto next = static_cast<std::size_t>((type + (in_order ? 1 : 2)) % 3),
               after = static_cast<std::size_t>((type + (in_order ? 2 : 1)) % 3);
    slot_[to][next] = static_cast<signed char>(others[0]);
    if (n == 2) slot_[to][after] = static_cast<signed char>(others[1]);
  }

  void carry_sites(std::uint32_t seed) {
    labelled_[seed] = 1;
    site_[seed] = {0, 0, false};
    const Vector3 a = bond(seed, graph_.neighbour(seed, 0)), b = bond(seed, graph_.neighbour(seed, 1)),
                  c = bond(seed, graph_.neighbour(seed, 2));
    normal_[seed] = (a.cross(b) + b.cross(c) + c.cross(a)).normalized().cast<float>();
    slot_[seed] = {0, 1, 2};
    std::vector<std::uint32_t> regular = {seed}, edges;
    const auto hand_on = [&](std::uint32_t i, std::vector<std::uint32_t>& queue) {
      for (int type = 0; type < 3; ++type) {
        const int k = slot_[i][static_cast<std::size_t>(type)];
        if (k < 0) continue;
        const std::uint32_t j = graph_.neighbour(i, k);
        if (labelled_[j]) continue;
        label(i, j, type);
        if (kind_[j] == Kind::regular)
          queue.push_back(j);
        else if (kind_[j] == Kind::edge)
          edges.push_back(j);
      }
    };
    for (std::size_t n = 0; n < regular.size(); ++n) hand_on(regular[n], regular);
    // Only then over the atoms beside holes and ends.
    for (std::size_t n = 0; n < edges.size(); ++n) hand_on(edges[n], edges);
  }

  struct Closures {
    Vector around;            // zero: there is none
    Vector along;             // period of an endless tube
    Vector3 period{0, 0, 0};  // nm: the site that lies `along` further is here
    bool ring = false;
  };

  // The closures follow bonds between regular atoms, or also those beside holes.
  Closures closures(const std::vector<std::uint32_t>& wall, bool over_edges) const {
    std::map<Vector, long> around;
    std::map<Vector, std::pair<long, Vector3>> along;
    const auto counts = [&](std::uint32_t i) {
      return labelled_[i] && (kind_[i] == Kind::regular || (over_edges && kind_[i] == Kind::edge));
    };
    for (const std::uint32_t i : wall) {
      if (!counts(i)) continue;
      for (int type = 0; type < 3; ++type) {
        const int slot = slot_[i][static_cast<std::size_t>(type)];
        if (slot < 0) continue;
        const std::uint32_t j = graph_.neighbour(i, slot);
        if (j < i || !counts(j)) continue;
        const Site expected = behind(site_[i], type);
        const int back = slot_[j][static_cast<std::size_t>(type)];
        if (expected.second != site_[j].second || back < 0 || graph_.neighbour(j, back) != i) continue;
        Vector w{expected.i - site_[j].i, expected.j - site_[j].j};
        if (w.zero()) continue;
        Vector3 gap = found_.positions[i] + bond(i, j) - found_.positions[j];
        if (w < Vector{}) {
          w = w.minus();
          gap = -gap;
        }
        if (gap.norm() < 0.05) {
          ++around[w];
        } else {
          auto& [votes, period] = along[w];
          ++votes;
          period = gap;
        }
      }
    }
    Closures out;
    long most = 0;
    for (const auto& [w, votes] : around)
      if (votes > most && (!over_edges || w.length() > shortest_circumference)) {
        most = votes;
        out.around = w;
      }
    if (most == 0) return out;
    for (const auto& [w, votes] : around) {
      const long across = static_cast<long>(out.around.p) * w.q - static_cast<long>(out.around.q) * w.p;
      out.ring = out.ring || (across != 0 && w.length() > longest_burgers && votes > 2);
    }
    most = 0;
    for (const auto& [w, voted] : along)
      if (voted.first > most) {
        most = voted.first;
        out.along = w;
        out.period = voted.second;
      }
    return out;
  }

  // Turns or mirrors sites and closures alike.
  template <class OfSite, class OfVector>
  void change(const std::vector<std::uint32_t>& wall, Closures& c, const OfSite& of_site,
              const OfVector& of_vector) {
    for (const std::uint32_t i : wall)
      if (labelled_[i]) site_[i] = of_site(site_[i]);
    c.around = of_vector(c.around);
    c.along = of_vector(c.along);
  }

  bool normals_point_outwards(const std::vector<std::uint32_t>& wall) const {
    double sum = 0;
    for (const std::uint32_t i : wall)
      if (labelled_[i] && kind_[i] == Kind::regular)
        for (int k = 0; k < 3; ++k) sum -= normal_[i].cast<double>().dot(bond(i, graph_.neighbour(i, k)));
    return sum > 0;
  }

  // The way along which the heights of a tube rise.
  Vector3 rise(const std::vector<std::uint32_t>& wall, Chirality c) const {
    double mean = 0, n = 0;
    Vector3 middle = Vector3::Zero();
    for (const std::uint32_t i : wall)
      if (labelled_[i]) {
        mean += static_cast<double>(height_in_thirds(c, site_[i]));
        middle += found_.positions[i];
        ++n;
      }
    mean /= n;
    middle /= n;
    Vector3 sum = Vector3::Zero();
    for (const std::uint32_t i : wall)
      if (labelled_[i])
        sum += (static_cast<double>(height_in_thirds(c, site_[i])) - mean) * (found_.positions[i] - middle);
    return sum;
  }

  void wall(const std::vector<std::uint32_t>& wall) {
    const std::uint32_t seed = wall.size() < smallest_wall ? nobody : seed_of(wall);
    Closures c;
    if (seed != nobody) {
      carry_sites(seed);
      c = closures(wall, false);
      // Holes may lie side by side from one end of a short tube to the other.
      if (c.around.zero()) c = closures(wall, true);
    }
    if (c.around.zero()) {
      found_.loose += static_cast<long>(wall.size());
      if (wall.size() > smallest_sheet) ++found_.sheets;
      for (const std::uint32_t i : wall) labelled_[i] = 0;
      return;
    }
    if (c.ring)
      throw InputError({file_, 0, ""},
                       fmt::format("the tube of {} atoms around ({:.2f}, {:.2f}, {:.2f}) nm bites its tail",
                                   wall.size(), raw_[seed].x(), raw_[seed].y(), raw_[seed].z()),
                       "a chain of elements has two ends: take away a few rings of its atoms");
    if (!normals_point_outwards(wall)) change(wall, c, mirrored, [](const Vector& v) { return v.mirrored(); });
    const auto turn = [&] { change(wall, c, turned, [](const Vector& v) { return v.turned(); }); };
    while (!(c.around.p > 0 && c.around.q >= 0)) turn();
    FoundTube tube;
    tube.chirality = {c.around.p, c.around.q};
    Vector3 way = rise(wall, tube.chirality);
    if (!way_) {
      Eigen::Index largest = 0;
      way.cwiseAbs().maxCoeff(&largest);
      way_ = way[largest] < 0 ? Vector3(-way) : way;
    }
    if (honeycomb_.one_species() ? way.dot(*way_) < 0 : sublattices_swapped(wall)) {
      // Upside down the circumference points the other way: the same tube, whose heights rise the other way.
      for (int k = 0; k < 3; ++k) turn();
      c.around = c.around.minus();
    }
    if (!c.along.zero()) cut_endless(wall, tube, c);
    refuse_doubles(wall, tube.chirality);
    take_atoms(wall, tube);
    count_defects(wall, tube);
    found_.tubes.push_back(std::move(tube));
  }

  // Sites and places of all atoms between a row and the one that is one period higher.
  void cut_endless(const std::vector<std::uint32_t>& wall, FoundTube& tube, Closures& c) {
    const auto height_of = [&](const Vector& v) {
      return 3 * (static_cast<long>(tube.chirality.n) * v.q - static_cast<long>(tube.chirality.m) * v.p);
    };
    long period = height_of(c.along);
    if (period == 0) return;  // closes sideways: not an endless tube
    if (period < 0) {
      c.along = c.along.minus();
      c.period = -c.period;
      period = -period;
    }
    const Vector3 parts = box_.inverse() * c.period;
    Eigen::Index edge = 0;
    parts.cwiseAbs().maxCoeff(&edge);
    double lowest = 2;
    long cut = 0;
    for (const std::uint32_t i : wall) {
      if (!labelled_[i] || site_[i].second) continue;
      const Vector3 at = box_.inverse() * (raw_[i] - box_.origin);
      double inside = at[edge] - std::floor(at[edge]);
      if (parts[edge] < 0) inside = 1 - inside;
      if (inside < lowest) {
        lowest = inside;
        cut = height_in_thirds(tube.chirality, site_[i]);
      }
    }
    for (const std::uint32_t i : wall) {
      if (!labelled_[i]) continue;
      const long periods = floored(height_in_thirds(tube.chirality, site_[i]) - cut, period);
      site_[i].i -= static_cast<int>(periods) * c.along.p;
      site_[i].j -= static_cast<int>(periods) * c.along.q;
      found_.positions[i] -= static_cast<double>(periods) * c.period;
    }
    tube.endless = true;
  }

  void refuse_doubles(const std::vector<std::uint32_t>& wall, Chirality c) {
    std::vector<std::tuple<int, int, bool, std::uint32_t>> all;
    for (const std::uint32_t i : wall)
      if (labelled_[i]) {
        site_[i] = reduced(c, site_[i]);
        all.emplace_back(site_[i].i, site_[i].j, site_[i].second, i);
      }
    std::sort(all.begin(), all.end());
    const auto same = [&](std::size_t a, std::size_t b) {
      return std::get<0>(all[a]) == std::get<0>(all[b]) && std::get<1>(all[a]) == std::get<1>(all[b]) &&
             std::get<2>(all[a]) == std::get<2>(all[b]);
    };
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
      if (same(k, k + 1)) labelled_[std::get<3>(all[k])] = labelled_[std::get<3>(all[k + 1])] = 0;
  }

  void take_atoms(const std::vector<std::uint32_t>& wall, FoundTube& tube) const {
    for (const std::uint32_t i : wall) {
      if (labelled_[i])
        tube.atoms.push_back({i, site_[i]});
      else
        ++tube.without_site;
      tube.centre += found_.positions[i] / static_cast<double>(wall.size());
    }
    trim(tube);
  }

  void count_defects(const std::vector<std::uint32_t>& wall, FoundTube& tube) const {
    const long reach = 3 * static_cast<long>(std::ceil(window / rolled_shape(tube.chirality).length_per_hexagon));
    Vector3 low = Vector3::Zero(), high = Vector3::Zero();
    double n_low = 0, n_high = 0;
    for (const LabelledAtom& atom : tube.atoms) {
      const long h = height_in_thirds(tube.chirality, atom.site);
      if (h < reach) {
        low += found_.positions[atom.atom];
        ++n_low;
      }
      if (h >= tube.top - reach) {
        high += found_.positions[atom.atom];
        ++n_high;
      }
      if (graph_.count(atom.atom) == 2 && (tube.endless || (h >= reach && h < tube.top - reach))) ++tube.open_atoms;
    }
    long fives = 0, sevens = 0, fives_low = 0, fives_high = 0;
    if (n_low > 0) low /= n_low;
    if (n_high > 0) high /= n_high;
    const double near = 2 * tube_radius(tube.chirality) + 0.5;
    for (const std::uint32_t i : wall) {
      fives += odd_rings_[i][0];
      sevens += odd_rings_[i][1];
      if (graph_.count(i) > 3) ++tube.crowded;
      if (odd_rings_[i][0] == 0) continue;
      const double to_low = (raw_[i] - low).norm(), to_high = (raw_[i] - high).norm();
      if (to_low < near && to_low <= to_high) fives_low += odd_rings_[i][0];
      if (to_high < near && to_high < to_low) fives_high += odd_rings_[i][0];
    }
    tube.pentagons = fives / 5;
    tube.heptagons = sevens / 7;
    tube.cap_below = fives_low / 5 >= 5;
    tube.cap_above = fives_high / 5 >= 5;
  }

  // Images of whole tubes that lie together: each one as near as it can be to one that has its place already.
  void gather() {
    std::vector<FoundTube>& tubes = found_.tubes;
    struct Way {
      double distance = 1e300;
      Vector3 shift{0, 0, 0};
    };
    std::vector<Way> ways(tubes.size());
    std::vector<char> placed(tubes.size(), 0);
    for (std::size_t n = 0, now = 0; n < tubes.size(); ++n) {
      placed[now] = 1;
      std::size_t next = now;
      double least = 1e301;
      for (std::size_t t = 0; t < tubes.size(); ++t) {
        if (placed[t]) continue;
        const Vector3 apart = tubes[t].centre - tubes[now].centre, image = nearest_(apart);
        if (image.norm() < ways[t].distance) ways[t] = {image.norm(), image - apart};
        if (ways[t].distance < least) {
          least = ways[t].distance;
          next = t;
        }
      }
      if (next == now) return;
      now = next;
      tubes[now].centre += ways[now].shift;
      for (const LabelledAtom& atom : tubes[now].atoms) found_.positions[atom.atom] += ways[now].shift;
    }
  }

  void sort() {
    Vector3 middle = Vector3::Zero();
    for (const FoundTube& t : found_.tubes) middle += t.centre / static_cast<double>(found_.tubes.size());
    const Vector3 way = way_->normalized();
    const Vector3 x = way.unitOrthogonal(), y = way.cross(x);
    const auto key = [&](const FoundTube& t) {
      const Vector3 from = t.centre - middle;
      const double a = from.dot(x), b = from.dot(y), r = std::hypot(a, b);
      return std::make_tuple(std::llround(r / 0.1), std::atan2(b, a), from.dot(way));
    };
    std::stable_sort(found_.tubes.begin(), found_.tubes.end(),
                     [&](const FoundTube& a, const FoundTube& b) { return key(a) < key(b); });
  }

  const std::vector<Vector3>& raw_;
  const std::vector<char>& species_;
  const Honeycomb& honeycomb_;
  AtomBox box_;
  std::string file_;
  NearestImage nearest_;
  BondGraph graph_;
  std::vector<Kind> kind_;
  std::vector<std::array<unsigned char, 2>> odd_rings_;  // angles of pentagons and of heptagons
  std::vector<char> labelled_;
  std::vector<Site> site_;
  std::vector<std::array<signed char, 3>> slot_;  // which neighbour bond 0, 1, 2 leads to; -1: none
  std::vector<Eigen::Vector3f> normal_;
  std::optional<Vector3> way_;
  FoundTubes found_;
};

}  // namespace

void trim(FoundTube& tube) {
  const Chirality c = tube.chirality;
  std::vector<long> heights;
  for (const LabelledAtom& atom : tube.atoms) heights.push_back(height_in_thirds(c, atom.site));
  std::sort(heights.begin(), heights.end());
  const SiteRows rows(c);
  const long reach = 3 * static_cast<long>(std::ceil(window / rolled_shape(c).length_per_hexagon));
  const auto is_whole = [&](long from, long to) {
    const auto there = std::lower_bound(heights.begin(), heights.end(), to) -
                       std::lower_bound(heights.begin(), heights.end(), from);
    return static_cast<double>(there) >= whole_part * static_cast<double>(rows.sites_between(from, to));
  };
  const auto lowest =
      std::find_if(heights.begin(), heights.end(), [&](long height) { return is_whole(height, height + reach); });
  const auto highest = std::find_if(heights.rbegin(), heights.rend(),
                                    [&](long height) { return is_whole(height + 1 - reach, height + 1); });
  const bool any = lowest != heights.end() && highest != heights.rend() && *highest >= *lowest;
  // The first site is one of the first sublattice, whose rows have multiples of this height: that of the lowest
  // row, or of the one just below it, where an upside-down tube has no atoms.
  const long row = 3L * std::gcd(c.n, c.m), bottom = any ? floored(*lowest, row) * row : 0;
  const LatticeVector origin = vector_of_height(c, bottom / 3);
  tube.top = any ? *highest + 1 - bottom : 0;
  std::vector<LabelledAtom> kept;
  for (const LabelledAtom& atom : tube.atoms) {
    const Site site = reduced(c, {atom.site.i - origin.p, atom.site.j - origin.q, atom.site.second});
    const long height = height_in_thirds(c, site);
    if (any && height >= *lowest - bottom && height < tube.top) kept.push_back({atom.atom, site});
  }
  tube.without_site += static_cast<long>(tube.atoms.size() - kept.size());
  tube.atoms = std::move(kept);
}

void turn_sites(FoundTube& tube, int parts) {
  const Chirality c = tube.chirality;
  const int g = std::gcd(c.n, c.m);
  for (LabelledAtom& atom : tube.atoms)
    atom.site = reduced(c, {atom.site.i - parts * (c.n / g), atom.site.j - parts * (c.m / g), atom.site.second});
}

FoundTubes find_tubes(const std::vector<Vector3>& positions, const std::vector<char>& species, const AtomBox& box,
                      const std::string& file, const Honeycomb& honeycomb) {
  return Search(positions, species, box, file, honeycomb).go();
}

}  // namespace ropewalk
