// The chart of speed against accuracy: errors and fronts of points made by hand, and a small chart end to end.
#include "chart/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "chart/overview.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "scene/ends/twist.hpp"

namespace ropewalk::validate {
namespace {
namespace UNIT {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* columns =
    "scene,model,kind,law,nodes_per_element,cutoff_nm,element_length_nm,integrator,time_step_fs,"
    "mass_scale,mode,contact_viscosity,bond_damping,precision,elements,simulated_ps,element_steps_per_ns,cpu_s_per_"
    "ns,"
    "cpu_ns_per_element_step,instructions_per_element_step,observable,unit,value,reference,reference_kind,error,"
    "failure";

TEST(ParetoFront, KeepsWhatNothingBeatsInBoth) {
  //                                        0    1    2    3    4     5
  const std::vector<double> cost = {1, 2, 2, 3, 4, 0.5};
  const std::vector<double> error = {0.1, 0.2, 0.05, 0.05, 0.01, std::nan("")};
  EXPECT_THAT(pareto_front(cost, error), ElementsAre(0u, 2u, 4u))
      << "1 is dearer and worse than 0, 3 dearer than 2 and no better, 5 has no error";
  EXPECT_THAT(pareto_front({2, 1}, {0.1, 0.1}), ElementsAre(1u)) << "of equal errors the cheaper one";
  EXPECT_TRUE(pareto_front({}, {}).empty());
}

TEST(ChartError, IsAFractionOfTheReferenceAndOfACharge) {
  EXPECT_DOUBLE_EQ(error_of("energy", 99, 100), 0.01);
  EXPECT_NEAR(error_of("energy", -2.2, -2), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(error_of("Q", 3, 0), 0.5) << "against the charge of an ideal twisted rope";
  EXPECT_DOUBLE_EQ(error_of("Q", 9, 12), 0.25);
}

ChartPoint made(const std::string& model, double energy, double cpu) {
  ChartPoint p;
  p.scene = "ring";
  p.model = p.kind = model;
  p.law = "none";
  p.elements = 10;
  p.steps = 1000;
  p.simulated = 50;
  p.cpu = cpu;
  p.time_step = 0.05;
  p.values = {{"energy", energy}, {"end_moment", 2 * energy}, {"bending_moment", 1}};
  return p;
}

TEST(ChartRows, HoldEveryModelToTheFinest) {
  const std::vector<ChartPoint> points = {made(finest_model, 10, 1), made(default_model, 11, 0.1)};
  const std::vector<ChartRow> rows = chart_rows(points);
  ASSERT_EQ(rows.size(), 6u) << "two models, three observables";
  EXPECT_EQ(rows[3].point->model, default_model);
  EXPECT_EQ(rows[3].observable, "energy");
  EXPECT_EQ(rows[3].reference_kind, "finest");
  EXPECT_DOUBLE_EQ(rows[3].error, 0.1);
  EXPECT_DOUBLE_EQ(rows[5].error, 0);
  EXPECT_TRUE(chart_rows({points[1]}).empty()) << "nothing to hold it to";
  ChartPoint failed = points[1];
  failed.error = "it blew up";
  EXPECT_EQ(chart_rows({points[0], failed}).size(), 3u);
}

TEST(ChartRows, AreWrittenWithTheColumnsThatReadersExpect) {
  const std::vector<ChartPoint> points = {made(finest_model, 10, 1), made(default_model, 11, 0.1)};
  std::istringstream text(points_csv(points, chart_rows(points)));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, columns);
  const auto commas = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  for (; std::getline(text, line); ++rows) EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  EXPECT_EQ(rows, 6);
  // 10 elements, 1000 steps in 50 ps, 0.1 s.
  EXPECT_THAT(points_csv(points, chart_rows(points)),
              HasSubstr(",50,200000,2,1e+04,,energy,eV,11,10,finest,0.1,\n"));
}

// --- All scenes in one ---

TEST(ChartQuartiles, LieBetweenNeighboursInOrder) {
  const Quartiles five = quartiles({5, 1, 4, 2, 3}), four = quartiles({40, 10, 20, 30}), one = quartiles({7});
  EXPECT_DOUBLE_EQ(five.lower, 2);
  EXPECT_DOUBLE_EQ(five.median, 3);
  EXPECT_DOUBLE_EQ(five.upper, 4);
  EXPECT_DOUBLE_EQ(four.lower, 17.5);
  EXPECT_DOUBLE_EQ(four.median, 25);
  EXPECT_DOUBLE_EQ(four.upper, 32.5);
  EXPECT_EQ(one.lower, 7);
  EXPECT_EQ(one.median, 7);
  EXPECT_EQ(one.upper, 7);
  EXPECT_THROW(quartiles({}), std::invalid_argument);
}

// Energies of 10 are right in all scenes; the end moment is off as the energy, the bending moment by `bending`.
ChartPoint made_in(const std::string& scene, const std::string& model, double energy, double cpu,
                   double bending = 1) {
  ChartPoint p = made(model, energy, cpu);
  p.scene = scene;
  if (scene == "tube-twist") p.values.erase("bending_moment");
  if (scene == "film") p.values.erase("end_moment");
  if (scene != "tube-twist") p.values["bending_moment"] = bending;
  return p;
}

TEST(ChartOverview, HoldsEveryModelToTheDefaultOfItsScene) {
  std::vector<ChartPoint> points = {made_in("tube-twist", finest_model, 10, 8),
                                    made_in("tube-twist", default_model, 10.1, 1),
                                    made_in("tube-twist", "length-2", 10.3, 0.5),
                                    made_in("film", finest_model, 10, 80),
                                    made_in("film", default_model, 10.2, 10),
                                    made_in("film", "length-2", 9.9, 8, 1.2),
                                    made_in("ring", finest_model, 10, 4),
                                    made_in("ring", default_model, 10.4, 2),
                                    made_in("ring", "length-2", 10.5, 0.2),
                                    made_in("ring", "hooke", 10, 3, 0.5),
                                    made_in("ring", "relax", 10, 3)};
  points.back().error = "it did not come to rest";
  points.back().values.clear();
  ChartPoint torn = made_in("film", "hooke", 10, 1);
  torn.error = "it blew up";
  torn.values.clear();
  points.push_back(torn);
  const std::vector<ModelPlaces> all = places_over_scenes(points, chart_rows(points));
  ASSERT_EQ(all.size(), 3u) << "neither the finest, which is the reference, nor what could be run nowhere";

  const ModelPlaces& ours = all[0];
  EXPECT_EQ(ours.model, default_model);
  EXPECT_DOUBLE_EQ(ours.cost.lower, 1);
  EXPECT_DOUBLE_EQ(ours.cost.upper, 1);
  EXPECT_NEAR(ours.error.median, 0.02, 1e-12) << "of 0.01, 0.02 and 0.04";
  EXPECT_EQ(worth_of(ours), Worth::like_the_default);

  const ModelPlaces& longer = all[1];
  EXPECT_EQ(longer.model, "length-2");
  EXPECT_EQ(longer.words, "element length × 2");
  ASSERT_EQ(longer.scenes.size(), 3u);
  EXPECT_NEAR(longer.cost.median, 0.5, 1e-12) << "of 0.5, 0.8 and 0.1, each over its own default";
  EXPECT_NEAR(longer.cost.lower, 0.3, 1e-12);
  EXPECT_NEAR(longer.cost.upper, 0.65, 1e-12);
  EXPECT_NEAR(longer.error.median, 0.05, 1e-12) << "of 0.03, 0.2 and 0.05: the largest of the observables";
  EXPECT_NEAR(longer.error.lower, 0.04, 1e-12);
  EXPECT_NEAR(longer.error.upper, 0.125, 1e-12);
  EXPECT_NEAR(longer.default_error, 0.02, 1e-12);
  EXPECT_EQ(longer.worst().point->scene, "film");
  EXPECT_EQ(longer.worst().observable, "bending_moment");
  EXPECT_EQ(worth_of(longer), Worth::cheap_at_a_price) << "0.05 is more than twice 0.02";

  const ModelPlaces& hooke = all[2];
  EXPECT_EQ(hooke.scenes.size(), 1u);
  EXPECT_THAT(hooke.failed, ElementsAre("film"));
  EXPECT_NEAR(hooke.default_error, 0.04, 1e-12) << "of the default in the ring alone";
  EXPECT_EQ(worth_of(hooke), Worth::wrong) << "half of the bending moment is missing";
}

TEST(ChartOverview, TellsCheapFromDear) {
  const auto worth = [](double cost, double error) {
    ModelPlaces m;
    m.cost.median = cost;
    m.error.median = error;
    m.default_error = 0.01;
    return worth_of(m);
  };
  EXPECT_EQ(worth(0.6, 0.019), Worth::cheap_and_right);
  EXPECT_EQ(worth(0.6, 0.021), Worth::cheap_at_a_price);
  EXPECT_EQ(worth(0.6, 0.11), Worth::wrong);
  EXPECT_EQ(worth(3, 0.11), Worth::wrong);
  EXPECT_EQ(worth(3, 0.004), Worth::dear_and_better);
  EXPECT_EQ(worth(3, 0.01), Worth::dear_for_nothing);
  EXPECT_EQ(worth(1.05, 0.01), Worth::like_the_default);
}

TEST(ChartOverview, ComesFirstAndNamesModelsInWords) {
  std::vector<ChartPoint> points = {made_in("ring", finest_model, 10, 8), made_in("ring", default_model, 10.1, 1),
                                    made_in("ring", "length-2", 10.15, 0.5)};
  points.back().kind = "element_length";
  const std::string page = chart_page(points, chart_rows(points), {});
  const std::size_t first = page.find("<figure>"), end = page.find("<h2>");
  ASSERT_LT(first, end);
  const std::string part = page.substr(first, end - first);
  EXPECT_EQ(part.find("<figure>", 1), std::string::npos) << "one figure before everything else";
  EXPECT_THAT(part, HasSubstr("All 1 scenes in one"));
  EXPECT_THAT(
      part,
      HasSubstr("Cheap, and at most twice as far off as the default:</b> element length × 2 (0.5; 1.5\u00a0%"));
  EXPECT_EQ(part.find("length-2"), std::string::npos) << "keys are for tables";
  EXPECT_THAT(page, HasSubstr("<td>length-2</td>"));
}

// --- The table of points, drawn again ---

TEST(ChartTable, ComesBackFromItsFile) {
  const std::string shipped = data_directory() + "/chart/points.csv";
  const ChartTable table = read_points_csv(shipped);
  std::size_t failed = 0;
  for (const ChartPoint& p : table.points) failed += p.error.empty() ? 0 : 1;
  EXPECT_EQ(table.points.size(), 426u);
  EXPECT_EQ(failed, 18u);
  std::istringstream before(read_file(shipped)), after(points_csv(table.points, table.rows));
  for (std::string b, a; std::getline(before, b);) {
    ASSERT_TRUE(std::getline(after, a));
    // The cost of a step of one element follows from two rounded numbers.
    std::vector<std::string> old_cells, new_cells;
    for (auto [line, cells] : {std::pair(&b, &old_cells), std::pair(&a, &new_cells)}) {
      std::istringstream text(*line);
      for (std::string cell; std::getline(text, cell, ',');) cells->push_back(cell);
    }
    ASSERT_EQ(new_cells.size(), old_cells.size()) << b;
    for (std::size_t k = 0; k < old_cells.size(); ++k)
      if (k == 18 && old_cells[0] != "scene" && !old_cells[k].empty())
        EXPECT_NEAR(std::stod(new_cells[k]) / std::stod(old_cells[k]), 1, 2e-3) << b;
      else
        EXPECT_EQ(new_cells[k], old_cells[k]) << b;
  }
}

TEST(ChartTable, ThatIsDamagedIsRefused) {
  const std::vector<ChartPoint> points = {made_in("ring", finest_model, 10, 8),
                                          made_in("ring", default_model, 10.1, 1)};
  const std::string good = points_csv(points, chart_rows(points));
  const std::string path = (fs::temp_directory_path() / ("ropewalk-table-" + std::to_string(getpid()))).string();
  write_file_atomically(path, good);
  EXPECT_EQ(read_points_csv(path).rows.size(), 6u);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& bad :
       {std::string(), changed("scene,model", "model,scene"), changed("ring,default", "ring,no-such-model"),
        changed("ring,finest", "no-such-scene,finest"), changed("eV,10.1", "eV,ten"),
        changed("bending_moment", "no_such_moment"), changed(",energy,", ",energy,,")}) {
    write_file_atomically(path, bad);
    EXPECT_THROW(read_points_csv(path), InputError) << bad;
  }
  fs::remove(path);
}

TEST(ChartPoint, ComesBackFromItsFile) {
  ChartPoint p = made(default_model, 11, 0.1);
  p.key = "key";
  p.instructions = 1234.5;
  const std::string path = (fs::temp_directory_path() / ("ropewalk-point-" + std::to_string(getpid()))).string();
  write_file_atomically(path, point_json(p));
  EXPECT_EQ(point_json(read_point(path)), point_json(p));
  ChartPoint failed = p;
  failed.error = "the motion blew up";
  failed.cpu = std::nan("");
  failed.values.clear();
  write_file_atomically(path, point_json(failed));
  EXPECT_EQ(read_point(path).error, failed.error);
  EXPECT_TRUE(std::isnan(read_point(path).cpu));
  for (const char* bad : {"{}", "", "[1]", "{\"format\": \"ropewalk-chart-1\", \"key\": 3}"}) {
    write_file_atomically(path, bad);
    EXPECT_THROW(read_point(path), InputError) << bad;
  }
  fs::remove(path);
}

double grip_distance(const Specimen& s) {
  return (s.state.position[static_cast<std::size_t>(s.grips.front())] -
          s.state.position[static_cast<std::size_t>(s.grips.back())])
      .norm();
}

TEST(ChartScenes, AreTheSameSpecimenAtEveryElementLength) {
  for (const char* name : {"tube-twist", "rope91", "rope19-moment", "crossed-tubes"}) {
    const ChartScene& scene = find_chart_scene(name);
    const std::vector<ChartModel> models = chart_models(scene, false);
    const Specimen base = scene.build(find_chart_model(models, default_model));
    for (const char* other : {finest_model, "length-2", "length-4", "length-8"}) {
      const Specimen s = scene.build(find_chart_model(models, other));
      EXPECT_EQ(s.topology.tubes(), base.topology.tubes());
      EXPECT_NE(s.topology.elements(), base.topology.elements()) << name << " " << other;
      EXPECT_NEAR(grip_distance(s), grip_distance(base), 1e-9) << name << " " << other;
      EXPECT_EQ(s.angle, base.angle);
      EXPECT_EQ(s.moment, base.moment);
      EXPECT_EQ(s.duration(), base.duration());
    }
  }
}

TEST(ChartScenes, AFilmHasTheSameTubesAtEveryElementLength) {
  const ChartScene& scene = find_chart_scene("film");
  const std::vector<ChartModel> models = chart_models(scene, false);
  const Specimen base = scene.build(find_chart_model(models, default_model));
  const auto length = [](const Specimen& s) { return s.topology.length_of(0) * s.scene.element_length; };
  const auto middle = [](const Specimen& s, int tube) -> Vector3 {
    const auto first = static_cast<std::size_t>(s.topology.tube_begin[tube]),
               last = static_cast<std::size_t>(s.topology.tube_begin[tube + 1]) - 1;
    return 0.5 * (s.state.position[first] + s.state.position[last]);
  };
  for (const char* other : {finest_model, "length-2", "length-4"}) {
    const Specimen s = scene.build(find_chart_model(models, other));
    EXPECT_NE(s.topology.elements(), base.topology.elements()) << other;
    EXPECT_NEAR(length(s), length(base), 1e-9) << other;
    for (int t = 0; t < base.topology.tubes(); ++t) EXPECT_LT((middle(s, t) - middle(base, t)).norm(), 1e-9) << t;
  }
}

// As with [twist], a couple on each end element is ramped, and nothing is held.
TEST(ChartScenes, ARopeIsTwistedByAMoment) {
  const ChartScene& scene = find_chart_scene("rope19-moment");
  const std::vector<ChartModel> models = chart_models(scene, false);
  const Specimen s = scene.build(find_chart_model(models, default_model));
  EXPECT_TRUE(s.held().empty());
  const LoadsAndConstraints led = s.loads();
  const std::vector<const TwistLoad*> grips = led.of<TwistLoad>();
  ASSERT_EQ(grips.size(), 2u);
  EXPECT_EQ(std::distance(led.begin(), led.end()), 2) << "and nothing else";
  const TwistLoad& twist = *grips[0];
  EXPECT_EQ(grips[0]->elements.size(), 19u);
  EXPECT_EQ(grips[1]->elements.size(), 19u);
  EXPECT_EQ(grips[0]->sign, 1);
  EXPECT_EQ(grips[1]->sign, -1);
  EXPECT_EQ(grips[1]->moment, twist.moment);
  EXPECT_EQ(twist.moment_at(0), 0);
  EXPECT_NEAR(twist.moment_at(0.5 * s.ramp), 0.5 * s.moment, 1e-12);
  EXPECT_EQ(twist.moment_at(s.duration()), s.moment);
  for (const TwistLoad* grip : grips)
    for (const int e : grip->elements) EXPECT_GT(grip->sign * s.state.position[static_cast<std::size_t>(e)].z(), 0);
  for (const ChartModel& m : models) EXPECT_EQ(m.mode, RunOptions::Mode::dynamics) << m.name;
}

TEST(ChartModels, HaveNamesOfTheirOwn) {
  std::map<std::string, std::string> named;  // by words
  for (const ChartScene& scene : chart_scenes()) {
    std::set<std::string> names;
    for (const ChartModel& model : chart_models(scene, false)) {
      EXPECT_TRUE(names.insert(model.name).second) << scene.name << " " << model.name << " twice";
      EXPECT_FALSE(model.words.empty()) << model.name;
      EXPECT_EQ(model_words(model.name), model.words) << scene.name << ": the same words in every scene";
      EXPECT_TRUE(named.emplace(model.words, model.name).first->second == model.name) << model.words;
    }
    if (scene.published) {
      EXPECT_NO_THROW(find_chart_model(chart_models(scene, true), published_model)) << scene.name;
    }
  }
}

class Chart : public ::testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("ropewalk-chart-" + std::to_string(getpid()));
    arguments.scenes = {"tube-twist"};
    arguments.out = dir.string();
    arguments.quick = arguments.quiet = true;
  }
  void TearDown() override { fs::remove_all(dir); }

