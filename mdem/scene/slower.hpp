// The same scene done more slowly: everything that is prescribed takes `times` as long, also holds, logging and the
// rules that end the run, so that row k of its log belongs to row k of the first. A result that rests on loading so
// slowly that the rate does not matter is then nearer to that of no rate at all.
//
// Which keys are times, rates or courses stands with each key (SceneKey::Pace). What tubes do by themselves, such
// as the coupling of a thermostat, the rate at which links form and the damping, stays.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace ropewalk {

// Why the scene has no rate that could be lower, in words for the user; empty: it has one.
std::string why_not_slower(const Scene& scene);

// As text for scene.toml, `comment` (one line) at its head.
std::string slower_scene_text(const Scene& scene, double times, const std::string& comment);

}  // namespace ropewalk
