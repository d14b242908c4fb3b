#include "plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>

#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "scene/build.hpp"
#include "scene/dissipation.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

using Law = ContactOptions::Law;

// --- which scene of the chart ---

constexpr double margin = 1.1;        // of what a charted scene covers
constexpr double crossing_slack = 1;  // deg
constexpr double radius_slack = 0.2;

// Why a charted scene does not cover another one; empty: it does.
std::string uncovered(const ChartedScene& c, const SceneFeatures& f) {
  if (c.contact != f.contact) return c.contact ? "has contact" : "has no contact";
  if (std::fabs(f.radius / c.radius - 1) > radius_slack) return fmt::format("tubes of radius {:.3g} nm", c.radius);
  if (f.curvature > margin * c.curvature + 1e-4) return fmt::format("curvature up to {:.3g} 1/nm", c.curvature);
  if (f.twist > margin * c.twist + 1e-4) return fmt::format("twist up to {:.3g} rad/nm", c.twist);
  if (f.contact && (f.crossing_from < c.crossing_from - crossing_slack ||
                    f.crossing_to > margin * c.crossing_to + crossing_slack))
    return fmt::format("crossing angles of {:g} to {:g} deg", c.crossing_from, c.crossing_to);
  return "";
}

double distance(const ChartedScene& c, const SceneFeatures& f) {
  const auto apart = [](double a, double b, double floor) {
    return std::fabs(std::log((a + floor) / (b + floor)));
  };
  return apart(c.curvature, f.curvature, 1e-3) + apart(c.twist, f.twist, 1e-3) + 0.5 * apart(c.tubes, f.tubes, 0);
}

double length_of(const ChartedScene& c) { return c.standard()->elements * c.standard()->element_length / c.tubes; }

// In tubes less than half as long the ends count for more: the default's twist angle is 4 % off in seven tubes of
// 8 nm, and less than 1 % in longer ropes.
bool is_short(const ChartedScene& c, const SceneFeatures& f) { return length_of(c) < 0.5 * f.length; }

bool nearer(const ChartedScene& a, const ChartedScene& b, const SceneFeatures& f) {
  if ((a.led == f.led) != (b.led == f.led)) return a.led == f.led;
  if (is_short(a, f) != is_short(b, f)) return is_short(b, f);
  return distance(a, f) < distance(b, f);
}

const ChartedScene* nearest(const std::vector<ChartedScene>& chart, const SceneFeatures& f, Plan& plan) {
  const ChartedScene* best = nullptr;
  for (const ChartedScene& c : chart) {
    if (!c.standard()) continue;
    const std::string why = uncovered(c, f);
    if (!why.empty()) {
      plan.why.push_back(fmt::format("chart scene {} does not cover this one: {}", c.name, why));
    } else if (!best || nearer(c, *best, f)) {
      best = &c;
    }
  }
  if (best && best->led != f.led)
    plan.led_otherwise =
        fmt::format("scene {} is led by {}, this one by {}: what answers to that may be farther off than expected",
                    best->name, words_of(best->led), words_of(f.led));
  return best;
}

// --- what a scene lets one change ---

bool names_only_ends(const Selection& on) {
  return on.all_elements ||
         std::all_of(on.elements.begin(), on.elements.end(), [](int e) { return e == 0 || e == -1; });
}

// Why there is no relaxation in the place of the motion; empty: there can be.
std::string needs_time(const Scene& scene) {
  if (scene.twist) return "the moment of [twist] is ramped, and where a rope ends depends on the way";
  for (const Load& load : scene.loads)
    if (std::holds_alternative<RotateLoad>(load.kind)) return "a rotation needs time";
  if (scene.temperature > 0) return "the scene is warm";
  return "";
}

// --- the knobs ---

struct Option {
  const ChartedModel* model = nullptr;
  std::map<std::string, double> change;  // of each observable, relative, from the knob's best value
  double cost = 1;                       // in that of the default
};

struct Knob {
  std::string name;
  std::vector<Option> options;
  std::map<std::string, double> standard;  // change of the default's value
};

