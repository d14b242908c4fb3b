#include "atoms/atom_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

#include "atoms/atom_writer.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace atom_readers {

constexpr const char* truncated = "the file is cut short or damaged: copy it again, or let LAMMPS write it anew";
constexpr std::int64_t most_atoms = 200000000;

enum class Format { data, dump, xyz };

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) words.emplace_back(word);
  return words;
}

template <class T>
bool parse(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && code == std::errc() && end == word.data() + word.size();
}

// 1 or 2: the sublattice whose species has this weight (u) or symbol; 0: neither.
char species_of_mass(const Honeycomb& h, double mass) {
  for (std::size_t k = 0; k < 2; ++k)
    if (std::fabs(mass - h.atomic_weight[k]) < 0.2) return static_cast<char>(k + 1);
  return 0;
}
char species_of_symbol(const Honeycomb& h, std::string_view symbol) {
  for (std::size_t k = 0; k < 2; ++k)
    if (symbol == h.species[k]) return static_cast<char>(k + 1);
  return h.carbon() && symbol == "6" ? 1 : 0;
}

// Lines of a file with their numbers.
class Lines {
 public:
  explicit Lines(const std::string& path) : path_(path), file_(opened_stream(path)) {}
  bool next() {
    if (!std::getline(file_, line_)) {
      if (file_.bad()) throw file_error(path_, "cannot be read", EIO);
      return false;
    }
    ++number_;
    return true;
  }
  bool ends_with_newline() const { return !file_.eof(); }
  const std::string& text() const { return line_; }
  const std::string& path() const { return path_; }
  int number() const { return number_; }
  [[noreturn]] void fail(const std::string& key, const std::string& what, const std::string& remedy) const {
    throw InputError({path_, number_, key}, what, remedy);
  }

 private:
  std::string path_;
  std::ifstream file_;
  std::string line_;
  int number_ = 0;
};

// Thrown and caught in this file: the file ends within a frame.
struct CutOff {};

// Masses by type and the number of types, where the file names them.
struct Species {
  Honeycomb honeycomb;
  std::map<long, double> masses;
  long types = 0;
};

Format format_of_atoms(const std::string& path) {
  Lines lines(path);
  for (int k = 0; k < 200 && lines.next(); ++k) {
    const std::string& line = lines.text();
    if (line.rfind("ITEM:", 0) == 0) return Format::dump;
    const std::vector<std::string> words = words_of(line);
    long n = 0;
    if (k == 0 && words.size() == 1 && parse(words[0], n)) return Format::xyz;
    if (words.size() == 2 && words[1] == "atoms" && parse(words[0], n)) return Format::data;
  }
  throw InputError(
      {path, 0, ""}, "is no file of atoms that is known here",
      "LAMMPS data files, LAMMPS text dumps and XYZ are read; ASE and MDAnalysis write XYZ from others");
}

class Reader {
 public:
  virtual ~Reader() = default;
  virtual bool next(AtomFrame& frame, std::vector<std::int64_t>& ids) = 0;
  virtual bool states_time() const { return true; }
};

double number(const Lines& lines, std::string_view word, const char* what) {
  double value = 0;
  if (!parse(word, value) || !std::isfinite(value))
    lines.fail(what, fmt::format("\"{}\" is not a number", printable(std::string(word), 40)),
               "the file is damaged, or has other columns than it says");
  return value;
}

void reserve(AtomFrame& frame, std::vector<std::int64_t>& ids, std::int64_t n) {
  frame = AtomFrame();
  const auto size = static_cast<std::size_t>(n);
  frame.positions.resize(size);
  frame.species.resize(size);
  ids.resize(size);
}

std::int64_t atom_count(const Lines& lines, std::string_view word) {
  std::int64_t n = 0;
  if (!parse(word, n) || n < 1 || n > most_atoms)
    lines.fail("", fmt::format("\"{}\" is no number of atoms", printable(std::string(word), 40)),
               fmt::format("1 to {} are read", most_atoms));
  return n;
}

