#include "scene/refuse_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/error.hpp"
#include "scene/ends/grip.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/scene_place.hpp"

namespace ropewalk {
namespace {

using Kept = std::array<bool, 6>;  // the axes of LoadEffect::axes along and about which an element cannot follow a load

Kept kept_by(const Load& load) {
  Kept out{};
  const std::optional<LoadEffect> effect = load.effect();
  if (!effect) return out;
  const auto* grip = dynamic_cast<const GripLoad*>(&load);
  const auto* turned = dynamic_cast<const PrescribedRotation*>(&load);
  // A load that holds all tubes as one body leaves each tube free.
  for (std::size_t axis = 0; axis < out.size(); ++axis) {
    const LoadComponent& c = effect->axes[axis];
    out[axis] = c.is_kept() && (c.each || grip || turned);
  }
  // A clamp that is free in one way moves under what acts on any of its elements.
  if (grip && (grip->slide_free || grip->spin_free || grip->tilt_free ||
               std::find(out.begin(), out.end(), false) != out.end()))
    return Kept{};
  if (turned && turned->spin_free) out[LoadEffect::about_z] = false;
  return out;
}

// The axes along and about which a clamp holds its elements for good.
Kept held_by(const GripLoad& grip) {
  Kept out{};
  const std::optional<LoadEffect> effect = grip.effect();
  if (!effect || grip.slide_free || grip.spin_free || grip.tilt_free) return out;
  for (std::size_t axis = 0; axis < out.size(); ++axis) out[axis] = effect->axes[axis].is == LoadComponent::Is::held;
  return out;
}

// Whether a load that fixes elements holds one along or about an axis where its clamp moves it. A clamp that turns or
// tilts moves its elements sideways too.
bool contradicts(const Load& fix, const Kept& clamp) {
  const std::optional<LoadEffect> effect = fix.effect();
  if (!effect) return true;
  const std::array<std::array<std::size_t, 3>, 6> needs = {
      {{0, 4, 5}, {1, 3, 5}, {2, 3, 4}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}}};
  for (std::size_t axis = 0; axis < needs.size(); ++axis)
    if (effect->axes[axis].is_kept())
      for (const std::size_t need : needs[axis])
        if (!clamp[need]) return true;
  return false;
}

bool is_felt(const LoadEffect& effect, const Kept& kept) {
  for (std::size_t axis = 0; axis < kept.size(); ++axis) {
    if (effect.axes[axis].is != LoadComponent::Is::loaded) continue;
    const bool along = axis == LoadEffect::about_z && effect.by == LoadEffect::By::tangential;
    if (along ? !kept[0] || !kept[1] : !kept[axis]) return true;
  }
  return false;
}

std::string named(const Topology& topology, int element) {
  const int tube = topology.tube_of(element);
  return fmt::format("element {} of tube {}", element - topology.tube_begin[tube], tube);
}

}  // namespace

void refuse_loads(const Scene& scene, const Topology& topology, const Interaction& interaction,
                  const LoadsAndConstraints& all) {
  if (all.empty()) return;
  const auto count = static_cast<std::size_t>(topology.elements());
  std::vector<Kept> kept(count, Kept{});
  std::vector<std::optional<Kept>> clamped(count);
  for (const auto& load : all) {
    const Kept own = kept_by(*load);
    const auto* grip = dynamic_cast<const GripLoad*>(load.get());
    for (const int e : load->elements) {
      const auto i = static_cast<std::size_t>(e);
      for (std::size_t axis = 0; axis < own.size(); ++axis) kept[i][axis] = kept[i][axis] || own[axis];
      if (grip) clamped[i] = held_by(*grip);
    }
  }
  std::map<std::string, int> number;  // tables of each name so far
  for (const auto& drive : scene.drives) {
    const std::string table = drive->table().name;
    const InputError::Place place = place_in(scene, table, number[table]++);
    LoadsAndConstraints own;
    drive->add_loads(scene, topology, interaction, own);
    bool loads = false, felt = false;
    int at = -1;
    for (const auto& load : own) {
      const bool fixes = dynamic_cast<const FixLoad*>(load.get()) != nullptr,
                 turns = dynamic_cast<const PrescribedRotation*>(load.get()) != nullptr;
      for (const int e : load->elements)
        if (const auto& clamp = clamped[static_cast<std::size_t>(e)];
            clamp && (turns || (fixes && contradicts(*load, *clamp))))
          throw InputError(place, fmt::format("says how {} moves, and a [[grip]] does as well", named(topology, e)),
                           "name other elements, or leave it to the grip");
      const std::optional<LoadEffect> effect = load->effect();
      if (!effect || dynamic_cast<const GripLoad*>(load.get())) continue;
      if (std::none_of(effect->axes.begin(), effect->axes.end(),
                       [](const LoadComponent& c) { return c.is == LoadComponent::Is::loaded; }))
        continue;
      loads = true;
      for (const int e : load->elements) {
        felt = felt || is_felt(*effect, kept[static_cast<std::size_t>(e)]);
        at = e;
      }
    }
    if (loads && !felt && at >= 0)
      throw InputError(place,
                       fmt::format("is a load that nothing feels: {}, and whatever else it acts on, is held there",
                                   named(topology, at)),
                       "free these elements, load others, or take the table away");
  }
}

}  // namespace ropewalk