std::string knob_of(const ChartedModel& m) {
  static const std::map<std::string, std::string> names = {
      {"nodes_per_element", "nodes"}, {"nodes", "nodes"},
      {"cutoff", "cutoff"},           {"cutoff_nm", "cutoff"},
      {"element_length", "length"},   {"element_length_nm", "length"},
      {"integrator", "integrator"},   {"contact_every", "levels"},
      {"time_step", "step"},          {"time_step_fs", "step"},
      {"mass_scale", "mass"},         {"mode", "mode"},
      {"precision", "precision"},     {"law", "nodes"}};
  const auto at = names.find(m.kind);
  return at == names.end() ? "" : at->second;
}

// Larger is better, whatever the number means.
double quality(const std::string& knob, const ChartedModel& m) {
  if (knob == "nodes") return m.nodes;
  if (knob == "cutoff") return m.cutoff;
  if (knob == "length") return -m.element_length;
  if (knob == "levels") return -m.contact_every;
  if (knob == "step") return -m.time_step;
  if (knob == "mass") return -std::fabs(std::log(m.mass_scale));
  if (knob == "mode") return m.mode == "dynamics";
  if (knob == "precision") return (m.precision.rfind("double", 0) == 0) + 2 * (m.precision.size() > 6);
  return m.integrator == "verlet";
}

// What the chart takes errors of an observable relative to: the reference, or what else it chose.
double scale_of(const ChartedScene& c, const std::string& observable) {
  for (const ChartedModel& m : c.models) {
    const auto at = m.finest.find(observable);
    if (at == m.finest.end()) continue;
    const double off = std::fabs(at->second.value - at->second.reference);
    if (at->second.error > 0 && off > 0) return off / at->second.error;
  }
  const double reference = std::fabs(c.standard()->finest.at(observable).reference);
  return reference > 0 ? reference : 1.0;
}

// Elements of a tube of the scene.
int elements_of(const Scene& scene) {
  if (const auto* chain = std::get_if<ChainSource>(&scene.source)) return chain->elements;
  const auto* rope = std::get_if<RopeSource>(&scene.source);
  return whole_elements(rope ? rope->length : std::get<FilmSource>(scene.source).length, scene.element_length);
}

// With so few elements that ends and middle are one, the chart says nothing: at least as many as it had, or eight.
bool long_enough(const ChartedScene& c, const ChartedModel& m, const Scene& scene) {
  const double length = m.element_length / c.standard()->element_length * scene.parameters().element_length;
  const double elements = elements_of(scene) * scene.element_length / length;
  return elements > std::min(8.0, static_cast<double>(m.elements) / c.tubes) - 0.5;
}

// Heavy tubes follow a motion that gives their waves as much time as in the chart.
bool slow_enough(const ChartedScene& c, const ChartedModel& m, const SceneFeatures& f) {
  return f.duration / f.length > 0.9 * m.simulated / length_of(c);
}

bool applies(const std::string& knob, const ChartedScene& c, const ChartedModel& m, const Scene& scene,
             const SceneFeatures& f, const PlanRequest& request) {
  const ChartedModel& standard = *c.standard();
  if (m.law != standard.law) return false;  // another law is another physics, not another accuracy
  if (knob == "nodes" || knob == "cutoff" || knob == "levels" || knob == "precision") {
    if (!f.contact) return false;
    if (knob == "levels" && (scene.damping.local > 0 || scene.thermostat)) return false;
  }
  // Where tubes feel nodes they settle in them, which scenes of the chart that are led from rest hardly show: seven
  // free tubes with two nodes instead of six lost 11 % of the energy of twisting.
  if (knob == "nodes") return m.nodes >= standard.nodes;
  if (knob == "length") return !fixed_length(scene).empty() || long_enough(c, m, scene);
  if (knob == "mass") return request.end_state && scene.temperature == 0 && !f.sudden && slow_enough(c, m, f);
  if (knob == "mode") return request.end_state && needs_time(scene).empty();
  return true;
}

