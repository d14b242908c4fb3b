// [rope]: any number of tubes, and strands of finite ones: scene/kinds/rope.hpp.
#include "scene/kinds/rope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "model/error.hpp"
#include "model/units.hpp"
#include "observe/centre_line.hpp"
#include "observe/observe.hpp"
#include "run/run_directory.hpp"
#include "scene/ends/grip.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "scene/spacing.hpp"
#include "scene/state_csv.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

Scene scene_of(const std::string& rope, const std::string& more = "", const std::string& top = "") {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n" + top + "[rope]\n" +
                           rope + more + "[run]\nduration_ps = 1\n",
                       "rope.toml");
}
const std::string
    seven = "tubes = 7\nlength_nm = 60\n",
    finite = seven + "tube_length_nm = 15\n",
    clamps = "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { strain = 0.01, rate_per_ps = 0.01 }\n";

double end_of(const Prepared& p, int tube, bool last) {
  const int e = last ? p.topology.tube_begin[tube + 1] - 1 : p.topology.tube_begin[tube];
  return p.state.position.z[static_cast<std::size_t>(e)] + (last ? 0.5 : -0.5) * p.topology.types[0].element_length;
}

TEST(RopeOfFiniteTubes, FillsEachStrandFromEndToEnd) {
  for (const char* stagger : {"none", "brick", "random"}) {
    Scene scene = scene_of(finite + "stagger = \"" + stagger + "\"\n");
    const Prepared p = prepare(scene);
    const Topology& t = p.topology;
    ASSERT_EQ(t.strands(), 7) << stagger;
    EXPECT_GT(t.tubes(), 14);
    const Topology strands = strands_of(t);
    const double whole = strands.length_of(0) * t.types[0].element_length + t.groups.strand_holes,
                 rest = coaxial_gap(scene);
    EXPECT_NEAR(whole, 60, 0.51 * t.types[0].element_length);
    EXPECT_GT(common_length(strands), 0) << "sections have all strands";
    for (int tube = 0; tube < t.tubes(); ++tube) {
      EXPECT_GE(t.length_of(tube), 3);
      if (t.begins_strand(tube)) {
        EXPECT_NEAR(end_of(p, tube, false), -0.5 * whole, 1e-9);
      }
      if (t.ends_strand(tube)) {
        EXPECT_NEAR(end_of(p, tube, true), 0.5 * whole, 1e-9);
      } else {
        EXPECT_GE(end_of(p, tube + 1, false) - end_of(p, tube, true), rest - 1e-9) << "gaps";
      }
    }
  }
}

TEST(RopeOfFiniteTubes, StaggersNeighboursByAThird) {
  Scene none = scene_of(finite + "stagger = \"none\"\n"), brick = scene_of(finite + "stagger = \"brick\"\n");
  const auto first_ends = [](Scene& scene) {
    const Prepared p = prepare(scene);
    std::vector<double> ends;
    for (int tube = 0; tube < p.topology.tubes(); ++tube)
      if (p.topology.begins_strand(tube)) ends.push_back(end_of(p, tube, true));
    return ends;
  };
  const std::vector<double> level = first_ends(none), shifted = first_ends(brick);
  for (const double end : level) EXPECT_NEAR(end, level[0], 1e-9);
  // The centre tube and its neighbours, and neighbours on the ring.
  for (std::size_t k = 1; k < 7; ++k) {
    EXPECT_GT(std::fabs(shifted[k] - shifted[0]), 3) << k;
    EXPECT_GT(std::fabs(shifted[k] - shifted[k % 6 + 1]), 3) << k;
  }
}

