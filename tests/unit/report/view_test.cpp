// The page in space: the precision of packing, and the frames left out of a page that would be too long.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <regex>
#include <sstream>

#include "report/view/pack.hpp"
#include "report/view/view_files.hpp"
#include "report/view/view_page.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Frames = std::vector<std::vector<double>>;

// The inverse of Packer, after the description in pack.hpp.
struct Unpacker {
  std::string bytes;
  std::size_t at = 0;

  Unpacker(const std::string& deflated, std::size_t size) : bytes(size, '\0') {
    uLongf length = static_cast<uLongf>(size);
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                         reinterpret_cast<const Bytef*>(deflated.data()), static_cast<uLong>(deflated.size())),
              Z_OK);
    EXPECT_EQ(length, size);
  }

  std::vector<std::vector<int>> next(std::size_t frames, const std::vector<int>& begin, int order) {
    const std::size_t n = static_cast<std::size_t>(begin.back()), total = frames * n;
    const auto byte = [&](std::size_t k) { return static_cast<int>(static_cast<unsigned char>(bytes[k])); };
    std::vector<std::vector<int>> out(frames, std::vector<int>(n));
    for (std::size_t f = 0; f < frames; ++f)
      for (std::size_t t = 0; t + 1 < begin.size(); ++t)
        for (int k = begin[t]; k < begin[t + 1]; ++k) {
          const std::size_t i = f * n + static_cast<std::size_t>(k);
          const int stored = byte(at + i) | byte(at + total + i) << 8;
          const int difference = stored % 2 ? -(stored + 1) / 2 : stored / 2;
          const auto code = [&](int e) { return out[f][static_cast<std::size_t>(e)]; };
          int guess = 0;
          if (k == begin[t])
            guess = t > 0 ? code(begin[t - 1]) : 0;
          else
            guess = order == 2 && k - begin[t] >= 2 ? 2 * code(k - 1) - code(k - 2) : code(k - 1);
          out[f][static_cast<std::size_t>(k)] = (guess + difference) & 65535;
        }
    at += 2 * total;
    return out;
  }
};

Frames random_frames(std::size_t frames, std::size_t n, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(low, high);
  Frames out(frames, std::vector<double>(n));
  for (auto& frame : out)
    for (double& v : frame) v = value(random);
  return out;
}

TEST(ViewPacking, KeepsNumbersToHalfAStep) {
  const std::vector<int> begin = {0, 1, 4, 60};  // also a tube of one element
  const double none = std::numeric_limits<double>::quiet_NaN();
  Frames wild = random_frames(3, 60, -5, 1e6, 1);  // jumps over the whole range
  wild[1][7] = none;
  wild[2][59] = std::numeric_limits<double>::infinity();
  Frames smooth = wild;
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t k = 0; k < 60; ++k) smooth[f][k] = std::sin(0.1 * static_cast<double>(k + 10 * f));
  const Frames constant(3, std::vector<double>(60, 4.25));

  Packer packer;
  const std::vector<std::pair<Frames, int>> channels = {{wild, 1}, {smooth, 2}, {wild, 2}, {constant, 1}};
  std::vector<CodeScale> scales;
  for (const auto& [frames, order] : channels) {
    scales.push_back(code_scale(frames, order == 1 ? 1000 : 65534));
    packer.add(frames, begin, scales.back(), order);
  }
  Unpacker unpacker(packer.deflated(), 4 * 2 * 3 * 60);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto codes = unpacker.next(3, begin, channels[c].second);
    for (std::size_t f = 0; f < 3; ++f)
      for (std::size_t k = 0; k < 60; ++k) {
        const double value = channels[c].first[f][k];
        if (!std::isfinite(value))
          EXPECT_EQ(codes[f][k], no_number_code);
        else
          EXPECT_NEAR(scales[c].value(static_cast<std::uint16_t>(codes[f][k])), value, 0.5001 * scales[c].step);
      }
  }
}

