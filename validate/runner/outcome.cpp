#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "model/error.hpp"
#include "runner/runner.hpp"

namespace ropewalk::validate {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN: null stands for it.
Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
double number(const Json& j) { return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>(); }

Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(number(v));
  return out;
}

std::vector<double> numbers(const Json& j) {
  std::vector<double> values;
  for (const Json& v : j) values.push_back(number(v));
  return values;
}

Json to_json(const Check& c) {
  return {{"name", c.name},
          {"value", number(c.value)},
          {"reference", number(c.reference)},
          {"tolerance", c.tolerance},
          {"relative", c.relative},
          {"unit", c.unit},
          {"informative", c.informative},
          {"difference", number(c.difference())},
          {"holds", c.holds()},
          {"known_miss", c.known ? Json{{"difference", c.known->expected}, {"within", c.known->spread}} : Json()},
          {"note", c.note}};
}

Check check_of(const Json& j) {
  Check c;
  c.name = j.at("name");
  c.value = number(j.at("value"));
  c.reference = number(j.at("reference"));
  c.tolerance = j.at("tolerance");
  c.relative = j.at("relative");
  c.unit = j.at("unit");
  c.informative = j.at("informative");
  c.note = j.at("note");
  if (const Json known = j.value("known_miss", Json()); known.is_object())
    c.known = Check::Known{known.at("difference"), known.at("within")};
  return c;
}

constexpr const char* guard_names[] = {"refused", "stopped", "told", "none"};  // same order as Limit::Guard

Json to_json(const Limit& l) {
  return {{"method", l.method},
          {"found", number(l.found)},
          {"theory", number(l.theory)},
          {"unit", l.unit},
          {"guard", guard_names[static_cast<std::size_t>(l.guard)]},
          {"how", l.how}};
}

Limit limit_of(const Json& j) {
  Limit l;
  l.method = j.at("method");
  l.found = number(j.at("found"));
  l.theory = number(j.at("theory"));
  l.unit = j.at("unit");
  const auto* word = std::find(std::begin(guard_names), std::end(guard_names), j.at("guard").get<std::string>());
  if (word == std::end(guard_names)) throw std::runtime_error("unknown guard");
  l.guard = static_cast<Limit::Guard>(word - std::begin(guard_names));
  l.how = j.at("how");
  return l;
}

Json to_json(const ChartAxis& a) {
  return {{"quantity", a.quantity}, {"unit", a.unit}, {"whole", a.whole}, {"decades", a.decades}};
}
ChartAxis axis_of(const Json& j) {
  return {j.at("quantity"), j.at("unit"), j.at("whole"), j.value("decades", false)};
}

Json to_json(const CaseFigure& f) {
  Json lines = Json::array(), bands = Json::array();
  for (const ChartLine& l : f.chart.lines)
    lines.push_back({{"name", l.name},
                     {"x", numbers(l.x)},
                     {"y", numbers(l.y)},
                     {"colour", l.colour},
                     {"dashed", l.dashed},
                     {"steps", l.steps},
                     {"points", l.points},
                     {"filled", l.filled}});
  for (const ChartBand& b : f.chart.bands)
    bands.push_back({{"from", b.from}, {"to", b.to}, {"label", b.label}, {"dark", b.dark}});
  return {{"title", f.chart.title}, {"x", to_json(f.chart.x)}, {"y", to_json(f.chart.y)}, {"lines", lines},
          {"bands", bands},         {"caption", f.caption},    {"below", f.chart.below},  {"above", f.chart.above},
          {"on_map", f.on_map},     {"labels", f.labels}};
}

CaseFigure figure_of(const Json& j) {
  CaseFigure f;
  f.chart.title = j.at("title");
  f.chart.x = axis_of(j.at("x"));
  f.chart.y = axis_of(j.at("y"));
  for (const Json& l : j.at("lines")) {
    ChartLine line;
    line.name = l.at("name");
    line.x = numbers(l.at("x"));
    line.y = numbers(l.at("y"));
    line.colour = l.at("colour");
    line.dashed = l.at("dashed");
    line.steps = l.at("steps");
    line.points = l.at("points");
    line.filled = l.value("filled", false);  // earlier versions have none
    f.chart.lines.push_back(std::move(line));
  }
  for (const Json& b : j.at("bands"))
    f.chart.bands.push_back({b.at("from"), b.at("to"), b.at("label"), b.at("dark")});
  f.chart.below = j.value("below", "");  // earlier versions have none
  f.chart.above = j.value("above", "");
  f.caption = j.at("caption");
  f.on_map = j.value("on_map", false);
  f.labels = j.value("labels", f.labels);
  return f;
}

const char* verdict_word(Outcome::Verdict v) {
  return v == Outcome::Verdict::holds            ? "holds"
         : v == Outcome::Verdict::misses         ? "misses"
         : v == Outcome::Verdict::not_applicable ? "not applicable"
                                                 : "failed";
}

