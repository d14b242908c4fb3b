// [failure] tubes that break: a bond between two elements breaks for good in the first step in which the tube about
// it is strained, or bends, beyond its limit, or in which the bond itself can carry no more torque.
//
//   strain of n bonds about it > strain,   or   bending moment over n bonds > moment,   or   twist of it >= 90
//   degrees
//
// n bonds are about as long as the tube is wide, one where elements are as long as that. So heat, which strains a
// bond the more the shorter it is, weakens a tube in short elements no more than in long ones. `from = "atoms"`
// takes the strain up to which atoms were pulled: the force there is the ideal strength at 0 K. The limit of strain
// may scatter along the tube, by the seed and the number of the element: the weakest place of a length l has the
// distribution of W. Weibull (J. Appl. Mech. 18, 293 (1951)),
//
//   probability that it bears more than e:  exp(-(l/l0) (e/e0)^k)
//
// l0 is the length to which the typed mean and standard deviation belong; they give e0 and k. A bond is as strong
// as its own length of tube, so that a tube is as strong in elements of any length. The energy of the bond is lost.
// The parts of the tube are then joined by nothing but contact; as before, elements within the exclusion along the
// tube do not touch each other. Units nm, ps, eV.
#include "scene/interactions/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "model/counter_random.hpp"
#include "model/error.hpp"
#include "observe/bending.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "scene/spacing.hpp"
#include "sim/forces/force_term.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk {
namespace {

constexpr double never_breaks = std::numeric_limits<double>::infinity();
constexpr double no_bond = -1;                         // behind the last element of a tube
constexpr double longest_bond = 1.5;                   // element lengths
constexpr std::uint32_t strain_question = 0xFFFFFFFE;  // a last number of counters that nothing else takes

// k, of a standard deviation of `share` of the mean.
double weibull_exponent(double share) {
  double below = 1, above = 1e6;
  for (int step = 0; step < 200; ++step) {
    const double k = std::sqrt(below * above), mean = std::tgamma(1 + 1 / k);
    (std::tgamma(1 + 2 / k) / (mean * mean) - 1 > share * share ? below : above) = k;
  }
  return above;
}

struct FailureLaw {
  double strain = never_breaks, deviation = 0, reference = 0;  // reference: nm of tube that both belong to
  bool from_atoms = false;
  double moment = never_breaks;  // eV
  std::uint64_t seed = 1;

  // Strain limits of the bond behind each element of such a tube.
  std::function<double(int)> strains_of(const TubeType& type) const {
    const double length = type.element_length;
    if (from_atoms) return [end = end_of_stretch(type.bond.anharmonic)](int) { return end; };
    if (!(deviation > 0)) return [mean = strain](int) { return mean; };
    const double k = weibull_exponent(deviation / strain),
                 scale = strain / std::tgamma(1 + 1 / k) * std::pow(reference / length, 1 / k);
    return [k, scale, seed = seed](int element) {
      const auto bits = philox({static_cast<std::uint32_t>(element), 0, 0, strain_question}, seed);
      return scale * std::pow(-std::log(unit_interval(bits[0])), 1 / k);
    };
  }
};

// --- the term -----------------------------------------------------------------------------------------

class TubeFailure : public ForceTerm {
 public:
  TubeFailure(FailureLaw law, const Topology& scene) : law_(law), scene_(scene), here_(scene) { find_limits(); }
  std::unique_ptr<ForceTerm> copy() const override { return std::make_unique<TubeFailure>(*this); }
  std::string name() const override { return "failure"; }
  const std::vector<char>* broken_bonds() const override { return all_.empty() ? nullptr : &broken_; }

  Strength strength(int type) const override {
    Strength out;
    out.moment = law_.moment;
    bool first = true;
    for (int t = 0; t < here_.tubes(); ++t)
      for (int i = here_.tube_begin[t]; here_.tube_type[t] == type && i < here_.tube_begin[t + 1]; ++i) {
        const auto e = static_cast<std::size_t>(i);
        if (limit_[e] == no_bond || broken_[e]) continue;
        out.weakest = first ? limit_[e] : std::min(out.weakest, limit_[e]);
        out.strongest = first ? limit_[e] : std::max(out.strongest, limit_[e]);
        first = false;
      }
    return out;
  }

