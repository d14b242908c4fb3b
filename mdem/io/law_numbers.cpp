#include "io/law_numbers.hpp"

namespace ropewalk {

// One line for each shipped law, and one below.
LawNumbers paper_numbers();
LawNumbers line_numbers();

const std::vector<LawNumbers>& law_numbers() {
  static const std::vector<LawNumbers> all = {
      paper_numbers(),
      line_numbers(),
  };
  return all;
}

}  // namespace ropewalk