TEST(RopeOfFiniteTubes, DrawsLengthsFromItsSeed) {
  const auto lengths = [](const std::string& seed) {
    Scene scene = scene_of("tubes = 19\nlength_nm = 300\ntube_length_nm = 30\ntube_length_deviation_nm = 8\n",
                           "[start]\nseed = " + seed + "\n");
    const Topology t = prepare(scene).topology;
    std::vector<int> inside;
    for (int tube = 0; tube < t.tubes(); ++tube)
      if (!t.begins_strand(tube) && !t.ends_strand(tube)) inside.push_back(t.length_of(tube));
    return inside;
  };
  const std::vector<int> a = lengths("1"), b = lengths("2");
  EXPECT_NE(a, b);
  EXPECT_EQ(a, lengths("1"));
  double mean = 0, square = 0;
  for (const int n : a) mean += n * 1.37758708 / static_cast<double>(a.size());
  for (const int n : a) square += std::pow(n * 1.37758708 - mean, 2) / static_cast<double>(a.size());
  EXPECT_NEAR(mean, 30, 3 * 8 / std::sqrt(a.size()));
  EXPECT_NEAR(std::sqrt(square), 8, 2);
}

// Their ends neither push nor pull: the tubes stay where they are.
TEST(RopeOfFiniteTubes, ItsEndsInLineRest) {
  Scene scene = scene_of("tubes = 1\nlength_nm = 40\ntube_length_nm = 19\nstagger = \"none\"\n");
  const Prepared p = prepare(scene);
  ASSERT_EQ(p.topology.tubes(), 2);
  Scene own = scene_of("tubes = 1\nlength_nm = 40\ntube_length_nm = 19\nstagger = \"none\"\ngap_nm = " +
                       std::to_string(coaxial_gap(scene)) + "\n");
  const double here = end_of(p, 1, false) - end_of(p, 0, true);
  EXPECT_GE(here, coaxial_gap(scene) - 1e-6);
  const Simulation s = start(scene, p);
  double largest = 0;
  for (std::size_t i = 0; i < p.state.size(); ++i) largest = std::max(largest, s.forces().force[i].norm());
  EXPECT_LT(largest, 0.3) << "eV/nm; it is 7 000 where their walls are 0.34 nm apart";
}

TEST(RopeOfFiniteTubes, ClampsHoldTheEndsOfTheRope) {
  Scene scene = scene_of(finite, clamps);
  const Prepared p = prepare(scene);
  for (const GripLoad* grip : p.loads.of<GripLoad>()) {
    EXPECT_EQ(grip->elements.size(), 7u);
    for (const int e : grip->elements) {
      const int tube = p.topology.tube_of(e);
      EXPECT_TRUE(grip->end == lower_end ? p.topology.begins_strand(tube) : p.topology.ends_strand(tube));
    }
  }
  Scene turned = scene_of(finite, "[twist]\nmoment_nN_nm = 1\nrate_nN_nm_per_ps = 1\n");
  const Prepared q = prepare(turned);
  for (const auto& load : q.loads) EXPECT_EQ(load->elements.size(), 7u) << "no couple on ends inside";
}

TEST(RopeOfFiniteTubes, StrainIsThatOfTheWholeFreeLength) {
  Scene scene = scene_of(finite, clamps);
  const Prepared p = prepare(scene);
  const auto at = [&](End end) {
    double sum = 0;
    for (const GripLoad* grip : p.loads.of<GripLoad>())
      if (grip->end == end)
        for (const int e : grip->elements) sum += p.state.position.z[static_cast<std::size_t>(e)] / 7;
    return sum;
  };
  EXPECT_NEAR(free_length(scene, strands_of(p.topology), 0), at(upper_end) - at(lower_end), 1e-9);
  // Whole tubes have the length that was asked for.
  Scene brick = scene_of("tubes = 7\nlength_nm = 100\ntube_length_nm = 20\nstagger = \"brick\"\n");
  const Topology t = prepare(brick).topology;
  for (int tube = 0; tube < t.tubes(); ++tube)
    if (!t.begins_strand(tube) && !t.ends_strand(tube)) {
      EXPECT_NEAR(t.length_of(tube) * t.types[0].element_length, 20, 0.7 * t.types[0].element_length) << tube;
    }
}

