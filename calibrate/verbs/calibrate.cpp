// `ropewalk calibrate --chirality n,m`: from a chirality to a parameter set.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "atomistic/walled_tube.hpp"
#include "atomistic/walls.hpp"
#include "atoms/honeycomb_file.hpp"
#include "io/data_files.hpp"
#include "io/file_group.hpp"
#include "io/files.hpp"
#include "io/grade.hpp"
#include "io/parameters_toml.hpp"
#include "io/potential_spread.hpp"
#include "io/toml_table.hpp"
#include "report/page.hpp"
#include "verbs/verbs.hpp"
#include "verbs/walls.hpp"

namespace ropewalk::calibrate {
namespace {

namespace fs = std::filesystem;

// "a,b" as two numbers.
template <class T>
bool two_numbers(const std::string& text, T& a, T& b) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return false;
  const auto number = [](const char* from, const char* to, T& value) {
    while (from < to && *from == ' ') ++from;
    const auto [end, error] = std::from_chars(from, to, value);
    return error == std::errc() && end == to;
  };
  const char* p = text.data();
  return number(p, p + comma, a) && number(p + comma + 1, p + text.size(), b);
}

// A cutoff leaves out more of the well where several walls stand behind one another (the issue of the tail: 9 to 24 % at
// 1.2 nm).
constexpr double cutoff_of_walls = 3;  // nm

// The numbers of a calibration, for a person and for a script.
struct Number {
  const char *words, *key, *unit;
  Measured value;           // value in the unit
  const char* in_set = "";  // its key there, where potentials differ in it
};

std::vector<Number> numbers_of(const Calibration& c) {
  const Stiffness& s = c.stiffness;
  const ContactSummary sum = contact_summary(c);
  const auto nN = [](const Measured& m) {
    return Measured{m.value * units::eV_in_nN_nm, m.standard_error * units::eV_in_nN_nm};
  };
  return {{"radius", "radius_nm", "nm", s.radius},
          {"atoms per length", "atoms_per_nm", "1/nm", s.atoms_per_length},
          {"EA", "EA_nN", "nN", nN(s.EA), "bond.EA"},
          {"EI", "EI_nN_nm2", "nN nm^2", nN(s.EI), "bond.EI"},
          {"GJ", "GJ_nN_nm2", "nN nm^2", nN(s.GJ), "bond.GJ"},
          {"stretch-twist coupling", "coupling_nN_nm", "nN nm", nN(s.coupling)},
          {"natural twist", "natural_twist", "rad/nm", s.natural_twist},
          {"Poisson contraction", "poisson", "", s.poisson},
          {"spacing of a pair", "pair_spacing_nm", "nm", sum.pair_spacing},
          {"energy of a pair", "pair_energy_eV_per_nm", "eV/nm", sum.pair_energy},
          {"energy crossed at 90 deg", "cross90_energy_eV", "eV", sum.cross90_energy}};
}

// Both ways of holding, and each wall.
void print_walls(const Calibration& c) {
  fmt::print("  {:<26} {:>12} {:>14} {:>14}   {:>9}\n", "", "EA nN", "EI nN nm^2", "GJ nN nm^2", "radius nm");
  const auto line = [](const std::string& words, const Measured& EA, const Measured& EI, const Measured& GJ,
                       const std::string& radius) {
    const double unit = units::eV_in_nN_nm;
    fmt::print("  {:<26} {:12.5g} {:14.5g} {:14.5g}   {:>9}\n", words, EA.value * unit, EI.value * unit,
               GJ.value * unit, radius);
  };
  const auto whole = [&](const std::string& words, const Stiffness& s) { line(words, s.EA, s.EI, s.GJ, ""); };
  whole("all walls held", c.walled->all);
  whole("the outer wall held", c.walled->outer);
  for (const WallStiffness& wall : c.walled->walls)
    line(fmt::format("wall ({},{})", wall.rest.c.n, wall.rest.c.m), wall.EA, wall.EI, wall.GJ,
         fmt::format("{:.5f}", wall.radius.value));
  fmt::print("  carried by {}\n", c.request.outer_carries ? "the outer wall (--carried-by all for all)"
                                                          : "all walls (--carried-by outer for the outer one)");
}

void print_result(const Calibration& c, const Grade& grade, const std::string& out) {
  const Stiffness& s = c.stiffness;
  const Chirality tube = c.request.chirality;
  fmt::print("{}, {}, LAMMPS {}\n", c.request.tube(), c.request.potential.name, c.lammps.text);
  if (!c.walled && tube.chiral() && tube.m > tube.n)
    fmt::print(
        "  the mirror image of ({},{}): coupling, natural twist and terms odd in shear have the other sign\n",
        tube.m, tube.n);
  for (const Number& n : numbers_of(c))
    fmt::print("  {:<26} {:>26} {}\n", n.words,
               measured_text({n.in_set, n.value.value, "", n.value.standard_error, "", "", "",
                              c.request.honeycomb().carbon()}),
               n.unit);
  if (c.walled) print_walls(c);
  fmt::print("  line law: largest error {:.1e} of the well", c.line.error);
  if (c.walled)
    fmt::print("; the cutoff of {:g} nm leaves out {:.1f} %", c.request.law.cutoff, 100 * c.cutoff_loss);
  else
    fmt::print("; published form {:.1e}", c.paper.error);
  if (c.universal) fmt::print("; universal law {:.1e}", c.universal_error);
  fmt::print("\n");
  if (c.registry)
    fmt::print("  atom by atom, over all registries: mean {:+.3f} %, standard deviation {:.2f} % of the integral\n",
               100 * (c.registry->mean - 1), 100 * c.registry->deviation);
  fmt::print("{}", s.fit_report);
  if (!s.fit_report.empty() && s.fit_report.back() != '\n') fmt::print("\n");
  for (const std::string& w : c.warnings) fmt::print("warning: {}\n", w);
  fmt::print("{:.1f} s: LAMMPS {:.1f}, contact integral {:.1f}, fits {:.1f}, rest {:.1f}\n", c.seconds,
             s.lammps_seconds, c.line.seconds_integral, s.fit_seconds + c.line.seconds_fit + c.paper_seconds,
             c.seconds - s.lammps_seconds - c.line.seconds_integral - s.fit_seconds - c.line.seconds_fit -
                 c.paper_seconds);
  fmt::print("Grade: {}\nSet: {}\n", grade.words(), out);
}

nlohmann::ordered_json result_json(const Calibration& c, const Grade& grade, const std::string& out) {
  const Stiffness& s = c.stiffness;
  nlohmann::ordered_json j;
  if (const Honeycomb& h = c.request.honeycomb(); !h.carbon()) j["species"] = {h.species[0], h.species[1]};
  if (c.walled) {
    for (const Chirality wall : c.request.walls) j["walls"].push_back({wall.n, wall.m});
    j["carried_by"] = c.request.outer_carries ? "outer" : "all";
    for (const auto& [way, s] : {std::pair{"held_all", &c.walled->all}, std::pair{"held_outer", &c.walled->outer}})
      j[way] = {{"EA_nN", s->EA.value * units::eV_in_nN_nm},
                {"EI_nN_nm2", s->EI.value * units::eV_in_nN_nm},
                {"GJ_nN_nm2", s->GJ.value * units::eV_in_nN_nm}};
    j["cutoff_loss"] = c.cutoff_loss;
  } else {
    j["chirality"] = {c.request.chirality.n, c.request.chirality.m};
  }
  j["potential"] = c.request.potential.name;
  for (const Number& n : numbers_of(c)) {
    j[n.key] = n.value.value;
    j[std::string(n.key) + "_standard_error"] = n.value.standard_error;
    if (const double spread = potential_spread(n.in_set); spread > 0 && c.request.honeycomb().carbon())
      j[std::string(n.key) + "_potential_error"] = spread * n.value.value;
  }
  j["line_error"] = c.line.error;
  if (!c.walled) j["paper_error"] = c.paper.error;
  if (c.universal) j["universal_error"] = c.universal_error;
  if (c.registry) j["registry"] = {{"mean", c.registry->mean}, {"standard_deviation", c.registry->deviation}};
  j["grade"] = grade.words();
  j["warnings"] = c.warnings;
  j["seconds"] = {
      {"total", c.seconds}, {"lammps", s.lammps_seconds}, {"contact_integral", c.line.seconds_integral}};
  j["file"] = out;
  return j;
}

struct OutputFiles {
  std::string set, stiffness, contact;
};

// A table with such a beginning whose set is not there: perhaps left by this very calibration, ended before its set
// had its name.
bool may_be_left_over(const OutputFiles& files, const std::string& table, const std::string& beginning) {
  std::error_code error;
  return !fs::exists(files.set, error) && fs::is_regular_file(fs::symlink_status(table, error)) &&
         read_file(table).rfind(beginning, 0) == 0;
}

// The text, unless a table of other energies stands in its place.
std::string of_this_calibration(const std::string& path, std::string text, bool force) {
  if (!force && fs::exists(path) && read_file(path) != text)
    throw InputError({path, 0, "--out"}, "exists, without its set and with other energies than this calibration",
                     "choose another name, or give --force to replace it; nothing was written");
  return text;
}

OutputFiles output_files(const CalibrateArguments& a, const CalibrationRequest& request) {
  const Chirality tube = request.chirality;
  const std::string name = request.name();
  OutputFiles f;
  f.set = a.out.empty() ? name + ".toml" : a.out;
  if (fs::path(f.set).extension() != ".toml")
    throw InputError({f.set, 0, "--out"}, "is not named *.toml", "choose such a name: the tables lie beside it");
  const std::string stem = f.set.substr(0, f.set.size() - 5);
  f.stiffness = stem + "-stiffness.csv";
  f.contact = stem + "-contact.csv";
  check_output(f.set, "--out", a.force);
  const auto check_table = [&](const std::string& table, const std::string& beginning) {
    check_output(table, "--out", a.force || may_be_left_over(f, table, beginning));
  };
  check_table(f.stiffness, fmt::format("# ropewalk-atomistic-1\n# chirality: {},{}\n", tube.n, tube.m));
  check_table(f.contact, fmt::format("# Surface integral of two {} tubes, ", request.tube()));
  return f;
}

// The measured limits of a set of the same tube and potential, and the rows of its table that they came from.
KnownEnvelope envelope_of(const std::string& name, const CalibrationRequest& request) {
  const ParameterSet set = read_parameters(find_parameters(name, "", {"", 0, "--envelope-of"}));
  const auto refuse = [&](const std::string& why, const std::string& remedy) {
    throw InputError({set.path, 0, "--envelope-of"}, why, remedy);
  };
  if (set.chirality.n != request.chirality.n || set.chirality.m != request.chirality.m ||
      set.honeycomb.name != request.honeycomb().name ||
      provenance_value(set, "potential_hash") != request.potential.file_hash)
    refuse("is a set of another tube or potential", "name one of the same, or measure with --envelope");
  const Quantity* kink = find_quantity(set, "validity.kink_curvature");
  if (kink->origin != "calibrated") refuse("has limits that were not measured", "measure them with --envelope");
  const fs::path table = fs::path(set.path).parent_path() / provenance_value(set, "stiffness_table");
  if (!fs::is_regular_file(table) || hash_hex(read_file(table.string())) != provenance_value(set, "stiffness_hash"))
    refuse("has no stiffness table beside it, or another one", "bring the table that the set was made from");
  const auto limit = [&](const char* key) {
    const Quantity* q = find_quantity(set, std::string("validity.") + key);
    return q ? Measured{q->value, q->standard_error.value_or(0)} : Measured{};
  };
  KnownEnvelope known;
  known.limits.kink_curvature = limit("kink_curvature");
  known.limits.twist_collapse = limit("twist_collapse");
  known.limits.compression = limit("stretch");
  known.limits.linear_curvature = limit("linear_curvature");
  known.limits.linear_shear = limit("linear_twist");
  known.limits.linear_strain = limit("linear_stretch");
  known.limits.measured = true;
  for (const AtomisticRow& row : read_atomistic_csv(table.string()))
    if (row.kind.rfind("envelope-", 0) == 0 || row.kind == "collapse-twist") known.rows.push_back(row);
  return known;
}

// Leaves out the bond of the thinnest tubes, whose windows are too wide for the polynomial; they have the harmonic
// one.
void leave_out_unusable_bond(Calibration& c, const std::string& text, const std::string& path) {
  try {
    parameters_of_text(text, path);
  } catch (const InputError& e) {
    const auto lies_in = [&](const char* table) { return e.place().key.rfind(table, 0) == 0; };
    if (lies_in("bond.pull")) {
      c.stiffness.pull = {};
      c.warnings.push_back(std::string("the pull is left out: ") + e.what());
    }
    if (!lies_in("bond.anharmonic")) return;
    c.stiffness.anharmonic.terms.clear();
    c.stiffness.pull = {};
    c.warnings.push_back(std::string("the bond beyond Hooke's law is left out: ") + e.what());
  }
}

// Grades a new parameter set, from the text that its file will have. Throws InputError for a text that the other
// commands would refuse, and for a contact law that writing and reading changes. The file is then not written.
Grade usable_grade(const std::string& text, const std::string& path, const std::string& tube) {
  const auto refuse = [&](const std::string& why) {
    throw InputError({"", 0, "--chirality"},
                     fmt::format("{} cannot be made a set of rigid circular tubes: {}", tube, why),
                     "take a wider tube, or a usual --lj and --lj-cutoff; nothing was written");
  };
  ParameterSet set;
  try {
    set = parameters_of_text(text, path);
  } catch (const InputError& e) {
    refuse(e.what());
  }
  const Grade grade = grade_of(set);
  if (line_fit_error(set) > unusable_contact) refuse(grade.words());
  const double wall = wall_stiffness(set);
  const WallRange range = wall_range(set.honeycomb);
  if (!(wall >= range.softest && wall <= range.stiffest))
    throw InputError({"", 0, "--potential"},
                     fmt::format("makes a wall of {:.4g} N/m, EA/(2 pi r), and {} has {:.0f} to {:.0f}", wall,
                                 range.of, range.softest, range.stiffest),
                     "check its parameters and their units, eV and Angstrom; nothing was written");
  return grade;
}

}  // namespace

