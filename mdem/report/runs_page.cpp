#include "report/runs_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/log_mean.hpp"
#include "report/log_figures.hpp"
#include "report/page.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

// Columns of most comparisons, drawn where they vary.
const char* const usual[] = {
    "torque_nN_nm", "tension_upper_nN", "stored_MJ_per_kg", "ends_strain", "beta_deg", "Q",
    "amplitude_nm",       "void_area_nm2",    "vdw_eV",           "kinetic_eV"};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// `rows` are those of the log of the run or of its errors.
std::vector<double> values_in(const RunCurve& run, const std::string& column, const std::vector<LogRow>& rows) {
  return values_of(rows, curve_column(column, run.log).value);
}

bool varies(const std::vector<RunCurve>& runs, const std::string& column) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const RunCurve& run : runs)
    for (const double v : values_in(run, column, run.log))
      if (std::isfinite(v)) least = std::min(least, v), most = std::max(most, v);
  return most - least > 1e-9 * std::max(std::fabs(most), std::fabs(least));
}

std::vector<std::string> columns_of(const std::vector<RunCurve>& runs, const RunsFigure& figure) {
  std::vector<std::string> out = figure.y;
  if (out.empty())
    for (const char* column : usual)
      if (column != figure.x && varies(runs, column)) out.push_back(column);
  return out;
}

// Names that leave no room for the curves are numbers on the page, which its first table explains.
constexpr std::size_t longest_label = 26;
bool are_long(const std::vector<RunCurve>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const RunCurve& r) { return r.name.size() > longest_label; });
}
std::string label_of(const std::vector<RunCurve>& runs, std::size_t k) {
  return are_long(runs) ? fmt::format("{}", k + 1) : runs[k].name;
}

// Many runs follow one another in colour; few are told apart.
int colour_of(std::size_t k, std::size_t n) {
  return n <= static_cast<std::size_t>(categorical_colours) ? static_cast<int>(k) : sequential_colour(k, n);
}

ScatterChart chart_of(const std::vector<RunCurve>& runs, const RunsFigure& figure, const std::string& column) {
  ScatterChart scatter;
  LineChart& chart = scatter.chart;
  chart.title = column_axis(column).quantity + " against " + column_axis(figure.x).quantity;
  chart.x = column_axis(figure.x);
  chart.y = column_axis(column);
  chart.y.decades = figure.y_decades;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunCurve& run = runs[k];
    ChartLine line{label_of(runs, k), values_in(run, figure.x, run.log), values_in(run, column, run.log),
                   colour_of(k, runs.size())};
    line.beyond = rows_within(run.log, run.limits);
    if (!run.error.empty() && !figure.y_decades) line.error = values_in(run, column, run.error);
    for (const double v : line.x)
      if (std::isfinite(v)) least = std::min(least, v), most = std::max(most, v);
    chart.lines.push_back(std::move(line));
  }
  for (const ReferenceLevel& level : figure.levels)
    chart.lines.push_back({level.name, {least, most}, {level.value, level.value}, 5, true});
  return scatter;
}

std::string pictures(const std::vector<RunCurve>& runs, Figures& figures) {
  std::vector<RopeView> views;
  double radius = 0;
  for (const RunCurve& run : runs)
    if (run.view) views.push_back(*run.view), radius = std::max(radius, run.tube_radius);
  if (views.empty()) return "";
  RopeCamera camera = rope_camera(views, radius, 1040);
  std::string html = heading("Last states") + "<figure class=\"strip\"><div class=\"views\">\n";
  std::size_t k = 0;
  for (const RunCurve& run : runs) {
    if (!run.view) continue;
    html += fmt::format("<div class=\"view\"><div class=\"tag\">{}, {} ps</div>\n", escape_markup(run.name),
                        number_text(run.view->time_ps, 4));
    html +=
        rope_picture(*run.view, camera, run.tube_radius, fmt::format("r{}", k), k + 1 == views.size()) + "</div>\n";
    ++k;
  }
  html += "</div>\n";
  if (camera.coloured()) html += colour_bar(camera);
  return html +
         figures.caption(
             fmt::format("All at the same scale; the bar is {:g} nm long. Colour: modulus of the bending "
                         "moment of the tube, where frames have it.",
                         scale_bar_length(camera))) +
         "</figure>\n";
}

std::vector<TableColumn> table_of(const std::vector<RunCurve>& runs, const std::string& x, const std::string& y) {
  std::vector<TableColumn> columns;
  std::size_t rows = 0;
  for (const RunCurve& run : runs) rows = std::max(rows, run.log.size());
  for (const RunCurve& run : runs)
    for (const std::string& name : {x, y}) {
      columns.push_back({run.name + ", " + name, values_in(run, name, run.log)});
      columns.back().values.resize(rows, nan);
    }
  return columns;
}

