#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/potential_spread.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t max_rows = 60;  // rows of a table under a chart
constexpr int max_decimals = 9;       // decimals of a number beside its error

// Decimals of a column: five digits of the largest value, and the same decimals in all rows.
int decimals_of(const TableColumn& column) {
  double largest = 0;
  bool whole = true;
  for (const double v : column.values)
    if (std::isfinite(v)) {
      largest = std::max(largest, std::abs(v));
      whole = whole && v == std::floor(v);
    }
  if (whole || largest == 0) return 0;
  return std::min(12, std::max(0, 4 - static_cast<int>(std::floor(std::log10(largest)))));
}

// nm^2 as nm²; escaped.
std::string with_powers(std::string text) {
  for (const auto& [from, to] : {std::pair("^2", "²"), std::pair("^3", "³"), std::pair("^4", "⁴")})
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from)) text.replace(at, 2, to);
  return escape_markup(text);
}

// The value with as many digits as its error allows, or with seven digits where it has no error.
std::string value_text(const Quantity& q) {
  if (std::isnan(q.value)) return "–";
  const double error = q.standard_error.value_or(0);
  const int decimals = error > 0 && std::isfinite(error) ? decimals_of_error(error) : max_decimals + 1;
  std::string text = decimals > max_decimals       ? fmt::format("{:.7g}", q.value)
                     : vanishes(q.value, decimals) ? "0"
                                                   : fmt::format("{:.{}f}", q.value, decimals);
  if (text[0] == '-') text.replace(0, 1, "−");
  return text;
}

