// Atoms of elements as arrays, and elements of atoms that Python hands over frame by frame.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "exchange/atoms_of_state.hpp"
#include "exchange/coarsen.hpp"
#include "model/error.hpp"
#include "python/arrays.hpp"
#include "python/given_state.hpp"
#include "python/scene.hpp"
#include "python/simulation.hpp"
#include "run/events_file.hpp"
#include "scene/kinds/state.hpp"

namespace ropewalk::python {
namespace {

// --- Elements to atoms -----------------------------------------------------------------------------------

AtomSelection selection_of(const std::vector<int>& tubes, std::optional<double> from, std::optional<double> to) {
  AtomSelection out;
  out.tubes = tubes;
  out.from_nm = from;
  out.to_nm = to;
  return out;
}

// Positions (atoms, 3), and tube and element of each atom.
py::tuple arrays_of(const AtomicState& s, const AtomSelection& selection) {
  std::vector<TubeReference> references;
  for (const ParameterSet& set : s.sets) references.push_back(reference_of(set));
  const AtomsOfElements atoms(s.topology, s.state, std::move(references), selected_parts(s, selection),
                              s.broken);
  const auto n = static_cast<py::ssize_t>(atoms.count());
  py::array_t<double> position({n, py::ssize_t(3)});
  py::array_t<std::int64_t> tube(n), element(n);
  double* x = position.mutable_data();
  std::int64_t *of_tube = tube.mutable_data(), *of_element = element.mutable_data();
  {
    const py::gil_scoped_release release;
    atoms.for_each([&](const PlacedAtom& atom) {
      x = std::copy_n(atom.position.data(), 3, x);
      *of_tube++ = atom.tube;
      *of_element++ = atom.element;
    });
  }
  return py::make_tuple(position, tube, element);
}

AtomicState evaluated(const SingleState& state, const std::string& name) {
  const py::gil_scoped_release release;
  return state_of_file(state, name);
}

py::tuple atoms_in_scene(const SceneHandle& handle, const py::array_t<double>& position,
                         const py::array_t<double>& orientation, const std::vector<int>& broken,
                         const std::vector<int>& tubes, std::optional<double> from, std::optional<double> to) {
  const std::shared_ptr<const Model> model = handle.model();
  AtomicState s;
  s.sets = model->scene.sets;
  s.topology = model->prepared.topology;
  s.state = GivenState(s.topology.tube_begin, position, orientation).state();
  s.broken = broken_flags(s.state.size(), broken);
  return arrays_of(s, selection_of(tubes, from, to));
}

std::vector<int> numbers_of(const std::vector<char>& flags) {
  std::vector<int> out;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i]) out.push_back(static_cast<int>(i));
  return out;
}

// Elements behind which tubes have broken: at the start of a scene, in a run at `time` (ps), in a simulation now.
std::vector<int> broken_at_start(const SceneHandle& handle) { return handle.model()->scene.memory.broken; }

std::vector<int> broken_in_run(const std::string& events, const SceneHandle& handle, double time) {
  return numbers_of(StoredEvents(events, handle.model()->prepared.topology).broken_at(time));
}

std::vector<int> broken_now(const SteppedScene& stepped) {
  const std::vector<char>* broken = stepped.simulation().broken_bonds();
  return broken ? numbers_of(*broken) : std::vector<int>();
}

py::tuple atoms_of_state(const std::vector<int>& tube_begin, const py::array_t<double>& position,
                         const py::array_t<double>& orientation, double element_length, SingleState s,
                         const std::vector<int>& tubes, std::optional<double> from, std::optional<double> to) {
  s.source = std::make_shared<GivenState>(tube_begin, position, orientation);
  s.element_length = element_length;
  return arrays_of(evaluated(s, "the state"), selection_of(tubes, from, to));
}

py::tuple atoms_of_file(const std::string& path, SingleState s, const std::vector<int>& tubes,
                        std::optional<double> from, std::optional<double> to) {
  s.source = std::make_shared<StateSource>(path);
  return arrays_of(evaluated(s, path), selection_of(tubes, from, to));
}

// --- Atoms to elements -----------------------------------------------------------------------------------

// A function of Python that returns one frame after another, and None behind the last: positions (atoms, 3) in nm,
// velocities in nm/ps or None, the vectors of a box as rows in nm or None, whether the box is periodic along each
// of them or None, and the time in ps.
class FramesOfPython : public AtomSource {
 public:
  FramesOfPython(const py::function& next, std::vector<char> carbon, std::string name)
      : next_(next), carbon_(std::move(carbon)), name_(std::move(name)) {}