std::string end_text(const RunCurve& run, const std::string& column) {
  const auto text = [](double value, double error) {
    return std::isfinite(value) ? measured_text(value, error) : std::string("–");
  };
  const LogValue value = curve_column(column, run.log).value;
  if (!run.means) return text(value(run.log.back()), run.error.empty() ? nan : value(run.error.back()));
  const RunMeans& m = *run.means;
  std::string words = text(value(m.value), value(m.error));
  if (value(m.needed_ps) > 0)
    words += fmt::format(" <span class=\"soft\">too short for an error, {} ps would do</span>",
                         number_text(value(m.needed_ps), 2));
  else if (const double correlation = value(m.correlation_ps); std::isfinite(correlation))
    words += fmt::format(" <span class=\"soft\">correlated over {} ps</span>", number_text(correlation, 2));
  return words;
}

std::string ends(const std::vector<RunCurve>& runs, const std::vector<std::string>& columns) {
  std::string html =
      "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th></th><th>run</th><th>rows</th>";
  for (const OutputColumn& c : limit_columns()) html += head_cell(c.name, c.meaning);
  for (const std::string& c : columns) html += head_cell(c, curve_column(c, {}).meaning);
  html += "<th></th></tr></thead><tbody>\n";
  std::size_t k = 0;
  for (const RunCurve& run : runs) {
    html += fmt::format("<tr><td>{}</td><th>{}</th><td>{}</td>", ++k, escape_markup(run.name), run.log.size());
    const LimitRecord* first = first_limit(run.limits);
    html += first
                ? fmt::format("<td>{}</td><td>{}</td>", escape_markup(first->key), number_text(first->passed_at_ps))
                : "<td>–</td><td>–</td>";
    for (const std::string& c : columns) html += "<td>" + end_text(run, c) + "</td>";
    html += "<td class=\"soft\">" + escape_markup(run.remark) + "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

bool stands_still(const std::vector<LogRow>& log) {
  return log.size() > 1 && log.back()["time_ps"] == log.front()["time_ps"];
}

void refuse_mean_over(double over_ps, const std::vector<std::vector<LogRow>>& logs, const std::string& path) {
  double longest = 0;
  for (const std::vector<LogRow>& log : logs) {
    if (stands_still(log))
      throw InputError({path, 0, "--mean"},
                       "is the log of a relaxation: its rows are steps, which have no mean over time",
                       "leave --mean out");
    longest = std::max(longest, log.back()["time_ps"] - log.front()["time_ps"]);
  }
  if (over_ps > longest * (1 + 1e-9))
    throw InputError({path, 0, "--mean"},
                     fmt::format("has rows over {:.6g} ps, and the mean is to be over {:.6g} ps", longest, over_ps),
                     "give a shorter time");
}

RunMeans means_of(const std::vector<std::vector<LogRow>>& logs, double over_ps) {
  RunMeans out;
  out.over_ps = over_ps;
  const auto n = static_cast<double>(logs.size());
  for (std::size_t k = 0; k < observables().size(); ++k) {
    double sum = 0, squares = 0, correlation = 0, needed = 0, error = nan;
    std::vector<double> values;
    for (const auto& log : logs) {
      const LogMean mean =
          mean_of_last(rows_of_last(over_ps, log), log, [k](const LogRow& row) { return row.values()[k]; });
      values.push_back(mean.value);
      sum += mean.value;
      correlation += mean.correlation_ps / n;
      needed = std::max(needed, mean.needed_ps);
      error = mean.error;
    }
    for (const double v : values) squares += std::pow(v - sum / n, 2);
    const bool alone = logs.size() == 1;
    out.value.values()[k] = sum / n;
    out.error.values()[k] = alone ? error : std::sqrt(squares / (n - 1) / n);
    out.correlation_ps.values()[k] = correlation;
    out.needed_ps.values()[k] = alone ? needed : 0;
  }
  return out;
}

RunCurve mean_of(std::string name, const std::vector<std::vector<LogRow>>& all) {
  const bool relaxed = all.size() > 1 && std::all_of(all.begin(), all.end(), stands_still);
  std::vector<std::vector<LogRow>> logs = all;
  for (std::vector<LogRow>& log : logs)
    if (relaxed) log = {log.back()};
  RunCurve curve{std::move(name), logs.front(), {}, logs.size(), "", {}, {}, 0};
  std::size_t rows = logs.front().size(), most = 0;
  for (const auto& log : logs) {
    rows = std::min(rows, log.size());
    most = std::max(most, log.size());
    for (std::size_t r = 0; r < rows; ++r)
      if (std::fabs(log[r]["time_ps"] - logs.front()[r]["time_ps"]) > 1e-6 * log[r]["time_ps"]) rows = r;
  }
  curve.log.resize(rows);
  if (relaxed) curve.remark = "means of the last rows of relaxations";
  if (rows < most && rows > 0)
    curve.remark = fmt::format("means up to {:.6g} ps, as far as all of them have rows at the same times",
                               curve.log.back()["time_ps"]);
  if (logs.size() < 2) return curve;
  curve.error.resize(rows);
  const auto n = static_cast<double>(logs.size());
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t k = 0; k < observables().size(); ++k) {
      double sum = 0, squares = 0;
      for (const auto& log : logs) sum += log[r].values()[k];
      const double mean = sum / n;
      for (const auto& log : logs) squares += std::pow(log[r].values()[k] - mean, 2);
      curve.log[r].values()[k] = mean;
      curve.error[r].values()[k] = std::sqrt(squares / (n - 1) / n);
    }
  return curve;
}

std::string runs_page(const std::string& title, const std::vector<RunCurve>& runs, const RunsFigure& figure,
                      Figures figures, const std::string& first) {
  const std::vector<std::string> columns = columns_of(runs, figure);
  std::string html = page_head(title) +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: runs side by side</p>\n<h1>" +
                     escape_markup(title) + "</h1>\n" + first;
  const bool beyond = std::any_of(runs.begin(), runs.end(),
                                  [](const RunCurve& r) { return rows_within(r.log, r.limits) < r.log.size(); });
  const auto any = [&](bool replicates) {
    return std::any_of(runs.begin(), runs.end(), [&](const RunCurve& r) {
      return replicates ? r.replicates > 1 : r.replicates == 1 && !r.error.empty();
    });
  };
  const bool replicated = any(true), carried = any(false);
  html += paragraph(fmt::format(
              "{} {} {}.{}{}",
              !runs.empty() && runs.front().means
                  ? fmt::format("Means over the last {} ps of", number_text(runs.front().means->over_ps, 4))
                  : "The ends of",
              runs.size(), replicated ? "ensembles" : "runs",
              replicated ? " Values are means over runs that differ in their seed alone, with the "
                           "standard error of the mean."
                         : "",
              carried ? " Errors of single runs are those that <code>ropewalk errors</code> found." : "")) +
          ends(runs, columns) + heading("Curves");
  std::string open;
  for (const std::string& column : columns) {
    const std::string svg = scatter_svg(chart_of(runs, figure, column));
    const std::string title_text = "<h3>" + escape_markup(column_axis(column).quantity) + "</h3>\n";
    std::string meaning = curve_column(column, {}).meaning;
    if (!meaning.empty()) meaning[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning[0])));
    const std::string one =
        svg.empty()
            ? not_drawn(column_axis(column).quantity)
            : "<figure>" + title_text + svg +
                  figures.caption(escape_markup(meaning) + "." +
                                  (beyond ? " Dotted: beyond the first limit of the run." : "") +
                                  (replicated || carried ? " Bands: one standard error to either side." : "")) +
                  data_table(table_of(runs, figure.x, column), "Every row is in the logs.") + "</figure>\n";
    if (open.empty()) {
      open = one;
      continue;
    }
    html += pair_of(open, one);
    open.clear();
  }
  if (!open.empty()) html += open;
  return html + pictures(runs, figures) + "</main>\n</body>\n</html>\n";
}

