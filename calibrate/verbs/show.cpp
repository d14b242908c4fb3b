// `ropewalk calibrate show`: the table of a set and its page of plots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "report/page.hpp"
#include "verbs/tables.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

struct ShowArguments {
  std::string set;
  std::string page;  // empty: NAME.html in the current directory
  bool table_only = false;
};

namespace fs = std::filesystem;

constexpr double wall_thickness = 0.335;    // wall of the published section, nm
constexpr double GPa = units::eV_in_nN_nm;  // nN/nm^2 is GPa; stiffnesses are kept in eV
constexpr const char* page_mark = "<!-- ropewalk calibrate show -->";

// The table that a set names, if it lies beside the set; else empty. Throws InputError if the set was made from
// another table.
std::string companion(const ParameterSet& set, const std::string& kind) {
  const std::string name = provenance_value(set, kind + "_table"), hash = provenance_value(set, kind + "_hash");
  const std::string path = (fs::path(set.path).parent_path() / name).string();
  if (name.empty() || hash.empty() || !fs::exists(path)) return "";
  if (hash_hex(read_file(path)) != hash)
    throw InputError({path, 0, ""}, fmt::format("is not the table that {} was made from", set.name),
                     "calibrate anew, or move the file away to see the set without its plots");
  return path;
}

// --- The page -----------------------------------------------------------------------------------------------

struct Points {
  std::vector<double> x, y, fit, residual;
  std::vector<double> curve_x, curve_y;  // the fit between the points

  void add(double at, double value, double of_fit) {
    x.push_back(at);
    y.push_back(value);
    fit.push_back(of_fit);
    residual.push_back(value - of_fit);
  }
  void draw(const std::function<double(double)>& f, int points = 121) {
    if (x.empty()) return;
    for (int k = 0; k < points; ++k) {
      curve_x.push_back(x.front() + (x.back() - x.front()) * k / (points - 1));
      curve_y.push_back(f(curve_x.back()));
    }
  }
  // Along one coordinate the fit is a polynomial of at most fourth degree, which its points determine.
  void draw_polynomial() {
    const auto lagrange = [this](double at) {
      double sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        double term = fit[i];
        for (std::size_t j = 0; j < x.size(); ++j)
          if (j != i) term *= (at - x[j]) / (x[i] - x[j]);
        sum += term;
      }
      return sum;
    };
    if (x.size() <= 12) draw(lagrange);
  }
  void sort() {
    std::vector<std::size_t> order(x.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    for (auto* v : {&y, &fit, &residual, &x}) {
      std::vector<double> sorted;
      for (const std::size_t k : order) sorted.push_back((*v)[k]);
      *v = std::move(sorted);
    }
  }
};

std::string figure(Figures& figures, const LineChart& chart, const std::string& words, const Points& p,
                   const std::string& x, const std::string& y) {
  return "<figure>" + chart_svg(chart) + figures.caption(words) +
         data_table({{x, p.x}, {y, p.y}, {"fit", p.fit}, {"residual", p.residual}},
                    "The table lies beside the set.") +
         "</figure>\n";
}

// The curve with its fit, and the residual with the same abscissa below.
std::string pair_of_figures(Figures& figures, const std::string& title, const ChartAxis& x, const ChartAxis& y,
                            const Points& p, const std::string& words) {
  LineChart curve;
  curve.title = title;
  curve.x = x;
  curve.y = y;
  curve.lines = {{"fit", p.curve_x, p.curve_y, 0}, {"data", p.x, p.y, 1}};
  curve.lines[1].points = true;
  LineChart residual;
  residual.title = title + ": residual";
  residual.x = x;
  residual.y = {y.quantity + " − fit", y.unit};
  residual.lines = {{"residual", p.x, p.residual, 1}};
  residual.lines[0].points = true;
  if (!can_draw(curve)) return "";
  std::string html = "<div class=\"pair\">\n";
  html += figure(figures, curve, words, p, x.quantity + " (" + x.unit + ")", y.quantity + " (" + y.unit + ")");
  return html + "<figure>" + chart_svg(residual) + figures.caption("What the fit leaves of it.") +
         "</figure></div>\n";
}

