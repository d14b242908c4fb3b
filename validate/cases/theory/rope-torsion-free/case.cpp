// A rope turned without tension.
#include "cases/common/rope_torsion.hpp"

namespace ropewalk::validate::rope_torsion_free {
namespace {

const RegisteredCase registered([] {
  Case c = rope_torsion_case();
  c.name = "rope-torsion-free";
  c.order = 150;
  c.run = [](const CaseContext& context) { return run_rope_torsion(context, RopeInMachine::Length::free); };
  c.turns_red = {{wrong_stiffnesses(1.1),
                  {"torque per tube, 7 tubes of (10,10), 0.5°", "torque per tube, 37 tubes of (10,10), 10°"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_torsion_free
