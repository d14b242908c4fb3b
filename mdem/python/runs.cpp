// Runs in this process, as `ropewalk run` and `resume` do them: the same files, stop reasons and messages.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "model/error.hpp"
#include "python/own_force.hpp"
#include "python/scene.hpp"
#include "run/begin_run.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk::python {
namespace {

// Passes remarks and progress on. Signals of Python, and whatever its functions raise, ask the run for an end, and
// are raised behind it.
class PythonListener : public RunListener {
 public:
  PythonListener(py::object tell, py::object progress) : tell_(std::move(tell)), progress_(std::move(progress)) {}

  void tell(const std::string& line) override {
    call([&] { tell_(line); });
  }

  std::string asked_to_stop() override {
    if (asked_.empty() && is_time(looked_, patience))
      call([] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      });
    return asked_;
  }

  void begin_loop(double, double total) override { total_ = total; }
  bool wants_progress() override { return shows_ && is_time(shown_, between_lines); }
  void progress(double done, const std::string& status) override {
    call([&] { progress_(static_cast<std::int64_t>(done), static_cast<std::int64_t>(total_), status); });
  }

  void raise_what_was_raised() {
    if (raised_) throw std::move(*raised_);
  }

 private:
  static constexpr double patience = 0.1, between_lines = 0.5;  // s

  static bool is_time(double& last, double interval) {
    const double now = steady_seconds();
    if (now - last < interval) return false;
    last = now;
    return true;
  }

  template <class Function>
  void call(Function function) {
    const py::gil_scoped_acquire acquire;
    try {
      function();
    } catch (py::error_already_set& e) {
      if (raised_) return;
      // Ctrl-C is what the program calls a signal 2.
      asked_ = e.matches(PyExc_KeyboardInterrupt) ? "by signal 2"
                                                  : "by " + e.type().attr("__name__").cast<std::string>();
      raised_.emplace(std::move(e));
    }
  }

  py::object tell_, progress_;
  bool shows_ = !progress_.is_none();
  double looked_ = steady_seconds(), shown_ = 0, total_ = 0;
  std::string asked_;
  std::optional<py::error_already_set> raised_;
};

struct InstructionsAsBefore {
  VectorUnit before = vector_unit_in_use();
  ~InstructionsAsBefore() { use_vector_unit(before); }
};

struct ThreadsAsBefore {
  int before = threads_in_use();
  ~ThreadsAsBefore() { use_threads(before); }
};

struct Asked {
  std::optional<std::int64_t> steps;
  std::optional<double> until_ps;
  std::optional<int> threads;
  std::string on_limit;
  std::optional<double> wall_time_s;
  std::string instructions, device;
  py::object tell, progress;
  std::vector<py::function> forces;
};

template <class Settings>
Settings settings_of(const Asked& a) {
  if (a.steps && a.until_ps) throw InputError({"", 0, "steps"}, "does not go with until_ps", "give one of them");
  if (a.steps && *a.steps < 0)
    throw InputError({"", 0, "steps"}, fmt::format("is {}", *a.steps), "take a whole number from 0");
  if (a.until_ps && !(*a.until_ps >= 0 && std::isfinite(*a.until_ps)))
    throw InputError({"", 0, "until_ps"}, fmt::format("is {}", *a.until_ps), "take a time from 0");
  if (a.threads && (*a.threads < 1 || *a.threads > most_threads))
    throw InputError({"", 0, "threads"}, fmt::format("is {}", *a.threads),
                     fmt::format("take a whole number from 1 to {}", most_threads));
  if (a.wall_time_s && !(*a.wall_time_s > 0 && std::isfinite(*a.wall_time_s)))
    throw InputError({"", 0, "wall_time_s"}, fmt::format("is {}", *a.wall_time_s), "take a time above 0");
  Settings s;
  s.steps = a.steps.value_or(-1);
  s.until_ps = a.until_ps.value_or(-1);
  s.on_limit = on_limit_of(a.on_limit);
  s.device = a.device;
  s.wall_time.allowed = a.wall_time_s.value_or(0);
  return s;
}

