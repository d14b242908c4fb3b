#include "io/law_numbers.hpp"

#include <utility>

#include "model/contract.hpp"

namespace ropewalk {

// One line for each shipped law, and one below.
LawNumbers paper_numbers();
LawNumbers line_numbers();

namespace {

std::vector<LawNumbers>& all_law_numbers() {
  static std::vector<LawNumbers> all = {
      paper_numbers(),
      line_numbers(),
  };
  return all;
}

}  // namespace

const std::vector<LawNumbers>& law_numbers() { return all_law_numbers(); }

bool add_law_numbers(LawNumbers law) {
  for ([[maybe_unused]] const LawNumbers& known : all_law_numbers()) ROPEWALK_EXPECTS(known.name != law.name);
  all_law_numbers().push_back(std::move(law));
  return true;
}

}  // namespace ropewalk
