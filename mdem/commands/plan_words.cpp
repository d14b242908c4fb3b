#include "commands/plan_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ropewalk {
namespace {

void print_models(const Plan& plan) {
  std::vector<std::string> columns;
  for (const auto& [name, error] : plan.standard.error) columns.push_back(name);
  fmt::print("{:<58} {:>7}", "model", "time");
  for (const std::string& name : columns) fmt::print(" {:>{}}", name, std::max<std::size_t>(9, name.size()));
  fmt::print("\n");
  const auto line = [&](const PlannedModel& m, const std::map<std::string, double>& errors) {
    fmt::print("{:<58} {:>7.2f}", m.name.substr(0, 58), m.seconds / plan.standard.seconds);
    for (const std::string& name : columns) {
      const auto at = errors.find(name);
      fmt::print(" {:>{}}", at == errors.end() ? "-" : fmt::format("{:.2f} %", 100 * at->second),
                 std::max<std::size_t>(9, name.size()));
    }
    fmt::print("{}\n", m.failure.empty() ? (m.holds ? "  holds" : "") : "  failed: " + m.failure);
  };
  line(plan.finest, {});
  line(plan.standard, plan.standard.error);
  for (const PlannedModel& m : plan.tried) line(m, m.error);
}

}  // namespace

void print_pilots(const Plan& plan, double seconds) {
  fmt::print("pilots: {}, {:.3g} s of processor time in all; differences from the finest model\n",
             plan.pilots.empty() ? "the whole scene" : plan.pilots, seconds);
  print_models(plan);
  if (!plan.scatter.empty()) {
    fmt::print("{:<58} {:>7}", "by chance, one standard deviation", "");
    for (const auto& [name, error] : plan.standard.error) {
      const auto at = plan.scatter.find(name);
      fmt::print(" {:>{}}", at == plan.scatter.end() ? "-" : fmt::format("{:.2f} %", 100 * at->second),
                 std::max<std::size_t>(9, name.size()));
    }
    fmt::print("\n");
  }
  for (const std::string& remark : plan.remarks) fmt::print("{}\n", remark);
}

void print_choice(const Plan& plan, const PlanRequest& request) {
  fmt::print("planned for {:g} %: {}. Errors promised:\n", 100 * request.error, plan.chosen.name);
  for (const auto& [name, error] : plan.chosen.expect) fmt::print("  {:20} {:6.2f} %\n", name, 100 * error);
  for (const std::string& line : plan.chosen.why) fmt::print("  {}\n", line);
}

}  // namespace ropewalk