std::string elastic_part(const ParameterSet& set, Figures& figures) {
  const std::string path = companion(set, "stiffness");
  if (path.empty()) return paragraph("The set names no table of energies, or it does not lie beside the set.");
  const std::vector<AtomisticRow> rows = read_atomistic_csv(path);
  Points stretch, twist, bend, pull;
  const Quantity* twisted = find_quantity(set, "atomistic.natural_twist");
  const double natural = twisted ? twisted->value : 0;
  for (const AtomisticRow& r : rows) {
    if (!(r.length > 0)) continue;
    const double e = r.energy / r.length, fit = (r.energy - r.residual) / r.length;
    if (r.kind == "stretch-twist") {
      // One curve for each coordinate: rows near the natural twist, and rows near zero strain.
      if (std::fabs(r.twist - natural) * set.radius < 5e-4) stretch.add(100 * r.strain, e, fit);
      if (std::fabs(r.strain) < 5e-4) twist.add(r.twist - natural, e, fit);
    }
    // The fit uses the difference of two lengths, which does not contain the ends.
    if (r.kind == "bend-long")
      for (const AtomisticRow& other : rows)
        if (other.kind == "bend-short" && std::fabs(other.curvature - r.curvature) < 1e-9) {
          const double length = r.length - other.length, difference = (r.energy - other.energy) / length;
          bend.add(r.curvature, difference, difference - (r.residual - other.residual) / length);
        }
  }
  // Mean forces between two rows.
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const AtomisticRow &a = rows[k - 1], &b = rows[k];
    if (a.kind != "pull" || b.kind != "pull") continue;
    const double over = units::eV_in_nN_nm / (b.length * (b.strain - a.strain)),
                 force = (b.energy - a.energy) * over;
    pull.add(50 * (a.strain + b.strain), force, force - (b.residual - a.residual) * over);
  }
  pull.sort();
  pull.curve_x = pull.x, pull.curve_y = pull.fit;
  for (Points* p : {&stretch, &twist, &bend}) {
    p->sort();
    p->draw_polynomial();
  }
  const ChartAxis energy{"energy per length", "eV/nm"};
  std::string html =
      pair_of_figures(figures, "Energy against strain", {"strain", "%"}, energy, stretch,
                      "Relaxed periodic cells near the natural twist; the fit takes all cells together.");
  html += pair_of_figures(figures, "Energy against twist", {"twist − natural twist", "rad/nm"}, energy, twist,
                          "Relaxed periodic cells near no strain.");
  html += pair_of_figures(figures, "Energy against curvature", {"curvature", "1/nm"}, energy, bend,
                          "Difference of two bent tubes over the difference of their lengths: without their ends.");
  html += pair_of_figures(
      figures, "Force against strain", {"strain", "%"}, {"force", "nN"}, pull,
      "One cell, pulled until its force falls or the potential cuts a bond off; and the bond of the set.");
  return html;
}

std::string contact_part(const ParameterSet& set, Figures& figures) {
  const std::string path = companion(set, "contact");
  if (path.empty() || !set.law<LineParameters>())
    return paragraph("The set names no table of the contact, or it does not lie beside the set.");
  struct Curve {
    const char *kind, *title, *quantity, *unit, *words;
  };
  const Curve curves[] = {
      {"density", "Line density", "u", "eV/nm²", "The Abel inverse of the parallel energy, and the closed form."},
      {"parallel", "Parallel tubes", "energy per length", "eV/nm", "Surface integral, and the line law."},
      {"crossed", "Tubes crossed at 90 degrees", "energy", "eV", "Surface integral, and the line law."}};
  const std::vector<ContactRow> rows = read_contact_csv(path);
  std::string html;
  for (const Curve& c : curves) {
    Points p;
    double lowest = 0;
    for (const ContactRow& r : rows)
      if (r.kind == c.kind) lowest = std::min(lowest, r.energy);
    // The repulsive wall is shown up to the height that equals the depth of the well.
    for (const ContactRow& r : rows)
      if (r.kind == c.kind && r.energy < -lowest) p.add(r.distance, r.energy, r.fit);
    p.sort();
    const LineDensity& law = set.law<LineParameters>()->density;
    p.draw([&](double at) {
      return c.kind == std::string("density")    ? law.energy(at)
             : c.kind == std::string("parallel") ? line_parallel_energy(law, at)
                                                 : line_crossed_energy(law, at, 0.5 * units::pi);
    });
    html += pair_of_figures(figures, c.title, {"distance of the axes", "nm"}, {c.quantity, c.unit}, p, c.words);
  }
  return html;
}

std::string section_part(const ParameterSet& set) {
  const Section s = effective_section(set);
  const auto number = [](double v, const char* unit) { return fmt::format("{:.5g} {}", v, unit); };
  const char* rule = "A = 2πrt, t = 0.335 nm; I = EI/E, J = 2I";
  return facts_part(
      {{"kn", number(s.kn, "nN/nm^3"), "E/T; published (10,10): 759.4, from 4740 eV/nm^4"},
       {"ks", number(s.ks, "nN/nm^3"), "G/T; published: 338.1, from 2110 eV/nm^4"},
       {"A", number(s.A, "nm^2"), "published: 1.427"},
       {"I", number(s.I, "nm^4"), "published: 0.348"},
       {"J", number(s.J, "nm^4"), "published: 0.696"},
       {"E", number(s.E, "GPa"), "published: 1030"},
       {"G", number(s.G, "GPa"), "published: 459"},
       {"I of a thick wall", number(s.thick_wall_I, "nm^4"), "πrt(r² + t²/4): not used, for comparison"},
       {"how", "EA, EI and GJ are three stiffnesses", rule}});
}

std::string provenance_part(const ParameterSet& set) {
  std::vector<ReportFact> facts = {{"file", fs::path(set.path).filename().string(), "hash " + set.hash}};
  for (const auto& [key, value] : set.provenance) facts.push_back({key, value, ""});
  return facts_part(facts);
}

}  // namespace

