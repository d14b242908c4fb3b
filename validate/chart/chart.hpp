// The chart of speed against accuracy: a few scenes, each run with many models that differ in one knob from the
// default, and what each costs and how far off it is.
//
// Scenes. The same physical specimen for every model: what deforms reaches from the centre of one held element to
// the centre of another, at a length that does not depend on the element length, and the loads act at those
// centres. Half an element stands out beyond each end; with long elements that overhang is longer, it is rigid, and
// what it changes is mass at the ends and contact that hardly changes with the twist. Energies are taken above the
// untwisted state. Damping constants belong to a pair of elements and to a bond; they go with the element length,
// so that the dissipation per length of tube is the same.
//
// Most scenes are led by rotation: the grips turn at a constant rate and are then held. The motion starts with the
// velocities of a uniform turn, so that no wave runs from the grips. At the stop the kinetic energy of the turn
// becomes vibration, which damping takes out in the hold; ramps are so long that it is small. Observables are means
// over the second half of the hold.
//
// A rope that is led by moments on its grips answers an error of its stiffness with its angle, not with its moment:
// one scene ramps a couple on each grip element at a constant rate, from rest, as [twist] does. Its ends are free,
// and nothing but damping takes out the slowest torsional vibration: half of the hold is one period of it.
//
// Cost. CPU time of this process in steps, one thread, per simulated ns. A relaxation has no time: what it takes
// from start to end is set against the ramp and hold that it replaces.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "observe/observe.hpp"
#include "scene/scene.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// --- Models ---

struct ChartModel {
  std::string name, kind;  // kind: the knob that is varied
  std::string set;         // parameter set; empty: the scene's
  ContactOptions::Law law = ContactOptions::Law::line;
  int nodes = 0;  // per element; 0: as line_nodes chooses
  bool all_nodes = false;
  Interaction::Precision precision = Interaction::Precision::mixed;
  double cutoff = 0;         // nm; 0: the set's
  double length = 1;         // of an element, in those of the default; rounded down to whole bonds
  double time_step = 0;      // ps, of the bonds; 0: by the fraction
  double step_fraction = 0;  // of the stability limit; 0: what a scene takes by itself
  Stepping stepping;
  double mass_scale = 1;
  RunOptions::Mode mode = RunOptions::Mode::dynamics;
  bool at_once = false;           // relaxed after the whole turn, not after each increment
  double contact_viscosity = 20;  // eV ps/nm^2, at the default's element length
  double bond_damping = 1;        // 1/ps, likewise
};

inline constexpr const char* published_model = "published";
inline constexpr const char* default_model = "default";
inline constexpr const char* finest_model = "finest";

// --- Scenes ---

// A scene as one model sees it.
struct Specimen {
  Scene scene;  // knobs and parameter set, for interaction and time step
  Topology topology;
  Interaction interaction;
  State state;           // before it is turned
  double time_step = 0;  // ps, of the bonds
  double spacing = 0;    // nm; 0: one tube

  // How far each element turns about the line z through the origin, in parts of the whole angle; with
  // `about_itself` it turns about its own axis instead and stays in its place.
  std::vector<double> place;
  bool about_itself = false;
  std::vector<int> grips;  // elements that are held and turned
  bool axial_free = false;
  double angle = 0;           // rad, the whole turn
  double moment = 0;          // eV on each grip element instead, against one another at the two ends
  double ramp = 0, hold = 0;  // ps
  int increments = 1;         // of a relaxation
  // Before it is relaxed, all turns evenly; else the grips alone, where the even turn is the answer already.
  bool interior_follows = true;
  bool moment_resists = true;  // the end moment counts against the turn, else with it
  bool above_start = true;     // the energy counts from that of the untwisted state

  double duration() const { return ramp + hold; }
  double outer_step() const { return time_step * scene.run.stepping.contact_every; }
  LoadsAndConstraints held() const;  // before the ramp; free where a moment leads
  LoadsAndConstraints led() const;
};

struct ChartReference {
  std::string observable;
  double value = 0;
};

struct ChartScene {
  std::string name, title, setup;
  bool contact = true;  // more than one tube
  std::vector<std::string> observables;
  std::function<Specimen(const ChartModel&)> build;
  std::function<std::vector<ChartReference>()> atoms;  // may be empty
  // Under couples on its tubes a rope turns because they rub on one another. A relaxation knows no friction, and
  // ends elsewhere: with three quarters of the angle.
  bool relaxes = true;
};

// A model's scene without its elements: set, contact, damping; at this element length. The interaction and the
// spacing of two tubes follow from it.
Scene knobs_of(const ChartModel& model, const std::string& default_set, double element_length);
double rest_spacing(const Scene& scene);

const std::vector<ChartScene>& chart_scenes();
const ChartScene& find_chart_scene(const std::string& name);
// Those that make sense in the scene; `quick`: a few.
std::vector<ChartModel> chart_models(const ChartScene& scene, bool quick);
const ChartModel& find_chart_model(const std::vector<ChartModel>& models, const std::string& name);

// "energy": unit "eV", ...
std::string observable_unit(const std::string& observable);

// --- Points ---

// One model in one scene, as the file of its result holds it.
struct ChartPoint {
  std::string key;    // what it was run with: another key makes it stale
  std::string error;  // of a model that could not be run
  std::string scene, model, kind, law, integrator, mode, precision;
  int nodes = 0, contact_every = 1, elements = 0;
  double cutoff = 0, element_length = 0;  // nm
  double time_step = 0;                   // ps, of the bonds
  double mass_scale = 1, contact_viscosity = 0, bond_damping = 0;
  double simulated = 0;  // ps
  double steps = 0;
  double cpu = 0;                      // s
  std::optional<double> instructions;  // per element-step
  std::map<std::string, double> values;

  double element_steps_per_ns() const { return elements * steps / (1e-3 * simulated); }
  double cpu_per_ns() const { return cpu / (1e-3 * simulated); }
  double cpu_per_element_step() const { return cpu / (elements * steps); }
};

std::string point_json(const ChartPoint& point);
// Throws InputError where the file is not such a point.
ChartPoint read_point(const std::string& path);

// The columns of a point that are known before it is run.
ChartPoint describe(const ChartScene& scene, const ChartModel& model, const Specimen& specimen);
// Runs it. Throws NumericalError.
void measure(const Specimen& specimen, const ChartModel& model, ChartPoint& point);
// Instructions per element-step by callgrind, of the first steps of the protocol; none where valgrind is missing.
std::optional<double> count_instructions(const ChartScene& scene, const ChartModel& model,
                                         const std::string& folder);
// Around the steps of step_for_counting; nothing where callgrind does not run.
void count_from_here();
void count_to_here();
// What the counted program does: so many steps from the turned state. For `chart-steps` alone.
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

// Against the finest model of the scene and against atoms; points that failed and scenes without their finest model
// give none.
std::vector<ChartRow> chart_rows(const std::vector<ChartPoint>& points);
// |value - reference| over |reference|. Of the packing charge, over 6 or more: a rope has none before it is
// twisted.
double error_of(const std::string& observable, double value, double reference);
// Of cost and error, those that no other beats in one without losing in the other; cheapest first.
std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

std::string points_csv(const std::vector<ChartRow>& rows);
std::string chart_page(const std::vector<ChartPoint>& points, const std::vector<std::string>& facts);

// --- The verb ---

struct ChartArguments {
  std::vector<std::string> scenes;  // empty: all
  std::string out = "chart";
  bool quick = false;
  bool instructions = false;
  bool again = false;
  bool quiet = false;
};
int chart_command(const ChartArguments& arguments);

}  // namespace ropewalk
