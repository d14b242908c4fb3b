#include "exchange/coarsen.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/removal.hpp"
#include "run/colours.hpp"
#include "run/limit_watch.hpp"
#include "run/wall_time.hpp"
#include "scene/bounds.hpp"
#include "scene/scene_toml.hpp"
#include "scene/single_state.hpp"
#include "scene/state_csv.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

constexpr double farthest = 0.08;     // nm: an atom farther from its place has no site
constexpr double emptiest = 0.5;      // least part of the sites of an element that must have an atom
constexpr double most_misfits = 0.2;  // largest part of a tube's sites
constexpr int fewest_elements = 2;
constexpr int most_rounds_of_misfits = 3;

// The largest distance of two rows that follow one another, in thirds of a hexagon.
long largest_gap(Chirality c) {
  const long period = 3L * std::gcd(c.n, c.m), offset = (((c.n - c.m) % period) + period) % period;
  return std::max(offset, period - offset);
}

// Whole elements below `top` (thirds of a hexagon), where the row above it would follow.
int elements_below(const TubeReference& reference, long top, double element_length) {
  const double end =
      static_cast<double>(top - 1 + largest_gap(reference.chirality)) / 3 * reference.shape.length_per_hexagon;
  return static_cast<int>(std::floor(end / element_length + 1e-6));
}

// That of the sets, which are of one; carbon where none is named.
Honeycomb honeycomb_of(const CoarsenSettings& settings) {
  Honeycomb out;
  for (std::size_t k = 0; k < settings.parameters.size(); ++k) {
    const ParameterSet set = read_parameters(find_parameters(settings.parameters[k], ""));
    if (k > 0 && set.honeycomb.name != out.name)
      throw InputError({set.path, 0, "--parameters"},
                       fmt::format("is a set of {}, and the first one of {}", set.honeycomb.name, out.name),
                       "read the tubes of one honeycomb at a time");
    out = set.honeycomb;
  }
  return out;
}

std::string chirality_name(Chirality c) { return fmt::format("({},{})", c.n, c.m); }

// A shipped set; Tersoff's potential is preferred.
std::string shipped_set_of(Chirality c, const std::string& file) {
  const std::string begin = fmt::format("cnt-{}-{}-", c.n, c.m);
  std::string found;
  for (const std::string& name : shipped_sets())
    if (name.rfind(begin, 0) == 0 && name != begin + "paper" && (found.empty() || name == begin + "tersoff"))
      found = name;
  if (found.empty())
    throw InputError(
        {file, 0, "--parameters"},
        fmt::format("it has a {} tube, and no shipped set is of these", chirality_name(c)),
        fmt::format("make one: ropewalk calibrate --chirality {},{}; and give it by --parameters", c.n, c.m));
  return found;
}

constexpr std::array<OutputColumn, 7> columns_of_sections = {{
    {"tube", "", "tube, from 0"},
    {"element", "", "element of the tube, from 0"},
    {"radius_nm", "nm", "mean radius of its atoms"},
    {"ovality_nm", "nm",
     "amplitude of the radius twice around: half of the difference of the widest and the narrowest radius"},
    {"shear_x_rad", "rad", "angle of the centre line against the normal of the section, along the body's x"},
    {"shear_y_rad", "rad", "along the body's y"},
    {"atoms", "", "atoms of the element over the sites that it has"},
}};

constexpr std::array<OutputColumn, 15> columns_of_tubes = {{
    {"tube", "", "tube, from 0"},
    {"n", "", "first number of its chirality; n < m: the mirror image of (m,n)"},
    {"m", "", "second number of its chirality"},
    {"elements", "", "elements"},
    {"atoms", "", "carbon atoms in elements"},
    {"atoms_in_no_element", "", "carbon atoms of this wall that are in none"},
    {"endless", "", "1: it goes through a periodic box, and is cut open there"},
    {"cap_first", "", "1: its first end has a cap"},
    {"cap_last", "", "1: its last end has a cap"},
    {"pentagons", "", "rings of five atoms"},
    {"heptagons", "", "rings of seven atoms"},
    {"atoms_beside_holes", "", "atoms with two neighbours, away from the ends"},
    {"atoms_with_four_bonds", "", "atoms with four neighbours or more"},
    {"radius_nm", "nm", "mean radius"},
    {"misfit_nm", "nm",
     "root mean square of the distance between the atoms and the places that the elements imply for them"},
}};

