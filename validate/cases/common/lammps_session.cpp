#include "cases/common/lammps_session.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <chrono>
#include <filesystem>

#include "io/files.hpp"

namespace ropewalk {

namespace fs = std::filesystem;

MdSession::MdSession(const CaseContext& context)
    : potential_(find_potential("tersoff")), folder_(context.work), progress_(context.progress) {}

RunContext MdSession::context_of(Chirality c, const std::string& folder) const {
  return {c, potential_, folder, options_, 0, {}};
}

void MdSession::progress(const std::string& line) const {
  if (progress_) progress_(line);
}

RelaxedTube MdSession::relaxed(Chirality c) {
  progress(fmt::format("relaxing ({},{})", c.n, c.m));
  const std::string folder = (fs::path(folder_) / fmt::format("relax-{}-{}", c.n, c.m)).string();
  fs::remove_all(folder);
  RunContext run = context_of(c, folder);
  const RelaxedTube tube = relax_tube(run);
  inputs_ += read_file(folder + "/relax.data") + read_file(folder + "/relax.in");
  seconds_ += run.lammps_seconds;
  return tube;
}

void MdSession::write(const std::string& name, const std::string& content) {
  write_data(context_of({}, folder_), name, content);
  inputs_ += content;
}

std::vector<std::vector<double>> MdSession::run(const std::string& name, const std::string& input, std::size_t rows,
                                                std::size_t columns, std::size_t min_rows) {
  progress("LAMMPS: " + name);
  fs::remove(fs::path(folder_) / (name + ".dat"));  // it is appended to
  RunContext context = context_of({}, folder_);
  run_stage(context, name, input);
  inputs_ += input;
  seconds_ += context.lammps_seconds;
  return read_results(context, name, min_rows > 0 ? min_rows : rows, rows, columns);
}

ReferenceTable MdSession::table(const std::string& title, const std::string& case_name, bool contact,
                                std::vector<std::string> columns) const {
  ReferenceTable t;
  t.add("title", title);
  t.add("potential", fmt::format("{} ({}, hash {})", potential_.name, fs::path(potential_.file).filename().string(),
                                 potential_.file_hash));
  if (contact)
    t.add("between_tubes", fmt::format("Lennard-Jones, {} eV, {} nm, cut at {} nm, not shifted", atom_law_.epsilon,
                                       atom_law_.sigma, atom_law_.cutoff));
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

std::vector<Vector3> tube_atoms(Chirality c, const TubeShape& shape, long hexagons, double turn) {
  const Eigen::AngleAxisd rotation(turn, Vector3::UnitZ());
  std::vector<Vector3> atoms;
  for (const Site& site : strip_sites(c, hexagons)) atoms.push_back(rotation * place(c, site, shape));
  return atoms;
}

}  // namespace ropewalk
