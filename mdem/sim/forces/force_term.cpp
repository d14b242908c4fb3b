#include "sim/forces/force_term.hpp"

#include <algorithm>
#include <utility>

#include "model/contract.hpp"

namespace ropewalk {

// Those of the shipped drives (scene/drive_kind.cpp). They are called for by name: the linker would leave a
// file that registers itself out of each program that needs nothing else from it, and the log would lose its
// columns there.
std::vector<TermKind> shipped_term_kinds();

namespace {

std::vector<TermKind>& all_kinds_of_terms() {
  static std::vector<TermKind> kinds = shipped_term_kinds();
  return kinds;
}

}  // namespace

TermState ForceTerm::halved(const TermState& coarse, const std::vector<int>& heirs) const {
  TermState fine = coarse;
  for (TermRecord& record : fine) record.element = heirs[static_cast<std::size_t>(record.element)];
  return fine;
}

const std::vector<TermKind>& term_kinds() { return all_kinds_of_terms(); }

bool add_term_kind(TermKind kind) {
  all_kinds_of_terms().push_back(std::move(kind));
  return true;
}

void add_term(std::shared_ptr<const ForceTerm> term, Interaction& interaction) {
  interaction.term_reach = std::max(interaction.term_reach, term->pair_reach());
  interaction.terms.push_back(std::move(term));
}

std::map<std::string, TermReading> term_readings(const Interaction& interaction,
                                                 const std::vector<double>& energies,
                                                 const std::vector<TermAccount>& accounts) {
  ROPEWALK_EXPECTS(energies.size() == interaction.terms.size() && accounts.size() == energies.size());
  std::map<std::string, TermReading> all;
  for (std::size_t k = 0; k < energies.size(); ++k) {
    TermReading& reading = all[interaction.terms[k]->name()];
    reading.energy += energies[k];
    reading.account.add(accounts[k]);
  }
  return all;
}

void for_all_pairs(const Topology& topology, const Interaction& in, const std::function<void(int, int)>& work) {
  for (int i = 0; i < topology.elements(); ++i) {
    const int tube = topology.tube_of(i), excluded = topology.type_of(tube).elements_within(in.excluded_arc());
    for (int j = topology.last_within(excluded, i, tube) + 1; j < topology.elements(); ++j) work(i, j);
  }
}

}  // namespace ropewalk
