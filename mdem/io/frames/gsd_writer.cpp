#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/frames/gsd.hpp"
#include "io/frames/gsd_layout.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t names_slots = 16;
constexpr std::uint64_t chunks_of_a_frame = 5 + colour_columns.size();  // those that change, and the colours
constexpr std::uint64_t spare_frames = 64, most_expected = 4096;        // a long run moves its index

std::string_view bytes_of(const void* data, std::size_t bytes) { return {static_cast<const char*>(data), bytes}; }

std::string colour_chunk(const ColourColumn& c) { return "log/particles/" + std::string(c.column.name); }

// The chunks of one frame, one after another, as they will lie in the file.
class FrameChunks {
 public:
  FrameChunks(std::uint64_t frame, std::uint64_t begin) : frame_(frame), begin_(begin) {}

  template <class T>
  void add(std::size_t name, const std::vector<T>& values, std::uint32_t columns = 1) {
    GsdEntry e;
    e.frame = frame_;
    e.rows = values.size() / columns;
    e.columns = columns;
    e.location = static_cast<std::int64_t>(begin_ + bytes.size());
    e.name = static_cast<std::uint16_t>(name);
    e.type = gsd_type<T>;
    if (values.empty()) return;
    entries.push_back(e);
    bytes += bytes_of(values.data(), values.size() * sizeof(T));
  }
  // Words of one length, filled with zeros.
  void add_words(std::size_t name, const std::vector<std::string>& words) {
    std::size_t longest = 0;
    for (const std::string& w : words) longest = std::max(longest, w.size() + 1);
    std::vector<char> text(words.size() * longest, '\0');
    for (std::size_t k = 0; k < words.size(); ++k)
      std::copy(words[k].begin(), words[k].end(), text.begin() + static_cast<std::ptrdiff_t>(k * longest));
    add(name, text, static_cast<std::uint32_t>(longest));
  }

  std::string bytes;
  std::vector<GsdEntry> entries;

 private:
  std::uint64_t frame_, begin_;
};

// A closed cylinder along z.
std::string cylinder(double radius, double length) {
  constexpr int sides = 12;
  nlohmann::json vertices = nlohmann::json::array(), triangles = nlohmann::json::array();
  const auto rounded = [](double v) { return std::round(1e4 * v) / 1e4; };
  for (int k = 0; k < sides; ++k)
    for (const double z : {-0.5 * length, 0.5 * length}) {
      const double angle = 2 * units::pi * k / sides;
      vertices.push_back({rounded(radius * std::cos(angle)), rounded(radius * std::sin(angle)), rounded(z)});
    }
  for (int k = 0; k < sides; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % sides);
    triangles.push_back({a, b, a + 1});
    triangles.push_back({a + 1, b, b + 1});
    if (k == 0 || k == sides - 1) continue;  // the caps are fans from the first corner
    triangles.push_back({0, b, a});
    triangles.push_back({1, a + 1, b + 1});
  }
  return nlohmann::json{{"type", "Mesh"}, {"vertices", vertices}, {"indices", triangles}}.dump();
}

// Chunks that do not change stand in the first frame alone.
void add_topology(FrameChunks& chunks, const Topology& topology) {
  std::vector<std::uint32_t> type, bonds;
  std::vector<std::int32_t> tube;
  std::vector<float> mass;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      type.push_back(static_cast<std::uint32_t>(topology.tube_type[t]));
      tube.push_back(t);
      mass.push_back(static_cast<float>(topology.type_of(t).mass));
      if (e + 1 == topology.tube_begin[t + 1]) continue;
      bonds.push_back(static_cast<std::uint32_t>(e));
      bonds.push_back(static_cast<std::uint32_t>(e + 1));
    }
  std::vector<std::string> names, shapes;
  for (std::size_t k = 0; k < topology.types.size(); ++k) {
    names.push_back(fmt::format("tube-{}", k + 1));
    shapes.push_back(cylinder(topology.types[k].radius, topology.types[k].element_length));
  }
  chunks.add(gsd_N, std::vector<std::uint32_t>{static_cast<std::uint32_t>(type.size())});
  chunks.add_words(gsd_types, names);
  chunks.add(gsd_typeid, type);
  chunks.add(gsd_mass, mass);
  chunks.add(gsd_body, tube);
  chunks.add_words(gsd_shapes, shapes);
  if (bonds.empty()) return;
  chunks.add(gsd_bonds, std::vector<std::uint32_t>{static_cast<std::uint32_t>(bonds.size() / 2)});
  chunks.add_words(gsd_bond_types, {"bond"});
  chunks.add(gsd_bond_group, bonds, 2);
}

float box_edge(const Topology& topology, const State& state) {
  double farthest = 0;
  for (const auto* axis : {&state.position.x, &state.position.y, &state.position.z})
    for (const double v : *axis) farthest = std::max(farthest, std::fabs(v));
  return static_cast<float>(2 * (farthest + topology.largest_radius() + topology.longest_element()));
}

std::uint64_t size_of(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : size;
}

}  // namespace

