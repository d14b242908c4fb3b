#include "io/friction_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr double pN = 1e-3 * units::nN_nm;  // eV/nm; pN/nm in eV/nm^2

bool same_tube(Chirality a, Chirality b) { return a.n == b.n && a.m == b.m; }

Chirality chirality_in(const TomlTable& t, const char* key) {
  const std::vector<long> nm = t.integers(key, 0, 1000);
  Chirality c;
  if (nm.size() == 2) c = {static_cast<int>(nm[0]), static_cast<int>(nm[1])};
  if (nm.size() != 2 || !c.valid())
    throw t.error(key, "is not that of a tube", "write [n, m], neither negative, not both 0");
  return c;
}

// Whoever made a file, its name may begin like this. Ours has the format in it, also where it is damaged.
bool is_ours(const std::string& text) { return text.find("ropewalk-friction-") != std::string::npos; }

std::vector<std::string> candidates_in(const fs::path& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("friction-", 0) == 0 && entry.path().extension() == ".toml" && entry.is_regular_file(error))
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<PairFriction> frictions_in(const fs::path& folder) {
  std::vector<PairFriction> all;
  for (const std::string& path : candidates_in(folder))
    if (const std::string text = read_file(path); is_ours(text)) all.push_back(friction_of_text(text, path));
  return all;
}

// The folders' own ones first.
std::vector<PairFriction> known_frictions(const std::vector<std::string>& folders) {
  std::vector<PairFriction> all;
  std::vector<fs::path> places(folders.begin(), folders.end());
  places.push_back(fs::path(data_directory()) / "friction");
  for (std::size_t k = 0; k < places.size(); ++k)
    if (std::find(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(k), places[k]) ==
        places.begin() + static_cast<std::ptrdiff_t>(k))
      for (PairFriction& f : frictions_in(places[k])) all.push_back(std::move(f));
  return all;
}

// How far the radii of both pairs are from each other, nm; the order of two tubes does not matter.
double radii_apart(Chirality a, Chirality b, const PairFriction& f) {
  const auto apart = [](Chirality x, Chirality y) {
    return std::fabs(ropewalk::tube_radius(x) - ropewalk::tube_radius(y));
  };
  return std::min(apart(a, f.a) + apart(b, f.b), apart(a, f.b) + apart(b, f.a));
}

}  // namespace

bool PairFriction::is_of(Chirality x, Chirality y) const {
  return (same_tube(a, x) && same_tube(b, y)) || (same_tube(a, y) && same_tube(b, x));
}

PairFriction friction_of_text(const std::string& text, const std::string& path) {
  const TomlTable top = TomlTable::parse(text, path);
  PairFriction f;
  f.path = path;
  f.hash = hash_hex(text);
  const TomlTable meta = top.table("meta");
  if (meta.string("format") != friction_format)
    throw meta.error("format", fmt::format("is \"{}\"", printable(meta.string("format"), 40)),
                     fmt::format("this program reads \"{}\"", friction_format));
  f.name = meta.string("name");
  f.a = chirality_in(meta, "chirality_a");
  f.b = chirality_in(meta, "chirality_b");
  f.potential = meta.string("potential");
  const auto number = [&](const TomlTable& t, const char* key, const char* unit, const Bounds& bounds) {
    f.quantities.push_back(read_quantity(t, key, unit, bounds));
    return f.quantities.back().value;
  };
  const TomlTable law = top.table("friction");
  f.strength = number(law, "strength", "pN/nm", Bounds::non_negative(1e5)) * pN;
  f.spin_strength = number(law, "spin_strength", "pN/nm", Bounds::non_negative(1e5)) * pN;
  f.end_strength = number(law, "end_strength", "pN", Bounds::non_negative(1e6)) * pN;
  f.elastic_slip = number(law, "elastic_slip", "nm", Bounds::range(1e-3, 1));
  f.drag = number(law, "drag", "eV ps/nm^3", Bounds::non_negative(1e4));
  // What the numbers above follow from, and what changes them.
  struct Other {
    const char *section, *key, *unit;
  };
  constexpr Other others[] = {{"register", "strength_least", "pN/nm"},
                              {"register", "strength_largest", "pN/nm"},
                              {"register", "strength_spread", "pN/nm"},
                              {"register", "spin_strength_least", "pN/nm"},
                              {"register", "spin_strength_largest", "pN/nm"},
                              {"register", "spin_strength_spread", "pN/nm"},
                              {"pressure", "ratio_at_10_pm", "1"},
                              {"pressure", "ratio_at_20_pm", "1"},
                              {"crossing", "force_at_2_deg", "pN"},
                              {"crossing", "force_at_5_deg", "pN"},
                              {"crossing", "force_at_10_deg", "pN"}};
  std::vector<std::pair<std::string, TomlTable>> sections;
  for (const char* name : {"register", "pressure", "crossing"})
    if (top.has(name)) sections.emplace_back(name, top.table(name));
  for (const Other& other : others)
    for (const auto& [name, t] : sections)
      if (name == other.section && t.has(other.key)) number(t, other.key, other.unit, Bounds::any());
  const TomlTable provenance = top.table("provenance");
  for (const std::string& key : provenance.keys()) f.provenance.emplace_back(key, provenance.string(key));
  top.finish();
  return f;
}

