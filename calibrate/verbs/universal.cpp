// `ropewalk calibrate universal`: one line law for all tubes.
#include <fmt/format.h>

#include <filesystem>

#include "io/files.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::calibrate {
namespace {

struct UniversalArguments {
  std::string lj = law_of_carbon;
  double lj_cutoff = 1.2;
  std::string out;  // empty: the shipped file
  bool force = false;
  std::string command;
};

// Pairs of equal and unequal radii over the range of the law.
std::vector<std::pair<double, double>> radii_to_fit() {
  const std::vector<double> radii = {0.3, 0.35, 0.42, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4};
  std::vector<std::pair<double, double>> pairs;
  for (const double r : radii) pairs.emplace_back(r, r);
  for (std::size_t i = 0; i < radii.size(); i += 3)
    for (std::size_t j = i + 3; j < radii.size(); j += 3) pairs.emplace_back(radii[i], radii[j]);
  return pairs;
}

int universal_command(const UniversalArguments& a) {
  const AtomLaw law = parse_atom_law(a.lj, a.lj_cutoff);
  const std::string out = a.out.empty() ? universal_path() : a.out;
  check_output(out, "--out", a.force);
  fmt::print(stderr, "fitting one law to {} pairs of radii\n", radii_to_fit().size());
  const UniversalFit fit = fit_universal(law, radii_to_fit());
  fmt::print("{:>8} {:>8}  {:>12} {:>12} {:>12} {:>12}\n", "r_i nm", "r_j nm", "own fit", "universal", "spacing",
             "depth");
  for (const UniversalFit::PairCheck& p : fit.pairs)
    fmt::print("{:8.3f} {:8.3f}  {:12.2e} {:12.2e} {:+12.2e} {:+12.2e}\n", p.r_i, p.r_j, p.direct_error, p.error,
               p.spacing_error, p.depth_error);
  write_file_atomically(out, universal_file(fit, a.command));
  fmt::print("largest error {:.2e} of the well; written to {}\n", fit.error, out);
  return 0;
}

}  // namespace

void add_universal(CLI::App& app, Program& program) {
  const auto a = std::make_shared<UniversalArguments>();
  a->command = program.command;
  CLI::App* c = app.add_subcommand("universal", "Fit one contact law for all radii (minutes)");
  add_law(*c, a->lj, a->lj_cutoff);
  c->add_option("--out", a->out, "File [default: the shipped one]");
  c->add_flag("--force", a->force, "Replace an existing file");
  c->callback([a, &program] { program.code = universal_command(*a); });
}

}  // namespace ropewalk::calibrate
