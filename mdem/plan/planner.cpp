#include "plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>

#include "model/error.hpp"
#include "plan/knobs.hpp"
#include "scene/dissipation.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

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
  if ((a.driven_by == f.driven_by) != (b.driven_by == f.driven_by)) return a.driven_by == f.driven_by;
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
  if (best && best->driven_by != f.driven_by)
    plan.driven_otherwise =
        fmt::format("scene {} is driven by {}, this one by {}: angles and moments may be farther off than expected",
                    best->name, words_of(best->driven_by), words_of(f.driven_by));
  return best;
}

// --- the knobs ---

struct Option {
  const ChartedModel* model = nullptr;
  std::map<std::string, double> change;  // of each observable, relative, from the knob's best value
  double cost = 1;                       // in that of the default
};

// What the chart has of one knob.
struct KnobOptions {
  const Knob* knob = nullptr;
  std::vector<Option> options;
  std::map<std::string, double> standard;  // change of the default's value
};

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

// Element-steps per ps with elements of this length: the stable step goes with damping and contact of the scene,
// whose reach is set.
double element_steps(Scene scene, const SceneFeatures& f, double length) {
  scene.damping = same_dissipation(scene.damping, scene.element_length, length);
  scene.element_length = length;
  scene.run.time_step = 0;
  scene.run.stepping = Stepping{};
  scene.run.mass_scale = 1;
  scene.contact.nodes = 0;
  scene.contact.cutoff = 0;
  if (!f.contact) scene.contact.law = "none";
  const Prepared p = prepare(scene);
  return p.topology.elements() / p.time_step;
}

// Elements that stay as they are count as the shortest of the chart that are not shorter.
void keep_length(const Scene& scene, const ChartedModel& standard, KnobOptions& k) {
  const double ratio = scene.element_length / scene.parameters().element_length;
  std::vector<Option> kept;
  for (const Option& o : k.options)
    if (o.model->element_length / standard.element_length > ratio * (1 - 1e-3) &&
        (kept.empty() || o.model->element_length < kept[0].model->element_length))
      kept = {o};
  k.options = std::move(kept);
}

// In the time that the chart needs; elements of another length also cost what the scene makes of them.
double cost_of(const Knob& knob, const ChartedModel& m, const KnobUse& use) {
  const ChartedModel& standard = *use.charted.standard();
  if (knob.id != Knob::Id::length || !fixed_length(use.scene).empty()) return m.cpu_per_ns / standard.cpu_per_ns;
  const double own = use.scene.parameters().element_length;
  return m.ns_per_element_step / standard.ns_per_element_step *
         element_steps(use.scene, use.features, own * m.element_length / standard.element_length) /
         element_steps(use.scene, use.features, own);
}

// Of the models, and the default as one of them.
KnobOptions options_of(const Knob& knob, std::vector<const ChartedModel*> models, const KnobUse& use,
                       const std::vector<std::string>& observables) {
  const ChartedModel& standard = *use.charted.standard();
  models.push_back(&standard);
  const ChartedModel* best = *std::max_element(models.begin(), models.end(), [&](const auto* a, const auto* b) {
    return knob.quality(*a) < knob.quality(*b);
  });
  KnobOptions k{&knob, {}, {}};
  for (const ChartedModel* m : models) {
    Option o{m, {}, cost_of(knob, *m, use)};
    for (const std::string& w : observables) {
      const double from = best->finest.at(w).value, scale = scale_of(use.charted, w);
      o.change[w] = std::fabs(m->finest.at(w).value - from) / scale;
    }
    if (m == &standard) k.standard = o.change;
    k.options.push_back(std::move(o));
  }
  std::sort(k.options.begin(), k.options.end(), [](const Option& a, const Option& b) { return a.cost < b.cost; });
  if (knob.id == Knob::Id::length && !fixed_length(use.scene).empty()) keep_length(use.scene, standard, k);
  return k;
}

