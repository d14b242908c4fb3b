#include "commands/cluster_scripts.hpp"

#include <fmt/format.h>

#include "commands/siblings.hpp"
#include "io/files.hpp"

namespace ropewalk {

int write_script(const ClusterScripts& scripts, const std::string& verb, const std::string& file,
                 const CampaignDirectory& dir, const std::vector<SweepPoint>& points, const std::string& options,
                 int jobs, bool force) {
  const std::string program = this_program();
  const bool slurm = !scripts.slurm.empty();
  const std::string& path = slurm ? scripts.slurm : scripts.snakemake;
  refuse_existing(path, slurm ? "--slurm" : "--snakemake", force);
  write_file_atomically(path, slurm ? slurm_script(program, verb, file, dir, points.size(), options)
                                    : snakemake_file(program, verb, file, dir, points, options));
  fmt::print("{} written: {}\n", path,
             slurm ? "sbatch " + path : fmt::format("snakemake -s {} --cores {}", path, jobs));
  return 0;
}

}  // namespace ropewalk
