// `ropewalk validate chart`: measures the points, one file each, and writes the chart from them, or draws it again
// from their table.
#include <fmt/format.h>

#include <filesystem>

#include "chart/chart.hpp"
#include "cli/command_line.hpp"
#include "core/own_files.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "version.hpp"

namespace ropewalk::validate {
namespace {

namespace fs = std::filesystem;

struct Task {
  const ChartScene* scene;
  ChartModel model;
  Specimen specimen;
  ChartPoint point;  // without its cost and values until it is measured
  std::string path;
  bool kept = false;     // measured before, by the same program
  bool counted = false;  // has its instructions, or does not need them
  bool done() const { return kept && counted; }
};

// For the estimate of the time left: the cost of a step differs by more than ten between models.
double guessed_work(const Task& t) {
  double each = 1;
  if (t.model.law == "paper") each = 2;
  if (t.model.precision == Interaction::Precision::full) each *= 2;
  if (!t.scene->contact) each = 0.3;
  return each * t.point.elements * t.point.steps;
}

// Hash of everything that the result depends on: program, scene and settings.
std::string key_of(const ChartPoint& described) {
  return hash_hex(fmt::format("{} {}", git_id, point_json(described)));
}

void make_directory(const fs::path& dir) {
  std::error_code error;
  if (fs::exists(dir, error) && !fs::is_directory(dir, error))
    throw InputError({dir.string(), 0, "--out"}, "exists and is not a directory", "choose another name");
  fs::create_directories(dir, error);
  if (error)
    throw InputError({dir.string(), 0, "--out"}, fmt::format("cannot be created: {}", error.message()),
                     "choose a directory that you may write to");
}

std::vector<Task> tasks_of(const ChartArguments& a) {
  std::vector<const ChartScene*> scenes;
  for (const std::string& name : a.scenes) scenes.push_back(&find_chart_scene(name));
  if (scenes.empty() && a.quick) scenes = {&find_chart_scene("tube-twist"), &find_chart_scene("crossed-tubes")};
  if (scenes.empty())
    for (const ChartScene& s : chart_scenes()) scenes.push_back(&s);
  make_directory(a.out);
  make_directory(fs::path(a.out) / "points");
  refuse_foreign_file(a.out + "/chart.html", page_mark);
  refuse_foreign_file(a.out + "/points.csv", "scene,model,");
  std::vector<Task> tasks;
  for (const ChartScene* scene : scenes)
    for (const ChartModel& model : chart_models(*scene, a.quick)) {
      Task t{scene, model, scene->build(model), {}, {}};
      t.point = describe(*scene, model, t.specimen);
      t.point.key = key_of(t.point);
      t.path = (fs::path(a.out) / "points" / fmt::format("{}--{}.json", scene->name, model.name)).string();
      if (!a.again && fs::exists(t.path)) {
        const ChartPoint before = read_point(t.path);
        t.kept = before.key == t.point.key;
        if (t.kept) t.point = before;
      }
      t.counted = !a.instructions || t.point.instructions || !t.point.error.empty();
      tasks.push_back(std::move(t));
    }
  return tasks;
}

void run_task(Task& t, const ChartArguments& a) {
  try {
    if (!t.kept) measure(t.specimen, t.model, t.point);
    if (a.instructions) t.point.instructions = count_instructions(*t.scene, t.model);
  } catch (const NumericalError& e) {
    t.point.error = e.what();
  }
  write_file_atomically(t.path, point_json(t.point));
}

// All points in the directory, in the order of scenes and models.
std::vector<ChartPoint> points_in(const std::string& dir) {
  std::vector<ChartPoint> points;
  for (const ChartScene& scene : chart_scenes())
    for (const ChartModel& model : chart_models(scene, false)) {
      const fs::path path = fs::path(dir) / "points" / fmt::format("{}--{}.json", scene.name, model.name);
      if (fs::exists(path)) points.push_back(read_point(path.string()));
    }
  return points;
}

void write_chart(const std::string& dir) {
  const std::vector<ChartPoint> points = points_in(dir);
  const std::vector<std::string> facts = {fmt::format("Ropewalk {} ({}), {}, {}; one thread, process CPU time.",
                                                      version, git_id, compiler, build_type)};
  const std::vector<ChartRow> rows = chart_rows(points);
  write_file_atomically(dir + "/points.csv", points_csv(points, rows));
  write_file_atomically(dir + "/chart.html", chart_page(points, rows, facts));
}

void draw_again(const ChartArguments& a) {
  const ChartTable table = read_points_csv(a.from);
  make_directory(a.out);
  refuse_foreign_file(a.out + "/chart.html", page_mark);
  const std::string fact = fmt::format(
      "Drawn by Ropewalk {} from a table of points that were measured before; one thread, process CPU time.",
      version);
  write_file_atomically(a.out + "/chart.html", chart_page(table.points, table.rows, {fact}));
}

}  // namespace

int chart_command(const ChartArguments& a) {
  if (!a.from.empty()) {
    draw_again(a);
    fmt::print("Chart: {}/chart.html\n", a.out);
    return 0;
  }
  std::vector<Task> tasks = tasks_of(a);
  double left = 0, done = 0;
  for (const Task& t : tasks)
    if (!t.done()) left += guessed_work(t);
  const double begin = steady_seconds();
  std::size_t number = 0;
  for (Task& t : tasks) {
    ++number;
    if (!a.quiet) {
      const double eta = done > 0 ? seconds_since(begin) / done * left : 0;
      fmt::print(stderr, "{}/{} {} {}{}{}\n", number, tasks.size(), t.scene->name, t.model.name,
                 t.done() ? ": kept"
                 : t.kept ? ": counting"
                          : "",
                 eta > 5 ? fmt::format(", about {:.0f} s left", eta) : "");
    }
    if (t.done()) continue;
    run_task(t, a);
    if (!a.quiet && !t.point.error.empty()) fmt::print(stderr, "    {}\n", t.point.error);
    done += guessed_work(t);
    left -= guessed_work(t);
    write_chart(a.out);
  }
  write_chart(a.out);
  fmt::print("Chart: {0}/chart.html, numbers: {0}/points.csv\n", a.out);
  return 0;
}

void add_chart(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ChartArguments>();
  CLI::App* c = app.add_subcommand("chart", "Speed against accuracy: cost and error of each numerical setting");
  c->add_option("--scenes", a->scenes, "Scenes, separated by commas [default: all]")->delimiter(',');
  c->add_option("--out", a->out, "Directory of points and chart; finished points in it are not run again")
      ->capture_default_str();
  c->add_option("--from", a->from, "Draw the chart again from this points.csv; nothing is measured")
      ->excludes(c->get_option("--scenes"));
  c->add_flag("--quick", a->quick, "A few models of two scenes, or of the named ones");
  c->add_flag("--instructions", a->instructions,
              "Also count instructions with callgrind (valgrind), for finished points too");
  c->add_flag("--again", a->again, "Run finished points again");
  c->add_flag("--quiet", a->quiet, "No progress lines");
  c->callback([a, &program] { program.code = chart_command(*a); });

  // Hidden: the program runs itself with this verb under callgrind.
  struct Counted {
    std::string scene, model;
    long steps = 0;
  };
  const auto counted = std::make_shared<Counted>();
  CLI::App* steps = app.add_subcommand("chart-steps")->group("");
  steps->add_option("scene", counted->scene)->required();
  steps->add_option("model", counted->model)->required();
  steps->add_option("steps", counted->steps)->required()->check(whole_number(1));
  steps->callback([counted] { step_for_counting(counted->scene, counted->model, counted->steps); });
}

}  // namespace ropewalk::validate
