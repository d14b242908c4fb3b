#include "io/frames/frames.hpp"

#include <unistd.h>

#include <filesystem>

#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/frames/dump.hpp"
#include "io/frames/gsd.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

class DumpWriter : public FrameWriter {
 public:
  DumpWriter(const std::string& path, std::uint64_t keep) : file_(path, keep) {}
  void write(const Topology& topology, const State& state, const ElementColours& colours) override {
    file_.write(dump_frame(topology, state, colours));
  }
  void cut(std::uint64_t keep) override { file_.cut(keep); }
  void sync() override { file_.sync(); }
  FileMark mark() const override { return file_.mark(); }

 private:
  GrowingFile file_;
};

}  // namespace

std::unique_ptr<FrameReader> open_frames(const std::string& path) {
  refuse_devices(path);
  if (is_gsd(path)) return std::make_unique<GsdReader>(path);
  return std::make_unique<DumpReader>(path);
}

std::optional<StoredFrame> last_frame(const std::string& path, const Topology& topology) {
  const auto reader = open_frames(path);
  const std::size_t frames = reader->count(topology);
  if (frames == 0) return {};
  StoredFrame frame;
  reader->seek(frames - 1);
  reader->next(topology, frame);
  return frame;
}

std::unique_ptr<FrameWriter> frame_writer(const std::string& path, FrameFormat format, std::uint64_t keep,
                                          std::size_t expected) {
  if (format == FrameFormat::gsd) return std::make_unique<GsdWriter>(path, keep, expected);
  return std::make_unique<DumpWriter>(path, keep);
}

NewFrames::NewFrames(const std::string& path, FrameFormat format, std::size_t expected, const std::string& from,
                     std::uint64_t keep)
    : path_(path), part_{new_part_of(path)} {
  std::error_code error;
  if (keep > 0 && !fs::copy_file(from, part_.name, fs::copy_options::overwrite_existing, error))
    throw file_error(from, "cannot be copied", error.value());
  writer_ = frame_writer(part_.name, format, keep, expected);
}

NewFrames::Part::~Part() {
  if (!renamed) ::unlink(name.c_str());
}

void NewFrames::replace() {
  writer_->sync();
  rename_whole(part_.name, path_);
  part_.renamed = true;
  writer_.reset();
}

FrameFormat format_of(const std::string& path) {
  const std::string end = ".lammpstrj";
  return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0
             ? FrameFormat::dump
             : FrameFormat::gsd;
}

}  // namespace ropewalk
