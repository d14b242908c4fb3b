#include "cases/common/lammps_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numeric>

#include "atoms/honeycomb_file.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/removal.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"

namespace ropewalk::validate {

namespace fs = std::filesystem;

namespace {

Potential potential_of(const ParameterSet& set) {
  const std::string name = provenance_value(set, "potential"), hash = provenance_value(set, "potential_hash");
  Potential potential;
  try {
    potential = ropewalk::potential_of(set, name);
  } catch (const InputError& e) {
    throw NotApplicable(
        fmt::format("the set was made with the interatomic potential \"{}\", which LAMMPS does not "
                    "have here: {}",
                    name, e.what()));
  }
  if (potential.file_hash != hash)
    throw NotApplicable(fmt::format("the set was made with another file of the potential \"{}\": hash {}, here {}",
                                    name, hash, potential.file_hash));
  return potential;
}

AtomLaw law_of(const ParameterSet& set) {
  AtomLaw law;
  if (!set.law<LineParameters>()) return law;
  law.epsilon = set.law<LineParameters>()->universal.epsilon;
  law.sigma = set.law<LineParameters>()->universal.sigma;
  law.cutoff = set.law<LineParameters>()->universal.lj_cutoff;
  if (law.cutoff <= 0) throw NotApplicable("the law between atoms of two tubes has no cutoff, which lj/cut needs");
  return law;
}

}  // namespace

MdSession::MdSession(const CaseContext& context, const ParameterSet& set)
    : set_(set),
      potential_(potential_of(set)),
      atom_law_(law_of(set)),
      folder_(context.work),
      progress_(context.progress) {}

calibrate::RunContext MdSession::context_of(const std::string& folder) const {
  return {set_.chirality, potential_, folder, options_, 0, {}};
}

void MdSession::progress(const std::string& line) const {
  if (progress_) progress_(line);
}

const RelaxedTube& MdSession::relaxed() {
  if (relaxed_) return *relaxed_;
  progress(fmt::format("relaxing {}", tube_name(set_)));
  const std::string folder =
      (fs::path(folder_) / fmt::format("relax-{}-{}", set_.chirality.n, set_.chirality.m)).string();
  make_work_folder(folder, "");
  calibrate::RunContext run = context_of(folder);
  relaxed_ = calibrate::relax_tube(run);
  inputs_ += read_file(folder + "/relax.data") + read_file(folder + "/relax.in");
  seconds_ += run.lammps_seconds;
  return *relaxed_;
}

TubeShape MdSession::rest_shape() {
  TubeShape shape = relaxed().shape;
  shape.twist = natural_twist(set_);
  return shape;
}

void MdSession::write(const std::string& name, const std::string& content) {
  calibrate::write_data(context_of(folder_), name, content);
  inputs_ += content;
}

std::vector<std::vector<double>> MdSession::run(const std::string& name, const std::string& input, std::size_t rows,
                                                std::size_t columns, std::size_t min_rows) {
  progress("LAMMPS: " + name);
  fs::remove(fs::path(folder_) / (name + ".dat"));  // it is appended to
  calibrate::RunContext context = context_of(folder_);
  calibrate::run_stage(context, name, input);
  inputs_ += input;
  seconds_ += context.lammps_seconds;
  return calibrate::read_results(folder_, name, min_rows > 0 ? min_rows : rows, rows, columns);
}

ReferenceTable MdSession::table(const std::string& title, const std::string& case_name, bool contact,
                                std::vector<std::string> columns) const {
  ReferenceTable t;
  t.add("title", title);
  t.add("potential", fmt::format("{} ({}, hash {})", potential_.name, fs::path(potential_.file).filename().string(),
                                 potential_.file_hash));
  if (contact) t.add("between_tubes", between_tubes(set_));
  t.add("lammps", lammps_version({}).text);
  t.add("input_hash", hash_hex(inputs_));
  t.add("wall_seconds", fmt::format("{:.0f}", seconds_));
  t.add("command", fmt::format("ropewalk validate run {} --fresh", case_name));
  t.columns = std::move(columns);
  return t;
}

long period_hexagons(Chirality c) { return cell_hexagons(c, translation_vector(c)); }

double period_of(Chirality c, const TubeShape& shape) {
  return static_cast<double>(period_hexagons(c)) * shape.length_per_hexagon;
}

long row_hexagons(Chirality c) { return std::gcd(c.n, c.m); }

double row_height(Chirality c, const TubeShape& shape) {
  return static_cast<double>(row_hexagons(c)) * shape.length_per_hexagon;
}

double natural_twist(const ParameterSet& set) {
  const Quantity* twist = find_quantity(set, "atomistic.natural_twist");
  return twist ? twist->value : 0;
}

std::vector<calibrate::WallShape> wall_shapes(const ParameterSet& set) {
  std::vector<calibrate::WallShape> out;
  for (const Wall& wall : set.walls) {
    TubeShape shape;
    shape.radius = wall.radius;
    shape.length_per_hexagon = 2 / wall.atoms_per_length;
    out.push_back({wall.chirality, shape});
  }
  return out;
}

std::string between_walls(const ParameterSet& set) {
  const UniversalLine& law = set.law<LineParameters>()->universal;
  return fmt::format("Lennard-Jones, {} eV, {} nm, cut at {} nm, shifted", law.epsilon, law.sigma,
                     std::min(law.lj_cutoff, between_walls_cutoff));
}

}  // namespace ropewalk::validate