TEST(RopeOfFiniteTubes, HasSectionsAndKeepsThemInAStateFile) {
  Scene scene = scene_of(finite, clamps);
  const Prepared p = prepare(scene);
  const Observer observer = make_observer(scene, p);
  const RopeObservation o = observe(observer, scene, p.topology, p.state);
  EXPECT_NEAR(o.beta, 0, 1e-9);
  EXPECT_EQ(o.middle.contacts, 12);
  EXPECT_EQ(o.middle.charge, 0);
  EXPECT_NEAR(o.radius_mid, p.spacing + p.topology.types[0].radius, 1e-9);
  EXPECT_EQ(observer.loading.radius.size(), static_cast<std::size_t>(p.topology.tubes())) << "of each tube";
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "strands.csv";
  std::ofstream(file) << state_csv(p.topology, p.state);
  Topology read = p.topology;
  State state;
  read_state_csv(file.string(), read, state);
  EXPECT_EQ(read.tube_begin, p.topology.tube_begin);
  EXPECT_EQ(read.groups.strand_begin, p.topology.groups.strand_begin);
  EXPECT_NEAR(read.groups.strand_holes, p.topology.groups.strand_holes, 1e-9);
  std::string damaged = state_csv(p.topology, p.state);
  const auto at = damaged.find("strands_begin_with_tubes: ");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << damaged.replace(at, 27, "strands_begin_with_tubes: 1");
  EXPECT_THROW(read_state_csv(file.string(), read, state), InputError);
  std::filesystem::remove(file);
}

TEST(RopeOfFiniteTubes, TakesATypeForEachStrandOrEachTube) {
  Scene scene = scene_of(finite, "", "");
  const int tubes = prepare(scene).topology.tubes();
  const auto types = [&](const std::string& list) {
    Scene mixed = scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = [\"cnt-10-10-tersoff\", "
        "\"cnt-5-5-tersoff\"]\nelement_length_nm = 1.4\ntube_types = [" +
            list + "]\n[rope]\n" + finite + "[run]\nduration_ps = 1\n",
        "rope.toml");
    return prepare(mixed).topology;
  };
  const Topology t = types("1, 0, 0, 0, 0, 0, 0");
  for (int tube = 0; tube < t.tubes(); ++tube)
    EXPECT_EQ(t.tube_type[static_cast<std::size_t>(tube)], tube < t.groups.strand_begin[1] ? 1 : 0);
  EXPECT_GT(tubes, 7);
  EXPECT_THROW(types("0, 1"), InputError);
}

TEST(Rope, TakesAnyNumberOfTubesWhereItIsRound) {
  for (const int tubes : {1, 2, 3, 7, 12, 50, 91}) {
    Scene scene = scene_of("tubes = " + std::to_string(tubes) + "\npacking = \"round\"\nlength_nm = 6\n");
    const Prepared p = prepare(scene);
    ASSERT_EQ(p.topology.tubes(), tubes);
    std::set<std::pair<long, long>> places;
    double farthest = 0;
    for (int t = 0; t < tubes; ++t) {
      const auto i = static_cast<std::size_t>(p.topology.tube_begin[t]);
      places.emplace(std::lround(1e3 * p.state.position.x[i]), std::lround(1e3 * p.state.position.y[i]));
      farthest = std::max(farthest, std::hypot(p.state.position.x[i], p.state.position.y[i]));
    }
    EXPECT_EQ(static_cast<int>(places.size()), tubes);
    // A disc of the area of so many cells, and one spacing.
    EXPECT_LT(farthest, p.spacing * (std::sqrt(tubes * std::sqrt(3) / (2 * units::pi)) + 0.6)) << tubes;
  }
}

