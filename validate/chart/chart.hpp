// The chart of speed against accuracy: cost and error of many models (models.toml), most of which differ from the
// default in one setting, in a few scenes (scenes.toml, scenes/NAME.toml).
//
// Scenes. Every model has the same physical specimen: the deforming part reaches from the centre of one held
// element to the centre of another, its length does not depend on the element length, and the loads act at those
// centres. Half an element extends beyond each end and is rigid. Long elements have a longer overhang, which
// changes the mass at the ends and a contact that hardly depends on the twist. Energies are above that of the
// untwisted state. Damping constants belong to a pair of elements or to a bond; they scale with the element length,
// so that the dissipation per length of tube is the same.
//
// Most scenes are displacement-controlled: the grips turn at a constant rate and are then held. The motion starts
// with the velocities of a uniform turn, so that no wave starts from the grips. When the grips stop, the kinetic
// energy of the turn becomes vibration, which is damped during the hold; ramps are so long that it is small.
// Observables are means over the second half of the hold. Two scenes are load-controlled, where an error of the
// stiffness shows in the angle and not in the moment: a couple on each grip element is ramped from rest at a
// constant rate, as [twist] does. Their ends are free, and only damping removes the slowest torsional vibration;
// half of the hold is one period of it. The film is laid down and left to itself.
//
// Cost: CPU time of this process in its steps, one thread, per simulated ns. A relaxation simulates no time; its
// CPU time counts for the ramp and hold that it replaces.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chart/point.hpp"
#include "io/outputs.hpp"
#include "observe/observe.hpp"
#include "scene/scene.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk::validate {

// --- Models ---

struct ChartModel {
  std::string name, kind;                          // kind: the setting that is varied
  std::string words;                               // what a reader is told instead of the name
  bool needs_contact = false, only_10_10 = false;  // scenes that it is for
  std::string set;                                 // parameter set; empty: the scene's
  std::string law = "line";
  int nodes = 0;  // per element; 0: as line_nodes chooses
  Interaction::Precision precision = Interaction::Precision::mixed;
  double cutoff = 0;         // nm; 0: the set's
  double length = 1;         // element length over that of the default; rounded down to whole bonds
  double time_step = 0;      // time step of the bonds, ps; 0: by the fraction
  double step_fraction = 0;  // fraction of the stability limit; 0: the default of a scene
  Stepping stepping;
  double mass_scale = 1;
  RunOptions::Mode mode = RunOptions::Mode::dynamics;
  bool at_once = false;           // relaxed once after the whole turn, not after each increment
  double contact_viscosity = 20;  // contact viscosity of a pair at the default element length, eV ps/nm^2
  double bond_damping = 1;        // 1/ps, likewise
  bool hooke = false;             // bonds; else as soft as the set's
};

inline constexpr const char* published_model = "published";
inline constexpr const char* default_model = "default";
inline constexpr const char* finest_model = "finest";

// --- Scenes ---

// How the points of a scene are measured, from scenes.toml.
struct ChartProtocol {
  double hold = 0;            // time at the end of the run, ps
  int increments = 1;         // increments of a relaxation
  bool about_itself = false;  // each element turns about its own axis and stays in place, otherwise about z
  // Before a relaxation all elements turn evenly. Otherwise only the grips turn, where the even turn is the
  // solution.
  bool interior_follows = true;
  bool moment_resists = true;  // sign of the end moment: positive against the turn, otherwise with it
  bool above_start = true;     // the energy is that above the untwisted state
  bool starts_at_rest = true;  // relaxed before it moves
};

// A scene as one model sees it.
struct Specimen : ChartProtocol {
  Scene scene;  // settings and parameter set, for interaction and time step
  Topology topology;
  Interaction interaction;
  State state;                 // before it is turned
  LoadsAndConstraints acting;  // of the ramp and the hold
  double time_step = 0;        // time step of the bonds, ps
  double spacing = 0;          // nm; 0: one tube
  double element = 0;          // element length of the default model, nm

