// `gather`: one table of the runs of a campaign.
#include <fmt/format.h>

#include "campaign/campaign.hpp"
#include "commands/commands.hpp"
#include "io/files.hpp"
#include "run/tell.hpp"

namespace ropewalk {

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

}  // namespace ropewalk