Grade grade_of(const PairFriction& f) {
  constexpr double known = 0.2, half = 0.5, nothing = 1;  // relative, relative, pN/nm
  Grade out;
  const auto look = [&](const char* key, const char* name, double smallest) {
    const auto q =
        std::find_if(f.quantities.begin(), f.quantities.end(), [&](const Quantity& x) { return x.key == key; });
    if (q == f.quantities.end()) return;
    const double error = q->standard_error.value_or(0), value = std::fabs(q->value);
    if (error <= std::max(known * value, smallest)) return;
    out.level = std::max(out.level, error > half * value ? Grade::Level::unfit : Grade::Level::limited);
    out.reasons.push_back(fmt::format("{} {:.3g} +- {:.2g} {}", name, q->value, error, q->unit));
  };
  look("friction.strength", "along the axis", nothing);
  look("friction.spin_strength", "against spin", nothing);
  look("friction.elastic_slip", "elastic slip", 0);
  return out;
}

PairFriction read_friction(const std::string& path) { return friction_of_text(read_file(path), path); }

std::vector<std::string> strange_friction_files(const std::vector<std::string>& folders) {
  std::vector<std::string> strange;
  for (const std::string& folder : folders)
    for (const std::string& path : candidates_in(folder))
      if (!is_ours(read_file(path)) && std::find(strange.begin(), strange.end(), path) == strange.end())
        strange.push_back(path);
  return strange;
}

std::string friction_text(const PairFriction& f, const std::string& comment) {
  std::string text =
      comment + fmt::format(
                    "\n[meta]\nformat = \"{}\"\nname = {}\nchirality_a = [{}, {}]\nchirality_b = [{}, {}]\n"
                    "potential = {}\n",
                    friction_format, toml_string(f.name), f.a.n, f.a.m, f.b.n, f.b.m, toml_string(f.potential));
  std::string section;
  for (const Quantity& q : f.quantities) {
    const std::size_t dot = q.key.rfind('.');
    if (q.key.substr(0, dot) != section) text += fmt::format("\n[{}]\n", section = q.key.substr(0, dot));
    text += quantity_text(q, q.key.substr(dot + 1));
  }
  text += "\n[provenance]\n";
  for (const auto& [key, value] : f.provenance) text += fmt::format("{:<16} = {}\n", key, toml_string(value));
  return text;
}

PairFriction find_friction(const std::string& name, const std::vector<std::string>& folders,
                           const InputError::Place& place) {
  const std::string stem =
      fs::path(name).extension() == ".toml" ? fs::path(name).stem().string() : fs::path(name).filename().string();
  std::error_code error;
  for (const std::string& folder : folders)
    for (const std::string& file : {name, name + ".toml"})
      if (const fs::path path = fs::path(folder) / file; fs::is_regular_file(path, error)) {
        PairFriction f = read_friction(path.string());
        if (f.name != stem)
          throw InputError(
              {f.path, 0, "meta.name"},
              fmt::format("is \"{}\", and the file is called {}", printable(f.name, 60), path.filename().string()),
              "give both the same name");
        return f;
      }
  std::string names;
  for (PairFriction& f : known_frictions(folders)) {
    if (f.name == stem) return std::move(f);
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", printable(f.name, 60));
  }
  throw InputError(place, fmt::format("is \"{}\", and there is no such friction", printable(name, 40)),
                   "write \"atoms\", or one of " + names + ", or type the strengths");
}

std::string kind_of_pair(Chirality a, Chirality b) {
  const auto kind = [](Chirality c) {
    return c.n == c.m ? "armchair" : c.n == 0 || c.m == 0 ? "zigzag" : "chiral";
  };
  const std::string of_a = kind(a), of_b = kind(b);
  return same_tube(a, b) || (of_a == of_b && of_a != "chiral") ? of_a : "unlike";
}

PairFriction friction_between(Chirality a, Chirality b, const std::vector<std::string>& folders,
                              const InputError::Place& place) {
  const std::string kind = kind_of_pair(a, b);
  std::vector<PairFriction> known;
  for (PairFriction& f : known_frictions(folders))
    if (kind_of_pair(f.a, f.b) == kind) known.push_back(std::move(f));
  if (known.empty())
    throw InputError(
        place,
        fmt::format("no friction of ({},{}) beside ({},{}) was measured, nor of any pair of their kind", a.n, a.m,
                    b.n, b.m),
        "measure it (ropewalk calibrate friction) and name its file, or type strengths");
  const auto exact = std::find_if(known.begin(), known.end(), [&](const PairFriction& f) { return f.is_of(a, b); });
  if (exact != known.end()) return *exact;
  return *std::min_element(known.begin(), known.end(), [&](const PairFriction& x, const PairFriction& y) {
    return radii_apart(a, b, x) < radii_apart(a, b, y);
  });
}

}  // namespace ropewalk
