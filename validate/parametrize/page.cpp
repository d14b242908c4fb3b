// Pages of parametrized tubes.
#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "parametrize/parametrize.hpp"

namespace ropewalk::validate {
namespace {

constexpr double nN = units::eV_in_nN_nm;

std::string with_error(const ParameterSet& set, const std::string& key) {
  const Quantity* q = find_quantity(set, key);
  return q ? measured_text(*q, true) : "not known";
}

ReportFact fact(const ParameterSet& set, const std::string& name, const std::string& key,
                const std::string& remark = "") {
  return {name, with_error(set, key), remark};
}

std::string numbers_part(const ParametrizedTube& t) {
  const ParameterSet& set = t.set;
  return facts_part(
      {fact(set, "Radius", "tube.radius"), fact(set, "EA, stretch", "bond.EA"), fact(set, "EI, bending", "bond.EI"),
       fact(set, "GJ, twist", "bond.GJ"),
       fact(set, "Coupling of stretch and twist", "atomistic.coupling", "zero for tubes (n,n) and (n,0)"),
       fact(set, "Natural twist", "atomistic.natural_twist", "of the relaxed tube against the rolled sheet"),
       fact(set, "Distance of two parallel tubes", "contact.line.pair_spacing"),
       fact(set, "Their energy", "contact.line.pair_energy"),
       fact(set, "Energy of two tubes crossed at 90°", "contact.line.cross90_energy"),
       fact(set, "Registry", "contact.line.registry",
            "standard deviation of the pair energy over all registries, over the well: an error bar")});
}

// Each number with its error.
std::string friction_part(const ParametrizedTube& t) {
  if (t.frictions.empty())
    return t.no_friction.empty() ? "" : heading("Friction") + paragraph(escape_markup(t.no_friction));
  std::string html =
      heading("Friction") +
      paragraph(
          "Of two tubes side by side at 0 K, mean over their turns. A scene with this set and "
          "<code>[[friction]] from = \"atoms\"</code> has it. The drag was not measured.") +
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>Tubes</th><th class=\"number\">Along the axis, "
      "pN/nm</th><th class=\"number\">Against spin, pN/nm</th><th class=\"number\">Of an end, pN</th><th "
      "class=\"number\">Elastic slip, nm</th><th>Grade</th></tr></thead><tbody>\n";
  for (const PairFriction& f : t.frictions) {
    html += fmt::format("<tr><th>({},{}) beside ({},{})</th>", f.a.n, f.a.m, f.b.n, f.b.m);
    for (const char* key :
         {"friction.strength", "friction.spin_strength", "friction.end_strength", "friction.elastic_slip"})
      for (const Quantity& q : f.quantities)
        if (q.key == key) html += fmt::format("<td class=\"number\">{}</td>", measured_text(q));
    html += fmt::format("<td>{}</td></tr>\n", escape_markup(grade_of(f).words()));
  }
  return html + "</tbody></table></div>\n";
}

std::string limits_part(const ParametrizedTube& t) {
  const ParameterSet& set = t.set;
  const double r = set.radius;
  std::vector<ReportFact> facts = {
      {"Twist", fmt::format("{} rad/nm", number_text(set.validity.collapse_at(r, 0) / r, 3)),
       "the wall of a long tube collapses; short clamped ones bear more"},
      {"Curvature", fmt::format("{} nm⁻¹", number_text(set.validity.kink_curvature, 3)),
       "the tube kinks; beyond it the moment of the bond is constant, that of atoms falls"},
      {"Strain", fmt::format("{} %", number_text(100 * set.validity.stretch, 3)), "tension or compression"}};
  return paragraph("Up to these limits the bonds have the energies of the atoms. A run says when it passes one.") +
         facts_part(facts);
}

// "Twisting energies of ropes of seven tubes agree within 1.1 % ..."
std::string agreement(const ParametrizedTube& t) {
  const Check* rope = worst_rope(t);
  if (!rope) return "No rope of atoms was compared with. ";
  return fmt::format(
      "Twisting energies of ropes of seven tubes, up to r τ = 0.04, agree with those of atoms within {} %; nothing "
      "was fitted to a rope. ",
      number_text(100 * std::fabs(rope->difference()), 2));
}

std::string uses_part(const ParametrizedTube& t) {
  const std::string grade = t.grade();
  std::string html = paragraph(
      "<b>For:</b> ropes, bundles, rings and films of such tubes at rest or in slow motion, "
      "within the limits below. " +
      escape_markup(agreement(t)));
  std::string not_for =
      "<b>Not for:</b> what walls do: their vibration (a warm bundle loses more cohesion than the model says), "
      "their flattening in contact, registry, open ends (see “ends flush”), defects, chemistry.";
  if (grade != "good") not_for += " " + escape_markup("This set is " + grade + ".");
  if (!t.set.anharmonic)
    not_for += " The set has no terms beyond Hooke's law: near the limits its energies are 3 to 20 % too large.";
  return html + paragraph(not_for);
}

std::string times(const ParametrizedTube& t) {
  double lammps = 0;
  for (const Outcome& o : t.outcomes)
    if (find_case(o.name).group == Case::Group::atoms) lammps += o.result.seconds;
  return fmt::format(
      "{}Processor time: calibration {:.0f} s; references of atoms and their cases {:.0f} s; other cases {:.0f} s.",
      t.tier == "quick" ? "Quick cases alone (--tier quick): no ropes and no bundles were compared. " : "",
      t.calibration_seconds, lammps, t.validation_seconds() - lammps);
}

double chiral_degrees(const ParametrizedTube& t) { return chiral_angle(t.set.chirality) * units::rad_in_degree; }

// Points of each potential.
std::vector<ChartLine> by_potential(const std::vector<ParametrizedTube>& tubes,
                                    const std::function<double(const ParametrizedTube&)>& x,
                                    const std::function<double(const ParametrizedTube&)>& y) {
  std::map<std::string, ChartLine> lines;
  for (const ParametrizedTube& t : tubes) {
    if (!t.error.empty()) continue;
    const std::string potential = provenance_value(t.set, "potential");
    ChartLine& line = lines[potential];
    line.name = potential;
    line.points = true;
    line.x.push_back(x(t));
    line.y.push_back(y(t));
  }
  std::vector<ChartLine> all;
  for (auto& [name, line] : lines) {
    line.colour = static_cast<int>(all.size());
    all.push_back(line);
  }
  return all;
}

ChartLine level(const std::string& name, double value, const std::vector<ChartLine>& points, int colour) {
  double least = 1e300, most = -1e300;
  for (const ChartLine& line : points)
    for (const double x : line.x) least = std::min(least, x), most = std::max(most, x);
  ChartLine line{name, {least, most}, {value, value}, colour};
  line.dashed = true;
  return line;
}

struct Figure {
  LineChart chart;
  std::string caption;
};

double radius(const ParametrizedTube& t) { return t.set.radius; }

// Divided by those of a thin wall, stiffnesses of all tubes are those of the sheet.
std::vector<Figure> overview_figures(const std::vector<ParametrizedTube>& tubes) {
  const auto stretch = [](const ParametrizedTube& t) {
    return t.set.bond.stretch * nN / (2 * units::pi * t.set.radius);
  };
  const auto bend = [](const ParametrizedTube& t) {
    return t.set.bond.bend * nN / (units::pi * std::pow(t.set.radius, 3));
  };
  const auto twist = [](const ParametrizedTube& t) {
    return t.set.bond.twist * nN / (2 * units::pi * std::pow(t.set.radius, 3));
  };
  const auto chart = [](const char* title, ChartAxis x, ChartAxis y, std::vector<ChartLine> lines) {
    LineChart c;
    c.title = title;
    c.x = std::move(x);
    c.y = std::move(y);
    c.lines = std::move(lines);
    return c;
  };
  const ChartAxis r = {"radius", "nm"};
  std::vector<Figure> figures;
  std::vector<ChartLine> lines = by_potential(tubes, radius, stretch);
  lines.push_back(level("ab initio", 345, lines, 5));
  lines.push_back(level("measured", 340, lines, 4));
  figures.push_back(
      {chart("EA over the circumference", r, {"EA/(2πr)", "N/m"}, lines),
       "Stretch: EA over the circumference, the stiffness of the sheet. Measured 340 ± 50 N/m (C. Lee et "
       "al., Science 321, 385 (2008), DOI 10.1126/science.1157996); ab initio 345 N/m (K. N. Kudin et "
       "al., Phys. Rev. B 64, 235406 (2001), DOI 10.1103/PhysRevB.64.235406)."});
  lines = by_potential(tubes, radius, bend);
  lines.push_back(level("ab initio", 345, lines, 5));
  figures.push_back({chart("EI over that of a thin wall", r, {"EI/(πr³)", "N/m"}, lines),
                     "Bending: a tube that stays round has the same value as in stretch."});
  lines = by_potential(tubes, radius, twist);
  lines.push_back(level("ab initio", 345 / (2 * 1.149), lines, 5));
  figures.push_back(
      {chart("GJ over that of a thin wall", r, {"GJ/(2πr³)", "N/m"}, lines),
       "Twist: the shear stiffness of the sheet. Ab initio: 150 N/m, from 345 N/m and a Poisson ratio of "
       "0.149 (the same source)."});
  lines = by_potential(tubes, radius, [](const ParametrizedTube& t) {
    return t.set.law<LineParameters>() ? t.set.law<LineParameters>()->pair_energy : std::nan("");
  });
  figures.push_back(
      {chart("Energy of two parallel tubes", r, {"energy per length", "eV/nm"}, lines),
       "Cohesion of two parallel tubes at rest. It follows from the Lennard-Jones law between atoms and "
       "hardly from the potential within a tube."});
  lines = by_potential(tubes, chiral_degrees, [](const ParametrizedTube& t) {
    const Quantity* q = find_quantity(t.set, "atomistic.natural_twist");
    return q ? 100 * q->value * t.set.radius : std::nan("");
  });
  figures.push_back(
      {chart("Natural twist against the chiral angle", {"chiral angle", "degrees"},
             {"radius times natural twist", "%"}, lines),
       "Natural twist of the relaxed tube against the rolled sheet, times the radius. It vanishes at 0 "
       "and 30 degrees by symmetry."});
  return figures;
}

std::string overview_row(const ParametrizedTube& t) {
  if (!t.error.empty())
    return fmt::format("<tr><td>{}</td><td>{}</td><td colspan=\"10\">no set: {}</td></tr>\n", escape_markup(t.tube),
                       escape_markup(t.name), escape_markup(t.error));
  const auto cell = [&](const char* key) {
    const Quantity* q = find_quantity(t.set, key);
    return fmt::format("<td class=\"number\">{}</td>", q ? measured_text(*q) : "not known");
  };
  const Check* rope = worst_rope(t);
  return fmt::format("<tr><td>{}</td><td><a href=\"{}.html\">{}</a></td>", escape_markup(t.tube), t.name,
                     escape_markup(t.name)) +
         cell("tube.radius") + cell("bond.EA") + cell("bond.EI") + cell("bond.GJ") +
         cell("atomistic.natural_twist") + cell("contact.line.pair_spacing") + cell("contact.line.pair_energy") +
         fmt::format(
             "<td>{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n", (t.holds() ? "✓ " : "✗ ") + t.verdict(),
             rope ? number_text(100 * std::fabs(rope->difference()), 2) + " %" : "", escape_markup(t.grade()));
}

// The spread of the sets of each tube that has several, by potentials.
std::string spread_part(const std::vector<ParametrizedTube>& tubes) {
  std::map<std::string, std::vector<const ParametrizedTube*>> groups;
  for (const ParametrizedTube& t : tubes)
    if (t.error.empty()) groups[t.tube].push_back(&t);
  std::vector<ReportFact> facts;
  for (const auto& [tube, sets] : groups) {
    if (sets.size() < 2) continue;
    const auto spread = [&, &all = sets](const std::function<double(const ParametrizedTube&)>& value) {
      double least = 1e300, most = -1e300;
      for (const ParametrizedTube* t : all) least = std::min(least, value(*t)), most = std::max(most, value(*t));
      return number_text(100 * (most / least - 1), 3) + " %";
    };
    facts.push_back(
        {tube,
         fmt::format("EA {}, EI {}, GJ {}", spread([](const ParametrizedTube& t) { return t.set.bond.stretch; }),
                     spread([](const ParametrizedTube& t) { return t.set.bond.bend; }),
                     spread([](const ParametrizedTube& t) { return t.set.bond.twist; })),
         fmt::format("largest over smallest of {} potentials", sets.size())});
  }
  if (facts.empty()) return "";
  return heading("Spread between potentials") +
         paragraph(
             "Potentials of carbon differ by far more than the errors of a calibration. A result for a real tube "
             "is no better than this.") +
         facts_part(facts);
}

}  // namespace

std::string tube_page(const ParametrizedTube& t) {
  PageTop top;
  top.kicker = "a nanotube, from its atoms to a validated parameter set";
  top.title = fmt::format("{}, potential {}", t.tube, provenance_value(t.set, "potential"));
  top.html = heading("What the set is for") + uses_part(t) + heading("The numbers") + numbers_part(t) +
             paragraph("Set <b>" + escape_markup(t.name) + ".toml</b>, grade: " + escape_markup(t.grade()) +
                       ". Its tables lie beside it. <code>ropewalk calibrate "
                       "show " +
                       escape_markup(t.name) + ".toml</code> draws every fit.") +
             friction_part(t) + heading("Limits") + limits_part(t) + heading("What was compared");
  std::vector<std::string> facts = page_facts(t.outcomes);
  facts.insert(facts.begin(), times(t));
  return validation_page(t.outcomes, facts, top);
}

std::string overview_page(const std::vector<ParametrizedTube>& tubes) {
  Figures figures;
  std::string head = page_head("Nanotubes");
  head.insert(head.find("</style>"), ".tubes td{white-space:nowrap}\n");
  std::string html =
      head +
      "<body>\n<main>\n<p class=\"kicker\">Ropewalk: from atoms to validated parameter sets</p>\n"
      "<h1>Nanotubes</h1>\n<div class=\"scroll\"><table class=\"facts tubes\"><thead><tr><th>Tube</th><th>Set</th>";
  for (const char* title : {"Radius, nm", "EA, nN", "EI, nN nm²", "GJ, nN nm²", "Natural twist, rad/nm",
                            "Spacing, nm", "Pair energy, eV/nm"})
    html += fmt::format("<th class=\"number\">{}</th>", title);
  html += "<th>Validation</th><th class=\"number\">Ropes</th><th>Grade</th></tr></thead><tbody>\n";
  for (const ParametrizedTube& t : tubes) html += overview_row(t);
  html += "</tbody></table></div>\n" +
          paragraph(
              "Ropes: the largest difference of twisting energies from atoms, ropes of seven tubes, up to r τ = "
              "0.04. The first error is that of the calibration, the second how far potentials lie apart.");
  const std::vector<Figure> all = overview_figures(tubes);
  for (std::size_t k = 0; k < all.size(); k += 2) {
    html += "<div class=\"pair\">\n";
    for (std::size_t i = k; i < std::min(k + 2, all.size()); ++i) {
      const std::string svg = chart_svg(all[i].chart);
      if (!svg.empty()) html += "<figure>" + svg + figures.caption(escape_markup(all[i].caption)) + "</figure>\n";
    }
    html += "</div>\n";
  }
  html += spread_part(tubes) + heading("Time");
  for (const ParametrizedTube& t : tubes)
    if (t.error.empty()) html += paragraph(escape_markup(t.name + ". " + times(t)));
  return html + "</main>\n</body>\n</html>\n";
}

std::string tubes_csv(const std::vector<ParametrizedTube>& tubes) {
  constexpr std::pair<const char*, const char*> columns[] = {
      {"tube.radius", "radius_nm"},
      {"bond.EA", "EA_nN"},
      {"bond.EI", "EI_nN_nm2"},
      {"bond.GJ", "GJ_nN_nm2"},
      {"atomistic.coupling", "coupling_nN_nm"},
      {"atomistic.natural_twist", "natural_twist_rad_per_nm"},
      {"contact.line.pair_spacing", "pair_spacing_nm"},
      {"contact.line.pair_energy", "pair_energy_eV_per_nm"},
      {"contact.line.cross90_energy", "cross90_energy_eV"}};
  std::string text = "set,n,m,potential,chiral_angle_deg";
  for (const auto& [key, name] : columns) text += fmt::format(",{0},{0}_standard_error", name);
  text += ",registry,grade,verdict,rope_difference,calibration_s,validation_s\n";
  for (const ParametrizedTube& t : tubes) {
    if (!t.error.empty()) continue;
    text += fmt::format("{},{},{},{},{:.4f}", t.name, t.set.chirality.n, t.set.chirality.m,
                        provenance_value(t.set, "potential"), chiral_degrees(t));
    for (const auto& [key, name] : columns) {
      const Quantity* q = find_quantity(t.set, key);
      text += q ? fmt::format(",{:.10g},{:.3g}", q->value, q->standard_error.value_or(0)) : ",,";
    }
    const Check* rope = worst_rope(t);
    text += fmt::format(",{:.4g},\"{}\",{},{},{:.1f},{:.1f}\n", registry_deviation(t.set), t.grade(), t.verdict(),
                        rope ? fmt::format("{:.4g}", rope->difference()) : "", t.calibration_seconds,
                        t.validation_seconds());
  }
  return text;
}

}  // namespace ropewalk::validate