// `begin`: makes the run. Throws what Python raised on the way, or what the run failed with.
template <class Begin>
void go(const Asked& asked, Begin begin) {
  PythonListener listener(asked.tell, asked.progress);
  RunResult result;
  {
    const py::gil_scoped_release release;
    const ThreadsAsBefore threads;
    const InstructionsAsBefore instructions;
    use_threads(asked.threads.value_or(0));
    result = go_through(begin(listener));
    if (result.end == RunEnd::failed)
      listener.tell(fmt::format("state written to {}", result.directory.failed_state()));
    if (result.end == RunEnd::broken_off)
      listener.tell(asked.forces.empty()
                        ? fmt::format("ended at step {}; resume {} goes on", result.steps, result.directory.path)
                        : fmt::format("ended at step {}; ropewalk.resume(\"{}\", forces=...) goes on", result.steps,
                                      result.directory.path));
    if (result.end == RunEnd::not_relaxed || result.end == RunEnd::at_limit || result.end == RunEnd::wall_time)
      listener.tell(result.remedy.empty() ? result.reason : result.reason + "; " + result.remedy);
  }
  listener.raise_what_was_raised();
  if (result.error) std::rethrow_exception(result.error);
  if (result.end == RunEnd::incomplete)
    throw InputError({result.directory.path, 0, ""}, "is done, but for " + result.missing,
                     "resume it to write them");
}

std::vector<OwnForceOfRun> own_forces(const Asked& asked, Scene scene) {
  if (asked.forces.empty()) return {};
  return OwnForce::of_run(asked.forces, prepare(scene).state);
}

void run(const SceneHandle& scene, const std::string& out, bool force, const Asked& asked) {
  auto settings = settings_of<RunSettings>(asked);
  settings.force = force;
  settings.own_forces = own_forces(asked, scene.scene());
  go(asked, [&](RunListener& listener) {
    if (!asked.instructions.empty() && !use_instructions(asked.instructions))
      throw InputError({"", 0, "instructions"}, fmt::format("there is no \"{}\" here", asked.instructions),
                       fmt::format("take one of {}", fmt::join(instruction_sets(), ", ")));
    return begin_run(scene.scene(), {out}, settings, listener);
  });
}

void resume(const std::string& directory, bool accept_changes, const Asked& asked) {
  auto settings = settings_of<ResumeSettings>(asked);
  settings.accept_changes = accept_changes;
  if (!asked.forces.empty()) settings.own_forces = own_forces(asked, read_run_scene({directory}));
  go(asked, [&](RunListener& listener) { return resume_run({directory}, settings, listener); });
}

}  // namespace

void bind_runs(py::module_& m) {
  py::class_<Asked>(m, "RunOptions")
      .def(py::init([](std::optional<std::int64_t> steps, std::optional<double> until_ps,
                       std::optional<int> threads, const std::string& on_limit, std::optional<double> wall_time_s,
                       const std::string& instructions, const std::string& device, const py::object& tell,
                       const py::object& progress, std::vector<py::function> forces) {
             return Asked{steps,        until_ps, threads, on_limit, wall_time_s,
                          instructions, device,   tell,    progress, std::move(forces)};
           }),
           py::arg("steps"), py::arg("until_ps"), py::arg("threads"), py::arg("on_limit"), py::arg("wall_time_s"),
           py::arg("instructions"), py::arg("device"), py::arg("tell"), py::arg("progress"), py::arg("forces"));
  m.def("run", run, py::arg("scene"), py::arg("out"), py::arg("force"), py::arg("options"));
  m.def("resume", resume, py::arg("directory"), py::arg("accept_changes"), py::arg("options"));
}

}  // namespace ropewalk::python