  void run() const {
    testing::internal::CaptureStdout();
    const int code = chart_command(arguments);
    testing::internal::GetCapturedStdout();
    EXPECT_EQ(code, 0);
  }
  std::string point(const std::string& model) const {
    return (dir / "points" / ("tube-twist--" + model + ".json")).string();
  }

  fs::path dir;
  ChartArguments arguments;
};

TEST_F(Chart, ComesOutWholeAndIsKept) {
  run();
  const ChartPoint ours = read_point(point(default_model)), published = read_point(point(published_model)),
                   finest = read_point(point(finest_model)), coarse = read_point(point("length-2"));
  ASSERT_EQ(ours.error, "");
  EXPECT_GT(ours.cpu, 0);
  EXPECT_GT(ours.steps, 1000);
  EXPECT_EQ(published.element_length, 1.356);
  EXPECT_DOUBLE_EQ(published.time_step, 0.02);
  // GJ/2 (twist)^2 L of either set, and the moment GJ twist; ours softens by 0.2 % at this twist.
  const double energy = finest.values.at("energy"), moment = finest.values.at("end_moment");
  EXPECT_NEAR(energy, 0.5 * 330.11 / 0.1602177 * 1.791029 * 1.791029 / 43.392, 4e-3 * energy);
  EXPECT_NEAR(moment, 330.11 * 1.791029 / 43.392, 8e-3 * moment);
  EXPECT_NEAR(published.values.at("energy") / energy, 319.5 / 330.11, 4e-3);
  for (const ChartPoint* p : {&ours, &coarse})
    EXPECT_LT(error_of("end_moment", p->values.at("end_moment"), moment), 1e-3);

  const std::string csv = read_file((dir / "points.csv").string());
  EXPECT_EQ(csv.substr(0, csv.find('\n')), columns);
  EXPECT_THAT(csv, HasSubstr("tube-twist,published,published,none"));
  EXPECT_THAT(csv, HasSubstr(",md,"));
  const std::string page = read_file((dir / "chart.html").string());
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("Pareto front"));
  EXPECT_THAT(page, HasSubstr("Against the published model"));
  EXPECT_EQ(page.find("<script"), std::string::npos);

  // From the table alone comes the same page, but for digits that the table does not have.
  ChartArguments again;
  again.from = (dir / "points.csv").string();
  again.out = (dir / "again").string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(chart_command(again), 0);
  testing::internal::GetCapturedStdout();
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const std::string drawn = read_file((dir / "again" / "chart.html").string());
  for (const char* part : {"<figure>", "class=\"mark", "<tr>", "<h2>"})
    EXPECT_EQ(count(drawn, part), count(page, part));
  EXPECT_FALSE(fs::exists(dir / "again" / "points")) << "nothing is measured";

  // A second run keeps all points but the one that another program made.
  const std::string kept = read_file(point(default_model));
  nlohmann::ordered_json stale = nlohmann::ordered_json::parse(read_file(point("length-2")));
  stale["key"] = "another version";
  stale["values"]["energy"] = 1;
  write_file_atomically(point("length-2"), stale.dump());
  fs::remove(point("relax"));
  run();
  EXPECT_EQ(read_file(point(default_model)), kept) << "to the last digit of its CPU time";
  EXPECT_EQ(read_point(point("length-2")).values, coarse.values);
  EXPECT_TRUE(fs::exists(point("relax")));
  arguments.again = true;
  run();
  EXPECT_NE(read_file(point(default_model)), kept);
  EXPECT_EQ(read_point(point(default_model)).values, ours.values) << "only times differ";
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::validate
