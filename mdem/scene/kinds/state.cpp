#include "scene/kinds/state.hpp"

#include <filesystem>

#include "scene/scene.hpp"
#include "scene/state_csv.hpp"

namespace ropewalk {

SceneKind state_kind() {
  using Key = KeyOf<StateSource>;
  const auto read_file = [](const TomlTable& t, const Scene& scene, StateSource& state) {
    state = StateSource((std::filesystem::path(scene.path).parent_path() / t.string("file")).string());
  };
  return scene_kind<StateSource>(
      {"state",
       "instead of [rope]: elements from a CSV file tube,x_nm,y_nm,z_nm,qw,qx,qy,qz, such as the final.csv of a "
       "run",
       {Key::custom("file", "", required("\"state.csv\""), "name of the file, which is looked for beside the scene",
                    read_file)},
       {}});
}

void StateSource::place(const Scene&, double, Random&, Topology& topology, State& state) const {
  read_state_csv(path_, topology, state);
}

}  // namespace ropewalk
