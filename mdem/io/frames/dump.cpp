#include "io/frames/dump.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <system_error>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

// Columns of every frame. OVITO maps those of place, orientation and shape to particle properties without the
// user's help. ASE has no use for mol, and finds the tube again as c_tube. MDAnalysis reads no ITEM: TIME.
constexpr std::array<OutputColumn, 15> fixed_columns = {{
    {"id", "", "element, from 1"},
    {"mol", "", "tube, from 1"},
    {"type", "", "type of the tube, from 1"},
    {"x", "nm", "centre of the element"},
    {"y", "nm", "centre of the element"},
    {"z", "nm", "centre of the element"},
    {"c_orient[1]", "", "orientation, a unit quaternion: x"},
    {"c_orient[2]", "", "orientation: y"},
    {"c_orient[3]", "", "orientation: z"},
    {"c_orient[4]", "", "orientation: w"},
    {"c_shape[1]", "nm", "radius of the tube"},
    {"c_shape[2]", "nm", "radius of the tube"},
    {"c_shape[3]", "nm", "length of the element"},
    {"c_tube", "", "tube, from 1, as mol"},
    {"c_time_ps", "ps", "time of the frame"},
}};
enum Column { id, mol, type, x, y, z, qx, qy, qz, qw, needed, time = 14 };

// --- Dump, writing --------------------------------------------------------------------------------------

using Buffer = fmt::memory_buffer;

struct Box {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
};

Box box_of(const Topology& topology, const State& state) {
  Box box;
  for (std::size_t i = 0; i < state.size(); ++i) {
    box.low = box.low.cwiseMin(state.position[i]);
    box.high = box.high.cwiseMax(state.position[i]);
  }
  const Vector3 margin = Vector3::Constant(topology.largest_radius() + topology.longest_element());
  if (!box.low.allFinite() || !box.high.allFinite()) return {-margin, margin};
  return {box.low - margin, box.high + margin};
}

void append_head(Buffer& out, const Topology& topology, const State& state) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", state.step, state.size());
  const Box box = box_of(topology, state);
  fmt::format_to(to, "ITEM: BOX BOUNDS ff ff ff\n");
  for (int k = 0; k < 3; ++k) fmt::format_to(to, "{:.4f} {:.4f}\n", box.low[k], box.high[k]);
}

void append_columns(Buffer& out, const State& state, const ElementColours& colours) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "ITEM: ATOMS");
  fmt::format_to(to, " {}", column_names(fixed_columns, " "));
  for (const ColourColumn& column : colour_columns)
    if (given(colours, column, state.size())) fmt::format_to(to, " {}", column.in_dump);
  out.push_back('\n');
}

void append_element(Buffer& out, const Topology& topology, const State& state, int tube, std::size_t i) {
  const Vector3 p = state.position[i];
  const Quaternion q = state.orientation[i];
  const TubeType& type = topology.type_of(tube);
  fmt::format_to(std::back_inserter(out),
                 "{} {} {} {:.7f} {:.7f} {:.7f} {:.8f} {:.8f} {:.8f} {:.8f} {:.6g} {:.6g} {:.6g} {} {:.10g}", i + 1,
                 tube + 1, topology.tube_type[tube] + 1, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                 type.radius, type.radius, type.element_length, tube + 1, state.time);
}

// --- Dump, reading --------------------------------------------------------------------------------------

// Thrown and caught in this file: the dump ends within a frame.
struct CutOff {};

template <class T>
bool parse(std::string_view word, T& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && code == std::errc() && end == word.data() + word.size();
}

constexpr int not_there = -1;

// The columns of a frame: indices of the values in its lines.
struct Layout {
  std::vector<std::string> names;
  std::array<int, needed> fixed;
  std::array<int, colour_columns.size()> colour;
  int time = not_there;
};

}  // namespace

struct DumpReader::Impl {
  struct Begin {
    std::streamoff at;
    int line;
  };

  std::string path;
  std::ifstream file;
  std::string line;
  int number = 0;
  std::vector<Begin> begins;  // where frames begin; empty until they are looked for
  Begin end{0, 0};

  InputError error(const std::string& column, const std::string& what, const char* remedy) const {
    return InputError({path, number, column}, what, remedy);
  }
  InputError garbled(const std::string& what) const {
    return error("", what, "the file was changed or damaged; restore it, or run the scene again");
  }

