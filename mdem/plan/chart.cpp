#include "plan/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "io/files.hpp"
#include "io/toml_table.hpp"  // printable
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* remedy = "make the chart anew with `ropewalk validate chart`";

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

// A table with a header, its columns found by name.
class Csv {
 public:
  explicit Csv(const std::string& path) : path_(path) {
    const std::string text = read_file(path);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      std::string line = text.substr(at, end - at);
      at = end + 1;
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line[0] == '#') continue;
      if (header_.empty()) {
        header_ = cells_of(line);
        continue;
      }
      rows_.push_back({line_, cells_of(line)});
      if (rows_.back().cells.size() != header_.size())
        fail("", fmt::format("{} columns, the header has {}", rows_.back().cells.size(), header_.size()));
    }
    if (header_.empty()) fail("", "is empty");
  }

  std::size_t rows() const { return rows_.size(); }
  const std::string& text(std::size_t row, const char* column) {
    const auto at = std::find(header_.begin(), header_.end(), column);
    line_ = rows_[row].line;
    if (at == header_.end()) fail(column, "there is no such column");
    return rows_[row].cells[static_cast<std::size_t>(at - header_.begin())];
  }
  double number(std::size_t row, const char* column) {
    const std::string& cell = text(row, column);
    double v = 0;
    const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), v);
    if (code != std::errc() || end != cell.data() + cell.size())
      fail(column, fmt::format("\"{}\" is not a number", printable(cell, 40)));
    return v;
  }
  int integer(std::size_t row, const char* column) { return static_cast<int>(std::lround(number(row, column))); }
  [[noreturn]] void fail(const std::string& column, const std::string& what) const {
    throw InputError({path_, line_, column}, what, remedy);
  }

 private:
  struct Row {
    int line = 0;
    std::vector<std::string> cells;
  };
  std::string path_;
  int line_ = 0;
  std::vector<std::string> header_;
  std::vector<Row> rows_;
};

ChartedModel model_of(Csv& csv, std::size_t row) {
  ChartedModel m;
  m.name = csv.text(row, "model");
  m.kind = csv.text(row, "kind");
  m.law = csv.text(row, "law");
  m.nodes = csv.integer(row, "nodes_per_element");
  m.cutoff = csv.number(row, "cutoff_nm");
  m.element_length = csv.number(row, "element_length_nm");
  m.integrator = csv.text(row, "integrator");
  m.contact_every = csv.integer(row, "contact_every");
  m.time_step = csv.number(row, "time_step_fs");
  m.mass_scale = csv.number(row, "mass_scale");
  m.mode = csv.text(row, "mode");
  m.precision = csv.text(row, "precision");
  m.elements = csv.integer(row, "elements");
  m.simulated = csv.number(row, "simulated_ps");
  m.cpu_per_ns = csv.number(row, "cpu_s_per_ns");
  m.ns_per_element_step = csv.number(row, "cpu_ns_per_element_step");
  return m;
}

DrivenBy driven_by_of(Csv& csv, std::size_t row) {
  const std::string& word = csv.text(row, "driven_by");
  for (const DrivenBy by : {DrivenBy::rotation, DrivenBy::load, DrivenBy::nothing})
    if (word == words_of(by)) return by;
  csv.fail("driven_by", "is neither rotation nor load nor nothing");
}

// A relaxation that was at rest at once has no cost of a step, and a model that broke down no values.
bool usable(double cost) { return std::isfinite(cost) && cost > 0; }

void read_points(const std::string& path, std::vector<ChartedScene>& scenes) {
  Csv csv(path);
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::string& name = csv.text(row, "scene");
    const auto scene =
        std::find_if(scenes.begin(), scenes.end(), [&](const ChartedScene& s) { return s.name == name; });
    if (scene == scenes.end())
      csv.fail("scene", fmt::format("scenes.csv does not say what \"{}\" covers", printable(name, 40)));
    const ChartedModel read = model_of(csv, row);
    if (!usable(read.cpu_per_ns) || !usable(read.ns_per_element_step)) continue;
    auto model = std::find_if(scene->models.begin(), scene->models.end(),
                              [&](const ChartedModel& m) { return m.name == read.name; });
    if (model == scene->models.end()) model = scene->models.insert(scene->models.end(), read);
    const std::string& kind = csv.text(row, "reference_kind");
    if (kind != "finest" && kind != "md") csv.fail("reference_kind", "is neither finest nor md");
    auto& values = kind == "md" ? model->atoms : model->finest;
    const ChartedValue v{csv.text(row, "unit"), csv.number(row, "value"), csv.number(row, "reference"),
                         csv.number(row, "error")};
    if (std::isfinite(v.value) && std::isfinite(v.reference) && std::isfinite(v.error))
      values[csv.text(row, "observable")] = v;
  }
}

}  // namespace

const char* words_of(DrivenBy by) {
  return by == DrivenBy::rotation ? "rotation" : by == DrivenBy::load ? "load" : "nothing";
}

const ChartedModel* ChartedScene::standard() const {
  for (const ChartedModel& m : models)
    if (m.kind == "default") return &m;
  return nullptr;
}

std::vector<ChartedScene> read_chart(const std::string& directory) {
  std::vector<ChartedScene> scenes;
  Csv csv(directory + "/scenes.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    ChartedScene s;
    s.name = csv.text(row, "scene");
    s.tubes = csv.integer(row, "tubes");
    s.contact = csv.integer(row, "contact") != 0;
    s.radius = csv.number(row, "radius_nm");
    s.curvature = csv.number(row, "curvature_per_nm");
    s.twist = csv.number(row, "twist_rad_per_nm");
    s.crossing_from = csv.number(row, "crossing_from_deg");
    s.crossing_to = csv.number(row, "crossing_to_deg");
    s.driven_by = driven_by_of(csv, row);
    const std::string& from = csv.text(row, "energy_from");
    if (from != "start" && from != "zero") csv.fail("energy_from", "is neither start nor zero");
    s.energy_above_start = from == "start";
    scenes.push_back(std::move(s));
  }
  read_points(directory + "/points.csv", scenes);
  return scenes;
}

}  // namespace ropewalk
