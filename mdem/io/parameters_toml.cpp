#include "io/parameters_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "io/files.hpp"
#include "io/law_numbers.hpp"
#include "io/rows_toml.hpp"
#include "io/toml_table.hpp"

namespace ropewalk {

std::string too_turned(const BondStiffness& bond, double element_length) {
  const double turn = element_length * vector(bond.natural).norm();
  if (!(turn > most_natural_turn)) return "";
  return fmt::format("is {:.6g} nm, over which the natural shape turns by {:.3g} degrees; {:.3g} are allowed",
                     element_length, turn / units::degree, most_natural_turn / units::degree);
}

std::string longest_for(const BondStiffness& bond) {
  return fmt::format("take at most {:.6g} nm", std::floor(1e3 * most_natural_turn / vector(bond.natural).norm()) / 1e3);
}

Quantity start_quantity(const std::string& key, double value, const char* unit) {
  return {key, value, unit, 0.0, "derived", "", "of the bond when the pull was made"};
}

namespace {

constexpr const char* not_published = "not published";

void check_doi(const TomlTable& table, const std::string& doi) {
  if (doi.compare(0, 3, "10.") != 0 || doi.find('/') == std::string::npos)
    throw table.error("doi", fmt::format("is \"{}\"", printable(doi, 40)), "write it bare, as in 10.1000/182");
}

std::optional<double> read_standard_error(const TomlTable& q) {
  if (!q.is_string("standard_error")) return q.number("standard_error", Bounds::non_negative());
  if (q.string("standard_error") == not_published) return std::nullopt;
  throw q.error("standard_error", fmt::format("is the string \"{}\"", printable(q.string("standard_error"), 40)),
                fmt::format("write a number in the quantity's unit, or \"{}\"", not_published));
}

std::string read_origin(const TomlTable& q) {
  static const Words<const char*> origins = {
      {"published", "published"}, {"derived", "derived"}, {"calibrated", "calibrated"}, {"chosen", "chosen"}};
  return q.word("origin", origins);
}

class Reader {
 public:
  Reader(const std::string& text, const std::string& path)
      : path_(path), text_(text), top_(TomlTable::parse(text_, path)) {}

  ParameterSet read() {
    set_.path = path_;
    set_.hash = hash_hex(text_);
    set_.filament = top_.has("filament");
    read_meta(top_.table("meta"));
    if (top_.has("lattice")) read_lattice(top_.table("lattice"));
    if (set_.filament)
      read_filament(top_.table("filament"));
    else
      read_tube(top_.table("tube"));
    read_bond(top_.table("bond"));
    if (!set_.walls.empty()) read_holding(top_.table("held"));
    const TomlTable contact = top_.table("contact");
    for (const LawNumbers& law : law_numbers())
      if (contact.has(law.name)) set_.laws[law.name] = law.read({contact.table(law.name), set_, number_of_law()});
    read_atomistic();
    read_validity(top_.table("validity"));
    const TomlTable provenance = top_.table("provenance");
    for (const std::string& key : provenance.keys()) set_.provenance.emplace_back(key, provenance.string(key));
    for (const TomlTable& t : top_.tables("correlation")) read_correlation(t);
    top_.finish();
    std::stable_sort(order_.begin(), order_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [line, quantity] : order_) set_.quantities.push_back(std::move(quantity));
    return std::move(set_);
  }

 private:
  double quantity(const TomlTable& section, const std::string& key, const std::string& unit, const Bounds& bounds) {
    Quantity out = read_quantity(section, key, unit, bounds);
    out.of_carbon = !set_.filament && set_.honeycomb.carbon();
    order_.emplace_back(section.line(key), out);
    return out.value;
  }

  LawTable::Number number_of_law() {
    return [this](const TomlTable& section, const std::string& key, const std::string& unit, const Bounds& bounds) {
      return quantity(section, key, unit, bounds);
    };
  }

