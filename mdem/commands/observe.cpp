// `observe`: the geometry of the stored frames.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "io/frames/frames.hpp"
#include "io/tube_table.hpp"
#include "model/error.hpp"
#include "observe/observables.hpp"
#include "plan/planner.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Observable> observables_of_frames() {
  std::vector<Observable> chosen;
  for (const Observable& o : observables())
    if (in_frames(o.group)) chosen.push_back(o);
  return chosen;
}

Json as_json(const Measurement& m, const std::vector<Observable>& chosen) {
  Json out;
  for (const Observable& observable : chosen) {
    const double value = observable.value(m);
    if (observable.whole && std::isfinite(value)) {
      out[observable.name] = static_cast<std::int64_t>(value);
    } else {
      out[observable.name] = value;
    }
  }
  const RopeObservation& o = m.rope;
  out["radius_profile_nm"] = o.radius_profile;
  Json line = Json::array();
  for (const Vector3& c : o.centre_line) line.push_back({c.x(), c.y(), c.z()});
  out["centre_line_nm"] = std::move(line);
  Json section = Json::array();
  for (std::size_t k = 0; k < o.middle.points.size(); ++k)
    section.push_back({{"x_nm", o.middle.points[k].x()},
                       {"y_nm", o.middle.points[k].y()},
                       {"neighbours", o.middle.neighbours[k]},
                       {"delaunay", o.middle.delaunay[k]}});
  out["section"] = std::move(section);
  return out;
}

// A table for the terminal. The words of a name stand one above the other, so that columns are narrow.
class Console {
 public:
  explicit Console(std::vector<Observable> columns) : columns_(std::move(columns)) {
    for (const Observable& o : columns_) {
      words_.push_back(words_of(o.name));
      std::size_t width = o.whole ? 4 : 9;
      for (const std::string& word : words_.back()) width = std::max(width, word.size());
      width_.push_back(width);
    }
  }

  void print_heading() const {
    std::size_t lines = 0;
    for (const auto& words : words_) lines = std::max(lines, words.size());
    for (std::size_t line = 0; line < lines; ++line)
      print_line([&](std::size_t k) { return line < words_[k].size() ? words_[k][line] : std::string(); });
  }

  void print_row(const Measurement& m) const {
    print_line([&](std::size_t k) {
      const double value = columns_[k].value(m);
      return columns_[k].whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
    });
  }

 private:
  static std::vector<std::string> words_of(const std::string& name) {
    std::vector<std::string> words(1);
    for (const char c : name) {
      if (c == '_') {
        words.emplace_back();
      } else {
        words.back() += c;
      }
    }
    return words;
  }

  template <class Cell>
  void print_line(const Cell& cell) const {
    std::string line;
    for (std::size_t k = 0; k < columns_.size(); ++k)
      line += fmt::format("{}{:>{}}", k == 0 ? "" : " ", cell(k), width_[k]);
    fmt::print("{}\n", line);
  }

  std::vector<Observable> columns_;
  std::vector<std::vector<std::string>> words_;
  std::vector<std::size_t> width_;
};

}  // namespace

int observe_command(const ObserveArguments& a) {
  if (a.list) {
    fmt::print("{}", observables_markdown());
    return 0;
  }
  if (a.dir.empty())
    throw InputError({"", 0, "dir"}, "is missing", "name the directory of a run, or see `ropewalk observe --list`");
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  if (a.neighbour_radius > 0) scene.observe.neighbour_radius = a.neighbour_radius;
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  const auto reader = open_frames(dir.frames());
  const std::vector<Observable> chosen = observables_of_frames();
  const Console console(chosen);
  if (a.tubes) {
    const std::optional<StoredFrame> last = last_frame(dir.frames(), prepared.topology);
    if (!last)
      throw InputError({dir.frames(), 0, ""}, "holds no frame", "run the scene further with `ropewalk resume`");
    fmt::print("{}", tube_table_csv(prepared.topology, last->state, observer.loading));
    return 0;
  }
  if (!a.json) console.print_heading();
  Json all = Json::array();
  StoredFrame frame;
  while (reader->next(prepared.topology, frame)) {
    const RopeObservation rope = observe(observer, scene, prepared.topology, frame.state);
    const Loading load = loading(prepared.topology, frame.state, observer.loading);
    const Measurement measurement{prepared.topology, frame.state, rope, load, observer.mass, {}};
    if (a.json) {
      all.push_back(as_json(measurement, chosen));
    } else {
      console.print_row(measurement);
    }
  }
  if (a.json) fmt::print("{}\n", all.dump(1));
  if (a.json || expectations_of(scene.text).errors.empty()) return 0;
  fmt::print("\nThis run was planned; held against a finer model:\n");
  PlanArguments check;
  check.check = a.dir;
  return plan_command(check);
}

}  // namespace ropewalk
