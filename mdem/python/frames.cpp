// The stored frames of a run. The one place that knows how they are read.
#include "io/frames.hpp"

#include <optional>

#include "model/error.hpp"
#include "python/arrays.hpp"
#include "python/scene.hpp"

namespace ropewalk::python {
namespace {

// Frames by number over a reader that only goes forward.
class FrameFile {
 public:
  FrameFile(const std::string& path, const SceneHandle& scene) : path_(path), model_(scene.model()) { rewind(); }

  long size() {
    if (!size_) {
      DumpReader reader(path_);
      DumpFrame frame;
      long count = 0;
      while (reader.next(model_->prepared.topology, frame)) ++count;
      size_ = count;
    }
    return *size_;
  }

  // Throws std::out_of_range behind the last.
  const DumpFrame& at(long number) {
    if (number == next_ - 1) return frame_;
    if (number < next_) rewind();
    while (next_ <= number) {
      if (!reader_->next(model_->prepared.topology, frame_)) {
        size_ = next_;
        throw std::out_of_range("there are " + std::to_string(next_) + " frames");
      }
      ++next_;
    }
    return frame_;
  }

  const Model& model() const { return *model_; }

 private:
  void rewind() {
    reader_ = std::make_unique<DumpReader>(path_);
    next_ = 0;
  }

  std::string path_;
  std::shared_ptr<const Model> model_;
  std::unique_ptr<DumpReader> reader_;
  long next_ = 0;  // the frame that the reader comes to
  DumpFrame frame_;
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
  const DumpFrame& f = file.at(number);
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