  bool next(AtomFrame& frame) override {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::object found = next_();
    if (found.is_none()) return false;
    const py::tuple parts = found;
    frame = AtomFrame();
    frame.positions = vectors(parts[0]);
    if (!parts[1].is_none()) frame.velocities = vectors(parts[1]);
    frame.species = carbon_;
    if (!parts[2].is_none()) {
      const py::array_t<double, py::array::c_style | py::array::forcecast> rows = parts[2].cast<py::array>();
      frame.box.edges = Eigen::Map<const Eigen::Matrix3d>(rows.data());  // columns, as Eigen stores them
      frame.box.periodic_known = !parts[3].is_none();
      frame.box.periodic = {true, true, true};
      if (frame.box.periodic_known) frame.box.periodic = parts[3].cast<std::array<bool, 3>>();
    }
    frame.time = parts[4].cast<double>();
    frame.step = number_++;
    return true;
  }
  const std::string& file() const override { return name_; }

 private:
  std::vector<Vector3> vectors(const py::handle& given) const {
    const py::array_t<double, py::array::c_style | py::array::forcecast> rows = given.cast<py::array>();
    if (rows.ndim() != 2 || rows.shape(1) != 3 || rows.shape(0) != static_cast<py::ssize_t>(carbon_.size()))
      throw InputError({name_, 0, ""}, "a frame has other atoms than the first one",
                       "give frames of one simulation, in which no atom comes or goes");
    std::vector<Vector3> out(carbon_.size());
    const double* from = rows.data();
    for (Vector3& v : out) {
      v = Vector3(from[0], from[1], from[2]);
      if (!v.allFinite()) throw InputError({name_, 0, ""}, "a position or velocity is not finite", "mend the frame");
      from += 3;
    }
    return out;
  }

  const py::function& next_;  // which is not given back without the lock of the interpreter
  std::vector<char> carbon_;
  std::string name_;
  std::int64_t number_ = 0;
};

class Teller : public RunListener {
 public:
  explicit Teller(const py::function& tell) : tell_(tell) {}
  void tell(const std::string& line) override {
    const py::gil_scoped_acquire acquire;
    tell_(line);
  }

 private:
  const py::function& tell_;
};

// Makes the directory of a run.
void coarsen(const CoarsenSettings& settings, const std::string& out, bool force,
             std::unique_ptr<AtomSource> atoms, const py::function& tell) {
  const py::gil_scoped_release release;
  Teller teller(tell);
  Coarsening coarse(settings, std::move(atoms));
  write_coarse_run(coarse, settings, {out}, force, teller);
  if (coarse.cut_off()) teller.tell("the last frame is cut off and was left out");
}

void coarsen_files(const std::vector<std::string>& files, const std::string& out, bool force,
                   const std::vector<std::string>& parameters, double element_length, double time_step_fs,
                   const py::function& tell) {
  const CoarsenSettings settings{files, parameters, element_length, time_step_fs};
  coarsen(settings, out, force, std::make_unique<AtomFiles>(files, time_step_fs), tell);
}

void coarsen_frames(const py::function& next, const std::vector<bool>& carbon, const std::string& name,
                    const std::string& out, bool force, const std::vector<std::string>& parameters,
                    double element_length, const py::function& tell) {
  const CoarsenSettings settings{{name}, parameters, element_length, 1};
  std::vector<char> flags(carbon.begin(), carbon.end());
  coarsen(settings, out, force, std::make_unique<FramesOfPython>(next, std::move(flags), name), tell);
}

}  // namespace

void bind_atoms(py::module_& m) {
  m.def("atoms_in_scene", atoms_in_scene);
  m.def("broken_at_start", broken_at_start);
  m.def("broken_in_run", broken_in_run);
  m.def("broken_now", broken_now);
  m.def("atoms_of_state", atoms_of_state);
  m.def("atoms_of_file", atoms_of_file);
  m.def("coarsen_files", coarsen_files, py::arg("files"), py::arg("out"), py::arg("force"), py::arg("parameters"),
        py::arg("element_length"), py::arg("time_step_fs"), py::arg("tell"));
  m.def("coarsen_frames", coarsen_frames, py::arg("next"), py::arg("carbon"), py::arg("name"), py::arg("out"),
        py::arg("force"), py::arg("parameters"), py::arg("element_length"), py::arg("tell"));
}

}  // namespace ropewalk::python
