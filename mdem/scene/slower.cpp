#include "scene/slower.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "io/plain_text.hpp"
#include "io/toml_text.hpp"
#include "scene/drive_kind.hpp"
#include "scene/scene_keys.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

using Pace = SceneKey::Pace;

// A number as it stands, or in { value = 1, standard_error = 0.1 }.
double number_of(const toml::node& node) {
  const toml::table* table = node.as_table();
  return table ? (*table)["value"].value_or(0.0) : node.value_or(0.0);
}

class Slowing {
 public:
  explicit Slowing(double times) : times_(times) {}

  int rates() const { return rates_; }  // motions and loads that go slower now

  void slow(const SceneTable& doc, toml::table& keys) {
    for (const SceneKey& key : doc.keys)
      if (key.pace != Pace::none) slow(key, keys);
  }

 private:
  void slow(const SceneKey& key, toml::table& keys) {
    toml::node* typed = keys.get(key.key);
    if (key.pace == Pace::course) {
      if (typed) slow_course(*typed);
      return;
    }
    // A key without a default follows from others, or acts only where it is typed.
    if (!typed && !key.standard.empty()) return;
    const double value = typed ? number_of(*typed) : leading_number(key.value).value_or(0);
    if (value == 0) return;
    if (key.pace == Pace::rate) ++rates_;
    keys.insert_or_assign(key.key, key.pace == Pace::rate ? value / times_ : value * times_);
  }

  // Points [[ps, value], ...], or a table with these or with a rate.
  void slow_course(toml::node& node) {
    if (toml::table* table = node.as_table()) {
      std::map<std::string, double> rates;
      for (auto&& [name, value] : *table)
        if (std::string(name.str()).rfind("rate_", 0) == 0)
          rates[std::string(name.str())] = number_of(value) / times_;
        else
          slow_course(value);
      for (const auto& [name, rate] : rates) ++rates_, table->insert_or_assign(name, rate);
      return;
    }
    toml::array* points = node.as_array();
    if (!points) return;
    double least = 0, most = 0;
    bool first = true;
    for (toml::node& point : *points) {
      toml::array* pair = point.as_array();
      if (!pair || pair->size() != 2) return;  // values that are reached at the rate beside them
      pair->replace(pair->cbegin(), times_ * number_of(*pair->get(0)));
      const double value = number_of(*pair->get(1));
      least = first ? value : std::min(least, value);
      most = first ? value : std::max(most, value);
      first = false;
    }
    if (most > least) ++rates_;
  }

  double times_;
  int rates_ = 0;
};

void slow_drives(const Scene& scene, toml::table& top, Slowing& slowing) {
  std::map<std::string, std::size_t> found;
  for (const auto& drive : scene.drives) {
    const SceneTable table = drive->table();
    toml::node& typed = *top.get(table.name);
    slowing.slow(table,
                 table.listed ? *typed.as_array()->get_as<toml::table>(found[table.name]++) : *typed.as_table());
  }
}

// Tables that stand any number of times.
void slow_list(const SceneTable& doc, toml::table& top, Slowing& slowing) {
  if (toml::array* all = top[doc.name].as_array())
    for (toml::node& one : *all) slowing.slow(doc, *one.as_table());
}

}  // namespace

std::string why_not_slower(const Scene& scene) {
  if (scene.run.mode == RunOptions::Mode::relax) return "a relaxation has no rate";
  toml::table top = parsed_toml(scene.text, scene.path);
  Slowing slowing(2);
  slow_drives(scene, top, slowing);
  return slowing.rates() > 0 ? "" : "nothing in the scene is moved or loaded at a rate";
}

std::string slower_scene_text(const Scene& scene, double times, const std::string& comment) {
  toml::table top = parsed_toml(scene.text, scene.path);
  Slowing slowing(times);
  top.insert_or_assign("name", scene.name);
  slow_drives(scene, top, slowing);
  if (toml::table* run = top["run"].as_table()) slowing.slow(run_table().doc(), *run);
  slow_list(stop_table().doc(), top, slowing);
  slow_list(expect_table().doc(), top, slowing);
  std::ostringstream text;
  text << "# " << comment << "\n" << top << "\n";
  return text.str();
}

}  // namespace ropewalk
