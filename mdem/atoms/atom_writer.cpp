#include "atoms/atom_writer.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "io/draft.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t buffer_size = 1 << 20;

// The type of the first sublattice of each part, from 1; that of the second is the next where it is another
// species.
std::vector<int> first_types(const AtomsOfElements& atoms, std::string& masses) {
  std::vector<int> first;
  int type = 0;
  for (const TubePart& part : atoms.parts()) {
    const Honeycomb& h = atoms.honeycomb_of(part);
    first.push_back(type + 1);
    for (int k = 0; k < (h.one_species() ? 1 : 2); ++k)
      masses += fmt::format("{} {}\n", ++type, h.atomic_weight[static_cast<std::size_t>(k)]);
  }
  first.push_back(type + 1);
  return first;
}

void append_head(fmt::memory_buffer& out, AtomFormat format, const AtomsOfElements& atoms, const std::string& title,
                 double time_ps, int types, const std::string& masses) {
  const auto to = std::back_inserter(out);
  if (format == AtomFormat::extended_xyz) {
    fmt::format_to(to, "{}\nProperties=species:S:1:pos:R:3:tube:I:1:tube_element:I:1 pbc=\"F F F\" Time={:.10g}\n",
                   atoms.count(), time_ps);
    return;
  }
  Vector3 low, high;
  atoms.bounds(low, high);
  fmt::format_to(to, "{}\n\n{} atoms\n{} atom types\n\n", lammps_comment(title), atoms.count(), types);
  for (int k = 0; k < 3; ++k)
    fmt::format_to(to, "{0:.6f} {1:.6f} {2}lo {2}hi\n", low[k] / angstrom, high[k] / angstrom, "xyz"[k]);
  fmt::format_to(to, "\nMasses\n\n{}\nAtoms # molecular\n\n", masses);
}

}  // namespace

AtomFormat atom_format_of(const std::string& path) {
  const std::string end = std::filesystem::path(path).extension().string();
  if (end == ".data") return AtomFormat::lammps_data;
  if (end == ".xyz" || end == ".extxyz") return AtomFormat::extended_xyz;
  throw InputError({path, 0, "-o"}, "ends in none of .data (LAMMPS), .xyz, .extxyz",
                   "choose the format by the end of the name");
}

std::vector<AtomRange> write_atoms(const std::string& path, AtomFormat format, const AtomsOfElements& atoms,
                                   const std::string& title, double time_ps) {
  Draft file(path);
  std::vector<AtomRange> ranges = write_atoms(file, format, atoms, title, time_ps);
  file.replace();
  return ranges;
}

std::vector<AtomRange> write_atoms(Draft& file, AtomFormat format, const AtomsOfElements& atoms,
                                   const std::string& title, double time_ps) {
  fmt::memory_buffer out;
  std::string masses;
  const std::vector<int> first = first_types(atoms, masses);
  append_head(out, format, atoms, title, time_ps, first.back() - 1, masses);
  std::vector<AtomRange> ranges;
  long id = 0;
  atoms.for_each([&](const PlacedAtom& atom) {
    ++id;
    if (ranges.empty() || ranges.back().part != atom.part || ranges.back().element != atom.element)
      ranges.push_back({atom.part, atom.tube, atom.element, id, id});
    ranges.back().last = id;
    const Vector3 x = atom.position / angstrom;
    const auto part = static_cast<std::size_t>(atom.part);
    if (format == AtomFormat::lammps_data)
      fmt::format_to(std::back_inserter(out), "{} {} {} {:.7f} {:.7f} {:.7f}\n", id, atom.tube + 1,
                     atom.second ? first[part + 1] - 1 : first[part], x.x(), x.y(), x.z());
    else
      fmt::format_to(std::back_inserter(out), "{} {:.7f} {:.7f} {:.7f} {} {}\n",
                     atoms.honeycomb_of(atoms.parts()[part]).species[atom.second ? 1 : 0], x.x(), x.y(), x.z(),
                     atom.tube, atom.element);
    if (out.size() < buffer_size) return;
    file.write({out.data(), out.size()});
    out.clear();
  });
  file.write({out.data(), out.size()});
  file.sync();
  return ranges;
}

}  // namespace ropewalk