char species_by_type(const Lines& lines, const Species& species, long type, bool only_type) {
  const auto known = species.masses.find(type);
  if (known != species.masses.end()) return species_of_mass(species.honeycomb, known->second);
  if (only_type && species.honeycomb.one_species()) return 1;
  lines.fail("type", fmt::format("{} is of no known species", type),
             "give the LAMMPS data file too, whose Masses say it, or dump the column element");
}

// --- LAMMPS data -----------------------------------------------------------------------------------------

// Columns before x of the atom styles that are read here.
struct Style {
  const char* name;
  int type, x;
};
constexpr Style styles[] = {{"atomic", 1, 2}, {"charge", 1, 3}, {"molecular", 2, 3},
                            {"bond", 2, 3},   {"angle", 2, 3},  {"full", 2, 4}};

class AtomDataReader : public Reader {
 public:
  AtomDataReader(const std::string& path, Species& species) : lines_(path), species_(species) { read(); }
  bool next(AtomFrame& frame, std::vector<std::int64_t>& ids) override {
    if (done_) return false;
    done_ = true;
    frame = std::move(frame_);
    ids = std::move(ids_);
    return true;
  }

 private:
  // The next line that holds more than a comment; false at the end.
  bool content(std::string& text, std::string& comment) {
    while (lines_.next()) {
      const std::size_t hash = lines_.text().find('#');
      text = lines_.text().substr(0, hash);
      comment = hash == std::string::npos ? "" : lines_.text().substr(hash + 1);
      if (text.find_first_not_of(" \t\r") != std::string::npos) return true;
    }
    return false;
  }
  void need(std::string& text, std::string& comment, const char* what) {
    if (!content(text, comment)) lines_.fail("", fmt::format("ends within {}", what), truncated);
  }

