// Charts with logarithmic axes.
#include "report/scatter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace ropewalk {
namespace {

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

}  // namespace
}  // namespace ropewalk
