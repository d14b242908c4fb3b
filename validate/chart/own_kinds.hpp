// Kinds of scenes of the chart, whose length is that between the centres of the first and the last element:
//
//   [crossing]   two tubes that cross in their middles, the second one above the first: length_nm, angle_deg,
//   distance_nm [ring]       a tube bent into a circle, its first and last element in one place: length_nm
#pragma once

namespace ropewalk::validate {

// Adds both to the register; later calls do nothing.
void add_own_kinds();

}  // namespace ropewalk::validate