  void read_meta(const TomlTable& t) {
    if (!top_.has("meta"))
      throw top_.error("meta", "is missing",
                       fmt::format("a parameter set starts with [meta] format = \"{}\"", parameter_format));
    const std::string format = t.string("format");
    if (format != parameter_format)
      throw t.error("format", fmt::format("is \"{}\"", printable(format, 40)),
                    fmt::format("this program reads \"{}\"", parameter_format));
    set_.name = t.string("name");
    read_chirality(t);
    set_.reference = t.string("reference");
    set_.doi = t.string_or("doi", "");
    if (!set_.doi.empty()) check_doi(t, set_.doi);
  }

  void read_chirality(const TomlTable& t) {
    set_.chirality = {0, 0};
    if (set_.filament) {
      if (t.has("chirality"))
        throw t.error("chirality", "is that of a tube, and the set has [filament]", "take one of them away");
      return;
    }
    if (t.has("walls")) {
      read_walls(t);
      return;
    }
    if (!t.has("chirality"))
      throw t.error("chirality", "is missing",
                    "add chirality = [n, m]; what has no lattice of carbon has [filament] in place of [tube]");
    const std::vector<long> nm = t.integers("chirality", 0, 1000);
    if (nm.size() == 2) set_.chirality = {static_cast<int>(nm[0]), static_cast<int>(nm[1])};
    if (nm.size() != 2 || !set_.chirality.valid())
      throw t.error("chirality", "is not that of a tube", "write [n, m], neither negative, not both 0");
  }

  void read_lattice(const TomlTable& t) {
    if (set_.filament)
      throw top_.error("lattice", "is that of a tube, and the set has [filament]", "take one of them away");
    Honeycomb& h = set_.honeycomb;
    h.name = t.string("name");
    check_name_of_honeycomb(t, "name", h.name);
    const std::vector<std::string> species = t.strings("species");
    if (species.size() != 2) throw t.error("species", "are not two", "name those of both sublattices: [\"B\", \"N\"]");
    for (std::size_t k = 0; k < 2; ++k) {
      check_element(t, "species", species[k]);
      h.species[k] = species[k];
      h.atomic_weight[k] = quantity(t, fmt::format("weight_{}", k + 1), "u", Bounds::range(1, 300));
    }
    h.lattice_constant = std::sqrt(3.0) * quantity(t, "bond_length", "nm", Bounds::range(0.1, 0.4));
    constexpr const char* of[] = {"11", "12", "22"};
    for (std::size_t k = 0; k < 3; ++k) {
      h.pairs[k].epsilon = quantity(t, fmt::format("epsilon_{}", of[k]), "eV", Bounds::positive(1));
      h.pairs[k].sigma = quantity(t, fmt::format("sigma_{}", of[k]), "nm", Bounds::range(0.2, 0.6));
    }
  }

  void read_walls(const TomlTable& t) {
    if (t.has("chirality"))
      throw t.error("walls", "are those of a tube that has meta.chirality too", "take one of them away");
    for (const std::vector<double>& nm : t.rows("walls", Bounds::range(0, 1000), 2)) {
      Wall wall;
      wall.chirality = {static_cast<int>(nm[0]), static_cast<int>(nm[1])};
      if (wall.chirality.n != nm[0] || wall.chirality.m != nm[1] || !wall.chirality.valid())
        throw t.error("walls", "are not those of a tube", "write [[n, m], ...], inside first");
      set_.walls.push_back(wall);
    }
    if (set_.walls.size() < 2)
      throw t.error("walls", "are fewer than two", "write chirality = [n, m] for a tube of one wall");
    set_.chirality = set_.walls.back().chirality;
    static const Words<bool> carriers = {{"outer", true}, {"all", false}};
    set_.outer_carries = t.word("carried_by", carriers);
  }

