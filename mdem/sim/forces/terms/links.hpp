// Links: elastic bridges between the walls of two tubes, that form and break.
//
// A link holds a point of an element a to a point of an element b of another tube. Both points lie between the
// walls, at half of the rest length from the wall, and move with their elements:
//
//   A = x_a + R_a p_a,  B = x_b + R_b p_b,  d = B - A
//   U = k_s/2 d^2 + (k_n - k_s)/4 [(d . R_a n_a)^2 + (d . R_b n_b)^2]
//
// p and n (unit, from the tube's axis towards the other tube) stay as they were when the link formed, in the frames
// of the elements. k_n is the stiffness of stretch, k_s that of shear. Forces and torques are minus the derivatives
// of U, so that momentum and angular momentum are kept. A link breaks for good in the first step with |dU/dd|,
// without what pushes, above its strength, or with U above its toughness. Its energy is then lost.
//
// At the start there are, in the mean, `density` links for each length along which two tubes face each other within
// `reach` between their walls, at random places (Poisson), or `at_ends` links of each tube end with the tubes that
// it faces; or they are placed like that at a later time. While a scene moves, links form with the rate `forming`
// per length and time, every picosecond, as long as there are less than `most` of this law per length of either
// tube. What forms depends on the numbers of the elements, the seed, the lineage and the step, so that a run gives
// the same bits on any number of threads and after `resume`.
//
// Source of the shear lag that such links give: O. Volkersen, Luftfahrtforschung 15, 41 (1938). Units nm, ps, eV.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/forces/force_term.hpp"
#include "sim/forces/terms/type_pairs.hpp"

namespace ropewalk {

struct LinkLaw {
  double stretch = 0, shear = 0;       // k_n, k_s, eV/nm^2
  double rest = -1;                    // nm, between the walls; negative: as far as they are when a link forms
  double strength = 0, toughness = 0;  // eV/nm, eV; 0: it never breaks for that
  double reach = 0.45;                 // nm, between walls
  double density = 0;                  // links per length of contact at the start, 1/nm
  int at_ends = 0;                     // links of each end of a tube at the start
  double placed_at = 0;  // ps; above 0: `density` and `at_ends` place links in the first step after this time
  double forming = 0, most = 0;  // 1/(nm ps), 1/nm
  std::uint64_t seed = 1;
  std::uint64_t lineage = 0;  // lineage of the links that form while the scene moves: see lineage_key()
  TypePairs types;            // types of tubes whose contacts get links
};

// Where a link holds: elements of the scene, and its points and normals in their frames.
struct LinkPlace {
  int a = 0, b = 0;
  Vector3 p_a, p_b, n_a, n_b;
};

// The links of a state. `pairs` of elements that links must join are taken as they are, at the point where they are
// nearest to each other; the others are chosen by the law.
std::vector<LinkPlace> placed_links(const LinkLaw& law, const Topology& topology, const State& state,
                                    const std::vector<std::pair<int, int>>& pairs);

std::shared_ptr<const ForceTerm> link_term(const LinkLaw& law, std::vector<LinkPlace> at_start,
                                           const Topology& scene);

}  // namespace ropewalk