  Begin here() { return {file.tellg(), number}; }
  void find_begins() {
    begins.clear();
    go_to({0, 0});
    for (Begin at{0, 0}; read_line(); at = here())
      if (line == "ITEM: TIMESTEP") begins.push_back(at);
    file.clear();
    file.seekg(0, std::ios::end);
    end = here();
  }
  void go_to(const Begin& begin) {
    file.clear();
    file.seekg(begin.at);
    number = begin.line;
  }

  // A last line without a newline was cut off and is not read.
  bool read_line() {
    std::getline(file, line);
    if (file.bad()) throw error("", "cannot be read", "check the disk");
    if (file.eof()) return false;
    ++number;
    return true;
  }
  void need_line() {
    if (!read_line()) throw CutOff();
  }

  // Reads a line that must begin with this text; returns the rest.
  std::string_view item(const char* name) {
    need_line();
    return check_item(name);
  }
  std::string_view check_item(const char* name) const {
    const std::string expected = std::string("ITEM: ") + name;
    if (line.compare(0, expected.size(), expected) != 0)
      throw garbled(fmt::format("\"{}\" is needed here, \"{}\" is found", expected, printable(line, 40)));
    return std::string_view(line).substr(expected.size());
  }

  template <class T>
  T number_line(const char* what) {
    need_line();
    std::string_view rest = line;
    T value{};
    if (!parse(next_word(rest), value) || !next_word(rest).empty())
      throw garbled(fmt::format("\"{}\" is not a {}", printable(line, 40), what));
    return value;
  }

  void skip_box() {
    item("BOX BOUNDS");
    for (int k = 0; k < 3; ++k) {
      need_line();
      if (line.compare(0, 5, "ITEM:") == 0) throw garbled("three lines of box bounds are needed");
    }
  }

  Layout layout() {
    std::string_view rest = item("ATOMS");
    Layout l;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) l.names.emplace_back(word);
    const auto place = [&](const std::string& name) {
      for (std::size_t k = 0; k < l.names.size(); ++k)
        if (l.names[k] == name) return static_cast<int>(k);
      return not_there;
    };
    for (std::size_t k = 0; k < l.fixed.size(); ++k) {
      l.fixed[k] = place(fixed_columns[k].name);
      if (l.fixed[k] == not_there) throw garbled(fmt::format("column {} is missing", fixed_columns[k].name));
    }
    l.time = place(fixed_columns[time].name);
    for (std::size_t k = 0; k < l.colour.size(); ++k) {
      l.colour[k] = place(colour_columns[k].in_dump);
      if (l.colour[k] == not_there) l.colour[k] = place(colour_columns[k].column.name);  // as version 0.1 called it
    }
    return l;
  }

  void read_values(const Layout& l, std::vector<double>& values) {
    need_line();
    std::string_view rest = line;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::string_view word = next_word(rest);
      if (word.empty() || word == "ITEM:")
        throw garbled(fmt::format("the frame is truncated: {} columns are needed, {} are found", values.size(), k));
      if (!parse(word, values[k]))
        throw error(l.names[k], fmt::format("\"{}\" is not a number", printable(std::string(word), 40)),
                    "the file was changed or damaged; restore it, or run the scene again");
    }
    if (!next_word(rest).empty()) throw garbled(fmt::format("more than {} columns", values.size()));
  }

  // The element of a line. Every element must come once and with its own tube.
  std::size_t element(const Topology& topology, const Layout& l, const std::vector<double>& values,
                      std::vector<char>& seen) const {
    const double number = values[l.fixed[id]];
    if (!(number >= 1 && number <= topology.elements()) || number != std::floor(number))
      throw error("id", fmt::format("{} is no element of the scene", number),
                  "is this the dump of the run whose scene is read?");
    const int e = static_cast<int>(number) - 1;
    if (seen[e]) throw garbled(fmt::format("element {} comes twice in this frame", e + 1));
    seen[e] = 1;
    if (values[l.fixed[mol]] != topology.tube_of(e) + 1)
      throw error(
          "mol",
          fmt::format("element {} is of tube {}, not {}", e + 1, topology.tube_of(e) + 1, values[l.fixed[mol]]),
          "is this the dump of the run whose scene is read?");
    return static_cast<std::size_t>(e);
  }

  void place(const Layout& l, const std::vector<double>& v, std::size_t i, StoredFrame& frame) const {
    const Vector3 p(v[l.fixed[x]], v[l.fixed[y]], v[l.fixed[z]]);
    const Quaternion q(v[l.fixed[qw]], v[l.fixed[qx]], v[l.fixed[qy]], v[l.fixed[qz]]);
    if (!p.allFinite()) throw garbled(fmt::format("the position of element {} is not finite", i + 1));
    if (!(std::abs(q.norm() - 1.0) < 1e-3))
      throw garbled(fmt::format("c_orient of element {} has the norm {:.4g}, 1 is needed", i + 1, q.norm()));
    frame.state.position.set(i, p);
    frame.state.orientation.set(i, q.normalized());  // its digits are rounded
    for (std::size_t k = 0; k < l.colour.size(); ++k)
      if (l.colour[k] != not_there) (frame.colours.*colour_columns[k].values)[i] = v[l.colour[k]];
    if (l.time != not_there) frame.state.time = v[l.time];
  }

  // True where the time is here, as version 0.1 wrote it.
  bool read_head(const Topology& topology, StoredFrame& frame) {
    frame.state.step = number_line<std::int64_t>("step");
    need_line();
    const bool timed = line == "ITEM: TIME";
    if (timed) {
      frame.state.time = number_line<double>("time");
      need_line();
    }
    check_item("NUMBER OF ATOMS");
    const auto n = number_line<std::int64_t>("number of elements");
    if (n != topology.elements())
      throw error("", fmt::format("the frame has {} elements, the scene has {}", n, topology.elements()),
                  "is this the dump of the run whose scene is read?");
    skip_box();
    return timed;
  }

  void read_frame(const Topology& topology, StoredFrame& frame) {
    frame.state = State(static_cast<std::size_t>(topology.elements()));
    frame.colours = {};
    const bool timed = read_head(topology, frame);
    const Layout l = layout();
    if (!timed && l.time == not_there) throw garbled(fmt::format("column {} is missing", fixed_columns[time].name));
    for (std::size_t k = 0; k < l.colour.size(); ++k)
      if (l.colour[k] != not_there) (frame.colours.*colour_columns[k].values).resize(frame.state.size());
    std::vector<double> values(l.names.size());
    std::vector<char> seen(frame.state.size(), 0);
    for (int k = 0; k < topology.elements(); ++k) {
      read_values(l, values);
      place(l, values, element(topology, l, values, seen), frame);
    }
  }
};