const char* page_css = R"(*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);overflow-wrap:break-word;
font:17px/1.55 Charter,"Bitstream Charter","Iowan Old Style",Palatino,"Liberation Serif",Georgia,serif}
main{max-width:1130px;margin:0 auto;padding:40px 28px 72px}
p,ul,.warnings{max-width:74ch}
h1{font-size:2.1rem;line-height:1.15;margin:.1em 0 .5em;font-weight:600;letter-spacing:-.01em;
overflow-wrap:anywhere}
h2{font-size:1.35rem;margin:1.7em 0 .7em;padding-top:.7em;border-top:1px solid var(--rule);font-weight:600}
h3,.kicker,.tag,.cut,.keys,details,table,th{
font-family:"Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif}
h3{font-size:.86rem;margin:0 0 .5em;font-weight:600}
.kicker{margin:0;color:var(--soft);font-size:.82rem;letter-spacing:.04em}
.lead{font-size:1.08rem}
.soft,.none{color:var(--soft)}
img{max-width:100%;height:auto}
figure{margin:0 0 1.9em;min-width:0;break-inside:avoid}
figcaption{font-size:.86rem;line-height:1.45;color:var(--soft);max-width:80ch;margin-top:.5em}
figcaption b{color:var(--ink)}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:0 34px}
.pair figure{margin-bottom:1.3em}
.strip{break-inside:auto}.view{max-width:100%;break-inside:avoid}
.views{display:flex;flex-wrap:wrap;gap:14px 28px;align-items:flex-start;margin-bottom:12px}
.tag{font-size:.82rem;font-variant-numeric:tabular-nums;font-weight:600;margin-bottom:2px}
.row{display:grid;gap:22px;grid-template-columns:repeat(auto-fill,minmax(130px,1fr))}
.row.few{grid-template-columns:repeat(auto-fill,minmax(190px,1fr))}
.cut{font-size:.82rem;line-height:1.5;font-variant-numeric:tabular-nums}
.cut svg{display:block;margin-bottom:6px}
.keys{font-size:.82rem;margin-top:16px;display:flex;flex-wrap:wrap;gap:4px 20px}
.keys svg{vertical-align:-2px}
.warnings{border:1px solid var(--c1);border-left-width:5px;border-radius:3px;padding:10px 18px;margin:1.4em 0}
.warnings ul{margin:.3em 0;padding-left:1.2em}
details{font-size:.82rem;margin-top:.5em}
summary{cursor:pointer;color:var(--soft);width:max-content;max-width:100%}
details p{margin:.5em 0;color:var(--soft)}
.legend>span{display:inline-block;margin-right:1.1em}
.scroll{overflow-x:auto;margin-bottom:1em}
@media screen{.scroll{background:linear-gradient(90deg,var(--paper) 30%,transparent) 0 0/40px 100% local no-repeat,
linear-gradient(270deg,var(--paper) 30%,transparent) 100% 0/40px 100% local no-repeat,
linear-gradient(90deg,var(--rule),transparent) 0 0/12px 100% no-repeat,
linear-gradient(270deg,var(--rule),transparent) 100% 0/12px 100% no-repeat}}
.wide svg{min-width:640px}a{color:var(--c0)}
math{font-family:"STIX Two Math","STIX Math","Latin Modern Math","Cambria Math","DejaVu Math TeX Gyre",math;
font-size:1.05em;padding:.13em 0}
mfrac>*{font-size:.84em}
table{border-collapse:collapse;font-size:.82rem;line-height:1.4;font-variant-numeric:tabular-nums}
th,td{padding:3px 14px 3px 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
thead th{color:var(--soft);font-weight:600;border-bottom-color:var(--soft)}
.numbers th,.numbers td,.number{text-align:right!important}
.numbers td,.numbers th{white-space:nowrap}
.numbers thead th,.numbers td.soft{white-space:normal}.numbers thead th{vertical-align:bottom}
.numbers td.soft{min-width:8em;text-align:left!important}
.facts tbody th{font-weight:600;padding-right:26px;white-space:nowrap}
.facts td{overflow-wrap:anywhere}
.facts td.number,.whole td{overflow-wrap:normal!important}
@media(max-width:600px){.facts td{min-width:6em}.facts td.number{min-width:0}
.facts:not(.numbers) tbody th{white-space:normal;overflow-wrap:anywhere;padding-right:12px}}
@page{margin:13mm 14mm}
@media print{html{font-size:12px}body{font-size:8.6pt;line-height:1.35}main{max-width:none;padding:0}
p,ul,.warnings,figcaption{max-width:none}.lead{font-size:1em}a{color:inherit}p{margin:.5em 0}
h1{font-size:1.7rem;margin:0 0 .2em}h2{font-size:1.15rem;margin:.6em 0 .3em;padding-top:.4em;break-after:avoid}h3{margin:0 0 .2em}
figure,.pair figure{margin-bottom:.5em}figcaption{font-size:.9em;line-height:1.25;margin-top:.2em}
.pair{grid-template-columns:1fr 1fr;gap:0 18px}.pair svg{width:auto;max-width:100%;max-height:43mm}
.views{display:grid;grid-template-columns:repeat(3,1fr);gap:4px 14px;margin-bottom:6px}.views svg{width:100%;height:auto}
.row{grid-template-columns:repeat(6,1fr);gap:8px}.cut svg{width:100%;height:auto;margin-bottom:2px}.keys{margin-top:6px}
details{display:none}.scroll{overflow:visible}.wide svg{min-width:0}.numbers td,.numbers th{white-space:normal}
table{font-size:.74em;line-height:1.2;width:100%}th,td,.facts tbody th{padding:1px 8px 1px 0}tr{break-inside:avoid}
figure>.chart{width:auto;max-height:60mm}.columns{columns:2;column-gap:18px}.columns table{font-size:.68em}.columns th,.columns td{padding-right:5px}
.columns td:not(:first-child){overflow-wrap:normal}}
)";

}  // namespace

std::string paragraph(const std::string& html) { return "<p>" + html + "</p>\n"; }

std::string heading(const std::string& text) { return "<h2>" + escape_markup(text) + "</h2>\n"; }

std::string head_cell(const std::string& name, const std::string& meaning) {
  std::string text;
  for (const char c : escape_markup(name)) text += c == '_' ? "_<wbr/>" : std::string(1, c);
  return (meaning.empty() ? "<th>" : fmt::format("<th title=\"{}\">", escape_markup(meaning))) + text + "</th>";
}

std::string Figures::caption(const std::string& html) {
  return fmt::format("<figcaption><b>Figure {}.</b> {}</figcaption>\n", ++number_, html);
}

std::vector<std::size_t> evenly(std::size_t n, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t m = std::min(n, most);
  for (std::size_t k = 0; k < m; ++k) chosen.push_back(m < 2 ? k : (k * (n - 1) + (m - 1) / 2) / (m - 1));
  return chosen;
}

