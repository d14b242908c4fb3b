// The stored frames of a run.
#include "io/frames/frames.hpp"

#include <optional>

#include "model/error.hpp"
#include "python/arrays.hpp"
#include "python/scene.hpp"

namespace ropewalk::python {
namespace {

// Frames by number; the last one that was read is kept.
class FrameFile {
 public:
  FrameFile(const std::string& path, const SceneHandle& scene)
      : model_(scene.model()), reader_(open_frames(path)) {}

  long size() {
    if (!size_) size_ = static_cast<long>(reader_->count(model_->prepared.topology));
    return *size_;
  }

  // Throws std::out_of_range behind the last.
  const StoredFrame& at(long number) {
    if (number == read_) return frame_;
    reader_->seek(static_cast<std::size_t>(number));
    if (!reader_->next(model_->prepared.topology, frame_))
      throw std::out_of_range("there are " + std::to_string(size()) + " frames");
    read_ = number;
    return frame_;
  }

  const Model& model() const { return *model_; }

 private:
  std::shared_ptr<const Model> model_;
  std::unique_ptr<FrameReader> reader_;
  StoredFrame frame_;
  long read_ = -1;
  std::optional<long> size_;
};

py::dict colours_of(const ElementColours& colours) {
  py::dict out;
  const auto add = [&](const char* name, const std::vector<double>& values) {
    if (!values.empty()) out[name] = array_of(values);
  };
  add("bond_energy", colours.bond_energy);
  add("vdw_energy", colours.vdw_energy);
  add("bending_moment", colours.bending_moment);
  add("twist_angle", colours.twist_angle);
  return out;
}

py::tuple frame_at(FrameFile& file, long number) {
  const StoredFrame& f = file.at(number);
  return py::make_tuple(f.state.step, f.state.time, copy_of(f.state.position), copy_of(f.state.orientation),
                        colours_of(f.colours));
}

}  // namespace

void bind_frames(py::module_& m) {
  py::class_<FrameFile>(m, "Frames")
      .def(py::init<const std::string&, const SceneHandle&>())
      .def("__len__", &FrameFile::size)
      .def("at", frame_at)
      .def("measure", [](FrameFile& file, long number) {
        return file.model().measure(file.at(number).state, EnergyAccount());
      });
}

}  // namespace ropewalk::python