  // Bonds that had broken before the start are where they are at the start.
  void prepare(const ListedScene& scene) override {
    if (scene.topology.part) {
      here_ = scene.topology;
      find_limits();
      mark_broken();
    }
    for (const int element : all_) {
      const auto i = static_cast<std::size_t>(element);
      if (!placed_) tell(element, 0, 0.5 * (scene.state.position[i] + scene.state.position[i + 1]));
    }
    placed_ = true;
  }

  // Each process has the bonds behind its own elements. Which of them break in one step depends on those that had
  // broken before it, and on no order.
  StateUpdate advance(double, const State& state) override {
    std::vector<std::pair<int, int>> breaking;  // tube and element
    for (int t = 0; t < here_.tubes(); ++t)
      for (int i = here_.tube_begin[t]; i < here_.tube_begin[t + 1]; ++i)
        if (here_.owns(i) && !here_.is_image(i) && breaks(t, state, i)) breaking.emplace_back(t, i);
    StateUpdate now;
    for (const auto& [t, i] : breaking) now.lost += break_at(here_.type_of(t), state, i);
    now.events = static_cast<long>(breaking.size());
    now.news = now.events > 0;
    return now;
  }

  bool remembers() const override { return true; }
  TermState memory() const override {
    TermState out;
    for (const int element : all_)
      if (owns_number(here_, element)) out.push_back({element, {}});
    return out;
  }
  // A bond is judged by those about it.
  double copy_reach() const override {
    double reach = 0;
    for (const TubeType& type : scene_.types) reach = std::max(reach, longest_bond * 2 * type.radius);
    return reach;
  }
  void set_memory(const TermState& memory) override {
    placed_ = true;
    all_.clear();
    events_.clear();
    for (const TermRecord& r : memory) {
      if (!r.numbers.empty() || ends_tube(r.element))
        throw std::runtime_error("the memory of broken tubes is damaged");
      all_.push_back(r.element);
    }
    mark_broken();
  }
  void begin_with(const TermState& memory) override {
    set_memory(memory);
    placed_ = false;
  }
  std::vector<TermEvent> events() const override { return events_; }
  void forget_events() override { events_.clear(); }
  std::size_t bytes() const override { return limit_.size() * (sizeof(double) + 1); }

 private:
  // Nothing is known of the bond behind a copy at the edge of what is here.
  void find_limits() {
    limit_.assign(static_cast<std::size_t>(here_.elements()), no_bond);
    for (int t = 0; t < here_.tubes(); ++t) {
      const auto strain_of = law_.strains_of(here_.type_of(t));
      for (int i = here_.tube_begin[t]; i + 1 < here_.tube_begin[t + 1]; ++i)
        limit_[static_cast<std::size_t>(i)] = strain_of(number_in_scene(here_, here_.original_of(i)));
    }
    broken_.assign(limit_.size(), 0);
  }
  void mark_broken() {
    broken_.assign(limit_.size(), 0);
    for (const int element : all_)
      if (const int i = place_of(here_, element); i >= 0)
        for (const int e : with_images(i)) broken_[static_cast<std::size_t>(e)] = 1;
  }
  bool ends_tube(int element) const {
    return element + 1 == scene_.tube_begin[static_cast<std::size_t>(scene_.tube_of(element)) + 1];
  }
  // A bond slips a hair before BondSum::slipping, so that no run ends for a bond that breaks.
  static bool slips(const TubeType& type, const Quaternion& from, const Quaternion& to) {
    Quaternion turn = from.conjugate() * to;
    if (is_shaped(type.bond)) {
      const Quaternion back = natural_turn(type.bond, -0.5 * type.element_length);
      turn = back * turn * back;
    }
    return turn.z() * turn.z() >= (1 - 1e-9) * turn.w() * turn.w();
  }
  bool breaks(int tube, const State& state, int element) const {
    const auto i = static_cast<std::size_t>(element);
    if (broken_[i] || limit_[i] == no_bond) return false;
    const TubeType& type = here_.type_of(tube);
    if (slips(type, state.orientation[i], state.orientation[i + 1])) return true;
    const auto [first, last] = about(tube, element);
    const int bonds = last - first + 1;
    const double length = bonds * type.element_length;
    double arc = 0;
    for (int k = first; k <= last; ++k) {
      const auto at = static_cast<std::size_t>(k);
      arc += (state.position[at + 1] - state.position[at]).norm();
    }
    return arc > length * (1 + limit_[i]) ||
           (law_.moment < never_breaks &&
            bending_moment(type.bond, length, frame_of(state.orientation[static_cast<std::size_t>(first)]),
                           frame_of(state.orientation[static_cast<std::size_t>(last + 1)])) > law_.moment);
  }
  // The bonds about this one, by the elements before them, which are together about as long as the tube is wide.
  // None of them is broken.
  std::pair<int, int> about(int tube, int element) const {
    const TubeType& type = here_.type_of(tube);
    const int bonds = std::max(1, static_cast<int>(std::lround(2 * type.radius / type.element_length)));
    int first = element, last = element;
    for (bool grows = true; grows && last - first + 1 < bonds;) {
      grows = false;
      if (last + 2 < here_.tube_begin[tube + 1] && !broken_[static_cast<std::size_t>(last + 1)])
        ++last, grows = true;
      if (last - first + 1 < bonds && first > here_.tube_begin[tube] &&
          !broken_[static_cast<std::size_t>(first - 1)])
        --first, grows = true;
    }
    return {first, last};
  }
  double break_at(const TubeType& type, const State& state, int element) {
    const auto i = static_cast<std::size_t>(element);
    const Vector3 d = state.position[i + 1] - state.position[i];
    const std::vector<int> bonds = with_images(element);
    for (const int e : bonds) broken_[static_cast<std::size_t>(e)] = 1;
    // The bonds are kept in the order of the elements, as a memory comes back.
    const int in_scene = number_in_scene(here_, element);
    all_.insert(std::upper_bound(all_.begin(), all_.end(), in_scene), in_scene);
    tell(in_scene, state.time, state.position[i] + 0.5 * d);
    return static_cast<double>(bonds.size()) * bond_energy(type.bond, type.element_length, d,
                                                           frame_of(state.orientation[i]),
                                                           frame_of(state.orientation[i + 1]))
                                                   .total();
  }
  void tell(int element, double time, const Vector3& place) {
    events_.push_back({time, "tube broke", element, element + 1, place});
  }
  // The bond behind this element, and its images in a slice.
  std::vector<int> with_images(int element) const {
    std::vector<int> all = {element};
    for (const int image : {here_.image_below(element), here_.image_above(element)})
      if (image >= 0 && limit_[static_cast<std::size_t>(image)] != no_bond) all.push_back(image);
    return all;
  }