std::string found_tubes_csv(const std::vector<CoarseTube>& tubes) {
  std::string text = column_names(columns_of_tubes) + "\n";
  for (std::size_t k = 0; k < tubes.size(); ++k) {
    const CoarseTube& t = tubes[k];
    text += fmt::format("{},{},{},{},{},{},{:d},{:d},{:d},{},{},{},{},{:.6g},{:.6g}\n", k, t.chirality.n,
                        t.chirality.m, t.elements, t.atoms, t.without_site, t.endless, t.cap_below, t.cap_above,
                        t.pentagons, t.heptagons, t.open_atoms, t.crowded, t.radius, t.misfit);
  }
  return text;
}

}  // namespace

std::vector<OutputColumn> found_tube_columns() { return {columns_of_tubes.begin(), columns_of_tubes.end()}; }
std::vector<OutputColumn> section_columns() { return {columns_of_sections.begin(), columns_of_sections.end()}; }

std::string words_of(const CoarseTube& t) {
  std::string text =
      fmt::format("{}, {} elements of {} atoms, mean radius {:.4f} nm, atoms {:.4f} nm from their places",
                  chirality_name(t.chirality), t.elements, t.atoms, t.radius, t.misfit);
  const auto add = [&](long count, const char* one, const char* many) {
    if (count > 0) text += fmt::format(", {} {}", count, count == 1 ? one : many);
  };
  if (t.endless) text += ", endless: cut open at the box";
  add(t.without_site, "atom in no element", "atoms in no element");
  if (t.cap_below || t.cap_above)
    text += t.cap_below && t.cap_above ? ", capped at both ends"
                                       : fmt::format(", capped at the {} end", t.cap_below ? "first" : "last");
  add(t.pentagons, "pentagon", "pentagons");
  add(t.heptagons, "heptagon", "heptagons");
  add(t.open_atoms, "atom beside a hole", "atoms beside holes");
  add(t.crowded, "atom with four bonds", "atoms with four bonds");
  return text;
}

Coarsening::Coarsening(const CoarsenSettings& settings)
    : Coarsening(settings,
                 std::make_unique<AtomFiles>(settings.files, settings.time_step_fs, honeycomb_of(settings))) {}

Coarsening::Coarsening(const CoarsenSettings& settings, std::unique_ptr<AtomSource> atoms)
    : settings_(settings), honeycomb_(honeycomb_of(settings)), atoms_(std::move(atoms)) {
  if (!atoms_->next(frame_)) throw InputError({atoms_->file(), 0, ""}, "has no frame", "give one or more");
  bool second = honeycomb_.one_species();
  for (const char species : frame_.species) {
    foreign_ += species ? 0 : 1;
    second = second || species == 2;
  }
  if (!second)
    throw InputError({atoms_->file(), 0, ""},
                     fmt::format("has no atom of {}, and the sets are of {}", honeycomb_.species[1], honeycomb_.name),
                     "give a file that names the species of its atoms, or sets of its tubes");
  find();
  choose_sets();
  fit_first();
}

void Coarsening::find() {
  if (frame_.box.periodic_known) {
    found_ = find_tubes(frame_.positions, frame_.species, frame_.box, atoms_->file(), honeycomb_);
    return;
  }
  // A data file does not say whether its box is periodic. In a box shrunk around open tubes their ends would touch.
  AtomBox open = frame_.box;
  open.periodic = {false, false, false};
  try {
    found_ = find_tubes(frame_.positions, frame_.species, frame_.box, atoms_->file(), honeycomb_);
    return;
  } catch (const InputError&) {
  }
  frame_.box = open;
  found_ = find_tubes(frame_.positions, frame_.species, frame_.box, atoms_->file(), honeycomb_);
}