  // The walls, which stand inside of one another.
  void read_each_wall(const TomlTable& t) {
    const Bounds stiffness = Bounds::positive(1e9);
    double density = 0, inside = 0;
    for (std::size_t k = 0; k < set_.walls.size(); ++k) {
      Wall& wall = set_.walls[k];
      const TomlTable own = t.table(fmt::format("{}", k + 1));
      wall.radius = quantity(own, "radius", "nm", Bounds::positive(1e3));
      check_geometry(own, "radius", wall.radius, tube_radius(wall.chirality), "nm", wall.chirality);
      wall.atoms_per_length = quantity(own, "atoms_per_length", "1/nm", Bounds::positive());
      check_geometry(own, "atoms_per_length", wall.atoms_per_length, ropewalk::atoms_per_length(wall.chirality), "1/nm",
                     wall.chirality);
      for (const char* key : {"EI", "GJ"}) quantity(own, key, "nN nm^2", stiffness);
      quantity(own, "EA", "nN", stiffness);
      if (wall.radius <= inside)
        throw own.error("radius", fmt::format("is {} nm, and the wall inside has {} nm", wall.radius, inside),
                        "name the walls from inside to outside");
      inside = wall.radius;
      density += wall.atoms_per_length;
    }
    const auto agree = [&](const char* key, double said, double of_walls, const char* unit) {
      if (std::fabs(said / of_walls - 1) > 1e-6)
        throw top_.table("tube").error(key, fmt::format("is {} {}", said, unit),
                                       fmt::format("the walls have {:.10g}", of_walls));
    };
    agree("contact_radius", set_.radius, inside, "nm");
    agree("atoms_per_length", set_.atoms_per_length, density, "1/nm");
  }

  // The tube by both ways of holding it, of which the bond has one.
  void read_holding(const TomlTable& t) {
    for (const char* way : {"all", "outer"}) {
      const TomlTable own = t.table(way);
      const bool used = set_.outer_carries == (way == std::string("outer"));
      for (const auto& [key, unit, bond] : {std::tuple{"EA", "nN", set_.bond.stretch},
                                            std::tuple{"EI", "nN nm^2", set_.bond.bend},
                                            std::tuple{"GJ", "nN nm^2", set_.bond.twist}}) {
        const double value = quantity(own, key, unit, Bounds::positive(1e9));
        if (used && std::fabs(bond / (value * units::nN_nm) - 1) > 1e-6)
          throw top_.table("meta").error("carried_by", fmt::format("is \"{}\", and bond.{} is not that of [held.{}]", way, key, way),
                           fmt::format("write bond.{} = {} {}", key, value, unit));
      }
    }
  }

  // A wrong unit or chirality changes the value by a factor; relaxation changes the rolled sheet by only 2 %.
  void check_geometry(const TomlTable& t, const char* key, double value, double rolled, const char* unit,
                      Chirality of) const {
    if (std::fabs(value / rolled - 1.0) < 0.1) return;
    throw t.error(
        key, fmt::format("is {} {}", value, unit),
        fmt::format("a ({},{}) tube has about {:.4g} {}", of.n, of.m, rolled, unit));
  }

  void read_tube(const TomlTable& t) {
    if (!set_.walls.empty()) {
      set_.radius = quantity(t, "contact_radius", "nm", Bounds::positive());
      set_.atoms_per_length = quantity(t, "atoms_per_length", "1/nm", Bounds::positive());
      set_.element_length = quantity(t, "element_length", "nm", Bounds::range(0.05, 50));
      read_each_wall(top_.table("wall"));
      return;
    }
    set_.radius = quantity(t, "radius", "nm", Bounds::positive());
    const double a = set_.honeycomb.lattice_constant;
    check_geometry(t, "radius", set_.radius, tube_radius(set_.chirality, a), "nm", set_.chirality);
    set_.atoms_per_length = quantity(t, "atoms_per_length", "1/nm", Bounds::positive());
    check_geometry(t, "atoms_per_length", set_.atoms_per_length, ropewalk::atoms_per_length(set_.chirality, a), "1/nm",
                   set_.chirality);
    set_.element_length = quantity(t, "element_length", "nm", Bounds::range(0.05, 50));
  }

