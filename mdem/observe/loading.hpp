// Tension, curvature, slip and pressure of the tubes of a loaded rope, and the distance between its ends. All of
// them follow from the present state and the state at the start.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "observe/observe.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/dynamics/gauges.hpp"
#include "sim/neighbours/cell_grid.hpp"

namespace ropewalk {

// Quantities of the state at the start, from which strain and slip are counted.
struct LoadingReference {
  EndElements ends;
  double ends_apart = 0;                        // nm, between the centres of the ends
  std::vector<std::pair<int, int>> neighbours;  // strands, of equal length
  std::vector<double>
      offset;  // nm: element by element along each pair, the displacement of the second one against the first
  std::vector<double> radius;             // distance of each tube from the axis, nm; empty: no common length
  std::vector<int> core;                  // the internal strands nearest to the axis
  std::vector<double> cells;              // area in the cross-section by the type of a tube, nm^2: packing_cells()
  std::shared_ptr<const ContactLaw> law;  // null: no contact

  bool knows_pressures() const { return law && !cells.empty() && cells.front() > 0; }
};
LoadingReference loading_reference(const Topology& topology, const State& start, const RopeShells& shells,
                                   EndElements ends, double spacing, double neighbour_radius,
                                   std::shared_ptr<const ContactLaw> law);

// The reference for tubes cut where they have broken (cut_behind): each part has the radius of its tube.
LoadingReference of_parts(LoadingReference reference, const Topology& whole, const Topology& parts);

struct Loading {
  double ends_apart = 0;     // nm, between the centres of the ends; of a slice: its period
  double strain = 0;         // relative change of that distance
  double least_tension = 0;  // least tension of a tube, mean over its middle third, eV/nm
  double most_tension = 0;   // eV/nm, likewise
  double curvature = 0;      // 1/nm, the largest
  double slip = 0;           // nm, the largest displacement of a tube along its neighbour since the start
  double core_pressure = 0;  // eV/nm^3; NaN where no tube is internal
};
Loading loading(const Topology& topology, const State& state, const LoadingReference& reference);

// Period along z of a slice whose images stand one period from their elements, nm.
double slice_length(const Topology& topology, const State& state);

// The load on one tube.
struct TubeLoading {
  double tension = 0, most_tension = 0;  // eV/nm: mean over the middle third, largest absolute value
  double twist = 0;                      // rad/nm, mean
  double curvature = 0;                  // 1/nm, the largest
  double slip = 0;                       // nm, the largest, of its strand
  double pressure = 0;                   // eV/nm^3
};
std::vector<TubeLoading> tube_loadings(const Topology& topology, const State& state,
                                       const LoadingReference& reference);

// The tension in each bond of a tube, eV/nm; 0 in a bond that has broken (has_parted).
std::vector<double> tensions(const Topology& topology, const State& state, int tube);

// The contact pressure on a tube (eV/nm^3), from the virial of the contact forces F_ij that act on its elements i:
//
//   p = 1/(4 A L) sum F_ij (x_i - x_j)
//
// Only the components across the tube enter. The sum runs over up to eight elements in the middle of the tube, L is
// their length without load, and A is the cell of such a tube in the cross-section. The pressure of a straight rope
// at rest is near zero, because the attraction of second neighbours balances the repulsion of the first ones.
class TubePressures {
 public:
  // All but `cells` must outlive it. cells: A by the type of a tube, nm^2.
  TubePressures(const Topology& topology, const State& state, const ContactLaw& law, std::vector<double> cells);
  double of(int tube) const;

 private:
  const Topology& topology_;
  const State& state_;
  const ContactLaw& law_;
  std::vector<double> cells_;
  CellGrid grid_;
};
// The pressure on every tube.
std::vector<double> tube_pressures(const Topology& topology, const State& state, const LoadingReference& reference);

}  // namespace ropewalk
