// A rope turned without tension.
#include "cases/common/rope_torsion.hpp"

namespace ropewalk::validate::rope_torsion_free {
namespace {

const RegisteredCase registered([] {
  Case c = rope_torsion_case();
  c.name = "rope-torsion-free";
  c.order = 150;
  c.title = "Torque and contraction of a rope turned without tension";
  c.why = "The other boundary of an experiment: one clamp moves along the rope, and the rope contracts.";
  c.setup =
      "7, 19, 37 and 91 tubes of {tube} (of other sets 7 and 37), wound evenly between two rigid clamps, one of "
      "which moves freely along the "
      "rope, and brought to rest. The outermost tubes lean by 0.5, 5, 10 and 15 degrees.";
  c.run = [](const CaseContext& context) { return run_rope_torsion(context, RopeInMachine::Length::free); };
  c.turns_red = {{wrong_stiffnesses(1.1),
                  {"torque per tube, 7 tubes of (10,10), 0.5°", "torque per tube, 37 tubes of (10,10), 10°"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_torsion_free
