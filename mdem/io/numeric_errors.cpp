#include "io/numeric_errors.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "io/files.hpp"
#include "io/log_mean.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* numerics_format = "ropewalk-numerics-1";
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr double sure = 2;  // standard errors, beyond which a difference is more than scatter

bool is_time(const std::string& name) { return name == "step" || name == "time_ps"; }

LogRow row_without_values() {
  LogRow row;
  for (double& v : row.values()) v = not_known;
  return row;
}

// The row at a time, on the lines through the rows around it; nothing where none enclose it.
LogRow row_at(double time, const std::vector<LogRow>& log) {
  const auto after = std::lower_bound(log.begin(), log.end(), time,
                                      [](const LogRow& row, double t) { return row["time_ps"] < t; });
  if (after == log.end()) return row_without_values();
  if (after == log.begin()) return (*after)["time_ps"] == time ? *after : row_without_values();
  const LogRow &a = *(after - 1), &b = *after;
  const double share = (time - a["time_ps"]) / (b["time_ps"] - a["time_ps"]);
  LogRow row;
  for (std::size_t k = 0; k < row.values().size(); ++k)
    row.values()[k] = share == 1 ? b.values()[k] : (1 - share) * a.values()[k] + share * b.values()[k];
  return row;
}

// Rows that belong to those of the log of the run. The last rows of both belong together: whole steps may end a
// little before the duration, and a rule may have ended one of the runs earlier. A relaxation has no times.
std::vector<LogRow> rows_beside(const std::vector<LogRow>& rows, double pace, const std::vector<LogRow>& log) {
  std::vector<LogRow> out(log.size(), row_without_values());
  if (rows.empty() || log.empty()) return out;
  const bool relaxes = log.back()["time_ps"] == log.front()["time_ps"] && log.size() > 1;
  for (std::size_t k = 0; !relaxes && k + 1 < log.size(); ++k) out[k] = row_at(pace * log[k]["time_ps"], rows);
  out.back() = rows.back();
  return out;
}

Json number_or_null(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

// A value that is missing in one run only says nothing of its error.
double difference(double a, double b) {
  return std::isfinite(a) && std::isfinite(b) ? std::fabs(a - b) : not_known;
}

double or_zero(double v) { return std::isfinite(v) ? v : 0; }

RunErrors::Value value_in(std::size_t k) {
  return [k](const LogRow& row) { return row.values()[k]; };
}

}  // namespace

double WholeError::total() const {
  if (without > 0) return not_known;
  return std::sqrt(statistics * statistics + numerics * numerics + parameters * parameters + potential * potential);
}

NumericErrors::NumericErrors(const std::string& directory, NumericRuns runs, RunErrors parameters,
                             std::vector<LogRow> log)
    : runs_(std::move(runs)), parameters_(std::move(parameters)), log_(std::move(log)) {
  for (const NumericSource& s : runs_.sources)
    refined_.push_back(rows_beside(read_log(directory + "/" + s.folder + "/log.csv"), s.pace, log_));
  for (const std::string& folder : runs_.starts)
    starts_.push_back(rows_beside(read_log(directory + "/" + folder + "/log.csv"), 1, log_));
}

WholeError NumericErrors::of(const RunErrors::Result& result, const Blocks& blocks) const {
  std::vector<double> starts, refined;
  for (const std::vector<LogRow>& log : starts_) starts.push_back(result(log));
  for (const std::vector<LogRow>& log : refined_) refined.push_back(result(log));
  return combined(result(log_), starts, refined, parameters_.empty() ? ResultError{} : parameters_.of(result), blocks);
}

WholeError NumericErrors::of_runs(const RunErrors::ResultOfRun& result, bool is_time) const {
  std::vector<double> starts, refined;
  int without = 0;
  const RunErrors::ResultOfRun counted = [&](const std::string& folder) {
    const double v = result(folder);
    without += !std::isfinite(v);
    return v;
  };
  for (const std::string& folder : runs_.starts) starts.push_back(counted(folder));
  for (const NumericSource& s : runs_.sources) refined.push_back(counted(s.folder) / (is_time ? s.pace : 1));
  const ResultError parameters = parameters_.empty() ? ResultError{} : parameters_.of_runs(counted);
  WholeError e = combined(result(""), starts, refined, parameters, [](WholeError&) {});
  e.without = without;
  return e;
}

