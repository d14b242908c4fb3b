#include "exchange/atoms_of_state.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "atoms/atom_files.hpp"
#include "io/draft.hpp"
#include "io/file_group.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/limits_file.hpp"
#include "io/removal.hpp"
#include "run/colours.hpp"
#include "run/events_file.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::string beside(const std::string& path, const char* ending) {
  return (fs::path(path).parent_path() / (fs::path(path).stem().string() + ending)).string();
}

std::vector<TubeReference> references_of(const std::vector<ParameterSet>& sets) {
  std::vector<TubeReference> out;
  for (const ParameterSet& set : sets) out.push_back(reference_of(set));
  return out;
}

std::size_t index_of(const Topology& topology, int tube, int element) {
  return static_cast<std::size_t>(topology.tube_begin[static_cast<std::size_t>(tube)] + element);
}

// The ends of each part, and elements that the run holds.
bool is_held(const AtomicState& s, const TubePart& part, int element) {
  return element == part.begin || element + 1 == part.end || s.held[index_of(s.topology, part.tube, element)];
}

std::vector<AtomRange> held_atoms(const AtomicState& s, const std::vector<TubePart>& parts,
                                  const std::vector<AtomRange>& ranges) {
  std::vector<AtomRange> held;
  for (const AtomRange& range : ranges)
    if (is_held(s, parts[static_cast<std::size_t>(range.part)], range.element)) held.push_back(range);
  return held;
}

// Energies of the model, of these parts alone and without the elements that are held.
void add_model_energies(const AtomicState& s, std::vector<PartComparison>& parts) {
  Topology topology;
  topology.types = s.topology.types;
  std::vector<std::size_t> from;
  for (const PartComparison& p : parts) {
    topology.add_tube(p.part.elements(), s.topology.tube_type[static_cast<std::size_t>(p.part.tube)]);
    for (int e = p.part.begin; e < p.part.end; ++e) from.push_back(index_of(s.topology, p.part.tube, e));
  }
  State state(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    state.position.set(i, s.state.position[from[i]]);
    state.orientation.set(i, s.state.orientation[from[i]]);
  }
  const ElementColours energies = element_colours(topology, s.interaction, state);
  std::size_t i = 0;
  for (PartComparison& p : parts)
    for (int e = p.part.begin; e < p.part.end; ++e, ++i) {
      if (is_held(s, p.part, e)) continue;
      p.bonds += energies.bond_energy[i];
      p.contact += energies.vdw_energy[i];
    }
}

// Energy (eV) of the atoms of a part where the tube is straight and at rest, relaxed alike.
double energy_at_rest(const AtomicState& s, const TubePart& part, const AtomForces& forces,
                      const std::string& folder, const LammpsOptions& options) {
  AtomicState rest;
  rest.sets = s.sets;
  rest.topology.types = s.topology.types;
  rest.topology.add_tube(part.end, s.topology.tube_type[static_cast<std::size_t>(part.tube)]);
  rest.state = State(static_cast<std::size_t>(part.end));
  rest.held.assign(rest.state.size(), 0);
  for (int e = part.begin; e < part.end; ++e)
    rest.held[static_cast<std::size_t>(e)] = s.held[index_of(s.topology, part.tube, e)];
  const double a = s.topology.type_of(part.tube).element_length;
  for (int e = 0; e < part.end; ++e)
    rest.state.position.set(static_cast<std::size_t>(e), Vector3(0, 0, (e + 0.5) * a));
  const std::vector<TubePart> parts = {{0, part.begin, part.end}};
  const AtomsOfElements atoms(rest.topology, rest.state, references_of(rest.sets), parts);
  const std::vector<AtomRange> ranges =
      write_atoms(folder + "/rest.data", AtomFormat::lammps_data, atoms, "straight tube", 0);
  return relax_atoms(folder, "rest", forces, 1, held_atoms(rest, parts, ranges), options).front().after;
}