  void read() {
    lines_.next();  // its title
    std::string text, comment;
    std::int64_t atoms = 0;
    Vector3 low(0, 0, 0), high(0, 0, 0), tilt(0, 0, 0);
    bool positions = false;
    while (content(text, comment)) {
      const std::vector<std::string> w = words_of(text);
      if (w.size() == 2 && w[1] == "atoms") {
        atoms = atom_count(lines_, w[0]);
      } else if (w.size() == 3 && w[1] == "atom" && w[2] == "types") {
        species_.types = std::llround(number(lines_, w[0], "atom types"));
      } else if (w.size() == 4 && w[2].size() == 3 && w[2].compare(1, 2, "lo") == 0 && w[2][0] >= 'x' &&
                 w[2][0] <= 'z') {
        low[w[2][0] - 'x'] = angstrom * number(lines_, w[0], "box");
        high[w[2][0] - 'x'] = angstrom * number(lines_, w[1], "box");
      } else if (w.size() == 6 && w[3] == "xy") {
        for (int k = 0; k < 3; ++k) tilt[k] = angstrom * number(lines_, w[static_cast<std::size_t>(k)], "tilt");
      } else if (w[0] == "Masses") {
        for (long t = 0; t < species_.types; ++t) {
          need(text, comment, "Masses");
          const std::vector<std::string> mass = words_of(text);
          if (mass.size() < 2) lines_.fail("Masses", "a line needs a type and a mass", truncated);
          species_.masses[std::llround(number(lines_, mass[0], "Masses"))] = number(lines_, mass[1], "Masses");
        }
      } else if (w[0] == "Atoms") {
        reserve(frame_, ids_, atoms);
        read_atoms(atoms, words_of(comment));
        positions = true;
      } else if (w[0] == "Velocities" && positions) {
        read_velocities(atoms);
      } else if (std::isupper(static_cast<unsigned char>(w[0][0])) != 0 && positions) {
        break;  // Bonds and the like
      }
    }
    if (!positions) lines_.fail("Atoms", "is missing", truncated);
    frame_.box.origin = low;
    frame_.box.edges = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      if (!(high[k] > low[k])) lines_.fail("box", "has no width", "write xlo xhi, ylo yhi and zlo zhi");
      frame_.box.edges(k, k) = high[k] - low[k];
    }
    frame_.box.edges(0, 1) = tilt[0];
    frame_.box.edges(0, 2) = tilt[1];
    frame_.box.edges(1, 2) = tilt[2];
    frame_.box.periodic = {true, true, true};
    frame_.box.periodic_known = false;
  }

  void read_atoms(std::int64_t atoms, const std::vector<std::string>& named) {
    const Style* style = nullptr;
    for (const Style& s : styles)
      if (!named.empty() && named[0] == s.name) style = &s;
    if (!named.empty() && !style)
      lines_.fail("Atoms", fmt::format("are of the style {}", printable(named[0], 30)),
                  "atomic, charge, molecular, bond, angle and full are read; or give a dump with id type x y z");
    std::string text, comment;
    for (std::int64_t k = 0; k < atoms; ++k) {
      need(text, comment, "Atoms");
      const std::vector<std::string> w = words_of(text);
      if (!style) style = guessed(w);
      if (w.size() < static_cast<std::size_t>(style->x) + 3)
        lines_.fail("Atoms", fmt::format("a line has {} columns", w.size()),
                    fmt::format("style {} has {} or more", style->name, style->x + 3));
      const auto i = static_cast<std::size_t>(k);
      if (!parse(w[0], ids_[i])) lines_.fail("Atoms", "a line begins with no id", truncated);
      long type = 0;
      if (!parse(w[static_cast<std::size_t>(style->type)], type))
        lines_.fail("Atoms", "a type is no whole number", "name the atom style: Atoms # full");
      frame_.species[i] = species_by_type(lines_, species_, type, species_.types == 1);
      for (int x = 0; x < 3; ++x)
        frame_.positions[i][x] = angstrom * number(lines_, w[static_cast<std::size_t>(style->x + x)], "Atoms");
    }
  }

  // The atom style that fits the columns of this line, with or without three image flags.
  const Style* guessed(const std::vector<std::string>& w) const {
    const std::size_t n = w.size();
    const bool images =
        n > 8 || (n == 8 && w[7].find('.') == std::string::npos && w[6].find('.') == std::string::npos);
    const std::size_t plain = n - (images ? 3 : 0);
    for (const Style& s : {styles[0], styles[2], styles[5]})
      if (plain == static_cast<std::size_t>(s.x) + 3) return &styles[s.x == 2 ? 0 : s.x == 3 ? 2 : 5];
    lines_.fail("Atoms", fmt::format("have {} columns, and no style is named", n),
                "name the style behind the word: Atoms # atomic");
  }

  void read_velocities(std::int64_t atoms) {
    std::map<std::int64_t, std::size_t> index;
    for (std::size_t i = 0; i < ids_.size(); ++i) index[ids_[i]] = i;
    frame_.velocities.assign(ids_.size(), Vector3::Zero());
    std::string text, comment;
    for (std::int64_t k = 0; k < atoms; ++k) {
      need(text, comment, "Velocities");
      const std::vector<std::string> w = words_of(text);
      std::int64_t id = 0;
      if (w.size() < 4 || !parse(w[0], id) || index.find(id) == index.end())
        lines_.fail("Velocities", "a line needs an id of Atoms and three numbers", truncated);
      for (int x = 0; x < 3; ++x)
        frame_.velocities[index[id]][x] =
            angstrom * number(lines_, w[static_cast<std::size_t>(x) + 1], "Velocities");
    }
  }

  Lines lines_;
  Species& species_;
  AtomFrame frame_;
  std::vector<std::int64_t> ids_;
  bool done_ = false;
};

// --- LAMMPS dump -----------------------------------------------------------------------------------------

class AtomDumpReader : public Reader {
 public:
  AtomDumpReader(const std::string& path, const Species& species, double time_step_fs)
      : lines_(path), species_(species), time_step_(time_step_fs * units::fs) {}

