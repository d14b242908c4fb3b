// A scene with elements of half the length: what a run goes on with when its elements have become too long.
//
// Loads and properties of a length of tube stay where they are on the tube. Lengths are those that the tubes have, in
// whole elements; a [[load]] on an element acts on both its halves; fixed and rotated elements are so with both halves.
// The grips of [twist] are the end elements of the tubes as in any scene: the same ends, gripped half as long, a
// quarter of a length farther out. How every other key goes with the length of an element stands with the key
// (SceneKey::length_power): the halves share a force or couple, so that the total and its place are the same; nodes
// of the line law keep their spacing, tubes their range of self-exclusion, and dissipation belongs to a length of
// tube (scene/tables/damping.cpp). A typed time step keeps its share of the stability limit.
#pragma once

#include <string>

#include "scene/prepare.hpp"

namespace ropewalk {

// Why the elements of a scene cannot be split, in words for the user; empty: they can. Not below the radius of the
// thickest tube: a rod is a model of lengths above the diameter, and the isotropic inertia of an element that short
// is 1.7 times the transverse one of a tube.
std::string why_not_finer(const Scene& scene, const Topology& topology);

// As text for scene.toml, `comment` (one line) at its head. A [state] is read from the file that the scene names,
// which must then hold the halved one.
std::string finer_scene_text(const Scene& scene, const Prepared& prepared, const std::string& comment);

}  // namespace ropewalk