std::vector<KnobOptions> knobs_of(const KnobUse& use, const std::vector<std::string>& observables) {
  std::vector<KnobOptions> out;
  for (const Knob& knob : all_knobs()) {
    std::vector<const ChartedModel*> models;
    for (const ChartedModel& m : use.charted.models) {
      const auto has = [&](const std::string& o) { return m.finest.count(o) > 0; };
      if (knob_of(m) != &knob || !std::all_of(observables.begin(), observables.end(), has)) continue;
      // Another law is another physics, not another accuracy.
      if (m.law == use.charted.standard()->law && knob.applies(use, m)) models.push_back(&m);
    }
    if (!models.empty()) out.push_back(options_of(knob, models, use, observables));
  }
  return out;
}

// Of the default's error, what its knobs do not explain, and what another scene may add.
std::map<std::string, double> unexplained(const ChartedScene& c, const std::vector<KnobOptions>& knobs,
                                          const std::vector<std::string>& observables) {
  std::map<std::string, double> left;
  for (const std::string& w : observables) {
    double rest = c.standard()->finest.at(w).error;
    for (const KnobOptions& k : knobs) rest -= k.standard.at(w);
    left[w] = std::max(0.0, rest) + (c.contact ? between_scenes : 0.0);
  }
  return left;
}

