#include "atoms/potential.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* name;
  const char* style;  // with its arguments
  const char* file;
  const char* element;
  double cutoff, inner;  // nm
  const char* reference;
  const char* doi;
};

// The cutoffs of AIREBO's bonded part are REBO's: without Lennard-Jones and torsion it is REBO with other
// constants.
constexpr std::array<Known, 4> known_potentials{
    {{"tersoff", "tersoff", "BNC.tersoff", "C", 0.21, 0.18,
      "L. Lindsay, D. A. Broido, Phys. Rev. B 81, 205441 (2010); file of A. Kinaci et al., Phys. Rev. B 86, 115410 "
      "(2012)",
      "10.1103/PhysRevB.81.205441"},
     {"airebo", "airebo 3.0 0 0", "CH.airebo", "C", 0.20, 0.17,
      "S. J. Stuart, A. B. Tutein, J. A. Harrison, J. Chem. Phys. 112, 6472 (2000); bonded part alone",
      "10.1063/1.481208"},
     {"rebo", "rebo", "CH.rebo", "C", 0.20, 0.17, "D. W. Brenner et al., J. Phys.: Condens. Matter 14, 783 (2002)",
      "10.1088/0953-8984/14/4/312"},
     {"lcbop", "lcbop", "C.lcbop", "C", 0.60, 0.17, "J. H. Los, A. Fasolino, Phys. Rev. B 68, 024107 (2003)",
      "10.1103/PhysRevB.68.024107"}}};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

// Folders of potential files: LAMMPS_POTENTIALS if it is set, else the usual folders of distributions. Not both: if
// a file is missing in the user's folder, another one must not replace it.
std::vector<std::string> potential_folders() {
  if (const char* chosen = std::getenv("LAMMPS_POTENTIALS"); chosen && *chosen) return split(chosen, ':');
  return {"/usr/share/lammps/potentials", "/usr/local/share/lammps/potentials"};
}

// The path of a file in the folders of potentials; empty: none of them has it.
std::string file_in_folders(const std::string& name) {
  for (const std::string& folder : potential_folders()) {
    std::error_code ignored;
    const fs::path path = fs::path(folder) / name;
    if (fs::is_regular_file(path, ignored)) return fs::absolute(path).string();
  }
  return "";
}

std::string find_file(const std::string& name, const std::string& folder) {
  std::error_code ignored;
  if (const fs::path beside = fs::path(folder) / name; !folder.empty() && fs::is_regular_file(beside, ignored))
    return fs::absolute(beside).lexically_normal().string();
  if (const std::string path = file_in_folders(name); !path.empty()) return path;
  throw InputError({name, 0, ""},
                   fmt::format("the potential file is not in {}", fmt::join(potential_folders(), ", ")),
                   "apt-get install lammps-data, or set LAMMPS_POTENTIALS to the folder that has it");
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

void refuse_reach(const InputError::Place& place, const std::string& line) {
  const auto refuse = [&](const char* what, const char* remedy) { throw InputError(place, what, remedy); };
  for (const char c : line)
    if (c != '\t' && c != '\r' && has_control_character({&c, 1}))
      refuse("holds a control character", "write plain text");
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last != std::string::npos && line[last] == '&')
    refuse("goes on in the next line by &", "write the whole command in one line");
  if (line.find('$') != std::string::npos) refuse("names a variable, $", "write its value");
  if (line.find_first_of("\"'") != std::string::npos)
    refuse("holds quotes", "write names without quotes and blanks; rename a file if need be");
}

namespace {

// Potential files name their units in the first line. LAMMPS converts some that say `real`, and believes them.
void check_units(const std::string& path) {
  std::istringstream file(read_file(path));
  std::string line;
  std::getline(file, line);
  const std::string key = "UNITS:";
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return;
  std::istringstream words(line.substr(at + key.size()));
  std::string units;
  words >> units;
  if (units != "metal")
    throw InputError({path, 1, "UNITS"}, fmt::format("is \"{}\"", printable(units, 40)),
                     "energies are taken in eV and lengths in Angstrom: convert the numbers of the file and write "
                     "UNITS: metal, or correct its header");
}

}  // namespace

