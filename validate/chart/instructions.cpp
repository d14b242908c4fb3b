// Instructions of a step, counted by callgrind: a cost that does not depend on the load of the machine.
// The program runs itself under callgrind and marks where the steps begin and end; the start is not counted and
// runs ten times as fast. Valgrind emulates a processor with AVX2 but without AVX-512, so that the kernels take
// their AVX2 versions, with about twice the instructions of the AVX-512 ones. The steps are the first of the
// protocol: the rope is not yet twisted.
#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "chart/chart.hpp"
#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"

namespace ropewalk::validate {
namespace {

namespace fs = std::filesystem;

constexpr double wanted_element_steps = 6000;
constexpr long min_steps = 12, whole_steps = 12;

// Reads "==12== Collected : 123456"; none where callgrind did not finish.
std::optional<double> collected(const std::string& path) {
  if (!fs::exists(path)) return {};
  std::istringstream text(read_file(path));
  for (std::string line; std::getline(text, line);) {
    const std::size_t at = line.find("Collected : ");
    if (at != std::string::npos) return std::stod(line.substr(at + 12));
  }
  return {};
}

std::optional<double> counted(const std::string& scene, const std::string& model, long steps) {
  const TemporaryFolder folder;
  ChildOptions options;
  options.folder = folder.path();
  options.output = folder.file("callgrind.txt");
  options.quiet_seconds = options.max_seconds = 600;
  const std::vector<std::string> arguments = {"valgrind",
                                              "--tool=callgrind",
                                              "--instr-atstart=no",
                                              "--callgrind-out-file=/dev/null",
                                              fs::read_symlink("/proc/self/exe").string(),
                                              "chart-steps",
                                              scene,
                                              model,
                                              std::to_string(steps)};
  const ChildEnd end = run_child(arguments, options);
  return end.kind == ChildEnd::Kind::exited && end.code == 0 ? collected(options.output) : std::nullopt;
}

}  // namespace

void count_from_here() {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
}
void count_to_here() { CALLGRIND_STOP_INSTRUMENTATION; }

std::optional<double> count_instructions(const ChartScene& scene, const ChartModel& model) {
  const double elements = scene.build(model).topology.elements();
  const long steps =
      std::max(min_steps, whole_steps * static_cast<long>(wanted_element_steps / elements / whole_steps));
  const std::optional<double> count = counted(scene.name, model.name, steps);
  if (!count) return {};
  return *count / (static_cast<double>(steps) * elements);
}

}  // namespace ropewalk::validate