WholeError NumericErrors::combined(double value, const std::vector<double>& starts,
                                   const std::vector<double>& refined, const ResultError& parameters,
                                   const Blocks& blocks) const {
  WholeError e;
  e.value = value;
  std::vector<double> values = {e.value};
  for (const double v : starts)
    if (std::isfinite(v)) values.push_back(v);
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  if (values.size() > 1) e.statistics = or_zero(std::sqrt(squares / static_cast<double>(values.size() - 1)));
  blocks(e);
  double largest = e.statistics, bounds = 0, certain = 0;
  if (largest > 0) e.decides = "statistics";
  // What is larger than all before it, and more than scatter makes of it.
  const auto weigh = [&](double part, double scatter, const std::string& name) {
    if (!(part > largest) || part <= sure * scatter) return;
    largest = part;
    e.decides = name;
  };
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const NumericSource& s = runs_.sources[i];
    const double part = s.times * difference(refined[i], e.value);
    const double scatter = s.times * std::sqrt(2.0) * e.statistics;
    e.parts.push_back(part);
    e.numerics = std::hypot(e.numerics, or_zero(part));
    (part <= sure * scatter ? bounds : certain) += or_zero(part * part);
    weigh(part, scatter, s.name);
  }
  e.bound = bounds > certain;
  if (!parameters_.empty()) {
    e.parameters = or_zero(parameters.error);
    e.potential = or_zero(parameters.potential);
    std::size_t most = 0;
    for (std::size_t i = 0; i < parameters.parts.size(); ++i)
      if (std::fabs(parameters.parts[i]) > std::fabs(parameters.parts[most])) most = i;
    weigh(e.parameters, e.statistics, parameters_.sources()[most].name);
    weigh(e.potential, 0, "potential");
  }
  return e;
}

WholeError NumericErrors::of(std::size_t k, const Value& value) const {
  return of([&](const std::vector<LogRow>& log) { return value(log.at(k)); }, [](WholeError&) {});
}

WholeError NumericErrors::at_end(const Value& value) const {
  if (!(runs_.mean_ps > 0)) return of(log_.size() - 1, value);
  const std::size_t rows = rows_of_last(runs_.mean_ps, log_);
  return of([&](const std::vector<LogRow>& log) { return mean_of_last(rows, log, value).value; },
            [&](WholeError& e) {
              const LogMean mean = mean_of_last(rows, log_, value);
              e.correlation_ps = mean.correlation_ps;
              if (std::isfinite(mean.error)) e.statistics = std::max(e.statistics, mean.error);
              if (mean.needed_ps > 0) e.needed_ps = mean.needed_ps;
            });
}

NumericErrors read_numeric_errors(const std::string& run_directory, const std::vector<LogRow>& log) {
  const std::string directory = run_directory + "/errors", path = directory + "/numerics.json";
  if (!std::filesystem::exists(path) || log.empty()) return {};
  NumericRuns runs;
  try {
    const Json j = Json::parse(read_file(path));
    if (j.at("format") != numerics_format) throw std::runtime_error("another format");
    runs.mean_ps = j.at("mean_ps");
    for (const Json& s : j.at("sources"))
      runs.sources.push_back(
          {s.at("name"), s.at("folder"), s.at("times"), s.at("pace"), s.at("change"), s.at("remedy")});
    runs.starts = j.at("starts").get<std::vector<std::string>>();
    runs.remarks = j.at("remarks").get<std::vector<std::string>>();
    std::vector<std::string> texts = runs.starts;
    for (const NumericSource& s : runs.sources) texts.insert(texts.end(), {s.name, s.folder, s.change, s.remedy});
    texts.insert(texts.end(), runs.remarks.begin(), runs.remarks.end());
    for (const std::string& text : texts)
      if (has_control_character(text)) throw std::runtime_error("a control character");
    std::vector<std::string> folders = runs.starts;
    for (const NumericSource& s : runs.sources) folders.push_back(s.folder);
    for (const std::string& folder : folders)
      if (!is_plain_name(folder)) throw std::runtime_error("a directory elsewhere");
  } catch (const std::exception&) {
    throw InputError({path, 0, ""}, "is not what `ropewalk errors --numerics` writes",
                     "make it again, or take it away");
  }
  return {directory, std::move(runs), read_run_errors(run_directory, log), log};
}