Potential find_potential(const std::string& name) {
  const auto known = std::find_if(known_potentials.begin(), known_potentials.end(),
                                  [&](const Known& k) { return name == k.name; });
  if (known == known_potentials.end()) {
    const auto nearest = std::min_element(
        known_potentials.begin(), known_potentials.end(),
        [&](const Known& a, const Known& b) { return edit_distance(name, a.name) < edit_distance(name, b.name); });
    throw InputError(
        {"", 0, "potential"}, fmt::format("'{}' is not known", name),
        fmt::format("did you mean '{}'? Known are tersoff, airebo, rebo, lcbop, or a file with your own "
                    "pair_style and pair_coeff lines",
                    nearest->name));
  }
  return potential_of_lines({known->name,
                             known->style,
                             known->file,
                             {known->element},
                             known->cutoff,
                             known->inner,
                             known->reference,
                             known->doi,
                             ""});
}

Potential potential_of_lines(const PotentialLines& lines) {
  Potential potential;
  potential.name = lines.name;
  potential.pair_style = split(lines.style, ' ').front();
  potential.file = find_file(lines.file, lines.folder);
  check_units(potential.file);
  potential.file_hash = hash_hex(read_file(potential.file));
  potential.commands = {
      fmt::format("pair_style {}", lines.style),
      fmt::format("pair_coeff * * {} {}", lammps_quoted(potential.file), fmt::join(lines.elements, " "))};
  potential.reference = lines.reference;
  potential.doi = lines.doi;
  potential.cutoff = lines.cutoff;
  potential.inner = lines.inner;
  return potential;
}

Potential user_potential(const std::string& path) {
  const std::string content = read_file(path);
  check_units(path);
  Potential potential;
  potential.name = "user";
  potential.file = fs::absolute(path).lexically_normal().string();
  potential.file_hash = hash_hex(content);
  potential.reference = fmt::format("pair_style and pair_coeff lines of {}", fs::path(path).filename().string());
  potential.cutoff = 1.2;  // unknown: the cutoff of common Lennard-Jones tails is taken

  const std::string folder = fs::path(potential.file).parent_path().string();
  int number = 0;
  bool has_coefficients = false;
  for (std::istringstream lines(content); lines;) {
    std::string line;
    if (!std::getline(lines, line)) break;
    if (++number == 1 && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);  // a byte order mark
    if (const auto comment = line.find('#'); comment != std::string::npos) line.resize(comment);
    refuse_reach({path, number, ""}, line);
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.empty()) continue;
    // Other commands could change the units, the box or the atoms.
    if (words[0] != "pair_style" && words[0] != "pair_coeff" && words[0] != "pair_modify")
      throw InputError({path, number, printable(words[0], 40)},
                       "only pair_style, pair_coeff and pair_modify lines may stand here", "remove this line");
    if (words.size() < 2) throw InputError({path, number, words[0]}, "has no arguments", "write the whole command");
    if (words[0] == "pair_style" && potential.pair_style.empty()) potential.pair_style = words[1];
    has_coefficients = has_coefficients || words[0] == "pair_coeff";
    // File names are relative to the user's folder; LAMMPS starts in another one.
    for (std::size_t i = 1; i < words.size(); ++i) {
      std::error_code ignored;
      const fs::path beside = fs::path(folder) / words[i];
      const bool here = fs::is_regular_file(beside, ignored);
      // Where LAMMPS looks for files that are not in its own folder.
      const std::string found = here ? beside.lexically_normal().string() : file_in_folders(words[i]);
      if (!found.empty()) check_units(found);
      if (here) words[i] = lammps_quoted(found);
    }
    potential.commands.push_back(fmt::format("{}", fmt::join(words, " ")));
  }
  if (potential.pair_style.empty())
    throw InputError({path, 0, "pair_style"}, "is missing", "write the LAMMPS command of your potential");
  if (!has_coefficients)
    throw InputError({path, 0, "pair_coeff"}, "is missing", "write the LAMMPS command of your potential");
  return potential;
}

}  // namespace ropewalk
