// Films of tubes that rest on one another: where they begin to conduct, and what the van der Waals forces make of
// their contacts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/common/bundle.hpp"
#include "cases/common/scene_of_case.hpp"
#include "model/contact/line_parameters.hpp"
#include "observe/growth.hpp"
#include "observe/network.hpp"
#include "scene/kinds/film.hpp"
#include "scene/network_words.hpp"
#include "scene/prepare.hpp"
#include "scene/spacing.hpp"

namespace ropewalk::validate::film_percolation {
namespace {

constexpr double stacked = 6.850923, crossing = 5.6373;  // N l^2 of the literature
constexpr double relaxing_time = 100;                    // ps, as in the scene

// Rigid tubes, laid one after another.
struct Film {
  std::vector<FilmTube> tubes;  // sorted by the order of laying
  int elements = 0;             // elements of each tube
  double element_length = 0, box = 0;

  double length() const { return elements * element_length; }
  // In this part of the box tubes are as dense at every angle: their ends cannot be outside.
  double reach() const { return 0.5 * (box - length()); }
};

Film laid(double length, int elements, double box, double dense, double spacing, std::uint64_t seed) {
  FilmSource source;
  source.length = length;
  source.width = source.depth = box * length;
  source.tubes = static_cast<int>(dense * box * box);
  source.laid = FilmSource::Laid::resting;
  Random random(seed);
  const double element = length / elements;
  return {lay_film(source, elements, element, spacing, random), elements, element, source.width};
}

// N l^2 of the first tubes of the film, of which the last one has this number.
double density(const Film& film, int last) {
  const double reach = film.reach();
  const auto inside = [&](const FilmTube& t) { return std::fabs(t.x) <= reach && std::fabs(t.y) <= reach; };
  const auto tubes = std::count_if(film.tubes.begin(), film.tubes.begin() + last + 1, inside);
  return static_cast<double>(tubes) * std::pow(film.length() / (2 * reach), 2);
}

// Mean in x and y of the density at which a cluster first spans the film: its tubes count in the order of laying.
// Not a number where none does.
double threshold(const Film& film, const Topology& topology, const State& state, std::vector<TubePair> pairs) {
  std::sort(pairs.begin(), pairs.end(), [](auto& a, auto& b) { return a.second < b.second; });
  TubeClusters clusters(topology, state, {film.reach(), film.reach()});
  double in_x = std::numeric_limits<double>::quiet_NaN(), in_y = in_x;
  for (const TubePair& pair : pairs) {
    clusters.join(pair);
    if (std::isnan(in_x) && clusters.spans_x()) in_x = density(film, pair.second);
    if (std::isnan(in_y) && clusters.spans_y()) in_y = density(film, pair.second);
    if (!std::isnan(in_x + in_y)) break;
  }
  return 0.5 * (in_x + in_y);
}

double threshold(const Film& film, double distance) {
  Topology topology;
  topology.types[0].element_length = film.element_length;
  State state;
  put_tubes(film.tubes, film.elements, film.element_length, topology, state);
  return threshold(film, topology, state, touching_tubes(topology, state, distance));
}

Film flattened(Film film) {
  for (FilmTube& t : film.tubes) t.z = t.tilt = 0;
  return film;
}

// --- rigid tubes ---

struct Thresholds {
  std::vector<double> stacked, crossing;  // threshold of each film
};

struct MeanOf {
  double value = 0, error = 0;
  explicit MeanOf(const std::vector<double>& v) {
    double sum = 0, squares = 0;
    for (const double x : v) sum += x;
    const auto n = static_cast<double>(v.size());
    value = sum / n;
    for (const double x : v) squares += (x - value) * (x - value);
    error = std::sqrt(squares / (n * (n - 1)));
  }
};

Thresholds thresholds(double length, double spacing, int films, std::uint64_t first_seed) {
  Thresholds out;
  for (int k = 0; k < films; ++k) {
    const Film film = laid(length, 10, 11, 9, spacing, first_seed + static_cast<std::uint64_t>(k));
    out.stacked.push_back(threshold(film, spacing * (1 + 1e-6)));
    out.crossing.push_back(threshold(flattened(film), 1e-6 * length));
  }
  return out;
}

// --- with forces ---

struct Relaxed {
  double length = 0;
  double contacts = 0, kept = 0, made = 0;  // of a tube at the start; the part of these that stays; of a tube, new
  double before = 0, after = 0;             // thresholds by the order of laying
  double energy = 0, crossings = 0;         // energy at the start, eV: of the model, and of all crossings by the integral
};

// Energy of all crossings of tubes of a film, each as that of two endless tubes.
double crossing_energy(const WallsIntegral& integral, const Film& film, double cutoff) {
  const double half = 0.5 * film.length();
  double sum = 0;
  for (std::size_t i = 0; i < film.tubes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 u = film.tubes[i].axis(), v = film.tubes[j].axis(), normal = u.cross(v);
      const Vector3 apart = film.tubes[j].middle() - film.tubes[i].middle();
      const double sine2 = normal.squaredNorm(), distance = std::fabs(apart.dot(normal)) / std::sqrt(sine2);
      const double on_i = apart.cross(v).dot(normal) / sine2, on_j = apart.cross(u).dot(normal) / sine2;
      if (distance < cutoff && std::fabs(on_i) < half && std::fabs(on_j) < half)
        sum += integral.crossed(distance) / std::sqrt(sine2);
    }
  return sum;
}

// With elements of twice the length, which bend as well and take a fourth of the time.
Relaxed relaxed(const CaseTube& tube, int elements, double box) {
  const double a = 2 * tube.set.element_length, length = elements * a;
  const std::string side = fmt::to_string(box * length);
  Scene scene = scene_of_case("film-percolation", tube.model,
                              {{"element_length_nm", fmt::to_string(a)},
                               {"film.tubes", fmt::format("{:.0f}", 7.5 * box * box)},
                               {"film.length_nm", fmt::to_string(length)},
                               {"film.width_nm", side},
                               {"film.depth_nm", side}});
  Prepared p = prepare(scene);
  const double spacing = crossed_spacing(scene), near = touching * spacing;
  const auto& source = dynamic_cast<const FilmSource&>(*scene.source);
  Random random(scene.start.seed);
  const Film film{lay_film(source, elements, a, spacing, random), elements, a, source.width};
  Topology same;
  put_tubes(film.tubes, elements, a, same, p.state);  // the same tubes, in the order of laying
  Simulation simulation = start(scene, p);
  const std::vector<TubePair> first = touching_tubes(p.topology, p.state, near);
  Relaxed out;
  out.length = length;
  out.energy = simulation.forces().energy.vdw;
  out.crossings = crossing_energy(surface_integral(tube.set), film, p.interaction.law->cutoff());
  simulation.steps(std::lround(relaxing_time / p.time_step));
  const std::vector<TubePair> last = touching_tubes(p.topology, simulation.state(), near);
  std::vector<TubePair> both;
  std::set_intersection(first.begin(), first.end(), last.begin(), last.end(), std::back_inserter(both));
  const auto tubes = static_cast<double>(film.tubes.size());
  out.contacts = 2 * static_cast<double>(first.size()) / tubes;
  out.kept = static_cast<double>(both.size()) / static_cast<double>(first.size());
  out.made = 2 * static_cast<double>(last.size() - both.size()) / tubes;
  out.before = threshold(film, p.topology, p.state, first);
  out.after = threshold(film, p.topology, simulation.state(), last);
  return out;
}

CaseFigure figure_of_rigid(const std::vector<double>& lengths, const std::vector<Thresholds>& all) {
  std::vector<double> micrometres, stacks, crosses;
  for (std::size_t k = 0; k < all.size(); ++k) {
    micrometres.push_back(1e-3 * lengths[k]);
    stacks.push_back(MeanOf(all[k].stacked).value);
    crosses.push_back(MeanOf(all[k].crossing).value);
  }
  const auto level = [&](const char* name, double value) {
    return theory_curve(name, micrometres.front(), micrometres.back(), [value](double) { return value; });
  };
  return case_figure(
      "Density at which laid tubes begin to conduct", {"length of the tubes", "µm", false, true},
      {"tubes on the square of their length", ""},
      "Tubes that rest on two others need more than lines that all cross. Tubes that are not much longer "
      "than thick need fewer: their ends touch where lines pass.",
      {level("sticks on one another", stacked), level("lines in a plane", crossing),
       model_points("tubes at rest on one another", micrometres, stacks),
       model_points("the same films from above", micrometres, crosses, 3)});
}

void add_relaxed_figures(const std::vector<Relaxed>& films, CaseResult& result) {
  std::vector<double> length, first, last, made, before, after;
  for (const Relaxed& f : films) {
    length.push_back(f.length);
    first.push_back(f.contacts);
    last.push_back(f.contacts * f.kept + f.made);
    made.push_back(f.made);
    before.push_back(f.before);
    after.push_back(f.after);
  }
  result.figure("Contacts before and after relaxing", {"length of the tubes", "nm"}, {"contacts of a tube", ""},
                fmt::format("Contacts within {} times the distance of crossed tubes, as laid and after {:.0f} ps.",
                            touching, relaxing_time),
                {model_points("as laid", length, first), model_points("relaxed", length, last, 3),
                 model_points("of these new", length, made, 4)});
  result.figure("Density at which the film begins to conduct, before and after relaxing",
                {"length of the tubes", "nm"}, {"tubes on the square of their length", ""},
                "One film for each length; its tubes count in the order of laying.",
                {model_points("as laid", length, before), model_points("relaxed", length, after, 3)});
}

CaseResult run(const CaseContext& context) {
  const CaseTube tube = context.tube();
  const WallsIntegral integral = surface_integral(tube.set);
  const double spacing = line_crossed_well(tube.model.law<LineParameters>()->density, 0.5 * units::pi).distance;
  CaseResult result;
  result.check_relative("distance of the axes of tubes at rest on one another", spacing,
                        integral.crossed_well().distance, 1e-3, "nm", "place of the minimum");
  const std::vector<double> lengths = {66, 250, 1000, 2000, 4000};
  std::vector<Thresholds> all;
  std::vector<double> stacks, crosses;  // thresholds of long tubes
  for (const double length : lengths) {
    if (context.progress) context.progress(fmt::format("rigid tubes of {} nm", length));
    const bool is_long = length >= 1000;
    all.push_back(thresholds(length, spacing, is_long ? 40 : 20, static_cast<std::uint64_t>(length)));
    const Thresholds& here = all.back();
    const MeanOf mean(here.stacked);
    result.show_absolute(fmt::format("N l^2 of tubes of {} nm at rest on one another", length), mean.value, stacked,
                         3 * mean.error, "", fmt::format("standard error {:.2g}", mean.error));
    if (!is_long) continue;
    stacks.insert(stacks.end(), here.stacked.begin(), here.stacked.end());
    crosses.insert(crosses.end(), here.crossing.begin(), here.crossing.end());
  }
  const MeanOf stack(stacks), cross(crosses);
  result.check_absolute(
      "N l^2 of tubes at rest on one another", stack.value, stacked, 0.2, "",
      fmt::format("three standard errors of 0.06 ({:.2g} here), and the thickness of the shortest", stack.error));
  result.check_absolute("N l^2 of the same tubes from above", cross.value, crossing, 0.15, "",
                        fmt::format("three standard errors of 0.05 ({:.2g} here)", cross.error));
  result.figures.push_back(figure_of_rigid(lengths, all));

  std::vector<Relaxed> films;
  for (const int elements : {12, 24, 48}) {
    if (context.progress) context.progress(fmt::format("relaxing tubes of {} elements", elements));
    films.push_back(relaxed(tube, elements, 5));
  }
  const Relaxed& longest = films.back();
  result.check_relative(fmt::format("van der Waals energy of a film of {:.0f} nm as laid", longest.length),
                        longest.energy, longest.crossings,
                        2 * tube.set.law<LineParameters>()->density.cutoff() / longest.length, "eV",
                        "ends of tubes within reach of others: twice the reach of the contact over the length");
  add_relaxed_figures(films, result);
  result.remarks.push_back(fmt::format(
      "Within {:.0f} ps tubes of {:.0f}, {:.0f} and {:.0f} nm keep {:.3g}, {:.3g} and {:.3g} % of their "
      "contacts and add {:.0f}, {:.0f} and {:.0f} % by van der Waals attraction. The film as laid conducts "
      "from `N l^2` = {:.2f}, {:.2f} and {:.2f} on, the relaxed one from {:.2f}, {:.2f} and {:.2f}.",
      relaxing_time, films[0].length, films[1].length, films[2].length, 100 * films[0].kept, 100 * films[1].kept,
      100 * films[2].kept, 100 * films[0].made / films[0].contacts, 100 * films[1].made / films[1].contacts,
      100 * films[2].made / films[2].contacts, films[0].before, films[1].before, films[2].before, films[0].after,
      films[1].after, films[2].after));
  result.remarks.push_back(fmt::format(
      "The limit is that of sticks without thickness. Tubes have one, and are caught by ends that would "
      "pass: those of 66 nm conduct from {:.2f} on, with {:.2g}.",
      MeanOf(all.front().stacked).value, MeanOf(all.front().stacked).error));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "film-percolation";
  c.order = 195;
  c.tier = Case::Tier::full;
  c.run = run;
  c.turns_red = {{wrong_contact(1.1), {"van der Waals"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::film_percolation