TEST(Rope, RefusesTubesThatCannotBePlaced) {
  const auto message = [](const std::string& rope) -> std::string {
    try {
      Scene scene = scene_of(rope);
      prepare(scene);
      return "none";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  EXPECT_THAT(message("tubes = 8\nlength_nm = 60\n"), HasSubstr("packing = \"round\" takes any number"));
  EXPECT_THAT(message(seven + "tube_length_nm = 2\n"), HasSubstr("less than 3 elements"));
  EXPECT_THAT(message(seven + "stagger = \"brick\"\n"), HasSubstr("give tube_length_nm too"));
  EXPECT_THAT(message(finite + "tube_length_deviation_nm = 10\n"), HasSubstr("more than half of the mean length"));
  EXPECT_THAT(message(finite + "gap_nm = 0.1\n"), HasSubstr("they would be driven into one another"));
}

// What tubes of each pair of types keep apart, and how near each tube has come to others.
struct Packed {
  double overlap = 0, loosest = 0;  // nm: of the most pressed pair; of the second nearest tube, the largest of all
  double rim = 0;                   // nm
};
Packed packed(const Scene& scene, const Prepared& p) {
  Packed out;
  const auto at = [&](int t) { return p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]; };
  for (int a = 0; a < p.topology.tubes(); ++a) {
    std::vector<double> holes;
    for (int b = 0; b < p.topology.tubes(); ++b)
      if (b != a) {
        const TypePair types{p.topology.tube_type[static_cast<std::size_t>(a)],
                             p.topology.tube_type[static_cast<std::size_t>(b)]};
        holes.push_back((at(a) - at(b)).head<2>().norm() - pair_spacing(scene, p.interaction.law.get(), types));
      }
    std::sort(holes.begin(), holes.end());
    out.overlap = std::max(out.overlap, -holes[0]);
    out.loosest = std::max(out.loosest, holes[1]);
    out.rim = std::max(out.rim, at(a).head<2>().norm());
  }
  return out;
}
const std::string both_sets = "[\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]\ntype_shares = [0.5, 0.5]\n";
Scene unlike(const std::string& rope) {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = " + both_sets + "[rope]\nlength_nm = 6\n" +
                           rope + "[run]\nduration_ps = 1\n",
                       "rope.toml");
}

TEST(RopePacking, AtRandomNoPairIsPressedAndNoTubeLoose) {
  for (const char* packing :
       {"tubes = 61\npacking = \"random\"\n", "tubes = 61\n", "tubes = 20\npacking = \"round\"\n"}) {
    Scene scene = unlike(packing);
    const Prepared p = prepare(scene);
    const Packed found = packed(scene, p);
    EXPECT_LT(found.overlap, 1e-3) << packing;
    EXPECT_LT(found.loosest, 0.12) << packing;
  }
  Scene scene = scene_of("tubes = 40\npacking = \"random\"\nlength_nm = 6\n");
  const Prepared p = prepare(scene);
  EXPECT_LT(packed(scene, p).overlap, 1e-3);
  // As large as a disc of the area of their cells, with room for what a random packing leaves free.
  EXPECT_LT(packed(scene, p).rim, 1.5 * p.spacing * std::sqrt(40 * std::sqrt(3) / (2 * units::pi)));
  Scene other = scene_of("tubes = 40\npacking = \"random\"\nlength_nm = 6\n", "[start]\nseed = 2\n");
  Scene again = scene_of("tubes = 40\npacking = \"random\"\nlength_nm = 6\n");
  EXPECT_EQ(prepare(again).state.position.x, p.state.position.x);
  EXPECT_NE(prepare(other).state.position.x, p.state.position.x);
}