DumpReader::DumpReader(const std::string& path) {
  impl_.reset(new Impl{path, opened_stream(path), "", 0, {}, {0, 0}});
}

DumpReader::~DumpReader() = default;

bool DumpReader::next(const Topology& topology, StoredFrame& frame) {
  try {
    if (!impl_->read_line()) return false;
    impl_->check_item("TIMESTEP");
    StoredFrame read;
    impl_->read_frame(topology, read);
    frame = std::move(read);
    return true;
  } catch (const CutOff&) {
    return false;
  }
}

std::size_t DumpReader::count(const Topology& topology) {
  const Impl::Begin here = impl_->here();
  impl_->find_begins();
  std::size_t whole = impl_->begins.size();
  if (whole > 0) {
    StoredFrame last;
    impl_->go_to(impl_->begins.back());
    if (!next(topology, last)) --whole;
  }
  impl_->go_to(here);
  return whole;
}

void DumpReader::seek(std::size_t frame) {
  if (impl_->begins.empty()) impl_->find_begins();
  const std::size_t frames = impl_->begins.size();
  impl_->go_to(frame < frames ? impl_->begins[frame] : impl_->end);
}

std::uint64_t DumpReader::position() const { return static_cast<std::uint64_t>(impl_->file.tellg()); }

std::string dump_frame(const Topology& topology, const State& state, const ElementColours& colours) {
  Buffer out;
  append_head(out, topology, state);
  append_columns(out, state, colours);
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      append_element(out, topology, state, t, i);
      for (const ColourColumn& column : colour_columns)
        if (given(colours, column, state.size()))
          fmt::format_to(std::back_inserter(out), " {:.6g}", (colours.*column.values)[i]);
      out.push_back('\n');
    }
  return fmt::to_string(out);
}

std::vector<OutputColumn> frame_columns() {
  std::vector<OutputColumn> columns(fixed_columns.begin(), fixed_columns.end());
  for (const ColourColumn& c : colour_columns) columns.push_back({c.in_dump, c.column.unit, c.column.meaning});
  return columns;
}

}  // namespace ropewalk