  void read_filament(const TomlTable& t) {
    if (top_.has("tube"))
      throw top_.error("tube", "is that of a carbon tube, and the set has [filament]", "take one of them away");
    set_.radius = quantity(t, "contact_radius", "nm", Bounds::positive(1e3));
    set_.mass_per_length = quantity(t, "mass_per_length", "u/nm", Bounds::positive(1e9)) * units::atomic_mass;
    set_.element_length = quantity(t, "element_length", "nm", Bounds::range(0.05, 1e3));
    if (t.has("curvature"))
      throw t.error("curvature", "has no direction", "give curvature_1 or curvature_2, about the body's first or second axis");
    const std::pair<const char*, double*> natural[] = {{"curvature_1", &set_.bond.natural.x},
                                                       {"curvature_2", &set_.bond.natural.y},
                                                       {"twist_per_length", &set_.bond.natural.z}};
    for (const auto& [key, value] : natural)
      if (t.has(key))
        *value = quantity(t, key, value == &set_.bond.natural.z ? "rad/nm" : "1/nm", Bounds::range(-10, 10));
    if (const std::string turned = too_turned(set_.bond, set_.element_length); !turned.empty())
      throw t.error("element_length", turned, longest_for(set_.bond));
  }

  // The stiffnesses about the two axes of the body, in place of EI.
  void read_two_bends(const TomlTable& t) {
    const char* key = t.has("EI_1") ? "EI_1" : "EI_2";
    if (!set_.filament) throw t.error(key, "is of a filament, and the set has [tube]", "give EI: a tube is round");
    if (t.has("EI")) throw t.error(key, "stands beside EI", "give EI_1 and EI_2, or EI");
    const Bounds stiffness = Bounds::positive(1e9);
    const double one = quantity(t, "EI_1", "nN nm^2", stiffness) * units::nN_nm,
                 two = quantity(t, "EI_2", "nN nm^2", stiffness) * units::nN_nm;
    set_.bond.bend = 0.5 * (one + two);
    set_.bond.bend_difference = 0.5 * (one - two);
  }

  void read_bond(const TomlTable& t) {
    const Bounds stiffness = Bounds::positive(1e9);
    set_.bond.stretch = quantity(t, "EA", "nN", stiffness) * units::nN_nm;
    if (t.has("EI_1") || t.has("EI_2"))
      read_two_bends(t);
    else
      set_.bond.bend = quantity(t, "EI", "nN nm^2", stiffness) * units::nN_nm;
    set_.bond.twist = quantity(t, "GJ", "nN nm^2", stiffness) * units::nN_nm;
    if (t.has("kGA")) set_.bond.shear = quantity(t, "kGA", "nN", stiffness) * units::nN_nm;
    if (set_.filament)
      for (const char* part : {"anharmonic", "pull"})
        if (t.has(part))
          throw t.error(part, "is of the wall of a carbon tube, and the set has [filament]",
                        "take it away: bonds of filaments are harmonic");
    if (t.has("anharmonic")) set_.anharmonic = read_anharmonic(t.table("anharmonic"));
    if (!t.has("pull")) return;
    if (!set_.anharmonic) throw t.error("pull", "goes on where [bond.anharmonic] ends, which is missing", "add it");
    read_pull(t.table("pull"));
  }

  // Where a pull begins. A set from before this was written has it by its terms.
  double start_of_pull(const TomlTable& t, const char* key, double now, const char* unit) {
    if (t.has(key)) return quantity(t, key, unit, Bounds::positive(1e9));
    order_.emplace_back(t.line("end"), start_quantity(std::string("bond.pull.") + key, now, unit));
    return now;
  }

  void read_pull(const TomlTable& t) {
    Anharmonic& h = *set_.anharmonic;
    Pull pull;
    pull.end = quantity(t, "end", "1", Bounds::range(h.max_strain, 1));
    if (pull.end <= h.max_strain)
      throw t.error("end", fmt::format("is {}", pull.end),
                    fmt::format("must lie beyond max_strain = {}", h.max_strain));
    read_row(t, "force", pull.force, set_.pull_errors);
    for (auto* row : {&pull.force, &set_.pull_errors})
      for (double& force : *row) force *= units::nN_nm;
    const EdgeOfWindow edge = edge_of_window(h, set_.bond.stretch);
    const double start = start_of_pull(t, "start", h.max_strain, "1");
    if (std::fabs(start - h.max_strain) > 1e-9)
      throw t.error("start", fmt::format("is {}, not max_strain = {}", start, h.max_strain),
                    "leave max_strain as it was, or make the pull anew: ropewalk calibrate pull");
    pull.edge_force = units::nN_nm * start_of_pull(t, "edge_force", edge.force * units::eV_in_nN_nm, "nN");
    if (!(std::fabs(pull.force[0] / pull.edge_force - 1) < 0.1))
      throw t.error("force", fmt::format("begins with {:.4g} nN", pull.force[0] * units::eV_in_nN_nm),
                    fmt::format("{} {:.4g} nN: calibrate the set anew",
                                t.has("edge_force") ? "edge_force is" : "the terms of [bond.anharmonic] end with",
                                pull.edge_force * units::eV_in_nN_nm));
    const std::array<double, PULL_STEPS + 1> force = forces_of(pull, h, set_.bond.stretch);
    const double first = force[1] - force[0], step = (pull.end - h.max_strain) / PULL_STEPS;
    for (std::size_t k = 0; k < PULL_STEPS; ++k)
      if (!(force[k + 1] > force[k]))
        throw t.error("force", fmt::format("does not rise from value {} to value {}", k, k + 1),
                      "end the pull where the force is largest");
    if (edge.slope * step > 3 * first)
      throw t.error("force", "rises too little at its beginning for a smooth law",
                    "calibrate the set anew, with a smaller max_strain");
    set_.pull = pull;
    set_pull(h, set_.bond.stretch, pull);
  }

