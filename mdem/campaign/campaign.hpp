// The directory of a campaign: one run in points/NAME for each point, shared starts in starts/NAME, what each run
// said in messages/NAME.txt, copies of the sweep and its scene, and table.csv.
#pragma once

#include <string>
#include <vector>

#include "campaign/sweep_file.hpp"
#include "io/manifest.hpp"
#include "run/expectations.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

struct CampaignDirectory {
  std::string path;

  std::string sweep() const { return path + "/sweep.toml"; }
  std::string scene() const { return path + "/scene.toml"; }
  std::string table() const { return path + "/table.csv"; }
  std::string trials() const { return path + "/trials.csv"; }
  // Throw InputError where it is a link.
  RunDirectory point(const std::string& name) const { return run_in("points", name); }
  RunDirectory start(const std::string& name) const { return run_in("starts", name); }
  std::string messages(const std::string& name) const { return path + "/messages/" + name + ".txt"; }
  RunDirectory run_in(const std::string& folder, const std::string& name) const;
};

// Beside the file of the sweep, where `out` is empty.
CampaignDirectory campaign_directory(const std::string& sweep_file, const std::string& out);

// Whether the directory holds a run of the scene `text` with the parameter sets and the state file of the point. If
// `any_step` is true, the run may have another time step than the scene.
bool is_run_of(const RunDirectory& dir, const std::string& text, const SweepPoint& point, bool any_step = false);

// How far the run of a point is.
struct PointProgress {
  enum class Stage { waiting, begun, ended, failed };
  Stage stage = Stage::waiting;
  std::string status;  // status in the manifest; "waiting" where there is none
  std::string reason;
  double wall_seconds = 0;
};
PointProgress progress_of(const RunDirectory& dir);

// What a finished run gave against the [[expect]] tables of its scene; empty: it has none, or has not finished.
std::vector<Judgement> judged(const RunDirectory& dir);

// Makes the directory with its copies, and holds it: alone with `force`, otherwise together with other processes.
// Throws InputError where it is not that of a campaign, or where another process holds it alone. Does so too where
// a point or a shared start in it was run with another scene, parameter set, state file or time of its shared
// start, unless `force` is set: these runs are then removed.
[[nodiscard]] DirectoryLock create_campaign(const CampaignDirectory& dir, const Sweep& sweep,
                                            const std::vector<SweepPoint>& points, bool force);

// The sweep as the directory has it, with names and values of its points.
Sweep read_campaign(const CampaignDirectory& dir);

// Chooses the rows of a log that the table shows.
struct GatherOptions {
  // Mean over the last rows of so much time, each with columns NAME_error and NAME_correlation_ps
  // (io/log_mean.hpp); 0: the last row.
  double mean_ps = 0;
  bool series = false;               // every row of every log instead
  std::vector<std::string> columns;  // log columns; empty: all, and result_columns()
  // Gets a sentence for each point whose means have no error; null: nobody asks.
  std::vector<std::string>* short_of = nullptr;
};
// One line per point: its name, the values of the keys that vary, how it ended and its first limit, the
// observables, what came of it, the limits passed. A point without rows has empty cells. Where the scene expects
// something, `expected` counts the [[expect]] tables, and `missed` those that do not hold. Everything in it follows
// from the scenes alone: no times of the machine.
std::string gathered_csv(const CampaignDirectory& dir, const Sweep& sweep, const std::vector<SweepPoint>& points,
                         const GatherOptions& options);

// For clusters: `program` runs each point, by its number from 1 or its name. `verb` is "sweep" or "threshold", with
// these further options.
std::string slurm_script(const std::string& program, const std::string& verb, const std::string& sweep_file,
                         const CampaignDirectory& dir, std::size_t points, const std::string& options);
std::string snakemake_file(const std::string& program, const std::string& verb, const std::string& sweep_file,
                           const CampaignDirectory& dir, const std::vector<SweepPoint>& points,
                           const std::string& options);

}  // namespace ropewalk