  bool next(AtomFrame& frame, std::vector<std::int64_t>& ids) override {
    double time = -1;
    std::int64_t step = 0, atoms = 0;
    AtomBox box;
    while (lines_.next()) {
      const std::string& line = lines_.text();
      if (line == "ITEM: TIMESTEP") {
        need();
        if (!parse(words_of(lines_.text()).empty() ? "" : words_of(lines_.text())[0], step))
          lines_.fail("TIMESTEP", "is no whole number", truncated);
      } else if (line == "ITEM: UNITS") {
        need();
        real_ = words_of(lines_.text()) == std::vector<std::string>{"real"};
      } else if (line == "ITEM: TIME") {
        need();
        std::string_view rest = lines_.text();
        time = number(lines_, next_word(rest), "TIME");
      } else if (line == "ITEM: NUMBER OF ATOMS") {
        need();
        std::string_view rest = lines_.text();
        atoms = atom_count(lines_, next_word(rest));
      } else if (line.rfind("ITEM: BOX BOUNDS", 0) == 0) {
        box = read_box(line.substr(16));
      } else if (line.rfind("ITEM: ATOMS", 0) == 0) {
        if (atoms == 0) lines_.fail("", "ITEM: NUMBER OF ATOMS is missing before this line", truncated);
        reserve(frame, ids, atoms);
        frame.step = step;
        states_time_ = time >= 0;
        frame.time = time >= 0 ? (real_ ? 1e-3 * time : time) : static_cast<double>(step) * time_step_;
        frame.box = box;
        read_atoms(line.substr(11), frame, ids);
        return true;
      } else if (line.find_first_not_of(" \t\r") != std::string::npos) {
        lines_.fail("", fmt::format("\"{}\" is no head of a dump", printable(line, 40)), truncated);
      }
    }
    return false;
  }
  bool states_time() const override { return states_time_; }

 private:
  // LAMMPS ends each line: a number at the end of one without an end may have lost digits.
  void need() {
    if (!lines_.next() || !lines_.ends_with_newline()) throw CutOff();
  }

  AtomBox read_box(const std::string& head) {
    AtomBox box;
    const std::vector<std::string> words = words_of(head);
    const bool tilted = words.size() >= 3 && words[0] == "xy";
    const std::size_t flags = tilted ? 3 : 0;
    for (std::size_t k = 0; k < 3; ++k) box.periodic[k] = words.size() >= flags + 3 && words[flags + k] == "pp";
    Vector3 low, high, tilt(0, 0, 0);
    for (int k = 0; k < 3; ++k) {
      need();
      const std::vector<std::string> w = words_of(lines_.text());
      if (w.size() < (tilted ? 3u : 2u)) lines_.fail("BOX BOUNDS", "a line has too few numbers", truncated);
      low[k] = angstrom * number(lines_, w[0], "BOX BOUNDS");
      high[k] = angstrom * number(lines_, w[1], "BOX BOUNDS");
      if (tilted) tilt[k] = angstrom * number(lines_, w[2], "BOX BOUNDS");
    }
    // A dump has the bounds of a box around the tilted one.
    low.x() -= std::min({0.0, tilt[0], tilt[1], tilt[0] + tilt[1]});
    high.x() -= std::max({0.0, tilt[0], tilt[1], tilt[0] + tilt[1]});
    low.y() -= std::min(0.0, tilt[2]);
    high.y() -= std::max(0.0, tilt[2]);
    box.origin = low;
    box.edges << high.x() - low.x(), tilt[0], tilt[1], 0, high.y() - low.y(), tilt[2], 0, 0, high.z() - low.z();
    for (int k = 0; k < 3; ++k)
      if (!(box.edges(k, k) > 0)) lines_.fail("BOX BOUNDS", "the box has no width", truncated);
    return box;
  }

