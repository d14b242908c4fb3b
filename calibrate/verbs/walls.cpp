#include "verbs/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atomistic/walls.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

double spacing(Chirality inside, Chirality outside) { return tube_radius(outside) - tube_radius(inside); }

// Armchair and zigzag walls up to a radius (nm).
std::vector<Chirality> simple_walls(double largest) {
  std::vector<Chirality> out;
  for (int n = 2; tube_radius({n, 0}) <= largest; ++n) {
    out.push_back({n, 0});
    if (tube_radius({n, n}) <= largest) out.push_back({n, n});
  }
  return out;
}

// The wall outside of this one at the distance nearest to that of graphite.
Chirality fitting_outside(Chirality inside) {
  Chirality best = inside;
  double least = 1e9;
  for (const Chirality c : simple_walls(tube_radius(inside) + most_wall_spacing))
    if (const double off = std::fabs(spacing(inside, c) - graphite_spacing); off < least) best = c, least = off;
  return best;
}

}  // namespace

std::string walls_text(const std::vector<Chirality>& walls) {
  std::string text;
  for (const Chirality c : walls) text += fmt::format("{}({},{})", text.empty() ? "" : "@", c.n, c.m);
  return text;
}

std::string walls_summary(const std::vector<Chirality>& walls) {
  std::string text =
      fmt::format("{}: {:.3f} nm wide, walls", walls_text(walls), 2 * tube_radius(walls.back()));
  for (std::size_t k = 1; k < walls.size(); ++k)
    text += fmt::format("{} {:.3f}", k > 1 ? "," : "", spacing(walls[k - 1], walls[k]));
  return text + " nm apart";
}

std::vector<Chirality> parse_walls(const std::string& text) {
  std::vector<Chirality> walls;
  for (std::size_t from = 0;;) {
    const std::size_t at = text.find('@', from);
    std::string one = text.substr(from, at == std::string::npos ? at : at - from);
    while (!one.empty() && one.back() == ' ') one.pop_back();
    while (!one.empty() && one.front() == ' ') one.erase(0, 1);
    if (one.size() > 2 && one.front() == '(' && one.back() == ')') one = one.substr(1, one.size() - 2);
    walls.push_back(parse_chirality(one));
    if (at == std::string::npos) break;
    from = at + 1;
  }
  for (std::size_t k = 1; k < walls.size(); ++k) {
    const Chirality a = walls[k - 1], b = walls[k], fits = fitting_outside(a);
    const double gap = spacing(a, b);
    if (gap >= least_wall_spacing && gap <= most_wall_spacing) continue;
    throw InputError({"", 0, "--chirality"},
                     fmt::format("({},{}) and ({},{}) are walls {:.3f} nm apart, and walls fit at {:.2f} to {:.2f} nm",
                                 a.n, a.m, b.n, b.m, gap, least_wall_spacing, most_wall_spacing),
                     fmt::format("name them from inside to outside; around ({},{}) fits ({},{}), {:.3f} nm apart", a.n,
                                 a.m, fits.n, fits.m, spacing(a, fits)));
  }
  return walls;
}

std::vector<Chirality> find_walls(int count, double outer_diameter) {
  const auto refuse = [&](const std::string& what) {
    throw InputError({"", 0, "--walls"}, what, "give 2 to 30 walls and an outer diameter that has room for them");
  };
  if (count < 2 || count > 30) refuse(fmt::format("is {}", count));
  constexpr double slack = 0.1;    // nm, of the outer diameter
  constexpr double outweighs = 0.05;  // what a spacing counts more than the diameter
  std::vector<Chirality> best;
  double least = 1e9;
  const std::vector<Chirality> all = simple_walls(0.5 * (outer_diameter + slack));
  for (const Chirality outer : all) {
    const double off = std::fabs(2 * tube_radius(outer) - outer_diameter);
    if (off > slack) continue;
    std::vector<Chirality> walls = {outer};
    double worst = 0;
    while (static_cast<int>(walls.size()) < count) {
      const auto misfit = [&](Chirality c) { return std::fabs(spacing(c, walls.back()) - graphite_spacing); };
      const auto nearest = std::min_element(
          all.begin(), all.end(), [&](const Chirality& a, const Chirality& b) { return misfit(a) < misfit(b); });
      if (misfit(*nearest) > graphite_spacing - least_wall_spacing || 2 * tube_radius(*nearest) < smallest_diameter)
        break;
      worst = std::max(worst, misfit(*nearest));
      walls.push_back(*nearest);
    }
    const double cost = worst + outweighs * off;
    if (static_cast<int>(walls.size()) < count || cost >= least) continue;
    least = cost;
    best.assign(walls.rbegin(), walls.rend());
  }
  if (best.empty()) refuse(fmt::format("is {}, and a tube {:.3g} nm wide has no room for so many", count, outer_diameter));
  return best;
}

bool walls_lock(const std::vector<Chirality>& walls) {
  const auto all = [&](auto is) { return std::all_of(walls.begin(), walls.end(), is); };
  return all([](Chirality c) { return c.n == c.m; }) || all([](Chirality c) { return c.n == 0 || c.m == 0; });
}

}  // namespace ropewalk::calibrate
