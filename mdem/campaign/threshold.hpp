// The critical value of a key: where a rope begins to pass a value of an observable, or to take a shape, within the
// time of its scene; beside it what theory says of the helix (plan/sliding_rope.hpp).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "io/outputs.hpp"
#include "plan/sliding_rope.hpp"

namespace ropewalk {

// One run at one value of the key.
struct Trial {
  double value = 0;
  bool passed = false;
  double time = 0;                    // when it passed or was cut short, ps
  bool cut_short = false;             // it did not pass, and a [[stop]] of the scene ended it before its time
  std::optional<double> rate, error;  // rate of the exponential growth on the way, 1/ps; none: it cannot be told
  std::optional<double> turn;         // turn of the ends of the rope about its axis, rad, mean under the whole load
  std::string shape;                  // shape of the rope then (observe/rope_shape.hpp); empty: not known
  std::string scene_hash;             // hash of its scene, parameter sets and state file
  std::string first_limit = {};       // key of the limit that was passed first; empty: none was, or it is not known
  std::optional<double> first_limit_time = {};  // ps
};

// The threshold of a point, by its runs; values rise.
struct Threshold {
  std::vector<Trial> trials;
  double below = 0, above = 0;  // the bracket of the bisection: the lowest values between which the outcome changes
  bool outside = false;         // passed at all values that were tried, or at none
  bool falling = false;         // passed below the threshold and not above it
  int changes = 0;              // changes of the outcome from value to value; more than one: no single threshold
  double middle() const { return 0.5 * (below + above); }
};
// Brackets the threshold of these trials, in any order, in a search from `from` to `to`.
Threshold bracketed(std::vector<Trial> trials, double from, double to);

// The exponent p of y = C x^p, by least squares of the logarithms. `error` is its standard error, NaN with two
// points.
struct PowerLaw {
  double exponent = 0, error = 0;
};
std::optional<PowerLaw> power_law(const std::vector<double>& x, const std::vector<double>& y);

// Reads the answer from the log of a run. `wave`: nm, that the scene began with; `constant_from`: ps, when the load
// is whole. `by_a_rule`: a [[stop]] rule ended the run.
Trial trial_of(const std::vector<LogRow>& log, const ThresholdQuestion& question, double value, double wave,
               double constant_from, bool by_a_rule);

// The scene of a trial: the point's, with the value, and ended where the question is decided.
std::string trial_text(const Sweep& sweep, const SweepPoint& point, double value);
RunDirectory trial_directory(const CampaignDirectory& dir, const Sweep& sweep, const SweepPoint& point,
                             double value);
std::string trial_hash(const Sweep& sweep, const SweepPoint& point, double value);
// The same for many values of one point: its scene is written and its files are read once.
class TrialHashes {
 public:
  TrialHashes(const Sweep& sweep, const SweepPoint& point);
  std::string of(double value) const;

 private:
  const Sweep& sweep_;
  const SweepPoint& point_;
  std::string head_, tail_;  // text before and after the value, with the files behind
  bool plain_;               // the value stands in one place
};
// Trials of earlier searches by the name of their point.
using KnownTrials = std::map<std::string, std::vector<Trial>>;
// Trials from the runs of this point in the directory, and from its known trials.
Threshold threshold_of(const CampaignDirectory& dir, const Sweep& sweep, const SweepPoint& point,
                       const KnownTrials& known);

// Points that differ in their seed alone.
struct PhasePoint {
  std::string name;
  std::vector<std::string> values;  // values of the keys, without the seed
  std::vector<Threshold> seeds;
  int tubes = 0;
  double length = 0, radius = 0;      // length and radius of the rope, nm; zero where it is none
  std::optional<HelixTheory> theory;  // where the key is the moment at both ends
  double passing = 0;                 // the amplitude that is asked for, nm; zero: it is another observable

  bool begun() const;  // has a run that ended
  double by_bisection() const, bisection_error() const;
  // The number of seeds whose outcome falls with the key, whose outcome changes more than once, and whose outcome
  // is the same at all values of the key that were tried. A seed of the third kind has no threshold, and then there
  // is no mean: by_bisection() is nan.
  std::size_t falling_seeds() const, unclear_seeds() const, outside_seeds() const;
  std::size_t cut_short_runs() const;  // Trial::cut_short
  // Remarks on the bisection: such seeds and runs. Empty: none.
  std::string remarks() const;
  // Theory, all in the unit of the key; nan: none. The static moment, below which no helix grows; the moment that
  // passes within the time of the scene, of a rope with the winding of its runs, or with 1 as long as there is
  // none; and the static moment of a rope whose tubes are glued.
  double static_theory() const, kinetic_theory() const, glued_theory() const;
  // Turns of the helix that grows under kinetic_theory(); nan: none.
  double theory_windings() const;
  // The median over the runs of f of plan/sliding_rope.hpp; nan: no run says.
  double winding() const;
  // The median of rates over those of theory at the same moment and winding, and the number of runs that have one.
  double rate_over_theory() const;
  std::size_t rates() const;

 private:
  std::vector<double> rate_ratios() const;
  double winding_or_free() const;          // 1 as long as no run says
  mutable std::optional<double> kinetic_;  // which takes some tenths of a second
};
std::vector<PhasePoint> phase_points(const CampaignDirectory& dir, const Sweep& sweep,
                                     const std::vector<SweepPoint>& points, const KnownTrials& known);

// The theory of a point, without its runs.
PhasePoint point_in_theory(const Sweep& sweep, const SweepPoint& point);

// Columns of trials.csv behind those of the keys that vary.
std::vector<OutputColumn> trial_columns();
// The cells of one row before those: of each key that varies, but the seed. `of_keys`: a text for each key of the
// sweep.
std::string key_cells(const Sweep& sweep, const std::vector<std::string>& of_keys);

// A table of trials, read by the names of its columns: earlier versions had fewer of them.
struct TrialTable {
  std::string keys;  // key_cells() of its header
  std::vector<Trial> trials;
  std::vector<std::string> values;  // key_cells() of each trial
};
TrialTable read_trials(const std::string& path);

std::string thresholds_csv(const Sweep& sweep, const std::vector<PhasePoint>& points);
std::string trials_csv(const Sweep& sweep, const std::vector<PhasePoint>& points);
// The last state of a run beside a threshold, as SVG.
struct StatePicture {
  std::string words, svg;
};
std::string phase_page(const Sweep& sweep, const std::vector<PhasePoint>& points,
                       const std::vector<StatePicture>& states);

}  // namespace ropewalk
