// `atoms`: elements as atoms.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "commands/sweep_progress.hpp"
#include "commands/verb.hpp"
#include "exchange/atoms_of_state.hpp"
#include "exchange/step_again.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/terminal_listener.hpp"
#include "scene/kinds/state.hpp"
#include "scene/single_state.hpp"

namespace ropewalk {
namespace {

struct AtomsArguments {
  std::string path;         // directory of a run, or a state file
  SingleState state;        // a state file, but for its source
  std::string out;          // .data, .xyz or .extxyz
  long frame = -1;          // of a run; from the end if negative
  std::string at;           // key of a limit: the place and time at which it was passed, instead of `frame`
  double length = 12;       // length of that place, nm
  bool step_again = false;  // to that moment, however long it takes
  std::string tubes;        // "0-18,20"; empty: all
  std::string between;      // "20,40" nm along each tube; empty: all
  std::string potential;    // empty: that of the sets
  bool relax = false;
  bool force = false;
  bool json = false;
};

namespace fs = std::filesystem;

// "0-18,20"
std::vector<int> tubes_of(const std::string& text) {
  std::vector<int> tubes;
  const auto fail = [&] {
    throw InputError({"", 0, "--tubes"}, fmt::format("\"{}\" names no tubes", printable(text, 40)),
                     "write numbers from 0 and ranges, as 0-18,20");
  };
  const char* at = text.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const long first = std::strtol(at, &end, 10);
    if (end == at || first < 0) fail();
    long last = first;
    if (*end == '-') {
      at = end + 1;
      last = std::strtol(at, &end, 10);
      if (end == at) fail();
    }
    if (last < first || last - first > 1000000 || (*end != ',' && *end != '\0')) fail();
    for (long t = first; t <= last; ++t) tubes.push_back(static_cast<int>(t));
    at = *end == ',' ? end + 1 : end;
    if (*end == ',' && *at == '\0') fail();
  }
  return tubes;
}

// "20,40"
void set_between(const std::string& text, AtomSelection& selection) {
  if (text.empty()) return;
  std::size_t read = 0, rest = 0;
  const std::optional<double> from = leading_number(text, &read);
  const std::string behind = from && read < text.size() && text[read] == ',' ? text.substr(read + 1) : "";
  const std::optional<double> to = leading_number(behind, &rest);
  if (!from || !to || rest != behind.size() || !(*from < *to))
    throw InputError({"", 0, "--between"}, fmt::format("\"{}\" is no stretch of a tube", printable(text, 40)),
                     "write two rising numbers of nm, as 20,40");
  selection.from_nm = *from;
  selection.to_nm = *to;
}

bool is_run(const std::string& path) { return fs::is_directory(path); }

void refuse_what_does_not_fit(const AtomsArguments& a, AtomFormat format) {
  const auto refuse = [](const char* option, const char* what, const char* remedy) {
    throw InputError({"", 0, option}, what, remedy);
  };
  if (!is_run(a.path)) {
    if (!fs::exists(a.path)) throw InputError({a.path, 0, ""}, "is not there", "name a run or a state file");
    if (a.state.parameters.empty())
      refuse("--parameters", "is missing, which a state file needs", "name the set that its elements are of");
    if (!a.at.empty()) refuse("--at", "needs the directory of a run", "a state file has no limits");
  } else if (!a.state.parameters.empty()) {
    refuse("--parameters", "is of a state file, and this is a run", "take it away: a run has its own sets");
  }
  if (a.relax && format != AtomFormat::lammps_data)
    refuse("--relax", "needs a file for LAMMPS", "let the name behind -o end in .data");
}

SingleState with_source(const AtomsArguments& a) {
  SingleState single = a.state;
  single.source = std::make_shared<StateSource>(a.path);
  return single;
}

constexpr double patience_s = 60;

// The state where a limit is passed, or the last frame before it; says which.
AtomicState state_at_place(const AtomsArguments& a, AtomSelection& selection) {
  const RunDirectory run{a.path};
  const LimitPlace place = place_of_limit(run, a.at);
  selection.around_tube = place.tube;
  selection.around_element = place.element;
  selection.around_nm = a.length;
  std::string why;
  const bool at_frame = place.frame >= 0 && place.before_ps <= 0;
  const std::optional<double> seconds = at_frame ? std::nullopt : seconds_to_step_again(run, place, why);
  if (seconds && (*seconds < patience_s || a.step_again)) {
    TerminalListener terminal(false);
    if (std::optional<AtomicState> found = state_at_limit(run, place, terminal, why)) {
      fmt::print(stderr, "note: {}; this is that moment, stepped again\n", place.words);
      return *found;
    }
  } else if (seconds) {
    why = fmt::format("that takes some {:.0f} min: --step-again", std::ceil(*seconds / 60));
  }
  if (place.frame < 0)
    throw InputError({run.frames(), 0, "--at"},
                     fmt::format("has no frame before the limit was passed. It was not stepped again: {}", why),
                     "run it again with a shorter run.frames_every_ps");
  if (at_frame)
    fmt::print(stderr, "note: {}; frame {} is of that moment\n", place.words, place.frame);
  else
    fmt::print(stderr, "note: {}; frame {} is {:.4g} ps before that. It was not stepped again: {}\n", place.words,
               place.frame, place.before_ps, why);
  return state_of_frame(run, place.frame);
}

void print_comparison(const std::vector<PartComparison>& parts) {
  fmt::print("energies, eV, of the free atoms against a straight tube at rest that was relaxed alike\n");
  fmt::print("{:>5} {:>9} {:>8} {:>13} {:>13} {:>13} {:>13} {:>13}\n", "tube", "elements", "free", "model: bonds",
             "contact", "sum", "atoms placed", "atoms relaxed");
  PartComparison sum;
  for (const PartComparison& p : parts) {
    fmt::print("{:>5} {:>9} {:>8} {:>13.6g} {:>13.6g} {:>13.6g} {:>13.6g} {:>13.6g}\n", p.part.tube,
               fmt::format("{}-{}", p.part.begin, p.part.end - 1), p.atoms, p.bonds, p.contact, p.bonds + p.contact,
               p.placed, p.relaxed);
    sum.atoms += p.atoms;
    sum.bonds += p.bonds;
    sum.contact += p.contact;
    sum.placed += p.placed;
    sum.relaxed += p.relaxed;
  }
  fmt::print("{:>5} {:>9} {:>8} {:>13.6g} {:>13.6g} {:>13.6g} {:>13.6g} {:>13.6g}\n", "all", "", sum.atoms,
             sum.bonds, sum.contact, sum.bonds + sum.contact, sum.placed, sum.relaxed);
  fmt::print("{}\n", verdict_on_walls(parts));
}

nlohmann::ordered_json as_json(const std::vector<PartComparison>& parts) {
  auto list = nlohmann::ordered_json::array();
  for (const PartComparison& p : parts)
    list.push_back({{"tube", p.part.tube},
                    {"first_element", p.part.begin},
                    {"last_element", p.part.end - 1},
                    {"free_atoms", p.atoms},
                    {"model_bonds_eV", p.bonds},
                    {"model_contact_eV", p.contact},
                    {"atoms_placed_eV", p.placed},
                    {"atoms_relaxed_eV", p.relaxed},
                    {"flattest_element", p.flattest},
                    {"thickness_over_width", p.flatness}});
  return list;
}

int atoms_command(const AtomsArguments& a) {
  const AtomFormat format = atom_format_of(a.out);
  refuse_what_does_not_fit(a, format);
  for (const char* end : {"", "-elements.csv", "-relax.in", "-relaxed.data"}) {
    const std::string stem = (fs::path(a.out).parent_path() / fs::path(a.out).stem()).string();
    refuse_existing(*end ? stem + end : a.out, "-o", a.force);
  }
  AtomSelection selection;
  selection.tubes = tubes_of(a.tubes);
  set_between(a.between, selection);
  const AtomicState s = !a.at.empty()    ? state_at_place(a, selection)
                        : is_run(a.path) ? state_of_frame({a.path}, a.frame)
                                         : state_of_file(with_source(a), a.path);
  const std::vector<TubePart> parts = selected_parts(s, selection);
  if (a.relax) listen_to_stop_signals();
  const WrittenAtoms written = write_atoms_of(s, parts, a.out, a.potential);
  std::set<int> tubes;
  for (const TubePart& part : parts) tubes.insert(part.tube);
  fmt::print(a.json ? stderr : stdout, "{} written: {} atoms of {} tube{}{}, {}\n", fmt::join(written.files, ", "),
             written.atoms, tubes.size(), tubes.size() == 1 ? "" : "s",
             parts.size() == tubes.size() ? "" : fmt::format(" in {} pieces", parts.size()), s.title);
  if (!written.not_relaxable.empty() && format == AtomFormat::lammps_data)
    fmt::print(stderr, "note: no input of LAMMPS was written: {}\n", written.not_relaxable);
  if (!a.relax) return 0;
  LammpsOptions options;
  options.interrupted = [] { return stop_signal != 0; };
  std::vector<PartComparison> found;
  try {
    found = compare_with_atoms(s, parts, written, a.out, a.potential, options);
  } catch (...) {
    for (const std::string& file : written.files) fs::remove(file);  // the same command would refuse to replace them
    if (stop_signal) return tell_stop();
    throw;
  }
  if (a.json)
    fmt::print("{}\n", as_json(found).dump(1));
  else
    print_comparison(found);
  return 0;
}

}  // namespace

