// The largest stable time step of a rope: by law, element length and stiffness of the contact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"
#include "model/contact/paper.hpp"
#include "scene/lattice.hpp"
#include "scene/random.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk::validate::contact_stiffness {
namespace {

constexpr int tubes = 7, elements = 4;

struct Series {
  std::size_t set;  // of Case::sets
  bool paper;
  double length;                // of an element, over the set's
  std::vector<double> factors;  // factors of the contact's energy
  std::string name;
};

const std::vector<Series>& all_series() {
  static const std::vector<Series> series = {
      {0, false, 1, {1, 4, 16, 64, 256}, "line law"},
      {0, false, 2, {1, 4, 16, 64, 256}, "line law, elements twice as long"},
      {1, true, 1, {1, 4, 16, 64}, "paper law"},
  };
  return series;
}

// Straight tubes in contact; not at rest yet.
Bundle packed(const Series& s, ParameterSet set, double factor) {
  set = with_elements(set, s.length);
  scale_contact(set, factor);
  if (!s.paper) return line_bundle(set, tubes, elements);
  Bundle b;
  b.interaction.law = paper_law(*set.law<PaperContact>());
  b.spacing = pair_spacing(*set.law<PaperContact>(), set.element_length);
  b.place(set, elements, hexagonal_lattice(tubes, b.spacing));
  b.time_step = default_step_fraction * time_step_limit(b.topology, b.interaction, b.spacing).limit;
  return b;
}

// Starts from a little disorder. Strongly bound short tubes side by side are not in a minimum, and only a
// disturbance shows it.
Bundle bundle_at_rest(const Series& s, const ParameterSet& set, double factor) {
  Bundle b = packed(s, set, factor);
  Random random(7);
  for (std::size_t i = 0; i < b.state.size(); ++i)
    b.state.position.add(i, 0.01 * Vector3(random.normal(), random.normal(), random.normal()));
  bring_to_rest(b);
  return b;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  std::vector<ChartLine> lines;
  int colour = 0;
  double min_margin = 1e9;
  for (const Series& s : all_series()) {
    std::vector<double> at, limit, expected;
    for (const double factor : s.factors) {
      const Bundle oracle = bundle_at_rest(s, context.set(s.set), factor);
      Bundle model = packed(s, context.model(s.set), factor);
      model.state = oracle.state;
      const double theory = 2 / stiffest_frequency(oracle.topology, oracle.interaction, oracle.state);
      const double found = largest_step(model.topology, model.interaction, model.state, theory);
      at.push_back(factor);
      limit.push_back(found / units::fs);
      expected.push_back(theory / units::fs);
      const double estimate = time_step_limit(oracle.topology, oracle.interaction, oracle.spacing).limit;
      min_margin = std::min(min_margin, theory / estimate);
      result.check_relative(fmt::format("{}, contact x {:.0f}", s.name, factor), limit.back(), expected.back(),
                            0.05, "fs", "seven tubes of four elements at rest");
    }
    result.limits.push_back({fmt::format("time step, seven tubes, {}", s.name), limit.front(), expected.front(),
                             "fs", Limit::Guard::refused, "a time step above the estimate"});
    lines.push_back({"2/w, " + s.name, at, expected, colour});
    lines.push_back(model_points("by bisection", at, limit, colour));
    ++colour;
  }
  result.figures.push_back(
      step_figure("stiffness of the contact", {"energy of the contact over the set's", "", false, true},
                  "Seven tubes. Points: by bisection. Lines: by the eigenvalues. Where a line begins to fall, the "
                  "contact becomes stiffer than the chains.",
                  lines));
  // The estimate of `run` must never lie above the stable step.
  result.check_absolute("estimates of `run` above the limit", min_margin < 1 ? 1 : 0, 0, 0, "", "0: none of these");
  result.show_absolute("smallest limit over estimate", min_margin, 1, 0, "",
                       "`auto` takes 0.9 of the estimate in cold scenes, 0.6 in others");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-contact-stiffness";
  c.order = 50;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.only_these = "it compares the contact laws of two shipped sets";
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::contact_stiffness
