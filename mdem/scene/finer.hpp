// A scene with elements of half the length: what a run goes on with when its elements have become too long.
//
// If drives hold single elements, another element comes between every two (Splitting::between). The held elements
// then keep their centres, the tubes keep their free length (free_length()), and each load on an element keeps its
// place and size. In other scenes every element is split in two, and the tubes keep their length. Lengths in the
// finer scene are whole elements. Each other key states its dependence on the element length
// (SceneKey::length_power): a load on all elements divides among them, nodes of the line law keep their spacing,
// tubes their range of self-exclusion, and dissipation its value per length of tube (scene/tables/damping.cpp). A
// typed time step keeps its share of the stability limit.
#pragma once

#include <string>

#include "scene/prepare.hpp"
#include "sim/dynamics/refine.hpp"

namespace ropewalk {

// How the elements of a scene are split.
Splitting splitting_of(const Scene& scene);

// Why the elements of a scene cannot be split, in words for the user; empty: they can. Not below the radius of the
// thickest tube: a rod is a model of lengths above the diameter, and the isotropic inertia of an element that short
// is 1.7 times the transverse one of a tube.
std::string why_not_finer(const Scene& scene, const Topology& topology);

// As text for scene.toml, `comment` (one line) at its head. A [state] is read from the file that the scene names,
// which must then hold the halved one.
std::string finer_scene_text(const Scene& scene, const Prepared& prepared, const std::string& comment);

}  // namespace ropewalk
