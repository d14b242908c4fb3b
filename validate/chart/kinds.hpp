// The families of models: their names in words, and how every figure of the chart draws them.
#pragma once

#include <array>
#include <string>

#include "report/scatter.hpp"

namespace ropewalk::validate {

struct KindStyle {
  const char *kind, *words;
  int colour;
  Mark mark;
};
inline constexpr std::array<KindStyle, 16> kind_styles = {{
    {"default", "default", 5, Mark::star},
    {"published", "published model", 1, Mark::star},
    {"finest", "finest model", 5, Mark::cross},
    {"combination", "several settings", 2, Mark::star},
    {"element_length", "element length", 0, Mark::dot},
    {"nodes_per_element", "nodes per element", 1, Mark::dot},
    {"cutoff", "cutoff", 2, Mark::dot},
    {"time_step", "time step", 3, Mark::dot},
    {"mass_scale", "masses", 4, Mark::dot},
    {"mode", "relaxation instead of dynamics", 5, Mark::diamond},
    {"law", "contact law", 0, Mark::square},
    {"precision", "precision", 1, Mark::square},
    {"integrator", "integrator", 2, Mark::square},
    {"contact_viscosity", "contact viscosity", 4, Mark::triangle},
    {"bond_damping", "damping of bonds", 0, Mark::triangle},
    {"bond", "bonds without softening", 3, Mark::diamond},
}};
// Throws std::logic_error for a kind that is not there.
const KindStyle& style_of(const std::string& kind);

// Marks and words of all families but those left out.
std::string kinds_legend(const std::string& without);

}  // namespace ropewalk::validate
