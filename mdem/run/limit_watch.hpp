// The watch over the limits of a run (observe/limits.hpp): checks them at every logged time and in between, reports
// in one line when a limit is passed for the first time, and keeps the records for limits.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "io/limits_file.hpp"
#include "observe/limits.hpp"

namespace ropewalk {

enum class OnLimit { warn, stop, refine };

// Reads the word of the command line. Throws InputError.
OnLimit on_limit_of(const std::string& word);

// Energies that limits of the whole run are judged by. NaN: not known, or not to be judged.
struct RunEnergies {
  double drift = std::numeric_limits<double>::quiet_NaN();    // energy_drift() of the account
  double kinetic = std::numeric_limits<double>::quiet_NaN();  // eV
};

class LimitWatch {
 public:
  // `may_refine`: whether messages name --on-limit refine.
  explicit LimitWatch(Watched watched, bool may_refine = false)
      : watched_(std::move(watched)), may_refine_(may_refine) {}

  // Takes over the limits of a run that goes on, from its own file or from that of the run before its elements were
  // split, without those passed after `step`.
  void inherit_from(const std::vector<LimitRecord>& earlier, std::int64_t step);

  // One line for each limit that is passed for the first time. Computing the pressure costs as much as several
  // steps. `topology`: the tubes of the scene; `now`: the same, cut where they have broken (Simulation::tubes_now).
  std::vector<std::string> check(const Topology& topology, const Topology& now, const State& state,
                                 const NeighbourList& list, const RunEnergies& energies, bool with_pressure);
  std::vector<std::string> check(const Topology& topology, const State& state, const NeighbourList& list,
                                 const RunEnergies& energies, bool with_pressure) {
    return check(topology, topology, state, list, energies, with_pressure);
  }

  // Whether at the last check a limit was passed that shorter elements would cure.
  bool finer_would_help() const { return finer_would_help_; }
  const std::vector<LimitRecord>& records() const { return records_; }
  const std::vector<Held>& held() const { return watched_.held; }

 private:
  Watched watched_;
  bool may_refine_ = false;
  std::vector<LimitRecord> records_;
  bool finer_would_help_ = false;
};

// One line that names every limit passed and its largest value, as "bend_deg up to 21.4 deg (limit 19.9)". The line
// is empty if no limit was passed.
std::string passed_words(const std::vector<LimitRecord>& records);

}  // namespace ropewalk