// Element-steps per ps with elements of this length: the stable step goes with damping and contact of the scene,
// whose reach is set.
double element_steps(Scene scene, const SceneFeatures& f, double length) {
  if (auto* chain = std::get_if<ChainSource>(&scene.source))
    chain->elements = std::max(2, static_cast<int>(std::lround(chain->elements * scene.element_length / length)));
  scene.damping = same_dissipation(scene.damping, scene.element_length, length);
  scene.element_length = length;
  scene.run.time_step = 0;
  scene.run.stepping = Stepping{};
  scene.run.mass_scale = 1;
  scene.contact.nodes = 0;
  scene.contact.cutoff = 0;
  if (!f.contact) scene.contact.law = Law::none;
  const Prepared p = prepare(scene);
  return p.topology.elements() / p.time_step;
}

// Elements that stay as they are count as the shortest of the chart that are not shorter.
void keep_length(const Scene& scene, const ChartedModel& standard, Knob& k) {
  const double ratio = scene.element_length / scene.parameters().element_length;
  std::vector<Option> kept;
  for (const Option& o : k.options)
    if (o.model->element_length / standard.element_length > ratio * (1 - 1e-3) &&
        (kept.empty() || o.model->element_length < kept[0].model->element_length))
      kept = {o};
  k.options = std::move(kept);
}

std::vector<Knob> knobs_of(const ChartedScene& c, const Scene& scene, const SceneFeatures& f,
                           const PlanRequest& request, const std::vector<std::string>& observables) {
  const ChartedModel& standard = *c.standard();
  std::map<std::string, std::vector<const ChartedModel*>> models;
  for (const ChartedModel& m : c.models) {
    const std::string knob = knob_of(m);
    const auto has = [&](const std::string& o) { return m.finest.count(o) > 0; };
    if (knob.empty() || !std::all_of(observables.begin(), observables.end(), has)) continue;
    if (applies(knob, c, m, scene, f, request)) models[knob].push_back(&m);
  }
  std::vector<Knob> knobs;
  for (auto& [name, list] : models) {
    list.push_back(&standard);
    const std::string knob = name;
    const ChartedModel* best = *std::max_element(list.begin(), list.end(), [&](const auto* a, const auto* b) {
      return quality(knob, *a) < quality(knob, *b);
    });
    Knob k{name, {}, {}};
    for (const ChartedModel* m : list) {
      Option o{m, {}, m->cpu_per_ns / standard.cpu_per_ns};
      if (name == "length" && fixed_length(scene).empty()) {
        const double own = scene.parameters().element_length;
        o.cost = m->ns_per_element_step / standard.ns_per_element_step *
                 element_steps(scene, f, own * m->element_length / standard.element_length) /
                 element_steps(scene, f, own);
      }
      for (const std::string& w : observables) {
        const double from = best->finest.at(w).value, scale = scale_of(c, w);
        o.change[w] = std::fabs(m->finest.at(w).value - from) / scale;
      }
      if (m == &standard) k.standard = o.change;
      k.options.push_back(std::move(o));
    }
    std::sort(k.options.begin(), k.options.end(), [](const Option& a, const Option& b) { return a.cost < b.cost; });
    if (name == "length" && !fixed_length(scene).empty()) keep_length(scene, standard, k);
    knobs.push_back(std::move(k));
  }
  return knobs;
}

// Of the default's error, what its knobs do not explain, and what another scene may add.
std::map<std::string, double> unexplained(const ChartedScene& c, const std::vector<Knob>& knobs,
                                          const std::vector<std::string>& observables) {
  std::map<std::string, double> left;
  for (const std::string& w : observables) {
    double rest = c.standard()->finest.at(w).error;
    for (const Knob& k : knobs) rest -= k.standard.at(w);
    left[w] = std::max(0.0, rest) + (c.contact ? between_scenes : 0.0);
  }
  return left;
}

bool longer_than_charted(const ChartedScene& c, const Scene& scene) {
  if (fixed_length(scene).empty()) return false;
  const double ratio = scene.element_length / scene.parameters().element_length;
  return std::none_of(c.models.begin(), c.models.end(), [&](const ChartedModel& m) {
    return (knob_of(m) == "length" || &m == c.standard()) &&
           m.element_length / c.standard()->element_length > ratio * (1 - 1e-3);
  });
}

// --- the choice ---