void Coarsening::choose_sets() {
  std::vector<ParameterSet> given;
  for (const std::string& name : settings_.parameters) given.push_back(read_parameters(find_parameters(name, "")));
  std::vector<int> types;
  for (const FoundTube& tube : found_.tubes) {
    const auto same = [&](const ParameterSet& set) {
      return set.walls.empty() && set.chirality.n == tube.chirality.n && set.chirality.m == tube.chirality.m;
    };
    auto at = std::find_if(sets_.begin(), sets_.end(), same);
    if (at == sets_.end()) {
      if (given.empty()) {
        sets_.push_back(read_parameters(find_parameters(shipped_set_of(tube.chirality, atoms_->file()), "")));
      } else {
        const auto own = std::find_if(given.begin(), given.end(), same);
        if (own == given.end())
          throw InputError(
              {atoms_->file(), 0, "--parameters"},
              fmt::format("it has a {} tube, and none of the sets is of these", chirality_name(tube.chirality)),
              fmt::format("make one: ropewalk calibrate --chirality {},{}", tube.chirality.n, tube.chirality.m));
        sets_.push_back(*own);
      }
      at = sets_.end() - 1;
    }
    types.push_back(static_cast<int>(at - sets_.begin()));
  }
  const double a = settings_.element_length > 0 ? settings_.element_length : sets_.front().element_length;
  topology_.types.resize(sets_.size());
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    topology_.types[k].element_length = a;
    topology_.types[k].radius = sets_[k].radius;
  }
  topology_.tube_type = std::move(types);
}

void Coarsening::fit_first() {
  positions_ = found_.positions;
  const double a = topology_.types.front().element_length;
  for (std::size_t t = 0; t < found_.tubes.size(); ++t) {
    FoundTube& tube = found_.tubes[t];
    const TubeReference reference = reference_of(sets_[static_cast<std::size_t>(topology_.tube_type[t])]);
    State state;
    std::optional<ElementFit> fit;
    // Atoms of a cap or beside a defect may have a site that they do not stand on: taken out, and the rest fitted
    // again.
    for (int round = 0;; ++round) {
      const int elements = elements_below(reference, tube.top, a);
      if (elements < fewest_elements)
        throw InputError(
            {atoms_->file(), 0, ""},
            fmt::format("a {} tube is {:.3g} nm long, shorter than {} elements of {:.4g} nm",
                        chirality_name(tube.chirality),
                        static_cast<double>(tube.top) / 3 * reference.shape.length_per_hexagon, fewest_elements, a),
            "take shorter ones by --element-length-nm");
      fit.emplace(reference, a, elements, tube.atoms);
      for (int e = 0; e < elements; ++e)
        if (fit->filled(e) < emptiest) {
          const Vector3 at = tube.centre;
          throw InputError(
              {atoms_->file(), 0, ""},
              fmt::format("element {} of a {} tube around ({:.2f}, {:.2f}, {:.2f}) nm has {:.0f} % of its "
                          "atoms",
                          e, chirality_name(tube.chirality), at.x(), at.y(), at.z(), 100 * fit->filled(e)),
              "take longer elements by --element-length-nm, or a tube with fewer defects");
        }
      state = State(static_cast<std::size_t>(elements));
      fit->fit(positions_, state, 0);
      if (round == most_rounds_of_misfits) break;
      const std::vector<double> misfits = fit->misfits(positions_, state, 0);
      std::vector<LabelledAtom> kept;
      std::vector<char> bad(positions_.size(), 0);
      for (std::size_t k = 0; k < misfits.size(); ++k) bad[fit->atoms()[k].atom] = misfits[k] > farthest;
      for (const LabelledAtom& atom : tube.atoms)
        if (!bad[atom.atom]) kept.push_back(atom);
      if (kept.size() == tube.atoms.size()) break;
      tube.without_site += static_cast<long>(tube.atoms.size() - kept.size());
      tube.atoms = std::move(kept);
      trim(tube);
    }
    const long sites = SiteRows(tube.chirality).sites_between(0, tube.top);
    const double missing = 1 - static_cast<double>(tube.atoms.size()) / static_cast<double>(sites);
    if (missing > most_misfits)
      throw InputError(
          {atoms_->file(), 0, ""},
          fmt::format("{:.0f} % of the sites of a {} tube around ({:.2f}, {:.2f}, {:.2f}) nm have no atom",
                      100 * missing, chirality_name(tube.chirality), tube.centre.x(), tube.centre.y(),
                      tube.centre.z()),
          "such a tube is no chain of elements: minimise it, or take it out");
    // The lattice has equal parts of a turn: take the one that turns the first element least.
    const int g = std::gcd(tube.chirality.n, tube.chirality.m);
    int best = 0;
    double most = -1;
    for (int k = 0; k < g; ++k) {
      const Quaternion q =
          state.orientation[0] * Quaternion(Eigen::AngleAxisd(2 * units::pi * k / g, Vector3::UnitZ()));
      if (std::fabs(q.w()) > most + 1e-9) {
        most = std::fabs(q.w());
        best = k;
      }
    }
    turn_sites(tube, best);
    fits_.emplace_back(reference, a, fit->elements(), tube.atoms);
    topology_.tube_begin.push_back(topology_.tube_begin.back() + fit->elements());
    CoarseTube told;
    told.chirality = tube.chirality;
    told.elements = fit->elements();
    told.atoms = static_cast<long>(fits_.back().atoms().size());
    told.without_site = tube.without_site + static_cast<long>(tube.atoms.size()) - told.atoms;
    told.pentagons = tube.pentagons;
    told.heptagons = tube.heptagons;
    told.open_atoms = tube.open_atoms;
    told.crowded = tube.crowded;
    told.cap_below = tube.cap_below;
    told.cap_above = tube.cap_above;
    told.endless = tube.endless;
    tubes_.push_back(told);
  }
  if (topology_.elements() > max_elements)
    throw InputError({atoms_->file(), 0, ""}, fmt::format("makes more than {} elements", max_elements),
                     "take fewer atoms");
  fit();
  for (std::size_t t = 0; t < tubes_.size(); ++t) {
    tubes_[t].radius = mean_radius(t);
    tubes_[t].misfit = misfit(t);
  }
}

