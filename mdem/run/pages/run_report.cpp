// report.html from the files of a run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/bath_words.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/grade.hpp"
#include "model/error.hpp"
#include "model/yarn.hpp"
#include "report/report.hpp"
#include "run/events_file.hpp"
#include "run/pages/run_views.hpp"
#include "run/results.hpp"
#include "run/run_directory.hpp"
#include "scene/ends/periodic.hpp"
#include "scene/network_words.hpp"
#include "scene/scene_to_model.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t pictured = 6;

std::vector<StoredFrame> read_frames(const RunDirectory& dir, const Topology& topology) {
  const auto reader = open_frames(dir.frames());
  const std::size_t all = reader->count(topology), some = std::min(all, pictured);
  std::vector<StoredFrame> out(some);
  // First, last and evenly between.
  for (std::size_t k = 0; k < some; ++k) {
    reader->seek(some < pictured ? k : k * (all - 1) / (pictured - 1));
    reader->next(topology, out[k]);
  }
  return out;
}

void add_run_facts(const Scene& scene, const Prepared& p, const Manifest& m, ReportInput& in) {
  const auto add = [&](std::string key, std::string value, std::string remark = "") {
    in.facts.push_back({std::move(key), std::move(value), std::move(remark)});
  };
  const Topology& t = p.topology;
  add("scene", scene.name, "hash " + scene.hash);
  add("tubes", fmt::format("{} with {} elements of {:.4g} nm in all", t.tubes(), t.elements(), t.longest_element()),
      t.tubes() > 0 ? fmt::format("the first is {:.4g} nm long", t.length_of(0) * t.longest_element()) : "");
  for (std::size_t k = 0; k < scene.sets.size(); ++k) {
    const auto tubes = std::count(t.tube_type.begin(), t.tube_type.end(), static_cast<int>(k));
    add(k == 0 ? "parameters" : "parameters, type " + std::to_string(k), scene.sets[k].name,
        (scene.sets.size() > 1 ? fmt::format("{} tubes, ", tubes) : "") + "hash " + scene.sets[k].hash);
    add("grade", grade_of(scene.sets[k]).words(), "how well the set represents its tube");
  }
  add("contact law", scene.contact.law,
      scene.contact.legacy_torque ? "legacy torque: not a gradient, energy is not conserved" : "full gradient");
  add("damping", fmt::format("contact viscosity {:.4g} eV ps/nm^2, bonds {:.4g} 1/ps, PFC local {:.4g}",
                             scene.damping.contact.eta, scene.damping.bond.rate, scene.damping.local));
  for (const auto& drive : scene.drives) add(drive->table().name, drive->words());
  add("time step", fmt::format("{:.4g} fs", p.time_step / units::fs),
      fmt::format("stability limit {:.4g} fs", p.limit.limit / units::fs));
  for (const std::string& words : warmth_of(scene, p)) add("temperature", words);
  add("seed", fmt::format("{}", m.seed));
  add("program", fmt::format("ropewalk {} ({})", m.version, m.git_id),
      fmt::format("{}, {}", m.compiler, m.build_type));
  if (!m.own_parts.empty()) add("of its own", m.own_parts, "parts that " + m.program + " has and no other program");
  add("wall time", fmt::format("{:.0f} s on {} threads", m.wall_seconds, m.threads), "started " + m.started);
  if (!m.own_forces.empty())
    add("forces of one's own", m.own_forces, "functions of Python, which no file of this run holds");
  if (!m.device.empty()) add("device", m.device, "moved the elements that no load acts on");
}

// What a testing machine tells, of a rope that may come apart.
void add_strength(const Scene& scene, ReportInput& in) {
  const bool breaks = std::any_of(scene.drives.begin(), scene.drives.end(), [](const auto& drive) {
    return drive->table().name == "links" || drive->table().name == "failure";
  });
  if (!breaks || in.log.empty()) return;
  const LogRow& last = in.log.back();
  if (const RunResults& r = in.results; std::isfinite(r.strength))
    in.facts.push_back({"strength",
                        fmt::format("{:.3g} GPa, {:.3g} N/tex, at a strain of {:.3g}", r.strength,
                                    r.strength_N_per_tex, r.strength_strain),
                        "the largest stress in the log, over the cells of the cross-section; strain since the pull began"});
  in.facts.push_back({"broken",
                      fmt::format("{:.0f} of {:.0f} links and {:.0f} bonds of tubes", last["links_broken"],
                                  last["links_formed"], last["bonds_broken"]),
                      "events.csv says when and where"});
}

