#include "python/scene.hpp"

#include "plan/forecast.hpp"
#include "python/arrays.hpp"
#include "scene/missing_forces.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_files.hpp"

namespace ropewalk::python {
namespace {

// The notes that `ropewalk run` prints before it starts.
std::vector<std::string> notes_of(const SceneHandle& handle) {
  const std::shared_ptr<const Model> model = handle.model();
  refuse_cooling(model->scene, model->prepared);
  std::vector<std::string> all;
  for (const auto& notes :
       {forgotten(model->scene.memory, model->prepared.interaction), warnings_of(model->scene, model->prepared),
        warmth_of(model->scene, model->prepared), limits_ahead(model->scene, model->prepared)})
    all.insert(all.end(), notes.begin(), notes.end());
  return all;
}

template <class Value>
py::array_t<double> of_tubes(const SceneHandle& handle, Value value) {
  const Topology& topology = handle.model()->prepared.topology;
  std::vector<double> out;
  for (int t = 0; t < topology.tubes(); ++t) out.push_back(value(topology.type_of(t)));
  return array_of(out);
}

py::tuple start_of(const SceneHandle& handle) {
  const State& s = handle.model()->prepared.state;
  return py::make_tuple(copy_of(s.position), copy_of(s.orientation), copy_of(s.velocity),
                        copy_of(s.angular_velocity));
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<SceneHandle, std::shared_ptr<SceneHandle>>(m, "Scene")
      .def_static("read", [](const std::string& path) { return SceneHandle(read_scene(path)); })
      .def_static("of_text", [](const std::string& text,
                                const std::string& path) { return SceneHandle(scene_of_text(text, path)); })
      .def_static("of_run", [](const std::string& dir) { return SceneHandle(read_run_scene({dir})); })
      .def_property_readonly("name", [](const SceneHandle& s) { return s.scene().name; })
      .def_property_readonly("text", [](const SceneHandle& s) { return s.scene().text; })
      .def_property_readonly("sets",
                             [](const SceneHandle& s) {
                               std::vector<std::string> files;
                               for (const ParameterSet& set : s.scene().sets) files.push_back(set.path);
                               return files;
                             })
      .def_property_readonly("grades", [](const SceneHandle& s) { return grades_of(s.scene()); })
      .def_property_readonly("relaxes",
                             [](const SceneHandle& s) { return s.scene().run.mode == RunOptions::Mode::relax; })
      .def_property_readonly("goal",
                             [](const SceneHandle& s) {
                               const RunOptions& run = s.scene().run;
                               return py::make_tuple(run.goal.force, run.goal.energy, run.max_steps);
                             })
      .def_property_readonly("time_step", [](const SceneHandle& s) { return s.model()->prepared.time_step; })
      .def_property_readonly("duration", [](const SceneHandle& s) { return s.model()->prepared.duration; })
      .def_property_readonly("spacing", [](const SceneHandle& s) { return s.model()->prepared.spacing; })
      .def_property_readonly("tube_begin",
                             [](const SceneHandle& s) { return s.model()->prepared.topology.tube_begin; })
      .def_property_readonly("tube_type",
                             [](const SceneHandle& s) { return s.model()->prepared.topology.tube_type; })
      .def_property_readonly(
          "radius", [](const SceneHandle& s) { return of_tubes(s, [](const TubeType& t) { return t.radius; }); })
      .def_property_readonly(
          "mass", [](const SceneHandle& s) { return of_tubes(s, [](const TubeType& t) { return t.mass; }); })
      .def_property_readonly("element_length", [](const SceneHandle& s) { return s.scene().element_length; })
      .def("refuse_missing_forces",
           [](const SceneHandle& s) { refuse_missing_forces(s.scene().missing_forces, s.scene().path); })
      .def("notes", notes_of)
      .def("start", start_of);
}

}  // namespace ropewalk::python
