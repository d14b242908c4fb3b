// Charts with logarithmic axes.
#include "report/scatter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;
using ::testing::Not;

ScatterChart scatter(std::vector<double> x, std::vector<double> y) {
  ScatterChart s;
  s.chart.x = {"cost", "s", false, true};
  s.chart.y = {"error", "%", false, true};
  s.chart.lines = {{"models", std::move(x), std::move(y), 0}};
  s.chart.lines[0].points = true;
  return s;
}

TEST(Scatter, TicksStandAtDecades) {
  const std::string svg = scatter_svg(scatter({0.01, 1, 1000}, {1e-3, 1, 100}));
  for (const char* tick : {">0.01<", ">0.1<", ">1<", ">10<", ">100<", ">1000<", ">0.001<"})
    EXPECT_THAT(svg, HasSubstr(tick)) << tick;
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Scatter, FewDecadesHaveTicksBetween) {
  const std::string svg = scatter_svg(scatter({1, 9}, {1, 30}));
  EXPECT_THAT(svg, HasSubstr(">2<"));
  EXPECT_THAT(svg, HasSubstr(">5<"));
}

TEST(Scatter, EqualFactorsAreEqualDistances) {
  const ScatterChart s = scatter({1, 10, 100}, {1, 1.5, 1});
  const std::string svg = scatter_svg(s);
  const std::size_t path = svg.find("points\" d=\"");
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(svg.c_str() + path + 11, "M%lf %lfh0M%lf %lfh0M%lf %lfh0", &x[0], &y[0], &x[1], &y[1],
                        &x[2], &y[2]),
            6);
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.2);
  EXPECT_GT(x[1], x[0]);
  EXPECT_LT(y[1], y[0]) << "upwards";
}

TEST(Scatter, NamesPointsAndLeavesOutWhatHasNoLogarithm) {
  ScatterChart s = scatter({1, 10, 0, -3}, {1, 2, 3, 4});
  s.labels = {{"a<b", "", "nothing", "nowhere"}};
  const std::string svg = scatter_svg(s);
  EXPECT_THAT(svg, HasSubstr("a&lt;b"));
  EXPECT_THAT(svg, Not(HasSubstr("nothing")));
  EXPECT_THAT(svg, Not(HasSubstr("nowhere")));
  EXPECT_EQ(scatter_svg(scatter({0, -1}, {1, 2})), "") << "nothing can be drawn";
}

// Of the text: its name, and the box about it that no other one may enter.
struct Text {
  std::string name;
  double x = 0, y = 0;
};
std::vector<Text> names_in(const std::string& svg) {
  std::vector<Text> all;
  for (std::size_t at = svg.find("class=\"halo"); at != std::string::npos; at = svg.find("class=\"halo", at + 1)) {
    Text t;
    std::sscanf(svg.c_str() + svg.find("x=\"", at), "x=\"%lf\" y=\"%lf\"", &t.x, &t.y);
    const std::size_t begin = svg.find('>', at) + 1;
    t.name = svg.substr(begin, svg.find('<', begin) - begin);
    all.push_back(t);
  }
  return all;
}

TEST(Scatter, NamesKeepApartOrAreLeftOut) {
  std::vector<double> x = {1, 100}, y = {1, 100};
  std::vector<std::string> names = {"far below", "far above"};
  for (int k = 0; k < 20; ++k) {  // in one place
    x.push_back(10 + 0.01 * k);
    y.push_back(10);
    names.push_back("crowd " + std::to_string(k));
  }
  ScatterChart s = scatter(x, y);
  s.labels = {names};
  EXPECT_THAT(scatter_svg(s), HasSubstr("crowd 19")) << "all names, over one another";
  s.names_keep_apart = true;
  const std::vector<Text> drawn = names_in(scatter_svg(s));
  ASSERT_GE(drawn.size(), 3u);
  EXPECT_LT(drawn.size(), 15u) << "twelve places about one point";
  EXPECT_EQ(drawn[0].name, "far below");
  EXPECT_EQ(drawn[1].name, "far above");
  EXPECT_EQ(drawn[2].name, "crowd 0") << "the first has the room";
  std::vector<double> rows;
  for (std::size_t k = 2; k < drawn.size(); ++k) rows.push_back(drawn[k].y);
  std::sort(rows.begin(), rows.end());
  // At most two names in a row, one on each side.
  for (std::size_t k = 2; k < rows.size(); ++k) EXPECT_GT(rows[k] - rows[k - 2], 5) << k;
}

TEST(Scatter, PaleMarksAndLinesStandBack) {
  ScatterChart s = scatter({1, 10}, {1, 2});
  s.chart.lines.push_back({"", {1, 10}, {1, 1}, 2});
  EXPECT_THAT(scatter_svg(s), Not(HasSubstr("faint")));
  s.styles.resize(2);
  s.styles[0].faint = true;
  EXPECT_THAT(scatter_svg(s), HasSubstr("class=\"mark e0 faint\""));
  s.styles[1].faint = true;
  EXPECT_THAT(scatter_svg(s), HasSubstr("class=\"line c2 faint\""));
}

TEST(Scatter, AFilledLineIsAnAreaWithItsNameInIt) {
  LineChart chart;
  chart.x = {"step", "fs"};
  chart.y = {"viscosity", "", false, true};
  chart.lines = {{"limit", {2, 4}, {1000, 0.1}, 1}, {"stable", {2, 4, 0, 0}, {1000, 0.1, 0.1, 1000}, 3}};
  const std::string before = chart_svg(chart);
  EXPECT_THAT(before, HasSubstr("line c3"));
  chart.lines[1].filled = true;
  const std::string svg = chart_svg(chart);
  EXPECT_THAT(svg, Not(HasSubstr("line c3"))) << "no stroke, no key";
  const std::size_t area = svg.find("region e3\" d=\"");
  ASSERT_NE(area, std::string::npos);
  double x[4], y[4], at_x = 0, at_y = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + area + 14, "M%lf %lfL%lf %lfL%lf %lfL%lf %lfZ", &x[0], &y[0], &x[1], &y[1],
                        &x[2], &y[2], &x[3], &y[3]),
            8);
  EXPECT_NEAR(x[0] - x[2], x[1] - x[0], 0.2) << "at 0, 2 and 4";
  EXPECT_EQ(x[2], x[3]);
  EXPECT_EQ(y[0], y[3]);
  const std::size_t name = svg.rfind("x=\"", svg.find(">stable<"));
  ASSERT_EQ(std::sscanf(svg.c_str() + name, "x=\"%lf\" y=\"%lf\"", &at_x, &at_y), 2);
  // A trapezium of the sides 2 and 4: its centre lies 14/9 from the longer side's end at 0, 4/9 of the height up.
  EXPECT_NEAR(at_x, x[2] + 14.0 / 9 * (x[0] - x[2]) / 2, 0.2);
  EXPECT_NEAR(at_y - 4, y[1] + 4.0 / 9 * (y[0] - y[1]), 0.2) << "in logarithms";
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