// Looks for the flattest section of each part, among elements that are not held. A section is the atoms of an
// element, seen along the line through the centres of its neighbours; thickness and width are those of an ellipse
// with the same second moments.
void add_flatness(const AtomicState& s, const std::vector<AtomRange>& ranges, const std::vector<Vector3>& atoms,
                  std::vector<PartComparison>& parts) {
  std::vector<Vector3> centres;
  for (const AtomRange& r : ranges) {
    Vector3 sum = Vector3::Zero();
    for (long k = r.first - 1; k < r.last; ++k) sum += atoms[static_cast<std::size_t>(k)];
    centres.emplace_back(sum / static_cast<double>(r.last - r.first + 1));
  }
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const AtomRange& r = ranges[k];
    PartComparison& p = parts[static_cast<std::size_t>(r.part)];
    if (is_held(s, p.part, r.element)) continue;  // so that it has both neighbours
    const Vector3 axis = (centres[k + 1] - centres[k - 1]).normalized();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (long i = r.first - 1; i < r.last; ++i) {
      const Vector3 from = atoms[static_cast<std::size_t>(i)] - centres[k], across = from - from.dot(axis) * axis;
      moments += across * across.transpose();
    }
    const Vector3 found =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues();
    const double flatness = std::sqrt(std::max(0.0, found[1]) / found[2]);
    if (p.flattest >= 0 && flatness >= p.flatness) continue;
    p.flatness = flatness;
    p.flattest = r.element;
  }
}

}  // namespace

AtomicState state_in_scene(const Scene& scene, const Prepared& prepared, const State& state) {
  AtomicState out;
  out.sets = scene.sets;
  out.topology = prepared.topology;
  out.state = state;
  out.interaction = prepared.interaction;
  out.held.assign(state.size(), 0);
  for (const std::vector<int>& end : ends_of(prepared.loads, prepared.topology))
    for (const int e : end) out.held[static_cast<std::size_t>(e)] = 1;
  out.title = fmt::format("{} at {:.6g} ps", scene.name, state.time);
  return out;
}

std::vector<char> broken_flags(std::size_t elements, const std::vector<int>& broken) {
  std::vector<char> flags;
  if (!broken.empty()) flags.assign(elements, 0);
  for (const int e : broken) flags[static_cast<std::size_t>(e)] = 1;
  return flags;
}

AtomicState state_of_frame(const RunDirectory& dir, long frame) {
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const auto frames = open_frames(dir.frames());
  const auto count = static_cast<long>(frames->count(prepared.topology));
  const long wanted = frame < 0 ? count + frame : frame;
  if (wanted < 0 || wanted >= count)
    throw InputError(
        {dir.frames(), 0, "--frame"}, fmt::format("there is no frame {}: there are {}", frame, count),
        count > 0 ? fmt::format("frames run from 0 to {}; -1 is the last", count - 1) : "let the run write one");
  frames->seek(static_cast<std::size_t>(wanted));
  StoredFrame stored;
  frames->next(prepared.topology, stored);
  AtomicState out = state_in_scene(scene, prepared, stored.state);
  out.broken = StoredEvents(dir.events(), prepared.topology).broken_at(stored.state.time);
  return out;
}

AtomicState state_of_file(const SingleState& state, const std::string& path) {
  EvaluatedState found = evaluate(state);
  AtomicState out;
  out.sets = std::move(found.sets);
  out.topology = std::move(found.built.topology);
  out.state = std::move(found.built.state);
  out.interaction = std::move(found.interaction);
  out.held.assign(out.state.size(), 0);
  out.broken = broken_flags(out.state.size(), found.broken);
  out.title = fs::path(path).filename().string();
  return out;
}

