// Numbers of many frames in few bytes, for the page in space, whose script frames.js unpacks them.
//
// A number is stored as a code of 16 bits: value = low + code * step; the code 65535 stands for no number. A
// channel is one quantity in all frames. Its codes are stored as differences, modulo 65536, from what the elements
// before in the same tube predict: order 1 predicts the code before, order 2 goes on in a straight line. (The first
// element of a tube is predicted by the first of the tube before, and that of the first tube by 0.) Differences are
// small and of either sign; they are stored as 2d or -2d - 1, so that the high byte is mostly 0. Of every channel
// come first all low bytes, then all high bytes. The bytes of all channels are deflated together (zlib's format).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ropewalk {

inline constexpr std::uint16_t no_number_code = 65535;

struct CodeScale {
  double low = 0, step = 0;  // no step: all numbers are the same

  std::uint16_t code(double value) const;
  double value(std::uint16_t code) const { return low + code * step; }
};

// `levels`: the largest code, at most 65534. Numbers that are not finite are left out.
CodeScale code_scale(const std::vector<std::vector<double>>& frames, int levels);

class Packer {
 public:
  // frames[f] has the numbers of a frame; tube t has those from begin[t] to begin[t + 1].
  void add(const std::vector<std::vector<double>>& frames, const std::vector<int>& begin, const CodeScale& scale,
           int order);
  std::string deflated() const;

 private:
  std::string bytes_;
};

}  // namespace ropewalk