struct Choice {
  std::vector<const Option*> options;
  std::map<std::string, double> error;
  double cost = 1;
  double largest() const {
    double most = 0;
    for (const auto& [name, e] : error) most = std::max(most, e);
    return most;
  }
};

// A relaxation has neither time nor masses. Two levels at more than the default part of their limit are in no
// chart: a rope of 37 tubes blew up at 0.9 of it.
bool contradicts_itself(const std::vector<Knob>& knobs, const Choice& c, const ChartedModel& standard) {
  bool relaxed = false, timed = false, levels = false, long_steps = false;
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    const std::string& name = knobs[k].name;
    const bool turned = c.options[k]->model != &standard;
    relaxed |= name == "mode" && turned;
    levels |= name == "levels" && turned;
    long_steps |= name == "step" && c.options[k]->model->time_step > standard.time_step;
    timed |= turned && (name == "levels" || name == "mass" || name == "integrator" || name == "step");
  }
  return (relaxed && timed) || (levels && long_steps);
}

// The cheapest that holds the error; where none does, the most accurate.
Choice choose(const std::vector<Knob>& knobs, const std::map<std::string, double>& rest, double limit,
              const ChartedModel& standard) {
  std::vector<double> least(knobs.size() + 1, 1.0);  // cost of the knobs from here on, at least
  for (std::size_t k = knobs.size(); k-- > 0;) least[k] = least[k + 1] * knobs[k].options.front().cost;
  Choice best, now;
  now.error = rest;
  bool any = false, best_holds = false;
  const std::function<void(std::size_t)> look = [&](std::size_t k) {
    if (best_holds && (now.largest() > limit || now.cost * least[k] >= best.cost)) return;
    if (k == knobs.size()) {
      if (contradicts_itself(knobs, now, standard)) return;
      const bool holds = now.largest() <= limit;
      const bool better = holds ? !best_holds || now.cost < best.cost : now.largest() < best.largest();
      if (!any || better) best = now, best_holds = holds, any = true;
      return;
    }
    for (const Option& o : knobs[k].options) {
      const Choice before = now;
      for (const auto& [name, change] : o.change) now.error[name] += change;
      now.cost *= o.cost;
      now.options.push_back(&o);
      look(k + 1);
      now = before;
    }
  };
  look(0);
  return best;
}

// --- the scene ---

class Writer {
 public:
  Writer(const Scene& scene, const SceneFeatures& features)
      : scene_(scene), features_(features), text_(scene.text) {}

  void set(const char* table, const char* key, const std::string& value, const std::string& why) {
    text_ = with_key(text_, table, key, value);
    why_.push_back(fmt::format("{}{}{} = {}: {}", table, *table ? "." : "", key, value, why));
  }
  void take_away(const char* table, const char* key) { text_ = without_key(text_, table, key); }
  void remark(std::string line) { why_.push_back(std::move(line)); }

  void drop_what_is_not_there() {
    if (scene_.contact.law == Law::none || features_.contact) return;
    if (features_.curvature * longest() > units::pi) {
      remark("contact stays: the lone tube may bend back to itself");
      return;
    }
    set("contact", "law", "\"none\"", "one tube, which does not come back to itself");
  }

  void turn(const Knob& knob, const Option& option, const ChartedModel& standard) {
    const ChartedModel& m = *option.model;
    const std::string why = fmt::format("chart model {}, {:.2f} of the default's time", m.name, option.cost);
    if (&m == &standard) {
      if (knob.name == "length") default_length();
      return;
    }
    if (knob.name == "length" && fixed_length(scene_).empty())
      lengthen(m.element_length / standard.element_length, why);
    if (knob.name == "nodes") nodes_per_nm_ = m.nodes / m.element_length, nodes_why_ = why;
    if (knob.name == "cutoff") set("contact", "cutoff_nm", fmt::format("{:.6g}", m.cutoff), why);
    if (knob.name == "levels") set("run", "contact_every", std::to_string(m.contact_every), why);
    if (knob.name == "integrator") set("run", "integrator", m.integrator == "rk4" ? "\"rk4\"" : "\"verlet\"", why);
    if (knob.name == "mass") set("run", "mass_scale", fmt::format("{:g}", m.mass_scale), why);
    if (knob.name == "step") step_ = m.time_step / standard.time_step, step_why_ = why;
    if (knob.name == "mode") relax(why);
    if (knob.name == "precision") precision(m.precision, why);
  }

