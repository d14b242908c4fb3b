// [state] arbitrary elements from a CSV file: tube,x_nm,y_nm,z_nm,qw,qx,qy,qz.
#pragma once

#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class StateSource : public Source {
 public:
  // `memory`: where its memory lies; empty: beside it.
  explicit StateSource(std::string path = "", std::string memory = "")
      : path_(std::move(path)), memory_path_(std::move(memory)) {}

  void place(const Scene&, double spacing, Random&, Topology&, State&) const override;
  std::string file() const override { return path_; }
  StateMemory memory() const override { return read_state_memory(path_, memory_path_); }

 private:
  std::string path_, memory_path_;
};

}  // namespace ropewalk