Chirality parse_chirality(const std::string& text) {
  const InputError::Place place{"", 0, "--chirality"};
  Chirality c;
  if (!two_numbers(text, c.n, c.m))
    throw InputError(place, fmt::format("is \"{}\"", printable(text, 40)), "write two integers, as in 10,10");
  if (!c.valid())
    throw InputError(place, fmt::format("({},{}) is not a tube", c.n, c.m),
                     "take n and m that are not negative; m above n is the mirror image of m,n");
  return c;
}

AtomLaw parse_atom_law(const std::string& lj, double cutoff) {
  AtomLaw law;
  if (!two_numbers(lj, law.epsilon, law.sigma))
    throw InputError({"", 0, "--lj"}, fmt::format("is \"{}\"", printable(lj, 40)),
                     "write epsilon in eV and sigma in nm, as in 2.84e-3,0.34");
  if (!(law.epsilon > 0 && law.epsilon < 1))
    throw InputError({"", 0, "--lj"}, fmt::format("epsilon is {} eV", law.epsilon), "must lie between 0 and 1");
  if (!(law.sigma >= 0.2 && law.sigma <= 0.6))
    throw InputError({"", 0, "--lj"}, fmt::format("sigma is {} nm", law.sigma), "must lie between 0.2 and 0.6");
  law.cutoff = cutoff == 0 ? std::numeric_limits<double>::infinity() : cutoff;
  if (!(cutoff >= 0))
    throw InputError({"", 0, "--lj-cutoff"}, fmt::format("is {} nm", cutoff), "must be positive, or 0 for none");
  if (law.cutoff < 2 * law.sigma)
    throw InputError(
        {"", 0, "--lj-cutoff"}, fmt::format("is {} nm", cutoff),
        fmt::format("must be at least 2 sigma, {:.3g} nm: a shorter cutoff loses the attraction", 2 * law.sigma));
  return law;
}