// What an experimenter knows of a yarn. Turns per metre say nothing of a rope that has ends: its own are a million
// times as many.
void add_size(const Scene& scene, const Observer& observer, ReportInput& in) {
  if (!in.rope) return;
  if (const std::string words = size_words(observer.size); !words.empty()) {
    const std::size_t colon = words.find(": ");
    in.facts.push_back({"size", words.substr(0, colon), words.substr(colon + 2)});
  }
  const auto slices = scene.drives_of<PeriodicDrive>();
  if (slices.empty() || in.log.empty() || !std::isfinite(in.log.back()["beta_deg"])) return;
  constexpr double usual = 20e3, um = 1e3;  // nm
  const double typed = slices.front()->load.yarn_diameter, diameter = typed > 0 ? typed : usual,
               beta = in.log.back()["beta_deg"] * units::degree;
  in.facts.push_back(
      {"as a yarn",
       fmt::format("{:.4g} turns per metre at a diameter of {:.4g} µm", 1e9 * yarn_turns(beta, diameter),
                   diameter / um),
       "by tan β = π d T, with the β of the last row; yarn_diameter_um in [periodic] names another"});
}

// Adds how the tubes of a film hang together, at first and in the end.
void add_network(const Scene& scene, const StoredEvents& events, const std::vector<StoredFrame>& frames,
                 ReportInput& in) {
  if (frames.empty()) return;
  const auto words = [&](const StoredFrame& frame) {
    return network_words(scene, events.tubes_at(frame.state.time), frame.state);
  };
  const std::string at_first = words(frames.front());
  if (at_first.empty()) return;
  const std::string touch = fmt::format("tubes touch within {} times the distance of crossed ones", touching);
  in.facts.push_back({"network at first", at_first, touch});
  in.facts.push_back({"network in the end", words(frames.back()), touch});
}

// Within some twenty degrees of one direction.
bool are_parallel(const State& state) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < state.size(); ++i) sum += axis_of(state.orientation[i]);
  const Vector3 mean = sum.normalized();
  for (std::size_t i = 0; i < state.size(); ++i)
    if (axis_of(state.orientation[i]).dot(mean) < 0.94) return false;
  return true;
}

// `now`: the tubes cut where they have broken.
ReportLoading loading_of(const Topology& topology, const Topology& now, const State& state,
                         const LoadingReference& reference) {
  ReportLoading out;
  out.time_ps = state.time;
  out.radius = reference.radius;
  if (reference.knows_pressures())
    for (const double pressure : tube_pressures(topology, state, reference))
      out.pressure_GPa.push_back(pressure / units::nN_nm);  // nN/nm^2
  for (int t = 0; t < topology.tubes(); ++t) {
    out.tension_nN.emplace_back();
    const std::vector<double> whole = tensions(topology, state, t);
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const int element = topology.tube_begin[t] + static_cast<int>(k);
      out.tension_nN.back().push_back(now.tube_of(element) == now.tube_of(element + 1) ? whole[k] / units::nN_nm
                                                                                       : 0);
    }
  }
  return out;
}

// Not where the run has gone on since.
bool has_view(const RunDirectory& dir) {
  std::error_code none;
  const auto view = std::filesystem::last_write_time(dir.view(), none);
  return !none && view >= std::filesystem::last_write_time(dir.frames(), none) && !none;
}