LimitPlace place_of_limit(const RunDirectory& dir, const std::string& limit) {
  const std::vector<LimitRecord> limits = read_limits(dir.limits()).limits;
  const auto known =
      std::find_if(limits.begin(), limits.end(), [&](const LimitRecord& r) { return r.key == limit; });
  if (known == limits.end() || !known->passed) {
    std::string passed;
    for (const LimitRecord& r : limits)
      if (r.passed) passed += (passed.empty() ? "" : ", ") + r.key;
    const std::string remedy = passed.empty() ? "no limit was: name a frame by --frame" : "passed were: " + passed;
    if (known == limits.end())
      throw InputError({dir.limits(), 0, "--at"}, fmt::format("there is no limit \"{}\"", limit), remedy);
    throw InputError({dir.limits(), 0, "--at"}, fmt::format("{} was not passed", limit), remedy);
  }
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  LimitPlace place;
  place.limit = limit;
  place.step = known->passed_at_step;
  place.tube = known->passed_tube;
  place.element = known->passed_element;
  const auto frames = open_frames(dir.frames());
  StoredFrame stored;
  for (long k = 0; frames->next(prepared.topology, stored); ++k) {
    if (stored.state.step > known->passed_at_step) break;
    place.frame = k;
    place.before_ps = known->passed_at_ps - stored.state.time;
  }
  const std::string at = place_words(*known);
  place.words = fmt::format("{} is passed {}{}", known->key, since_words(*known), at.empty() ? "" : ": " + at);
  return place;
}

std::vector<TubePart> selected_parts(const AtomicState& s, const AtomSelection& selection) {
  for (const int t : selection.tubes)
    if (t < 0 || t >= s.topology.tubes())
      throw InputError({"", 0, "--tubes"}, fmt::format("there is no tube {}", t),
                       fmt::format("tubes run from 0 to {}", s.topology.tubes() - 1));
  std::vector<TubePart> parts;
  for (int t = 0; t < s.topology.tubes(); ++t) {
    if (!selection.tubes.empty() &&
        std::find(selection.tubes.begin(), selection.tubes.end(), t) == selection.tubes.end())
      continue;
    const double a = s.topology.type_of(t).element_length;
    bool before = false;
    for (int e = 0; e < s.topology.length_of(t); ++e) {
      const double along = (e + 0.5) * a;
      bool wanted =
          (!selection.from_nm || along >= *selection.from_nm) && (!selection.to_nm || along <= *selection.to_nm);
      if (wanted && selection.around_tube >= 0) {
        const Vector3 place =
            s.state.position[index_of(s.topology, selection.around_tube, selection.around_element)];
        wanted = (s.state.position[index_of(s.topology, t, e)] - place).norm() <= 0.5 * selection.around_nm;
      }
      if (wanted && before)
        parts.back().end = e + 1;
      else if (wanted)
        parts.push_back({t, e, e + 1});
      before = wanted && (s.broken.empty() || !s.broken[index_of(s.topology, t, e)]);
    }
  }
  if (parts.empty())
    throw InputError({"", 0, ""}, "no element was asked for", "look at --tubes, --between and --length");
  return parts;
}

WrittenAtoms write_atoms_of(const AtomicState& s, const std::vector<TubePart>& parts, const std::string& path,
                            const std::string& potential) {
  const AtomFormat format = atom_format_of(path);
  const AtomsOfElements atoms(s.topology, s.state, references_of(s.sets), parts, s.broken);
  WrittenAtoms out;
  std::optional<AtomForces> forces;
  try {
    if (format == AtomFormat::lammps_data) forces = atom_forces(s.sets, potential);
  } catch (const InputError& e) {
    if (!potential.empty()) throw;
    out.not_relaxable = e.what();
  }
  // All of them, or none.
  Draft all(path);
  out.ranges = write_atoms(all, format, atoms, s.title, s.state.time);
  out.atoms = out.ranges.back().last;
  std::string table = "tube,element,first_atom,last_atom\n";
  for (const AtomRange& r : out.ranges) table += fmt::format("{},{},{},{}\n", r.tube, r.element, r.first, r.last);
  out.files = {path, beside(path, "-elements.csv")};
  std::vector<std::pair<std::string, std::string>> beside_it = {{out.files.back(), table}};
  if (forces) {
    out.files.push_back(beside(path, "-relax.in"));
    beside_it.emplace_back(out.files.back(), relax_input(fs::path(path).stem().string(), *forces, parts.size(),
                                                         held_atoms(s, parts, out.ranges)));
  }
  write_files_together(beside_it);
  all.replace();
  return out;
}