std::string numeric_errors_json(const NumericErrors& errors, const std::vector<LogRow>& log,
                                const std::vector<std::pair<std::string, WholeError>>& results) {
  const NumericRuns& runs = errors.runs();
  Json sources = Json::array(), at_the_end = Json::object(), came_of_it = Json::object();
  for (const NumericSource& s : runs.sources)
    sources.push_back({{"name", s.name},
                       {"folder", s.folder},
                       {"times", s.times},
                       {"pace", s.pace},
                       {"change", s.change},
                       {"remedy", s.remedy}});
  const auto json_of = [&](const WholeError& e) {
    Json parts = Json::object();
    for (std::size_t i = 0; i < e.parts.size(); ++i) parts[runs.sources[i].name] = number_or_null(e.parts[i]);
    return Json{{"value", number_or_null(e.value)},
                {"error", number_or_null(e.total())},
                {"statistics", number_or_null(e.statistics)},
                {"numerics", number_or_null(e.numerics)},
                {"parameters", number_or_null(e.parameters)},
                {"potential", number_or_null(e.potential)},
                {"upper_bound", e.bound},
                {"decides", e.decides},
                {"parts", parts}};
  };
  for (std::size_t k = 0; k < observables().size() && !log.empty(); ++k) {
    const std::string& name = observables()[k].name;
    if (is_time(name)) continue;
    const WholeError e = errors.at_end(value_in(k));
    at_the_end[name] = json_of(e);
    at_the_end[name]["correlation_ps"] = number_or_null(e.correlation_ps);
    at_the_end[name]["needed_ps"] = number_or_null(e.needed_ps);
  }
  for (const auto& [name, error] : results) {
    came_of_it[name] = json_of(error);
    came_of_it[name]["runs_without"] = error.without;
  }
  return Json{{"format", numerics_format}, {"mean_ps", runs.mean_ps}, {"sources", sources},
              {"starts", runs.starts},     {"remarks", runs.remarks}, {"results", came_of_it},
              {"at_the_end", at_the_end}}
             .dump(1) +
         "\n";
}

std::string whole_errors_csv(const NumericErrors& errors, const std::vector<LogRow>& log,
                             const std::function<double(const WholeError&)>& which) {
  std::string text = log_header();
  if (text.empty() || text.back() != '\n') text += '\n';
  for (std::size_t k = 0; k < log.size(); ++k) {
    LogRow row = log[k];
    for (std::size_t i = 0; i < observables().size(); ++i)
      if (!is_time(observables()[i].name)) row.values()[i] = which(errors.of(k, value_in(i)));
    text += log_line(row);
    if (text.back() != '\n') text += '\n';
  }
  return text;
}

std::vector<LogRow> rows_of_errors(const std::string& run_directory, const std::vector<LogRow>& log) {
  const RunErrors parameters = read_run_errors(run_directory, log);
  const NumericErrors numerics = read_numeric_errors(run_directory, log);
  if (parameters.empty() && numerics.empty()) return {};
  std::vector<LogRow> rows = log;
  for (std::size_t k = 0; k < log.size(); ++k)
    for (std::size_t i = 0; i < observables().size(); ++i) {
      if (is_time(observables()[i].name)) continue;
      const ResultError p = parameters.empty() ? ResultError{} : parameters.of(k, value_in(i));
      rows[k].values()[i] =
          numerics.empty() ? std::hypot(p.error, p.potential) : numerics.of(k, value_in(i)).total();
    }
  return rows;
}

}  // namespace ropewalk
