// Runs as curves to compare: alone, or those of a campaign that differ in their seed alone together.
#pragma once

#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "report/runs_page.hpp"
#include "report/tensile.hpp"

namespace ropewalk {

struct RunGroup {
  std::string name;
  // Of a campaign: the values of its keys but the first that varies, "20, 0.05". Runs of one line differ in that
  // one.
  std::string line = {};
  std::vector<RunDirectory> runs;
};

// The run or the campaign in this directory. Throws InputError where it is neither.
std::vector<RunGroup> groups_in(const std::string& directory);
// The keys behind the values of RunGroup::line, "tube_length_nm, per_nm"; empty where there are none.
std::string line_keys_in(const std::string& directory);
// The name of a directory.
std::string last_part_of(const std::string& path);

// The mean of its logs; `pictured`: with the last frame of the first run.
RunCurve curve_of(const RunGroup& group, bool pictured);

// What a testing machine tells of its runs. Throws InputError where nothing pulls in one.
TensileGroup tensile_of(const RunGroup& group);

}  // namespace ropewalk