  Anharmonic read_anharmonic(const TomlTable& t) {
    Anharmonic h;
    h.used = true;
    h.radius = set_.radius;
    for (const AnharmonicTerm& term : anharmonic_terms)
      h.*term.value = quantity(t, term.key, "nN", Bounds::range(-1e9, 1e9)) * units::nN_nm;
    h.min_strain = quantity(t, "min_strain", "1", Bounds::range(-1, 0));
    h.max_strain = quantity(t, "max_strain", "1", Bounds::range(0, 1));
    h.max_shear = quantity(t, "max_shear", "1", Bounds::range(0, 1));
    h.max_bend = quantity(t, "max_bend", "1", Bounds::range(0, 1));
    check_anharmonic(t, h);
    return h;
  }

  // A bond whose stiffness vanishes within the window would let its tube fall into pieces of two strains.
  void check_anharmonic(const TomlTable& t, const Anharmonic& h) const {
    const BondStiffness& k = set_.bond;
    const auto stretch = [&](double e) { return k.stretch + 6 * h.e3 * e + 12 * h.e4 * e * e; };
    const double r2 = h.radius * h.radius, s = h.max_shear, b = h.max_bend;
    if (std::min(stretch(h.min_strain), stretch(h.max_strain)) <= 0)
      throw t.error("e3", "and e4 leave no stiffness at the end of the window", "narrow min_strain and max_strain");
    if (k.twist / r2 - 6 * std::fabs(h.s3) * s + 12 * h.s4 * s * s <= 0)
      throw t.error("s4", "and s3 leave no stiffness at the end of the window", "narrow max_shear");
    if (k.bend / r2 + 4 * h.b4 * b * b <= 0)
      throw t.error("b4", "leaves no moment at the end of the window", "narrow max_bend");
  }

  void read_atomistic() {
    if (set_.filament && top_.has("atomistic"))
      throw top_.error("atomistic", "is of the lattice of a carbon tube, and the set has [filament]", "take it away");
    if (!top_.has("atomistic")) {
      if (set_.anharmonic)
        throw top_.error("atomistic", "is missing", "[bond.anharmonic] needs the coupling that stands there");
      return;
    }
    const TomlTable t = top_.table("atomistic");
    quantity(t, "natural_twist", "rad/nm", Bounds::range(-10, 10));
    const double coupling = quantity(t, "coupling", "nN nm", Bounds::range(-1e6, 1e6)) * units::nN_nm;
    if (set_.anharmonic) set_.anharmonic->coupling = coupling;
    quantity(t, "poisson", "1", Bounds::range(-1, 1));
    quantity(t, "energy_per_atom", "eV", Bounds::range(-100, 0));
    if (t.has("sublattice_turn")) quantity(t, "sublattice_turn", "rad", Bounds::range(-1, 1));
    if (t.has("sublattice_rise")) quantity(t, "sublattice_rise", "nm", Bounds::range(-0.1, 0.1));
    if (t.has("sublattice_lift")) quantity(t, "sublattice_lift", "nm", Bounds::range(-0.1, 0.1));
  }