  std::vector<double> twist_share;  // angle of each element, in parts of the whole angle
  std::vector<int> grips;           // elements that are held and turned
  double angle = 0;                 // rad, the whole turn
  double moment = 0;    // eV on each grip element instead of an angle, with opposite signs at the two ends
  double ramp = 0;      // ps
  bool is_rope = true;  // parallel tubes, if there are more than two

  double duration() const { return ramp + hold; }
  LoadsAndConstraints held() const;  // before the ramp; free in load control
  const LoadsAndConstraints& loads() const { return acting; }
};

struct ChartReference {
  std::string observable;
  double value = 0;
};

struct ChartScene : ChartProtocol {
  std::string name, title, setup;
  std::vector<std::string> observables;
  Scene scene;          // as in its file
  double element = 0;   // element length of the default model, nm
  double band = 0;      // length of a grip beyond its innermost centres, nm
  bool relaxes = true;  // a relaxation ends in the state of the dynamics
  // What its file says: more than one tube; (10,10) tubes, the only ones of the published model; bonds as soft as the
  // set's.
  bool contact = true, published = true, soft_bonds = true;

  Specimen build(const ChartModel& model) const;
  std::vector<ChartReference> atoms() const;  // may be empty
};

// The settings of the model, all but the element length and the time step.
void apply(const ChartModel& model, Scene& scene);

const std::vector<ChartScene>& chart_scenes();
const ChartScene& find_chart_scene(const std::string& name);
// The models that apply to the scene; `quick`: a few of them.
std::vector<ChartModel> chart_models(const ChartScene& scene, bool quick);
const ChartModel& find_chart_model(const std::vector<ChartModel>& models, const std::string& name);

// "twist angle beta" for "beta", ...
std::string observable_title(const std::string& observable);
// "eV" for "energy", ...
std::string observable_unit(const std::string& observable);

// --- Points ---

// The columns of a point that are known before its run.
ChartPoint describe(const ChartScene& scene, const ChartModel& model, const Specimen& specimen);
// Runs the model and adds cost and values. Throws NumericalError.
void measure(const Specimen& specimen, const ChartModel& model, ChartPoint& point);
// Instructions per element and step by callgrind, in the first steps of the protocol; none without valgrind.
std::optional<double> count_instructions(const ChartScene& scene, const ChartModel& model);
// Mark the steps to count in step_for_counting; without callgrind they do nothing.
void count_from_here();
void count_to_here();
// The counted program, the hidden verb `chart-steps`: runs this many steps.
void step_for_counting(const std::string& scene, const std::string& model, long steps);

// --- Errors and fronts ---

// One point against one reference.
struct ChartRow {
  const ChartPoint* point = nullptr;
  std::string observable;
  double value = 0;
  double reference = 0;
  std::string reference_kind;  // "finest" or "md"
  double error = 0;            // a fraction, never negative
};

// Rows against the finest model of the scene and against atoms. Points that failed have none; a scene without its
// finest model has none against it.
std::vector<ChartRow> chart_rows(const std::vector<ChartPoint>& points);
// |value - reference| over |reference|; for the packing charge over 6 or more, since an untwisted rope has a charge
// of zero.
double error_of(const std::string& observable, double value, double reference);
// Indices of the Pareto-optimal points in cost and error, cheapest first.
std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

std::vector<OutputColumn> points_columns();
// Rows of each point, in the order of the points, and one row for each that failed.
std::string points_csv(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows);

// Points and rows as they stand in a points.csv: costs, values and errors to its digits.
struct ChartTable {
  std::vector<ChartPoint> points;
  std::vector<ChartRow> rows;  // rows of these points
};
// Throws InputError where the file is no such table, or has models that this program does not know.
ChartTable read_points_csv(const std::string& path);

// `rows` are those of `points`; the facts say how the page was made.
std::string chart_page(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows,
                       const std::vector<std::string>& facts);

// --- The verb ---

struct ChartArguments {
  std::vector<std::string> scenes;  // empty: all
  std::string out = "chart";
  std::string from;  // a points.csv to draw, without measuring
  bool quick = false;
  bool instructions = false;
  bool again = false;
  bool quiet = false;
};
int chart_command(const ChartArguments& arguments);

}  // namespace ropewalk::validate