TEST(ViewPacking, TheRangeHasTheLevelsAskedFor) {
  const CodeScale scale = code_scale({{-2, 7}, {3, std::nan("")}}, 1000);
  EXPECT_DOUBLE_EQ(scale.low, -2);
  EXPECT_DOUBLE_EQ(scale.step, 9.0 / 1000);
  EXPECT_EQ(scale.code(-2), 0);
  EXPECT_EQ(scale.code(7), 1000);
  EXPECT_EQ(scale.code(std::nan("")), no_number_code);
  EXPECT_EQ(code_scale({{-2, 7}}, 65534).code(7), no_number_code - 1);
}

// Noise, which no packing makes small.
ViewInput noisy(std::size_t frames) {
  ViewInput in;
  in.name = "a </script> rope & more";
  in.tube_begin = {0, 200, 400};
  in.tube_radius = {0.7, 0.7};
  in.stored_frames = frames;
  for (std::size_t f = 0; f < frames; ++f) {
    in.time_ps.push_back(static_cast<double>(f));
    in.step.push_back(static_cast<std::int64_t>(f));
  }
  const Frames x = random_frames(frames, 402, 0, 60, 2);
  for (const auto& frame : x) {
    in.joints.emplace_back();
    for (const double v : frame) in.joints.back().push_back({v, v, v});
  }
  in.fields.push_back({"Energy", "eV", "noise", false, random_frames(frames, 400, 0, 1, 3),
                       std::vector<double>(frames, std::nan(""))});
  return in;
}

TEST(ViewPage, RoundsAndThenLeavesFramesOutWhereItWouldBeTooLong) {
  const ViewInput in = noisy(40);
  const ViewPage all = view_page(in, 100000000);
  EXPECT_EQ(all.frames, 40u);
  EXPECT_EQ(all.levels, 65534);
  EXPECT_DOUBLE_EQ(all.position_step, 0.001);

  const ViewPage rounded = view_page(in, all.html.size() - 5000);
  EXPECT_EQ(rounded.frames, 40u);
  EXPECT_LT(rounded.levels, 65534);
  EXPECT_LE(rounded.html.size(), all.html.size() - 5000);

  const std::size_t rest = view_page(noisy(1), 100000000).html.size();
  const std::size_t third = rest + (all.html.size() - rest) / 3;
  const ViewPage fewer = view_page(in, third);
  EXPECT_EQ(fewer.frames, 10u);
  EXPECT_LE(fewer.html.size(), third);
  EXPECT_NE(fewer.html.find("\"time_ps\":[0.0,"), std::string::npos) << "the first frame stays";
  EXPECT_NE(fewer.html.find(",39.0]"), std::string::npos) << "and the last";
  EXPECT_EQ(view_page(in, 1).frames, 1u);
}

// A straight tube has no extent across.
TEST(ViewPage, AStraightTubeIsAsExactAsARope) {
  ViewInput in = noisy(1);
  for (Vector3& p : in.joints[0]) p.x() = p.y() = 0;
  EXPECT_DOUBLE_EQ(view_page(in, 100000000).position_step, 0.001);
}

TEST(ViewPage, NamesAreTextAndNothingElseIsAskedFor) {
  const std::string page = view_page(noisy(2), 100000000).html;
  EXPECT_EQ(page.find("a </script> rope"), std::string::npos);
  EXPECT_NE(page.find("<h1>a &lt;/script&gt; rope &amp; more</h1>"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'nonce-"),
            std::string::npos);
  EXPECT_EQ(page.find("{{"), page.find("{{", page.find(view_js))) << "every mark of view.html is filled";
}

// CMake puts the files of the tree into the program.
TEST(ViewFiles, AreTheFilesOfTheTree) {
  const auto tree = [](const std::string& name) {
    std::ifstream file(ROPEWALK_SOURCE_DIR "/mdem/report/view/" + name);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_FALSE(text.str().empty()) << name;
    return text.str();
  };
  EXPECT_EQ(view_body_html, tree("view.html"));
  EXPECT_EQ(view_css, tree("view.css"));
  std::string scripts;
  for (const char* name : {"frames.js", "scene.js", "camera.js", "page.js"}) {
    const std::string module = std::regex_replace("\n" + tree(name), std::regex("\nimport [^;]*;"), "");
    scripts += std::regex_replace(module, std::regex("\nexport "), "\n");
  }
  EXPECT_EQ(view_js, scripts);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