  void read_atoms(const std::string& head, AtomFrame& frame, std::vector<std::int64_t>& ids) {
    const std::vector<std::string> names = words_of(head);
    const auto column = [&](const std::string& name) {
      const auto at = std::find(names.begin(), names.end(), name);
      return at == names.end() ? -1 : static_cast<int>(at - names.begin());
    };
    const int id = column("id"), type = column("type"), element = column("element"), mass = column("mass");
    if (id < 0)
      lines_.fail("ATOMS", "there is no column id", "dump id type x y z: it tells the atoms of the next frame");
    std::array<int, 3> x{}, v{};
    bool scaled = false;
    for (const char* ending : {"", "u", "s", "su"}) {
      for (int k = 0; k < 3; ++k) x[static_cast<std::size_t>(k)] = column(std::string(1, "xyz"[k]) + ending);
      scaled = ending[0] == 's';
      if (x[0] >= 0 && x[1] >= 0 && x[2] >= 0) break;
    }
    if (x[0] < 0 || x[1] < 0 || x[2] < 0)
      lines_.fail("ATOMS", "there are no columns x y z, nor xu, xs or xsu", "dump id type x y z");
    for (int k = 0; k < 3; ++k) v[static_cast<std::size_t>(k)] = column(std::string("v") + "xyz"[k]);
    const bool moving = v[0] >= 0 && v[1] >= 0 && v[2] >= 0;
    if (moving) frame.velocities.resize(frame.positions.size());
    std::vector<std::string_view> words(names.size());
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      need();
      std::string_view rest = lines_.text();
      for (std::size_t k = 0; k < words.size(); ++k)
        if ((words[k] = next_word(rest)).empty()) throw CutOff();
      const auto word = [&](int k) { return words[static_cast<std::size_t>(k)]; };
      if (!parse(word(id), ids[i])) lines_.fail("id", "is no whole number", truncated);
      Vector3 at;
      for (int k = 0; k < 3; ++k) at[k] = number(lines_, word(x[static_cast<std::size_t>(k)]), "x y z");
      frame.positions[i] = scaled ? Vector3(frame.box.origin + frame.box.edges * at) : Vector3(angstrom * at);
      for (int k = 0; moving && k < 3; ++k)
        frame.velocities[i][k] =
            angstrom * (real_ ? 1e3 : 1) * number(lines_, word(v[static_cast<std::size_t>(k)]), "vx vy vz");
      if (element >= 0) {
        frame.species[i] = species_of_symbol(species_.honeycomb, word(element));
      } else if (mass >= 0) {
        frame.species[i] = species_of_mass(species_.honeycomb, number(lines_, word(mass), "mass"));
      } else {
        long t = 1;
        if (type >= 0 && !parse(word(type), t)) lines_.fail("type", "is no whole number", truncated);
        if (species_.masses.empty() && t != 1) lone_type_ = false;
        frame.species[i] = species_by_type(lines_, species_, t, lone_type_);
      }
    }
  }

  Lines lines_;
  const Species& species_;
  double time_step_;  // ps
  bool real_ = false, states_time_ = false, lone_type_ = true;
};

// --- XYZ -------------------------------------------------------------------------------------------------

class XyzReader : public Reader {
 public:
  // `frames`: that came before this file. A file that states no time has its frames 1 ps apart.
  XyzReader(const std::string& path, std::int64_t frames, const Honeycomb& honeycomb)
      : lines_(path), frame_(frames), honeycomb_(honeycomb) {}

