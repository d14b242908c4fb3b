#include "bench/bench_scenes.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "model/error.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

// Tubes of 50 elements. The larger films differ only in size: the box has 100 nm^2 for each tube.
BenchScene film(const char* name, int tubes, int width, int depth) {
  return {name, fmt::format("film of {} tubes of 50 elements, {} nm x {} nm", tubes, width, depth),
          fmt::format("[film]\ntubes = {}\nwidth_nm = {}\ndepth_nm = {}\n", tubes, width, depth), 50};
}

BenchScene rope(const char* name, int tubes, int elements) {
  return {name, fmt::format("rope of {} tubes of {} elements", tubes, elements),
          fmt::format("[rope]\ntubes = {}\nperturbation_nm = 0.0005\n", tubes), elements};
}

// Twisted from rest at 0 K to 46 degrees at the outermost tubes and held for a while. Neighbours then cross at 0 to
// 17 degrees.
BenchScene twisted(BenchScene rope) {
  rope.after = 135;
  rope.description += fmt::format(", twisted for {} ps before it is measured", rope.after);
  rope.name += "-twisted";
  rope.motion = "[damping]\n[twist]\nmoment_nN_nm = 35\nrate_nN_nm_per_ps = 1\nhold_ps = 500\n[run]\n";
  return rope;
}

const BenchScene* named(const std::string& name) {
  for (const BenchScene& s : bench_scenes())
    if (s.name == name) return &s;
  return nullptr;
}

std::string text_of(const BenchScene& s, bool paper) {
  // The element lengths of the shipped sets; a deviation of less than half an element is rounded away.
  const double element_length = paper ? 1.356 : 1.3776;
  std::string text = fmt::format("format = \"{}\"\nname = \"{}\"\nparameters = \"{}\"\n", scene_format, s.name,
                                 paper ? "cnt-10-10-paper" : "cnt-10-10-tersoff");
  text += s.source;
  if (s.elements > 0) text += fmt::format("length_nm = {}\n", s.elements * element_length);
  // The moment of the twisted ropes is more than real walls bear.
  text += "[bond]\nlaw = \"harmonic\"\n";
  text += fmt::format("[contact]\nlaw = \"{}\"\n", paper ? "paper" : "line");
  return text + s.motion;
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes = {
      {"chain", "one straight tube of 10000 elements", "[chain]\nelements = 10000\n", 0},
      rope("rope-91x50", 91, 50),
      twisted(rope("rope-91x50", 91, 50)),
      rope("rope-169x240", 169, 240),
      film("film-1e3", 20, 75, 70),
      film("film-1e4", 200, 200, 100),
      film("film-1e5", 2000, 500, 400),
      film("film-1e6", 20000, 2000, 1000),
  };
  return scenes;
}

double bench_after(const std::string& name) {
  const BenchScene* s = named(name);
  return s ? s->after : 0;
}

std::string bench_scene_text(const std::string& name, const std::string& law) {
  const BenchScene* s = named(name);
  return s ? text_of(*s, law == "paper") : "";
}

Scene bench_scene(const std::string& name, const std::string& law) {
  if (const BenchScene* s = named(name)) return scene_of_text(text_of(*s, law == "paper"), name);
  if (!std::filesystem::exists(name))
    throw InputError({"", 0, "scene"}, fmt::format("there is no file and no known scene '{}'", name),
                     "see `ropewalk bench --list`");
  if (!law.empty())
    throw InputError({"", 0, "--law"}, "belongs to the scenes of `ropewalk bench --list`",
                     fmt::format("write law = \"{}\" under [contact] of {}", law, name));
  return read_scene(name);
}

}  // namespace ropewalk