Json body(const Outcome& o) {
  Json checks = Json::array(), figures = Json::array();
  for (const Check& c : o.result.checks) checks.push_back(to_json(c));
  for (const CaseFigure& f : o.result.figures) figures.push_back(to_json(f));
  Json limits = Json::array(), sets = Json::array();
  for (const Limit& l : o.result.limits) limits.push_back(to_json(l));
  for (const UsedSet& s : o.sets)
    sets.push_back(
        {{"name", s.name}, {"hash", s.hash}, {"tube", s.tube}, {"grade", s.grade}, {"registry", s.registry}});
  return {{"format", outcome_format},
          {"case", o.name},
          {"verdict", verdict_word(o.verdict())},
          {"tubes", o.tubes},
          {"sets", sets},
          {"not_applicable", o.not_applicable},
          {"checks", checks},
          {"limits", limits},
          {"remarks", o.result.remarks},
          {"sources", o.result.sources},
          {"error", o.error},
          {"key", o.key},
          {"seconds", o.result.seconds},
          {"figures", figures}};
}

std::string check_line(const Check& c) {
  const std::string mark = c.informative ? "  " : !c.holds() ? "NO" : c.known ? "kn" : "ok";
  const std::string allowed = c.informative ? "shown only"
                              : c.known     ? "known miss"
                              : c.relative  ? fmt::format("within {:.3g} %", 100 * c.tolerance)
                                            : fmt::format("within {:.3g} {}", c.tolerance, c.unit);
  const std::string off =
      c.relative ? fmt::format("{:+.3g} %", 100 * c.difference()) : fmt::format("{:+.3g}", c.difference());
  return fmt::format("  {} {:<52} {:>12.6g} {:>12.6g} {:<10} {:>10}  {}\n", mark, c.name, c.value, c.reference,
                     c.unit, off, allowed);
}

}  // namespace

Outcome::Verdict Outcome::verdict() const {
  if (!error.empty()) return Verdict::failed;
  if (!not_applicable.empty()) return Verdict::not_applicable;
  return result.holds() ? Verdict::holds : Verdict::misses;
}

std::string Outcome::with_tubes(std::string text) const {
  const std::string place = "{tube}";
  for (std::size_t at = 0; (at = text.find(place)) != std::string::npos;) text.replace(at, place.size(), tubes);
  return text;
}

std::string grade_with_verdicts(const std::string& grade, const std::string& hash,
                                const std::vector<Outcome>& outcomes) {
  std::string misses;
  for (const Outcome& o : outcomes) {
    const auto same = [&](const UsedSet& set) { return set.hash == hash; };
    if (o.verdict() == Outcome::Verdict::misses && std::any_of(o.sets.begin(), o.sets.end(), same))
      misses += (misses.empty() ? "" : ", ") + o.name;
  }
  if (misses.empty()) return grade;
  return (grade == "good" ? "limited: " : grade + "; ") + "it misses in " + misses;
}

std::string outcome_json(const Outcome& outcome) { return body(outcome).dump(1) + "\n"; }

Outcome read_outcome(const std::string& path) {
  try {
    const Json j = Json::parse(read_file(path));
    if (j.at("format") != outcome_format) throw std::runtime_error("another format");
    Outcome o;
    o.name = j.at("case");
    o.tubes = j.at("tubes");
    for (const Json& s : j.at("sets"))
      o.sets.push_back({s.at("name"), s.at("hash"), s.at("tube"), s.at("grade"), s.at("registry")});
    o.not_applicable = j.at("not_applicable");
    o.error = j.at("error");
    o.key = j.at("key");
    for (const Json& c : j.at("checks")) o.result.checks.push_back(check_of(c));
    for (const Json& l : j.value("limits", Json::array())) o.result.limits.push_back(limit_of(l));  // older: none
    for (const Json& f : j.at("figures")) o.result.figures.push_back(figure_of(f));
    o.result.remarks = j.at("remarks").get<std::vector<std::string>>();
    o.result.sources = j.at("sources").get<std::vector<std::string>>();
    o.result.seconds = j.at("seconds");
    return o;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    throw InputError({path, 0, ""}, "is not a result of `ropewalk validate run`",
                     "run the case again with --again");
  }
}

std::string validation_json(const std::vector<Outcome>& outcomes) {
  Json all = Json::array();
  for (const Outcome& o : outcomes) {
    Json j = body(o);
    j.erase("figures");
    j.erase("format");
    all.push_back(std::move(j));
  }
  return Json{{"format", outcome_format}, {"cases", all}}.dump(1) + "\n";
}

std::string validation_table(const std::vector<Outcome>& outcomes) {
  std::string text =
      fmt::format("     {:<52} {:>12} {:>12} {:<10} {:>10}\n", "", "model", "oracle", "unit", "difference");
  for (const Outcome& o : outcomes) {
    if (o.verdict() == Outcome::Verdict::not_applicable) continue;
    text += fmt::format("{:<8} {} {} ({:.1f} s)\n",
                        o.verdict() == Outcome::Verdict::holds    ? "holds"
                        : o.verdict() == Outcome::Verdict::misses ? "MISSES"
                                                                  : "FAILED",
                        o.name, o.tubes, o.result.seconds);
    if (!o.error.empty()) text += "  " + o.error + "\n";
    for (const Check& c : o.result.checks) text += check_line(c);
  }
  for (const Outcome& o : outcomes)
    if (o.verdict() == Outcome::Verdict::not_applicable)
      text += fmt::format("not applicable  {}: {}\n", o.name, o.not_applicable);
  return text;
}

}  // namespace ropewalk::validate