  void default_length() {
    if (fixed_length(scene_).empty()) lengthen(1, "as the chart's default");
  }

  // Nodes go with the length of the elements, the time step with everything.
  void finish() {
    if (nodes_per_nm_ > 0) {
      const long nodes =
          std::max(1L, std::lround(nodes_per_nm_ * scene_of_text(text_, scene_.path).element_length));
      set("contact", "nodes_per_element", std::to_string(nodes), nodes_why_);
    }
    if (step_ > 0) {
      text_ = with_key(text_, "run", "time_step_fs", "\"auto\"");
      Scene so_far = scene_of_text(text_, scene_.path);
      const Prepared p = prepare(so_far);
      const int every = so_far.run.stepping.contact_every;
      // Whatever part of the limit the chart's default and this one's are.
      const double most = cold_step_fraction * inner_step_limit(p.limit, every),
                   chosen = std::min(step_ * p.time_step / every, most);
      set("run", "time_step_fs", fmt::format("{:.4g}", chosen / units::fs), step_why_);
    }
  }

  const std::string& text() const { return text_; }
  const std::vector<std::string>& why() const { return why_; }

 private:
  double longest() const {
    if (const auto* rope = std::get_if<RopeSource>(&scene_.source)) return rope->length;
    if (const auto* chain = std::get_if<ChainSource>(&scene_.source))
      return chain->elements * scene_.element_length;
    if (const auto* film = std::get_if<FilmSource>(&scene_.source)) return film->length;
    return std::numeric_limits<double>::infinity();
  }

  // In elements of the set's length, which the chart's default has. As in the chart, what lies between the centres
  // of the end elements stays as long as it is where loads act on them; else the whole tube does.
  void lengthen(double times, const std::string& why) {
    const double wanted = times * scene_.parameters().element_length, old = scene_.element_length;
    if (std::fabs(wanted / old - 1) < 1e-6) return;
    const int overhang = scene_.twist || !scene_.loads.empty() ? 1 : 0;
    const double between = (elements_of(scene_) - overhang) * old;
    const long parts = std::max(2L, std::lround(between / wanted));
    const double length = between / static_cast<double>(parts);
    set("", "element_length_nm", fmt::format("{:.10g}", length), why);
    keep_dissipation(length);
    const std::string stays = overhang ? "the ends' centres stay as far apart" : "the tubes stay as long";
    const long now = parts + overhang;
    if (std::holds_alternative<ChainSource>(scene_.source))
      set("chain", "elements", std::to_string(now), stays);
    else
      set(std::holds_alternative<RopeSource>(scene_.source) ? "rope" : "film", "length_nm",
          fmt::format("{:.10g}", static_cast<double>(now) * length), stays);
  }

  void keep_dissipation(double length) {
    const Damping &now = scene_.damping, kept = same_dissipation(now, scene_.element_length, length);
    const auto write = [&](const char* key, double value) {
      set("damping", key, fmt::format("{:.6g}", value), "as much per length of tube as before");
    };
    if (now.contact.eta > 0 && features_.contact) write("contact_viscosity_eV_ps_per_nm2", kept.contact.eta);
    if (now.bond.rate > 0) write("bond_damping_per_ps", kept.bond.rate);
  }

  void precision(const std::string& words, const std::string& why) {
    const bool full = words.rfind("double", 0) == 0;
    set("contact", "precision", full ? "\"double\"" : "\"mixed\"", why);
    if (scene_.contact.law == Law::line)
      set("contact", "all_nodes", words.find("all") == std::string::npos ? "false" : "true", why);
  }

  void relax(const std::string& why) {
    set("run", "mode", "\"relax\"", why + "; only the end is asked for");
    for (const char* key : {"duration_ps", "contact_every", "integrator", "mass_scale"}) take_away("run", key);
  }

  const Scene& scene_;
  const SceneFeatures& features_;
  std::string text_;
  std::vector<std::string> why_;
  double nodes_per_nm_ = 0, step_ = 0;
  std::string nodes_why_, step_why_;
};

