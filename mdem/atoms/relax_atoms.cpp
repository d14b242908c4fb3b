#include "atoms/relax_atoms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "atoms/honeycomb_file.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/plain_text.hpp"
#include "model/contact/line_parameters.hpp"

namespace ropewalk {
namespace {

std::vector<std::string> command_words(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// A short-ranged potential does not reach from one tube to the next, and one instance serves all tubes. Any other
// one is made once for each part, so that it does not count as contact.
constexpr double reaches_next_tube = 0.28;  // nm

void refuse_other_lines(const Potential& potential, const std::string& name) {
  const std::size_t elements = potential.honeycomb.one_species() ? 1 : 2;
  if (potential.commands.size() == 2 && command_words(potential.commands[0]).size() >= 2 &&
      command_words(potential.commands[0])[0] == "pair_style") {
    const std::vector<std::string> coeff = command_words(potential.commands[1]);
    if (coeff.size() == 4 + elements && coeff[0] == "pair_coeff" && coeff[1] == "*" && coeff[2] == "*") return;
  }
  throw InputError(
      {name, 0, "--potential"}, "has lines that several tubes cannot share",
      fmt::format("take one with pair_style STYLE and pair_coeff * * FILE {}",
                  elements == 1 ? potential.honeycomb.species[0]
                                : potential.honeycomb.species[0] + " " + potential.honeycomb.species[1]));
}

// The energies of all types, `species` of them a part.
std::vector<double> part_energies(const std::string& path, std::size_t parts, std::size_t species) {
  std::istringstream lines(read_file(path));
  std::vector<double> energies;
  bool in_block = false;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> words = command_words(line);
    if (words.size() != 2 || words[0].front() == '#') continue;
    if (!in_block) {  // its head: the step, and how many lines follow
      in_block = true;
      continue;
    }
    energies.push_back(std::strtod(words[1].c_str(), nullptr));
  }
  if (energies.size() != parts * species)
    throw LammpsError(fmt::format("LAMMPS left {} of {} energies in {}", energies.size(), parts * species, path));
  std::vector<double> of_parts(parts, 0);
  for (std::size_t k = 0; k < energies.size(); ++k) {
    if (!std::isfinite(energies[k])) throw LammpsError(fmt::format("LAMMPS left no finite energy in {}", path));
    of_parts[k / species] += energies[k];
  }
  return of_parts;
}

// The laws between all atoms of two parts, by their species.
std::string pair_lines_of_species(const AtomForces& forces, std::size_t parts) {
  std::string text;
  for (std::size_t p = 0; p < parts; ++p)
    for (std::size_t q = p + 1; q < parts; ++q)
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
          const PairLaw& law = forces.potential.honeycomb.pairs[i + j];
          text += fmt::format("pair_coeff {} {} lj/cut {:.8f} {:.6f}\n", 2 * p + i + 1, 2 * q + j + 1, law.epsilon,
                              law.sigma / angstrom);
        }
  return text;
}

}  // namespace

std::string pair_lines(const AtomForces& forces, std::size_t parts) {
  const Potential& potential = forces.potential;
  std::string text;
  if (parts == 1) {
    for (const std::string& command : potential.commands) text += command + "\n";
    return text;
  }
  const std::vector<std::string> style = command_words(potential.commands.at(0));
  const std::vector<std::string> coeff = command_words(potential.commands.at(1));
  std::string own = style[1];
  for (std::size_t k = 2; k < style.size(); ++k) own += " " + style[k];
  const auto species = static_cast<std::size_t>(forces.species());
  const std::size_t instances = potential.cutoff < reaches_next_tube ? 1 : parts;
  text = "pair_style hybrid/overlay";
  for (std::size_t p = 0; p < instances; ++p) text += " " + own;
  text += fmt::format(" lj/cut {:.6f}\n", forces.cutoff / angstrom);
  for (std::size_t p = 1; p <= instances; ++p) {
    text +=
        fmt::format("pair_coeff * * {}", style[1]) + (instances > 1 ? fmt::format(" {}", p) : "") + " " + coeff[3];
    for (std::size_t k = 1; k <= parts; ++k)
      for (std::size_t s = 4; s < 4 + species; ++s) text += instances == 1 || k == p ? " " + coeff[s] : " NULL";
    text += "\n";
  }
  if (species == 2) return text + pair_lines_of_species(forces, parts);
  for (std::size_t p = 1; p < parts; ++p)
    text += fmt::format("pair_coeff {} {}*{} lj/cut {:.8f} {:.6f}\n", p, p + 1, parts, forces.epsilon,
                        forces.sigma / angstrom);
  return text;
}

