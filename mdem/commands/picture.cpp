// `picture`: a figure for a paper from the frames and the log of a run.
#include <fmt/format.h>

#include <filesystem>

#include "commands/commands.hpp"
#include "io/files.hpp"
#include "io/limits_file.hpp"
#include "io/run_results.hpp"
#include "model/error.hpp"
#include "report/drawing.hpp"
#include "run/pages/run_plate.hpp"

namespace ropewalk {
namespace {

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

}  // namespace

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

}  // namespace ropewalk
