#include "io/run_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/potential_spread.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "ropewalk-errors-1";
constexpr double rounding = 1e-9;  // relative to the value and to 1 in its unit
constexpr double noise = 1e-5;     // likewise, of a value that is not linear in the parameters
constexpr double unlike = 1e-3;    // of the value: a smaller effect is of no interest, linear or not

LogRow nothing() {
  LogRow row;
  for (double& v : row.values()) v = std::numeric_limits<double>::quiet_NaN();
  return row;
}

std::vector<LogRow> aligned(std::vector<LogRow> rows, const std::vector<LogRow>& log) {
  bool alike = rows.size() == log.size();
  for (std::size_t k = 0; alike && k < rows.size(); ++k) alike = rows[k]["step"] == log[k]["step"];
  if (alike) return rows;
  std::vector<LogRow> out(log.size(), nothing());
  if (!rows.empty() && !out.empty()) out.back() = rows.back();
  return out;
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

bool is_clock(const std::string& name) { return name == "step" || name == "time_ps"; }

RunErrors::Value column(std::size_t k) {
  return [k](const LogRow& row) { return row.values()[k]; };
}

}  // namespace

RunErrors::RunErrors(const std::string& directory, std::vector<ErrorSource> sources,
                     std::vector<std::vector<double>> correlation, const std::vector<LogRow>& log)
    : sources_(std::move(sources)), correlation_(std::move(correlation)), log_(log) {
  for (const ErrorSource& s : sources_)
    runs_.emplace_back(aligned(read_log(directory + "/" + s.plus + "/log.csv"), log),
                       s.minus.empty() ? log : aligned(read_log(directory + "/" + s.minus + "/log.csv"), log));
}

ResultError RunErrors::of(std::size_t k, const Value& value) const {
  return of([&](const std::vector<LogRow>& log) { return value(log.at(k)); });
}

ResultError RunErrors::of(const Result& result) const {
  return combined(result(log_), [&](std::size_t i, bool plus) {
    return result(plus ? runs_[i].first : runs_[i].second);
  });
}

ResultError RunErrors::of_runs(const ResultOfRun& result) const {
  return combined(result(""), [&](std::size_t i, bool plus) {
    return result(plus ? sources_[i].plus : sources_[i].minus);
  });
}

ResultError RunErrors::combined(double middle, const std::function<double(std::size_t, bool)>& result) const {
  ResultError out;
  out.value = middle;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const double plus = result(i, true), minus = sources_[i].minus.empty() ? 2 * middle - plus : result(i, false);
    const double scale = 0.5 * sources_[i].sigma / sources_[i].step;
    double part = scale * (plus - minus);
    const double bent = scale * std::fabs(plus + minus - 2 * middle);
    if (bent > std::fabs(part)) {
      part = std::copysign(std::hypot(part, bent), part);
      if (bent > unlike * std::fabs(middle)) out.linear = false;
    }
    out.parts.push_back(part);
  }
  double variance = 0, between = 0;
  for (std::size_t i = 0; i < out.parts.size(); ++i)
    for (std::size_t j = 0; j < out.parts.size(); ++j) {
      const double product = out.parts[i] * out.parts[j];
      variance += product * correlation_[i][j];
      between += product / (sources_[i].sigma * sources_[j].sigma) *
                 potential_covariance(sources_[i].key, sources_[j].key);
    }
  out.potential = std::isfinite(variance) ? std::sqrt(std::max(0.0, between)) : std::nan("");
  out.error = std::sqrt(std::max(0.0, variance));
  if (!std::isfinite(variance)) out.error = std::numeric_limits<double>::quiet_NaN();
  return out;
}

double movement(const std::vector<LogRow>& log, const RunErrors::Value& value) {
  const std::size_t n = std::min(log.size(), std::max<std::size_t>(8, log.size() / 10));
  if (n < 4) return 0;
  const std::size_t first = log.size() - n;
  double t = 0, y = 0, tt = 0, ty = 0;
  const auto rows = static_cast<double>(n);
  for (std::size_t k = first; k < log.size(); ++k) t += log[k]["time_ps"] / rows, y += value(log[k]) / rows;
  for (std::size_t k = first; k < log.size(); ++k) {
    const double from = log[k]["time_ps"] - t;
    tt += from * from;
    ty += from * (value(log[k]) - y);
  }
  double most = 0;
  for (std::size_t k = first; k < log.size(); ++k)
    most = std::max(most, std::fabs(value(log[k]) - y - (tt > 0 ? ty / tt : 0) * (log[k]["time_ps"] - t)));
  return most;
}