AtomForces atom_forces(const std::vector<ParameterSet>& sets, const std::string& potential) {
  AtomForces out;
  std::string name = potential;
  for (const ParameterSet& set : sets) {
    if (set.honeycomb.name != sets.front().honeycomb.name)
      throw InputError(
          {set.path, 0, "lattice"},
          fmt::format("is of {}, and the first set of {}", set.honeycomb.name, sets.front().honeycomb.name),
          "take sets of one honeycomb");
    if (potential.empty()) {
      const std::string own = provenance_value(set, "potential");
      if (own.empty() || own == "user")
        throw InputError({set.path, 0, "provenance.potential"}, "names no potential of LAMMPS",
                         "give one: --potential tersoff");
      if (!name.empty() && own != name)
        throw InputError({set.path, 0, "provenance.potential"},
                         fmt::format("is {}, and that of another set {}", own, name),
                         "choose one: --potential " + name);
      name = own;
    }
    if (!set.law<LineParameters>()) continue;
    const UniversalLine& law = set.law<LineParameters>()->universal;
    if (out.epsilon != 0 && (law.epsilon != out.epsilon || law.sigma != out.sigma))
      throw InputError({set.path, 0, "contact.line"}, "has another Lennard-Jones law than the first set",
                       "take sets with the same one");
    out.epsilon = law.epsilon;
    out.sigma = law.sigma;
    out.cutoff = law.lj_cutoff > 0 ? law.lj_cutoff : 1.2;
  }
  if (out.epsilon == 0)
    throw InputError({sets.front().path, 0, "contact.line"},
                     "is missing: the set does not say how atoms of two tubes attract",
                     "take a set that ropewalk calibrate made");
  const bool file = name.find_first_of("/.") != std::string::npos;
  out.potential = file ? user_potential(name) : potential_of(sets.front(), name);
  out.potential.honeycomb = sets.front().honeycomb;
  refuse_other_lines(out.potential, name);
  return out;
}

std::string relax_input(const std::string& stem, const AtomForces& forces, std::size_t parts,
                        const std::vector<AtomRange>& held) {
  std::string text =
      "# Minimises the energy of these atoms, with the end elements held where they are.\n"
      "units metal\natom_style molecular\natom_modify map array sort 0 0.0\nboundary s s s\nneighbor 0.5 bin\n"
      "neigh_modify delay 0 every 1 check yes\n";
  text += fmt::format("read_data {}\n", lammps_quoted(stem + ".data")) + pair_lines(forces, parts);
  text += "group held id";
  for (std::size_t k = 0; k < held.size(); ++k) {
    std::size_t end = k;
    while (end + 1 < held.size() && held[end + 1].first == held[end].last + 1) ++end;
    text += fmt::format(" {}:{}", held[k].first, held[end].last);
    k = end;
  }
  text +=
      "\ngroup free subtract all held\nfix hold held setforce 0.0 0.0 0.0\n"
      "min_style cg\nmin_modify dmax 0.05 line quadratic norm max\n"
      "compute energy all pe/atom\n"
      "compute part all chunk/atom type nchunk once\n"
      "compute of_parts free reduce/chunk part sum c_energy\n"
      "thermo_style custom step pe fnorm fmax\nthermo 100\n"
      "thermo_modify flush yes lost error norm no format float %.12g\n";
  const auto energies = [&](const char* when) {
    return fmt::format(
        "fix out all ave/time 1 1 1 c_of_parts mode vector file {} format \" %.12g\"\nrun 0 post no\nunfix out\n",
        lammps_quoted(stem + "-" + when + ".txt"));
  };
  // Round walls under too much twist or bend rest on a saddle, where a minimiser ends. Motion at 20 K leaves it:
  // the mode by which they give way grows, while displacements at random have next to nothing of it.
  text += energies("before") +
          "timestep 0.001\nvelocity free create 20.0 5113\nfix move free nve\nrun 500 post no\nunfix move\n"
          "velocity all set 0.0 0.0 0.0\nminimize 0.0 2.0e-3 3000 30000\n" +
          energies("after");
  return text + fmt::format("write_data {} nocoeff\n", lammps_quoted(stem + "-relaxed.data"));
}

std::vector<PartEnergies> relax_atoms(const std::string& folder, const std::string& stem, const AtomForces& forces,
                                      std::size_t parts, const std::vector<AtomRange>& held,
                                      const LammpsOptions& options) {
  run_lammps(folder, stem, relax_input(stem, forces, parts, held), options);
  const auto species = static_cast<std::size_t>(forces.species());
  const std::vector<double> before = part_energies(folder + "/" + stem + "-before.txt", parts, species),
                            after = part_energies(folder + "/" + stem + "-after.txt", parts, species);
  std::vector<PartEnergies> out;
  for (std::size_t p = 0; p < parts; ++p) out.push_back({before[p], after[p]});
  return out;
}

}  // namespace ropewalk