ReportInput gather(const RunDirectory& dir, const Scene& scene, const Prepared& p) {
  ReportInput in;
  const Manifest m = read_manifest(dir.manifest());
  in.name = scene.name;
  in.status = m.status;
  in.reason = m.reason;
  add_run_facts(scene, p, m, in);
  in.warnings = warnings_of(scene, p);
  for (const ParameterSet& set : scene.sets)
    if (const Grade grade = grade_of(set); grade.level != Grade::Level::good)
      in.warnings.push_back("Parameters " + set.name + " are " + grade.words() + ".");
  in.log = read_log(dir.log());
  if (const ThermostatOptions* bath = scene.bath())
    if (const std::string words = bath_words(in.log, bath->coupling); !words.empty()) in.warnings.push_back(words);
  in.errors = read_run_errors(dir.path, in.log);
  in.whole = read_numeric_errors(dir.path, in.log);
  in.error_bars = error_bars_of(scene, p.topology, in.log);
  in.ramp_end_ps = whole_from(end_drives(p.loads, p.topology));
  in.tube_radius = p.topology.largest_radius();
  in.spacing = p.spacing;
  in.element_length = p.topology.longest_element();
  in.tubes = p.topology.tubes();
  in.bonds = p.topology.bonds();
  if (scene.sets.size() == 1)
    in.validity = validities(scene, p.topology).front();  // of more than one, no number holds for all
  if (std::filesystem::exists(dir.limits())) in.watched = read_limits(dir.limits());
  if (std::filesystem::exists(dir.equilibria())) in.equilibria = read_equilibria(dir.equilibria());
  in.results = results_of(dir, p);
  in.result_errors = errors_of_results(dir);
  add_strength(scene, in);
  const Observer observer = make_observer(scene, p);
  in.rope = is_rope(p, observer);
  add_size(scene, observer, in);
  in.loaded = !p.loads.empty();
  in.shells = observer.shells;
  const StoredEvents events(dir.events(), p.topology);
  const std::vector<StoredFrame> frames = read_frames(dir, p.topology);
  add_network(scene, events, frames, in);
  for (const StoredFrame& frame : frames) {
    const Topology now = events.tubes_at(frame.state.time);
    const RopeObservation o = observe(observer, scene, now, frame.state);
    const double beta = o.beta / units::degree;
    in.sections.push_back({frame.state.time, beta, o.middle, o.radius_profile});
    in.views.push_back(view_of(events, frame, beta));
    if (in.rope) in.loading.push_back(loading_of(p.topology, now, frame.state, observer.loading));
  }
  in.in_space = has_view(dir);
  in.parameter_name = scene.parameters().name;
  in.parameter_reference = scene.parameters().reference;
  in.parameters = scene.parameters().quantities;
  return in;
}

}  // namespace

bool is_rope(const Prepared& p, const Observer& observer) {
  return p.topology.tubes() > 1 && !observer.loading.radius.empty() && are_parallel(p.state);
}

RopeView view_of(const StoredEvents& events, const StoredFrame& frame, double beta_deg) {
  const Topology topology = events.tubes_at(frame.state.time);
  RopeView view;
  view.time_ps = frame.state.time;
  view.beta_deg = beta_deg;
  const auto& moment = frame.colours.bending_moment;
  for (int t = 0; t < topology.tubes(); ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    std::vector<Vector3> line;
    for (int e = from; e < to; ++e) line.push_back(frame.state.position[static_cast<std::size_t>(e)]);
    view.tubes.push_back(std::move(line));
    view.radii.push_back(topology.type_of(t).radius);
    if (moment.empty()) continue;
    view.colour.emplace_back();
    for (int e = from; e < to; ++e)
      view.colour.back().push_back(std::fabs(moment[static_cast<std::size_t>(e)]) / units::nN_nm);
  }
  for (const auto& [a, b] : events.links_at(frame.state.time))
    view.links.push_back(
        {frame.state.position[static_cast<std::size_t>(a)], frame.state.position[static_cast<std::size_t>(b)]});
  return view;
}

std::optional<RopeView> last_view(const RunDirectory& dir, const Scene& scene, const Prepared& prepared) {
  const std::optional<StoredFrame> frame = last_frame(dir.frames(), prepared.topology);
  if (!frame) return {};
  const double beta = observe(make_observer(scene, prepared), scene, prepared.topology, frame->state).beta;
  return view_of(StoredEvents(dir.events(), prepared.topology), *frame, beta / units::degree);
}

std::string report_of(const RunDirectory& dir, const Scene& scene, const Prepared& prepared) {
  return report_html(gather(dir, scene, prepared));
}

void write_report(const RunDirectory& dir, const Scene& scene, const Prepared& prepared) {
  write_file_atomically(dir.report(), report_of(dir, scene, prepared));
}

}  // namespace ropewalk