  bool next(AtomFrame& frame, std::vector<std::int64_t>& ids) override {
    do {
      if (!lines_.next()) return false;
    } while (lines_.text().find_first_not_of(" \t\r") == std::string::npos);
    std::string_view first = lines_.text();
    const std::int64_t atoms = atom_count(lines_, next_word(first));
    if (!lines_.next()) throw CutOff();
    reserve(frame, ids, atoms);
    std::iota(ids.begin(), ids.end(), 1);
    frame.step = frame_;
    const std::string head = lines_.text();
    set_box(head, frame.box);
    const std::string time = value(head, "Time");
    states_time_ = !time.empty();
    frame.time = states_time_ ? number(lines_, time, "Time") : static_cast<double>(frame_);
    ++frame_;
    int species = 0, position = 1;
    set_columns(value(head, "Properties"), species, position);
    const auto needed = static_cast<std::size_t>(std::max(species + 1, position + 3));
    std::vector<std::string_view> words(needed);
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      if (!lines_.next()) throw CutOff();
      std::string_view rest = lines_.text();
      for (std::size_t k = 0; k < needed; ++k)
        if ((words[k] = next_word(rest)).empty()) throw CutOff();
      const std::string_view name = words[static_cast<std::size_t>(species)];
      if (!std::isalpha(static_cast<unsigned char>(name[0])) && name != "6")
        lines_.fail("species", fmt::format("\"{}\" is no element", printable(std::string(name), 20)),
                    "write its symbol, C for carbon");
      frame.species[i] = species_of_symbol(honeycomb_, name);
      for (int k = 0; k < 3; ++k)
        frame.positions[i][k] = angstrom * number(lines_, words[static_cast<std::size_t>(position + k)], "pos");
    }
    return true;
  }
  bool states_time() const override { return states_time_; }

 private:
  // The value of key="..." or key=...; empty: the head has no such key.
  static std::string value(const std::string& head, const std::string& key) {
    for (std::size_t at = head.find(key + "="); at != std::string::npos; at = head.find(key + "=", at + 1)) {
      if (at > 0 && head[at - 1] != ' ') continue;
      const std::size_t begin = at + key.size() + 1;
      const char quote = begin < head.size() ? head[begin] : ' ';
      if (quote == '"' || quote == '\'') return head.substr(begin + 1, head.find(quote, begin + 1) - begin - 1);
      return head.substr(begin, head.find_first_of(" \r", begin) - begin);
    }
    return "";
  }

  void set_box(const std::string& head, AtomBox& box) const {
    const std::vector<std::string> lattice = words_of(value(head, "Lattice"));
    if (lattice.empty()) return;
    if (lattice.size() != 9) lines_.fail("Lattice", "needs nine numbers", "write three vectors, one after another");
    for (int k = 0; k < 9; ++k)
      box.edges(k % 3, k / 3) = angstrom * number(lines_, lattice[static_cast<std::size_t>(k)], "Lattice");
    if (!(std::fabs(box.edges.determinant()) > 1e-9))
      lines_.fail("Lattice", "its vectors span no box", "write three vectors, one after another");
    const std::vector<std::string> pbc = words_of(value(head, "pbc"));
    for (std::size_t k = 0; k < 3; ++k) box.periodic[k] = pbc.size() != 3 || pbc[k] == "T" || pbc[k] == "1";
  }

  // Finds the columns of species and position in a text such as Properties=species:S:1:pos:R:3.
  void set_columns(const std::string& properties, int& species, int& position) const {
    if (properties.empty()) return;
    species = position = -1;
    int column = 0;
    std::vector<std::string> parts(1);
    for (const char c : properties) {
      if (c == ':')
        parts.emplace_back();
      else
        parts.back() += c;
    }
    for (std::size_t k = 0; k + 2 < parts.size(); k += 3) {
      int width = 0;
      if (!parse(parts[k + 2], width) || width < 1 || width > 1000)
        lines_.fail("Properties", "has a column without a number", "write species:S:1:pos:R:3");
      if (parts[k] == "species" || (parts[k] == "element" && parts[k + 1] == "S" && species < 0)) species = column;
      if (parts[k] == "pos") position = column;
      column += width;
    }
    if (species < 0 || position < 0)
      lines_.fail("Properties", "names no species or no pos", "write species:S:1:pos:R:3");
  }

  Lines lines_;
  std::int64_t frame_;
  const Honeycomb& honeycomb_;
  bool states_time_ = false;
};

}  // namespace atom_readers

struct AtomFiles::Impl {
  struct File {
    std::string path;
    atom_readers::Format format;
  };
  std::vector<File> files;
  double time_step_fs = 1;
  atom_readers::Species species;
  std::size_t at = 0;
  std::unique_ptr<atom_readers::Reader> reader;
  std::string file;
  bool cut_off = false, states_time = true;
  std::int64_t frames = 0;  // that were read
  double time = 0;          // time of the last one, ps
  bool opened = false;      // no frame of the present file was read
  std::vector<std::int64_t> first_ids;  // ids in the first frame, in rising order