bool longer_than_charted(const ChartedScene& c, const Scene& scene) {
  if (fixed_length(scene).empty()) return false;
  const double ratio = scene.element_length / scene.parameters().element_length;
  return std::none_of(c.models.begin(), c.models.end(), [&](const ChartedModel& m) {
    const Knob* knob = knob_of(m);
    return ((knob && knob->id == Knob::Id::length) || &m == c.standard()) &&
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
bool contradicts_itself(const std::vector<KnobOptions>& knobs, const Choice& c, const ChartedModel& standard) {
  bool relaxed = false, timed = false, levels = false, long_steps = false;
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    const Knob& knob = *knobs[k].knob;
    const bool changed = c.options[k]->model != &standard;
    relaxed |= knob.id == Knob::Id::mode && changed;
    levels |= knob.id == Knob::Id::levels && changed;
    long_steps |= knob.id == Knob::Id::step && c.options[k]->model->time_step > standard.time_step;
    timed |= knob.in_time && changed;
  }
  return (relaxed && timed) || (levels && long_steps);
}

// The cheapest that holds the error; where none does, the most accurate.
Choice choose(const std::vector<KnobOptions>& knobs, const std::map<std::string, double>& rest, double limit,
              const ChartedModel& standard) {
  std::vector<double> least(knobs.size() + 1, 1.0);  // cost of the knobs from here on, at least
  for (std::size_t k = knobs.size(); k-- > 0;) least[k] = least[k + 1] * knobs[k].options.front().cost;
  Choice best, now;
  now.error = rest;
  bool any = false, best_holds = false;
  const std::function<void(std::size_t)> choose_from = [&](std::size_t k) {
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
      choose_from(k + 1);
      now = before;
    }
  };
  choose_from(0);
  return best;
}

// --- the text ---

std::string expectations(const std::map<std::string, double>& expected, bool energy_above_start, double asked) {
  std::string text = fmt::format("# plan: asked {:.6g}\n", asked);
  for (const auto& [name, error] : expected)
    text += fmt::format("# plan: expect {} {:.6g}\n",
                        name == "energy" && !energy_above_start ? "total_energy" : name, error);
  return text;
}

std::string header_of(const Plan& plan, const PlanRequest& request) {
  if (plan.stands_for.empty()) return "# The default model: the chart has no scene like this one.\n";
  const std::string caution = plan.driven_otherwise.empty() ? "" : "# " + plan.driven_otherwise + ".\n";
  return fmt::format("# Planned for an error of {:g} %{}, by scene {} of the chart.\n{}{}", 100 * request.error,
                     plan.holds ? "" : ", which no model of the chart meets", plan.stands_for, caution,
                     expectations(plan.expected, plan.energy_above_start, request.error));
}

std::string standard_header_of(const Plan& plan, const PlanRequest& request) {
  return fmt::format("# The default model: it meets an error of {:g} %, by scene {} of the chart.\n{}",
                     100 * request.error, plan.stands_for,
                     expectations(plan.standard_expected, plan.energy_above_start, request.error));
}

// The keys of all knobs as the program has them by default, and the chart's default model too.
void start_from_default(PlannedScene& w) {
  for (const Knob& knob : all_knobs())
    for (const Knob::Key& k : knob.keys) {
      if (k.typed(w.scene())) w.remark(fmt::format("{}.{}: left to the program first", k.table, k.key));
      w.take_away(k.table, k.key);
    }
}

void write(const KnobOptions& k, const Option& option, const ChartedModel& standard, PlannedScene& w) {
  const std::string why =
      fmt::format("chart model {}, {:.2f} of the default's time", option.model->name, option.cost);
  if (option.model != &standard)
    k.knob->write(w, *option.model, standard, why);
  else if (k.knob->id == Knob::Id::length)
    w.default_length();
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

// Where no rotation is prescribed, the loads give the end moment, or it is zero. Its error in the chart then bounds
// that of the twist, and no run can check it.
void leave_out_given_moment(const SceneFeatures& f, Plan& plan) {
  const auto moment = plan.expected.find("end_moment");
  if (f.driven_by == DrivenBy::rotation || moment == plan.expected.end()) return;
  plan.why.push_back(
      fmt::format("end_moment: loads give it here; its error in the chart, {:.2f} %, is to be expected of the "
                  "twist instead",
                  100 * moment->second));
  plan.expected.erase(moment);
  plan.standard_expected.erase("end_moment");
}

// What the chart has of the choice and of the default.
void promise(const ChartedScene& c, const std::vector<KnobOptions>& knobs,
             const std::map<std::string, double>& rest, const Choice& choice,
             const std::vector<std::string>& observables, double limit, Plan& plan) {
  plan.expected = choice.error;
  plan.holds = choice.largest() <= limit;
  plan.cost = choice.cost;
  plan.ns_per_element_step = c.standard()->ns_per_element_step;
  for (const Option* o : choice.options)
    plan.ns_per_element_step *= o->model->ns_per_element_step / c.standard()->ns_per_element_step;
  Choice standard;
  standard.error = rest;
  for (const KnobOptions& k : knobs)  // elements that cannot be others leave no choice
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
  PlannedScene w(built, f);
  start_from_default(w);
  w.drop_what_is_not_there();
  PlannedScene standard = w;
  standard.default_length();
  const bool line_or_none = !f.contact || scene.contact.law == "line";
  const ChartedScene* c = f.not_estimable.empty() && line_or_none ? nearest(chart, f, plan) : nullptr;
  if (c && longer_than_charted(*c, scene)) {
    plan.why.push_back(fmt::format("elements of {:.4g} nm, which stay since {}, are longer than any in scene {}",
                                   scene.element_length, fixed_length(scene), c->name));
    c = nullptr;
  }
  if (!c) {
    plan.driven_otherwise.clear();
    if (!f.not_estimable.empty()) plan.why.push_back("the chart has nothing like it: " + f.not_estimable);
    if (!line_or_none) plan.why.push_back("the chart varies law \"line\", and this scene has another");
    plan.why.push_back("no point of the chart is near: the default model is taken, and no error is promised");
  } else {
    plan.stands_for = c->name;
    plan.energy_above_start = c->energy_above_start;
    const std::vector<std::string> observables = observables_of(*c, request);
    const std::vector<KnobOptions> knobs = knobs_of({*c, built, f, request.end_state}, observables);
    const std::map<std::string, double> rest = unexplained(*c, knobs, observables);
    const Choice choice = choose(knobs, rest, request.error, *c->standard());
    for (std::size_t k = 0; k < knobs.size(); ++k) write(knobs[k], *choice.options[k], *c->standard(), w);
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
