#include "parametrize/parametrize.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "atomistic/potential.hpp"
#include "io/failure.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::validate {
namespace {

namespace fs = std::filesystem;

// The places of a tube's files.
struct Place {
  std::string tube, potential;  // as typed
  std::string name;             // "cnt-7-3-tersoff"
  fs::path folder;

  std::string file(const char* ending) const { return (folder / (name + ending)).string(); }
};

std::vector<Place> places(const ParametrizeArguments& a) {
  std::vector<Place> all;
  for (const std::string& text : a.tubes)
    for (const std::string& potential : a.potentials) {
      const Chirality c = calibrate::parse_chirality(text);
      calibrate::find_potential(potential);
      const Place place{text, potential, fmt::format("cnt-{}-{}-{}", c.n, c.m, potential), a.out};
      const auto twice = [&](const Place& other) { return other.name == place.name; };
      if (std::none_of(all.begin(), all.end(), twice)) all.push_back(place);
    }
  return all;
}

// In a process of its own. The numbers go to NAME-calibration.json, and the reason of a failure to NAME-error.txt.
int calibrate(const Place& place) {
  calibrate::CalibrateArguments c;
  c.chirality = place.tube;
  c.potential = place.potential;
  c.envelope = c.json = c.force = c.quiet = true;
  c.out = place.file(".toml");
  c.command =
      fmt::format("ropewalk calibrate --chirality {} --potential {} --envelope", place.tube, place.potential);
  try {
    if (!std::freopen(place.file("-calibration.json").c_str(), "w", stdout))
      throw std::runtime_error(fmt::format("{}: {}", place.file("-calibration.json"), std::strerror(errno)));
    const int code = calibrate::calibrate_command(c);
    if (std::fflush(stdout) != 0) throw std::runtime_error(std::strerror(errno));
    return code;
  } catch (const std::exception& e) {
    fs::remove(place.file("-calibration.json"));
    write_file_atomically(place.file("-error.txt"), failure_words(e) + "\n");
    return 3;
  }
}

void calibrate_all(const std::vector<Place>& all, const ParametrizeArguments& a, int jobs) {
  std::vector<ProcessTask> tasks;
  for (const Place& place : all) {
    if (!a.again && fs::exists(place.file(".toml"))) {
      if (!a.quiet) fmt::print(stderr, "{}: set kept\n", place.name);
      continue;
    }
    fs::remove(place.file("-error.txt"));
    tasks.push_back({[place, &a] {
                       if (!a.quiet) fmt::print(stderr, "{}: calibrating\n", place.name);
                       return calibrate(place);
                     },
                     [place, &a](int status) {
                       if (status == 0 || fs::exists(place.file("-error.txt"))) return;
                       write_file_atomically(place.file("-error.txt"), death_words(status) + "\n");
                     }});
  }
  run_processes(tasks, jobs);
}

double calibration_seconds(const Place& place) {
  try {
    return nlohmann::json::parse(read_file(place.file("-calibration.json"))).at("seconds").at("total");
  } catch (const std::exception&) {
    return 0;  // a set that was brought here without it
  }
}

ParametrizedTube validated(const Place& place, const ParametrizeArguments& a, int jobs) {
  ParametrizedTube tube;
  tube.name = place.name;
  const Chirality c = calibrate::parse_chirality(place.tube);
  tube.tube = fmt::format("({},{})", c.n, c.m);
  if (!fs::exists(place.file(".toml"))) {
    tube.error = fs::exists(place.file("-error.txt")) ? read_file(place.file("-error.txt")) : "was interrupted";
    while (!tube.error.empty() && tube.error.back() == '\n') tube.error.pop_back();
    return tube;
  }
  tube.set = read_parameters(place.file(".toml"));
  tube.calibration_seconds = calibration_seconds(place);
  ValidateArguments v;
  v.parameters = place.file(".toml");
  v.out = place.file("-validation");
  v.atoms = true;
  v.budget = a.budget;
  v.jobs = jobs;
  v.again = a.again;
  v.quiet = a.quiet;
  tube.outcomes = run_cases(v);
  return tube;
}

// One tube has one page, report.html.
void write_pages(const std::vector<ParametrizedTube>& tubes, std::size_t count, const std::string& out) {
  const auto path = [&](const std::string& name) { return (fs::path(out) / name).string(); };
  write_file_atomically(path("tubes.csv"), tubes_csv(tubes));
  if (count == 1 && tubes.front().error.empty()) {
    write_file_atomically(path("report.html"), tube_page(tubes.front()));
    return;
  }
  for (const ParametrizedTube& tube : tubes)
    if (tube.error.empty()) write_file_atomically(path(tube.name + ".html"), tube_page(tube));
  write_file_atomically(path("report.html"), overview_page(tubes));
}

void print_line(const ParametrizedTube& t) {
  if (!t.error.empty()) {
    fmt::print("{:<24} no set: {}\n", t.name, t.error);
    return;
  }
  const Check* rope = worst_rope(t);
  fmt::print("{:<24} {:<7} EA {:.4g} nN, EI {:.4g} nN nm^2, GJ {:.4g} nN nm^2, pair {:.4g} eV/nm{}\n", t.name,
             t.holds() ? "holds" : "MISSES", t.set.bond.stretch * units::eV_in_nN_nm,
             t.set.bond.bend * units::eV_in_nN_nm, t.set.bond.twist * units::eV_in_nN_nm,
             t.set.line ? t.set.line->pair_energy : 0,
             rope ? fmt::format(", ropes within {:.1f} %", 100 * std::fabs(rope->difference())) : "");
}

}  // namespace

bool ParametrizedTube::holds() const {
  return error.empty() && std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) {
           return o.verdict() == Outcome::Verdict::holds || o.verdict() == Outcome::Verdict::not_applicable;
         });
}

std::string ParametrizedTube::grade() const {
  return grade_with_verdicts(grade_of(set).words(), set.hash, outcomes);
}

double ParametrizedTube::validation_seconds() const {
  double sum = 0;
  for (const Outcome& o : outcomes) sum += o.result.seconds;
  return sum;
}

const Check* worst_rope(const ParametrizedTube& tube) {
  const Check* worst = nullptr;
  for (const Outcome& o : tube.outcomes) {
    if (o.name.rfind("rope-7-", 0) != 0) continue;
    for (const Check& c : o.result.checks)
      if (!c.informative && c.name.find(": twisting energy, ") != std::string::npos &&
          (!worst || std::fabs(c.difference()) > std::fabs(worst->difference())))
        worst = &c;
  }
  return worst;
}

int parametrize_command(const ParametrizeArguments& a) {
  const std::vector<Place> all = places(a);
  make_directory(a.out);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  calibrate_all(all, a, jobs);
  std::vector<ParametrizedTube> tubes;
  for (const Place& place : all) {
    tubes.push_back(validated(place, a, jobs));
    write_pages(tubes, all.size(), a.out);
    print_line(tubes.back());
    std::fflush(stdout);
  }
  fmt::print("Report: {}/report.html; table: {}/tubes.csv\n", a.out, a.out);
  int code = 0;
  for (const ParametrizedTube& tube : tubes) {
    if (!tube.error.empty()) code = 3;
    for (const Outcome& o : tube.outcomes)
      if (o.verdict() == Outcome::Verdict::failed) code = 3;
    if (code == 0 && !tube.holds()) code = 1;
  }
  return code;
}

}  // namespace ropewalk::validate
