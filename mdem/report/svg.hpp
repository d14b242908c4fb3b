// Pictures as SVG text: line charts, side views of a rope, cross-sections. The same data give the same bytes.
// Charts and sections take their colours from svg_css(), which a page includes once and which follows the reader's
// light or dark setting. rope_svg() is a complete file.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/markup.hpp"
#include "observe/observe.hpp"

namespace ropewalk {

// --- Text ---

// A number with `digits` digits, with a true minus sign, and as a power of 10 if that is shorter; a dash for NaN.
std::string number_text(double value, int digits = 4);
// A number with `decimals` decimals, for columns; digits are in groups of three from 10 000 on.
std::string fixed_text(double value, int decimals);

// CSS rules for all pictures below, and the variables --paper, --ink, --soft and --rule, which a page may use too.
std::string svg_css();

// A file of its own, on white, with elements that have the colours of svg_css().
std::string svg_file(const std::string& body, double width, double height);

// "#rrggbb" of the viridis map at 0 .. 1; values outside are clamped.
std::string viridis(double at);

// --- Line charts ---

inline constexpr int categorical_colours = 6;  // 0 .. 5, told apart by colour-blind readers
inline constexpr int sequential_colours = 6;   // 6 .. 11, from early to late
// The k-th of n lines that follow one another.
int sequential_colour(std::size_t k, std::size_t n);

struct ChartLine {
  std::string name;
  std::vector<double> x, y;  // a NaN interrupts the line
  int colour = 0;
  bool dashed = false;
  bool steps = false;   // holds its value until the next point
  bool points = false;  // dots, not joined
  // A band about the line, as wide as this to either side; empty: none.
  std::vector<double> error = {};
  bool bars = false;    // the errors are bars at its points instead
  bool filled = false;  // an area that the line goes round, with its name at the centre
  // From this point on the line is pale and dotted: the run is beyond its model there.
  std::size_t beyond = std::numeric_limits<std::size_t>::max();
};

struct ChartBand {
  double from = 0, to = 0;
  std::string label;
  bool dark = false;
};

struct ChartAxis {
  std::string quantity, unit;  // the unit may be empty
  bool whole = false;          // ticks at integers only
  bool decades = false;        // the axis is logarithmic, and the chart omits points that are not positive
  bool from_zero = false;      // 0 is on the axis, so that differences look as large as they are
};

struct LineChart {
  std::string title;  // read aloud, not shown
  ChartAxis x, y;
  std::vector<ChartLine> lines;
  std::vector<ChartBand> bands;
  double width = 540, height = 290;  // user units: pixels at full size
  // Names of the fields below and above all whole lines, "stable" and "unstable"; the lower one is shaded.
  std::string below = {}, above = {};
  // From here to the right the chart is hatched, under the name that stands at the top; NaN: nowhere.
  double beyond = std::numeric_limits<double>::quiet_NaN();
  std::string beyond_name = {};
  std::string note = {};  // words in the lower right corner
};

// False if no line has two finite points at different x.
bool can_draw(const LineChart& chart);
// An <svg> element; empty if the chart cannot be drawn. A line has at most 400 points: of crowded points the lowest
// and the highest are kept.
std::string chart_svg(const LineChart& chart);

// --- Ropes from the side ---

// What tubes are coloured by, as the bar of colours names it.
struct RopeColours {
  std::string quantity = "bending moment", unit = "nN nm";  // the unit may be empty
  bool is_signed = false;                                   // zero is the middle of the colours
};

struct RopeView {
  double time_ps = 0;
  double beta_deg = 0;
  std::vector<std::vector<Vector3>> tubes;  // nm
  RopeColours coloured_by = {};
  std::vector<std::vector<double>> colour = {};    // quantity of each element, in its unit; none: shaded by depth alone
  std::vector<double> radii = {};                  // radii of the tubes, nm; none: all are of the one radius
  std::vector<std::array<Vector3, 2>> links = {};  // points on the axes of two tubes, nm; drawn in red
};

// Direction and scale of a view. Several views with one camera are comparable.
struct RopeCamera {
  Vector3 right = Vector3::UnitZ(), up = Vector3::UnitX(), towards = Vector3::UnitY();
  double left = 0, width = 1;  // nm along `right`
  double scale = 1;            // pixels per nm
  RopeColours coloured_by = {};
  double least = 0, most = 0;  // ends of the colours; the same: no view has any
  bool coloured() const { return most > least; }
};
// The rope lies across the page, and the plane of its largest deflection in the page.
RopeCamera rope_camera(const std::vector<RopeView>& views, double tube_radius, double widest = 1040,
                       double highest = 300);
// A camera at a side of one's choice: `towards` points to who looks. The rope lies across the page unless it is
// seen from its end.
RopeCamera rope_camera(const std::vector<RopeView>& views, double tube_radius, const Vector3& towards,
                       double widest, double highest);

// An <svg> element of at most 60 kB. `name` makes its ids unique in the page.
std::string rope_picture(const RopeView& view, const RopeCamera& camera, double tube_radius,
                         const std::string& name, bool scale_bar);
double scale_bar_length(const RopeCamera& camera);  // nm
std::string colour_bar(const RopeCamera& camera);   // an <svg> element: the colours and their scale

// A file of its own, on white, with scale bar and colours: for a README or a paper.
std::string rope_svg(const RopeView& view, double tube_radius, double width = 1200);

// --- Cross-sections ---

// half_width: nm, the same for sections that are to be compared. Classes: n5, n7, nx (internal with another
// number of neighbours than six), n6, outermost.
std::string section_picture(const CrossSection& section, const RopeShells& shells, double tube_radius,
                            double half_width, double pixels = 200);
double section_half_width(const CrossSection& section, double tube_radius);

}  // namespace ropewalk
