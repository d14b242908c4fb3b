// A force term of one's own beside the installed library: [trap] draws each element to the z axis,
// U = k/2 (x^2 + y^2). How such a file is written: docs/how-to/force-term.md.
#include <fmt/format.h>

#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {
namespace {

class Trap : public ForceTerm {
 public:
  explicit Trap(double k) : k_(k) {}

  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<Trap>(*this); }
  std::string name() const override { return "trap"; }
  TermSum add(const State& state, const Segment& part, const ForceRows& out) const override {
    TermSum sum;
    for (int e = part.begin; e < part.end; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Vector3 away(state.position.x[i], state.position.y[i], 0);
      out.force.add(static_cast<std::size_t>(e - out.origin), -k_ * away);
      sum.energy += 0.5 * k_ * away.squaredNorm();
    }
    return sum;
  }
  double stiffness() const override { return k_; }

 private:
  double k_;  // eV/nm^2
};

class TrapDrive : public Drive {
 public:
  double k = 0;  // eV/nm^2

  static const KeyTable<TrapDrive>& keys();
  SceneTable table() const override { return keys().doc(); }
  std::string words() const override { return fmt::format("trap: {:.4g} nN/nm", k / units::nN_nm); }
  void refuse(const TomlTable& top, const Scene& scene) const override {
    if (scene.has_ends(Ends::endless))
      throw top.table("trap").error("", "does not go with [periodic]: it would count the images", "take a whole rope");
  }
  void add_terms(const Scene&, const Topology&, const State&, Interaction& interaction) const override {
    add_term(std::make_shared<Trap>(k), interaction);
  }
};

const KeyTable<TrapDrive>& TrapDrive::keys() {
  using Key = KeyOf<TrapDrive>;
  static const KeyTable<TrapDrive> table = {
      "trap",
      "draws each element to the z axis; without this table, nothing does",
      {Key::number("stiffness_nN_per_nm", {"nN/nm", units::nN_nm}, Bounds::positive(1e3), &TrapDrive::k,
                   required("0.01"), "force on each element per distance from the axis")
           .goes_as_length(1)},
      {}};
  return table;
}

DriveKind trap_drive() {
  return {[] { return TrapDrive::keys().doc(); },
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            return std::make_shared<TrapDrive>(TrapDrive::keys().read(t, scene));
          },
          "energy of the elements in the trap"};
}

const bool added = add_drive_kind(trap_drive());

}  // namespace
}  // namespace ropewalk
