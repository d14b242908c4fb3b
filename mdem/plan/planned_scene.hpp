// The text of a scene as the planner changes it, with a line of reason for each change.
#pragma once

#include <string>
#include <vector>

#include "plan/features.hpp"

namespace ropewalk {

class PlannedScene {
 public:
  // `scene` with its text.
  PlannedScene(const Scene& scene, const SceneFeatures& features)
      : scene_(scene), features_(features), text_(scene.text) {}

  void set(const std::string& table, const std::string& key, const std::string& value, const std::string& why);
  void take_away(const std::string& table, const std::string& key);
  void remark(std::string line) { why_.push_back(std::move(line)); }

  // Leaves to the program what `plan` may change.
  void start_from_default();
  // No contact for a lone tube that does not come back to itself.
  void drop_what_is_not_there();
  // Makes elements `times` as long as the set's. The free length of the tubes stays (free_length()).
  // Does nothing where fixed_length() forbids it.
  void lengthen(double times, const std::string& why);
  void default_length() { lengthen(1, "as in the set"); }
  // Written at the end: nodes go with the length of the elements, the time step with everything.
  void set_nodes(double per_nm, const std::string& why) { nodes_per_nm_ = per_nm, nodes_why_ = why; }
  void set_step(double times_default, const std::string& why) { step_ = times_default, step_why_ = why; }
  void finish();

  const std::string& text() const { return text_; }
  const std::vector<std::string>& why() const { return why_; }

 private:
  double longest() const;  // nm, of the tubes

  const Scene& scene_;
  const SceneFeatures& features_;
  std::string text_;
  std::vector<std::string> why_;
  double nodes_per_nm_ = 0, step_ = 0;
  std::string nodes_why_, step_why_;
};

// Elements of a tube of the scene; 0: not known beforehand.
int elements_of(const Scene& scene);

// Why elements cannot be longer or shorter in this scene; empty: they can.
std::string fixed_length(const Scene& scene);

}  // namespace ropewalk