GsdWriter::GsdWriter(const std::string& path, std::uint64_t keep, std::size_t expected)
    : file_(path, keep == 0 ? 0 : size_of(path)),
      expected_entries_(gsd_colours + colour_columns.size() +
                        chunks_of_a_frame * (2 * std::min<std::uint64_t>(expected, most_expected) + spare_frames)) {
  if (keep > 0) {
    const GsdReader there(path);
    header_ = there.header();
    entries_ = there.entries();
  }
  cut(keep);
}

void GsdWriter::begin() {
  header_ = {};
  entries_.clear();
  std::strncpy(header_.application, "Ropewalk", sizeof header_.application - 1);
  std::strncpy(header_.schema, "hoomd", sizeof header_.schema - 1);
  header_.names_location = sizeof header_;
  header_.names_allocated = names_slots;
  header_.index_location = header_.names_location + names_slots * slot_bytes;
  header_.index_allocated = expected_entries_;
  std::string names;
  for (const OutputColumn& c : gsd_fixed_chunks) names += std::string(c.name) + '\0';
  for (const ColourColumn& c : colour_columns) names += colour_chunk(c) + '\0';
  names.resize(names_slots * slot_bytes, '\0');
  std::string head(bytes_of(&header_, sizeof header_));
  head += names;
  head.resize(index_end(), '\0');
  file_.cut(0);
  file_.write(head);
  file_.tail_begins_at(index_end());
}

void GsdWriter::write(const Topology& topology, const State& state, const ElementColours& colours) {
  if (entries_.size() + gsd_colours + colour_columns.size() > header_.index_allocated)
    place_index(2 * header_.index_allocated);
  FrameChunks chunks(entries_.empty() ? 0 : entries_.back().frame + 1, file_.size());
  const float edge = box_edge(topology, state);
  std::vector<float> x(3 * state.size()), q(4 * state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector3 p = state.position[i];
    const Quaternion o = state.orientation[i];
    for (int k = 0; k < 3; ++k) x[3 * i + static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
    std::size_t k = 4 * i;
    for (const double v : {o.w(), o.x(), o.y(), o.z()}) q[k++] = static_cast<float>(v);
  }
  chunks.add(gsd_step, std::vector<std::uint64_t>{static_cast<std::uint64_t>(state.step)});
  chunks.add(gsd_box, std::vector<float>{edge, edge, edge, 0, 0, 0});
  if (entries_.empty()) add_topology(chunks, topology);
  chunks.add(gsd_position, x, 3);
  chunks.add(gsd_orientation, q, 4);
  chunks.add(gsd_time, std::vector<double>{state.time});
  for (std::size_t k = 0; k < colour_columns.size(); ++k) {
    if (!given(colours, colour_columns[k], state.size())) continue;
    const std::vector<double>& v = colours.*colour_columns[k].values;
    chunks.add(gsd_colours + k, std::vector<float>(v.begin(), v.end()));
  }
  const std::uint64_t before = file_.size();
  file_.write(chunks.bytes);
  try {
    // The frame is there from here on.
    file_.patch(header_.index_location + entries_.size() * sizeof(GsdEntry),
                bytes_of(chunks.entries.data(), chunks.entries.size() * sizeof(GsdEntry)));
  } catch (...) {
    file_.cut(before);
    throw;
  }
  entries_.insert(entries_.end(), chunks.entries.begin(), chunks.entries.end());
}

void GsdWriter::cut(std::uint64_t keep) {
  if (keep == 0) return begin();
  const std::size_t before = entries_.size();
  while (!entries_.empty()) {
    const GsdEntry& e = entries_.back();
    if (static_cast<std::uint64_t>(e.location) + e.rows * e.columns * gsd_type_bytes[e.type] <= keep) break;
    const std::uint64_t frame = e.frame;
    while (!entries_.empty() && entries_.back().frame == frame) entries_.pop_back();
  }
  if (index_end() > keep) {  // the index has moved since
    file_.cut(keep);
    return place_index(header_.index_allocated);
  }
  // Also those that a frame left which was not written to its end.
  const std::size_t most =
      std::min<std::size_t>(header_.index_allocated, before + gsd_colours + colour_columns.size());
  file_.patch(header_.index_location + entries_.size() * sizeof(GsdEntry),
              std::string((most - entries_.size()) * sizeof(GsdEntry), '\0'));
  file_.cut(keep);
  file_.tail_begins_at(index_end());
}

// A new index at the end of the file. Where the old one was stays a gap.
void GsdWriter::place_index(std::uint64_t allocated) {
  const std::uint64_t at = file_.size();
  std::string block(bytes_of(entries_.data(), entries_.size() * sizeof(GsdEntry)));
  block.resize(allocated * sizeof(GsdEntry), '\0');
  file_.write(block);
  header_.index_location = at;
  header_.index_allocated = allocated;
  file_.patch(0, bytes_of(&header_, sizeof header_));
  file_.tail_begins_at(index_end());
}

std::vector<OutputColumn> gsd_chunks() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const ColourColumn& c : colour_columns) out.push_back(colour_chunk(c));
    return out;
  }();
  std::vector<OutputColumn> all(gsd_fixed_chunks.begin(), gsd_fixed_chunks.end());
  for (std::size_t k = 0; k < colour_columns.size(); ++k)
    all.push_back({names[k].c_str(), colour_columns[k].column.unit, colour_columns[k].column.meaning});
  return all;
}

}  // namespace ropewalk