std::string data_table(const std::vector<TableColumn>& columns, const char* source) {
  const std::size_t n = columns.empty() ? 0 : columns[0].values.size();
  const std::vector<std::size_t> rows = evenly(n, max_rows);
  std::string html = "<details><summary>Numbers</summary>\n";
  html += paragraph(rows.size() < n ? fmt::format("{} of {} rows. {}", rows.size(), n, source)
                                    : fmt::format("All {} rows. {}", n, source));
  html += "<div class=\"scroll\"><table class=\"numbers\"><thead><tr>";
  for (const TableColumn& c : columns) html += head_cell(c.title);
  html += "</tr></thead><tbody>\n";
  std::vector<int> decimals;
  for (const TableColumn& c : columns) decimals.push_back(decimals_of(c));
  for (const std::size_t r : rows) {
    html += "<tr>";
    for (std::size_t k = 0; k < columns.size(); ++k)
      html += "<td>" + fixed_text(columns[k].values[r], decimals[k]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div></details>\n";
}

namespace {

// Between interatomic potentials of carbon, in the unit of the quantity; 0: none.
double spread_of(const Quantity& q) { return q.of_carbon ? potential_spread(q.key) * std::fabs(q.value) : 0; }

}  // namespace

std::string measured_text(const Quantity& q, bool and_unit) {
  std::string text = measured_text(q.value, q.standard_error.value_or(0));
  if (const double spread = spread_of(q); spread > 0) {
    const double unit = std::pow(10.0, std::floor(std::log10(spread)) - 1);  // unit of its second digit
    text += fmt::format(" ± {:g} (potential)", std::round(spread / unit) * unit);
  }
  return and_unit && q.unit != "1" ? text + " " + q.unit : text;
}

std::string facts_part(const std::vector<ReportFact>& facts) {
  std::string html = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
  for (const ReportFact& f : facts)
    html += fmt::format("<tr><th>{}</th><td>{}</td><td class=\"soft\">{}</td></tr>\n", escape_markup(f.key),
                        with_powers(f.value), with_powers(f.remark));
  return html + "</tbody></table></div>\n";
}

std::string parameters_part(const std::string& name, const std::string& reference,
                            const std::vector<Quantity>& parameters) {
  std::string html;
  if (!name.empty())
    html += paragraph(fmt::format("Set <b>{}</b>{}{}.", escape_markup(name), reference.empty() ? "" : ", after ",
                                  escape_markup(reference)));
  if (parameters.empty()) return html + paragraph("No parameters are listed.");
  html +=
      "<div class=\"scroll columns\"><table class=\"facts\"><thead><tr><th>Parameter</th><th "
      "class=\"number\">Value</th>"
      "<th>Unit</th><th>Standard error</th><th>Between potentials</th><th>Origin</th><th>DOI</th></tr></thead>"
      "<tbody>\n";
  for (const Quantity& q : parameters)
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape_markup(q.key), value_text(q), with_powers(q.unit),
        q.standard_error ? number_text(*q.standard_error, 2) : "<span class=\"soft\">not published</span>",
        spread_of(q) > 0 ? number_text(spread_of(q), 2) : "",
        escape_markup(q.origin), escape_markup(q.doi));
  return html + "</tbody></table></div>\n";
}

std::string warnings_part(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string html = "<div class=\"warnings\" role=\"note\"><b>Warnings</b><ul>\n";
  for (const std::string& w : warnings) html += "<li>" + escape_markup(w) + "</li>\n";
  return html + "</ul></div>\n";
}

namespace {

std::string head(const std::string& name, const std::string& allowed, const std::string& more_css) {
  return std::string(
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
             "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; ") +
         allowed +
         "\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
         "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>" +
         escape_markup(name) + " – Ropewalk</title>\n<style>\n" + svg_css() + page_css + more_css +
         "</style>\n</head>\n";
}

}  // namespace

std::string page_head(const std::string& name) { return head(name, "style-src 'unsafe-inline'", ""); }

std::string scripted_page_head(const std::string& name, const std::string& css, const std::string& nonce) {
  return head(name, "style-src 'unsafe-inline'; script-src 'nonce-" + nonce + "'", css);
}

}  // namespace ropewalk