void check_output(const std::string& path, const std::string& option, bool force) {
  std::error_code error;
  refuse_existing(path, option, force);
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw InputError({path, 0, option}, "lies in a directory that does not exist", "make the directory first");
}

WorkFolder::WorkFolder(const std::string& keep) : path_(keep) {
  std::error_code error;
  if (!keep.empty()) {
    if (fs::exists(keep, error) && (!fs::is_directory(keep, error) || !fs::is_empty(keep, error)))
      throw InputError({keep, 0, "--keep"}, "exists and is not an empty directory", "choose another name");
    fs::create_directories(keep, error);
    if (error)
      throw InputError({keep, 0, "--keep"}, fmt::format("cannot be made: {}", error.message()),
                       "choose a place that you may write to");
    return;
  }
  temporary_.emplace();
  path_ = temporary_->path();
}

void WorkFolder::stay_for(const LammpsError& error) {
  const bool names_files = interrupted_by() == 0 && !dynamic_cast<const LammpsDiskFull*>(&error);
  if (temporary_ && names_files) temporary_->keep();
}

namespace {

Potential potential_of_request(const CalibrateArguments& a) {
  if (a.user_potential.empty()) return potential_of_atoms(a.atoms, a.potential);
  Potential out = user_potential(a.user_potential);
  if (a.atoms == "C") return out;
  const Potential named = potential_of_atoms(a.atoms, "");
  out.honeycomb = named.honeycomb;
  out.atoms = named.atoms;
  out.pairs_reference = named.pairs_reference;
  out.pairs_doi = named.pairs_doi;
  return out;
}

AtomLaw law_of_request(const CalibrateArguments& a, const Honeycomb& honeycomb) {
  if (honeycomb.carbon()) return parse_atom_law(a.lj.empty() ? law_of_carbon : a.lj, a.lj_cutoff);
  if (!a.lj.empty())
    throw InputError({"", 0, "--lj"}, fmt::format("is one law, and {} has one for each pair of species", honeycomb.name),
                     "change [lennard_jones] in a copy of the file behind --atoms");
  const PairLaw shell = shell_law(honeycomb.pairs);
  return parse_atom_law(fmt::format("{},{}", shell.epsilon, shell.sigma), a.lj_cutoff);
}

}  // namespace

