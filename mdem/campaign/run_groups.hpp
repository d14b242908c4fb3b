// Runs as curves to compare: alone, or those of a campaign that differ in their seed alone together.
#pragma once

#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "report/load_tests.hpp"
#include "report/runs_page.hpp"

namespace ropewalk {

struct RunGroup {
  std::string name;
  // The keys that vary in a campaign, but the first of them, and their values: "tube_length_nm, per_nm" and "20,
  // 0.05". Groups with the same values are points of one line of a figure.
  std::string line_keys = {}, line = {};
  std::vector<RunDirectory> runs;
};

// The run or the campaign in this directory. Throws InputError where it is neither.
std::vector<RunGroup> groups_in(const std::string& directory);
// The name of a directory.
std::string last_part_of(const std::string& path);

// The mean of its logs; `pictured`: with the last frame of the first run. mean_ps: with means over so much time;
// 0: without. Throws InputError where a log has no times.
RunCurve curve_of(const RunGroup& group, bool pictured, double mean_ps = 0);

// The tensile test, or the test in torsion, of each of its runs. Throws InputError for a run without a tension, or
// without a torque.
LoadTestGroup tensile_of(const RunGroup& group);
LoadTestGroup torsion_of(const RunGroup& group);

}  // namespace ropewalk
