// `gather`: one table of the runs of a campaign.
#include <fmt/format.h>

#include "campaign/campaign.hpp"
#include "commands/verb.hpp"
#include "io/files.hpp"
#include "run/tell.hpp"

namespace ropewalk {
namespace {

struct GatherArguments {
  std::string dir;
  std::string out;  // empty: to the terminal
  double mean_ps = 0;
  bool series = false;
  std::vector<std::string> columns;
  bool force = false;
};

int gather_command(const GatherArguments& a) {
  if (!a.out.empty()) refuse_existing(a.out, "-o", a.force);
  const CampaignDirectory dir{a.dir};
  const Sweep sweep = read_campaign(dir);
  GatherOptions options;
  options.mean_ps = a.mean_ps;
  options.series = a.series;
  options.columns = a.columns;
  std::vector<std::string> short_of;
  options.short_of = &short_of;
  const std::string table = gathered_csv(dir, sweep, points_of(sweep, PointsAs::names), options);
  for (const std::string& words : short_of) tell(words);
  if (a.out.empty()) {
    fmt::print("{}", table);
    return 0;
  }
  write_file_atomically(a.out, table);
  fmt::print("{} written\n", a.out);
  return 0;
}

}  // namespace

void add_gather(CLI::App& app, Program& program) {
  const auto a = std::make_shared<GatherArguments>();
  CLI::App* c = app.add_subcommand("gather", "One table (CSV) of all points of a campaign, at their ends");
  c->add_option("dir", a->dir, "Directory of the campaign")->required();
  c->add_option("-o", a->out, "File to write [default: the terminal]");
  c->add_option("--columns", a->columns, "Columns of log.csv [default: all]")->delimiter(',');
  c->add_option("--mean", a->mean_ps, "Means over the last rows of so much time, ps [default: the last row]")
      ->check(number_within(Bounds::positive()));
  c->add_flag("--series", a->series, "All rows of all logs instead of the ends");
  c->add_flag("--force", a->force, "Replace the file");
  c->callback([a, &program] { program.code = gather_command(*a); });
}

}  // namespace ropewalk
