// The report on one run: one HTML file without scripts. It asks for no other file; it has a link to view.html.
#pragma once

#include <string>
#include <vector>

#include "io/equilibria.hpp"
#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "io/numeric_errors.hpp"
#include "io/run_errors.hpp"
#include "io/run_results.hpp"
#include "model/parameters.hpp"
#include "observe/observe.hpp"
#include "report/page.hpp"
#include "report/svg.hpp"

namespace ropewalk {

struct ReportSection {
  double time_ps = 0;
  double beta_deg = 0;
  CrossSection section;
  std::vector<double> radius_profile;  // nm, per element index; may be empty
};

// The load on the tubes of a rope in one frame.
struct ReportLoading {
  double time_ps = 0;
  std::vector<double> radius;                   // distance of each tube from the axis at the start, nm
  std::vector<double> pressure_GPa;             // of each tube; empty: there is no contact
  std::vector<std::vector<double>> tension_nN;  // along each tube
};

struct ReportInput {
  std::string name;
  std::string status;  // as in the manifest: running, finished, interrupted, failed, not relaxed
  std::string reason;  // in words; may be empty
  std::vector<std::string> warnings;
  std::vector<std::string> error_bars;  // a paragraph each
  std::vector<ReportFact> facts;        // scene, program, how long it took: in the order of the page

  std::vector<LogRow> log;
  RunErrors errors;           // empty: not known
  NumericErrors whole;        // with those above in it; empty: not known
  double ramp_end_ps = 0;     // end of the loading stage; 0: no such stage
  double tube_radius = 0;     // nm
  double spacing = 0;         // nm
  double element_length = 0;  // nm
  int tubes = 0;
  int bonds = 0;
  bool rope = false;                   // several tubes of one length, parallel at the start
  bool loaded = false;                 // by [twist], grips or loads
  std::vector<ReportLoading> loading;  // loadings in the order of time
  Validity validity;
  Equilibria equilibria;  // equilibria of a run with load steps
  LimitsFile watched;     // empty if the run has no limits.json
  RunResults results;
  std::vector<WholeError> result_errors;  // errors of result_values(); empty: not known

  RopeShells shells;                    // shells of the untwisted rope
  std::vector<ReportSection> sections;  // in the order of time; of more than six, six are shown
  std::vector<RopeView> views;          // likewise
  bool in_space = false;                // view.html stands beside the report

  std::string parameter_name;
  std::string parameter_reference;
  std::vector<Quantity> parameters;
};

std::string report_html(const ReportInput& input);

}  // namespace ropewalk
