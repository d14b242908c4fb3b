#include "run/stages.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "io/files.hpp"
#include "scene/finer.hpp"
#include "scene/state_csv.hpp"
#include "sim/dynamics/refine.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// The path without a slash at its end, and with the name of the directory for ".".
fs::path plain(const std::string& path) {
  fs::path p = fs::path(path).lexically_normal();
  if (p.filename().empty()) p = p.parent_path();
  if (p.filename() == "." || p.filename() == "..") p = fs::weakly_canonical(fs::absolute(p));
  return p;
}

}  // namespace

std::string name_of(const RunDirectory& dir) { return plain(dir.path).filename().string(); }

std::string stage_of(const RunDirectory& dir) {
  const std::string name = name_of(dir), mark = ".fine";
  const std::size_t at = name.rfind(mark);
  if (at == std::string::npos) return "";
  const std::string number = name.substr(at + mark.size());
  const bool ours = number.size() <= 3 && number.find_first_not_of("0123456789") == std::string::npos;
  return ours ? name.substr(at) : "";
}

RunDirectory finer_directory(const RunDirectory& dir) {
  const std::string path = plain(dir.path).string(), mark = ".fine", stage = stage_of(dir);
  if (stage.empty()) return {path + mark};
  const int number = stage == mark ? 1 : std::atoi(stage.c_str() + mark.size());
  return {fmt::format("{}{}{}", path.substr(0, path.size() - stage.size()), mark, number + 1)};
}

DirectoryLock write_finer_scene(const RunDirectory& from, const Scene& scene, const Prepared& prepared, double time,
                                bool force) {
  const RunDirectory to = finer_directory(from);
  const std::string text = finer_scene_text(
      scene, prepared,
      fmt::format("Made by ropewalk at {:.6g} ps of the run {}: every element split in two.", time, name_of(from)));
  DirectoryLock lock = create_run_directory(to, force || !has_checkpoint(to));
  write_file_atomically(to.scene(), text);
  copy_parameters(scene, to);
  const Splitting how = splitting_of(scene);
  if (scene.from_file())
    write_file_atomically(
        to.state(), state_csv(halved(prepared.topology, how), halved(prepared.topology, prepared.state, how)));
  return lock;
}

}  // namespace ropewalk