void Coarsening::fit() {
  state_ = State(static_cast<std::size_t>(topology_.elements()));
  state_.time = frame_.time;
  state_.step = frame_.step;
  for (std::size_t t = 0; t < fits_.size(); ++t) {
    const auto first = static_cast<std::size_t>(topology_.tube_begin[t]);
    fits_[t].fit(positions_, state_, first);
    if (has_velocities()) fits_[t].fit_velocities(positions_, frame_.velocities, state_, first);
  }
  shapes_.clear();
  for (std::size_t t = 0; t < fits_.size(); ++t) {
    const std::vector<SectionShape> own =
        fits_[t].shapes(positions_, state_, static_cast<std::size_t>(topology_.tube_begin[t]));
    shapes_.insert(shapes_.end(), own.begin(), own.end());
  }
}

double Coarsening::mean_radius(std::size_t tube) const {
  double sum = 0;
  for (int e = topology_.tube_begin[tube]; e < topology_.tube_begin[tube + 1]; ++e)
    sum += shapes_[static_cast<std::size_t>(e)].radius;
  return sum / (topology_.tube_begin[tube + 1] - topology_.tube_begin[tube]);
}

double Coarsening::misfit(std::size_t tube) const {
  double squares = 0;
  for (const double d : fits_[tube].misfits(positions_, state_, static_cast<std::size_t>(topology_.tube_begin[tube])))
    squares += d * d;
  return std::sqrt(squares / static_cast<double>(tubes_[tube].atoms));
}

