// [state] arbitrary elements from a CSV file: tube,x_nm,y_nm,z_nm,qw,qx,qy,qz.
#pragma once

#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class StateSource : public Source {
 public:
  explicit StateSource(std::string path = "") : path_(std::move(path)) {}

  void place(const Scene&, double spacing, Random&, Topology&, State&) const override;
  std::string file() const override { return path_; }
  std::string not_for_lammps() const override;

 private:
  std::string path_;
};

}  // namespace ropewalk
