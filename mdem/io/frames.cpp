#include "io/frames.hpp"

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

#include "io/base64.hpp"
#include "io/files.hpp"
#include "io/markup.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

// ASE keeps no column of a dump that it does not know, but for those that begin with c_.
struct ColourColumn {
  OutputColumn column;
  const char* in_dump;
  std::vector<double> ElementColours::*values;
};

constexpr std::array<ColourColumn, 4> colour_columns = {{
    {{"bond_energy_eV", "eV", "half of the energy of each bond of the element"},
     "c_bond_energy_eV",
     &ElementColours::bond_energy},
    {{"vdw_energy_eV", "eV", "half of the energy of each contact of the element"},
     "c_vdw_energy_eV",
     &ElementColours::vdw_energy},
    {{"bending_moment_eV", "eV", "bending moment: EI times curvature"},
     "c_bending_moment_eV",
     &ElementColours::bending_moment},
    {{"twist_angle_rad", "rad", "twist angle, mean of the bonds of the element"},
     "c_twist_angle_rad",
     &ElementColours::twist_angle},
}};

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

bool given(const ElementColours& colours, const ColourColumn& column, const State& state) {
  return state.size() > 0 && (colours.*column.values).size() == state.size();
}

void append_columns(Buffer& out, const State& state, const ElementColours& colours) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "ITEM: ATOMS");
  fmt::format_to(to, " {}", column_names(fixed_columns, " "));
  for (const ColourColumn& column : colour_columns)
    if (given(colours, column, state)) fmt::format_to(to, " {}", column.in_dump);
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

std::string_view next_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  text.remove_prefix(begin);
  const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

template <class T>
bool parse(std::string_view word, T& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && code == std::errc() && end == word.data() + word.size();
}

constexpr int not_there = -1;

// Where the columns of a frame stand: indices of the values in its lines.
struct Layout {
  std::vector<std::string> names;
  std::array<int, needed> fixed;
  std::array<int, colour_columns.size()> colour;
  int time = not_there;
};

}  // namespace

struct DumpReader::Impl {
  std::string path;
  std::ifstream file;
  std::string line;
  int number = 0;

  InputError error(const std::string& column, const std::string& what, const char* remedy) const {
    return InputError({path, number, column}, what, remedy);
  }
  InputError garbled(const std::string& what) const {
    return error("", what, "the file was changed or damaged; restore it, or run the scene again");
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

  void place(const Layout& l, const std::vector<double>& v, std::size_t i, DumpFrame& frame) const {
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
  bool read_head(const Topology& topology, DumpFrame& frame) {
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

  void read_frame(const Topology& topology, DumpFrame& frame) {
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
  refuse_devices(path);
  impl_.reset(new Impl{path, std::ifstream(path), "", 0});
  if (!impl_->file) throw file_error(path, "cannot be opened", errno);
}

DumpReader::~DumpReader() = default;

bool DumpReader::next(const Topology& topology, DumpFrame& frame) {
  try {
    if (!impl_->read_line()) return false;
    impl_->check_item("TIMESTEP");
    DumpFrame read;
    impl_->read_frame(topology, read);
    frame = std::move(read);
    return true;
  } catch (const CutOff&) {
    return false;
  }
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
        if (given(colours, column, state))
          fmt::format_to(std::back_inserter(out), " {:.6g}", (colours.*column.values)[i]);
      out.push_back('\n');
    }
  return fmt::to_string(out);
}

// --- VTK XML --------------------------------------------------------------------------------------------

namespace {

template <class T>
struct VtkType;
template <>
struct VtkType<float> {
  static constexpr const char* name = "Float32";
};
template <>
struct VtkType<std::int32_t> {
  static constexpr const char* name = "Int32";
};

// Without compression VTK encodes the length, a UInt64, and the data as one block.
template <class T>
std::string data_array(const char* name, int components, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
      VtkType<T>::name, name, components, base64(bytes));
}

constexpr OutputColumn director{"director", "", "x axis of the element, normal to the tube: shows physical twist"};
constexpr OutputColumn axis{"axis", "", "axis of the tube"};
constexpr OutputColumn tube_number{"tube", "", "tube, from 1"};
constexpr OutputColumn tube_radius{"radius", "nm", "radius of the tube: scale ParaView's Tube filter by it"};

template <class Of>
std::string vectors(const char* name, const State& state, const Of& of) {
  std::vector<float> values;
  values.reserve(3 * state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Vector3 v = of(i);
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(v[k]));
  }
  return data_array(name, 3, values);
}

// Polylines have two points or more; a tube of one element is a vertex.
std::string cells(const char* kind, const Topology& topology, bool single) {
  std::vector<std::int32_t> connectivity, offsets;
  for (int t = 0; t < topology.tubes(); ++t) {
    if ((topology.length_of(t) == 1) != single || topology.length_of(t) == 0) continue;
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) connectivity.push_back(e);
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  return fmt::format("<{0}>\n{1}{2}</{0}>\n", kind, data_array("connectivity", 1, connectivity),
                     data_array("offsets", 1, offsets));
}

std::string point_data(const Topology& topology, const State& state, const ElementColours& colours) {
  std::string text = vectors(director.name, state, [&](std::size_t i) -> Vector3 {
    return state.orientation[i].toRotationMatrix().col(0);
  });
  text += vectors(axis.name, state, [&](std::size_t i) { return axis_of(state.orientation[i]); });
  for (const ColourColumn& column : colour_columns)
    if (given(colours, column, state)) {
      const std::vector<double>& values = colours.*column.values;
      text += data_array(column.column.name, 1, std::vector<float>(values.begin(), values.end()));
    }
  std::vector<std::int32_t> tube;
  std::vector<float> radius;
  for (int t = 0; t < topology.tubes(); ++t) {
    tube.insert(tube.end(), topology.length_of(t), t + 1);
    radius.insert(radius.end(), topology.length_of(t), static_cast<float>(topology.type_of(t).radius));
  }
  return text + data_array(tube_number.name, 1, tube) + data_array(tube_radius.name, 1, radius);
}

int cell_count(const Topology& topology, bool single) {
  int count = 0;
  for (int t = 0; t < topology.tubes(); ++t)
    if (topology.length_of(t) > 0 && (topology.length_of(t) == 1) == single) ++count;
  return count;
}

constexpr const char* byte_order =
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    "LittleEndian";
#else
    "BigEndian";
#endif

}  // namespace

std::vector<OutputColumn> frame_columns() {
  std::vector<OutputColumn> columns(fixed_columns.begin(), fixed_columns.end());
  for (const ColourColumn& c : colour_columns) columns.push_back({c.in_dump, c.column.unit, c.column.meaning});
  return columns;
}

std::vector<OutputColumn> vtp_arrays() {
  std::vector<OutputColumn> columns = {director, axis};
  for (const ColourColumn& c : colour_columns) columns.push_back(c.column);
  columns.push_back(tube_number);
  columns.push_back(tube_radius);
  return columns;
}

std::string vtp_frame(const Topology& topology, const State& state, const ElementColours& colours) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n<PolyData>\n"
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}"
      "</DataArray>\n</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      byte_order, state.time, state.size(), cell_count(topology, true), cell_count(topology, false));
  text += "<PointData>\n" + point_data(topology, state, colours) + "</PointData>\n";
  text += "<Points>\n" + vectors("points", state, [&](std::size_t i) { return state.position[i]; }) + "</Points>\n";
  text += cells("Verts", topology, true) + cells("Lines", topology, false);
  return text + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const PvdEntry& entry : entries)
    text +=
        fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, escape_markup(entry.file));
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace ropewalk
