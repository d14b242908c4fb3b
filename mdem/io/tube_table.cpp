#include "io/tube_table.hpp"

#include <fmt/format.h>

#include <cmath>

namespace ropewalk {
namespace {

struct TubeColumn {
  OutputColumn of;
  double (*value)(const TubeLoading&);
};
constexpr TubeColumn columns[] = {
    {{"tension_nN", "nN", "tension, mean over the middle third"},
     [](const TubeLoading& t) { return t.tension / units::nN_nm; }},
    {{"most_tension_nN", "nN", "the largest tension or compression of a bond"},
     [](const TubeLoading& t) { return t.most_tension / units::nN_nm; }},
    {{"twist_deg_per_nm", "deg/nm", "twist of the bonds per length, mean"},
     [](const TubeLoading& t) { return t.twist / units::degree; }},
    {{"curvature_per_nm", "1/nm", "the largest curvature"}, [](const TubeLoading& t) { return t.curvature; }},
    {{"slip_nm", "nm", "the largest displacement along a neighbour since the start"},
     [](const TubeLoading& t) { return t.slip; }},
    {{"pressure_GPa", "GPa", "pressure of the contacts across the tube, in its middle"},
     [](const TubeLoading& t) { return t.pressure / units::nN_nm; }},  // nN/nm^2
};

}  // namespace

std::vector<OutputColumn> tube_columns() {
  std::vector<OutputColumn> out = {{"time_ps", "ps", "time of the frame"},
                                   {"tube", "", "tube, from 0"},
                                   {"radius_nm", "nm", "distance from the axis of the rope at the start"}};
  for (const TubeColumn& column : columns) out.push_back(column.of);
  return out;
}

std::string tube_table_csv(const Topology& topology, const State& state, const LoadingReference& reference) {
  std::string text = column_names(tube_columns()) + "\n";
  const std::vector<TubeLoading> tubes = tube_loadings(topology, state, reference);
  for (std::size_t t = 0; t < tubes.size(); ++t) {
    text += fmt::format("{},{},{}", state.time, t, reference.radius.empty() ? NAN : reference.radius[t]);
    for (const TubeColumn& column : columns) text += fmt::format(",{}", column.value(tubes[t]));
    text += "\n";
  }
  return text;
}

}  // namespace ropewalk
