#include "plan/pilot_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "model/error.hpp"
#include "plan/planned_scene.hpp"
#include "plan/scene_edit.hpp"
#include "scene/kinds/film.hpp"
#include "scene/lattice.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

constexpr int least_elements_of_pilot = 20, least_tubes = 7;
constexpr double caution_if_shorter = 1.5, caution_if_fewer = 2;
constexpr double near_enough = 0.85;  // of the time that is too much

class Shrinking {
 public:
  Shrinking(const Scene& scene, double part) : scene_(scene), left_(part), pilot_{scene.text, -1, ""} {}

  PilotScene go() {
    if (left_ < near_enough && scene_.kind == "rope") {
      shorten();
      fewer_tubes();
    }
    if (left_ < near_enough && scene_.kind == "film") smaller_box();
    if (left_ < near_enough) first_part();
    return pilot_;
  }

 private:
  // All drives must do the same in a shorter time, and one of them at least has something to do.
  void shorten() {
    const int elements = elements_of(scene_);
    const double part = std::max(std::sqrt(left_), static_cast<double>(least_elements_of_pilot) / elements);
    if (part > 0.9) return;
    const double length = std::round(part * elements) * scene_.element_length;
    std::vector<std::pair<std::string, double>> keys;
    for (const auto& drive : scene_.drives) {
      const auto hastened = drive->hastened(part);
      if (!hastened) return;
      keys.insert(keys.end(), hastened->begin(), hastened->end());
    }
    if (keys.empty()) return;
    attempt(part * part, caution_if_shorter,
            fmt::format("{:.3g} of {:.3g} nm in as short a time", length, elements * scene_.element_length), [&] {
              set("rope.length_nm", length);
              for (const auto& [key, value] : keys) set(key.c_str(), value);
              if (scene_.run.duration > 0) set("run.duration_ps", scene_.run.duration * part);
              if (scene_.run.log_every > 0) set("run.log_every_ps", scene_.run.log_every * part);
            });
  }

  void fewer_tubes() {
    const int tubes = scene_.source->sizes(scene_.element_length).tubes;
    const int fewer = std::max(least_tubes, nearest_hexagonal(static_cast<int>(left_ * tubes)).first);
    if (left_ >= near_enough || fewer >= tubes) return;
    attempt(static_cast<double>(fewer) / tubes, caution_if_fewer, fmt::format("{} of {} tubes", fewer, tubes),
            [&] { set("rope.tubes", fewer); });
  }

  void smaller_box() {
    const auto& film = dynamic_cast<const FilmSource&>(*scene_.source);
    const double smallest = 1.01 * film.length / std::min(film.width, film.depth);
    const double side = std::max(std::sqrt(left_), smallest);
    if (side >= 0.95) return;
    const int tubes = std::max(2, static_cast<int>(std::lround(film.tubes * side * side)));
    attempt(side * side, caution_if_fewer, fmt::format("{} of {} tubes, as dense", tubes, film.tubes), [&] {
      set("film.tubes", tubes);
      set("film.width_nm", film.width * side);
      set("film.depth_nm", film.depth * side);
    });
  }

  void first_part() {
    if (scene_.run.mode == RunOptions::Mode::relax) return;
    Scene small = scene_of_text(pilot_.text, scene_.path);
    const double duration = prepare(small).duration;
    pilot_.until = left_ * duration;
    say(fmt::format("the first {:.3g} of {:.3g} ps", pilot_.until, duration), caution_if_shorter);
  }

  void set(const char* path, double value) {
    pilot_.text = with_value(pilot_.text, path, fmt::format("{:.10g}", value), scene_.path);
  }

  // Undone where it makes no scene, such as one whose grips name tubes that are gone.
  void attempt(double part, double caution, const std::string& words, const std::function<void()>& change) {
    const PilotScene before = pilot_;
    try {
      change();
      Scene small = scene_of_text(pilot_.text, scene_.path);
      prepare(small);
    } catch (const InputError&) {
      pilot_ = before;
      return;
    }
    left_ /= part;
    say(words, caution);
  }

  void say(const std::string& words, double caution) {
    pilot_.words += (pilot_.words.empty() ? "" : ", ") + words;
    pilot_.caution = std::max(pilot_.caution, caution);
  }

  const Scene& scene_;
  double left_;  // of the time, that is still too much
  PilotScene pilot_;
};

}  // namespace

PilotScene pilot_scene(const Scene& scene, double seconds, double affordable) {
  return Shrinking(scene, affordable / seconds).go();
}

}  // namespace ropewalk