bool Coarsening::next() {
  AtomFrame frame;
  const bool periodic = frame_.box.periodic_known;
  if (!atoms_->next(frame)) return false;
  if (!periodic) frame.box.periodic = frame_.box.periodic;
  if (!(frame.time > frame_.time))
    throw InputError({atoms_->file(), 0, ""},
                     fmt::format("a frame at {:g} ps comes after one at {:g} ps", frame.time, frame_.time),
                     "give the frames of one simulation in the order of their times, each once");
  frame_ = std::move(frame);
  // The images that have moved as their neighbours have: a rope that drifts through its box stays whole.
  const NearestImage nearest(frame_.box);
  Vector3 way = Vector3::Zero();
  for (const ElementFit& fit : fits_)
    for (const LabelledAtom& atom : fit.atoms()) {
      Vector3& at = positions_[atom.atom];
      way += nearest(frame_.positions[atom.atom] - at - way);
      at += way;
    }
  fit();
  // A flat ribbon has 0.79 of the radius of the tube that collapsed to it, and its atoms are nearer than that to their
  // places.
  for (std::size_t t = 0; t < tubes_.size(); ++t)
    if (const double radius = mean_radius(t), first = tubes_[t].radius, off = misfit(t);
        !(radius > 0.5 * first && radius < 1.5 * first && off < first))
      throw InputError({atoms_->file(), 0, ""},
                       fmt::format("at {:g} ps the atoms of tube {} lie {:.3g} nm from its axis, in the first frame "
                                   "{:.3g} nm, and {:.3g} nm from their places in its elements",
                                   frame_.time, t, radius, first, off),
                       "are they in another order than in the first frame, lengths not in Angstrom, or has it fallen "
                       "apart?");
  return true;
}

namespace {

std::string scene_text(const Coarsening& coarse, const CoarsenSettings& settings,
                       const std::vector<std::string>& sets) {
  const Topology& topology = coarse.topology();
  std::string name = std::filesystem::path(settings.files.back()).stem().string();
  for (char& c : name)
    if (c == '"' || c == '\\') c = '_';
  std::string text = "# Elements that were taken from atoms: this scene was not run.\n";
  text += fmt::format("format = \"{}\"\nname = \"atoms of {}\"\n", scene_format, name);
  if (sets.size() == 1) {
    text += fmt::format("parameters = \"{}\"\n", sets.front());
  } else {
    text += "parameters = [";
    for (std::size_t k = 0; k < sets.size(); ++k) text += fmt::format("{}\"{}\"", k ? ", " : "", sets[k]);
    text += fmt::format("]\ntube_types = [{}]\n", fmt::join(topology.tube_type, ", "));
  }
  text += fmt::format("element_length_nm = {}\n\n[state]\nfile = \"state.csv\"\n\n",
                      topology.types.front().element_length);
  return text + "[run]\nduration_ps = 1\n";
}

// The means of shapes over frames.
class Sections {
 public:
  void add(const std::vector<SectionShape>& shapes) {
    if (sums_.empty()) sums_.resize(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      sums_[i].radius += shapes[i].radius;
      sums_[i].ovality += shapes[i].ovality;
      sums_[i].shear_x += shapes[i].shear_x;
      sums_[i].shear_y += shapes[i].shear_y;
    }
    ++frames_;
  }
  std::string csv(const Topology& topology, const std::vector<double>& filled) const {
    std::string text = column_names(columns_of_sections) + "\n";
    for (int t = 0; t < topology.tubes(); ++t)
      for (int e = topology.tube_begin[static_cast<std::size_t>(t)];
           e < topology.tube_begin[static_cast<std::size_t>(t) + 1]; ++e) {
        const SectionShape& s = sums_[static_cast<std::size_t>(e)];
        text += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", t,
                            e - topology.tube_begin[static_cast<std::size_t>(t)], s.radius / frames_,
                            s.ovality / frames_, s.shear_x / frames_, s.shear_y / frames_,
                            filled[static_cast<std::size_t>(e)]);
      }
    return text;
  }

 private:
  std::vector<SectionShape> sums_;
  double frames_ = 0;
};

}  // namespace

std::vector<double> Coarsening::filled() const {
  std::vector<double> out;
  for (const ElementFit& fit : fits_)
    for (int e = 0; e < fit.elements(); ++e) out.push_back(fit.filled(e));
  return out;
}