std::string expectations(const std::map<std::string, double>& expected, bool energy_above_start, double asked) {
  std::string text = fmt::format("# plan: asked {:.6g}\n", asked);
  for (const auto& [name, error] : expected)
    text += fmt::format("# plan: expect {} {:.6g}\n",
                        name == "energy" && !energy_above_start ? "total_energy" : name, error);
  return text;
}

std::string header_of(const Plan& plan, const PlanRequest& request) {
  if (plan.stands_for.empty()) return "# The default model: the chart has no scene like this one.\n";
  const std::string caution = plan.led_otherwise.empty() ? "" : "# " + plan.led_otherwise + ".\n";
  return fmt::format("# Planned for an error of {:g} %{}, by scene {} of the chart.\n{}{}", 100 * request.error,
                     plan.holds ? "" : ", which it does not hold", plan.stands_for, caution,
                     expectations(plan.expected, plan.energy_above_start, request.error));
}

std::string standard_header_of(const Plan& plan, const PlanRequest& request) {
  return fmt::format("# The default model, which holds an error of {:g} % by scene {} of the chart.\n{}",
                     100 * request.error, plan.stands_for,
                     expectations(plan.standard_expected, plan.energy_above_start, request.error));
}

std::vector<std::string> observables_of(const ChartedScene& c, const PlanRequest& request) {
  std::string known;
  std::vector<std::string> all;
  for (const auto& [name, value] : c.standard()->finest) {
    all.push_back(name);
    known += (known.empty() ? "" : ", ") + name;
  }
  for (const std::string& o : request.observables)
    if (!std::count(all.begin(), all.end(), o))
      throw InputError({"", 0, "--observables"},
                       fmt::format("the chart has no \"{}\" for scenes like {}", o, c.name), "choose of " + known);
  return request.observables.empty() ? all : request.observables;
}

// The keys that cost, as the program has them by default and the chart's default model too.
void start_from_default(const Scene& scene, Writer& w) {
  const auto reset = [&](bool typed, const char* table, const char* key) {
    if (typed) w.remark(fmt::format("{}.{}: left to the program first", table, key));
    w.take_away(table, key);
  };
  reset(scene.run.time_step > 0, "run", "time_step_fs");
  reset(scene.run.stepping.contact_every > 1, "run", "contact_every");
  reset(scene.run.mass_scale != 1, "run", "mass_scale");
  reset(scene.run.stepping.runge_kutta, "run", "integrator");
  reset(scene.contact.nodes > 0, "contact", "nodes_per_element");
  reset(scene.contact.cutoff > 0, "contact", "cutoff_nm");
  reset(scene.contact.all_nodes, "contact", "all_nodes");
  reset(scene.contact.precision.has_value(), "contact", "precision");
}

}  // namespace

std::string fixed_length(const Scene& scene) {
  if (std::holds_alternative<StateSource>(scene.source)) return "the elements come from a file";
  if (scene.contact.law == Law::paper) return "law \"paper\" holds for its set's length alone";
  for (const Load& load : scene.loads)
    if (!names_only_ends(load.on)) return "a load names elements by number";
  return "";
}

namespace {

// Where nothing is turned the end moment is given by the loads, or is zero: what the chart has of it bounds how far
// tubes give way, but cannot be looked at.
void leave_out_given_moment(const SceneFeatures& f, Plan& plan) {
  const auto moment = plan.expected.find("end_moment");
  if (f.led == LedBy::rotation || moment == plan.expected.end()) return;
  plan.why.push_back(
      fmt::format("end_moment: loads give it here; its error in the chart, {:.2f} %, stands for how far "
                  "tubes give way",
                  100 * moment->second));
  plan.expected.erase(moment);
  plan.standard_expected.erase("end_moment");
}

// What the chart has of the choice and of the default.
void promise(const ChartedScene& c, const std::vector<Knob>& knobs, const std::map<std::string, double>& rest,
             const Choice& choice, const std::vector<std::string>& observables, double limit, Plan& plan) {
  plan.expected = choice.error;
  plan.holds = choice.largest() <= limit;
  plan.cost = choice.cost;
  plan.ns_per_element_step = c.standard()->ns_per_element_step;
  for (const Option* o : choice.options)
    plan.ns_per_element_step *= o->model->ns_per_element_step / c.standard()->ns_per_element_step;
  Choice standard;
  standard.error = rest;
  for (const Knob& k : knobs)  // elements that cannot be others leave no choice
    for (const auto& [name, change] : k.options.size() == 1 ? k.options[0].change : k.standard)
      standard.error[name] += change;
  plan.standard_expected = standard.error;
  plan.standard_holds = standard.largest() <= limit;
  for (const std::string& o : observables) {
    const auto at = c.standard()->atoms.find(o);
    if (at != c.standard()->atoms.end()) plan.atoms[o] = at->second.error;
  }
}

}  // namespace

