#include "sim/forces/force_term.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "model/contract.hpp"
#include "sim/forces/shipped_terms.hpp"

namespace ropewalk {

namespace {

std::vector<TermKind> (*shipped_terms)() = nullptr;  // there before any static variable is made

std::vector<TermKind>& all_kinds_of_terms() {
  static std::vector<TermKind> kinds;
  return kinds;
}

}  // namespace

TermState ForceTerm::halved(const TermState& coarse, const std::vector<int>& heirs) const {
  TermState fine = coarse;
  for (TermRecord& record : fine) record.element = heirs[static_cast<std::size_t>(record.element)];
  return fine;
}

bool set_shipped_terms(std::vector<TermKind> (*terms)()) {
  shipped_terms = terms;
  return true;
}

const std::vector<TermKind>& term_kinds() {
  // Those that add_term_kind() added stand behind the shipped ones, whichever came first.
  [[maybe_unused]] static const bool once = [] {
    std::vector<TermKind>& all = all_kinds_of_terms();
    std::vector<TermKind> first = shipped_terms ? shipped_terms() : std::vector<TermKind>();
    all.insert(all.begin(), std::make_move_iterator(first.begin()), std::make_move_iterator(first.end()));
    return true;
  }();
  return all_kinds_of_terms();
}

bool add_term_kind(TermKind kind) {
  all_kinds_of_terms().push_back(std::move(kind));
  return true;
}

void add_term(std::shared_ptr<const ForceTerm> term, Interaction& interaction) {
  interaction.term_reach = std::max(interaction.term_reach, term->pair_reach());
  interaction.term_copies = std::max(interaction.term_copies, term->copy_reach());
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
