// Sliding of one row of elements along another: three contact laws.
#include <cmath>

#include "cases/common/bead_law.hpp"
#include "cases/common/bundle.hpp"
#include "cases/common/slide.hpp"
#include "model/contact/paper.hpp"
#include "scene/build.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk::validate::isotropic_contact {
namespace {

Slide slide(const ContactLaw& law, double element_length, double distance) {
  return slide_first(law, element_length, {{0, 0}, {distance, 0}});
}

// Appends what the published law makes of the same rows, for comparison.
void add_published(const ParameterSet& paper, double compression, std::vector<ChartLine>& lines,
                   CaseResult& result) {
  const double length = paper.element_length, spacing = pair_spacing(*paper.law<PaperContact>(), length);
  const double well = std::fabs(paper_parallel_energy(*paper.law<PaperContact>(), length, spacing));
  const PaperLaw law(*paper.law<PaperContact>());
  const Slide at_rest = slide(law, length, spacing);
  result.show_absolute("corrugation of the paper law over its well", at_rest.corrugation() / well, 0, 1e-3, "1",
                       "smooth where it was fitted");
  result.show_absolute("the same, 0.05 nm inside of the well",
                       slide(law, length, spacing - compression).corrugation() / well, 0, 4e-3, "1");
  lines.push_back(model_points("paper law", at_rest.shift, at_rest.relative(-well), 2));
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model();
  const Well pair = surface_integral(context.set()).parallel_well();
  const LineLaw line({line_contact_of(model)});
  const double a = model.element_length, compression = 0.05;
  const BeadLaw bead(pair.distance, pair.energy, a);
  const Slide by_line = slide(line, a, pair.distance), by_bead = slide(bead, a, pair.distance);
  const double depth = std::fabs(pair.energy);

  CaseResult result;
  std::vector<ChartLine> lines = {theory_curve("smooth tubes", 0, 1, [](double) { return 0.0; }),
                                  model_points("isotropic bead", by_bead.shift, by_bead.relative(pair.energy))};
  result.check_absolute("corrugation of the line law over the well", by_line.corrugation() / depth, 0, 1e-3, "1",
                        "registry of real tubes is 1e-2");
  result.check_absolute("the same, 0.05 nm inside of the well",
                        slide(line, a, pair.distance - compression).corrugation() / depth, 0, 6e-3, "1",
                        "most for (7,2): 5.5e-3");
  result.check_relative("mean energy of the line law", by_line.mean(), pair.energy, 3e-3, "eV/nm",
                        "contact fitted to the surface integral");
  if (context.sets.size() > 1) add_published(context.model(1), compression, lines, result);
  result.show_absolute("corrugation of the isotropic bead law over the well", by_bead.corrugation() / depth, 0,
                       1e-3, "1", "beads fall into the gaps of the other row");
  result.show_absolute("the same, 0.05 nm inside of the well",
                       slide(bead, a, pair.distance - compression).corrugation() / depth, 0, 4e-3, "1");
  result.show_absolute("sliding barrier of one element of the bead law", by_bead.corrugation() * a, 0,
                       units::boltzmann * 300, "eV", "against the thermal energy at 300 K");
  lines.push_back(model_points("line law", by_line.shift, by_line.relative(pair.energy), 3));
  result.figure("Energy of two parallel rows that slide along each other", {"shift", "elements"},
                {"energy from its mean, of the well", "%"},
                "A tube is smooth along its axis. Any corrugation is an error of the law's discretisation.", lines);
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "isotropic-contact";
  c.order = 10;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::isotropic_contact
