// The table that `ropewalk modes` prints: each line describes one mode.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "observe/mode_shape.hpp"

namespace ropewalk {

struct ModeRow {
  std::complex<double> rate;  // 1/ns
  double residual = 0;        // 1/ns
  bool neutral = false;
  ModeShape shape;

  double frequency() const;  // GHz
};

std::vector<OutputColumn> mode_columns();
std::string modes_csv(const std::vector<ModeRow>& rows);

}  // namespace ropewalk
