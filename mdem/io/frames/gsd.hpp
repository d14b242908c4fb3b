// Frames in HOOMD's GSD format, which OVITO (tubes as meshes along the local z of the elements), MDAnalysis and the
// Python package gsd open. A file has a header, names of chunks, an index and, behind it, the chunks of the frames,
// one after another: it grows at its end, but for the entries of the index. Whatever a kill leaves is a whole file.
//
// Layout of the file, version 2, and schema "hoomd" 1.4: documentation of gsd, section file layer and schema.
// Lengths are in nm, energies in eV.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "io/frames/frames.hpp"

namespace ropewalk {

// At the begin of the file.
struct GsdHeader {
  std::uint64_t magic = 0x65DF65DF65DF65DF;
  std::uint64_t index_location = 0, index_allocated = 0;  // bytes, entries
  std::uint64_t names_location = 0, names_allocated = 0;  // bytes, slots
  std::uint32_t schema_version = 1 << 16 | 4;
  std::uint32_t version = 2 << 16;
  char application[64] = {}, schema[64] = {}, reserved[80] = {};
};
static_assert(sizeof(GsdHeader) == 256);
inline constexpr std::uint64_t slot_bytes = 64;  // bytes of a name

// The place of a chunk: rows times columns of a type. Entries of the index rise by frame, then by name; one with
// location 0 is free.
struct GsdEntry {
  std::uint64_t frame = 0, rows = 0;
  std::int64_t location = 0;
  std::uint32_t columns = 0;
  std::uint16_t name = 0;
  std::uint8_t type = 0, flags = 0;
};
static_assert(sizeof(GsdEntry) == 32);

bool is_gsd(const std::string& path);

// Throws InputError that names frame and chunk.
class GsdReader : public FrameReader {
 public:
  explicit GsdReader(const std::string& path);
  bool next(const Topology& topology, StoredFrame& frame) override;
  std::uint64_t position() const override { return position_; }

  std::size_t count(const Topology&) override { return count(); }
  std::size_t count() const { return frame_begin_.size() - 1; }
  void seek(std::size_t frame) override { next_ = std::min(frame, count()); }

  const GsdHeader& header() const { return header_; }
  const std::vector<GsdEntry>& entries() const { return entries_; }

 private:
  [[noreturn]] void fail(const std::string& chunk, const std::string& what) const;
  void read_index();
  void read_at(std::uint64_t at, void* to, std::uint64_t bytes) const;
  const GsdEntry* find(std::size_t k, const std::string& chunk) const;
  void read(const Topology& topology, std::size_t k, StoredFrame& frame);
  template <class T>
  std::vector<T> values(std::size_t k, const std::string& chunk, std::uint64_t rows, std::uint32_t columns,
                        bool* there = nullptr) const;

  std::string path_;
  Descriptor file_;
  GsdHeader header_;
  std::uint64_t size_ = 0, position_ = 0;
  std::vector<std::string> names_;
  std::vector<GsdEntry> entries_;            // entries of whole frames
  std::vector<std::size_t> frame_begin_{0};  // indices in entries_; one more than frames
  std::size_t next_ = 0;
};

class GsdWriter : public FrameWriter {
 public:
  GsdWriter(const std::string& path, std::uint64_t keep, std::size_t expected);
  void write(const Topology& topology, const State& state, const ElementColours& colours) override;
  void cut(std::uint64_t keep) override;
  void sync() override { file_.sync(); }
  FileMark mark() const override { return file_.mark(); }

 private:
  void begin();
  void place_index(std::uint64_t allocated);
  std::uint64_t index_end() const { return header_.index_location + header_.index_allocated * sizeof(GsdEntry); }

  GrowingFile file_;
  std::uint64_t expected_entries_;
  GsdHeader header_;
  std::vector<GsdEntry> entries_;
};

// Chunks of a frame, and of the first one alone.
std::vector<OutputColumn> gsd_chunks();

}  // namespace ropewalk
