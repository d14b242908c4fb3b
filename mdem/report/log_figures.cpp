#include "report/log_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/run_results.hpp"
#include "observe/observables.hpp"
#include "report/page.hpp"

namespace ropewalk {

ChartAxis column_axis(const std::string& column) {
  const CurveColumn c = curve_column(column, {});
  return {c.quantity, c.unit, c.whole};
}

LogValue logged(const std::string& column) {
  return [k = index_of_observable(column)](const LogRow& row) { return row.values()[k]; };
}

double error_of(const ReportInput& in, std::size_t row, const LogValue& value) {
  if (!in.whole.empty()) return in.whole.of(row, value).total();
  if (in.errors.empty()) return 0;
  const ResultError e = in.errors.of(row, value);
  return std::hypot(e.error, e.potential);
}

double total_energy(const LogRow& r) { return potential_energy(r) + r["kinetic_eV"]; }

Clock clock_of(const std::vector<LogRow>& log) {
  double first = 0, last = 0;
  if (!log.empty()) first = log.front()["time_ps"], last = log.back()["time_ps"];
  if (log.size() > 1 && !(last > first) && log.back()["step"] > log.front()["step"])
    return {{"step", "", true}, "step"};
  return {{"time", "ps", false}, "time_ps"};
}

std::vector<double> values_of(const std::vector<LogRow>& log, const LogValue& value) {
  std::vector<double> values;
  for (const LogRow& row : log) values.push_back(value(row));
  return values;
}

std::size_t mark_beyond(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits,
                        const std::vector<double>& x, LineChart& chart) {
  const std::size_t within = rows_within(log, limits);
  if (within < x.size()) {
    // A quantity that goes back and forth has no region of its own.
    if (std::is_sorted(x.begin(), x.end())) chart.beyond = x[within];
    chart.beyond_name = "beyond " + first_limit(limits)->key;
  }
  return within;
}

namespace {

void take_first_off(std::vector<double>& values) {
  const auto first = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  const double origin = first == values.end() ? 0 : *first;
  for (double& v : values) v -= origin;
}

std::vector<ChartBand> stages(const ReportInput& in) {
  if (!(in.ramp_end_ps > 0) || in.log.size() < 2) return {};
  std::vector<ChartBand> bands{{in.log.front()["time_ps"], in.ramp_end_ps, "loading", false}};
  if (in.log.back()["time_ps"] > in.ramp_end_ps)
    bands.push_back({in.ramp_end_ps, in.log.back()["time_ps"], "holding", true});
  return bands;
}

// A column as the horizontal axis.
Clock axis_of(const std::vector<LogRow>& log, const Panel& panel) {
  if (panel.against.empty()) return clock_of(log);
  const Observable& o = observables()[index_of_observable(panel.against)];
  return {{quantity_of(o), o.unit, false}, panel.against};
}

LineChart chart_of(const ReportInput& in, const Panel& panel, const Clock& clock) {
  LineChart chart;
  chart.title = panel.title;
  chart.x = clock.axis;
  chart.y = panel.axis;
  if (clock.column == "time_ps") chart.bands = stages(in);
  const std::vector<double> x = values_of(in.log, logged(clock.column));
  const std::size_t within = mark_beyond(in.log, in.watched.limits, x, chart);
  for (const Trace& trace : panel.traces) {
    ChartLine line{trace.name, x, values_of(in.log, trace.value), trace.colour, trace.dashed, panel.steps};
    if (panel.since_start) take_first_off(line.y);
    if (within < x.size()) line.beyond = within;
    const bool known = !in.errors.empty() || !in.whole.empty();
    for (std::size_t k = 0; (trace.half_width || known) && k < in.log.size(); ++k) {
      const double carried = error_of(in, k, trace.value);
      line.error.push_back(std::hypot(carried, trace.half_width ? trace.half_width(in.log[k]) : 0));
    }
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

// The legend of what is dotted.
std::string beyond_words_of(const ReportInput& in) {
  const LimitRecord* first = first_limit(in.watched.limits);
  return first && rows_within(in.log, in.watched.limits) < in.log.size()
             ? fmt::format(" Dotted: beyond {}, {}.", escape_markup(first->key), since_words(*first))
             : "";
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

}  // namespace

std::string not_drawn(const std::string& title) {
  return fmt::format(
      "<figure><h3>{}</h3>\n<p class=\"none\">Not drawn: there are fewer than two values.</p></figure>\n",
      escape_markup(title));
}

std::string log_figure(const ReportInput& in, const Panel& panel, Figures& figures) {
  const Clock clock = axis_of(in.log, panel);
  const LineChart chart = chart_of(in, panel, clock);
  if (!can_draw(chart)) return not_drawn(panel.title);
  std::vector<TableColumn> columns{{with_unit(clock.axis.quantity, clock.axis.unit), chart.lines[0].x}};
  for (const Trace& trace : panel.traces)
    columns.push_back({with_unit(trace.name, panel.axis.unit), values_of(in.log, trace.value)});
  for (const Trace& trace : panel.traces)
    if (trace.half_width)
      columns.push_back(
          {with_unit("half width of the band", panel.axis.unit), values_of(in.log, trace.half_width)});
  return fmt::format("<figure><h3>{}</h3>\n", escape_markup(panel.title)) + chart_svg(chart) +
         figures.caption(panel.caption + beyond_words_of(in)) +
         data_table(columns, "Every row and column is in log.csv.") + "</figure>\n";
}

std::string pair_of(const std::string& a, const std::string& b) {
  return "<div class=\"pair\">\n" + a + b + "</div>\n";
}

}  // namespace ropewalk
