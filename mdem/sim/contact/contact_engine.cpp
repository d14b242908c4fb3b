#include "sim/contact/contact_engine.hpp"

#include "sim/contact/line/engine.hpp"
#include "sim/contact/pair_engine.hpp"
#include "sim/contact/paper/engine.hpp"

namespace ropewalk {

std::unique_ptr<ContactEngine> make_contact_engine(const ContactLaw& law) {
  if (dynamic_cast<const LineLaw*>(&law)) return std::make_unique<LineEngine>();
  if (dynamic_cast<const PaperLaw*>(&law)) return std::make_unique<PaperEngine>();
  return std::make_unique<PairEngine>();
}

PairEnergy ContactEngine::pair_energy(const ContactLaw& law) const {
  return [&law](TypePair types, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) {
    return law.energy(types, separation, n_i, n_j);
  };
}

}  // namespace ropewalk