Section effective_section(const ParameterSet& set) {
  Section s{};
  const double T = set.element_length;
  s.A = 2 * units::pi * set.radius * wall_thickness;
  s.E = set.bond.stretch * GPa / s.A;
  s.I = set.bond.bend * GPa / s.E;
  s.J = 2 * s.I;
  s.G = set.bond.twist * GPa / s.J;
  s.kn = s.E / T;
  s.ks = s.G / T;
  s.thick_wall_I =
      units::pi * set.radius * wall_thickness * (set.radius * set.radius + 0.25 * wall_thickness * wall_thickness);
  return s;
}

// The stiffnesses as those of a carbon wall of this radius.
void print_section(const ParameterSet& set) {
  const Section s = effective_section(set);
  fmt::print(
      "\nAs bonds of rigid elements of {:.4g} nm (A = 2 pi r t, t = 0.335 nm; published (10,10) in brackets)\n"
      "  kn {:.5g} nN/nm^3 [759.4]  ks {:.5g} nN/nm^3 [338.1]  A {:.4g} nm^2 [1.427]  I {:.4g} nm^4 [0.348]  "
      "J {:.4g} nm^4 [0.696]\n  E {:.4g} GPa [1030]  G {:.4g} GPa [459]\n",
      set.element_length, s.kn, s.ks, s.A, s.I, s.J, s.E, s.G);
}

void print_set(const ParameterSet& set) {
  fmt::print("{}{}  {}\n{}\n", set.name, set.filament ? "" : " " + tube_name(set), set.reference,
             grade_of(set).words());
  std::string section;
  for (const Quantity& q : set.quantities) {
    const std::size_t dot = q.key.rfind('.');
    if (q.key.substr(0, dot) != section) fmt::print("\n[{}]\n", section = q.key.substr(0, dot));
    fmt::print("  {:<18}{:>26} {:<9} {:<11}{}\n", q.key.substr(dot + 1),
               q.standard_error ? measured_text(q) : fmt::format("{:.7g}, error not known", q.value), q.unit,
               q.origin, q.note);
  }
  if (!set.filament && set.honeycomb.carbon()) print_section(set);
  if (set.provenance.empty()) return;
  fmt::print("\n[provenance]\n");
  for (const auto& [key, value] : set.provenance) fmt::print("  {:<18}{}\n", key, value);
}

std::string calibration_page(const ParameterSet& set) {
  Figures figures;
  std::string html = page_head(set.name) + page_mark +
                     "\n<body>\n<main>\n<p class=\"kicker\">Ropewalk: a parameter set</p>\n<h1>" +
                     escape_markup(set.name) + "</h1>\n";
  html += paragraph(fmt::format("{}: EA {:.5g} nN, EI {:.5g} nN nm², GJ {:.5g} nN nm², {} {:.5g} nm.",
                                set.filament ? "A filament" : "The " + tube_name(set) + " tube",
                                set.bond.stretch * units::eV_in_nN_nm, set.bond.bend * units::eV_in_nN_nm,
                                set.bond.twist * units::eV_in_nN_nm, set.filament ? "contact radius" : "radius",
                                set.radius));
  html += paragraph("<b>" + escape_markup(grade_of(set).words()) + "</b>");
  html += heading("Stretch, twist and bend") + elastic_part(set, figures);
  html += heading("Contact") + contact_part(set, figures);
  if (!set.filament && set.honeycomb.carbon()) html += heading("As bonds of rigid elements") + section_part(set);
  html += heading("Parameters") + parameters_part(set.name, set.reference, set.quantities);
  html += heading("Where it comes from") + provenance_part(set);
  return html + "</main>\n</body>\n</html>\n";
}

namespace {

int show_command(const ShowArguments& a) {
  const ParameterSet set = read_parameters(find_parameters(a.set, "", {"", 0, "set"}));
  print_set(set);
  if (a.table_only) return 0;
  // The name is a text of whoever made the set, and no path.
  const std::string page = a.page.empty() ? fs::path(set.name).filename().string() + ".html" : a.page;
  // Only a page of this command may be replaced.
  if (fs::exists(page) && read_file(page).find(page_mark) == std::string::npos)
    throw InputError({page, 0, "--page"}, "exists and is not such a page", "choose another name");
  write_file_atomically(page, calibration_page(set));
  fmt::print("\nPage: {}\n", page);
  return 0;
}

}  // namespace

void add_show(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ShowArguments>();
  CLI::App* c = app.add_subcommand("show", "The table of a set, and a page with its plots");
  c->add_option("set", a->set, "Parameter set: a file, or the name of a shipped one")->required();
  c->add_option("--page", a->page, "Where the page goes [default: NAME.html]");
  c->add_flag("--table", a->table_only, "The table alone");
  c->callback([a, &program] { program.code = show_command(*a); });
}

}  // namespace ropewalk::calibrate
