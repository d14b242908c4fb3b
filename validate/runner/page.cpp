#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/formula.hpp"
#include "report/scatter.hpp"
#include "runner/runner.hpp"

namespace ropewalk::validate {
namespace {

const char* verdict_css = R"(
.verdicts td,.verdicts th{padding:5px 16px 5px 0}
.verdict{font-weight:600;white-space:nowrap}
.good{color:#197a3a}.bad{color:#c0271d}.dim{color:var(--soft)}
@media(prefers-color-scheme:dark){.good{color:#5fc784}.bad{color:#ff7b6e}}
.case{scroll-margin-top:1em}
.facts .number,.limits td:nth-child(4){white-space:nowrap}
.map{width:180px;height:18px;display:block}
.map .band{fill:var(--rule)}.map .axis{stroke:var(--soft)}.map .dot{fill:#197a3a}.map .off{fill:#c0271d}
@media(prefers-color-scheme:dark){.map .dot{fill:#5fc784}.map .off{fill:#ff7b6e}}
)";

std::string verdict_html(const Outcome& o) {
  switch (o.verdict()) {
    case Outcome::Verdict::holds:
      return "<span class=\"verdict good\">✓ holds</span>";
    case Outcome::Verdict::misses:
      return "<span class=\"verdict bad\">✗ misses</span>";
    case Outcome::Verdict::not_applicable:
      return "<span class=\"verdict dim\">not applicable</span>";
    case Outcome::Verdict::failed:
      return "<span class=\"verdict bad\">✗ could not be run</span>";
  }
  return "";
}

// A space and the unit; nothing for a plain number.
std::string unit_of(const Check& c) { return c.unit.empty() || c.unit == "1" ? "" : " " + c.unit; }

std::string percent(const Check& c) {
  if (!std::isfinite(c.value)) return "not finite";
  return c.relative ? number_text(100 * c.difference(), 3) + " %"
                    : number_text(c.difference(), 3) + escape_markup(unit_of(c));
}

std::string allowed(const Check& c) {
  if (c.informative) return "<span class=\"dim\">shown only</span>";
  if (c.known) {
    const double scale = c.relative ? 100 : 1;
    return fmt::format("known miss: {} to {}{}", number_text(scale * (c.known->expected - c.known->spread), 3),
                       number_text(scale * (c.known->expected + c.known->spread), 3),
                       c.relative ? " %" : escape_markup(unit_of(c)));
  }
  return c.relative ? number_text(100 * c.tolerance, 3) + " %"
                    : number_text(c.tolerance, 3) + escape_markup(unit_of(c));
}

// The check that uses most of its tolerance.
const Check* worst_check(const CaseResult& r) {
  const Check* worst = nullptr;
  double ratio = -1;
  for (const Check& c : r.checks) {
    if (c.informative || c.known) continue;
    const double used = std::isfinite(c.value) ? std::fabs(c.difference()) / c.tolerance : 1e300;
    if (used > ratio) {
      ratio = used;
      worst = &c;
    }
  }
  return worst;
}

std::string summary_row(const Outcome& o) {
  const Case& c = find_case(o.name);
  std::string tight = "<td></td>";
  if (const Check* w = worst_check(o.result))
    tight = fmt::format("<td>{}: {} of {} allowed</td>", with_formulas(w->name), percent(*w), allowed(*w));
  if (!o.error.empty()) tight = "<td>" + escape_markup(o.error) + "</td>";
  if (!o.not_applicable.empty()) tight = "<td class=\"dim\">" + with_formulas(o.not_applicable) + "</td>";
  const std::string title = escape_markup(o.with_tubes(c.title));
  const std::string name = o.not_applicable.empty() ? fmt::format("<a href=\"#{}\">{}</a>", o.name, title) : title;
  return fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>{}<td class=\"dim\">{}</td></tr>\n", verdict_html(o),
                     name, o.not_applicable.empty() ? escape_markup(o.tubes) : "", tight, group_name(c.group));
}

std::string checks_table(const CaseResult& r) {
  if (r.checks.empty()) return "";
  std::string html =
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th></th><th>Quantity</th><th "
      "class=\"number\">Model</th>"
      "<th class=\"number\">Oracle</th><th>Unit</th><th class=\"number\">Difference</th><th "
      "class=\"number\">Allowed</th>"
      "<th></th></tr></thead><tbody>\n";
  for (const Check& c : r.checks)
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"dim\">{}</td></tr>\n",
        c.informative          ? ""
        : c.holds() && c.known ? "<span class=\"dim\">✗</span>"
        : c.holds()            ? "<span class=\"good\">✓</span>"
                               : "<span class=\"bad\">✗</span>",
        with_formulas(c.name), number_text(c.value, 6), number_text(c.reference, 6), escape_markup(c.unit),
        percent(c), allowed(c), with_formulas(c.note));
  return html + "</tbody></table></div>\n";
}

std::string figure_html(const CaseFigure& f, Figures& figures) {
  const std::string svg = scatter_svg({f.chart, f.labels});
  if (svg.empty()) return "";
  std::vector<TableColumn> columns;
  // The table has the lines that share the abscissa of the first.
  for (const ChartLine& line : f.chart.lines) {
    if (columns.empty()) columns.push_back({f.chart.x.quantity + " (" + f.chart.x.unit + ")", line.x});
    if (line.x == columns[0].values) columns.push_back({line.name, line.y});
  }
  return "<figure>" + svg + figures.caption(with_formulas(f.caption)) +
         data_table(columns, "The JSON file of the case has all lines.") + "</figure>\n";
}

std::string figures_html(const std::vector<CaseFigure>& all, bool on_map, Figures& figures) {
  std::string html;
  int drawn = 0;
  for (const CaseFigure& f : all) {
    const std::string figure = f.on_map == on_map ? figure_html(f, figures) : "";
    if (figure.empty()) continue;
    if (drawn % 2 == 0) html += drawn == 0 ? "<div class=\"pair\">\n" : "</div>\n<div class=\"pair\">\n";
    html += figure;
    ++drawn;
  }
  return drawn == 0 ? "" : html + "</div>\n";
}

std::string case_html(const Outcome& o, Figures& figures) {
  const Case& c = find_case(o.name);
  std::string html = fmt::format("<section class=\"case\" id=\"{}\">\n{}", o.name, heading(o.with_tubes(c.title)));
  html += paragraph(verdict_html(o) + ". " + with_formulas(c.why));
  html += paragraph("<b>Set-up.</b> " + with_formulas(o.with_tubes(c.setup)) + " <b>Oracle.</b> " +
                    with_formulas(o.with_tubes(c.oracle)));
  if (!o.error.empty()) html += paragraph("<span class=\"bad\">" + escape_markup(o.error) + "</span>");
  html += checks_table(o.result) + figures_html(o.result.figures, false, figures);
  for (const std::string& r : o.result.remarks) html += paragraph(with_formulas(r));
  std::string sources = "<span class=\"soft\">Run it again: <code>ropewalk validate run " + o.name + "</code>. ";
  for (const std::string& s : o.result.sources) sources += "Reference: " + escape_markup(s) + ". ";
  if (!c.literature.empty()) sources += escape_markup(c.literature);
  return html + paragraph(sources + "</span>") + "</section>\n";
}

// --- The map of all limits --------------------------------------------------------------------------------

constexpr double agreement = 0.05;       // relative difference of found and theory that the cases allow
constexpr double drawn = 2 * agreement;  // half the width of the strip

// Found over theory, as a dot on a strip with a band of the allowed values.
std::string strip(double ratio) {
  constexpr double half = 90;
  if (!std::isfinite(ratio)) return "";
  const auto at = [&](double r) { return half * (1 + std::clamp((r - 1) / drawn, -0.97, 0.97)); };
  return fmt::format(
      "<svg class=\"map\" viewBox=\"0 0 180 18\" role=\"img\" aria-label=\"found over theory {0:.4f}\">"
      "<rect class=\"band\" x=\"{1:.1f}\" y=\"2\" width=\"{2:.1f}\" height=\"14\"/>"
      "<line class=\"axis\" x1=\"90\" x2=\"90\" y1=\"0\" y2=\"18\"/>"
      "<circle class=\"{3}\" cx=\"{4:.1f}\" cy=\"9\" r=\"4\"/></svg>",
      ratio, at(1 - agreement), at(1 + agreement) - at(1 - agreement),
      std::fabs(ratio - 1) <= agreement ? "dot" : "off", at(ratio));
}

const char* guard_words(Limit::Guard guard) {
  switch (guard) {
    case Limit::Guard::refused:
      return "refused before the start";
    case Limit::Guard::stopped:
      return "stopped with the reason";
    case Limit::Guard::told:
      return "reported";
    case Limit::Guard::none:
      return "none";
  }
  return "";
}

std::string limit_row(const Limit& l, const std::string& name) {
  return fmt::format(
      "<tr><td><a href=\"#{}\">{}</a></td><td class=\"number\">{}</td><td "
      "class=\"number\">{}</td><td>{}</td><td>{}</td>"
      "<td><b>{}</b></td><td class=\"dim\">{}</td></tr>\n",
      name, with_formulas(l.method), number_text(l.found), number_text(l.theory), escape_markup(l.unit),
      strip(l.found / l.theory), guard_words(l.guard), with_formulas(l.how));
}

std::string limits_map(const std::vector<Outcome>& outcomes, Figures& figures) {
  std::string rows;
  std::vector<CaseFigure> steps;
  for (const Outcome& o : outcomes) {
    for (const Limit& l : o.result.limits) rows += limit_row(l, o.name);
    steps.insert(steps.end(), o.result.figures.begin(), o.result.figures.end());
  }
  if (rows.empty()) return "";
  return heading("The map") + figures_html(steps, true, figures) +
         paragraph(
             "The place where each method fails, found by bisection on the method itself, with theory beside it "
             "and "
             "with what <code>ropewalk run</code> does there. The dot is found over theory; the band is 5 % to "
             "either "
             "side, the strip 10 %.") +
         "<div class=\"scroll\"><table class=\"facts limits\"><thead><tr><th>Limit</th><th "
         "class=\"number\">Found</th>"
         "<th class=\"number\">Theory</th><th>Unit</th><th>Found over theory</th><th>Guard of a "
         "run</th><th></th></tr>"
         "</thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string lead(const std::vector<Outcome>& outcomes) {
  const auto count = [&](Outcome::Verdict v) {
    return std::count_if(outcomes.begin(), outcomes.end(), [&](const Outcome& o) { return o.verdict() == v; });
  };
  const auto good = count(Outcome::Verdict::holds), miss = count(Outcome::Verdict::misses),
             failed = count(Outcome::Verdict::failed), apart = count(Outcome::Verdict::not_applicable);
  const auto known = std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) {
    return o.verdict() == Outcome::Verdict::holds &&
           std::any_of(o.result.checks.begin(), o.result.checks.end(),
                       [](const Check& c) { return c.known.has_value(); });
  });
  std::string text = fmt::format("{} of {} cases hold", good - known, static_cast<long>(outcomes.size()) - apart);
  if (known > 0) text += fmt::format(", {} with a known miss", known);
  if (miss > 0) text += fmt::format(", <b class=\"bad\">{} {}</b>", miss, miss == 1 ? "misses" : "miss");
  if (failed > 0) text += fmt::format(", <b class=\"bad\">{} could not be run</b>", failed);
  if (apart > 0) text += fmt::format("; {} are not applicable to this set, for the reasons given", apart);
  return text +
         ". A case holds if every number of the model lies within its tolerance. Tolerances were fixed before the "
         "cases were run, or the case says why not; no reference was used in a fit. A case that misses names the "
         "assumption that fails.";
}

PageTop top_of(const std::vector<Outcome>& outcomes) {
  const bool limits = !outcomes.empty() && std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) {
    return find_case(o.name).group == Case::Group::stability;
  });
  if (limits) return {"where the methods fail, by bisection and by theory", "Stability", ""};
  return {"the model against exact theory, atoms and other codes", "Validation", ""};
}

}  // namespace

std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts) {
  return validation_page(outcomes, facts, top_of(outcomes));
}

std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts,
                            const PageTop& top) {
  Figures figures;
  std::string head = page_head(top.title);
  head.insert(head.find("</style>"), verdict_css);
  std::string html = head + "<body>\n<main>\n<p class=\"kicker\">Ropewalk: " + escape_markup(top.kicker) +
                     "</p>\n<h1>" + escape_markup(top.title) + "</h1>\n<p class=\"lead\">" + lead(outcomes) +
                     "</p>\n" + top.html +
                     "<div class=\"scroll\"><table class=\"verdicts\"><thead><tr><th>Verdict</th>"
                     "<th>Case</th><th>Tube</th><th>Tightest check</th><th>Against</th></tr></thead><tbody>\n";
  for (const Outcome& o : outcomes) html += summary_row(o);
  html += "</tbody></table></div>\n" + limits_map(outcomes, figures);
  for (const Outcome& o : outcomes)
    if (o.not_applicable.empty()) html += case_html(o, figures);
  html += heading("How this page was made");
  for (const std::string& f : facts) html += paragraph(escape_markup(f));
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace ropewalk::validate