// Tubes alike stay on their lattice, and with tubes in line each strand moves as a whole.
TEST(RopePacking, DrawsUnlikeTubesTogetherAlone) {
  Scene alike = scene_of("tubes = 19\nlength_nm = 6\n");
  const Prepared lattice = prepare(alike);
  EXPECT_NEAR(lattice.state.position.x[static_cast<std::size_t>(lattice.topology.tube_begin[1])], lattice.spacing,
              1e-12);
  Scene mixed = unlike("tubes = 19\n");
  const auto mean_radius = [](const Prepared& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.state.size(); ++i) sum += p.state.position[i].head<2>().norm();
    return sum / static_cast<double>(p.state.size());
  };
  EXPECT_LT(mean_radius(prepare(mixed)), 0.9 * mean_radius(lattice)) << "narrow tubes need less room";
  Scene strands =
      scene_of_text("format = \"ropewalk-scene-1\"\nparameters = " + both_sets +
                        "[rope]\nlength_nm = 40\ntubes = 7\ntube_length_nm = 10\n[run]\nduration_ps = 1\n",
                    "rope.toml");
  const Prepared p = prepare(strands);
  for (int t = 0; t < p.topology.tubes(); ++t)
    for (int e = p.topology.tube_begin[t]; e < p.topology.tube_begin[t + 1]; ++e) {
      if (p.topology.begins_strand(t)) continue;
      EXPECT_EQ(p.state.position.x[static_cast<std::size_t>(e)],
                p.state.position.x[static_cast<std::size_t>(p.topology.tube_begin[t] - 1)]);
    }
}

TEST(RopePacking, TubesStayAtPlacesThatAreTyped) {
  Scene scene = scene_of("tubes = 3\nlength_nm = 6\nplaces_nm = [[0, 0], [1.8, 0], [0, -2.5]]\n");
  const Prepared p = prepare(scene);
  EXPECT_EQ(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[2])].y(), -2.5);
  Scene apart = unlike("tubes = 2\nplaces_nm = [[0, 0], [4, 0]]\n");
  const Prepared unlike_pair = prepare(apart);
  EXPECT_EQ(unlike_pair.state.position.x[static_cast<std::size_t>(unlike_pair.topology.tube_begin[1])], 4);
  const auto message = [](const std::string& rope, Scene (*make)(const std::string&)) -> std::string {
    try {
      Scene refused = make(rope);
      prepare(refused);
      return "none";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  const auto alike = [](const std::string& rope) { return scene_of(rope); };
  EXPECT_THAT(message("tubes = 3\nlength_nm = 6\nplaces_nm = [[0, 0], [1.8, 0]]\n", alike),
              HasSubstr("rope.places_nm: has 2 places, and the rope has 3 tubes; write tubes = 2"));
  EXPECT_THAT(
      message("tubes = 2\nlength_nm = 6\nplaces_nm = [[0, 0], [1, 0]]\n", alike),
      ::testing::AllOf(HasSubstr("rope.places_nm: elements "), HasSubstr("overlap: their axes are 1 nm apart")));
  // A wide tube and a narrow one: the axes are nearer than two wide tubes may be, or one is inside of the other.
  EXPECT_EQ(message("tubes = 2\nplaces_nm = [[0, 0], [1.2, 0]]\n", unlike), "none");
  EXPECT_THAT(message("tubes = 2\nplaces_nm = [[0, 0], [0, 0]]\n", unlike),
              HasSubstr("rope.places_nm: tubes 0 and 1 lie inside of one another"));
  EXPECT_THAT(message("tubes = 1\npacking = \"round\"\nlength_nm = 6\nplaces_nm = [[0, 0]]\n", alike),
              HasSubstr("stands beside packing"));
}

// Tubes at the surface are outermost, and so are those at a hole with room for a tube.
TEST(RopePacking, OutermostTubesAreThoseOfTheSurface) {
  for (const char* rope : {"tubes = 91\npacking = \"random\"\n", "tubes = 91\n"}) {
    Scene scene = unlike(rope);
    const Prepared p = prepare(scene);
    const RopeShells shells = rope_shells(p.topology, p.state, 0.5 * (1 + std::sqrt(3.0)) * p.spacing);
    const double rim = packed(scene, p).rim;
    int inside = 0, enclosed = 0;
    for (int t = 0; t < p.topology.tubes(); ++t) {
      const double r = p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])].head<2>().norm();
      if (r < 0.6 * rim) ++inside, enclosed += shells.internal[static_cast<std::size_t>(t)];
      if (r > rim - 1e-9) {
        EXPECT_TRUE(shells.outermost[static_cast<std::size_t>(t)]) << rope << t;
      }
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(enclosed, 0.85 * inside) << rope << ": but those beside a hole with room for a tube";
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