int calibrate_command(const CalibrateArguments& a) {
  CalibrationRequest request;
  const std::vector<Chirality> walls = a.walls > 0 ? find_walls(a.walls, a.outer_diameter) : parse_walls(a.chirality);
  request.chirality = walls.back();
  request.potential = potential_of_request(a);
  if (walls.size() > 1) {
    request.walls = walls;
    request.outer_carries = a.carried_by.empty() ? !walls_lock(walls) : a.carried_by == "outer";
    if (!request.honeycomb().carbon())
      throw InputError({"", 0, "--atoms"}, fmt::format("is {}, and several walls are made of carbon alone", a.atoms),
                       "give one wall, or leave --atoms away");
    if (!a.envelope_of.empty())
      throw InputError({"", 0, "--envelope-of"}, "takes the limits of a tube of one wall", "measure with --envelope");
    walled_pair_commands(request.potential, {}, walls.size());  // refuses a potential that walls cannot have each
  } else if (!a.carried_by.empty()) {
    throw InputError({"", 0, "--carried-by"}, "is about several walls", "leave it out for a tube of one wall");
  }
  request.law = law_of_request(a, request.honeycomb());
  if (a.usual_cutoff && walls.size() > 1) request.law.cutoff = cutoff_of_walls;
  request.stiffness = a.stiffness;
  StiffnessOptions& s = request.stiffness;
  if (walls.size() > 1) std::tie(s.short_length, s.long_length) = specimen_lengths(walls);
  if (!a.bend_lengths.empty() && !two_numbers(a.bend_lengths, s.short_length, s.long_length))
    throw InputError({"", 0, "--bend-lengths"}, fmt::format("is \"{}\"", printable(a.bend_lengths, 40)),
                     "write two lengths in nm, as in 6,10");
  request.stiffness.envelope = a.envelope;
  if (a.envelope && !a.envelope_of.empty())
    throw InputError({"", 0, "--envelope-of"}, "takes the place of --envelope", "give one of them");
  request.stiffness.lammps.interrupted = [] { return interrupted_by() != 0; };
  request.command = a.command;
  if (!a.envelope_of.empty()) request.stiffness.known_envelope = envelope_of(a.envelope_of, request);
  const OutputFiles files = output_files(a, request);
  if (!a.quiet && walls.size() > 1) fmt::print(stderr, "{}\n", walls_summary(walls));
  if (!a.quiet) request.stiffness.progress = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  WorkFolder folder(a.keep);
  request.folder = folder.path();
  Calibration c;
  try {
    c = calibrate(request);
  } catch (const LammpsError& e) {
    folder.stay_for(e);
    throw;
  }
  const auto set_text = [&] {
    const ParameterSet set = parameter_set(c, fs::path(files.stiffness).filename().string(),
                                           fs::path(files.contact).filename().string());
    return parameters_text(set, parameter_file_comment(c));
  };
  leave_out_unusable_bond(c, set_text(), files.set);
  const std::string text = set_text();
  const Grade grade = usable_grade(text, files.set, request.tube());
  write_files_together({{files.stiffness, of_this_calibration(files.stiffness, stiffness_csv(c), a.force)},
                        {files.contact, of_this_calibration(files.contact, contact_csv(c), a.force)},
                        {files.set, text}});
  if (a.json) {
    fmt::print("{}\n", result_json(c, grade, files.set).dump(1));
  } else {
    print_result(c, grade, files.set);
  }
  return 0;
}