void add_atoms(CLI::App& app, Program& program) {
  const auto a = std::make_shared<AtomsArguments>();
  CLI::App* c = app.add_subcommand(
      "atoms", "Elements as atoms: a frame of a run, or a state, as a LAMMPS data file or extended XYZ");
  c->add_option("path", a->path, "Directory of a run, or a state file (CSV)")->required();
  c->add_option(
       "-o", a->out,
       "File to write: .data for LAMMPS, .xyz or .extxyz. Beside it: which atoms are of which element, and an "
       "input of LAMMPS that relaxes them")
      ->required();
  CLI::Option* frame =
      c->add_option("--frame", a->frame, "Frame of a run, from 0; -1 is the last")->capture_default_str();
  CLI::Option* at =
      c->add_option("--at", a->at,
                    "A limit that the run has passed: the place where it did so first. The run is stepped again to "
                    "that moment where that takes less than a minute; else the last frame before it is taken")
          ->excludes(frame);
  c->add_flag("--step-again", a->step_again, "With --at: step the run again, however long it takes")->needs(at);
  c->add_option("--length", a->length, "With --at: diameter of that place, nm")
      ->capture_default_str()
      ->check(number_within(Bounds::range(1, 1000)))
      ->needs(at);
  c->add_option("--tubes", a->tubes, "These tubes alone, from 0: 0-18,20");
  c->add_option("--between", a->between, "This stretch of each tube alone, nm from its first end at rest: 20,40");
  c->add_flag("--relax", a->relax,
              "Have LAMMPS minimise the energy with the ends held, and print it beside that of the model");
  c->add_option("--potential", a->potential,
                "tersoff, airebo, rebo, lcbop, or a file of pair_style and pair_coeff lines [default: the set's]");
  c->add_option("--parameters", a->state.parameters,
                "For a state file: its parameter set; several, separated by commas, for tube types")
      ->delimiter(',');
  c->add_option("--tube-types", a->state.tube_types,
                "For a state file: number of the parameter set of each tube, from 0 [default: all 0]")
      ->delimiter(',');
  c->add_option("--element-length-nm", a->state.element_length,
                "For a state file: length of an element [default: what the file says, else the set's]")
      ->check(number_within(Bounds::range(0.05, 50)));
  c->add_flag("--json", a->json, "With --relax: JSON");
  c->add_flag("--force", a->force, "Replace existing files");
  c->callback([a, &program] { program.code = atoms_command(*a); });
}

}  // namespace ropewalk