std::string runs_svg(const std::vector<RunCurve>& runs, const RunsFigure& figure) {
  const std::vector<std::string> columns = columns_of(runs, figure);
  if (columns.empty()) return "";
  ScatterChart scatter = chart_of(runs, figure, columns.front());
  if (std::any_of(scatter.chart.lines.begin(), scatter.chart.lines.end(), [](const ChartLine& l) { return !l.error.empty(); }))
    scatter.chart.note = "band: one standard error";
  return chart_file(scatter);
}

namespace {

std::string means_csv(const std::vector<RunCurve>& runs, const std::vector<std::string>& columns) {
  std::string text = "run,replicates,mean_over_ps";
  for (const std::string& c : columns) text += fmt::format(",{0},{0}_standard_error,{0}_correlation_ps", c);
  text += "," + column_names(limit_columns()) + "\n";
  for (const RunCurve& run : runs) {
    text += fmt::format("\"{}\",{},{:.6g}", run.name, run.replicates, run.means->over_ps);
    for (const std::string& c : columns) {
      const LogValue value = curve_column(c, run.log).value;
      text += fmt::format(",{:.8g},{:.3g},{:.3g}", value(run.means->value), value(run.means->error),
                          value(run.means->correlation_ps));
    }
    text += "," + limit_cells(run.limits) + "\n";
  }
  return text;
}

}  // namespace

std::string runs_csv(const std::vector<RunCurve>& runs, const RunsFigure& figure) {
  const std::vector<std::string> columns = columns_of(runs, figure);
  if (!runs.empty() && runs.front().means) return means_csv(runs, columns);
  std::string text = "run,replicates," + figure.x;
  for (const std::string& c : columns) text += fmt::format(",{},{}_standard_error", c, c);
  text += "," + column_names(limit_columns()) + "\n";
  for (const RunCurve& run : runs) {
    const LogValue x = curve_column(figure.x, run.log).value;
    std::vector<LogValue> values;
    for (const std::string& c : columns) values.push_back(curve_column(c, run.log).value);
    for (std::size_t r = 0; r < run.log.size(); ++r) {
      text += fmt::format("\"{}\",{},{:.8g}", run.name, run.replicates, x(run.log[r]));
      for (const LogValue& value : values)
        text += fmt::format(",{:.8g},{:.3g}", value(run.log[r]), run.error.empty() ? nan : value(run.error[r]));
      text += "," + limit_cells(run.limits) + "\n";
    }
  }
  return text;
}

}  // namespace ropewalk