  FailureLaw law_;
  Topology scene_, here_;      // here: what this process has of the scene
  std::vector<double> limit_;  // strain limit of the bond behind each element here
  std::vector<char> broken_;   // likewise
  std::vector<int> all_;           // elements behind which a bond has broken, images left out
  std::vector<TermEvent> events_;  // that nobody has written yet
  bool placed_ = true;
};

// --- its table ----------------------------------------------------------------------------------------

class FailureDrive : public Drive {
 public:
  FailureLaw law;

  SceneTable table() const override;
  std::string words() const override {
    std::string strain = law.from_atoms              ? "strained beyond the pull of their atoms"
                         : law.strain < never_breaks ? fmt::format("strained by {:.4g}", law.strain)
                                                     : "";
    if (law.deviation > 0) strain += fmt::format(" ± {:.3g} in {:.4g} nm of tube", law.deviation, law.reference);
    if (law.moment < never_breaks)
      strain += fmt::format("{}bent with {:.4g} nN nm", strain.empty() ? "" : " or ", law.moment / units::nN_nm);
    return "tubes break where they are " + strain;
  }
  void add_terms(const Scene&, const Topology& topology, const State&, Interaction& interaction) const override {
    add_term(std::make_shared<TubeFailure>(law, topology), interaction);
  }
  // Strain and moment count over a diameter of tube, whatever the bonds in it.
  std::string why_not_split() const override {
    return law.deviation > 0 ? "[failure] strain_deviation draws a strain for every bond, and of shorter elements others"
                             : "";
  }
  std::string why_not_lengthened() const override { return ""; }
};

// A strain at which the bonds do not follow the atoms any more would make the strength up.
void refuse_beyond_data(const TomlTable& t, const Scene& scene, const FailureLaw& law) {
  for (const ParameterSet& set : scene.sets) {
    const std::string key = law.from_atoms ? "from" : "strain";
    const double end = scene.bond.anharmonic ? set.end_of_stretch() : set.validity.stretch;
    if (law.from_atoms ? scene.bond.anharmonic && set.pull : !(law.strain < never_breaks) || law.strain <= end)
      continue;
    const std::string what =
        law.from_atoms ? fmt::format("is \"atoms\", and {}",
                                     scene.bond.anharmonic ? set.name + " has no pull of atoms until they give way"
                                                           : "the bonds are harmonic")
                       : fmt::format("is {:.4g}, and the bonds of {} follow its atoms up to {:.4g}", law.strain,
                                     set.name, end);
    std::string remedy = law.from_atoms ? "give a strain of your own" : fmt::format("take at most {:.4g}", end);
    if (scene.bond.anharmonic && !set.pull)
      remedy = fmt::format("`ropewalk calibrate pull {}` makes a set that has more, or {}", set.path, remedy);
    if (!scene.bond.anharmonic && set.pull) remedy = "leave [bond] law out, or " + remedy;
    throw t.error(key, what, remedy);
  }
}

const KeyTable<FailureDrive>& failure_table() {
  using Key = KeyOf<FailureDrive>;
  static const KeyTable<FailureDrive> table = {
      "failure",
      "tubes break; without this table they do not, at whatever load",
      {Key::number(
           "strain", unit::none, Bounds::range(0.001, 1), [](auto& d) -> auto& { return d.law.strain; },
           otherwise("0.16", "required but for from and moment_nN_nm"),
           "strain at which a tube breaks: 0.16 without defects (DOI 10.1103/PhysRevB.65.235430), 0.02 to 0.12 in "
           "experiments (DOI 10.1126/science.287.5453.637)"),
       Key::word(
           "from", Words<bool>{{"atoms", true}}, [](auto& d) -> auto& { return d.law.from_atoms; },
           otherwise("\"atoms\"", "a strain of your own"),
           "\"atoms\": at the end of the pull of the set, the ideal strength at 0 K"),
       Key::number(
           "strain_deviation", unit::none, Bounds::range(0, 1), [](auto& d) -> auto& { return d.law.deviation; },
           standard(), "standard deviation of that strain along the tubes, as defects make it (Weibull)"),
       Key::number(
           "reference_length_nm", unit::nm, Bounds::positive(1e9), [](auto& d) -> auto& { return d.law.reference; },
           otherwise("1.378", "the set's own element length"),
           "length of tube that the scattered strain and its deviation belong to: longer tubes are weaker"),
       Key::number(
           "moment_nN_nm", unit::nN_nm, Bounds::positive(1e6), [](auto& d) -> auto& { return d.law.moment; },
           otherwise("15", "never"), "bending moment at which a bond breaks too"),
       Key::integer(
           "seed", 0, 1000000000, [](auto& d) -> auto& { return d.law.seed; }, otherwise("1", "start.seed"),
           "seed of the scatter")},
      [](const TomlTable& t, const Scene& scene, FailureDrive& failure) {
        if (!t.has("strain") && !t.has("from") && !t.has("moment_nN_nm"))
          throw t.error("strain", "is missing", "write one, or from = \"atoms\", or moment_nN_nm");
        for (const char* key : {"strain", "strain_deviation"})
          if (failure.law.from_atoms && t.has(key))
            throw t.error(key, "stands beside from = \"atoms\", which has the strain of tubes without defects",
                          "give one of them");
        if (t.has("strain_deviation") && !t.has("strain"))
          throw t.error("strain_deviation", "stands without strain", "give the mean strain too");
        refuse_beyond_data(t, scene, failure.law);
        if (!t.has("seed")) failure.law.seed = scene.start.seed;
        if (!(failure.law.reference > 0)) failure.law.reference = own_element_length(scene);
        if (failure.law.deviation > 0.34 * failure.law.strain)
          throw t.error("strain_deviation", "is more than a third of strain: some bonds would break at rest",
                        fmt::format("take at most {:.2g}", failure.law.strain / 3));
      }};
  return table;
}

SceneTable FailureDrive::table() const { return failure_table().doc(); }

}  // namespace

std::shared_ptr<const ForceTerm> broken_tubes_term(const Topology& topology) {
  FailureLaw law;
  constexpr double beyond_all = 1e6;
  law.strain = beyond_all;
  return std::make_shared<TubeFailure>(law, topology);
}

DriveKind failure_drive() {
  return {
      [] { return failure_table().doc(); },
      [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
        return std::make_shared<const FailureDrive>(failure_table().read(t, scene));
      },
      "",
      {{"failure_lost_eV", "eV", "energy that bonds have lost as tubes broke, since the start", &TermAccount::lost},
       {"bonds_broken", "", "bonds of tubes that have broken since the start", &TermAccount::events}}};
}

}  // namespace ropewalk
