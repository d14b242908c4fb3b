#include "report/view/pack.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ropewalk {
namespace {

std::uint16_t zigzag(std::uint16_t difference) {
  return static_cast<std::uint16_t>(difference < 32768 ? 2 * difference : 2 * (65535 - difference) + 1);
}

}  // namespace

std::uint16_t CodeScale::code(double value) const {
  if (!std::isfinite(value)) return no_number_code;
  if (step == 0) return 0;
  return static_cast<std::uint16_t>(std::clamp(std::round((value - low) / step), 0.0, no_number_code - 1.0));
}

CodeScale code_scale(const std::vector<std::vector<double>>& frames, int levels) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& frame : frames)
    for (const double v : frame)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(low < high)) return {std::isfinite(low) ? low : 0, 0};
  return {low, (high - low) / levels};
}

void Packer::add(const std::vector<std::vector<double>>& frames, const std::vector<int>& begin,
                 const CodeScale& scale, int order) {
  std::string low, high;
  for (const std::vector<double>& frame : frames) {
    std::uint16_t first = 0;
    for (std::size_t t = 0; t + 1 < begin.size(); ++t) {
      std::uint16_t before = first, second = first;
      for (int k = begin[t]; k < begin[t + 1]; ++k) {
        const std::uint16_t code = scale.code(frame[static_cast<std::size_t>(k)]);
        const bool line = order == 2 && k - begin[t] >= 2;
        const auto guess = static_cast<std::uint16_t>(line ? 2 * before - second : before);
        const std::uint16_t stored = zigzag(static_cast<std::uint16_t>(code - guess));
        low += static_cast<char>(stored & 255);
        high += static_cast<char>(stored >> 8);
        if (k == begin[t]) first = code;
        second = before;
        before = code;
      }
    }
  }
  bytes_ += low + high;
}

std::string Packer::deflated() const {
  uLongf size = compressBound(static_cast<uLong>(bytes_.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                static_cast<uLong>(bytes_.size()), 6) != Z_OK)
    throw std::runtime_error("the frames could not be compressed: out of memory");
  out.resize(size);
  return out;
}

}  // namespace ropewalk
