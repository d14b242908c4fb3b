// The frames of a run: its elements against time. GSD is binary, with random access; the LAMMPS text dump is four
// times as large.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/frames/colours.hpp"
#include "io/frames/format.hpp"
#include "io/growing_file.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct StoredFrame {
  State state;             // velocities are not in the file: zero
  ElementColours colours;  // empty where the file has none
};

// Reads the frames one after another. A last frame that is incomplete, as after a kill, is left out.
class FrameReader {
 public:
  virtual ~FrameReader() = default;
  // False at the end of the file. Throws InputError where the file is damaged or of another scene.
  virtual bool next(const Topology& topology, StoredFrame& frame) = 0;
  // The number of whole frames. next() goes on with the frame that was sought, counted from 0 and at most count().
  virtual std::size_t count(const Topology& topology) = 0;
  virtual void seek(std::size_t frame) = 0;
  // Bytes, behind the frame just read.
  virtual std::uint64_t position() const = 0;
};
// Opens a file by its content, whatever its name.
std::unique_ptr<FrameReader> open_frames(const std::string& path);

// None where the file has no whole frame.
std::optional<StoredFrame> last_frame(const std::string& path, const Topology& topology);

// A file of frames that grows. Throws InputError where it cannot be written.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void write(const Topology& topology, const State& state, const ElementColours& colours) = 0;
  // Drops all that was written after this mark.
  virtual void cut(std::uint64_t keep) = 0;
  virtual void sync() = 0;
  virtual FileMark mark() const = 0;
};
// Makes the file, or cuts it back to `keep` bytes. `expected`: frames, about.
std::unique_ptr<FrameWriter> frame_writer(const std::string& path, FrameFormat format, std::uint64_t keep,
                                          std::size_t expected);

// Frames that replace a file once they are whole. The destructor removes an unfinished file.
class NewFrames {
 public:
  // They begin with the first bytes of `from`.
  NewFrames(const std::string& path, FrameFormat format, std::size_t expected, const std::string& from = "",
            std::uint64_t keep = 0);
  NewFrames(const NewFrames&) = delete;
  NewFrames& operator=(const NewFrames&) = delete;

  FrameWriter* operator->() { return writer_.get(); }
  void replace();

 private:
  struct Part {
    std::string name;
    bool renamed = false;
    ~Part();
  };

  std::string path_;
  Part part_;
  std::unique_ptr<FrameWriter> writer_;
};

// The format, by the name of the file.
FrameFormat format_of(const std::string& path);

}  // namespace ropewalk
