// Scripts that run the points of a campaign on a cluster.
#pragma once

#include <string>
#include <vector>

#include "campaign/campaign.hpp"

namespace ropewalk {

struct ClusterScripts {
  std::string slurm, snakemake;  // files to write; empty: none

  bool any() const { return !slurm.empty() || !snakemake.empty(); }
};

// Writes one of them: for `verb` ("sweep" or "threshold") on the file, with further options. `jobs`: for the words
// that say how to run it. Returns the exit code. Throws InputError where the file is there, unless `force` is set.
int write_script(const ClusterScripts& scripts, const std::string& verb, const std::string& file,
                 const CampaignDirectory& dir, const std::vector<SweepPoint>& points, const std::string& options,
                 int jobs, bool force);

}  // namespace ropewalk