  void open() {
    opened = true;
    const File& f = files[at];
    file = f.path;
    if (f.format == atom_readers::Format::data)
      reader = std::make_unique<atom_readers::AtomDataReader>(f.path, species);
    else if (f.format == atom_readers::Format::dump)
      reader = std::make_unique<atom_readers::AtomDumpReader>(f.path, species, time_step_fs);
    else
      reader = std::make_unique<atom_readers::XyzReader>(f.path, frames, species.honeycomb);
  }

  // Whether a simulation that went on wrote the frame at which it had been stopped once more, into a further file.
  bool again(const AtomFrame& frame) {
    const bool first = opened;
    opened = false;
    if (first && frames > 0 && frame.time == time) return true;
    ++frames;
    time = frame.time;
    return false;
  }

  // Brings the atoms into the order of their ids.
  void sort(AtomFrame& frame, std::vector<std::int64_t>& ids) {
    if (!std::is_sorted(ids.begin(), ids.end())) {
      std::vector<std::uint32_t> order(ids.size());
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
      const auto rearrange = [&](auto& values) {
        if (values.empty()) return;
        auto sorted = values;
        for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
        values.swap(sorted);
      };
      rearrange(frame.positions);
      rearrange(frame.velocities);
      rearrange(frame.species);
      rearrange(ids);
    }
    if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end())
      throw InputError({file, 0, "id"}, fmt::format("{} comes twice in a frame", *twice), atom_readers::truncated);
    if (first_ids.empty()) {
      first_ids = ids;
    } else if (ids != first_ids) {
      throw InputError(
          {file, 0, ""},
          fmt::format("a frame has other atoms than the first one: {} and {}", ids.size(), first_ids.size()),
          "give the files of one simulation, in which no atom comes or goes");
    }
  }
};

AtomFiles::AtomFiles(std::vector<std::string> paths, double time_step_fs, const Honeycomb& honeycomb)
    : impl_(new Impl) {
  impl_->species.honeycomb = honeycomb;
  impl_->time_step_fs = time_step_fs;
  bool moving = false;
  std::vector<Impl::File> data;
  for (const std::string& path : paths) {
    const atom_readers::Format format = atom_readers::format_of_atoms(path);
    (format == atom_readers::Format::data ? data : impl_->files).push_back({path, format});
    moving = moving || format != atom_readers::Format::data;
  }
  if (!moving) {
    impl_->files = data;
    if (data.size() > 1)
      throw InputError({data[1].path, 0, ""}, "is a second data file", "give one, and dumps for more frames");
    return;
  }
  for (const Impl::File& file : data) atom_readers::AtomDataReader(file.path, impl_->species);
}

AtomFiles::~AtomFiles() = default;

bool AtomFiles::next(AtomFrame& frame) {
  std::vector<std::int64_t> ids;
  while (impl_->at < impl_->files.size()) {
    if (!impl_->reader) impl_->open();
    try {
      if (impl_->reader->next(frame, ids)) {
        impl_->states_time = impl_->reader->states_time();
        impl_->sort(frame, ids);
        if (impl_->again(frame)) continue;
        return true;
      }
    } catch (const atom_readers::CutOff&) {
      impl_->cut_off = true;
    }
    impl_->reader.reset();
    ++impl_->at;
  }
  if (impl_->first_ids.empty())
    throw InputError({impl_->file, 0, ""}, impl_->cut_off ? "ends within its first frame" : "has no frame",
                     atom_readers::truncated);
  return false;
}

const std::string& AtomFiles::file() const { return impl_->file; }
bool AtomFiles::cut_off() const { return impl_->cut_off; }
bool AtomFiles::states_time() const { return impl_->states_time; }

}  // namespace ropewalk
