// What is said of the network of a film.
#include "scene/network_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/build.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

std::string words_of(const std::string& kind) {
  Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + kind + "[run]\nduration_ps = 1\n",
      "film.toml");
  const BuiltScene b = build(scene);
  return network_words(scene, b.topology, b.state);
}

TEST(NetworkWords, OfAFilm) {
  const std::string box = "length_nm = 20\nwidth_nm = 60\ndepth_nm = 60\nlaid = \"resting\"\n";
  EXPECT_EQ(
      words_of("[film]\ntubes = 1\n" + box),
      "a tube touches 0.00 others in the mean, 100 % of the tubes hang together in the largest cluster, and the "
      "box is spanned neither in x nor in y");
  EXPECT_THAT(words_of("[film]\ntubes = 200\n" + box), HasSubstr("spanned in x and in y"));
  EXPECT_THAT(words_of("[film]\ntubes = 200\nspacing_nm = 2.5\n" + box), HasSubstr("touches 0.00 others"));
}

TEST(NetworkWords, OfNoFilm) { EXPECT_EQ(words_of("[rope]\ntubes = 7\nlength_nm = 20\n"), ""); }

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
