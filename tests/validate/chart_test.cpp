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

#include "io/files.hpp"
#include "model/error.hpp"
#include "scene/loads/twist.hpp"

namespace ropewalk::validate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* columns =
    "scene,model,kind,law,nodes_per_element,cutoff_nm,element_length_nm,integrator,time_step_fs,"
    "mass_scale,mode,contact_viscosity,bond_damping,precision,elements,simulated_ps,element_steps_per_ns,cpu_s_per_"
    "ns,"
    "cpu_ns_per_element_step,instructions_per_element_step,observable,unit,value,reference,reference_kind,error";

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
  std::istringstream text(points_csv(chart_rows(points)));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, columns);
  const auto commas = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  for (; std::getline(text, line); ++rows) EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  EXPECT_EQ(rows, 6);
  // 10 elements, 1000 steps in 50 ps, 0.1 s.
  EXPECT_THAT(line = points_csv(chart_rows(points)), HasSubstr(",50,200000,2,1e+04,,energy,eV,11,10,finest,0.1\n"));
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
  for (const ChartScene& scene : chart_scenes()) {
    std::set<std::string> names;
    for (const ChartModel& model : chart_models(scene, false))
      EXPECT_TRUE(names.insert(model.name).second) << scene.name << " " << model.name << " twice";
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

}  // namespace
}  // namespace ropewalk::validate