  void read_validity(const TomlTable& t) {
    set_.validity.kink_curvature = quantity(t, "kink_curvature", "1/nm", Bounds::positive(1e3));
    set_.validity.twist_collapse = quantity(t, "twist_collapse", "1", Bounds::positive(10));
    set_.validity.stretch = quantity(t, "stretch", "1", Bounds::positive(1));
    if (t.has("endless_collapse"))
      set_.validity.endless_collapse = quantity(t, "endless_collapse", "1", Bounds::positive(10));
    if (t.has("linear_curvature")) quantity(t, "linear_curvature", "1/nm", Bounds::positive(1e3));
    if (t.has("linear_twist")) quantity(t, "linear_twist", "1", Bounds::positive(10));
    if (t.has("linear_stretch")) quantity(t, "linear_stretch", "1", Bounds::positive(1));
    if (!set_.filament) return;
    // A wall between held ends stays round longer; a filament has one limit of twist at any length.
    if (t.has("endless_collapse"))
      throw t.error("endless_collapse", "is of the wall of a carbon tube, and the set has [filament]", "take it away");
    set_.validity.endless_collapse = set_.validity.twist_collapse;
  }

  void read_correlation(const TomlTable& t) {
    Correlation c;
    c.of = t.strings("of");
    const auto known = [&](const std::string& key) {
      return std::any_of(order_.begin(), order_.end(), [&](const auto& q) { return q.second.key == key; });
    };
    for (const std::string& key : c.of) {
      if (!known(key))
        throw t.error("of", fmt::format("names \"{}\", which is no quantity of this set", printable(key, 40)),
                      "write keys as in \"bond.EA\"");
      for (const Correlation& other : set_.correlations)
        if (std::find(other.of.begin(), other.of.end(), key) != other.of.end())
          throw t.error("of", fmt::format("names \"{}\" a second time", key), "name it in one group");
    }
    c.matrix = t.matrix("matrix", Bounds::range(-1 - 1e-9, 1 + 1e-9), c.of.size());
    Eigen::MatrixXd m(c.of.size(), c.of.size());
    for (std::size_t i = 0; i < c.of.size(); ++i)
      for (std::size_t j = 0; j < c.of.size(); ++j)
        m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = c.matrix[i][j];
    if ((m - m.transpose()).cwiseAbs().maxCoeff() > 1e-9 || (m.diagonal().array() - 1).abs().maxCoeff() > 1e-9 ||
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues().minCoeff() < -1e-6)
      throw t.error("matrix", "is not one of correlations",
                    "it must be symmetric, with 1 on the diagonal and no negative eigenvalue");
    set_.correlations.push_back(std::move(c));
  }