Plan plan_scene(const Scene& scene, const std::vector<ChartedScene>& chart, const PlanRequest& request) {
  Plan plan;
  Scene built = scene;  // which sets the reach of its damping
  const Prepared prepared = prepare(built);
  const SceneFeatures f = features_of(built, prepared);
  plan.why = f.why;
  Writer w(built, f);
  start_from_default(built, w);
  w.drop_what_is_not_there();
  Writer standard = w;
  standard.default_length();
  const bool line_or_none = !f.contact || scene.contact.law == Law::line;
  const ChartedScene* c = f.beyond.empty() && line_or_none ? nearest(chart, f, plan) : nullptr;
  if (c && longer_than_charted(*c, scene)) {
    plan.why.push_back(fmt::format("elements of {:.4g} nm, which stay since {}, are longer than any in scene {}",
                                   scene.element_length, fixed_length(scene), c->name));
    c = nullptr;
  }
  if (!c) {
    plan.led_otherwise.clear();
    if (!f.beyond.empty()) plan.why.push_back("the chart has nothing like it: " + f.beyond);
    if (!line_or_none) plan.why.push_back("the chart varies law \"line\", and this scene has another");
    plan.why.push_back("no point of the chart is near: the default model is taken, and no error is promised");
  } else {
    plan.stands_for = c->name;
    plan.energy_above_start = c->energy_above_start;
    const std::vector<std::string> observables = observables_of(*c, request);
    const std::vector<Knob> knobs = knobs_of(*c, built, f, request, observables);
    const std::map<std::string, double> rest = unexplained(*c, knobs, observables);
    const Choice choice = choose(knobs, rest, request.error, *c->standard());
    for (std::size_t k = 0; k < knobs.size(); ++k) w.turn(knobs[k], *choice.options[k], *c->standard());
    if (!fixed_length(scene).empty()) w.remark("element length stays: " + fixed_length(scene));
    if (request.end_state && !needs_time(scene).empty()) w.remark("no relaxation: " + needs_time(scene));
    if (request.end_state && f.sudden)
      w.remark("masses stay: a load acts at once, and heavy tubes swing for longer");
    promise(*c, knobs, rest, choice, observables, request.error, plan);
    leave_out_given_moment(f, plan);
  }
  w.finish();
  plan.why.insert(plan.why.end(), w.why().begin(), w.why().end());
  plan.text = header_of(plan, request) + w.text();
  plan.standard_text = standard_header_of(plan, request) + standard.text();
  for (const std::string& text : {plan.text, plan.standard_text})
    scene_of_text(text, scene.path);  // must be scenes
  return plan;
}

bool default_serves(const Plan& plan, double planned_seconds, double standard_seconds) {
  constexpr double noise = 1.1;
  return plan.standard_holds && standard_seconds <= noise * planned_seconds;
}

Expectations expectations_of(const std::string& text) {
  Expectations out;
  const std::regex line("# plan: expect (\\S+) (\\S+)"), asked("# plan: asked (\\S+)");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), line); at != std::sregex_iterator(); ++at)
    out.errors[(*at)[1]] = std::strtod((*at)[2].str().c_str(), nullptr);
  std::smatch found;
  if (std::regex_search(text, found, asked)) out.asked = std::strtod(found[1].str().c_str(), nullptr);
  return out;
}

}  // namespace ropewalk