namespace {

CoarseRun write_files_of(Coarsening& coarse, const CoarsenSettings& settings, const RunDirectory& to,
                         RunListener& listener) {
  const RunClock clock;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < coarse.sets().size(); ++k) {
    write_file_atomically(to.parameters(k), read_file(coarse.sets()[k].path));
    names.push_back(std::filesystem::path(to.parameters(k)).filename().string());
  }
  write_file_atomically(to.state(), state_csv(coarse.topology(), coarse.state()));
  write_file_atomically(to.scene(), scene_text(coarse, settings, names));
  Scene scene = read_run_scene(to);
  const Prepared prepared = prepare(scene);
  const Observer observer = make_observer(scene, prepared);
  LimitWatch watch(watched_by_run(scene, prepared, observer));
  GrowingFile log(to.log(), 0);
  log.write(log_header());
  NewFrames frames(to.frames(FrameFormat::gsd), FrameFormat::gsd, 0);
  Sections sections;
  CoarseRun done;
  EnergyAccount account;
  account.time_step = prepared.time_step;
  do {
    const State& state = coarse.state();
    const Forces forces =
        forces_of(prepared.topology, prepared.interaction, state, false, {settings.files.back(), 0, ""});
    account.potential = forces.energy;
    account.kinetic = coarse.has_velocities() ? kinetic_energy(prepared.topology, state) : 0;
    if (done.frames == 0) {
      account.first = forces.energy;
      account.first_energy = forces.energy.potential() + account.kinetic;
    }
    log.write(log_line(log_row(observer, scene, prepared.topology, state, account)));
    frames->write(prepared.topology, state, element_colours(prepared.topology, prepared.interaction, state));
    NeighbourList list(prepared.interaction, default_skin(prepared.interaction));
    list.build(prepared.topology, state);
    for (const std::string& line : watch.check(prepared.topology, state, list, {}, true)) listener.tell(line);
    sections.add(coarse.shapes());
    ++done.frames;
    done.time = state.time;
    const std::string stop = listener.asked_to_stop();
    if (!stop.empty()) {
      listener.tell("stopped " + stop + ": the frames so far are kept");
      break;
    }
  } while (coarse.next());
  log.sync();
  frames.replace();
  LimitsFile limits;
  limits.limits = watch.records();
  write_file_atomically(to.limits(), limits_json(limits));
  write_file_atomically(to.file("found-tubes.csv"), found_tubes_csv(coarse.tubes()));
  write_file_atomically(to.file("sections.csv"), sections.csv(coarse.topology(), coarse.filled()));
  write_file_atomically(to.final_state(), state_csv(coarse.topology(), coarse.state()));
  Manifest m;
  m.version = version;
  m.git_id = git_id;
  m.compiler = compiler;
  m.build_type = build_type;
  m.instructions = instructions_in_use();
  m.threads = threads_in_use();
  m.seed = scene.start.seed;
  m.scene_hash = scene.hash;
  m.parameter_hash = scene.parameters().hash;
  m.grade = fmt::format("{}", fmt::join(grades_of(scene), "; "));
  m.started = clock.begun;
  m.wall_seconds = clock.seconds();
  m.steps = coarse.state().step;
  m.time_step_fs = settings.time_step_fs;
  m.status = "taken from atoms";
  m.reason = fmt::format("{} frames of {}", done.frames, fmt::join(settings.files, ", "));
  m.scene = scene.name;
  write_file_atomically(to.manifest(), manifest_json(m));
  done.passed = passed_words(watch.records());
  return done;
}

}  // namespace

CoarseRun write_coarse_run(Coarsening& coarse, const CoarsenSettings& settings, const RunDirectory& to, bool force,
                           RunListener& listener) {
  const DirectoryLock lock = create_run_directory(to, force);
  try {
    return write_files_of(coarse, settings, to, listener);
  } catch (...) {
    empty_run_directory(to);  // half of it would stand in the way of the same command
    throw;
  }
}

}  // namespace ropewalk
