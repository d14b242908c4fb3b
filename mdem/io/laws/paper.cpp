// The numbers of the contact law `paper`:
//
//   [contact.paper]   present: the set has the `paper` law; epsilon (eV), A, B, alpha, beta, C1 .. C5,
//               C_gamma, delta, freeze, switch_start, cutoff (all in units of the radius), core_gap
#include "model/contact/paper.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/law_numbers.hpp"
#include "model/units.hpp"

namespace ropewalk {
namespace {

void check_paper(const TomlTable& t, const PaperContact& k) {
  if (k.alpha <= k.beta)
    throw t.error("alpha", fmt::format("is {}, not above beta = {}", k.alpha, k.beta),
                  "repulsion must be the steeper of the two");
  if (k.cutoff_ratio <= k.switch_start)
    throw t.error("cutoff", fmt::format("is {} r, not above switch_start = {} r", k.cutoff_ratio, k.switch_start),
                  "the switch needs room to fall to zero");
  // The minimum of V, at D^(alpha - beta) = alpha A / (beta B), must lie between the core and the switch.
  const double lowest = std::pow(k.alpha * k.repulsion / (k.beta * k.attraction), 1 / (k.alpha - k.beta));
  if (lowest + 2 >= k.switch_start)
    throw t.error("A", fmt::format("makes the contact strongest at {:.4g} r", lowest + 2),
                  fmt::format("that must be inside of switch_start = {} r", k.switch_start));
  if (k.core_gap >= lowest)
    throw t.error("core_gap", fmt::format("is {}", k.core_gap),
                  fmt::format("must be below {:.4g}, where the contact is strongest", lowest));
  for (int degree = 0; degree <= 90; ++degree) {
    const double theta = degree * units::degree;
    double stretch = 1;
    for (int i = 1; i <= 5; ++i)
      stretch += k.angular[static_cast<std::size_t>(i - 1)] * ((i % 2 ? 1 : -1) + std::cos(2 * i * theta));
    if (stretch < 0.05)
      throw t.error("C1", fmt::format("makes Theta({} deg) = {:.3g}", degree, stretch),
                    "C1 .. C5 must keep Theta positive at every angle");
  }
}

PaperContact read_paper(const LawTable& law) {
  PaperContact k;
  k.radius = law.set.radius;
  k.epsilon = law.number("epsilon", "eV", Bounds::positive(100));
  k.repulsion = law.number("A", "1", Bounds::positive(1e6));
  k.attraction = law.number("B", "1", Bounds::positive(1e6));
  k.alpha = law.number("alpha", "1", Bounds::range(1, 100));
  k.beta = law.number("beta", "1", Bounds::range(1, 100));
  for (std::size_t i = 0; i < k.angular.size(); ++i)
    k.angular[i] = law.number(fmt::format("C{}", i + 1), "1", Bounds::range(-1, 1));
  k.crossing = law.number("C_gamma", "1", Bounds::non_negative(1e6));
  k.delta = law.number("delta", "1", Bounds::range(-100, 0));
  k.freeze = law.number("freeze", "r", Bounds::range(0.1, 100));
  k.switch_start = law.number("switch_start", "r", Bounds::range(2, 100));
  k.cutoff_ratio = law.number("cutoff", "r", Bounds::range(2, 100));
  k.core_gap = law.number("core_gap", "1", Bounds::range(0.01, 10));
  check_paper(law.table, k);
  return k;
}

}  // namespace

LawNumbers paper_numbers() { return {PaperContact::law, read_paper}; }

}  // namespace ropewalk
