#include "scene/network_words.hpp"

#include <fmt/format.h>

#include "observe/network.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {

std::string network_words(const Scene& scene, const Topology& topology, const State& state) {
  const auto [width, depth] = scene.source->box();
  if (width == 0) return "";
  const Source::Sizes sizes = scene.source->sizes(scene.element_length);
  const double length = sizes.elements * scene.element_length;
  const TubeNetwork network = tube_network(topology, state, touching * crossed_spacing(scene),
                                           {0.5 * (width - length), 0.5 * (depth - length)});
  const char* const spans = network.spans_x && network.spans_y ? "in x and in y"
                            : network.spans_x                  ? "in x, not in y"
                            : network.spans_y                  ? "in y, not in x"
                                                               : "neither in x nor in y";
  return fmt::format(
      "a tube touches {:.2f} others in the mean, {:.3g} % of the tubes hang together in the largest cluster, and "
      "the "
      "box is spanned {}",
      network.contacts, 100 * network.largest, spans);
}

}  // namespace ropewalk