void add_law(CLI::App& app, std::string& lj, double& cutoff) {
  app.add_option("--lj", lj, fmt::format("Lennard-Jones epsilon (eV) and sigma (nm) between carbon atoms of two tubes "
                                         "[default: {}]", law_of_carbon));
  app.add_option("--lj-cutoff", cutoff, "Its cutoff (nm), truncated as lj/cut does; 0: none")
      ->capture_default_str();
}

void add_calibrate(CLI::App& app, Program& program) {
  const auto a = std::make_shared<CalibrateArguments>();
  a->command = program.command;
  app.add_option("--chirality", a->chirality, "n,m, as in 10,10 or 7,3; several walls, inside first: '(5,5)@(10,10)'");
  app.add_option("--walls", a->walls, "Find so many walls, 0.34 nm apart, for --outer-diameter");
  app.add_option("--outer-diameter", a->outer_diameter, "Diameter of the outer wall (nm), for --walls");
  app.add_option("--carried-by", a->carried_by,
                 "Walls that carry stretch and torsion: outer or all [default: all where all are armchair or all zigzag]")
      ->check(CLI::IsMember({"outer", "all"}));
  app.add_option("--atoms", a->atoms, "C, BN, or a file that names species, potentials and contact of another honeycomb")
      ->capture_default_str();
  app.add_option("--potential", a->potential,
                 "Of carbon: tersoff, airebo, rebo or lcbop; of BN: extep or tersoff [default: the first]");
  app.add_option("--potential-file", a->user_potential,
                 "Your own pair_style and pair_coeff lines, an atom type for each species");
  add_law(app, a->lj, a->lj_cutoff);
  app.add_flag("--envelope", a->envelope, "Measure kink, collapse and 1 % limits with LAMMPS (minutes)");
  app.add_option("--envelope-of", a->envelope_of,
                 "Take them from this set of the same tube and potential instead, with the rows of its table");
  app.add_option("--out", a->out, "Parameter file; its tables lie beside it [default: cnt-N-M-POTENTIAL.toml, bn-...]");
  app.add_option("--keep", a->keep, "Keep LAMMPS's inputs and logs in this new directory");
  app.add_option("--cell-length", a->stiffness.cell_length, "Least length of the periodic cells (nm); 0: chosen")
      ->capture_default_str();
  app.add_option("--strain", a->stiffness.largest_strain, "Fit window of stretch")->capture_default_str();
  app.add_option("--shear", a->stiffness.largest_shear, "Fit window of twist: radius times twist")
      ->capture_default_str();
  app.add_option("--bend-lengths", a->bend_lengths,
                 "Free lengths of the shorter and the longer bent tube (nm) [default: 6,10; several walls: 3 and 6 outer "
                 "diameters, at most 6 and 12 nm]");
  app.add_flag("--json", a->json, "JSON");
  app.add_flag("--force", a->force, "Replace existing files");
  app.add_flag("--quiet", a->quiet, "No progress lines");
  app.callback([&app, a, &program] {
    if (!app.get_subcommands().empty()) return;
    if ((a->walls > 0) != (a->outer_diameter > 0) || (a->walls > 0 && !a->chirality.empty()))
      throw InputError({"", 0, "--walls"}, "goes with --outer-diameter, in place of --chirality",
                       "write --walls 3 --outer-diameter 2.5");
    a->usual_cutoff = app.count("--lj-cutoff") == 0;
    if (a->chirality.empty() && a->walls == 0)
      throw InputError({"", 0, "--chirality"}, "is missing", "write --chirality 10,10, or see --help");
    program.code = calibrate_command(*a);
  });
}

}  // namespace ropewalk::calibrate
