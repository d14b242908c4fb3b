#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "io/files.hpp"
#include "io/frames/gsd.hpp"
#include "io/frames/gsd_layout.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr const char* damaged = "the file was changed or damaged; restore it, or run the scene again";

std::uint64_t bytes_of(const GsdEntry& e) { return e.rows * e.columns * gsd_type_bytes[e.type]; }
std::uint64_t end_of(const GsdEntry& e) { return static_cast<std::uint64_t>(e.location) + bytes_of(e); }

// Whether a chunk of such a size lies within the file, without a number that overflows.
bool lies_within(const GsdEntry& e, std::uint64_t size) {
  if (e.type == 0 || e.type >= gsd_type_bytes.size() || e.location < 0) return false;
  const auto location = static_cast<std::uint64_t>(e.location);
  if (location > size || e.columns == 0) return false;
  return e.rows <= (size - location) / e.columns / gsd_type_bytes[e.type];
}

}  // namespace

bool is_gsd(const std::string& path) {
  const Descriptor file = opened_to_read(path);
  std::uint64_t magic = 0;
  return ::pread(file.get(), &magic, sizeof magic, 0) == sizeof magic && magic == GsdHeader().magic;
}

GsdReader::GsdReader(const std::string& path) : path_(path), file_(opened_to_read(path)) {
  struct stat status;
  if (::fstat(file_.get(), &status) != 0) throw file_error(path, "cannot be read", errno);
  size_ = static_cast<std::uint64_t>(status.st_size);
  if (size_ < sizeof header_) fail("", "the header is not whole");
  read_at(0, &header_, sizeof header_);
  if (header_.magic != GsdHeader().magic || header_.version >> 16 != 2) fail("", "is not a GSD file of version 2");
  read_index();
}

void GsdReader::fail(const std::string& chunk, const std::string& what) const {
  throw InputError({path_, 0, chunk}, what, damaged);
}

void GsdReader::read_at(std::uint64_t at, void* to, std::uint64_t bytes) const {
  for (auto* next = static_cast<char*>(to); bytes > 0;) {
    const ssize_t n = uninterrupted([&] { return ::pread(file_.get(), next, bytes, static_cast<off_t>(at)); });
    if (n < 0) throw file_error(path_, "cannot be read", errno);
    if (n == 0) fail("", fmt::format("ends before byte {}", at + bytes));
    next += n;
    at += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::uint64_t>(n);
  }
}

void GsdReader::read_index() {
  const auto block = [&](std::uint64_t location, std::uint64_t count, std::uint64_t bytes) {
    return location <= size_ && count <= (size_ - location) / bytes;
  };
  if (!block(header_.names_location, header_.names_allocated, slot_bytes) ||
      !block(header_.index_location, header_.index_allocated, sizeof(GsdEntry)))
    fail("", "ends before its index");
  std::string names(header_.names_allocated * slot_bytes, '\0');
  read_at(header_.names_location, names.data(), names.size());
  for (std::size_t at = 0; at < names.size() && names[at] != '\0'; at += names_.back().size() + 1)
    names_.emplace_back(names.c_str() + at);
  entries_.resize(header_.index_allocated);
  read_at(header_.index_location, entries_.data(), entries_.size() * sizeof(GsdEntry));
  std::size_t used = 0, frames = 0;
  for (; used < entries_.size() && entries_[used].location != 0; ++used) {
    const GsdEntry& e = entries_[used];
    if (e.frame < frames || e.frame > frames + (used > 0 ? 1 : 0)) fail("", "its index is out of order");
    if (e.frame > frames) frame_begin_.push_back(used);
    frames = e.frame;
    if (!lies_within(e, size_)) break;  // the frame was not written to its end
  }
  const bool whole = used == entries_.size() || entries_[used].location == 0;
  if (whole && used > 0) frame_begin_.push_back(used);
  entries_.resize(frame_begin_.back());
}

const GsdEntry* GsdReader::find(std::size_t k, const std::string& chunk) const {
  const auto name = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), chunk) - names_.begin());
  for (const std::size_t frame : {k, std::size_t{0}})
    for (std::size_t e = frame_begin_[frame]; e < frame_begin_[frame + 1]; ++e)
      if (entries_[e].name == name) return &entries_[e];
  return nullptr;
}

template <class T>
std::vector<T> GsdReader::values(std::size_t k, const std::string& chunk, std::uint64_t rows, std::uint32_t columns,
                                 bool* there) const {
  const GsdEntry* e = find(k, chunk);
  if (there) *there = e != nullptr;
  if (!e && there) return {};
  if (!e) fail(chunk, fmt::format("is missing in frame {}", k));
  if (e->type != gsd_type<T> || e->rows != rows || e->columns != columns)
    fail(chunk, fmt::format("has {} x {} values in frame {}, {} x {} are needed, of type {}", e->rows, e->columns,
                            k, rows, columns, gsd_type<T>));
  std::vector<T> out(rows * columns);
  read_at(static_cast<std::uint64_t>(e->location), out.data(), out.size() * sizeof(T));
  return out;
}

void GsdReader::read(const Topology& topology, std::size_t k, StoredFrame& frame) {
  const auto n = static_cast<std::uint64_t>(topology.elements());
  if (const std::uint32_t here = values<std::uint32_t>(k, "particles/N", 1, 1).front(); here != n)
    throw InputError({path_, 0, "particles/N"}, fmt::format("the frame has {} elements, the scene has {}", here, n),
                     "are these the frames of the run whose scene is read?");
  StoredFrame read{State(n), {}};
  read.state.step = static_cast<std::int64_t>(values<std::uint64_t>(k, "configuration/step", 1, 1).front());
  read.state.time = values<double>(k, "log/time_ps", 1, 1).front();
  const std::vector<std::int32_t> tube = values<std::int32_t>(k, "particles/body", n, 1);
  const std::vector<float> x = values<float>(k, "particles/position", n, 3),
                           q = values<float>(k, "particles/orientation", n, 4);
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      if (tube[i] != t)
        throw InputError({path_, 0, "particles/body"},
                         fmt::format("element {} is of tube {}, not {}", i, t, tube[i]),
                         "are these the frames of the run whose scene is read?");
      const Vector3 p(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      const Quaternion o(q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]);
      if (!p.allFinite())
        fail("particles/position", fmt::format("that of element {} in frame {} is not finite", i, k));
      if (!(std::abs(o.norm() - 1.0) < 1e-3))
        fail("particles/orientation",
             fmt::format("that of element {} in frame {} has the norm {:.4g}, 1 is needed", i, k, o.norm()));
      read.state.position.set(i, p);
      read.state.orientation.set(i, o.normalized());  // its digits are rounded
    }
  for (const ColourColumn& c : colour_columns) {
    bool there = false;
    const std::vector<float> v = values<float>(k, "log/particles/" + std::string(c.column.name), n, 1, &there);
    if (there) (read.colours.*c.values).assign(v.begin(), v.end());
  }
  frame = std::move(read);
  position_ = 0;
  for (std::size_t e = frame_begin_[k]; e < frame_begin_[k + 1]; ++e)
    position_ = std::max(position_, end_of(entries_[e]));
}

bool GsdReader::next(const Topology& topology, StoredFrame& frame) {
  if (next_ == count()) return false;
  read(topology, next_++, frame);
  return true;
}

}  // namespace ropewalk
