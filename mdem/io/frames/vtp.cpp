#include "io/frames/vtp.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

#include "io/base64.hpp"
#include "io/markup.hpp"

namespace ropewalk {

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
constexpr OutputColumn radius_of_tube{"radius", "nm", "radius of the tube: scale ParaView's Tube filter by it"};

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
    if (given(colours, column, state.size())) {
      const std::vector<double>& values = colours.*column.values;
      text += data_array(column.column.name, 1, std::vector<float>(values.begin(), values.end()));
    }
  std::vector<std::int32_t> tube;
  std::vector<float> radius;
  for (int t = 0; t < topology.tubes(); ++t) {
    tube.insert(tube.end(), topology.length_of(t), t + 1);
    radius.insert(radius.end(), topology.length_of(t), static_cast<float>(topology.type_of(t).radius));
  }
  return text + data_array(tube_number.name, 1, tube) + data_array(radius_of_tube.name, 1, radius);
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

std::vector<OutputColumn> vtp_arrays() {
  std::vector<OutputColumn> columns = {director, axis};
  for (const ColourColumn& c : colour_columns) columns.push_back(c.column);
  columns.push_back(tube_number);
  columns.push_back(radius_of_tube);
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