namespace {

// Relaxes the atoms in a folder, and sets what they have against the model.
void compare_in(const TemporaryFolder& work, const AtomicState& s, const std::vector<TubePart>& parts,
                const WrittenAtoms& written, const std::string& path, const AtomForces& forces,
                const LammpsOptions& options, std::vector<PartComparison>& out) {
  write_file_atomically(work.file("atoms.data"), read_file(path));
  const std::vector<PartEnergies> found =
      relax_atoms(work.path(), "atoms", forces, parts.size(), held_atoms(s, parts, written.ranges), options);
  AtomFiles relaxed({work.file("atoms-relaxed.data")}, 1);
  AtomFrame frame;
  relaxed.next(frame);
  add_flatness(s, written.ranges, frame.positions, out);
  // Parts with the same sites, held alike, have the same energy at rest.
  std::map<std::tuple<int, int, int, std::vector<char>>, double> at_rest;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<char> held;
    for (int e = parts[p].begin; e < parts[p].end; ++e)
      held.push_back(s.held[index_of(s.topology, parts[p].tube, e)]);
    const std::tuple key(s.topology.tube_type[static_cast<std::size_t>(parts[p].tube)], parts[p].begin,
                         parts[p].end, held);
    if (at_rest.find(key) == at_rest.end())
      at_rest[key] = energy_at_rest(s, parts[p], forces, work.path(), options);
    out[p].placed = found[p].before - at_rest[key];
    out[p].relaxed = found[p].after - at_rest[key];
  }
  write_file_atomically(beside(path, "-relaxed.data"), read_file(work.file("atoms-relaxed.data")));
}

}  // namespace

std::vector<PartComparison> compare_with_atoms(const AtomicState& s, const std::vector<TubePart>& parts,
                                               const WrittenAtoms& written, const std::string& path,
                                               const std::string& potential, const LammpsOptions& options) {
  const AtomForces forces = atom_forces(s.sets, potential);
  std::vector<PartComparison> out;
  for (const TubePart& part : parts) out.push_back({part});
  for (const AtomRange& r : written.ranges)
    if (const auto part = static_cast<std::size_t>(r.part); !is_held(s, parts[part], r.element))
      out[part].atoms += r.last - r.first + 1;
  add_model_energies(s, out);
  const fs::path place = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  TemporaryFolder work(place.string());
  try {
    compare_in(work, s, parts, written, path, forces, options, out);
  } catch (const LammpsDiskFull&) {
    throw;
  } catch (const LammpsError&) {  // it names files in that folder
    if (!options.interrupted || !options.interrupted()) work.keep();
    throw;
  }
  return out;
}

std::string verdict_on_walls(const std::vector<PartComparison>& parts) {
  constexpr double flat = 0.8, collapsed = 0.5;
  const auto p = std::min_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a.flatness < b.flatness;
  });
  if (p == parts.end() || p->flattest < 0) return "All elements are held: nothing is said of the walls.";
  const char* verdict = p->flatness < collapsed ? "The walls have collapsed"
                        : p->flatness < flat    ? "The walls are flattened"
                                                : "The walls hold";
  return fmt::format("{}: the flattest section, tube {}, element {}, has {:.2f} of its width as thickness.", verdict,
                     p->part.tube, p->flattest, p->flatness);
}

}  // namespace ropewalk
