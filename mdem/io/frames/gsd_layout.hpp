// Names of the chunks of a GSD file, and numbers of their types.
#pragma once

#include <array>
#include <cstdint>

#include "io/outputs.hpp"

namespace ropewalk {

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "GSD files are little endian, and are written here as the processor has them."
#endif

template <class T>
inline constexpr std::uint8_t gsd_type = 0;
template <>
inline constexpr std::uint8_t gsd_type<std::uint8_t> = 1;
template <>
inline constexpr std::uint8_t gsd_type<std::uint32_t> = 3;
template <>
inline constexpr std::uint8_t gsd_type<std::uint64_t> = 4;
template <>
inline constexpr std::uint8_t gsd_type<char> = 5;  // int8
template <>
inline constexpr std::uint8_t gsd_type<std::int32_t> = 7;
template <>
inline constexpr std::uint8_t gsd_type<float> = 9;
template <>
inline constexpr std::uint8_t gsd_type<double> = 10;

inline constexpr std::array<std::uint8_t, 11> gsd_type_bytes = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};

// The order is that of the file and of docs/outputs.md.
enum GsdChunk : std::uint16_t {
  gsd_step,
  gsd_box,
  gsd_N,
  gsd_types,
  gsd_typeid,
  gsd_mass,
  gsd_body,
  gsd_shapes,
  gsd_bonds,
  gsd_bond_types,
  gsd_bond_group,
  gsd_position,
  gsd_orientation,
  gsd_time,
  gsd_colours,  // and one more for each of them
};

inline constexpr std::array<OutputColumn, gsd_colours> gsd_fixed_chunks = {{
    {"configuration/step", "", "step of the run"},
    {"configuration/box", "nm", "a cube around the origin that holds every element"},
    {"particles/N", "", "number of elements; this chunk and all down to bonds/group are in the first frame alone"},
    {"particles/types", "", "types of tube"},
    {"particles/typeid", "", "type of the tube, from 0"},
    {"particles/mass", "eV ps^2/nm^2", "mass of the element"},
    {"particles/body", "", "tube, from 0"},
    {"particles/type_shapes", "nm", "mesh of an element: a cylinder along its local z"},
    {"bonds/N", "", "bonds between the elements of a tube"},
    {"bonds/types", "", "their one type"},
    {"bonds/group", "", "the two elements of a bond"},
    {"particles/position", "nm", "centre of the element"},
    {"particles/orientation", "", "orientation, a unit quaternion: w, x, y, z"},
    {"log/time_ps", "ps", "time of the frame"},
}};

}  // namespace ropewalk