bool has_influence(const ResultError& error, const std::vector<LogRow>& log, const RunErrors::Value& value) {
  double largest = 1;
  for (const LogRow& row : log)
    if (const double v = value(row); std::isfinite(v)) largest = std::max(largest, std::fabs(v));
  if (!std::isfinite(error.error) || !(error.error > rounding * largest)) return false;
  // A value that symmetry makes zero depends on no parameter: it is noise, and varies by its own size.
  return error.linear || (error.error > noise * largest && error.error > movement(log, value));
}

bool is_plain_name(const std::string& folder) {
  return !folder.empty() && folder != "." && folder != ".." && folder.find('/') == std::string::npos;
}

RunErrors read_run_errors(const std::string& run_directory, const std::vector<LogRow>& log) {
  const std::string directory = run_directory + "/errors", path = directory + "/errors.json";
  if (!std::filesystem::exists(path)) return {};
  std::vector<ErrorSource> sources;
  std::vector<std::vector<double>> correlation;
  try {
    const Json j = Json::parse(read_file(path));
    if (j.at("format") != format_name) throw std::runtime_error("another format");
    for (const Json& s : j.at("sources")) {
      const std::string name = s.at("name");  // files of 0.2 have it alone
      sources.push_back({name, s.at("plus"), s.at("minus"), s.at("standard_error"), s.at("step"),
                         s.value("key", "bond." + name.substr(0, name.find(' ')))});
      const ErrorSource& read = sources.back();
      for (const std::string& text : {read.name, read.plus, read.minus, read.key})
        if (has_control_character(text)) throw std::runtime_error("a control character");
      for (const std::string& folder : {read.plus, read.minus})
        if (!folder.empty() && !is_plain_name(folder)) throw std::runtime_error("a directory elsewhere");
    }
    correlation = j.at("correlation").get<std::vector<std::vector<double>>>();
    bool square = correlation.size() == sources.size();
    for (const std::vector<double>& row : correlation) square = square && row.size() == sources.size();
    if (!square) throw std::runtime_error("a correlation of another size");
  } catch (const std::exception&) {
    throw InputError({path, 0, ""}, "is not what `ropewalk errors` writes", "make it again, or take it away");
  }
  return {directory, std::move(sources), std::move(correlation), log};
}

std::string run_errors_json(const RunErrors& errors, const std::vector<LogRow>& log,
                            const std::vector<std::pair<std::string, ResultError>>& results,
                            const std::vector<std::string>& without_error,
                            const std::vector<std::string>& not_varied) {
  Json sources = Json::array(), at_the_end = Json::object(), came_of_it = Json::object();
  for (const ErrorSource& s : errors.sources())
    sources.push_back({{"name", s.name},
                       {"key", s.key},
                       {"standard_error", s.sigma},
                       {"step", s.step},
                       {"plus", s.plus},
                       {"minus", s.minus}});
  const auto json_of = [&](const ResultError& e) {
    Json parts = Json::object();
    for (std::size_t i = 0; i < e.parts.size(); ++i) parts[errors.sources()[i].name] = number(e.parts[i]);
    return Json{{"value", number(e.value)},
                {"standard_error", number(e.error)},
                {"potential_error", number(e.potential)},
                {"linear", e.linear},
                {"parts", parts}};
  };
  for (std::size_t k = 0; k < observables().size() && !log.empty(); ++k) {
    const std::string& name = observables()[k].name;
    if (is_clock(name)) continue;
    at_the_end[name] = json_of(errors.of(log.size() - 1, column(k)));
    at_the_end[name]["moves_by"] = number(movement(log, column(k)));
  }
  for (const auto& [name, error] : results) came_of_it[name] = json_of(error);
  return Json{{"format", format_name},          {"sources", sources},       {"correlation", errors.correlation()},
              {"without_error", without_error}, {"not_varied", not_varied}, {"results", came_of_it},
              {"at_the_end", at_the_end}}
             .dump(1) +
         "\n";
}

std::string run_errors_csv(const RunErrors& errors, const std::vector<LogRow>& log, double ResultError::*which) {
  std::string text = log_header();
  if (text.empty() || text.back() != '\n') text += '\n';
  for (std::size_t k = 0; k < log.size(); ++k) {
    LogRow row = log[k];
    for (std::size_t i = 0; i < observables().size(); ++i)
      if (!is_clock(observables()[i].name)) row.values()[i] = errors.of(k, column(i)).*which;
    text += log_line(row);
    if (text.back() != '\n') text += '\n';
  }
  return text;
}

}  // namespace ropewalk
