// A load of one's own beside the installed library: [[load]] kind = "wind", a force along x that grows with the
// height z. How such a file is written: docs/how-to/load.md.
#include "scene/loads/load_kind.hpp"

namespace ropewalk {
namespace {

class Wind : public Load {
 public:
  double growth = 0;  // eV/nm^2: force on each element per height

  std::shared_ptr<Load> copy() const override { return std::make_shared<Wind>(*this); }
  void add_forces(const State& state, double, std::vector<PointLoad>& out) const override {
    for (const int e : elements)
      out.push_back(
          {e, growth * state.position.z[static_cast<std::size_t>(e)] * Vector3::UnitX(), Vector3::Zero()});
  }
};

LoadKind wind_kind() {
  using Key = KeyOf<Wind>;
  return load_kind<Wind>({"wind",
                          "",
                          {Key::number("growth_nN_per_nm", {"nN/nm", units::nN_nm}, Bounds::positive(10),
                                       &Wind::growth, required("1e-5"), "force along x on each element per height")
                               .goes_as_length(1)},
                          {}});
}

const bool added = add_load_kind(wind_kind());

}  // namespace
}  // namespace ropewalk