  std::string path_, text_;
  TomlTable top_;
  ParameterSet set_;
  std::vector<std::pair<int, Quantity>> order_;
};

}  // namespace

// Sweeps read the same few sets for thousands of scenes.
ParameterSet read_parameters(const std::string& path) {
  thread_local std::map<std::string, std::pair<std::string, ParameterSet>> known;  // by path: text and set
  std::string text = read_file(path);
  const auto at = known.find(path);
  if (at != known.end() && at->second.first == text) return at->second.second;
  ParameterSet set = parameters_of_text(text, path);
  if (known.size() >= 16) known.clear();
  known[path] = {std::move(text), set};
  return set;
}

ParameterSet parameters_of_text(const std::string& text, const std::string& path) {
  return Reader(text, path).read();
}

std::string with_start_of_pull(const std::string& text, const std::string& path) {
  const TomlTable bond = TomlTable::parse(text, path).table("bond");
  if (!bond.has("pull")) return text;
  const TomlTable pull = bond.table("pull");
  const ParameterSet set = parameters_of_text(text, path);
  std::string missing;
  for (const char* key : {"start", "edge_force"})
    if (!pull.has(key)) missing += quantity_text(*find_quantity(set, std::string("bond.pull.") + key), key);
  if (missing.empty()) return text;
  std::size_t at = 0;
  for (int line = pull.line("force"); line > 1; --line) at = text.find('\n', at) + 1;
  // A pull that is written with dotted keys has no place for new lines: the whole set is written anew.
  if (text.compare(at, 5, "force") != 0) return parameters_text(set, "");
  return text.substr(0, at) + missing + text.substr(at);
}

std::vector<std::vector<double>> covariance(const ParameterSet& set, const std::vector<std::string>& keys) {
  const auto error = [&](const std::string& key) {
    const Quantity* q = find_quantity(set, key);
    return q ? q->standard_error.value_or(0) : 0.0;
  };
  const auto correlation = [&](const std::string& i, const std::string& j) {
    if (i == j) return 1.0;
    for (const Correlation& c : set.correlations) {
      const auto a = std::find(c.of.begin(), c.of.end(), i), b = std::find(c.of.begin(), c.of.end(), j);
      if (a != c.of.end() && b != c.of.end())
        return c.matrix[static_cast<std::size_t>(a - c.of.begin())][static_cast<std::size_t>(b - c.of.begin())];
    }
    return 0.0;
  };
  std::vector<std::vector<double>> out;
  for (const std::string& i : keys) {
    out.emplace_back();
    for (const std::string& j : keys) out.back().push_back(correlation(i, j) * error(i) * error(j));
  }
  return out;
}

std::string provenance_value(const ParameterSet& set, const std::string& key) {
  for (const auto& [name, value] : set.provenance)
    if (name == key) return value;
  return "";
}

std::string tube_name(const ParameterSet& set) {
  if (set.filament) return set.name;
  std::string text;
  for (const Wall& wall : set.walls)
    text += fmt::format("{}({},{})", text.empty() ? "" : "@", wall.chirality.n, wall.chirality.m);
  if (text.empty()) text = fmt::format("({},{})", set.chirality.n, set.chirality.m);
  return set.honeycomb.carbon() ? text : text + " " + set.honeycomb.name;
}

void refuse_filament(const ParameterSet& set, const std::string& so, const std::string& instead) {
  if (set.filament) throw InputError({set.path, 0, "filament"}, "has no lattice of atoms: " + so, instead);
}

void refuse_other_than_carbon(const ParameterSet& set, const std::string& what) {
  if (set.filament || set.honeycomb.carbon()) return;
  throw InputError({set.path, 0, "lattice"}, fmt::format("is of {}, and {}", set.honeycomb.name, what),
                   "take a set of a carbon tube");
}

void check_element(const TomlTable& t, const std::string& key, const std::string& symbol) {
  const auto letter = [](char c, char from, char to) { return c >= from && c <= to; };
  if (!symbol.empty() && symbol.size() <= 2 && letter(symbol[0], 'A', 'Z') &&
      (symbol.size() == 1 || letter(symbol[1], 'a', 'z')))
    return;
  throw t.error(key, fmt::format("names \"{}\", which is no element", printable(symbol, 20)),
                "write symbols, as \"B\" or \"Si\"");
}

void check_name_of_honeycomb(const TomlTable& t, const std::string& key, const std::string& name) {
  const bool letters = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
  if (letters && name.size() <= 12 && name != "C") return;
  throw t.error(key, fmt::format("is \"{}\"", printable(name, 40)),
                name == "C" ? "carbon is built in: leave its table away"
                            : "write up to 12 letters and digits, as \"BN\": sets are named by them");
}

void refuse_several_walls(const ParameterSet& set, const std::string& so, const std::string& instead) {
  if (set.walls.empty()) return;
  throw InputError({set.path, 0, "meta.walls"}, fmt::format("are {}: {}", tube_name(set), so), instead);
}

const Quantity* find_quantity(const ParameterSet& set, const std::string& key) {
  for (const Quantity& q : set.quantities)
    if (q.key == key) return &q;
  return nullptr;
}

Quantity read_quantity(const TomlTable& section, const std::string& key, const std::string& unit,
                       const Bounds& bounds) {
  const std::string form = fmt::format("{{ value, unit = \"{}\", standard_error, origin, doi }}", unit);
  if (!section.has(key)) throw section.error(key, "is missing", fmt::format("add {} = {}", key, form));
  const TomlTable q = section.table(key, form);
  Quantity out;
  out.key = section.path() + "." + key;
  out.value = q.number("value", bounds);
  out.unit = q.string("unit");
  if (out.unit != unit)
    throw q.error("unit", fmt::format("is \"{}\"", printable(out.unit, 40)),
                  fmt::format("convert the value to \"{}\"", unit));
  out.standard_error = read_standard_error(q);
  out.origin = read_origin(q);
  out.note = q.string_or("note", "");
  if (out.origin == "published" || q.has("doi")) {
    out.doi = q.string("doi");
    check_doi(q, out.doi);
  }
  return out;
}

std::string quantity_text(const Quantity& q, const std::string& key) {
  std::string text = fmt::format(
      "{:<16} = {{ value = {}, unit = {}, standard_error = {}, origin = {}", key, q.value, toml_string(q.unit),
      q.standard_error ? fmt::format("{:.3g}", *q.standard_error) : toml_string(not_published),
      toml_string(q.origin));
  if (!q.doi.empty()) text += ", doi = " + toml_string(q.doi);
  if (!q.note.empty()) text += ", note = " + toml_string(q.note);
  return text + " }\n";
}

namespace {

std::string pull_row_text(const ParameterSet& set) {
  std::array<std::string, PULL_STEPS + 1> values, errors;
  for (std::size_t k = 0; k <= PULL_STEPS; ++k) {
    values[k] = fmt::format("{:.8g}", set.pull->force[k] * units::eV_in_nN_nm);
    errors[k] = fmt::format("{:.2g}", set.pull_errors[k] * units::eV_in_nN_nm);
  }
  return row_text("force", values, errors);
}

}  // namespace

std::string parameters_text(const ParameterSet& set, const std::string& comment) {
  std::string text = comment;
  text += fmt::format("\n[meta]\nformat = \"{}\"\nname = {}\n", parameter_format, toml_string(set.name));
  if (!set.walls.empty()) {
    std::vector<std::string> walls;
    for (const Wall& wall : set.walls)
      walls.push_back(fmt::format("[{}, {}]", wall.chirality.n, wall.chirality.m));
    text += fmt::format("walls = [{}]\ncarried_by = \"{}\"\n", fmt::join(walls, ", "),
                        set.outer_carries ? "outer" : "all");
  } else if (!set.filament) {
    text += fmt::format("chirality = [{}, {}]\n", set.chirality.n, set.chirality.m);
  }
  text += fmt::format("reference = {}\n", toml_string(set.reference));
  if (!set.doi.empty()) text += fmt::format("doi = {}\n", toml_string(set.doi));
  std::string section;
  for (const Quantity& q : set.quantities) {
    const std::size_t dot = q.key.rfind('.');
    if (q.key.substr(0, dot) != section) {
      section = q.key.substr(0, dot);
      text += fmt::format("\n[{}]\n", section);
      if (section == "lattice")
        text += fmt::format("name = {}\nspecies = [{}, {}]\n", toml_string(set.honeycomb.name),
                            toml_string(set.honeycomb.species[0]), toml_string(set.honeycomb.species[1]));
      for (const LawNumbers& law : law_numbers())
        if (law.rows && set.laws.count(law.name)) text += law.rows(set.laws.at(law.name), section);
      if (section == "bond.pull") text += pull_row_text(set);
    }
    text += quantity_text(q, q.key.substr(dot + 1));
  }
  for (const Correlation& c : set.correlations) {
    std::vector<std::string> names, rows;
    for (const std::string& key : c.of) names.push_back(toml_string(key));
    for (const std::vector<double>& row : c.matrix) {
      std::vector<std::string> numbers;
      for (const double x : row) numbers.push_back(fmt::format("{:.10g}", x));
      rows.push_back(fmt::format("  [{}],\n", fmt::join(numbers, ", ")));
    }
    text +=
        fmt::format("\n[[correlation]]\nof = [{}]\nmatrix = [\n{}]\n", fmt::join(names, ", "), fmt::join(rows, ""));
  }
  if (!set.provenance.empty()) text += "\n[provenance]\n";
  for (const auto& [key, value] : set.provenance)
    text += fmt::format("{:<16} = {}\n", toml_key(key), toml_string(value));
  return text;
}

}  // namespace ropewalk
