// The file of the friction of two kinds of tubes, as `ropewalk calibrate friction` writes it.
//
//   [meta]         format = "ropewalk-friction-1", name, chirality_a, chirality_b, potential
//   [friction]     the law of sim/forces/terms/dry_friction.hpp: strength, spin_strength, end_strength,
//   elastic_slip,
//                  drag
//   [register]     how the strengths spread over the turns of the tubes
//   [pressure], [crossing]   what changes them
//   [provenance]   texts
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/grade.hpp"
#include "model/error.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

inline constexpr const char* friction_format = "ropewalk-friction-1";

struct PairFriction {
  std::string path, hash;  // path and hash of the file that it was read from
  std::string name, potential;
  Chirality a, b;
  std::vector<Quantity> quantities;
  std::vector<std::pair<std::string, std::string>> provenance;
  double strength = 0, spin_strength = 0;  // eV/nm^2
  double end_strength = 0;                 // eV/nm
  double elastic_slip = 0;                 // nm
  double drag = 0;                         // eV ps/nm^3

  bool is_of(Chirality x, Chirality y) const;  // x and y in either order
};

// good: both strengths known to a fifth, or to 1 pN/nm, and the elastic slip to a fifth. unfit: a strength of which
// not even a half is sure. limited: between.
Grade grade_of(const PairFriction& friction);

// Throws InputError.
PairFriction read_friction(const std::string& path);
PairFriction friction_of_text(const std::string& text, const std::string& path);
// Files friction-*.toml in the folders that are none of this program's: the functions below pass over them.
std::vector<std::string> strange_friction_files(const std::vector<std::string>& folders);
// The text of names, quantities and provenance, below `comment`.
std::string friction_text(const PairFriction& friction, const std::string& comment);

// The friction of this name: a file NAME or NAME.toml in one of the folders, a copy friction-K.toml there which has
// it as its meta.name, or a shipped one. Throws InputError at `place`.
PairFriction find_friction(const std::string& name, const std::vector<std::string>& folders,
                           const InputError::Place& place);

// "armchair", "zigzag" or "chiral" for two tubes that fit each other, "unlike" for others. Two tubes fit each other
// if both are armchair tubes, both are zigzag tubes, or both have the same chirality.
std::string kind_of_pair(Chirality a, Chirality b);

// The friction of these tubes, from a file friction-*.toml in one of the folders or a shipped one; where there is
// none, that of the pair of the same kind whose radii are nearest. An estimate then: its tubes are others. Throws
// InputError at `place` if no pair of this kind is there.
PairFriction friction_between(Chirality a, Chirality b, const std::vector<std::string>& folders,
                              const InputError::Place& place);

}  // namespace ropewalk
