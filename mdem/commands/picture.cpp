// `picture`: a figure for a paper from the frames and the log of a run.
#include <fmt/format.h>

#include <filesystem>

#include "commands/verb.hpp"
#include "io/files.hpp"
#include "io/limits_file.hpp"
#include "io/run_results.hpp"
#include "model/error.hpp"
#include "report/drawing.hpp"
#include "run/pages/run_plate.hpp"

namespace ropewalk {
namespace {

struct PictureArguments {
  std::string dir;
  std::string out;                  // .svg, .pdf or .png
  std::vector<double> at;           // ps; empty: four times over the run
  std::string from = "side";        // or "x", "y", "z", "AZIMUTH,ELEVATION"
  std::vector<std::string> curves;  // "twist_eV+bend_eV" is one chart
  std::string x;                    // column over which they are drawn; empty: time
  std::string colour;               // a word of colour_words(); empty: bending moment
  bool sections = false;
  double width = 1040, highest = 200;  // width of the figure and largest height of each state, pixels
  double zoom = 2;                     // pixels of a PNG for one of the figure
  bool force = false;
};

namespace fs = std::filesystem;

std::vector<std::vector<std::string>> curves_of(const std::vector<std::string>& groups) {
  std::vector<std::vector<std::string>> out;
  for (const std::string& group : groups) {
    out.emplace_back(1);
    for (const char c : group)
      if (c == '+')
        out.back().emplace_back();
      else
        out.back().back() += c;
    for (const std::string& column : out.back()) curve_column(column, {}, {"", 0, "--curves"});
  }
  return out;
}

int picture_command(const PictureArguments& a) {
  const std::string format = fs::path(a.out).extension().string();
  if (format != ".svg" && format != ".pdf" && format != ".png")
    throw InputError({a.out, 0, "-o"}, "is no .svg, .pdf or .png", "end the name in one of them");
  refuse_existing(a.out, "-o", a.force);
  PlateOptions options;
  options.at = a.at;
  options.from = a.from;
  options.colour = a.colour;
  options.sections = a.sections;
  options.curves = curves_of(a.curves);
  if (!a.x.empty()) curve_column(a.x, {}, {"", 0, "--x"});
  options.x = a.x;
  options.width = a.width;
  options.highest = a.highest;
  const std::string svg = run_plate({a.dir}, options);
  if (format == ".svg")
    write_file_atomically(a.out, svg);
  else
    write_drawing(a.out, svg, format.substr(1), format == ".png" ? a.zoom : 1, "-o");
  fmt::print("{} written\n", a.out);
  const RunDirectory dir{a.dir};
  if (!fs::exists(dir.limits())) return 0;
  if (const std::string beyond = beyond_sentence(read_limits(dir.limits()).limits); !beyond.empty())
    fmt::print("{}{}\n", beyond, a.curves.empty() ? "" : " Curves are dotted from there on.");
  return 0;
}

}  // namespace

void add_picture(CLI::App& app, Program& program) {
  const auto a = std::make_shared<PictureArguments>();
  CLI::App* c =
      app.add_subcommand("picture", "A figure for a paper: states of a run, their sections, curves with marks");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  c->add_option("-o", a->out, "File to write: .svg, .pdf or .png")->required();
  c->add_option("--at", a->at, "Times of the states, ps [default: four over the run]")->delimiter(',');
  c->add_option("--from", a->from,
                "Seen from: side (the largest deflection in the page), x, y, z, or AZIMUTH,ELEVATION")
      ->capture_default_str();
  c->add_option(
       "--curves", a->curves,
       "Charts below: columns of log.csv, or torque_nN_nm, the mean of both ends; twist_eV+bend_eV,Q makes two")
      ->delimiter(',');
  c->add_option("--x", a->x, "Column of log.csv over which these are drawn, such as rotation_deg [default: time]");
  add_colour(c, a->colour, "Tubes");
  c->add_flag("--sections", a->sections, "The cross-section of each state beside it");
  c->add_option("--width", a->width, "Width of the figure, pixels")
      ->capture_default_str()
      ->check(whole_number(200, 8000));
  c->add_option("--highest", a->highest, "Largest height of a state, pixels")
      ->capture_default_str()
      ->check(whole_number(20, 8000));
  c->add_option("--zoom", a->zoom, "Pixels of a PNG per pixel of the figure")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0.1, 20.0)));
  c->add_flag("--force", a->force, "Replace the file");
  c->callback([a, &program] { program.code = picture_command(*a); });
}

}  // namespace ropewalk
